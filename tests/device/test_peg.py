"""A peg in a hole: the check values of forces, section 6, on the solver of held bolts.

A thread of depth zero has corners that the device refuses. A bolt that touches with its crest alone is the same peg:
the thread is so coarse that tip, hole, rim and side meet between grooves. In the plane of the tilt all of it has closed
forms; the depth of two-point contact is exact in space.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq, nnls

from threadstate.device import _chart_kernel as ck
from threadstate.device import _friction_kernel as fk
from threadstate.device import _friction_rest_kernel as fr
from threadstate.device import _friction_step_kernel as fs
from threadstate.device import _settle_kernel as sk
from threadstate.device._modes_kernel import CONTACT_SIZE
from threadstate.device.command import command_numbers, strip_numbers
from threadstate.device.friction import FrictionPath, begin_friction, settled_with_friction
from threadstate.device.model import Device, Outcome, SettledFlag, SettledState, diagonal_device
from threadstate.device.settle import device_numbers, path_with_friction, settle_pose, settled_rows
from threadstate.thread.fit import Fit
from threadstate.thread.form import Form
from threadstate.thread.pair import Pair
from threadstate.units import LengthUnit

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

r, R = 5.0, 5.2
"""Radii of peg and hole (mm), Whitney's d = 10 and D = 10.4."""
PITCH = 40.0
PEG = Pair(
    "peg",
    LengthUnit.MILLIMETRE,
    2.0 * r,
    PITCH,
    Form("peg", 30.0, 0.01, 0.01, 0.01, 0.01),
    Fit("peg", 2.0 * r, 2.0 * r - 1.0, 2.0 * r - 2.0, 2.0 * R + 2.0, 2.0 * R + 1.0, 2.0 * R),
)
PUSH = 10.0
K_LATERAL, K_TILT = 20.0, 1e6
DEVICE = diagonal_device(
    k_lateral=K_LATERAL,
    k_axial=0.0,
    k_tilt=K_TILT,
    k_twist=None,
    centre=0.0,
    push=PUSH,
    unit=LengthUnit.MILLIMETRE,
)


def pose_of(tilt_deg: float) -> tuple[float, float, float]:
    """Roll, pitch and phase (deg) at which the peg's two contacts are in the middle of crests, at about their depth.

    Of the bolt that is the side at the azimuth whose crest reaches from the base to the rim, of the nut the rim over a
    crest that reaches down to the tip.
    """
    tilt = math.radians(tilt_deg)
    depth = two_point_depth(tilt)
    # The profile is at its crest for s = z - k azimuth in (0, p / 2): the side has z from 0 to the depth.
    on_bolt = -2.0 * math.pi / PITCH * (0.5 * PITCH - 0.5 * depth) + math.pi
    # The nut's crest is where its profile is lowest, in (-p / 2, 0).
    on_nut = -2.0 * math.pi / PITCH * (-0.5 * PITCH + 0.5 * depth)
    # The bolt's axis leans towards the side that meets the rim: a turn about the axis across it.
    axis = np.array([-math.sin(on_bolt), math.cos(on_bolt), 0.0])
    leaning = rotation_about(axis, tilt)
    # Ry(pitch) Rx(roll) has the same axis z, up to a turn about it.
    x, y, z = leaning[:, 2]
    roll = math.asin(-y)
    pitch = math.atan2(x, z)
    return math.degrees(roll), math.degrees(pitch), math.degrees(on_nut - on_bolt)


def rotation_about(axis: Floats, angle: float) -> Floats:
    """Rodrigues' formula, shape (3, 3)."""
    cross = np.cross(np.eye(3), axis)
    return np.asarray(np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross)


def two_point_depth(tilt: float) -> float:
    """How deep the base's centre is where the tip touches the hole, and the rim the side; tilt in rad."""
    return (2.0 * R - r * (math.cos(tilt) + 1.0 / math.cos(tilt))) / math.tan(tilt)


