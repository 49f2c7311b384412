"""A request's connection to the database, which cannot write."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from fastapi import Depends, Request
from sqlalchemy import Connection, Engine


def engine_of(request: Request) -> Engine:
    """The application's engine."""
    engine: Engine = request.app.state.engine
    return engine


def _connection(request: Request) -> Iterator[Connection]:
    with engine_of(request).connect() as connection:
        yield connection


ReadConnection = Annotated[Connection, Depends(_connection)]
"""A connection with one snapshot of the database for the whole request."""
