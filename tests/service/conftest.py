from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import Connection, Engine

from service.app import create_app
from tests.service.made_up_states import made_up_states
from threadstate.library.engine import reader_engine, writer_engine
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import chunk_rows
from threadstate.library.write import open_library, publish, write_chunk
from threadstate.mesh.options import MeshOptions
from threadstate.settings import read_settings
from threadstate.state.model import Answer, ContactState
from threadstate.state.solve import SolveOptions, solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair
from worker.migrate import migrate

Solve = Callable[[Sequence[tuple[float, float, float]]], Sequence[Answer]]


@dataclass(frozen=True)
class StoredLibrary:
    """A library in a database: its URL, the library's number, its pair and grid, its states in order."""

    database: str
    id: int
    pair: Pair
    grid: Grid
    states: tuple[ContactState, ...]


def store_library(
    database: str, pair: Pair, grid: Grid, solve: Solve, mesh: MeshOptions | None = None
) -> StoredLibrary:
    """Migrate the database and publish a library in it."""
    engine = writer_engine(database)
    migrate(engine)
    library_id = open_library(engine, LibraryInputs(pair, grid, SolveOptions(), mesh))
    states: list[ContactState] = []
    for index in range(grid.orientation_count):
        solved = solve(grid.poses(index))
        write_chunk(engine, library_id, chunk_rows(grid.orientation(index), grid.first_ordinal(index), solved))
        states += [answer for answer in solved if isinstance(answer, ContactState)]
    publish(engine, library_id, grid)
    engine.dispose()
    return StoredLibrary(database, library_id, pair, grid, tuple(states))


@pytest.fixture(scope="session")
def made_up(tmp_path_factory: pytest.TempPathFactory) -> StoredLibrary:
    """A library of 108 made-up states, which have every class, flag, region and absence."""
    database = f"sqlite:///{tmp_path_factory.mktemp('made_up') / 'library.sqlite3'}"
    return store_library(database, quarter_twenty_unc(), Grid(1.0, 1.0, 30.0), made_up_states)


@pytest.fixture(scope="session")
def solved(tmp_path_factory: pytest.TempPathFactory) -> StoredLibrary:
    """A library of 90 states found by the exact solver: tilts of 0 and 4 deg, ten phases."""
    database = f"sqlite:///{tmp_path_factory.mktemp('solved') / 'library.sqlite3'}"
    pair = quarter_twenty_unc()
    return store_library(database, pair, Grid(4.0, 4.0, 36.0), lambda poses: solve_poses(pair, poses))


def migrated_database(folder: Path) -> str:
    """The URL of a new database in that folder, migrated and without a library."""
    database = f"sqlite:///{folder / 'library.sqlite3'}"
    engine = writer_engine(database)
    migrate(engine)
    engine.dispose()
    return database


@pytest.fixture(scope="session")
def empty_database(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A migrated database without a library."""
    return migrated_database(tmp_path_factory.mktemp("empty"))


def client_of(database: str) -> TestClient:
    """A client of a service over that database."""
    return TestClient(create_app(read_settings({"THREADSTATE_DATABASE": database})))


@pytest.fixture(scope="session")
def client(made_up: StoredLibrary) -> Iterator[TestClient]:
    """A client of a service over the made-up library."""
    with client_of(made_up.database) as client:
        yield client


@pytest.fixture(scope="session")
def solved_client(solved: StoredLibrary) -> Iterator[TestClient]:
    """A client of a service over the library found by the exact solver."""
    with client_of(solved.database) as client:
        yield client


@pytest.fixture
def engine(made_up: StoredLibrary) -> Iterator[Engine]:
    """An engine that reads the made-up library."""
    engine = reader_engine(made_up.database)
    yield engine
    engine.dispose()


@pytest.fixture
def connection(engine: Engine) -> Iterator[Connection]:
    """A connection that reads the made-up library."""
    with engine.connect() as connection:
        yield connection


@pytest.fixture
def missing_database(tmp_path: Path) -> str:
    """The URL of a database that does not exist."""
    return f"sqlite:///{tmp_path / 'missing.sqlite3'}"
