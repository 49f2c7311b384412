"""The grid of a success map by the options of a command."""

from __future__ import annotations

from typing import TYPE_CHECKING

from threadstate.errors import InvalidValueError

if TYPE_CHECKING:
    from threadstate.library.grid import Grid

LARGEST_PHASES = 36_000


def grid_of_phases(tilt_max: float, tilt_step: float, phases: int) -> Grid:
    """The grid with so many starting phases, evenly spaced; angles in degrees.

    Raises:
        InvalidValueError: the number does not divide 360 deg into decimals, or the grid refuses a tilt.
    """
    from threadstate.library.grid import Grid

    # What remains of a number of phases without its twos, fives and two threes has no finite decimal.
    rest = phases
    for prime in (2, 2, 2, 2, 2, 2, 2, 2, 3, 3, 5, 5, 5):
        rest = rest // prime if rest % prime == 0 else rest
    if rest != 1:
        raise InvalidValueError("phases", phases, "a number that divides 360 deg into decimals, as 4, 8, 12 or 36")
    return Grid(tilt_max, tilt_step, 360.0 / phases)
