from __future__ import annotations

from collections.abc import Iterator

import pytest
from sqlalchemy import Connection

from harness.databases import Databases
from tests.stored_histories.history_library import SMALL_GRID, store_histories
from threadstate.history.model import SolvedHistory
from threadstate.library.engine import reader_engine
from threadstate.library.read import library_by_id
from threadstate.responses.library_network import LibraryNetwork, library_network


@pytest.fixture(scope="module")
def database(sqlite_databases: Databases, small_histories: list[SolvedHistory]) -> str:
    """A database with a library of nine orientations."""
    url = sqlite_databases.migrated()
    store_histories(url, SMALL_GRID, small_histories)
    return url


@pytest.fixture
def connection(database: str) -> Iterator[Connection]:
    """A reader of it."""
    engine = reader_engine(database)
    with engine.connect() as connection:
        yield connection
    engine.dispose()


@pytest.fixture
def network(connection: Connection) -> LibraryNetwork:
    """The library's network, of which nothing was asked yet."""
    return library_network(connection, library_by_id(connection, 1))
