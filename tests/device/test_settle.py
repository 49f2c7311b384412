"""Laws of settled states: what holds of every one, symmetries, limits, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.device.document import device_from_document
from threadstate.device.model import About, Device, Outcome, SettledFlag, SettledState, default_device, diagonal_device
from threadstate.device.settle import settle_pose, settle_poses
from threadstate.errors import InvalidValueError
from threadstate.state.model import FeaturePair
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc
from threadstate.thread.hand import Hand
from threadstate.units import LengthUnit

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()
R = UNC.nominal_diameter / 2.0
DEVICE = default_device()
PUSH = DEVICE.push


def random_poses(seed: int, count: int) -> Floats:
    """Random poses of the study's range."""
    return np.random.default_rng(seed).uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0], (count, 3))


@pytest.fixture(scope="module")
def states() -> list[SettledState]:
    """Random poses, settled by the default device."""
    return settle_poses(UNC, random_poses(1, 80))


def rotation_of(vector: Floats) -> Floats:
    """The rotation by a vector (Rodrigues)."""
    angle = float(np.linalg.norm(vector))
    if angle == 0.0:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross)


def command_of(state: SettledState) -> Floats:
    """The commanded rotation by the method's section 2."""
    a, b, c = map(math.radians, (state.roll_deg, state.pitch_deg, state.phase_deg))
    turn = rotation_of(np.array([0.0, 0.0, c]))
    return np.asarray(turn @ rotation_of(np.array([0.0, b, 0.0])) @ rotation_of(np.array([a, 0.0, 0.0])))


def energy(device: Device, vector: Floats, shift: Floats) -> float:
    """The elastic energy of a deviation."""
    e = np.concatenate([vector, shift])
    return float(0.5 * e @ np.array(device.stiffness) @ e)


def test_nearly_all_settle_and_what_does_not_says_why(states: list[SettledState]) -> None:
    settled = [state for state in states if state.outcome is Outcome.SETTLED]
    assert len(settled) > 0.97 * len(states)
    for state in states:
        assert (state.pose is None) == (state.outcome is not Outcome.SETTLED)
        if state.outcome is Outcome.UNDECIDED:
            assert state.flags


def test_pose_deviation_and_energy_belong_together(states: list[SettledState]) -> None:
    held = DEVICE.in_unit(UNC.unit)
    for state in states:
        if state.pose is None or state.shift is None or state.rotation_deg is None:
            continue
        vector, shift = np.radians(state.rotation_deg), np.array(state.shift)
        assert vector[2] == 0.0
        rotation = np.array(state.pose.rotation)
        assert np.abs(rotation - command_of(state) @ rotation_of(vector)).max() < 1e-14
        # The centre is the origin, commanded on the axis at the height of the first contact.
        assert np.abs(np.array(state.pose.translation)[:2] - shift[:2]).max() < 1e-15
        first = solve_pose(UNC, state.roll_deg, state.pitch_deg, state.phase_deg).poses[0].translation[2]
        assert state.pose.translation[2] - shift[2] == pytest.approx(first, abs=1e-12)
        assert state.elastic_energy == pytest.approx(energy(held, vector, shift), rel=1e-12, abs=1e-14)


