"""The states of one orientation."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import Connection

from threadstate.library.read import LibraryRecord, not_on_the_grid, states_between, undecided_between
from threadstate.state.model import ContactState, UndecidedPose


@dataclass(frozen=True)
class History:
    """The states of an orientation, and its poses that have none, each in the order of phases."""

    states: list[ContactState]
    undecided: list[UndecidedPose]


def history(connection: Connection, library: LibraryRecord, roll_deg: float, pitch_deg: float) -> History:
    """The answers for an orientation at all phases, in order.

    Raises:
        NotFoundError: the orientation is not one of the library's grid.
    """
    grid = library.grid
    if roll_deg not in grid.tilts_deg or pitch_deg not in grid.tilts_deg:
        raise not_on_the_grid(library, roll_deg, pitch_deg)
    orientation = grid.tilts_deg.index(roll_deg) * grid.tilt_count + grid.tilts_deg.index(pitch_deg)
    first = grid.first_ordinal(orientation)
    last = first + grid.phase_count - 1
    return History(
        states_between(connection, library.id, first, last),
        [pose for _, pose in undecided_between(connection, library.id, first, last)],
    )
