"""Responses read straight from the database, before routing: the state of a pose, the history of an orientation.

Each is one read and one serialisation. Only successful responses are made here, with the same bytes as the endpoints'
(a test compares them); everything else, errors included, is left to the endpoints.
"""

from __future__ import annotations

import re

import orjson
from fastapi.concurrency import run_in_threadpool
from sqlalchemy import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

from service.cache.responses import CachedResponse
from service.quantities import UNIT_HEADER
from service.representation import JSON, VARY_ACCEPT, etag_of
from threadstate.errors import NotFoundError, UndecidedPoseError
from threadstate.library.address import is_sqlite
from threadstate.library.direct_reader import DirectReader
from threadstate.library.pose import state_of_pose
from threadstate.library.read import LibraryRecord, undecided_between
from threadstate.library.rows import unpacked_states
from threadstate.library.states_json import orientation_states_json
from threadstate.numbers import number_text
from threadstate.state.json import state_json
from threadstate.state.model import ContactState

STATE_ROUTE = "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}"
HISTORY_ROUTE = "/v1/libraries/{id}/histories/{roll}/{pitch}"

_ANGLE = r"(-?[0-9]{1,3}(?:\.[0-9]{1,15})?)"
_STATE = re.compile(f"/states/{_ANGLE}/{_ANGLE}/{_ANGLE}")
_HISTORY = re.compile(f"/histories/{_ANGLE}/{_ANGLE}")
_JSON = JSON.encode()
_UNIT_HEADER = UNIT_HEADER.lower().encode()


class StoredResponses:
    """States and histories of the database behind ``engine``, in their library's own unit.

    They are read in the event loop where that never blocks (SQLite), else in a thread.
    """

    def __init__(self, engine: Engine, cache_control: str) -> None:
        self._engine = engine
        self._reader = DirectReader(engine) if is_sqlite(engine.url) else None
        self._cache_control = cache_control.encode()

    def close(self) -> None:
        """Close the connection that reads within the event loop."""
        if self._reader is not None:
            self._reader.close()

    async def state(self, library: LibraryRecord, path: str) -> CachedResponse | None:
        """The response for the state at ``path``, relative to the library; None if it is not the path of a stored
        state.
        """
        match = _STATE.fullmatch(path)
        if match is None:
            return None
        pose = float(match[1]), float(match[2]), float(match[3])
        if self._reader is not None:
            state = self._reader.state(library.id, *pose)
        else:
            state = await run_in_threadpool(self._read_state, library.id, *pose)
        if state is None:
            return None
        location = content_location(library.id, *pose)
        return self._response(STATE_ROUTE, library, state_json(state), ("content-location", location))

    async def history(self, library: LibraryRecord, path: str) -> CachedResponse | None:
        """The response for the history at ``path``, relative to the library; None if it is not the path of a stored
        one.
        """
        match = _HISTORY.fullmatch(path)
        if match is None:
            return None
        orientation = library.grid.orientation_index(float(match[1]), float(match[2]))
        if orientation is None:
            return None
        if self._reader is not None and not library.undecided_count:
            packed = self._reader.packed_states(library.id, orientation)
            if packed is not None:
                return self._history(library, _history_json(library, orientation, unpacked_states(packed), []))
        return await run_in_threadpool(self._read_history, library, orientation)

    def _read_state(self, library_id: int, roll_deg: float, pitch_deg: float, phase_deg: float) -> ContactState | None:
        try:
            with self._engine.connect() as connection:
                return state_of_pose(connection, library_id, roll_deg, pitch_deg, phase_deg)
        except (NotFoundError, UndecidedPoseError, SQLAlchemyError):
            return None

    def _read_history(self, library: LibraryRecord, orientation: int) -> CachedResponse | None:
        try:
            with self._engine.connect() as connection:
                return self._history(library, history_rows_json(connection, library, orientation))
        except SQLAlchemyError:
            return None

    def _history(self, library: LibraryRecord, content: bytes) -> CachedResponse:
        return self._response(HISTORY_ROUTE, library, content, vary=VARY_ACCEPT)

    def _response(
        self, route: str, library: LibraryRecord, content: bytes, *further: tuple[str, str], vary: str = ""
    ) -> CachedResponse:
        etag = etag_of(content)
        headers = [
            (b"etag", etag.encode()),
            (b"cache-control", self._cache_control),
            (_UNIT_HEADER, library.length_unit.value.encode()),
            *((name.encode(), value.encode()) for name, value in further),
            (b"vary", f"{vary}, Accept-Encoding".removeprefix(", ").encode()),
            (b"content-length", b"%d" % len(content)),
            (b"content-type", _JSON),
        ]
        return CachedResponse(route, etag, headers, content)


def content_location(library_id: int, roll_deg: float, pitch_deg: float, phase_deg: float) -> str:
    """The address of a state in this very library, angles in degrees."""
    return f"/v1/libraries/{library_id}/states/{'/'.join(map(number_text, (roll_deg, pitch_deg, phase_deg)))}"


def undecided_phases(connection: Connection, library: LibraryRecord, orientation: int) -> list[dict[str, object]]:
    """The phases of an orientation without a state, and why, in order."""
    if not library.undecided_count:
        return []
    first = library.grid.first_ordinal(orientation)
    poses = undecided_between(connection, library.id, first, first + library.grid.phase_count - 1)
    return [{"phase": pose.phase_deg, "reason": pose.reason} for _, pose in poses]


def history_rows_json(connection: Connection, library: LibraryRecord, orientation: int) -> bytes:
    """The history of the orientation with that number, in the library's own unit."""
    states = orientation_states_json(connection, library.id, library.grid, orientation)
    return _history_json(library, orientation, states, undecided_phases(connection, library, orientation))


def _history_json(library: LibraryRecord, orientation: int, states: bytes, undecided: list[dict[str, object]]) -> bytes:
    place = library.grid.orientation(orientation)
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
