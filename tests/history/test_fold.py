"""Folds of edge on edge, beside heights at phases that near them and beside the edges themselves."""

from __future__ import annotations

import math

import numpy as np
import pytest

from oracle.pose import pose_rotation
from oracle.profile import bolt_profile, nut_profile, radius
from threadstate.history.descents import falls_of
from threadstate.history.falls import Jump
from threadstate.history.fold import fold_near
from threadstate.history.height_curve import height_curve
from threadstate.state.model import FeaturePair
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
ORIENTATIONS = [(0.0, -4.0), (-2.0, -2.0), (1.0, -1.0), (0.37, -2.9), (-1.61, -3.3)]
Tilt = tuple[float, float]
NEAREST_DEG = (2e-8, 5e-8)
"""How far from a fold the nearest phases are that limits are extrapolated from.

With roll 1 and pitch -1 a region ends 2e-6 deg before the fold: beyond it the height is another function.
"""


@pytest.fixture(scope="module")
def jumps() -> list[tuple[Tilt, Jump]]:
    found = []
    for tilt in ORIENTATIONS:
        jumps = [descent.largest_jump for descent in falls_of(height_curve(PAIR, *tilt), PAIR.thread_pitch).descents]
        found.append((tilt, max((jump for jump in jumps if jump is not None), key=lambda jump: jump.fall)))
    return found


def _extrapolated(tilt: Tilt, jump: Jump, phases_deg: float) -> float:
    """The limit of heights before a jump from four phases, the nearest that far from it, in powers of the root."""
    roots = math.sqrt(phases_deg) * np.arange(1.0, 5.0)
    states = solve_poses(PAIR, [(*tilt, jump.phase_deg - root**2) for root in roots])
    assert {state.contacts[0].features for state in states} == {FeaturePair.EDGE_EDGE}
    heights = [state.poses[0].translation[2] for state in states]
    return float(np.linalg.solve(np.vander(roots), heights)[-1])


def _least_excess(tilt: Tilt, azimuth: float, phase_deg: float) -> float:
    """How far the bolt's edge is beyond the nut's outline at most, of its points within 0.03 rad of an azimuth."""
    theta = azimuth + np.linspace(-0.03, 0.03, 4_001)
    k = PAIR.thread_pitch / (2.0 * math.pi)
    r = np.array([radius(-k * one, bolt_profile(PAIR)) for one in theta])
    rotation = pose_rotation(*tilt, phase_deg)
    x, y, _ = rotation @ np.array([r * np.cos(theta), r * np.sin(theta), np.zeros_like(r)])
    outline = [radius(-k * one, nut_profile(PAIR)) for one in np.arctan2(y, x)]
    return float((np.hypot(x, y) - outline).max())


def test_the_height_before_a_jump_is_what_heights_before_it_near(jumps: list[tuple[Tilt, Jump]]) -> None:
    for tilt, jump in jumps:
        for nearest in NEAREST_DEG:
            assert _extrapolated(tilt, jump, nearest) == pytest.approx(jump.height_before, abs=1e-11)


def test_errors_are_stated_and_small(jumps: list[tuple[Tilt, Jump]]) -> None:
    for _, jump in jumps:
        assert 0.0 < jump.height_error < 1e-9
        assert 0.0 < jump.width_deg < 1e-9


def test_behind_the_phase_of_a_fold_the_edge_is_within_the_outline(jumps: list[tuple[Tilt, Jump]]) -> None:
    for tilt, jump in jumps:
        (state,) = solve_poses(PAIR, [(*tilt, jump.phase_deg - 1e-7)])
        x, y, _ = state.contacts[0].point_bolt
        azimuth = math.atan2(y, x)
        assert _least_excess(tilt, azimuth, jump.phase_deg - 1e-7) > 0.0
        assert _least_excess(tilt, azimuth, jump.phase_deg + 1e-7) < 0.0


def test_a_fold_is_the_same_from_farther_off(jumps: list[tuple[Tilt, Jump]]) -> None:
    tilt, jump = jumps[0]
    (state,) = solve_poses(PAIR, [(*tilt, jump.phase_deg - 1e-4)])
    x, y, _ = state.contacts[0].point_bolt
    fold = fold_near(PAIR, *tilt, jump.phase_deg - 1e-4, math.atan2(y, x))
    assert fold is not None
    assert abs(fold.phase_deg - jump.phase_deg) <= fold.phase_error_deg + 0.5 * jump.width_deg
    assert abs(fold.height - jump.height_before) <= 2.0 * fold.height_error


def test_there_is_no_fold_where_both_outlines_are_round() -> None:
    assert fold_near(PAIR, 0.0, 0.0, 0.0, -0.5 * math.pi) is None