def test_forces_and_moments_balance(states: list[SettledState]) -> None:
    """The moment of the device comes from differences of its energy over turns of the bolt in space."""
    held = DEVICE.in_unit(UNC.unit)
    for state in states:
        if state.pose is None or state.shift is None or state.rotation_deg is None:
            continue
        rotation, command = np.array(state.pose.rotation), command_of(state)
        shift = np.array(state.shift)
        force = np.array([0.0, 0.0, -PUSH]) - np.array(held.stiffness)[3:, 3:] @ shift
        centre = np.array(state.pose.translation)
        moment = np.zeros(3)
        for contact in state.contacts:
            assert np.dot(contact.force, contact.normal) > 0.0
            assert np.linalg.norm(np.cross(contact.force, contact.normal)) < 1e-12 * PUSH
            force = force + contact.force
            moment = moment + np.cross(np.array(contact.point) - centre, contact.force)
        assert np.abs(force).max() < 1e-8
        # Turns that keep the third component of the rotation vector: the others are the rigid twist's to balance.
        vector = np.radians(state.rotation_deg)
        h = 1e-5
        for i in range(2):
            ends = []
            for sign in (1.0, -1.0):
                moved = vector + sign * h * np.eye(3)[i]
                relative = command @ rotation_of(moved) @ rotation.T
                spin = np.array(
                    [relative[2, 1] - relative[1, 2], relative[0, 2] - relative[2, 0], relative[1, 0] - relative[0, 1]]
                )
                ends.append((0.5 * spin, energy(held, moved, shift)))
            turn = (ends[0][0] - ends[1][0]) / (2.0 * h)
            slope = (ends[0][1] - ends[1][1]) / (2.0 * h)
            assert moment @ turn - slope == pytest.approx(0.0, abs=1e-7 * PUSH * R)


def test_margins_are_positive(states: list[SettledState]) -> None:
    for state in states:
        if state.outcome is not Outcome.SETTLED:
            continue
        margins = state.margins
        assert margins.residual is not None
        assert margins.residual < 1e-9
        if SettledFlag.FLUSH in state.flags:
            assert margins.pressure is not None
            assert margins.pressure > 0.0
            continue
        assert margins.force is not None
        assert margins.force > 0.0
        assert margins.stability is None or margins.stability > 0.0
        assert margins.gap is None or SettledFlag.MARGINAL in state.flags or margins.gap > 0.0


def test_along_the_path_energy_is_spent_only_in_falls(states: list[SettledState]) -> None:
    """At each push the bolt is no higher in potential than where it was before, and falls lose."""
    for state in states:
        points = state.path
        assert points[0].push == 0.0
        assert points[0].elastic_energy == 0.0
        for before, after in pairwise(points):
            assert after.push >= before.push
            at_new_push = before.elastic_energy + after.push * before.centre[2]
            assert after.potential <= at_new_push + 1e-9 * PUSH * R
        for fall in state.falls:
            assert fall.energy >= -1e-9 * PUSH * R
            assert fall.way >= abs(fall.drop)


def test_a_stiff_device_stays_at_the_first_contact() -> None:
    stiff = diagonal_device(
        k_lateral=1e9, k_axial=0.0, k_tilt=1e9, k_twist=None, centre=0.0, push=10.0, unit=LengthUnit.MILLIMETRE
    )
    for roll, pitch, phase in random_poses(3, 20):
        state = settle_pose(UNC, roll, pitch, phase, stiff)
        first = solve_pose(UNC, roll, pitch, phase)
        assert state.outcome is Outcome.SETTLED
        assert state.pose is not None
        assert state.pose.translation[2] == pytest.approx(first.poses[0].translation[2], abs=1e-8)
        assert [contact.features for contact in state.contacts] == [first.contacts[0].features]
        assert np.abs(np.subtract(state.contacts[0].point, first.contacts[0].point)).max() < 1e-5
        assert state.falls == ()


def test_units_of_pair_and_device_make_no_difference() -> None:
    metric = UNC.in_unit(LengthUnit.MILLIMETRE)
    for pose in random_poses(4, 25):
        (inch,) = settle_poses(UNC, [pose])
        (same,) = settle_poses(metric, [pose], DEVICE.in_unit(LengthUnit.INCH))
        assert (same.outcome, same.flags, len(same.contacts)) == (inch.outcome, inch.flags, len(inch.contacts))
        if inch.pose is None or same.pose is None:
            continue
        assert np.allclose(same.pose.translation, np.multiply(inch.pose.translation, 25.4), rtol=0.0, atol=1e-9)
        assert np.allclose(same.pose.rotation, inch.pose.rotation, rtol=0.0, atol=1e-10)
        assert same.elastic_energy == pytest.approx(25.4 * (inch.elastic_energy or 0.0), rel=1e-8, abs=1e-10)


