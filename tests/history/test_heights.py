"""Curves of height against phase, beside states that are solved one by one."""

from __future__ import annotations

import numpy as np
import pytest

from threadstate.history.build import history_of
from threadstate.history.descents import falls_of
from threadstate.history.height_curve import height_curve
from threadstate.history.heights import LEAST_DEG, Heights, heights_of
from threadstate.history.model import Boundary, SolvedHistory
from threadstate.library.read import rests
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
ORIENTATIONS = [(0.0, -4.0), (-1.37, -2.61)]
TOLERANCE = 1e-5


def _sides(boundaries: tuple[Boundary, ...]) -> list[float]:
    return [phase for one in boundaries for phase in (one.low_deg, one.high_deg)]


@pytest.fixture(scope="module", params=ORIENTATIONS)
def history(request: pytest.FixtureRequest) -> SolvedHistory:
    roll, pitch = request.param
    return history_of(PAIR, roll, pitch)


@pytest.fixture(scope="module")
def heights(history: SolvedHistory) -> Heights:
    return heights_of(PAIR, history.roll_deg, history.pitch_deg, _sides(history.boundaries), TOLERANCE)


def test_a_curve_goes_once_round_and_ends_as_it_begins(heights: Heights) -> None:
    assert (heights.phases_deg[0], heights.phases_deg[-1]) == (0.0, 360.0)
    assert (np.diff(heights.phases_deg) > 0.0).all()
    assert heights.first[0] == heights.first[-1]
    assert np.array_equal(heights.rest[:1], heights.rest[-1:], equal_nan=True)
    assert not np.isnan(heights.first).any()


def test_lines_are_right_anywhere(history: SolvedHistory, heights: Heights) -> None:
    phases = np.random.default_rng(17).uniform(0.0, 360.0, 400)
    phases = phases[[all(abs(phase - side) > LEAST_DEG for side in _sides(history.boundaries)) for phase in phases]]
    states = solve_poses(PAIR, [(history.roll_deg, history.pitch_deg, phase) for phase in phases])
    off = np.interp(phases, heights.phases_deg, heights.first) - [one.poses[0].translation[2] for one in states]
    assert np.abs(off).max() <= TOLERANCE
    # Beside a phase at which the bolt begins to rest, or ceases to, a line has but one end.
    shown = np.interp(phases, heights.phases_deg, heights.rest)
    resting = np.array([rests(one.state_class, one.embedment_margin) for one in states])
    assert np.array_equal(~np.isnan(shown), resting)
    last = np.array([one.poses[-1].translation[2] for one in states])
    assert np.abs(shown - last)[resting].max() <= TOLERANCE
    assert 0 < resting.sum() < len(states)


def test_a_curve_holds_both_sides_of_the_jump(history: SolvedHistory, heights: Heights) -> None:
    curve = height_curve(PAIR, history.roll_deg, history.pitch_deg)
    (descent,) = falls_of(curve, PAIR.thread_pitch).descents
    jump = descent.largest_jump
    assert jump is not None
    falls = heights.first[:-1] - heights.first[1:]
    # Before the jump the height falls as the root of the phase that is left: 1e-8 in within the bracket.
    assert falls.max() == pytest.approx(jump.fall, abs=5e-8)
    assert heights.phases_deg[falls.argmax()] == pytest.approx(jump.phase_deg, abs=LEAST_DEG)


def test_what_is_known_changes_no_bit(history: SolvedHistory, heights: Heights) -> None:
    whole = np.arange(0.0, 360.0)
    states = solve_poses(PAIR, [(history.roll_deg, history.pitch_deg, phase) for phase in whole])
    known = {
        one.phase_deg: (
            one.poses[0].translation[2],
            one.poses[-1].translation[2] if rests(one.state_class, one.embedment_margin) else np.nan,
        )
        for one in states
    }
    again = heights_of(PAIR, history.roll_deg, history.pitch_deg, _sides(history.boundaries), TOLERANCE, known)
    assert np.array_equal(again.phases_deg, heights.phases_deg)
    assert np.array_equal(again.first, heights.first)
    assert np.array_equal(again.rest, heights.rest, equal_nan=True)


def test_an_undecided_stretch_has_no_heights_and_is_not_searched() -> None:
    roll, pitch = ORIENTATIONS[0]
    known = {float(phase): (np.nan, np.nan) for phase in range(100, 121)}
    curve = heights_of(PAIR, roll, pitch, (), TOLERANCE, known)
    inside = (curve.phases_deg >= 100.0) & (curve.phases_deg <= 120.0)
    assert np.isnan(curve.first[inside]).all()
    assert set(curve.phases_deg[inside].tolist()) <= set(known)
    assert not np.isnan(curve.first[~inside]).any()
