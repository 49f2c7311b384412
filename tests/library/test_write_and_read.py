from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import Engine, func, select
from sqlalchemy.exc import DBAPIError

from harness.databases import Databases
from tests.library.states import orientation_states, plain_state
from threadstate.errors import NotFoundError
from threadstate.library import read, write
from threadstate.library.engine import reader_engine, writer_engine, writing
from threadstate.library.fingerprint import answers_sha256, library_sha256
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.pose import state_of_pose
from threadstate.library.rows import ChunkRows, chunk_rows
from threadstate.library.tables import state
from threadstate.state.model import ContactState, Flag, StateClass
from threadstate.state.solve import SolveOptions
from threadstate.tables import metadata
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.units import LengthUnit
from worker.migrate import migrate

GRID = Grid(1.0, 1.0, 120.0)
INPUTS = LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions())


def _states(index: int) -> list[ContactState]:
    return [plain_state(*pose) for pose in GRID.poses(index)]


def _chunk(index: int) -> ChunkRows:
    return chunk_rows(GRID.orientation(index), GRID.first_ordinal(index), _states(index))


def _published(writer: Engine) -> int:
    library_id = write.open_library(writer, INPUTS)
    for index in range(GRID.orientation_count):
        write.write_chunk(writer, library_id, _chunk(index))
    write.publish(writer, library_id, GRID)
    return library_id


def _row_counts(engine: Engine) -> dict[str, int]:
    with engine.connect() as connection:
        return {
            table.name: connection.scalar(select(func.count()).select_from(table)) or 0
            for table in metadata.sorted_tables
        }


@dataclass(frozen=True)
class Bits:
    writer: Engine
    reader: Engine


@pytest.fixture(scope="module")
def bits(databases: Databases) -> Iterator[Bits]:
    """Engines of a database that every example of a test leaves empty."""
    database = databases.migrated()
    engines = Bits(writer_engine(database), reader_engine(database))
    yield engines
    engines.writer.dispose()
    engines.reader.dispose()


def _remove_libraries(writer: Engine) -> None:
    with writer.begin() as connection:
        connection.execute(metadata.tables["library"].delete())


@given(st.data())
def test_states_are_read_back_bit_by_bit(bits: Bits, data: st.DataObject) -> None:
    grid = Grid(0.0, 1.0, 180.0)
    inputs = replace(INPUTS, grid=grid)
    states = data.draw(orientation_states(grid, 0))
    library_id = write.open_library(bits.writer, inputs)
    rows = chunk_rows(grid.orientation(0), 0, states)
    write.write_chunk(bits.writer, library_id, rows)
    content_sha256 = write.publish(bits.writer, library_id, grid)
    with bits.reader.connect() as connection:
        stored = read.states_between(connection, library_id, 0, grid.pose_count - 1)
        at_second = read.states_at(connection, library_id, [1, 0])
    _remove_libraries(bits.writer)
    assert stored == states
    # Equality is blind to the last bit of nothing but zeros; the hash looks at every bit.
    assert answers_sha256(stored) == rows.content_sha256
    assert content_sha256 == library_sha256([answers_sha256(states)])
    assert at_second == [states[1], states[0]]


def test_a_library_is_not_seen_before_it_is_whole(writer: Engine, reader: Engine) -> None:
    library_id = write.open_library(writer, INPUTS)
    for index in range(GRID.orientation_count):
        with reader.connect() as connection:
            assert read.published_libraries(connection) == []
            assert read.library_by_input(connection, INPUTS.sha256) is None
            with pytest.raises(NotFoundError):
                read.latest_library(connection)
            with pytest.raises(NotFoundError):
                read.library_by_id(connection, library_id)
        if index:
            with pytest.raises(write.IncompleteLibraryError):
                write.publish(writer, library_id, GRID)
        write.write_chunk(writer, library_id, _chunk(index))
    content_sha256 = write.publish(writer, library_id, GRID)
    with reader.connect() as connection:
        record = read.latest_library(connection, INPUTS.pair.designation)
        assert read.library_by_id(connection, library_id) == record
        assert read.library_by_input(connection, INPUTS.sha256) == record
        assert read.published_libraries(connection) == [record]
    assert record.content_sha256 == content_sha256
    assert record.length_unit is LengthUnit.INCH
    assert record.grid == GRID
    assert record.published_at >= record.created_at


def test_a_reader_keeps_its_view_while_a_library_is_published(writer: Engine, reader: Engine) -> None:
    with reader.connect() as connection:
        assert read.published_libraries(connection) == []
        _published(writer)
        assert read.published_libraries(connection) == []
    with reader.connect() as connection:
        assert len(read.published_libraries(connection)) == 1


def test_the_content_does_not_depend_on_the_order_of_writing(writer: Engine) -> None:
    library_id = write.open_library(writer, INPUTS)
    for index in reversed(range(GRID.orientation_count)):
        assert write.write_chunk(writer, library_id, _chunk(index))
    expected = library_sha256([answers_sha256(_states(index)) for index in range(GRID.orientation_count)])
    assert write.publish(writer, library_id, GRID) == expected


