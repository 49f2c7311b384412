"""The engine that writes jobs; libraries are never written by the service."""

from __future__ import annotations

from threading import Lock
from typing import Annotated

from fastapi import Depends, Request
from sqlalchemy import Engine

from service.database import engine_of
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
