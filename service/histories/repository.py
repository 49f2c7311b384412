"""The states of one orientation."""

from __future__ import annotations

from sqlalchemy import Connection

from threadstate.errors import NotFoundError
from threadstate.library.read import LibraryRecord, states_between
from threadstate.state.model import ContactState


def history(connection: Connection, library: LibraryRecord, roll_deg: float, pitch_deg: float) -> list[ContactState]:
    """The states of an orientation at all phases, in order.

    Raises:
        NotFoundError: the orientation is not one of the library's grid.
    """
    grid = library.grid
    if roll_deg not in grid.tilts_deg or pitch_deg not in grid.tilts_deg:
        raise NotFoundError(
            f"library {library.id} has no orientation of roll {roll_deg:g}, pitch {pitch_deg:g} deg; "
            f"its grid: -{grid.tilt_max_deg:g} to {grid.tilt_max_deg:g} deg in steps of {grid.tilt_step_deg:g}"
        )
    orientation = grid.tilts_deg.index(roll_deg) * grid.tilt_count + grid.tilts_deg.index(pitch_deg)
    first = grid.first_ordinal(orientation)
    return states_between(connection, library.id, first, first + grid.phase_count - 1)
