from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from sqlalchemy import func, select

import benchmarks.scale.growing
from benchmarks.scale.computing import committed
from benchmarks.scale.figures import Committed, Computed, Copied, Figures, Grown, Room
from benchmarks.scale.growing import grown, rooms
from benchmarks.scale.page import dollars, hours, short, write_page
from benchmarks.scale.plan import bytes_of, steps
from harness.databases import Databases
from threadstate.library.engine import writing
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import published_libraries
from threadstate.library.tables import chunk, contact, state
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.compute import compute_library_chunk
from worker.rebuild import rebuild
from worker.sweep.estimate import POSTGRESQL_BYTES_A_ROW, POSTGRESQL_S_A_ROW, SQLITE_BYTES_A_ROW, SQLITE_S_A_ROW

GRID = Grid(0.0, 1.0, 15.0)
INPUTS = LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions())


class _Unwatched:
    def begin(self, committed: int, total: int) -> None: ...

    def ready(self) -> None: ...

    def advance(self, poses: int) -> None: ...


@pytest.fixture(scope="module")
def figures(repository_root: Path) -> Figures:
    """The figures that the page was made from."""
    said = json.loads((repository_root / "docs/scale.json").read_text())
    return Figures(
        [Computed(**one) for one in said["computed"]],
        [Committed(**one) for one in said["committed"]],
        [Grown(**one) for one in said["grown"]],
        [Room(**one) for one in said["rooms"]],
        [Copied(**one) for one in said["copied"]],
        said["parquet_bytes_a_state"],
        said["flush_ms"],
        said["network_s"],
    )


def test_the_pages_tables_are_those_of_its_figures(figures: Figures, repository_root: Path, tmp_path: Path) -> None:
    page = repository_root / "docs/scale.md"
    written = tmp_path / "scale.md"
    shutil.copy(page, written)
    write_page(figures, written)
    assert written.read_text() == page.read_text()


def test_the_plan_ends_with_the_catalogue(figures: Figures) -> None:
    today, *_, catalogue = steps(figures)
    assert (today.states, catalogue.states) == (29_160, 10_000 * 81**2 * 3_600)
    assert catalogue.core_hours == pytest.approx(10_000 * 6_561 * figures.computed[-1].seconds / 3_600)
    for database in ("SQLite", "PostgreSQL"):
        whole = sum(bytes_of(figures, database, today, histories=histories) for histories in (False, True))
        (one,) = (grown for grown in figures.grown if (grown.database, grown.libraries) == (database, 9))
        assert whole == pytest.approx(one.bytes / 9, rel=0.15)


@pytest.mark.parametrize(
    ("database", "bytes_a_row", "a_row_s"),
    [
        ("SQLite", SQLITE_BYTES_A_ROW, SQLITE_S_A_ROW),
        ("PostgreSQL", POSTGRESQL_BYTES_A_ROW, POSTGRESQL_S_A_ROW),
    ],
)
def test_estimates_of_sweeps_stand_on_the_figures(
    figures: Figures, database: str, bytes_a_row: float, a_row_s: float
) -> None:
    of_library = figures.computed[0]
    largest = max((one for one in figures.grown if one.database == database), key=lambda one: one.libraries)
    assert largest.bytes / largest.states / of_library.rows * of_library.poses == pytest.approx(bytes_a_row, rel=0.1)
    found = next(one for one in figures.committed if one.database == database)
    assert found.phase_step_deg == of_library.phase_step_deg
    assert found.seconds / of_library.rows == pytest.approx(a_row_s, rel=0.5)


def test_a_database_grows_by_whole_libraries(databases: Databases, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(benchmarks.scale.growing, "SIZES", (1, 3))
    with databases.lent() as database, writing(database) as engine:
        rebuild(engine, INPUTS, 1, _Unwatched())
        one, three = grown(engine, "this")
        sizes = {room.table: room for room in rooms(engine, "this")}
        with engine.connect() as connection:
            assert len({library.content_sha256 for library in published_libraries(connection)}) == 1
            assert len(published_libraries(connection)) == 3
            contacts = connection.scalar(select(func.count()).select_from(contact)) or 0
    assert (one.states, three.states) == (GRID.pose_count, 3 * GRID.pose_count)
    assert three.bytes >= one.bytes > 0
    assert sizes["contact"].rows_each == contacts / three.states
    assert sizes["contact"].table_bytes > 0
    assert sizes["state"].index_bytes > 0


def test_chunks_are_committed_to_a_library_of_their_own(databases: Databases) -> None:
    with databases.lent() as database, writing(database) as engine:
        found = committed(engine, "this", Grid(1.0, 1.0, 90.0), [compute_library_chunk(INPUTS, 0)])
        with engine.connect() as connection:
            counts = [connection.scalar(select(func.count()).select_from(table)) for table in (chunk, state)]
    assert counts == [1, GRID.pose_count]
    assert found.here_s > 0.0
    assert (found.server_s > 0.0) == (engine.dialect.name == "postgresql")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (short(999.4), "999 B"),
        (short(999.6), "1 kB"),
        (short(2.36e11, unit=""), "236 G"),
        (hours(0.5), "30.0 min"),
        (hours(99.94), "99.9 h"),
        (hours(14_582.0), "14,582 h"),
        (dollars(0.2), "<$1"),
        (dollars(26_345.0), "$26,000"),
    ],
)
def test_large_numbers_are_short(text: str, expected: str) -> None:
    assert text == expected
