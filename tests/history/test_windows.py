"""Clearance windows, and what the mirror of the outlines implies for them."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from threadstate.history.build import history_of
from threadstate.history.descents import falls_of
from threadstate.history.height_curve import height_curve
from threadstate.history.labels import UNDECIDED
from threadstate.history.window import windows_of
from threadstate.state.model import FeaturePair
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.play import axial_play

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()


def test_the_jump_at_roll_0_pitch_minus_4() -> None:
    (window,) = windows_of(PAIR, history_of(PAIR, 0.0, -4.0))
    (descent,) = falls_of(height_curve(PAIR, 0.0, -4.0), PAIR.thread_pitch).descents
    jump = descent.largest_jump
    assert jump is not None
    assert 357.0 < jump.phase_deg < 358.0
    assert jump.width_deg <= 1e-8
    # Nearer than that two contacts are nearer to each other than round-off tells.
    before, after, later = (
        solve_pose(PAIR, 0.0, -4.0, jump.phase_deg + offset).poses[0].translation[2] for offset in (-2e-9, 1e-9, 1e-6)
    )
    # Before the jump the height falls as the root of the phase that is left, behind it by the lead.
    assert before == pytest.approx(jump.height_before, abs=5e-8)
    assert after == pytest.approx(jump.height_after, abs=1e-12)
    assert window.enter_height == jump.height_before
    assert later - jump.height_after == pytest.approx(PAIR.thread_pitch / 360.0 * 1e-6, abs=1e-12)
    assert window.lowest_height == jump.height_after


def test_the_edge_climbs_on_the_nut_s_thread_by_the_lead() -> None:
    (window,) = windows_of(PAIR, history_of(PAIR, 0.0, -4.0))
    rates = [c.rate_per_lead(PAIR.thread_pitch) for c in window.courses if c.features is FeaturePair.EDGE_THREAD]
    assert rates
    assert rates == pytest.approx([1.0] * len(rates), abs=1e-6)


@pytest.mark.parametrize(("roll", "pitch"), [(2.0, 3.0), (-3.0, 1.5), (0.3, -4.0)])
def test_the_mirror_of_a_pose_has_the_same_height_where_edges_meet(roll: float, pitch: float) -> None:
    # The outlines are their own mirror images in x, the threads are not.
    phases = np.arange(0.5, 360.0, 7.0)
    on_edges = (FeaturePair.EDGE_SURFACE, FeaturePair.EDGE_EDGE)
    compared = 0
    for phase in phases.tolist():
        one, other = solve_poses(PAIR, [(roll, pitch, phase), (roll, -pitch, -phase)])
        if one.contacts[0].features in on_edges and other.contacts[0].features in on_edges:
            assert one.poses[0].translation[2] == pytest.approx(other.poses[0].translation[2], abs=1e-12)
            compared += 1
    assert compared > 30


def test_a_level_bolt_climbs_by_the_lead_over_twice_its_play() -> None:
    (window,) = windows_of(PAIR, history_of(PAIR, 0.0, 0.0))
    play = axial_play(PAIR)
    assert window.enter_deg == pytest.approx(360.0 * (1.0 - play / PAIR.thread_pitch), abs=3e-7)
    assert window.width_deg == pytest.approx(720.0 * play / PAIR.thread_pitch, abs=3e-7)
    assert [c.rate_per_lead(PAIR.thread_pitch) for c in window.courses] == pytest.approx([1.0], abs=1e-6)


def test_an_undecided_stretch_within_a_window_belongs_to_it() -> None:
    history = history_of(PAIR, 0.0, -4.0)
    (window,) = windows_of(PAIR, history)
    i = next(
        i
        for i, one in enumerate(history.intervals)
        if window.enter_deg < one.start_deg + 360.0 and one.end_deg + 360.0 < window.leave_deg
    )
    whole = history.intervals[i]
    cuts = (whole.start_deg, whole.start_deg + 1e-3, whole.start_deg + 2e-3, whole.end_deg)
    parts = [replace(whole, start_deg=start, end_deg=end) for start, end in pairwise(cuts)]
    parts[1] = replace(parts[1], labels=UNDECIDED, state=None)
    opening = history.boundaries[i]
    made = [replace(opening, low_deg=cut, high_deg=cut, before=None, after=None, changes=()) for cut in cuts[1:-1]]
    undecided = replace(
        history,
        intervals=(*history.intervals[:i], *parts, *history.intervals[i + 1 :]),
        boundaries=(*history.boundaries[: i + 1], *made, *history.boundaries[i + 1 :]),
    )
    (bridged,) = windows_of(PAIR, undecided)
    assert replace(bridged, courses=()) == replace(window, courses=())
