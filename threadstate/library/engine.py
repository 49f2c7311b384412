"""Engines for writers and read-only engines for readers, of SQLite and PostgreSQL.

SQLite: the ``sqlite3`` module begins transactions late and implicitly; both engines disable that and begin explicitly,
the writer with BEGIN IMMEDIATE (it waits for other writers at the beginning and cannot be refused later), a reader
with BEGIN (all its queries see one snapshot).

PostgreSQL: writers are isolated as READ COMMITTED and exclude each other by row locks: what a statement after the lock
reads is committed and does not change. All queries of a reader's transaction see one snapshot (REPEATABLE READ, READ
ONLY).
"""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any
from urllib.parse import quote

from sqlalchemy import URL, Connection, Engine, create_engine, event

from threadstate.errors import InvalidValueError, MissingExtraError
from threadstate.library.address import database_url, is_sqlite, masked_url, sqlite_path
from threadstate.settings import database_password

BUSY_TIMEOUT_S = 30.0
RETRY_S = 0.01
"""How often a lock that SQLite does not wait for is asked for again."""
WRITER_CACHE_KIB = 65536
WRITER_CHECKPOINT_PAGES = 8192
CONNECT_TIMEOUT_S = 10
LOCK_TIMEOUT_S = 60
IDLE_TIMEOUT_S = 60
"""A transaction that is idle for longer, as one of a machine that is down, is aborted and releases its locks."""


def writer_engine(database: str, lock_timeout_s: float | None = None) -> Engine:
    """An engine that may write; a SQLite file, and the folder around it, is made where it is missing.

    ``lock_timeout_s`` is for how many seconds it waits for another writer's locks; None is the default of the database:
    ``BUSY_TIMEOUT_S`` or ``LOCK_TIMEOUT_S``.

    Raises:
        InvalidValueError: ``database`` is not the URL of a SQLite or PostgreSQL database, or the folder cannot be made.
    """
    url = database_url(database)
    return sqlite_writer(url, lock_timeout_s) if is_sqlite(url) else postgresql_writer(url, lock_timeout_s)


def reader_engine(database: str) -> Engine:
    """An engine that cannot write.

    Raises:
        InvalidValueError: ``database`` is not the URL of a SQLite or PostgreSQL database.
    """
    url = database_url(database)
    return sqlite_reader(url) if is_sqlite(url) else postgresql_reader(url)


@contextmanager
def writing(database: str) -> Iterator[Engine]:
    """A :func:`writer_engine`, whose connections are closed on leaving."""
    with _closed(writer_engine(database)) as engine:
        yield engine


@contextmanager
def reading(database: str) -> Iterator[Engine]:
    """A :func:`reader_engine`, whose connections are closed on leaving."""
    with _closed(reader_engine(database)) as engine:
        yield engine


@contextmanager
def _closed(engine: Engine) -> Iterator[Engine]:
    try:
        yield engine
    finally:
        engine.dispose()


def sqlite_writer(url: URL, lock_timeout_s: float | None = None) -> Engine:
    """An engine that may write; it makes the file, and the folder around it, where they are missing.

    It waits for another writer for ``lock_timeout_s`` seconds (None: ``BUSY_TIMEOUT_S``).

    Raises:
        InvalidValueError: the folder cannot be made.
    """
    try:
        sqlite_path(url).parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidValueError("database", masked_url(url), f"a file in a folder that can be made ({error})") from None
    wait_s = BUSY_TIMEOUT_S if lock_timeout_s is None else lock_timeout_s
    engine = create_engine(url, connect_args={"timeout": wait_s})

    @event.listens_for(engine, "connect")
    def prepare(connection: Any, _record: object) -> None:
        connection.isolation_level = None
        _use_write_ahead_log(connection, wait_s)
        connection.execute("PRAGMA synchronous = NORMAL")
        connection.execute("PRAGMA foreign_keys = ON")
        # Orientations fall in order into the tables and all over the indexes: those are to stay in memory.
        connection.execute(f"PRAGMA cache_size = -{WRITER_CACHE_KIB}")
        # Committed pages are copied from the log into the file every 32 MiB; each time waits for the disk.
        connection.execute(f"PRAGMA wal_autocheckpoint = {WRITER_CHECKPOINT_PAGES}")

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        connection.exec_driver_sql("BEGIN IMMEDIATE")

    return engine


def _use_write_ahead_log(connection: sqlite3.Connection, wait_s: float) -> None:
    """Readers go on reading while a chunk is written then; a killed process loses no committed chunk.

    Of two that make a new file at once SQLite refuses one without waiting.
    """
    until = time.monotonic() + wait_s
    while True:
        try:
            connection.execute("PRAGMA journal_mode = WAL")
            return
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode & 0xFF != sqlite3.SQLITE_BUSY or time.monotonic() > until:
                raise
            time.sleep(RETRY_S)


def sqlite_reader(url: URL) -> Engine:
    """An engine that cannot write and does not make the file."""
    uri = url.set(database="file:" + quote(str(sqlite_path(url).absolute())), query={"mode": "ro", "uri": "true"})
    engine = create_engine(uri, connect_args={"timeout": BUSY_TIMEOUT_S})

    @event.listens_for(engine, "connect")
    def prepare(connection: Any, _record: object) -> None:
        connection.isolation_level = None

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        connection.exec_driver_sql("BEGIN")

    return engine


def postgresql_writer(url: URL, lock_timeout_s: float | None = None) -> Engine:
    """An engine that may write; it waits for locks for ``lock_timeout_s`` seconds (None: ``LOCK_TIMEOUT_S``).

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
            lock_timeout=f"{round(1000 * (LOCK_TIMEOUT_S if lock_timeout_s is None else lock_timeout_s))}ms",
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
    """Set parameters of the session outside any transaction, with which they would end.

    ``extra_float_digits = 1`` is the server's default unless configured otherwise: doubles are written so that they
    read back bit by bit.
    """
    connection.autocommit = True
    for name, value in values.items():
        connection.execute(f"SET {name} = '{value}'")
    connection.autocommit = False
