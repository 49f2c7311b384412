"""Left-hand pairs are mirror images of right-hand ones; pairs of several starts repeat themselves within a turn."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from oracle.first_height import first_height
from oracle.state_turns import earlier_appearance, turns_of
from tests.contact.samples import Floats, random_poses
from threadstate.history.descents import falls_of
from threadstate.history.height_curve import height_curve
from threadstate.mesh.options import MeshOptions, Scene
from threadstate.mesh.solve import solve_poses_by_mesh
from threadstate.responses.histories import computed_history
from threadstate.state.model import ContactState, Flag
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.statics.solve import statics_of
from threadstate.statics.verdict import Verdict
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.hand import Hand
from threadstate.thread.pair import Pair

IN_MIRROR = np.array([1.0, -1.0, 1.0])
"""What becomes of a vector where y is reversed: with it the helix turns the other way, and azimuth 0 stays."""
POSE_IN_MIRROR = np.array([-1.0, 1.0, -1.0])


def of_starts(designation: str, starts: int) -> Pair:
    pair = pair_by_designation(designation)
    return replace(pair, designation=f"{designation} of {starts} starts", starts=starts)


def sorted_points(state: ContactState, by: Floats) -> Floats:
    """Points and normals of a state's contacts, transformed, in an order that the transformation does not change."""
    found = np.array([[*(by @ contact.point), *(by @ contact.normal), contact.stage] for contact in state.contacts])
    return np.asarray(found[np.lexsort(np.round(found[:, [0, 1, 2, 6]], 6).T)])


def numbers_of(state: ContactState) -> list[float]:
    numbers = (state.drop, state.embedment, state.pivot_offset, *(pose.translation[2] for pose in state.poses))
    return [math.nan if number is None else number for number in numbers]


def assert_same(one: ContactState, other: ContactState, transformed: Floats, within: float) -> None:
    assert (one.state_class, set(one.flags)) == (other.state_class, set(other.flags))
    assert sorted(c.features for c in one.contacts) == sorted(c.features for c in other.contacts)
    assert numbers_of(one) == pytest.approx(numbers_of(other), rel=0.0, abs=within, nan_ok=True)
    np.testing.assert_allclose(
        sorted_points(one, np.eye(3)), sorted_points(other, transformed), rtol=0.0, atol=100.0 * within
    )


@pytest.mark.parametrize("designation", ["M6", "1/4-20 UNC-2A/2B", "1/4-16 ACME-2G at minimum material", "1/4-20 BSW"])
def test_a_left_hand_pair_is_the_mirror_image(designation: str) -> None:
    right, size = pair_by_designation(designation), designation.partition(" at ")
    left = pair_by_designation(f"{size[0]} LH{size[1]}{size[2]}")
    assert (left.hand, left.lead, left.fit, left.form) == (Hand.LEFT, -right.lead, right.fit, right.form)
    poses = random_poses(1818, 60, tilt_deg=6.0)
    poses[:20] = np.round(poses[:20])
    poses[:4, :2] = 0.0
    poses[:4, 2] = [0.0, 1.0, 90.0, 359.0]
    mirrored = solve_poses(left, poses * POSE_IN_MIRROR)
    for state, image in zip(solve_poses(right, poses), mirrored, strict=True):
        assert_same(image, state, np.diag(IN_MIRROR), 1e-11 * right.nominal_diameter)