def tilt_of(state: SettledState) -> float:
    """The tilt of a settled peg (rad)."""
    assert state.pose is not None
    return math.acos(state.pose.rotation[2][2])


@dataclass(frozen=True)
class Planar:
    """A peg on both contacts in the plane of its tilt: depth of its base's centre, its shift away from the rim, and
    normal forces at rim and tip.
    """

    tilt: float
    depth: float
    shift: float
    rim: float
    tip: float


def planar_forces(tilt: float, commanded: float, mu: float, push: float) -> tuple[Planar, float]:
    """Contact forces, both sliding down, that balance forces; and the moment about the base's centre that is left."""
    c, s = math.cos(tilt), math.sin(tilt)
    depth, shift = two_point_depth(tilt), R - r * c
    # Across, and up: at the rim the normal is across the axis, friction along it; at the tip the wall is upright.
    matrix = np.array([[-c + mu * s, 1.0], [s + mu * c, mu]])
    rim, tip = np.linalg.solve(matrix, [-K_LATERAL * shift, push])
    at_rim, at_tip = (R + shift, depth), (-r * c, r * s)
    moment = K_TILT * (commanded - tilt)
    moment += at_rim[1] * matrix[0, 0] * rim - at_rim[0] * matrix[1, 0] * rim
    moment += at_tip[1] * tip - at_tip[0] * mu * tip
    return Planar(tilt, depth, shift, float(rim), float(tip)), float(moment)


def planar_rest(commanded: float, mu: float, push: float) -> Planar:
    """Where the peg rests on both contacts, which slide down as the push grows."""
    tilt = brentq(lambda a: planar_forces(a, commanded, mu, push)[1], 0.7 * commanded, commanded, xtol=1e-15)
    return planar_forces(tilt, commanded, mu, push)[0]


@pytest.mark.parametrize("tilt_deg", [2.0, 3.0, 4.0, 6.0])
def test_two_points_touch_at_the_depth_of_the_peg(tilt_deg: float) -> None:
    """At the tilt that the device has left it: l tan(tilt) = 2 R - r (cos(tilt) + 1 / cos(tilt))."""
    state = settle_pose(PEG, *pose_of(tilt_deg), DEVICE)
    assert state.outcome is Outcome.SETTLED
    assert state.pose is not None
    assert len(state.contacts) == 2
    tilt = tilt_of(state)
    assert 0.85 * math.radians(tilt_deg) < tilt < math.radians(tilt_deg)
    assert -state.pose.translation[2] == pytest.approx(two_point_depth(tilt), abs=1e-8)
    rest = planar_rest(math.radians(tilt_deg), 0.0, PUSH)
    assert (tilt, -state.pose.translation[2]) == pytest.approx((rest.tilt, rest.depth), abs=1e-7)
    assert math.hypot(*state.pose.translation[:2]) == pytest.approx(rest.shift, abs=1e-8)


def test_the_depths_of_forces_section_6() -> None:
    depths = [two_point_depth(math.radians(tilt)) for tilt in (2.0, 3.0, 4.0, 6.0)]
    assert depths == pytest.approx([11.454, 7.632, 5.720, 3.804], abs=5e-4)


def settled_path(tilt_deg: float, mu: float, device: Device = DEVICE) -> tuple[SettledState, FrictionPath]:
    """A peg that has settled with friction, and the path that goes on from it."""
    pose = np.array(pose_of(tilt_deg))
    numbers = device_numbers(PEG, device)
    _, rows = settled_rows(PEG, device, numbers, pose[None])
    path = path_with_friction(PEG, device, numbers, pose, rows[0][0], mu)
    assert isinstance(path, FrictionPath)
    phase = math.radians(pose[2])
    leg = path.follow((phase, phase), (0.0, device.push))
    return settled_with_friction(device, pose, path, leg), path


