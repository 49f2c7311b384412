from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

import pytest
from sqlalchemy import Engine, create_engine, event

from harness.databases import SqliteDatabases
from tests.prepared import use_prepared_chunks
from tests.stored_histories.history_library import content_of
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import published_libraries
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.jobs.serve import WorkerOptions

GRID = Grid(tilt_max_deg=3.0, tilt_step_deg=3.0, phase_step_deg=30.0)
INPUTS = LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions())
SERVING = WorkerOptions(processes=1, scheduler=None, lease_s=20.0, heartbeat_file=None)
GRID_OPTIONS = ("--tilt-max", "3", "--tilt-step", "3", "--phase-step", "30")


class Unwatched:
    """Nobody watches a rebuild."""

    def begin(self, committed: int, total: int) -> None: ...

    def ready(self) -> None: ...

    def advance(self, poses: int) -> None: ...


def published(engine: Engine) -> list[str]:
    """The content hashes of what is seen."""
    with engine.connect() as connection:
        return [library.content_sha256 for library in published_libraries(connection)]


@contextmanager
def holding(database: str) -> Iterator[None]:
    """Another process's transaction, which holds a SQLite file."""
    engine = create_engine(database, isolation_level=None)
    event.listen(engine, "begin", lambda connection: connection.exec_driver_sql("BEGIN EXCLUSIVE"))
    with engine.connect() as connection, connection.begin():
        yield
    engine.dispose()


@pytest.fixture(autouse=True)
def _prepared_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    use_prepared_chunks(monkeypatch)


@pytest.fixture(scope="session")
def expected_content() -> str:
    """The content hash of the small library where nothing fails."""
    return content_of(GRID)


@pytest.fixture
def sqlite_database(sqlite_databases: SqliteDatabases) -> str:
    """A migrated SQLite file."""
    return sqlite_databases.migrated()


@pytest.fixture
def environment_of_commands(repository_root: Path) -> Mapping[str, str]:
    """The environment of commands; this source tree goes before anything installed."""
    return {**os.environ, "PYTHONPATH": str(repository_root)}
