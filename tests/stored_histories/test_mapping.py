from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import pytest
from sqlalchemy import func, select

from harness.databases import Databases
from tests.stored_histories.history_library import SMALL_GRID as GRID
from tests.stored_histories.history_library import falls_at, rows_of, store_histories
from threadstate.history.model import SolvedHistory
from threadstate.history.window import windows_of
from threadstate.library.engine import reader_engine, writer_engine
from threadstate.library.history_tables import history_interval
from threadstate.library.identity import LibraryInputs
from threadstate.library.tables import library
from threadstate.library.write import open_library
from threadstate.network.formation import formation_of
from threadstate.network.from_history import smallest_margin
from threadstate.state.solve import SolveOptions
from threadstate.stored_histories.mapping import formations, orientation_history, stored_histories
from threadstate.stored_histories.model import StoredHistories
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
INPUTS = LibraryInputs(PAIR, GRID, SolveOptions())


@pytest.fixture
def histories(small_histories: list[SolvedHistory]) -> list[SolvedHistory]:
    return small_histories


@pytest.fixture(scope="module")
def database(small_histories: list[SolvedHistory], databases: Databases) -> str:
    url = databases.migrated()
    store_histories(url, GRID, small_histories)
    return url


@pytest.fixture
def stored(database: str) -> Iterator[StoredHistories]:
    engine = reader_engine(database)
    with engine.connect() as connection:
        found = stored_histories(connection, 1, GRID)
    engine.dispose()
    assert found is not None
    yield found


def test_a_history_is_read_back_as_it_was(stored: StoredHistories, histories: list[SolvedHistory]) -> None:
    for number, history in enumerate(histories):
        kept = stored.orientations[number]
        assert stored.tilt_deg(number) == (history.roll_deg, history.pitch_deg)
        assert [(cell.start_deg, cell.end_deg) for cell in kept.cells] == [
            (one.start_deg, one.end_deg) for one in history.intervals
        ]
        assert [cell.formation for cell in kept.cells] == [formation_of(one.labels) for one in history.intervals]
        assert [cell.flags for cell in kept.cells] == [one.labels.flags for one in history.intervals]
        assert [cell.margin for cell in kept.cells] == [smallest_margin(one.state) for one in history.intervals]
        assert kept.windows == windows_of(PAIR, history)
        assert kept.falls == falls_at(history.roll_deg, history.pitch_deg)


def test_a_boundary_keeps_both_sides(stored: StoredHistories, histories: list[SolvedHistory]) -> None:
    for kept, history in zip(stored.orientations, histories, strict=True):
        for one, boundary in zip(kept.boundaries, history.boundaries, strict=True):
            assert (one.low_deg, one.high_deg, one.phase_deg) == (
                boundary.low_deg,
                boundary.high_deg,
                boundary.phase_deg,
            )
            if boundary.before is not None and boundary.after is not None:
                assert one.first_height_before == boundary.before.poses[0].translation[2]
                assert one.last_height_after == boundary.after.poses[-1].translation[2]
            assert [(c.stage, c.place, c.before, c.after, c.moved) for c in one.changes] == [
                (c.stage, c.place, c.before, c.after, c.moved) for c in boundary.changes
            ]
            for change in one.changes:
                for labels, normal in ((change.before, change.normal_before), (change.after, change.normal_after)):
                    assert (labels is None) == (normal is None)
                    assert normal is None or math.hypot(*normal) == pytest.approx(1.0, abs=1e-12)


def test_the_window_is_marked_on_its_intervals(stored: StoredHistories) -> None:
    for history in stored.orientations:
        for cell in history.cells:
            middle = 0.5 * (cell.start_deg + cell.end_deg)
            inside = [
                window
                for window in history.windows
                if any(window.enter_deg <= middle + turn <= window.leave_deg for turn in (-360.0, 0.0, 360.0))
            ]
            assert cell.in_window == bool(inside)
        assert any(cell.in_window for cell in history.cells) == bool(history.windows)


def test_the_hash_of_a_history_knows_every_number(histories: list[SolvedHistory]) -> None:
    history = histories[1]
    rows = rows_of(history)
    assert rows_of(histories[1]).content_sha256 == rows.content_sha256
    first, *others = rows.intervals
    changed = (first[0], math.nextafter(first[1], 400.0), *first[2:])
    variants = [
        rows,
        replace(rows, intervals=(changed, *others)),
        replace(rows, windows=()),
        replace(rows, descents=()),
        replace(rows, steepest_fall=((0.0, None, None),)),
        replace(rows, boundary_contacts=rows.boundary_contacts[1:]),
        replace(rows, formations=rows.formations[1:]),
    ]
    assert len({one.content_sha256 for one in variants}) == len(variants)


def test_rows_alone_give_the_history(histories: list[SolvedHistory], stored: StoredHistories) -> None:
    rows = rows_of(histories[2])
    assert orientation_history(2, rows, formations(rows.formations)) == stored.orientations[2]


def test_a_library_without_histories_has_none(databases: Databases) -> None:
    engine = writer_engine(databases.migrated())
    library_id = open_library(engine, INPUTS)
    with engine.connect() as connection:
        assert stored_histories(connection, library_id, GRID) is None
    engine.dispose()


def test_removing_a_library_removes_its_histories(database: str) -> None:
    engine = writer_engine(database)
    with engine.connect() as connection:
        assert connection.scalar(select(func.count()).select_from(history_interval))
        connection.execute(library.delete())
        assert connection.scalar(select(func.count()).select_from(history_interval)) == 0
        connection.rollback()
    engine.dispose()