def test_a_left_hand_pair_is_the_mirror_image() -> None:
    left = replace(UNC, designation="left", hand=Hand.LEFT)
    mirror = np.diag([1.0, -1.0, 1.0])
    for roll, pitch, phase in random_poses(5, 25):
        right, other = settle_pose(UNC, roll, pitch, phase), settle_pose(left, -roll, pitch, -phase)
        assert (other.outcome, other.flags) == (right.outcome, right.flags)
        if right.pose is None or other.pose is None:
            continue
        assert np.abs(mirror @ right.pose.translation - other.pose.translation).max() < 1e-10
        assert np.abs(mirror @ np.array(right.pose.rotation) @ mirror - other.pose.rotation).max() < 1e-10


def test_the_phase_about_the_bolt_is_that_about_the_nut_of_another_pose() -> None:
    """Ry Rx Rz(phase) is Rz(phase) Ry' Rx' of the tilt seen from a frame that has turned with the bolt."""
    roll, pitch, phase = 2.0, -1.5, 120.0
    about_bolt = settle_pose(UNC, roll, pitch, phase, replace(DEVICE, about=About.BOLT))
    a, b, c = map(math.radians, (roll, pitch, phase))
    command = (
        rotation_of(np.array([0.0, b, 0.0]))
        @ rotation_of(np.array([a, 0.0, 0.0]))
        @ rotation_of(np.array([0.0, 0.0, c]))
    )
    same_pitch = -math.asin(command[2, 0])
    same_roll = math.atan2(command[2, 1], command[2, 2])
    same_phase = math.atan2(command[1, 0], command[0, 0])
    (about_nut,) = settle_poses(UNC, np.degrees([[same_roll, same_pitch, same_phase]]))
    assert about_bolt.pose is not None
    assert about_nut.pose is not None
    assert np.allclose(about_bolt.pose.translation, about_nut.pose.translation, rtol=0.0, atol=1e-10)


def test_a_level_bolt_tips_where_its_patch_does_not_carry_the_push() -> None:
    """At phase 180 the patch is symmetric about the y axis: the bolt tips about x, on two crossings of the edges."""
    state = settle_pose(UNC, 0.0, 0.0, 180.0)
    assert state.outcome is Outcome.SETTLED
    assert state.rotation_deg is not None
    assert state.rotation_deg[0] < -0.01
    assert state.rotation_deg[1] == pytest.approx(0.0, abs=1e-9)
    assert [contact.features for contact in state.contacts] == [FeaturePair.EDGE_EDGE] * 2
    assert [contact.force[2] for contact in state.contacts] == pytest.approx([PUSH / 2.0] * 2, rel=1e-9)


def test_a_level_bolt_stays_where_its_patch_carries_the_push() -> None:
    """Of two starts the patch lies on both sides of the axis."""
    state = settle_pose(replace(UNC, starts=2), 0.0, 0.0, 90.0)
    assert (state.outcome, state.flags, state.falls) == (Outcome.SETTLED, (SettledFlag.FLUSH,), ())
    assert state.rotation_deg == (0.0, 0.0, 0.0)
    assert state.elastic_energy == 0.0
    assert sum(contact.force[2] for contact in state.contacts) == pytest.approx(PUSH)
    arm = sum(contact.force[2] * np.array(contact.point) for contact in state.contacts)
    assert np.abs(arm).max() < 1e-12


def test_a_level_bolt_in_phase_goes_down_its_thread() -> None:
    state = settle_pose(UNC, 0.0, 0.0, 0.0)
    assert state.outcome is Outcome.SETTLED
    assert state.pose is not None
    assert state.pose.translation[2] < -0.003
    assert {contact.features for contact in state.contacts} <= {FeaturePair.EDGE_THREAD, FeaturePair.THREAD_EDGE}


