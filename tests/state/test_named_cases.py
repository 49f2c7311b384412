"""The special cases of the method, each by its name: sections 2, 4 and 5."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle.contact_rules import Touch, surface_gaps
from oracle.first_height import first_height
from oracle.profile import bolt_profile, nut_profile, radius
from oracle.solids import edge_tangent, outside_thread
from oracle.state_turns import contacts_of_stage, deepest_near, turns_of
from threadstate.state.model import ContactState, FeaturePair, Flag, StateClass
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.regions import Region

Floats = NDArray[np.float64]

HEIGHT_TOLERANCE_INCH = 1e-9
SURFACE_TOLERANCE_INCH = 1e-12
ANGLE_TOLERANCE_DEG = 1e-10
PATCH_TOLERANCE_INCH = 2.5e-5
"""Of a corner of a patch against samples of its border: they are this far apart, 0.01 deg."""

PAIR = quarter_twenty_unc()
BOLT, NUT = bolt_profile(PAIR), nut_profile(PAIR)
AXIAL_PLAY_INCH = (PAIR.fit.nut_pitch_diameter - PAIR.fit.bolt_pitch_diameter) / 2 * math.tan(math.radians(30.0))
IN_PHASE_DEG = 360.0 * AXIAL_PLAY_INCH / PAIR.thread_pitch


def tilt_deg(roll_deg: float, pitch_deg: float) -> float:
    return math.degrees(math.acos(math.cos(math.radians(roll_deg)) * math.cos(math.radians(pitch_deg))))


# --- Zero tilt


@pytest.mark.parametrize("phase", [2.3, 5.0, 45.0, 90.0, 131.0, 180.0, 185.5, 270.0, 300.0, 357.0])
def test_level_bolt_out_of_phase_lies_flush_on_the_surface(phase: float) -> None:
    state = solve_pose(PAIR, 0.0, 0.0, phase)
    assert state.flags == (Flag.FLUSH,)
    assert state.state_class is StateClass.STABLE_THREE_POINT
    assert state.poses[0].translation == (0.0, 0.0, 0.0)
    assert (state.lambda_deg, state.mu_deg, state.drop, state.embedment, state.pivot_offset) == (None,) * 5
    assert len(state.poses) == 1
    assert len(state.contacts) >= 2
    assert {(c.stage, c.features, c.normal) for c in state.contacts} == {(1, FeaturePair.FLUSH, (0.0, 0.0, 1.0))}


@pytest.mark.parametrize("phase", [5.0, 90.0, 131.0, 185.5, 300.0])
def test_contacts_of_a_level_bolt_are_the_extreme_points_of_its_patch(phase: float) -> None:
    state = solve_pose(PAIR, 0.0, 0.0, phase)
    azimuths = np.radians(np.arange(0.0, 360.0, 0.01)).tolist()
    edge = [radius(-PAIR.thread_pitch * (a - math.radians(phase)) / (2 * math.pi), BOLT) for a in azimuths]
    border = np.array([(r * math.cos(a), r * math.sin(a), 0.0) for r, a in zip(edge, azimuths, strict=True)])
    on_nut = np.array([outside_thread(point, NUT) >= 0.0 for point in border])
    found = np.array([contact.point for contact in state.contacts])
    for axis in (0, 1):
        extent = border[on_nut][:, axis].max(), border[on_nut][:, axis].min()
        assert (found[:, axis].max(), found[:, axis].min()) == pytest.approx(extent, abs=PATCH_TOLERANCE_INCH)


# --- Threads in phase


@pytest.mark.slow
@pytest.mark.parametrize("share", [-0.99, -0.5, 0.0, 0.3, 0.99])
def test_level_bolt_in_phase_drops_until_the_flanks_meet_along_a_strip(share: float) -> None:
    phase = share * IN_PHASE_DEG
    state = solve_pose(PAIR, 0.0, 0.0, phase)
    height = PAIR.thread_pitch * phase / 360.0 - AXIAL_PLAY_INCH
    assert state.poses[0].translation[2] == pytest.approx(height, abs=1e-15)
    assert state.poses[0].translation[2] == pytest.approx(first_height(PAIR, 0.0, 0.0, phase).height, abs=1e-12)
    assert state.flags == (Flag.FLUSH,)
    assert state.state_class is StateClass.STABLE_THREE_POINT
    assert len(state.contacts) == 4
    for contact in state.contacts:
        gaps = surface_gaps(Touch.of(PAIR, contact, state.poses[0]))
        assert max(gaps.values()) < SURFACE_TOLERANCE_INCH
        # The strip ends where a flank does, on one of the two: round-off does not choose between it and its fillet.
        assert (contact.bolt_region, contact.nut_region) == (Region.FLANK_POS, Region.FLANK_POS)
        assert 0.0 <= min(contact.bolt_margin, contact.nut_margin) < SURFACE_TOLERANCE_INCH
    assert sorted(round(contact.point[2] / height) for contact in state.contacts) == [0, 0, 1, 1]


def test_the_drop_in_phase_ends_where_the_play_does() -> None:
    just_in, just_out = (solve_pose(PAIR, 0.0, 0.0, side * IN_PHASE_DEG) for side in (0.999999, 1.000001))
    assert just_in.poses[0].translation[2] == pytest.approx(0.0, abs=1e-8)
    assert just_in.poses[0].translation[2] < 0.0
    assert just_out.poses[0].translation[2] == 0.0
    fallen = solve_pose(PAIR, 0.0, 0.0, -0.999999 * IN_PHASE_DEG)
    assert fallen.poses[0].translation[2] == pytest.approx(-2.0 * AXIAL_PLAY_INCH, abs=1e-8)


def test_level_in_phase_is_level_in_phase_a_turn_later() -> None:
    assert solve_pose(PAIR, 0.0, 0.0, 720.0).poses[0].translation[2] == pytest.approx(-AXIAL_PLAY_INCH, abs=1e-15)


# --- Flush after levelling


@pytest.mark.parametrize("pose", [(4.0, 0.0, 185.0), (2.0, 2.0, 0.0 + 60.0), (3.0, -1.0, 200.0), (0.5, 0.25, 200.0)])
def test_a_turn_that_levels_the_bolt_is_as_large_as_its_tilt(pose: tuple[float, float, float]) -> None:
    state = solve_pose(PAIR, *pose)
    assert state.flags == (Flag.FLUSH,)
    assert state.state_class is StateClass.STABLE_THREE_POINT
    assert state.contacts[0].features is FeaturePair.EDGE_SURFACE
    assert state.lambda_deg == pytest.approx(tilt_deg(*pose[:2]), abs=ANGLE_TOLERANCE_DEG)
    assert (state.mu_deg, state.drop, state.embedment, state.pivot_offset) == (None,) * 4
    assert {(c.stage, c.features) for c in state.contacts[1:]} == {(2, FeaturePair.FLUSH)}
    assert state.poses[1].translation[2] == pytest.approx(0.0, abs=SURFACE_TOLERANCE_INCH)
    np.testing.assert_allclose(np.array(state.poses[1].rotation)[2], (0.0, 0.0, 1.0), rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("pose", [(4.0, 0.0, 185.0), (3.0, -1.0, 200.0)])
def test_the_patch_after_levelling_reaches_both_sides_of_the_axis(pose: tuple[float, float, float]) -> None:
    state = solve_pose(PAIR, *pose)
    turn = turns_of(PAIR, state)[0]
    across = np.cross(turn.direction, (0.0, 0.0, 1.0))
    sides = [across @ (np.array(c.point) - turn.point) for c in contacts_of_stage(state, 2)]
    # CP0 itself is the patch's end on one side: the bolt was lowest there.
    assert max(np.abs(sides)) > 0.1
    assert min(sides) >= -1e-9 or max(sides) <= 1e-9


# --- Ties

FAR_APART_INCH = 0.02
SIMULTANEOUS_INCH = 1e-11

TIED = [
    (-3.63, -2.2, -2.252523456),
    (9.56, 4.14, 342.496587764),
    (7.57, -6.76, -5.283517893),
    (2.5, -2.35, -2.412470474),
    (-3.14, -0.44, 164.090694964),
    (3.09, 2.16, -13.738636889),
    (-0.98, 0.76, -12.563061059),
    (2.31, 4.0, 331.746768788),
]
"""Roll, pitch, phase (to 1e-8 deg) at which two places far apart have the same first height."""


def first_point(phase: float, roll: float, pitch: float) -> Floats:
    return np.array(solve_pose(PAIR, roll, pitch, phase).contacts[0].point)


def tied_phase(roll: float, pitch: float, near: float) -> tuple[float, Floats, Floats]:
    """The phase at which the first contact changes places, by bisection, and the two places."""
    low, high = near - 1e-3, near + 1e-3
    before, after = first_point(low, roll, pitch), first_point(high, roll, pitch)
    while high - low > 1e-12:
        middle = 0.5 * (low + high)
        state = solve_pose(PAIR, roll, pitch, middle)
        if Flag.TIE in state.flags:
            return middle, before, after
        point = np.array(state.contacts[0].point)
        if np.linalg.norm(point - before) < np.linalg.norm(point - after):
            low, before = middle, point
        else:
            high, after = middle, point
    raise AssertionError(f"no tie between {low} and {high}")


@pytest.mark.parametrize("pose", TIED)
def test_simultaneous_first_contacts_are_both_kept_and_flagged(pose: tuple[float, float, float]) -> None:
    roll, pitch, near = pose
    phase, before, after = tied_phase(roll, pitch, near)
    state = solve_pose(PAIR, roll, pitch, phase)
    assert Flag.TIE in state.flags
    assert state.lambda_deg == 0.0
    assert state.poses[1] == state.poses[0]
    earlier_points = np.array([c.point for c in state.contacts if c.stage in (1, 2)])
    for place in (before, after):
        assert np.linalg.norm(earlier_points - place, axis=1).min() < 1e-5
    assert np.linalg.norm(before - after) > FAR_APART_INCH
    # Both lie on both surfaces in the one pose: neither comes before the other.
    for contact in state.contacts[:2]:
        assert max(surface_gaps(Touch.of(PAIR, contact, state.poses[0])).values()) < SIMULTANEOUS_INCH


def test_beside_a_tie_there_is_none() -> None:
    roll, pitch, near = TIED[0]
    phase = tied_phase(roll, pitch, near)[0]
    for side in (-1e-5, 1e-5):
        assert Flag.TIE not in solve_pose(PAIR, roll, pitch, phase + side).flags


# --- Balanced axis

BALANCED = [
    (-9.26, 3.52, 1.936952337),
    (-4.34, -3.96, 76.782488122),
    (-7.3, 7.05, 3.064983535),
    (-5.29, 1.79, -1.100109006),
]
"""Roll, pitch, phase (to 1e-8 deg) at which the origin is over the pivot axis."""


def moment(state: ContactState) -> float:
    """The lever of a vertical force at the origin about CP0-CP1, signed, in inches."""
    cp0, cp1 = np.array(state.contacts[0].point), np.array(state.contacts[1].point)
    axis = (cp1 - cp0) / np.linalg.norm(cp1 - cp0)
    return float(np.cross(axis, np.array(state.poses[1].translation) - cp0)[2])


def balanced_phase(roll: float, pitch: float, near: float) -> float:
    low, high = near - 1e-3, near + 1e-3
    sign = moment(solve_pose(PAIR, roll, pitch, low))
    assert sign * moment(solve_pose(PAIR, roll, pitch, high)) < 0.0
    while high - low > 1e-13:
        middle = 0.5 * (low + high)
        here = moment(solve_pose(PAIR, roll, pitch, middle))
        if abs(here) < 2e-13:
            return middle
        low, high = (middle, high) if here * sign > 0.0 else (low, middle)
    raise AssertionError(f"no balance between {low} and {high}")


@pytest.mark.parametrize("pose", BALANCED)
def test_a_balanced_axis_is_flagged_and_the_shorter_turn_kept(pose: tuple[float, float, float]) -> None:
    roll, pitch, near = pose
    phase = balanced_phase(roll, pitch, near)
    state = solve_pose(PAIR, roll, pitch, phase)
    assert Flag.BALANCED in state.flags
    sides = [solve_pose(PAIR, roll, pitch, phase + side) for side in (-1e-7, 1e-7)]
    assert moment(sides[0]) * moment(sides[1]) < 0.0
    assert all(Flag.BALANCED not in side.flags for side in sides)
    turns = [side.mu_deg for side in sides if side.mu_deg is not None]
    if turns:
        assert state.mu_deg == pytest.approx(min(turns), abs=1e-4)
    else:
        assert state.mu_deg is None


# --- Grazing contact

GRAZING_DEG = [(0.44001675920453387, 1.9107023880317282, 2.468680820398987)]
GRAZING_SINE = 1e-3


def edge_sine(state: ContactState, index: int) -> float:
    contact = state.contacts[index]
    rotation = np.array(state.poses[contact.stage - 1].rotation)
    bolt = rotation @ edge_tangent(np.array(contact.point_bolt), BOLT)
    return float(np.linalg.norm(np.cross(bolt, edge_tangent(np.array(contact.point), NUT))))


@pytest.mark.parametrize("pose", GRAZING_DEG)
def test_edges_that_nearly_run_together_are_flagged(pose: tuple[float, float, float]) -> None:
    roll, pitch, phase = pose
    assert Flag.GRAZING in solve_pose(PAIR, *pose).flags
    flagged = 0
    for offset in np.linspace(-0.5, 0.5, 41).tolist():
        state = solve_pose(PAIR, roll, pitch, phase + offset)
        sines = [edge_sine(state, i) for i, c in enumerate(state.contacts) if c.features is FeaturePair.EDGE_EDGE]
        assert (Flag.GRAZING in state.flags) == any(sine < GRAZING_SINE for sine in sines)
        flagged += Flag.GRAZING in state.flags
    assert 0 < flagged < 41


@pytest.mark.parametrize("pose", [(-4.0, 0.0, 131.0), (0.0, 3.0, 250.0), (1.0, -2.0, 10.0)])
def test_edges_that_cross_are_not_flagged(pose: tuple[float, float, float]) -> None:
    state = solve_pose(PAIR, *pose)
    sines = [edge_sine(state, i) for i, c in enumerate(state.contacts) if c.features is FeaturePair.EDGE_EDGE]
    assert min(sines) > GRAZING_SINE
    assert Flag.GRAZING not in state.flags


# --- Thread on thread first

THREAD_ON_THREAD = [
    ((2.0, 1.0, 354.0), 0.0035967976620),
    ((2.0, 1.0, 355.0), 0.0037356865509),
    ((2.0, 1.0, 356.0), 0.0038745754398),
]
"""Pose in degrees and first height in inches, by the brute force."""


@pytest.mark.parametrize(("pose", "height"), THREAD_ON_THREAD)
def test_thread_meets_thread_first(pose: tuple[float, float, float], height: float) -> None:
    state = solve_pose(PAIR, *pose)
    first = state.contacts[0]
    assert first.features is FeaturePair.THREAD_THREAD
    assert state.poses[0].translation[2] == pytest.approx(height, abs=1e-12)
    assert state.poses[0].translation[2] > max(first_height(PAIR, *pose).by_feature[:2]) + 1e-7
    assert -PAIR.thread_pitch < first.point[2] < 0.0 < first.point_bolt[2]
    assert Region.SURFACE is not first.nut_region
    assert max(surface_gaps(Touch.of(PAIR, first, state.poses[0])).values()) < SURFACE_TOLERANCE_INCH


def test_thread_meets_thread_first_far_from_the_edges() -> None:
    pose = (3.7329537598678675, 2.3147751774318355, 350.1907642991677)
    state = solve_pose(PAIR, *pose)
    assert state.contacts[0].features is FeaturePair.THREAD_THREAD
    expected = first_height(PAIR, *pose).height
    assert state.poses[0].translation[2] == pytest.approx(expected, abs=HEIGHT_TOLERANCE_INCH)


# --- Thread on thread in a later stage

LATER_THREADS = [
    ((3.7346419688143078, 1.3703873785284273, -9.730369777020403), 0.571138),
    ((2.938465661855993, 0.5078196847908858, -7.65513343424924), 1.415095),
    ((6.83145721305326, 9.9, -50.30500151388847), 3.655966),
]
"""Pose and second turn in degrees, by the brute force: the ridge of the bolt's crest fillet meets the nut's flank."""


@pytest.mark.parametrize(("pose", "lambda_deg"), LATER_THREADS)
def test_thread_meets_thread_second(pose: tuple[float, float, float], lambda_deg: float) -> None:
    state = solve_pose(PAIR, *pose)
    # The brute force sees a component once it is 1e-7 in deep.
    assert state.lambda_deg == pytest.approx(lambda_deg, abs=1e-3)
    assert state.contacts[1].features is FeaturePair.THREAD_THREAD


def test_a_third_contact_may_come_at_once() -> None:
    state = solve_pose(PAIR, -3.2450761764579132, 9.9, -9.774640711025029)
    assert state.mu_deg is not None
    assert 0.0 < state.mu_deg < 3e-4
    turn = turns_of(PAIR, state)[1]
    point = np.array(contacts_of_stage(state, 3)[0].point)
    assert deepest_near(PAIR, *turn.pose_after(state.mu_deg + 1e-4), point, 5e-5) > 0.0


@pytest.mark.parametrize("pose", [(3.0, -1.0, 0.0), (4.0, 1.0, 1.0)])
def test_thread_meets_thread_late_in_the_third_turn(pose: tuple[float, float, float]) -> None:
    """A ridge ends there between two azimuths, with another one less than a tenth of a pitch away."""
    state = solve_pose(PAIR, *pose)
    (third,) = contacts_of_stage(state, 3)
    assert third.features is FeaturePair.THREAD_THREAD
    assert state.mu_deg is not None
    turn, point = turns_of(PAIR, state)[1], np.array(third.point)
    before, after = (deepest_near(PAIR, *turn.pose_after(state.mu_deg + d), point, 5e-5) for d in (-1e-4, 1e-4))
    assert before < 0.0 < after


# --- No third contact


@pytest.mark.parametrize(
    "pose",
    [(-2.9472516020024786, 1.7284319575711464, 2.2615793370244504), (-3.33003171617, -1.47849225826, 79.04844887633)],
)
def test_a_bolt_that_finds_no_third_contact_is_unstable(pose: tuple[float, float, float]) -> None:
    state = solve_pose(PAIR, *pose)
    assert state.flags == (Flag.NO_THIRD,)
    assert state.state_class is StateClass.UNSTABLE_TWO_POINT
    assert state.lambda_deg is not None
    assert (state.mu_deg, state.drop, state.embedment) == (None, None, None)
    assert state.pivot_offset is not None
    assert [contact.stage for contact in state.contacts] == [1, 2]
    assert len(state.poses) == 2
