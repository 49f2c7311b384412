from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from sqlalchemy import Engine

from threadstate.library.engine import reader_engine, writer_engine
from worker.migrate import migrate


@pytest.fixture
def database(tmp_path: Path) -> str:
    """The URL of a migrated, empty database; made through the migrations, as a user's is."""
    url = f"sqlite:///{tmp_path / 'threads.sqlite3'}"
    engine = writer_engine(url)
    migrate(engine)
    engine.dispose()
    return url


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
