"""A history as rows: the states of an orientation, between a head and the phases that have none."""

from __future__ import annotations

import orjson
from sqlalchemy import Connection

from threadstate.library.read import LibraryRecord, undecided_between
from threadstate.library.states_json import orientation_states_json

HISTORY_ROUTE = "/v1/libraries/{id}/histories/{roll}/{pitch}"


def undecided_phases(connection: Connection, library: LibraryRecord, orientation: int) -> list[dict[str, object]]:
    """The phases of an orientation without a state, and why, in order."""
    if not library.undecided_count:
        return []
    first = library.grid.first_ordinal(orientation)
    poses = undecided_between(connection, library.id, first, first + library.grid.phase_count - 1)
    return [{"phase": pose.phase_deg, "reason": pose.reason} for _, pose in poses]


def history_rows_json(connection: Connection, library: LibraryRecord, orientation: int) -> bytes:
    """The history of the orientation with that number, in the library's own unit."""
    place = library.grid.orientation(orientation)
    states = orientation_states_json(connection, library.id, library.grid, orientation)
    undecided = undecided_phases(connection, library, orientation)
    return orjson.dumps(
        {
            "library": library.id,
            "unit": library.length_unit.value,
            "roll": place.roll_deg + 0.0,
            "pitch": place.pitch_deg + 0.0,
            "states": orjson.Fragment(states),
            "undecided": undecided,
        }
    )
