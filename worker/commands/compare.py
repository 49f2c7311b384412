"""``threadstate compare``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.numbers import number
from worker.options import Database, Json, UnitName
from worker.output import print_json, print_line


def compare(
    libraries: Annotated[
        list[str] | None,
        typer.Option("--library", metavar="NAME", help="A library; any number of times.", show_default="latest"),
    ] = None,
    tilts: Annotated[
        list[str] | None,
        typer.Option(
            "--tilt",
            metavar="ANGLES",
            help="Snaps and windows of an orientation, as ROLL,PITCH; any number of times.",
            show_default="figures of all orientations",
        ),
    ] = None,
    each: Annotated[bool, typer.Option("--each", help="Also a line for each orientation.")] = False,
    unit: UnitName = None,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Print libraries side by side: windows, snaps, classes, least friction and embedment over all orientations.

    Lengths are in thread pitches, in which threads of different sizes compare. With --tilt, snaps and windows of these
    orientations instead, on a library's grid or not, with lengths in the first library's unit.

    \b
    Examples:
      threadstate compare --library 1-4-20-unc --library m6
      threadstate compare --library 1-4-20-unc --library m6 --tilt 0,-4
      threadstate compare --tilt 0,-4 --tilt 2.5,-1.2 --unit mm
    """
    if not tilts:
        if unit is not None:
            raise InvalidValueError("--unit", unit.value, "with --tilt; without it lengths are in thread pitches")
        _compare_libraries(libraries or [None], database, each=each, as_json=as_json)
        return
    if each:
        raise InvalidValueError("--each", True, "without --tilt, which names the orientations")
    from threadstate.units import conversion_factor
    from worker.falls import falls_and_windows
    from worker.history_table import Compared, print_compared
    from worker.library_source import stored_network

    angles = [_angles(text) for text in tilts]
    networks = [stored_network(database, name) for name in libraries or (None,)]
    shown = unit or networks[0].pair.unit
    compared = []
    for network in networks:
        factor = conversion_factor(network.pair.unit, shown)
        for roll, pitch in angles:
            (found,) = falls_and_windows(network, roll, pitch, factor)
            compared.append(
                Compared(network.library.id, network.pair.designation, network.pair.thread_pitch * factor, found)
            )
    if as_json:
        entries = [
            {
                "library": one.library,
                "designation": one.designation,
                "thread_pitch": one.thread_pitch,
                **one.found.model_dump(mode="json", by_alias=True),
            }
            for one in compared
        ]
        print_json({"unit": shown.value, "orientations": entries})
        return
    print_compared(compared, shown)


def _compare_libraries(names: Sequence[str | None], database: str | None, *, each: bool, as_json: bool) -> None:
    from threadstate.library.figures import library_figures
    from threadstate.responses.comparison import ComparisonDocument, compared_library
    from worker.comparison_table import print_comparison, print_each
    from worker.library_source import connected_library

    found = []
    for name in names:
        with connected_library(database, name) as (connection, record):
            found.append(compared_library(library_figures(connection, record)))
    if as_json:
        print_json(ComparisonDocument(libraries=found).model_dump(mode="json"))
        return
    print_comparison(found)
    if each:
        print_line("")
        print_each(found)


def _angles(text: str) -> tuple[float, float]:
    parts = text.split(",")
    try:
        roll, pitch = (number(part.strip(" ")) for part in parts)
    except ValueError:
        raise InvalidValueError("--tilt", text, "two angles in degrees with a comma, as 0,-4") from None
    return roll, pitch
