"""``threadstate windows``."""

from __future__ import annotations

from typing import Annotated

import typer

from worker.options import Database, Json, LibraryName, UnitName
from worker.output import print_json


def windows(
    roll: Annotated[float | None, typer.Option("--roll", metavar="DEG", help="Only of this roll.")] = None,
    pitch: Annotated[float | None, typer.Option("--pitch", metavar="DEG", help="Only of this pitch.")] = None,
    library: LibraryName = None,
    unit: UnitName = None,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Print the clearance windows of a library: where the bolt, turned counter-clockwise, falls into the nut.

    \b
    Examples:
      threadstate windows
      threadstate windows --roll 0 --pitch -4 --json
      threadstate windows --library 1-4-20-unc --unit mm
    """
    from threadstate.answer.windows import windows_of_histories
    from threadstate.units import conversion_factor
    from worker.history_table import print_windows
    from worker.stored_network import stored_network

    network = stored_network(database, library)
    shown = unit or network.pair.unit
    factor = conversion_factor(network.pair.unit, shown)
    found = windows_of_histories(network.histories, roll, pitch, network.pair.thread_pitch, factor)
    if as_json:
        for one in found:
            print_json(one.model_dump(mode="json", by_alias=True))
        return
    print_windows(found, shown)
