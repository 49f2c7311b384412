"""Boxes of azimuth and time: their ranges hold every value, and no box that holds an onset is excluded."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.contact.edges import new_edge, new_kept
from tests.contact.samples import Floats, random_poses
from tests.thread.shapes import BUTTRESS, TURNED_BUTTRESS
from threadstate.contact import _box_kernel as box
from threadstate.contact import _onset_kernel as onset
from threadstate.contact._branchless_kernel import (
    azimuth,
    coarse_azimuth,
    course_over,
    profile_numbers,
    radius_and_slope,
    second_derivative_range,
    sine_cosine,
    slope_change_limit,
)
from threadstate.contact._edge_kernel import Box
from threadstate.contact._edge_search_kernel import evaluate_box
from threadstate.contact._frame_kernel import motion_numbers
from threadstate.contact._geometry_kernel import M_COPLANAR, MOTION_SIZE, PATH_SIZE, TWO_PI
from threadstate.contact._range_kernel import ranges, size_numbers
from threadstate.contact._stage_kernel import rotation, set_motions
from threadstate.contact._surface_kernel import start_height
from threadstate.state.model import Contact, ContactState, FeaturePair
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair
from threadstate.thread.profile import Profile

PAIR = quarter_twenty_unc()
SHARP = replace(PAIR, form=replace(PAIR.form, bolt_root_fillet=0.0, bolt_crest_fillet=1e-4, nut_root_fillet=1e-3))
BOLT, NUT = PAIR.bolt.packed, PAIR.nut.packed
ROUND_OFF = 1e-14

ON_BOLT = {FeaturePair.EDGE_EDGE, FeaturePair.EDGE_SURFACE, FeaturePair.EDGE_THREAD}
ON_NUT = {FeaturePair.EDGE_EDGE, FeaturePair.BASE_EDGE, FeaturePair.THREAD_EDGE}


def edge_motions(
    pose: Floats, is_turn: bool, coplanar: bool, point: Floats, axis: Floats, pair: Pair = PAIR
) -> list[tuple[Floats, Floats, Floats]]:
    """The motion of either edge curve, with the curve's profile and the solid's."""
    bolt_motion, nut_motion = np.zeros(MOTION_SIZE), np.zeros(MOTION_SIZE)
    set_motions(pose, is_turn, coplanar, point, axis, bolt_motion, nut_motion)
    bolt, nut = pair.bolt.packed, pair.nut.packed
    return [(bolt_motion, bolt, nut), (nut_motion, nut, bolt)]


def random_motion(rng: np.random.Generator, kind: str, pair: Pair = PAIR) -> tuple[Floats, Floats, Floats]:
    """A motion of that kind from a random pose, and the profiles of the curve and of the solid."""
    tilt = math.radians(10.0 ** rng.uniform(-8.0, 1.0))
    near = rng.random() < 0.5
    pose = np.zeros(12)
    rotation(tilt * rng.uniform(-1, 1), tilt * rng.uniform(-1, 1), rng.uniform(0, TWO_PI), pose)
    point, axis = np.zeros(3), np.array([0.0, 0.0, -1.0])
    if kind == "turn":
        pose[9:] = rng.normal(0, 0.003, 3) * (min(1.0, 30.0 * tilt) if near else 1.0)
        around, along = rng.uniform(0, TWO_PI, 2)
        point = np.array([0.11 * math.cos(around), 0.11 * math.sin(around), rng.uniform(-0.02, 0)])
        axis = np.array([math.cos(along), math.sin(along), rng.normal(0, 0.05)])
        axis /= np.linalg.norm(axis)
    pose[11] = rng.uniform(-0.005, 0.01)
    return edge_motions(pose, kind == "turn", False, point, axis, pair)[rng.integers(2)]


def jets(theta: Floats, tau: Floats, motion: Floats, curve: Floats, solid: Floats) -> Floats:
    path, jet = np.empty(PATH_SIZE), np.empty(onset.JET_SIZE)
    found = []
    for t in theta:
        for when in tau:
            onset.set_jet(t, when, motion, curve, solid, path, jet)
            found.append(jet.copy())
    return np.array(found)


@pytest.mark.parametrize("kind", ["turn", "translation"])
def test_no_point_of_a_box_is_deeper_than_it_says(kind: str) -> None:
    rng = np.random.default_rng(62)
    boxes = np.zeros(box.BOXES_SIZE)
    least = math.inf
    for _ in range(600):
        motion, curve, solid = random_motion(rng, kind)
        theta, a, start = rng.uniform(0, TWO_PI), 10.0 ** rng.uniform(-7, -1), rng.uniform(0, 0.01)
        b = 10.0 ** rng.uniform(-10, -3)
        evaluate_box(Box(theta, a, start, start + 2 * b), new_edge(motion, curve, solid, new_kept(1)), boxes)
        seen = jets(np.linspace(theta - a, theta + a, 5), np.linspace(start, start + 2 * b, 5), motion, curve, solid)
        above = boxes[box.X_DEEPEST] - np.minimum(seen[:, onset.J_PHI], seen[:, onset.J_G]).max()
        least = min(least, above)
        assert above > -ROUND_OFF
    assert least < 1e-6


@pytest.mark.parametrize("kind", ["turn", "translation"])
@pytest.mark.parametrize(
    "pair", [PAIR, SHARP, BUTTRESS, TURNED_BUTTRESS], ids=["filleted", "sharp", "buttress", "turned buttress"]
)
def test_ranges_hold_every_point_of_the_box(kind: str, pair: Pair) -> None:
    rng = np.random.default_rng(61)
    for _ in range(600):
        motion, curve, solid = random_motion(rng, kind, pair)
        theta, a = rng.uniform(0, TWO_PI), 10.0 ** rng.uniform(-7, -1)
        start = rng.uniform(0, 0.3) if kind == "turn" else rng.uniform(0, 0.012)
        b = 10.0 ** rng.uniform(-10, -1.6) * (1.0 if kind == "turn" else 0.1)
        x_axis, y_axis, origin, rest = motion_numbers(motion)
        numbers = profile_numbers(curve), profile_numbers(solid)
        sizes = size_numbers(motion, curve, solid)
        phi, g, depth = ranges(theta, a, start + b, b, x_axis, y_axis, origin, rest, *numbers, sizes)
        seen = jets(np.linspace(theta - a, theta + a, 5), np.linspace(start, start + 2 * b, 5), motion, curve, solid)
        azimuths, times = np.repeat(np.linspace(-a, a, 5), 5), np.tile(np.linspace(-b, b, 5), 5)
        for one, columns in (
            (phi, (onset.J_PHI, onset.J_PHI_THETA, onset.J_PHI_TAU, onset.J_PHI_THETA_THETA, onset.J_PHI_THETA_TAU)),
            (g, (onset.J_G, onset.J_G_THETA, onset.J_G_TAU, onset.J_G_THETA_THETA, onset.J_G_THETA_TAU)),
        ):
            size, cross = max(one.tt_high, -one.tt_low), abs(one.tv) + one.tv_var
            change = (
                abs(one.by_theta) * a + abs(one.by_tau) * b + 0.5 * size * a * a + cross * a * b + 0.5 * one.vv * b * b
            )
            by_theta, by_tau = one.by_theta, one.by_tau
            allowed = [
                (one.value - change, one.value + change),
                (by_theta - size * a - cross * b, by_theta + size * a + cross * b),
                (by_tau - cross * a - one.vv * b, by_tau + cross * a + one.vv * b),
                (one.tt_low, one.tt_high),
                (one.tv - one.tv_var, one.tv + one.tv_var),
            ]
            for column, (least, most) in zip(columns, allowed, strict=True):
                assert least - ROUND_OFF <= seen[:, column].min()
                assert seen[:, column].max() <= most + ROUND_OFF
            changes = (by_theta, one.theta_change), (by_tau, one.tau_change)
            for column, (middle, changed) in zip(columns[1:], changes, strict=False):
                assert np.abs(seen[:, column] - middle).max() <= changed + ROUND_OFF
            assert one.theta_low - ROUND_OFF <= seen[:, columns[1]].min()
            assert seen[:, columns[1]].max() <= one.theta_high + ROUND_OFF
            beyond = seen[:, columns[0]] - one.value - by_theta * azimuths - by_tau * times
            assert -one.below - ROUND_OFF <= beyond.min()
            assert beyond.max() <= one.above + ROUND_OFF
        assert (-motion[19] * seen[:, onset.J_Z]).min() >= depth - ROUND_OFF


@pytest.fixture(scope="module")
def states() -> list[ContactState]:
    poses = np.vstack([random_poses(62, 60, tilt_deg=4.0), random_poses(63, 60, tilt_deg=4.0, phase_deg=20.0)])
    return [state for state in solve_poses(PAIR, poses) if state.contacts]


def descent(state: ContactState) -> list[tuple[Floats, Floats, Floats]]:
    pose = np.zeros(12)
    roll, pitch, phase = (math.radians(a) for a in (state.roll_deg, state.pitch_deg, state.phase_deg))
    rotation(roll, pitch, phase, pose)
    pose[11] = start_height(pose, BOLT)
    return edge_motions(pose, False, False, np.zeros(3), np.array([0.0, 0.0, -1.0]))


def third_turn(state: ContactState, first: Contact, second: Contact) -> list[tuple[Floats, Floats, Floats]]:
    start = state.poses[1]
    pose = np.array([*np.ravel(start.rotation), *start.translation])
    point, axis = np.array(first.point), np.subtract(second.point, first.point)
    axis /= np.linalg.norm(axis)
    if np.cross(axis, pose[9:] - point)[2] > 0.0:
        axis = -axis
    flat = {FeaturePair.EDGE_EDGE, FeaturePair.EDGE_SURFACE, FeaturePair.BASE_EDGE}
    return edge_motions(pose, True, {first.features, second.features} <= flat, point, axis)


def onsets(states: list[ContactState]) -> list[tuple[float, float, Floats, Floats, Floats]]:
    """Azimuth and time of contacts on an edge curve, with the motion of their onset."""
    found = []
    for state in states:
        first, *later = state.contacts
        motions = [(first, -state.poses[0].translation[2], descent(state))]
        motions[0] = (first, motions[0][2][0][0][11] + motions[0][1], motions[0][2])
        if state.mu_deg and len(later) == 2:
            motions.append((later[1], math.radians(state.mu_deg), third_turn(state, first, later[0])))
        for contact, time, (bolt_edge, nut_edge) in motions:
            if contact.features in ON_BOLT:
                found.append((math.atan2(contact.point_bolt[1], contact.point_bolt[0]), time, *bolt_edge))
            if contact.features in ON_NUT:
                found.append((math.atan2(contact.point[1], contact.point[0]), time, *nut_edge))
    return found


def test_no_box_that_holds_an_onset_is_excluded(states: list[ContactState]) -> None:
    rng = np.random.default_rng(64)
    found_onsets = onsets(states)
    assert len(found_onsets) > 150
    boxes = np.zeros(box.BOXES_SIZE)
    for theta, time, motion, curve, solid in 3 * found_onsets:
        for i in range(box.CAPACITY):
            half, span = 10.0 ** rng.uniform(-8, -1), 10.0 ** rng.uniform(-9, -1.5)
            boxes[box.X_THETA + i] = theta + rng.uniform(-0.99, 0.99) * half
            boxes[box.X_HALF + i] = half
            boxes[box.X_START + i] = time - rng.uniform(0.01, 0.99) * span
            boxes[box.X_END + i] = boxes[box.X_START + i] + span
        box.classify_boxes(box.CAPACITY, motion, curve, solid, boxes)
        classes = boxes[box.X_CLASS : box.X_CLASS + box.CAPACITY]
        assert not np.isin(classes, (box.ALL_OUTSIDE, box.EXCLUDED)).any()


def test_small_boxes_around_an_onset_hold_no_other(states: list[ContactState]) -> None:
    """The bounds are sharp enough there for the search to end."""
    boxes = np.zeros(box.BOXES_SIZE)
    for theta, time, motion, curve, solid in onsets(states):
        if motion[M_COPLANAR] == 0.0:
            edge = new_edge(motion, curve, solid, new_kept(0))
            found = evaluate_box(Box(theta, 1e-7, time - 1e-9, time + 1e-9), edge, boxes)
            assert found in (box.ONE_EDGE, box.ONE_THREAD, box.ONE_PLANE)


def test_elementary_functions_without_branches() -> None:
    for angle in np.linspace(-7.0, 7.0, 2001):
        assert sine_cosine(angle) == pytest.approx((math.sin(angle), math.cos(angle)), abs=4e-15)
        x, y = 0.1 * math.cos(angle), 0.1 * math.sin(angle)
        assert azimuth(x, y, math.hypot(x, y)) == pytest.approx(math.atan2(y, x), abs=2e-14)
        assert coarse_azimuth(x, y, math.hypot(x, y)) == pytest.approx((math.atan2(y, x), 10.0), abs=6e-10)


@pytest.mark.parametrize("profile", [PAIR.bolt, PAIR.nut, BUTTRESS.bolt, BUTTRESS.nut, TURNED_BUTTRESS.bolt])
def test_profile_without_branches(profile: Profile) -> None:
    rng = np.random.default_rng(65)
    numbers = profile_numbers(profile.packed)
    for s in rng.uniform(-0.2, 0.2, 2000):
        expected = profile.derivatives(s)
        r, slope, u, rises = radius_and_slope(s, numbers)
        assert (r, slope) == pytest.approx(expected[:2], rel=1e-10, abs=1e-15)
        reach = 10.0 ** rng.uniform(-8, -1.5)
        low, high = second_derivative_range(u, reach, rises, numbers)
        seen = [profile.derivatives(q)[2] for q in np.linspace(s - reach, s + reach, 15)]
        assert low - 1e-7 * abs(low) <= min(seen)
        assert max(seen) <= high + 1e-7 * abs(high)


@pytest.mark.parametrize("profile", [PAIR.bolt, PAIR.nut, SHARP.nut, BUTTRESS.bolt, BUTTRESS.nut, TURNED_BUTTRESS.bolt])
def test_a_profile_stays_within_its_course(profile: Profile) -> None:
    """Radii and slopes at many places within reach are in the ranges, which are near to what is seen."""
    rng = np.random.default_rng(66)
    numbers = profile_numbers(profile.packed)
    loosest = []
    for s in rng.uniform(-0.1, 0.1, 3000):
        r, slope, u, rises = radius_and_slope(s, numbers)
        reach = 10.0 ** rng.uniform(-6, 0) * 0.6 * profile.thread_pitch
        course = course_over(r, slope, u, reach, rises, numbers)
        places = np.linspace(-reach, reach, 41)
        seen = np.array([profile.derivatives(s + d)[:2] for d in places])
        remainders, changes = seen[:, 0] - r - slope * places, seen[:, 1] - slope
        assert course.slope_low - 1e-9 <= changes.min()
        assert changes.max() <= course.slope_high + 1e-9
        assert np.abs(changes).max() <= slope_change_limit(slope, u, reach, rises, numbers) + 1e-9
        assert course.low - 1e-15 <= remainders.min()
        assert remainders.max() <= course.high + 1e-15
        if math.isfinite(course.high) and remainders.max() - remainders.min() > 1e-3 * profile.thread_pitch:
            loosest.append((course.high - course.low) / (remainders.max() - remainders.min()))
    assert np.median(loosest) < 1.01


def test_a_reach_longer_than_a_half_period_bounds_nothing() -> None:
    numbers = profile_numbers(NUT)
    r, slope, u, rises = radius_and_slope(0.001, numbers)
    course = course_over(r, slope, u, 0.51 * PAIR.thread_pitch, rises, numbers)
    assert (course.low, course.high) == (-math.inf, math.inf)
    steepest = numbers[2]
    assert slope_change_limit(slope, u, 0.51 * PAIR.thread_pitch, rises, numbers) == steepest + abs(slope)