@pytest.mark.parametrize("starts", [2, 3, 4])
def test_several_starts_repeat_within_a_turn(starts: int) -> None:
    pair = of_starts("1/4-20 UNC", starts)
    poses = random_poses(1819, 40, tilt_deg=4.0)
    poses[:2, :2] = 0.0
    poses[0, 2] = 1.0
    step = 2.0 * math.pi / starts
    turn = np.array([[math.cos(step), -math.sin(step), 0.0], [math.sin(step), math.cos(step), 0.0], [0.0, 0.0, 1.0]])
    further = solve_poses(pair, poses + np.array([0.0, 0.0, 360.0 / starts]))
    for state, image in zip(solve_poses(pair, poses), further, strict=True):
        if Flag.FLUSH not in state.flags:
            assert_same(image, state, turn, 1e-11 * pair.nominal_diameter)
        else:
            # A patch's extreme points are those across the turn's axis, which other pairs of points may be as well.
            assert image.poses[-1].translation[2] == pytest.approx(state.poses[-1].translation[2], abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(
    "pair",
    [
        of_starts("M6", 2),
        of_starts("1/4-20 UNC-1A/1B at minimum material", 3),
        of_starts("1/4-16 ACME-2G", 2),
        replace(of_starts("1/4-20 BSW", 4), hand=Hand.LEFT),
    ],
    ids=lambda pair: pair.designation,
)
def test_heights_and_turns_of_several_starts_are_those_of_the_brute_force(pair: Pair) -> None:
    poses = random_poses(1820, 5, tilt_deg=4.0)
    for number, state in enumerate(solve_poses(pair, poses)):
        pose = (state.roll_deg, state.pitch_deg, state.phase_deg)
        expected = first_height(pair, *pose).height
        assert state.poses[0].translation[2] == pytest.approx(expected, abs=1e-9 * pair.thread_pitch), pose
        for turn in turns_of(pair, state) if number == 0 else ():
            earlier = earlier_appearance(pair, turn, SolveOptions().turn_limit_deg, steps=10)
            assert earlier is None or earlier.depth > 2e-5 * pair.thread_pitch, (pose, turn.stage)


def test_a_level_bolt_rests_on_a_strip_of_each_start() -> None:
    pair = of_starts("M6", 3)
    state = solve_pose(pair, 0.0, 0.0, 0.0)
    azimuths = np.array([math.degrees(math.atan2(c.point[1], c.point[0])) for c in state.contacts])
    assert len(azimuths) == 12
    np.testing.assert_allclose((azimuths[4:] - azimuths[:8]) % 360.0, 120.0, atol=1e-9)


def test_two_strips_hold_a_push_that_tips_a_bolt_on_one() -> None:
    one, two = pair_by_designation("M6"), of_starts("M6", 2)
    verdicts = [statics_of(pair, solve_pose(pair, 0.0, 0.0, 0.0), mu=0.3).verdict for pair in (one, two)]
    assert verdicts == [Verdict.MOVES, Verdict.CAN_STAY]


def test_windows_of_three_starts_are_a_third_of_a_turn_apart_and_climb_with_the_lead() -> None:
    pair = of_starts("M6", 3)
    windows = computed_history(pair, 0.0, -4.0).windows
    enters = [window.enter_deg for window in windows]
    assert np.diff(enters) == pytest.approx([120.0, 120.0], abs=1e-3)
    rates = [one.rate_per_lead(pair.lead) for window in windows for one in window.courses]
    assert rates == pytest.approx([1.0, 1.0, 1.0], abs=1e-6)
    falls = [one.fall for one in falls_of(height_curve(pair, 0.0, -4.0), pair.thread_pitch).descents]
    assert falls == pytest.approx([falls[0]] * 3, rel=1e-6)


@pytest.mark.slow
def test_meshes_find_the_states_of_a_left_hand_pair_of_two_starts() -> None:
    pair = replace(of_starts("M6", 2), hand=Hand.LEFT)
    poses = np.array([[1.0, -2.0, 10.0], [-4.0, 0.0, 131.0], [2.0, 2.0, 300.0]])
    by_mesh = solve_poses_by_mesh(pair, poses, MeshOptions(scene=Scene.CURVES))
    for exact, mesh in zip(solve_poses(pair, poses), by_mesh, strict=True):
        assert [c.features for c in mesh.contacts] == [c.features for c in exact.contacts]
        assert mesh.poses[0].translation[2] == pytest.approx(exact.poses[0].translation[2], abs=5e-4)
        assert mesh.lambda_deg == pytest.approx(exact.lambda_deg, abs=0.02)
