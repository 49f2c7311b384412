"""The database connections of a request: one that cannot write, and the engine that writes jobs."""

from __future__ import annotations

from collections.abc import Iterator
from threading import Lock
from typing import Annotated

from fastapi import Depends, Request
from sqlalchemy import Connection, Engine

from threadstate.library.engine import writer_engine
from threadstate.library.schema import check_schema

LOCK_TIMEOUT_S = 2.0
"""How long a request, and its thread, waits for another process's write lock."""


class ControlEngine:
    """An engine that may write, created when it is first needed, after the schema check: it never creates a SQLite
    file.
    """

    def __init__(self, database: str) -> None:
        self._database = database
        self._engine: Engine | None = None
        self._lock = Lock()

    def get(self) -> Engine:
        """The engine; the database must exist."""
        with self._lock:
            if self._engine is None:
                self._engine = writer_engine(self._database, LOCK_TIMEOUT_S)
            return self._engine

    def dispose(self) -> None:
        """Close its connections."""
        with self._lock:
            if self._engine is not None:
                self._engine.dispose()


def _control(request: Request) -> Engine:
    check_schema(engine_of(request))
    control: ControlEngine = request.app.state.control
    return control.get()


RequestedControl = Annotated[Engine, Depends(_control)]
"""The engine that writes jobs, over a database that is migrated."""


def engine_of(request: Request) -> Engine:
    """The application's engine."""
    engine: Engine = request.app.state.engine
    return engine


def _connection(request: Request) -> Iterator[Connection]:
    with engine_of(request).connect() as connection:
        yield connection


ReadConnection = Annotated[Connection, Depends(_connection)]
"""A connection with one snapshot of the database for the whole request."""
