from __future__ import annotations

from collections.abc import Iterator

import pytest
from sqlalchemy import Engine

from harness.databases import Databases
from threadstate.library.engine import writing


@pytest.fixture
def engine(databases: Databases) -> Iterator[Engine]:
    """An engine of a migrated, empty database that may write."""
    with databases.lent() as database, writing(database) as engine:
        yield engine
