"""``threadstate heights``."""

from __future__ import annotations

from typing import Annotated

import typer

from worker.options import Database, Designation, Json
from worker.output import print_json


def heights(
    roll: Annotated[float, typer.Option("--roll", metavar="DEG", help="Roll, -10 to 10.")],
    pitch: Annotated[float, typer.Option("--pitch", metavar="DEG", help="Pitch, -10 to 10.")],
    stored: Annotated[
        bool, typer.Option("--stored", help="From the latest library, in place of computing it.", show_default=False)
    ] = False,
    database: Database = None,
    pair: Designation = None,
    as_json: Json = False,
) -> None:
    r"""Print the height of the bolt against its phase, at as many phases as straight lines between them need.

    A jump shows as two heights at phases that all but coincide.

    \b
    Examples:
      threadstate heights --roll 0 --pitch -4
      threadstate heights --roll 1.5 --pitch -0.7 --json
      threadstate heights --roll 0 --pitch -4 --stored
    """
    from threadstate.answer.heights import computed_heights, heights_document, stored_heights
    from threadstate.thread.catalogue import DEFAULT_DESIGNATION, pair_by_designation
    from worker.history_table import print_heights
    from worker.stored_network import connected_network

    if stored:
        with connected_network(database) as (connection, network):
            threads = network.pair
            found = stored_heights(connection, network, roll, pitch)
    else:
        threads = pair_by_designation(DEFAULT_DESIGNATION if pair is None else pair)
        found = computed_heights(threads, roll, pitch)
    document = heights_document(found, roll, pitch, threads.thread_pitch, 1.0)
    if as_json:
        print_json({"unit": threads.unit.value, **document.model_dump(mode="json")})
        return
    print_heights(document, threads.unit)
