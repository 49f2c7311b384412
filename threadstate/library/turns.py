"""Writers taking turns where the row that they would lock is not there yet."""

from __future__ import annotations

from enum import IntEnum

from sqlalchemy import Connection, func, select

_LOCKS = 0x746872
"""Sets this project's advisory locks apart from others of the same database."""


class Turn(IntEnum):
    """What is done by one writer at a time."""

    MIGRATE = 1
    OPEN_LIBRARY = 2
    ASK = 3


def take_turn(connection: Connection, turn: Turn) -> None:
    """Wait until no other writer's transaction is at this, and keep the others waiting until this one's ends.

    SQLite's writers take turns with whole transactions already.
    """
    if connection.dialect.name == "postgresql":
        connection.execute(select(func.pg_advisory_xact_lock(_LOCKS, int(turn))))
