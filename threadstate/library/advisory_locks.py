"""Advisory locks for writers whose row to lock does not exist yet."""

from __future__ import annotations

from enum import IntEnum

from sqlalchemy import Connection, func, select

_LOCKS = 0x746872
"""The first key of every advisory lock of this project."""


class WriterLock(IntEnum):
    """What one writer at a time may do."""

    MIGRATE = 1
    OPEN_LIBRARY = 2
    SUBMIT_JOB = 3


def take_lock(connection: Connection, lock: WriterLock) -> None:
    """Hold a lock until the transaction ends; waits while another transaction holds it.

    Does nothing on SQLite, whose write transactions exclude each other.
    """
    if connection.dialect.name == "postgresql":
        connection.execute(select(func.pg_advisory_xact_lock(_LOCKS, int(lock))))
