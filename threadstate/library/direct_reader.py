"""Reads of the most frequent requests, executed directly by the database's driver."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from typing import Any

from sqlalchemy import CompoundSelect, Connection, Engine, Select, bindparam, select
from sqlalchemy.exc import SQLAlchemyError

from threadstate.library.pose import STATE_OF_POSE, state_of_rows
from threadstate.library.tables import chunk
from threadstate.state.model import ContactState

_STATES_JSON = select(chunk.c.states_json).where(
    chunk.c.library_id == bindparam("library"), chunk.c.orientation == bindparam("orientation")
)


class _Prepared:
    """A statement in the database's words, and the names of its parameters in their order."""

    def __init__(self, engine: Engine, statement: Select[Any] | CompoundSelect[Any]) -> None:
        compiled = statement.compile(dialect=engine.dialect)
        self.sql = str(compiled)
        self.names = tuple(compiled.positiontup or ())


class DirectReader:
    """Reads from a SQLite file over a connection of its own; where it would have to wait for a lock, it finds nothing.

    Not safe for threads. What it does not find may still be there.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._state = _Prepared(engine, STATE_OF_POSE)
        self._states_json = _Prepared(engine, _STATES_JSON)
        self._connection: Connection | None = None
        self._cursor: Any = None

    def state(self, library_id: int, roll_deg: float, pitch_deg: float, phase_deg: float) -> ContactState | None:
        """The state of a pose of the grid, as :func:`threadstate.library.pose.state_of_pose`; None where not found."""
        pose = {"library": library_id, "roll": roll_deg, "pitch": pitch_deg, "phase": phase_deg}
        return state_of_rows(self._rows(self._state, pose))

    def packed_states(self, library_id: int, orientation: int) -> bytes | None:
        """The compressed JSON of an orientation's states; None where not found."""
        rows = self._rows(self._states_json, {"library": library_id, "orientation": orientation})
        return rows[0][0] if rows else None

    def close(self) -> None:
        """Close the connection."""
        if self._connection is not None:
            self._connection.close()
            self._connection = self._cursor = None

    def _rows(self, statement: _Prepared, values: dict[str, float]) -> Sequence[Sequence[Any]]:
        try:
            if self._cursor is None:
                self._connection = self._engine.connect()
                self._cursor = self._connection.connection.cursor()
                self._cursor.execute("PRAGMA busy_timeout = 0")
            parameters = [values[name] for name in statement.names]
            rows: Sequence[Sequence[Any]] = self._cursor.execute(statement.sql, parameters).fetchall()
        except (SQLAlchemyError, sqlite3.Error):
            return ()
        return rows
