"""``threadstate compare``."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.numbers import number
from worker.options import Database, Json, UnitName
from worker.output import print_json


def compare(
    libraries: Annotated[
        list[str] | None,
        typer.Option("--library", metavar="NAME", help="A library; any number of times.", show_default="latest"),
    ] = None,
    tilts: Annotated[
        list[str] | None,
        typer.Option(
            "--tilt", metavar="ANGLES", help="An orientation as ROLL,PITCH; any number of times.", show_default="0,-4"
        ),
    ] = None,
    unit: UnitName = None,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Print snaps and windows of orientations and libraries side by side.

    Every orientation of every library, on its grid or not. Falls are also given in thread pitches, in which threads of
    different sizes compare; lengths are in the first library's unit.

    \b
    Examples:
      threadstate compare --library 1-4-20-unc --library m6x1 --tilt 0,-4
      threadstate compare --tilt 0,-4 --tilt 2.5,-1.2 --unit mm
    """
    from threadstate.units import conversion_factor
    from worker.falls import falls_and_windows
    from worker.history_table import Compared, print_compared
    from worker.library_source import stored_network

    angles = [_angles(text) for text in tilts or ["0,-4"]]
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


def _angles(text: str) -> tuple[float, float]:
    parts = text.split(",")
    try:
        roll, pitch = (number(part.strip(" ")) for part in parts)
    except ValueError:
        raise InvalidValueError("--tilt", text, "two angles in degrees with a comma, as 0,-4") from None
    return roll, pitch
