from __future__ import annotations

from collections.abc import Iterator

import pytest
from sqlalchemy import Engine

from harness.databases import Databases
from threadstate.library.engine import reader_engine, writer_engine


@pytest.fixture
def database(databases: Databases) -> Iterator[str]:
    """The URL of a migrated, empty database."""
    with databases.lent() as url:
        yield url


@pytest.fixture
def writer(database: str) -> Iterator[Engine]:
    engine = writer_engine(database)
    yield engine
    engine.dispose()


@pytest.fixture
def reader(database: str) -> Iterator[Engine]:
    engine = reader_engine(database)
    yield engine
    engine.dispose()
