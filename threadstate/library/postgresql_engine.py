"""Connections to PostgreSQL: one kind for writers, one that cannot write for readers.

Writers are isolated as READ COMMITTED and take turns by locks on rows: what a statement after the lock reads is
committed and stays so. A reader's queries all see one snapshot (REPEATABLE READ, READ ONLY).
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any

from sqlalchemy import URL, Engine, create_engine, event

from threadstate.errors import MissingExtraError
from threadstate.settings import database_password

CONNECT_TIMEOUT_S = 10
LOCK_TIMEOUT_S = 60
IDLE_TIMEOUT_S = 60
"""A writer that stands still within a transaction, as one whose machine is gone, loses it and so its locks."""


def postgresql_writer(url: URL, patience_s: float | None = None) -> Engine:
    """An engine that may write; it waits for locks for ``patience_s`` seconds (None: ``LOCK_TIMEOUT_S``).

    Raises:
        InvalidValueError: the password's file cannot be read.
        MissingExtraError: psycopg is not installed.
    """
    # Rows are handed to the driver as tuples.
    engine = create_engine(
        _with_defaults(url), isolation_level="READ COMMITTED", paramstyle="format", pool_pre_ping=True
    )

    @event.listens_for(engine, "connect")
    def prepare(connection: Any, _record: object) -> None:
        _set(
            connection,
            extra_float_digits="1",
            lock_timeout=f"{round(1000 * (LOCK_TIMEOUT_S if patience_s is None else patience_s))}ms",
            idle_in_transaction_session_timeout=f"{IDLE_TIMEOUT_S}s",
        )

    return engine


def postgresql_reader(url: URL) -> Engine:
    """An engine that cannot write.

    Raises:
        InvalidValueError: the password's file cannot be read.
        MissingExtraError: psycopg is not installed.
    """
    engine = create_engine(_with_defaults(url), isolation_level="REPEATABLE READ", pool_pre_ping=True)

    @event.listens_for(engine, "connect")
    def prepare(connection: Any, _record: object) -> None:
        _set(connection, extra_float_digits="1")
        connection.read_only = True

    return engine


def _with_defaults(url: URL) -> URL:
    if find_spec("psycopg") is None:
        raise MissingExtraError("a PostgreSQL database", "postgresql")
    defaults = {
        "application_name": "threadstate",
        "client_encoding": "utf8",
        "connect_timeout": str(CONNECT_TIMEOUT_S),
    }
    url = url.set(query={**defaults, **url.query})
    password = None if url.password else database_password()
    return url if password is None else url.set(password=password)


def _set(connection: Any, **values: str) -> None:
    """Set parameters of the session for good: within a transaction they would end with it.

    ``extra_float_digits`` is 1 unless a server is told otherwise: doubles are then written so that they read back bit
    by bit.
    """
    connection.autocommit = True
    for name, value in values.items():
        connection.execute(f"SET {name} = '{value}'")
    connection.autocommit = False
