"""``threadstate history``."""

from __future__ import annotations

from typing import Annotated

import typer

from worker.options import Database, Designation, Json
from worker.output import print_json


def history(
    roll: Annotated[float, typer.Option("--roll", metavar="DEG", help="Roll, -10 to 10.")],
    pitch: Annotated[float, typer.Option("--pitch", metavar="DEG", help="Pitch, -10 to 10.")],
    stored: Annotated[
        bool, typer.Option("--stored", help="From the latest library, in place of computing it.", show_default=False)
    ] = False,
    database: Database = None,
    pair: Designation = None,
    as_json: Json = False,
) -> None:
    r"""Print the history of an orientation: its phase circle, cut where any label changes, and its clearance windows.

    Any orientation is computed, which takes about a second; with --stored one of the library's grid is read.

    \b
    Examples:
      threadstate history --roll 0 --pitch -4
      threadstate history --roll 1.5 --pitch -0.7 --json
      threadstate history --roll 0 --pitch -4 --stored
    """
    from threadstate.answer.histories import computed_history, history_document
    from threadstate.thread.catalogue import DEFAULT_DESIGNATION, pair_by_designation
    from worker.history_table import print_history
    from worker.stored_network import stored_network

    if stored:
        network = stored_network(database)
        threads = network.pair
        found = network.histories.orientations[network.orientation(roll, pitch)]
    else:
        threads = pair_by_designation(DEFAULT_DESIGNATION if pair is None else pair)
        found = computed_history(threads, roll, pitch)
    document = history_document(found, roll, pitch, threads.thread_pitch, 1.0)
    if as_json:
        print_json({"unit": threads.unit.value, **document.model_dump(mode="json", by_alias=True)})
        return
    print_history(document, threads.unit)
