"""Connections to the database: one kind for the writer, one that cannot write for readers.

The ``sqlite3`` module begins transactions late and on its own; both kinds switch that off and begin explicitly: the
writer with BEGIN IMMEDIATE (it waits for its turn at the beginning and cannot be refused half-way), a reader with BEGIN
(all its queries see one snapshot).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any
from urllib.parse import quote

from sqlalchemy import URL, Connection, Engine, create_engine, event, make_url
from sqlalchemy.exc import ArgumentError

from threadstate.errors import InvalidValueError

BUSY_TIMEOUT_S = 30.0
WRITER_CACHE_KIB = 65536
WRITER_CHECKPOINT_PAGES = 8192


def database_url(database: str) -> URL:
    """The database's address, checked.

    Raises:
        InvalidValueError: it is not the URL of a SQLite file.
    """
    valid = "a SQLite file's URL, such as sqlite:////absolute/path/threadstate.sqlite3"
    try:
        url = make_url(database)
    except ArgumentError:
        raise InvalidValueError("database", database, valid) from None
    if url.get_backend_name() != "sqlite" or not url.database or url.database == ":memory:" or url.query:
        raise InvalidValueError("database", url.render_as_string(), valid)
    return url


def database_path(database: str) -> Path:
    """The file behind a database's address."""
    return Path(str(database_url(database).database))


def writer_engine(database: str) -> Engine:
    """An engine that may write; it makes the file, and the folder around it, where they are missing.

    Raises:
        InvalidValueError: ``database`` is not the URL of a SQLite file, or the folder cannot be made.
    """
    path = database_path(database)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidValueError("database", database, f"a file in a folder that can be made ({error})") from None
    engine = create_engine(database_url(database), connect_args={"timeout": BUSY_TIMEOUT_S})

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


def reader_engine(database: str) -> Engine:
    """An engine that cannot write.

    Raises:
        InvalidValueError: ``database`` is not the URL of a SQLite file.
    """
    url = database_url(database)
    uri = url.set(
        database="file:" + quote(str(database_path(database).absolute())), query={"mode": "ro", "uri": "true"}
    )
    engine = create_engine(uri, connect_args={"timeout": BUSY_TIMEOUT_S})

    @event.listens_for(engine, "connect")
    def prepare(connection: Any, _record: object) -> None:
        connection.isolation_level = None

    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        connection.exec_driver_sql("BEGIN")

    return engine
