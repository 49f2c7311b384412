"""The network of the latest library, for the commands that ask about it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import Connection

from threadstate.answer.library_network import LibraryNetwork, library_network
from threadstate.library.engine import reading
from threadstate.library.read import latest_library
from threadstate.library.schema import check_schema
from threadstate.settings import read_settings


def stored_network(database: str | None) -> LibraryNetwork:
    """The histories and the network of the latest library by the exact method.

    Raises:
        SchemaError: the database is at another revision.
        NotFoundError: no library is published.
    """
    with connected_network(database) as (_, network):
        return network


@contextmanager
def connected_network(database: str | None) -> Iterator[tuple[Connection, LibraryNetwork]]:
    """As :func:`stored_network`, with the connection that it was read by."""
    with reading(database or read_settings().database) as engine:
        check_schema(engine)
        with engine.connect() as connection:
            yield connection, library_network(connection, latest_library(connection))