def test_a_slightly_tilted_bolt_is_laid_flush_with_the_forces_on_the_hull() -> None:
    state = settle_pose(UNC, 1.0, 0.5, 120.0)
    assert SettledFlag.FLUSH in state.flags
    assert state.pose is not None
    assert state.pose.rotation[2] == (0.0, 0.0, 1.0)
    assert state.pose.translation[2] == 0.0
    assert state.shift is not None
    assert np.abs(state.shift[:2]).max() == 0.0
    # Unequal forces: their centre balances the moment of the springs.
    assert min(contact.force[2] for contact in state.contacts) > 0.0
    centre = sum(contact.force[2] * np.array(contact.point) for contact in state.contacts) / PUSH
    tilt = math.hypot(*np.radians(state.rotation_deg or ()))
    assert np.linalg.norm(centre) == pytest.approx(500.0 / 25.4 * tilt / PUSH, rel=2e-3)


def test_the_same_pose_gives_the_same_bits_whatever_the_others_are() -> None:
    poses = random_poses(6, 6)
    together = settle_poses(UNC, poses)
    assert [settle_pose(UNC, *pose) for pose in poses] == together
    assert settle_poses(UNC, poses[::-1])[::-1] == together
    assert settle_poses(UNC, []) == []


@pytest.mark.parametrize(
    ("pose", "mu", "name"),
    [((11.0, 0.0, 0.0), 0.0, "roll"), ((0.0, 0.0, math.inf), 0.0, "phase"), ((0.0, 3.0, 0.0), -0.1, "mu")],
)
def test_a_bad_pose_or_friction_is_refused(pose: tuple[float, float, float], mu: float, name: str) -> None:
    with pytest.raises(InvalidValueError, match=name):
        settle_pose(UNC, *pose, mu=mu)


@pytest.mark.parametrize(
    ("designation", "name"),
    [
        ("1/4-16 acme at minimum material", "flank_half_angle_deg"),
        ("sharp", "bolt_root_fillet"),
        ("M6 with chamfer", "chamfer"),
    ],
)
def test_pairs_that_the_search_does_not_cover_are_refused(designation: str, name: str) -> None:
    pair = (
        replace(UNC, form=replace(UNC.form, bolt_root_fillet=0.0))
        if designation == "sharp"
        else pair_by_designation(designation)
    )
    with pytest.raises(InvalidValueError, match=name):
        settle_pose(pair, 1.0, 2.0, 3.0)


@pytest.mark.parametrize(
    "changes",
    [
        {"centre": -10.0},
        {"centre": 10.0},
        {"k_twist": 500.0},
        {"k_axial": 50.0},
        {"k_tilt": 5000.0, "k_lateral": 5.0},
        {"stiffness": [[1e3 if i == j else (5.0 if i + j == 3 else 0.0) for j in range(6)] for i in range(6)]},
    ],
)
def test_other_devices_balance_too(changes: dict[str, Any]) -> None:
    device = device_from_document({"unit": "mm", **changes})
    settled = [state for state in settle_poses(UNC, random_poses(8, 6), device) if state.outcome is Outcome.SETTLED]
    assert len(settled) >= 5
    stiffness = np.array(device.in_unit(UNC.unit).stiffness)
    for state in settled:
        deviation = np.concatenate([np.radians(state.rotation_deg or ()), state.shift or ()])
        force = np.sum([contact.force for contact in state.contacts], axis=0) - [0.0, 0.0, device.push]
        assert np.abs(force - (stiffness @ deviation)[3:]).max() < 1e-8
        assert state.margins.residual is not None
        assert state.margins.residual < 1e-9


@pytest.mark.parametrize("tilt_deg", [2e-9, 3e-8, 1e-6, 4e-6])
def test_a_bolt_that_is_all_but_level_rests_on_the_lowest_point_of_its_edge_first(tilt_deg: float) -> None:
    """Samples of the edge beside that point are higher by less than round-off on an arc of one depth."""
    settled = [settle_pose(UNC, tilt, -1.6 * tilt, -110.77) for tilt in (tilt_deg, 1e-4)]
    assert [state.outcome for state in settled] == [Outcome.SETTLED] * 2
    near, far = (np.array(state.pose.translation) for state in settled if state.pose is not None)
    assert np.abs(near - far).max() < 1e-6
