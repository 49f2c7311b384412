from __future__ import annotations

import math
import tracemalloc
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from sqlalchemy import Engine, Table, update

from harness.databases import Databases
from tests.library.states import plain_state
from tests.library.test_undecided import published as published_with_undecided
from tests.stored_histories.history_library import SMALL_GRID as GRID
from tests.stored_histories.history_library import store_histories
from threadstate.errors import NotFoundError
from threadstate.history.model import SolvedHistory
from threadstate.library import copying, write
from threadstate.library.copying import CopyError, copy_library
from threadstate.library.engine import reading, writing
from threadstate.library.grid import Grid
from threadstate.library.history_tables import history_interval
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import library_by_id, published_libraries
from threadstate.library.rows import chunk_rows
from threadstate.library.stored_chunk import stored_chunk
from threadstate.library.tables import contact, library
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

LIBRARY = 1


@pytest.fixture(scope="module")
def with_histories(databases: Databases, small_histories: list[SolvedHistory]) -> str:
    """A database with a library that has histories."""
    database = databases.migrated()
    store_histories(database, GRID, small_histories)
    return database


@dataclass(frozen=True)
class Way:
    source: Engine
    target: Engine


@pytest.fixture
def way(with_histories: str, databases: Databases, request: pytest.FixtureRequest) -> Iterator[Way]:
    """From the library with histories to an empty database of the other kind."""
    kinds: list[Databases] = [request.getfixturevalue(f"{kind}_databases") for kind in ("sqlite", "postgresql")]
    (other,) = (kind for kind in kinds if kind is not databases)
    with other.lent() as empty, reading(with_histories) as source, writing(empty) as target:
        yield Way(source, target)


def _published(engine: Engine) -> int:
    with engine.connect() as connection:
        return len(published_libraries(connection))


def _write_some(way: Way, indexes: range) -> int:
    """Begin a copy with some chunks, as one that was stopped has."""
    with way.source.connect() as connection:
        library_id = write.open_copy(way.target, library_by_id(connection, LIBRARY))
        for index in indexes:
            chunk = stored_chunk(connection, LIBRARY, GRID, index)
            assert write.write_chunk(way.target, library_id, chunk.rows, chunk.history)
    return library_id


def test_a_copy_is_the_same_to_the_last_bit(way: Way) -> None:
    copied = copy_library(way.source, way.target, LIBRARY)
    assert not copied.was_there
    assert copied.pose_count == GRID.pose_count
    with way.source.connect() as source, way.target.connect() as target:
        record = library_by_id(source, LIBRARY)
        there = library_by_id(target, copied.library_id)
        assert there.content_sha256 == copied.content_sha256 == record.content_sha256
        assert (there.input_sha256, there.created_at) == (record.input_sha256, record.created_at)
        for index in range(GRID.orientation_count):
            chunk = stored_chunk(source, LIBRARY, GRID, index)
            assert chunk.history is not None
            assert stored_chunk(target, copied.library_id, GRID, index) == chunk
    again = copy_library(way.source, way.target, LIBRARY)
    assert again.was_there
    assert again.library_id == copied.library_id


def test_undecided_poses_are_copied(databases: Databases) -> None:
    with databases.lent() as full, databases.lent() as empty, writing(full) as source, writing(empty) as target:
        library_id = published_with_undecided(source)
        copied = copy_library(source, target, library_id)
        with source.connect() as here, target.connect() as there:
            record = library_by_id(there, copied.library_id)
            assert record.undecided_count == library_by_id(here, library_id).undecided_count > 0
            for index in range(record.grid.orientation_count):
                assert stored_chunk(there, copied.library_id, record.grid, index) == stored_chunk(
                    here, library_id, record.grid, index
                )


def test_a_copy_that_was_stopped_is_gone_on_with(way: Way) -> None:
    library_id = _write_some(way, range(3, 6))
    assert copy_library(way.source, way.target, LIBRARY).library_id == library_id


def test_nothing_is_seen_before_the_proof(way: Way, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> str:
        assert _published(way.target) == 0
        raise KeyboardInterrupt

    monkeypatch.setattr(copying, "library_sha256", interrupted)
    with pytest.raises(KeyboardInterrupt):
        copy_library(way.source, way.target, LIBRARY)
    assert _published(way.target) == 0


@pytest.mark.parametrize(("table", "name"), [(contact, "nut_margin"), (history_interval, "end_deg")])
def test_one_bit_that_arrives_otherwise_is_found_and_nothing_is_left(way: Way, table: Table, name: str) -> None:
    _write_some(way, range(1))
    with way.target.begin() as connection:
        value = connection.scalar(table.select().with_only_columns(table.c[name]).limit(1))
        assert value is not None
        changed = connection.execute(
            update(table).where(table.c[name] == value).values({name: math.nextafter(value, math.inf)})
        )
        assert changed.rowcount >= 1
    with pytest.raises(CopyError, match="removed again"):
        copy_library(way.source, way.target, LIBRARY)
    with way.target.connect() as connection:
        assert connection.execute(library.select()).all() == []
    assert not copy_library(way.source, way.target, LIBRARY).was_there


def test_another_content_of_the_same_inputs_is_refused(way: Way) -> None:
    copy_library(way.source, way.target, LIBRARY)
    with way.target.begin() as connection:
        connection.execute(update(library).values(content_sha256="0" * 64))
    with pytest.raises(CopyError, match="same inputs"):
        copy_library(way.source, way.target, LIBRARY)


def test_what_is_not_published_is_not_copied(way: Way) -> None:
    with pytest.raises(NotFoundError):
        copy_library(way.source, way.target, LIBRARY + 1)


def _peak_bytes(databases: Databases, grid: Grid) -> int:
    """The most memory that copying a library of plain states takes."""
    with writing(databases.migrated()) as source, writing(databases.migrated()) as target:
        library_id = write.open_library(source, LibraryInputs(quarter_twenty_unc(), grid, SolveOptions()))
        for index in range(grid.orientation_count):
            states = [plain_state(*pose) for pose in grid.poses(index)]
            write.write_chunk(
                source, library_id, chunk_rows(grid.orientation(index), grid.first_ordinal(index), states)
            )
        write.publish(source, library_id, grid)
        tracemalloc.start()
        copy_library(source, target, library_id)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
    return peak


@pytest.mark.sqlite_alone
def test_memory_does_not_grow_with_the_number_of_orientations(databases: Databases) -> None:
    few, many = Grid(0.0, 1.0, 15.0), Grid(2.0, 1.0, 15.0)
    assert many.pose_count == 25 * few.pose_count
    _peak_bytes(databases, few)  # what is loaded and compiled once does not count
    assert _peak_bytes(databases, many) < 2 * _peak_bytes(databases, few)
