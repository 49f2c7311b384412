"""Connections to the database, whichever it is: one kind for writers, one that cannot write for readers."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import Engine

from threadstate.library.address import database_url, is_sqlite
from threadstate.library.postgresql_engine import postgresql_reader, postgresql_writer
from threadstate.library.sqlite_engine import sqlite_reader, sqlite_writer


def writer_engine(database: str, patience_s: float | None = None) -> Engine:
    """An engine that may write; a SQLite file, and the folder around it, is made where it is missing.

    ``patience_s`` is for how many seconds it waits for what another writer holds (None: as long as a writer of
    libraries may be at it).

    Raises:
        InvalidValueError: ``database`` is the URL of neither database, or the folder cannot be made.
    """
    url = database_url(database)
    return sqlite_writer(url, patience_s) if is_sqlite(url) else postgresql_writer(url, patience_s)


def reader_engine(database: str) -> Engine:
    """An engine that cannot write.

    Raises:
        InvalidValueError: ``database`` is the URL of neither database.
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
