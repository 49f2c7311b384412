"""Histories against states that are solved one by one, from outside."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from studies.history.boundaries import check_boundaries
from threadstate.history import records
from threadstate.history.build import RESOLUTION, histories_of, history_of
from threadstate.history.labels import Labels, labels_of
from threadstate.history.model import POINT_DEG, Boundary, Interval, SolvedHistory
from threadstate.history.records import RecordStore
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
BESIDE_DEG = 1e-5
ORIENTATIONS = [(0.0, -4.0), (3.0, 3.0), *np.random.default_rng(71).uniform(-4.0, 4.0, (2, 2)).tolist()]


@pytest.fixture(scope="module")
def histories() -> list[SolvedHistory]:
    return histories_of(PAIR, [(roll, pitch) for roll, pitch in ORIENTATIONS])


def labels_at(history: SolvedHistory, phases_deg: list[float]) -> list[Labels]:
    """The labels of states that are solved at phases."""
    poses = [(history.roll_deg, history.pitch_deg, phase) for phase in phases_deg]
    return [labels_of(state) for state in solve_poses(PAIR, poses)]


def with_sides(history: SolvedHistory) -> list[tuple[Interval, Boundary, Interval]]:
    """Every boundary between the interval before it and the one after it."""
    earlier = history.intervals[-1:] + history.intervals[:-1]
    return list(zip(earlier, history.boundaries, history.intervals, strict=True))


def test_intervals_cover_the_circle_once(histories: list[SolvedHistory]) -> None:
    for history in histories:
        assert len(history.intervals) == len(history.boundaries) > 1
        for one, following in pairwise(history.intervals):
            assert one.end_deg == following.start_deg
        assert history.intervals[-1].end_deg == history.intervals[0].start_deg + 360.0
        assert 0.0 <= history.intervals[0].start_deg < 360.0
        assert all(interval.width_deg > 0.0 for interval in history.intervals)


def test_every_boundary_is_narrow_and_bracketed_by_solved_states(histories: list[SolvedHistory]) -> None:
    for history in histories:
        for before, boundary, after in with_sides(history):
            for state, phase, interval in (
                (boundary.before, boundary.low_deg, before),
                (boundary.after, boundary.high_deg, after),
            ):
                assert labels_of(state) == interval.labels
                if state is not None:
                    assert state == solve_pose(PAIR, history.roll_deg, history.pitch_deg, phase % 360.0)
            if boundary.before is not None and boundary.after is not None:
                assert boundary.width_deg <= POINT_DEG


def test_labels_differ_across_a_boundary(histories: list[SolvedHistory]) -> None:
    for history in histories:
        for before, boundary, after in with_sides(history):
            moved = any(change.moved for change in boundary.changes)
            assert before.labels != after.labels or boundary.through or moved or boundary.last_height_jump


def test_labels_agree_within_intervals(histories: list[SolvedHistory]) -> None:
    compared = 0
    for history in histories:
        opening = history.boundaries
        closing = (*opening[1:], opening[0])
        for interval, begins, ends in zip(history.intervals, opening, closing, strict=True):
            start = interval.start_deg + 0.5 * begins.width_deg + BESIDE_DEG
            end = interval.end_deg - 0.5 * ends.width_deg - BESIDE_DEG
            if end - start > 100.0 * BESIDE_DEG and interval.labels.decided:
                inside = [phase % 360.0 for phase in np.linspace(start, end, 7).tolist()]
                assert set(labels_at(history, inside)) == {interval.labels}, (history.roll_deg, history.pitch_deg)
                compared += 1
    assert compared > 60


def test_boundaries_hold_from_outside(histories: list[SolvedHistory]) -> None:
    check = check_boundaries(PAIR, histories)
    assert check.boundaries == sum(len(history.boundaries) for history in histories)
    assert check.sides > 1.9 * (check.boundaries - check.undecided)
    assert check.alike == 0
    assert check.failures == ()


def test_a_history_has_the_same_bits_alone_and_beside_others(histories: list[SolvedHistory]) -> None:
    roll, pitch = ORIENTATIONS[1]
    assert history_of(PAIR, roll, pitch) == histories[1]


def test_ten_times_the_density_finds_nothing_new(histories: list[SolvedHistory]) -> None:
    dense = histories_of(PAIR, [ORIENTATIONS[0]], resolution=replace(RESOLUTION, step=RESOLUTION.step / 10.0))
    found = histories[0].boundaries
    decided = [boundary for boundary in dense[0].boundaries if boundary.decided]
    assert len(decided) > 30
    for boundary in decided:
        apart = min(max(one.low_deg - boundary.high_deg, boundary.low_deg - one.high_deg) for one in found)
        assert apart <= BESIDE_DEG


def test_stored_records_are_used_and_change_nothing(
    histories: list[SolvedHistory], monkeypatch: pytest.MonkeyPatch
) -> None:
    roll, pitch = ORIENTATIONS[1]
    poses = np.column_stack([np.full((360, 2), (roll, pitch)), np.arange(360.0)])
    known = RecordStore(PAIR, SolveOptions())
    known.records(poses)
    solved: list[np.ndarray] = []

    def recorded(pair: Pair, options: SolveOptions, poses_deg: np.ndarray, *, beside: np.ndarray) -> np.ndarray:
        solved.extend(poses_deg)
        return solve_records(pair, options, poses_deg, beside=beside)

    monkeypatch.setattr(records, "solve_records", recorded)
    assert histories_of(PAIR, [(roll, pitch)], store=known) == [histories[1]]
    phases = [phase for _, _, phase in np.array(solved).tolist()]
    assert len(phases) == len(set(phases))
    assert not set(phases) & set(range(360))