def test_everything_may_be_done_twice(writer: Engine) -> None:
    library_id = _published(writer)
    before = _row_counts(writer)
    assert write.open_library(writer, INPUTS) == library_id
    assert not write.write_chunk(writer, library_id, _chunk(4))
    with writer.connect() as connection:
        record = read.library_by_id(connection, library_id)
    assert write.publish(writer, library_id, GRID) == record.content_sha256
    with writer.connect() as connection:
        assert read.library_by_id(connection, library_id) == record
    assert _row_counts(writer) == before


def test_many_at_once_open_one_library_and_write_each_chunk_once(database: str) -> None:
    def opened_and_written(order: int) -> tuple[int, int]:
        with writing(database) as engine:
            library_id = write.open_library(engine, INPUTS)
            indexes = range(GRID.orientation_count)[::order]
            return library_id, sum(write.write_chunk(engine, library_id, _chunk(index)) for index in indexes)

    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(opened_and_written, (1, -1, 1, -1)))
    assert len({library_id for library_id, _ in results}) == 1
    assert sum(written for _, written in results) == GRID.orientation_count


def test_a_chunk_that_cannot_be_written_leaves_nothing_behind(writer: Engine) -> None:
    library_id = write.open_library(writer, INPUTS)
    before = _row_counts(writer)
    chunk = _chunk(0)
    broken = replace(chunk, flags=(*chunk.flags, (0, 9, "no such flag")))
    with pytest.raises(DBAPIError, match="flag_known"):
        write.write_chunk(writer, library_id, broken)
    assert _row_counts(writer) == before
    assert write.committed_orientations(writer, library_id) == frozenset()


def test_other_inputs_make_a_library_beside_the_old(writer: Engine, reader: Engine) -> None:
    first = _published(writer)
    other = replace(INPUTS, options=replace(INPUTS.options, quasi_stable_fraction=0.2))
    second = write.open_library(writer, other)
    assert second != first
    with reader.connect() as connection:
        assert read.latest_library(connection).id == first
    for index in range(GRID.orientation_count):
        write.write_chunk(writer, second, _chunk(index))
    write.publish(writer, second, GRID)
    with reader.connect() as connection:
        assert read.latest_library(connection).id == second
        assert [record.id for record in read.published_libraries(connection)] == [second, first]


def test_a_state_is_found_by_its_pose(writer: Engine, reader: Engine) -> None:
    library_id = _published(writer)
    with reader.connect() as connection:
        assert state_of_pose(connection, library_id, 1.0, -1.0, 240.0) == plain_state(1.0, -1.0, 240.0)
        with pytest.raises(NotFoundError, match="roll 1, pitch -1, phase 241"):
            state_of_pose(connection, library_id, 1.0, -1.0, 241.0)
        with pytest.raises(NotFoundError, match="no state 27"):
            read.states_at(connection, library_id, [0, 27])


def test_every_class_and_flag_is_counted(writer: Engine, reader: Engine) -> None:
    library_id = _published(writer)
    with reader.connect() as connection:
        counted = read.counts(connection, library_id)
    assert dict(counted.of_class) == {name: 27 * (name is StateClass.STABLE_THREE_POINT) for name in StateClass}
    assert dict(counted.of_flag) == {name: 27 * (name is Flag.TIE) for name in Flag}


def test_a_reader_cannot_write(reader: Engine) -> None:
    with reader.connect() as connection, pytest.raises(DBAPIError, match=r"read-?only"):
        connection.execute(state.delete())


def test_removing_a_library_removes_all_its_rows(writer: Engine) -> None:
    library_id = _published(writer)
    with writer.begin() as connection:
        library = metadata.tables["library"]
        connection.execute(library.delete().where(library.c.id == library_id))
    assert set(_row_counts(writer).values()) == {0}


@pytest.mark.sqlite_alone
def test_a_killed_writer_leaves_the_last_committed_chunk(database: str) -> None:
    """What was not committed when the file was copied, as after a power cut, is not there."""
    engine = writer_engine(database)
    library_id = write.open_library(engine, INPUTS)
    write.write_chunk(engine, library_id, _chunk(0))
    path = Path(str(engine.url.database))
    with engine.begin() as connection:
        connection.execute(state.delete())
        for suffix in ("", "-wal"):
            part = Path(f"{path}{suffix}")
            part.with_name(f"copy.sqlite3{suffix}").write_bytes(part.read_bytes())
        connection.rollback()
    engine.dispose()
    copy = sqlite3.connect(path.with_name("copy.sqlite3"))
    assert copy.execute("SELECT count(*) FROM state").fetchone() == (3,)
    assert copy.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    copy.close()


def test_migrated_tables_hold_a_library(tmp_path: Path) -> None:
    engine = writer_engine(f"sqlite:///{tmp_path / 'deep' / 'er' / 'threads.sqlite3'}")
    migrate(engine)
    assert _published(engine) == 1
    engine.dispose()
