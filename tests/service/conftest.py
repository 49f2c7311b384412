from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import Connection, Engine

from harness.databases import Databases
from tests.service.made_up_states import made_up_states, made_up_statics
from tests.service.own_library import store_own_library
from tests.service_app import service_app
from threadstate.library.engine import reader_engine, writer_engine
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import chunk_rows
from threadstate.library.write import open_library, publish, write_chunk
from threadstate.mesh.options import MeshOptions
from threadstate.settings import CACHE_MB, DATABASE, read_settings
from threadstate.state.model import Answer, ContactState
from threadstate.state.solve import SolveOptions, solve_poses
from threadstate.statics.rows import statics_by_ordinal
from threadstate.statics.stored import LibraryStateDocument, StoredStatics, library_state_document
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair

Solve = Callable[[Sequence[tuple[float, float, float]]], Sequence[Answer]]
MakeStatics = Callable[[int, Sequence[Answer]], dict[int, StoredStatics | None]]


@dataclass(frozen=True)
class StoredLibrary:
    """A library in a database: its URL, the library's number, its pair and grid, its states in order."""

    database: str
    id: int
    pair: Pair
    grid: Grid
    states: tuple[ContactState, ...]
    statics: Mapping[int, StoredStatics | None]

    def documents(self) -> list[LibraryStateDocument]:
        """The documents of its states, all of which are decided, in order."""
        return [library_state_document(state, self.statics.get(i)) for i, state in enumerate(self.states)]


def store_library(
    database: str,
    pair: Pair,
    grid: Grid,
    solve: Solve,
    mesh: MeshOptions | None = None,
    statics: MakeStatics = lambda _first, _answers: {},
) -> StoredLibrary:
    """Publish a library in a migrated database."""
    engine = writer_engine(database)
    library_id = open_library(engine, LibraryInputs(pair, grid, SolveOptions(), mesh))
    states: list[ContactState] = []
    of_states: dict[int, StoredStatics | None] = {}
    for index in range(grid.orientation_count):
        solved, first = solve(grid.poses(index)), grid.first_ordinal(index)
        found = statics(first, solved)
        write_chunk(engine, library_id, chunk_rows(grid.orientation(index), first, solved, found))
        of_states |= found
        states += [answer for answer in solved if isinstance(answer, ContactState)]
    publish(engine, library_id, grid)
    engine.dispose()
    return StoredLibrary(database, library_id, pair, grid, tuple(states), of_states)


@pytest.fixture(scope="session")
def made_up(databases: Databases) -> StoredLibrary:
    """A library of 108 made-up states, which have every class, flag, region and absence."""
    grid = Grid(1.0, 1.0, 30.0)
    return store_library(databases.migrated(), quarter_twenty_unc(), grid, made_up_states, statics=made_up_statics)


@pytest.fixture(scope="session")
def solved(databases: Databases) -> StoredLibrary:
    """A library of 90 states found by the exact solver: tilts of 0 and 4 deg, ten phases."""
    database = databases.migrated()
    pair = quarter_twenty_unc()
    return store_library(
        database,
        pair,
        Grid(4.0, 4.0, 36.0),
        lambda poses: solve_poses(pair, poses),
        statics=partial(statics_by_ordinal, pair),
    )


@pytest.fixture(scope="session")
def empty_database(databases: Databases) -> str:
    """A migrated database without a library."""
    return databases.migrated()


def client_of(database: str, *, cache_mb: int = 256) -> TestClient:
    """A client of a service over that database, which keeps up to so many megabytes of answers."""
    return TestClient(service_app(read_settings({DATABASE: database, CACHE_MB: str(cache_mb)})))


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


@pytest.fixture(scope="session")
def own_client(databases: Databases) -> Iterator[TestClient]:
    """A client of a service over a library of one's own pair, with tolerances of its own."""
    database = databases.migrated()
    store_own_library(database)
    with client_of(database) as client:
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
def missing_database(databases: Databases) -> str:
    """The URL of a database without a schema."""
    return databases.new()
