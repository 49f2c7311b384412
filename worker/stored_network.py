"""A library by its name, and its network, for the commands that ask about it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import Connection

from threadstate.library.engine import reading
from threadstate.library.named import LATEST, named_library
from threadstate.library.read import LibraryRecord
from threadstate.library.schema import check_schema
from threadstate.responses.library_network import LibraryNetwork, library_network
from threadstate.settings import read_settings


@contextmanager
def connected_library(database: str | None, name: str | None) -> Iterator[tuple[Connection, LibraryRecord]]:
    """The library of a name (None: ``latest``), with the connection that it was read by.

    Raises:
        SchemaError: the database is at another revision.
        NotFoundError: no such library is published.
    """
    with reading(database or read_settings().database) as engine:
        check_schema(engine)
        with engine.connect() as connection:
            yield connection, named_library(connection, LATEST if name is None else name)


def checked_database(database: str) -> None:
    """Check that a database is there and at this code's schema, before something opens it that would make it.

    Raises:
        SchemaError: it is not.
    """
    with reading(database) as engine:
        check_schema(engine)


def stored_network(database: str | None, name: str | None = None) -> LibraryNetwork:
    """The histories and the network of the library of a name (None: ``latest``).

    Raises:
        SchemaError: the database is at another revision.
        NotFoundError: no such library is published, or it has no histories.
    """
    with connected_library(database, name) as (connection, record):
        return library_network(connection, record)
