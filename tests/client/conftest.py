from __future__ import annotations

from collections.abc import Iterator

import pytest

from harness.databases import Databases
from service.app import create_app
from tests.service.conftest import store_library
from tests.service.made_up_states import made_up_states
from tests.service.settled_library import store_settled
from tests.service.success_map import store_success_map
from tests.service_thread import service_thread
from tests.stored_histories.history_library import SMALL_GRID, store_histories
from threadstate.client import Client
from threadstate.history.model import SolvedHistory
from threadstate.library.grid import Grid
from threadstate.settings import read_settings
from threadstate.thread.catalogue import quarter_twenty_unc

MADE_UP_GRID = Grid(1.0, 1.0, 30.0)


@pytest.fixture(scope="session")
def made_up_id() -> int:
    """Number of the library of made-up states, which have every class, flag, region and absence."""
    return 1


@pytest.fixture(scope="session")
def database(sqlite_databases: Databases, small_histories: list[SolvedHistory], made_up_id: int) -> str:
    """A database with a library of made-up states, the latest one of real histories, one of settled states, and a
    success map.
    """
    database = sqlite_databases.migrated()
    made_up = store_library(database, quarter_twenty_unc(), MADE_UP_GRID, made_up_states)
    assert made_up.id == made_up_id
    store_histories(database, SMALL_GRID, small_histories)
    store_settled(database)
    store_success_map(database)
    return database


@pytest.fixture(scope="session")
def address(database: str) -> Iterator[str]:
    """The address of a service over that database."""
    with service_thread(database) as address:
        yield address


@pytest.fixture(scope="session")
def client(address: str) -> Iterator[Client]:
    """A client of that service."""
    with Client(address) as client:
        yield client


@pytest.fixture(scope="session")
def openapi(database: str) -> dict[str, object]:
    """What the service says of itself."""
    return create_app(read_settings({"THREADSTATE_DATABASE": database})).openapi()
