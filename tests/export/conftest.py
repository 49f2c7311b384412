from __future__ import annotations

from collections.abc import Iterator

import pytest
from sqlalchemy import Engine

from harness.databases import Databases
from tests.service.conftest import store_library
from tests.service.made_up_states import made_up_states
from tests.stored_histories.history_library import SMALL_GRID, store_histories
from threadstate.history.model import SolvedHistory
from threadstate.library.engine import reading, writing
from threadstate.library.grid import Grid
from threadstate.library.read import LibraryRecord, library_by_id
from threadstate.thread.catalogue import quarter_twenty_unc


@pytest.fixture(scope="session")
def exported_database(databases: Databases, small_histories: list[SolvedHistory]) -> str:
    """A database with a library of made-up states, number 1, and one of real histories, number 2."""
    database = databases.migrated()
    store_library(database, quarter_twenty_unc(), Grid(1.0, 1.0, 30.0), made_up_states)
    store_histories(database, SMALL_GRID, small_histories)
    return database


@pytest.fixture
def engine(exported_database: str) -> Iterator[Engine]:
    """An engine that reads that database."""
    with reading(exported_database) as engine:
        yield engine


def record(engine: Engine, library_id: int) -> LibraryRecord:
    """A published library."""
    with engine.connect() as connection:
        return library_by_id(connection, library_id)


@pytest.fixture
def one_library(databases: Databases) -> Iterator[tuple[Engine, LibraryRecord]]:
    """An engine that may write, and a library of its own."""
    database = databases.migrated()
    made = store_library(database, quarter_twenty_unc(), Grid(1.0, 1.0, 3.0), made_up_states)
    with writing(database) as engine:
        yield engine, record(engine, made.id)
