"""Connections to a SQLite file: one kind for the writer, one that cannot write for readers.

The ``sqlite3`` module begins transactions late and on its own; both kinds switch that off and begin explicitly: the
writer with BEGIN IMMEDIATE (it waits for its turn at the beginning and cannot be refused half-way), a reader with BEGIN
(all its queries see one snapshot).
"""

from __future__ import annotations

from typing import Any
from urllib.parse import quote

from sqlalchemy import URL, Connection, Engine, create_engine, event

from threadstate.errors import InvalidValueError
from threadstate.library.address import shown, sqlite_path

BUSY_TIMEOUT_S = 30.0
WRITER_CACHE_KIB = 65536
WRITER_CHECKPOINT_PAGES = 8192


def sqlite_writer(url: URL, patience_s: float | None = None) -> Engine:
    """An engine that may write; it makes the file, and the folder around it, where they are missing.

    It waits for another writer for ``patience_s`` seconds (None: ``BUSY_TIMEOUT_S``).

    Raises:
        InvalidValueError: the folder cannot be made.
    """
    try:
        sqlite_path(url).parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidValueError("database", shown(url), f"a file in a folder that can be made ({error})") from None
    engine = create_engine(url, connect_args={"timeout": BUSY_TIMEOUT_S if patience_s is None else patience_s})

    @event.listens_for(engine, "connect")
    def prepare(connection: Any, _record: object) -> None:
        connection.isolation_level = None
        # Readers go on reading while a chunk is written; a killed process loses no committed chunk.
        connection.execute("PRAGMA journal_mode = WAL")
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