@pytest.mark.parametrize(("tilt_deg", "mu"), [(4.0, 0.05), (4.0, 0.1), (6.0, 0.1), (3.0, 0.2)])
def test_a_peg_that_slides_rests_where_the_planar_balance_has_it(tilt_deg: float, mu: float) -> None:
    """Pose and forces of the path are those of three planar equations; the load lies on the line of two cones' edges:
    Whitney's jamming line, exactly.
    """
    state, _ = settled_path(tilt_deg, mu)
    assert (state.outcome, state.flags) == (Outcome.SETTLED, ())
    assert state.pose is not None
    rest = planar_rest(math.radians(tilt_deg), mu, PUSH)
    assert min(rest.rim, rest.tip) > 0.0
    assert (tilt_of(state), -state.pose.translation[2]) == pytest.approx((rest.tilt, rest.depth), abs=1e-6)
    assert math.hypot(*state.pose.translation[:2]) == pytest.approx(rest.shift, abs=1e-6)
    normals = sorted(float(np.dot(contact.force, contact.normal)) for contact in state.contacts)
    assert normals == pytest.approx(sorted((rest.rim, rest.tip)), abs=1e-6 * PUSH)


def holds(path: FrictionPath, state: SettledState, mu: float, push: float) -> bool:
    """Whether friction can hold the peg where it is, by the test of the solver."""
    contacts = np.zeros((5, CONTACT_SIZE))
    for row, contact in zip(contacts, state.contacts, strict=False):
        row[:3], row[3:6] = contact.point, contact.normal
    return bool(fr.rests(path.q, push, mu, len(state.contacts), contacts, path.numbers))


def least_friction(path: FrictionPath, state: SettledState, push: float) -> float:
    """The least friction that holds the peg where it is, bracketed to 1e-8."""
    low, high = 0.0, 1.0
    assert holds(path, state, high, push)
    while high - low > 1e-8:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if holds(path, state, middle, push) else (middle, high)
    return high


@pytest.mark.parametrize(("tilt_deg", "mu"), [(4.0, 0.05), (6.0, 0.1), (3.0, 0.2)])
def test_a_peg_jams_from_the_friction_on_with_which_it_has_slid_there(tilt_deg: float, mu: float) -> None:
    """Where both contacts have slid the load is on the edge of what contacts hold: with less friction it goes on."""
    state, path = settled_path(tilt_deg, mu)
    assert least_friction(path, state, PUSH) == pytest.approx(mu, abs=1e-6)


def wedging_friction(state: SettledState) -> float:
    """From which friction on the line between both contacts lies in both cones."""
    tilt = tilt_of(state)
    line = math.atan2(two_point_depth(tilt) - r * math.sin(tilt), 2.0 * R)
    return math.tan(line + tilt)


@pytest.mark.parametrize("tilt_deg", [4.0, 6.0, 8.0])
def test_a_peg_wedges_where_the_line_between_its_contacts_is_in_both_cones(tilt_deg: float) -> None:
    """Nothing that pulls it out moves it then, and anything that is more than the device does below: to 1e-6."""
    state = settle_pose(PEG, *pose_of(tilt_deg), DEVICE)
    _, path = settled_path(tilt_deg, 0.05)
    numbers = path.numbers
    assert state.shift is not None
    assert state.rotation_deg is not None
    path.q[:3] = np.radians(state.rotation_deg)
    path.q[3:] = np.array(state.shift) + numbers[ck.D_PLACE : ck.D_PLACE + 3]
    wedging = wedging_friction(state)
    # A spring along z pulls by the push, and by 1e-5 of it more: that is several times the load of the device.
    push, stretch = 1e8, 2.0
    numbers[ck.D_STIFFNESS + 35] = push * (1.0 + 1e-5) / stretch
    numbers[ck.D_PLACE + 2] = path.q[5] + stretch
    assert not holds(path, state, wedging - 1e-6, push)
    assert holds(path, state, wedging + 1e-6, push)


def planar_rests(tilt: float, commanded: float, mu: float, push: float) -> bool:
    """Whether forces along the four edges of both planar cones balance device and push at a two-point contact."""
    c, s = math.cos(tilt), math.sin(tilt)
    depth, shift = two_point_depth(tilt), R - r * c
    arms = ((R + shift, depth), (-r * c, r * s))
    normals, tangents = ((-c, s), (1.0, 0.0)), ((s, c), (0.0, 1.0))
    columns = []
    for (x, z), n, t in zip(arms, normals, tangents, strict=True):
        for side in (-mu, mu):
            fx, fz = n[0] + side * t[0], n[1] + side * t[1]
            columns.append((fx, fz, (z * fx - x * fz) / r))
    _, residual = nnls(np.array(columns).T, [-K_LATERAL * shift, push, -K_TILT * (commanded - tilt) / r])
    return bool(residual < 1e-9 * push)


def followed(tilt_deg: float, mu: float) -> Floats:
    """The points of a path on which the push has grown, as the kernel's rows."""
    pose = np.array(pose_of(tilt_deg))
    numbers = device_numbers(PEG, DEVICE)
    _, rows = settled_rows(PEG, DEVICE, numbers, pose[None])
    command = command_numbers(DEVICE, float(pose[0]), float(pose[1]), float(rows[0][0][sk.R_HEIGHT]))
    phase = math.radians(pose[2])
    path = begin_friction(PEG, numbers, command, strip_numbers(PEG), phase, mu)
    leg = path.follow((phase, phase), (0.0, PUSH))
    assert leg.status == fs.REACHED
    return leg.points


def test_a_peg_that_may_rest_and_may_slide_is_ambiguous() -> None:
    """Below the friction that wedges there is a range in which a growing push may be held where the peg is, and may as
    well slide it down: both satisfy the planar equations, so that a step has two solutions.
    """
    commanded = math.radians(8.0)
    state = settle_pose(PEG, *pose_of(8.0), DEVICE, mu=0.22)
    assert (state.outcome, state.flags) == (Outcome.UNDECIDED, (SettledFlag.AMBIGUOUS,))
    points = followed(8.0, 0.22)
    seen = 0
    for before, after in pairwise(points):
        if before[fk.P_COUNT] != 2 or after[fk.P_COUNT] != 2 or after[fk.P_PUSH] < 0.5 * PUSH:
            continue
        push = float(after[fk.P_PUSH])
        tilts = [math.acos(row[fk.P_POSE + 8]) for row in (before, after)]
        slides = planar_rest(commanded, 0.22, push)
        assert min(slides.rim, slides.tip) > 0.0
        assert (tilts[1], -after[fk.P_POSE + 11]) == pytest.approx((slides.tilt, slides.depth), abs=1e-6)
        both = planar_rests(tilts[0], commanded, 0.22, push)
        assert after[fk.P_SOLUTIONS] == (2 if both else 1)
        seen += both
    assert seen >= 3


def test_with_less_friction_there_is_one_solution() -> None:
    commanded = math.radians(8.0)
    points = followed(8.0, 0.1)
    assert (points[:, fk.P_SOLUTIONS] <= 1.0).all()
    for before, after in pairwise(points):
        if before[fk.P_COUNT] == after[fk.P_COUNT] == 2:
            tilt = math.acos(before[fk.P_POSE + 8])
            assert not planar_rests(tilt, commanded, 0.1, float(after[fk.P_PUSH]))


def test_a_peg_that_can_wedge_has_two_solutions_at_each_step() -> None:
    """With friction above that of wedging contacts can hold any push; whether they do is not computed."""
    points = followed(8.0, 0.4)
    touching = points[points[:, fk.P_COUNT] == 2]
    assert len(touching) > 5
    tilt = math.acos(touching[0, fk.P_POSE + 8])
    line = math.atan2(two_point_depth(tilt) - r * math.sin(tilt), 2.0 * R)
    assert math.tan(line + tilt) < 0.4
    for before, after in pairwise(touching):
        assert planar_rests(math.acos(before[fk.P_POSE + 8]), math.radians(8.0), 0.4, float(after[fk.P_PUSH]))
        assert after[fk.P_SOLUTIONS] == 2
