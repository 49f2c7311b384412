"""Laws of paths: what holds at each of their points, energy, symmetry, the aligned screw, and how they end."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle.pose import pose_rotation
from oracle.rest import HeldBolt
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath, AssemblyPoint, Held, PathEventKind
from threadstate.device.model import About, Device, Limits, default_device
from threadstate.device.strategy import Strategy
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc
from threadstate.thread.hand import Hand
from threadstate.thread.play import axial_limits
from threadstate.units import LengthUnit, conversion_factor

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()
R = UNC.nominal_diameter / 2.0
DEVICE = default_device()
HELD = DEVICE.in_unit(UNC.unit)
PUSH = DEVICE.push
PAPER = (0.0, -4.0, 300.0)
"""The orientation of the paper's case, turned back from its snap."""


@pytest.fixture(scope="module")
def paper() -> AssemblyPath:
    """The path of the paper's case by the default device."""
    return assemble_pose(UNC, *PAPER)


@pytest.fixture(scope="module")
def level() -> AssemblyPath:
    """That of a level bolt."""
    return assemble_pose(UNC, 0.0, 0.0, 300.0)


@pytest.fixture(scope="module")
def paths(paper: AssemblyPath, level: AssemblyPath) -> list[AssemblyPath]:
    """Paths of several ends."""
    others = [(0.0, 4.0, 300.0), (-1.0, 3.0, 50.0)]
    return [paper, level, *(assemble_pose(UNC, *pose) for pose in others)]


def height(point: AssemblyPoint) -> float:
    """The height of the bolt's origin."""
    return point.pose.translation[2]


def test_the_papers_case_engages(paper: AssemblyPath) -> None:
    """The snap is where the study of rigid turns has it, near 357 to 358 deg; 0.17 to 0.30 mm deep."""
    assert paper.outcome is AssemblyOutcome.ENGAGED
    assert paper.flags == ()
    (snap,) = [event for event in paper.events if event.kind is PathEventKind.SNAP]
    assert 357.0 < snap.phase_deg < 358.0
    assert snap.drop is not None
    assert 0.15 < 25.4 * snap.drop < 0.30
    assert paper.margins is not None
    assert all(margin is not None and margin > 0.0 for margin in vars_of(paper.margins))
    assert paper.points[-1].phase_deg == pytest.approx(snap.phase_deg - 270.0)
    assert height(paper.points[-1]) < -0.7 * UNC.thread_pitch


def vars_of(margins: object) -> list[float | None]:
    """The values of a dataclass with slots."""
    return [getattr(margins, name) for name in margins.__dataclass_fields__]  # type: ignore[attr-defined]


def test_a_whole_turn_without_a_snap(paths: list[AssemblyPath]) -> None:
    for path in paths[2:4]:
        assert path.outcome is AssemblyOutcome.NO_SNAP
        assert path.points[-1].phase_deg == pytest.approx(path.points[0].phase_deg + 360.0)


def test_a_snap_beyond_a_whole_turn_needs_a_hand_that_turns_farther() -> None:
    """A level bolt from phase 0 snaps at 360.51 deg; what is before the end of the shorter turn stays as it is."""
    device = replace(DEVICE, ccw_turn_deg=390.0)
    whole, farther = (assemble_pose(UNC, 0.0, 0.0, 0.0, one) for one in (DEVICE, device))
    assert whole.outcome is AssemblyOutcome.NO_SNAP
    assert farther.outcome is AssemblyOutcome.ENGAGED
    (snap,) = [event for event in farther.events if event.kind is PathEventKind.SNAP]
    assert 360.5 < snap.phase_deg < 360.52
    alike = [point for point in whole.points if point.phase_deg < 358.0]
    assert list(farther.points[: len(alike)]) == alike


@pytest.mark.parametrize("mu", [0.0, 0.1])
def test_a_path_ends_where_it_passes_a_limit_of_the_device(mu: float) -> None:
    """It is the path without limits, up to the first point beyond one."""
    whole = assemble_pose(UNC, 0.0, -4.0, 0.0, mu=mu)
    assert whole.travel is not None
    factor = conversion_factor(UNC.unit, DEVICE.unit)
    points, travel = whole.points, whole.travel
    over = AssemblyOutcome.OVER_TRAVEL
    for name, most, values, outcome in (
        ("tilt_deg", travel.tilt_deg, [math.hypot(*one.rotation_deg) for one in points], over),
        ("shift", travel.shift, [math.hypot(*one.shift[:2]) for one in points], over),
        ("torque", travel.torque, [abs(one.torque) for one in points], AssemblyOutcome.JAMMED),
    ):
        limit = 0.9 * most
        given = limit if name == "tilt_deg" else limit * factor
        path = assemble_pose(UNC, 0.0, -4.0, 0.0, replace(DEVICE, limits=replace(Limits(), **{name: given})), mu=mu)
        beyond = next(k for k, value in enumerate(values) if value > limit)
        assert (path.outcome, path.flags) == (outcome, ())
        assert path.points == points[: beyond + 1]
        assert path.events == whole.events[: len(path.events)]
        assert len(path.events) < len(whole.events)
        assert path.energy is not None
        assert abs(path.energy.balance) < 1e-4
        assert path.margins is not None
        assert (path.margins.torque < 0.0) == (name == "torque")


def test_limits_that_are_not_passed_change_nothing(paper: AssemblyPath) -> None:
    device = replace(DEVICE, limits=Limits(90.0, 25.0, 1e6))
    assert assemble_pose(UNC, *PAPER, device) == paper


def test_a_left_hand_bolt_is_turned_the_other_way_as_far() -> None:
    left = replace(UNC, hand=Hand.LEFT)
    path = assemble_pose(left, 0.0, 4.0, 0.0, replace(DEVICE, ccw_turn_deg=45.0))
    assert path.outcome is AssemblyOutcome.NO_SNAP
    assert path.points[-1].phase_deg == pytest.approx(-45.0)


def test_forces_and_moments_balance_at_each_point(paths: list[AssemblyPath]) -> None:
    """Across the nut's axis; the moment of the tilt's springs is that of the contacts about the bolt's axes."""
    k_lateral, k_tilt = HELD.stiffness[3][3], HELD.stiffness[0][0]
    for path in paths:
        for point in path.points:
            force, moment = np.zeros(3), np.zeros(3)
            for contact in point.contacts:
                assert np.dot(contact.force, contact.normal) > 0.0
                force += contact.force
                moment += np.cross(np.array(contact.point) - point.pose.translation, contact.force)
            assert force[2] == pytest.approx(PUSH, rel=1e-5)
            assert np.allclose(force[:2], k_lateral * np.array(point.shift[:2]), atol=1e-5 * PUSH)
            # The rotation vector is small or along the axis that the bolt turns about: its springs turn it back.
            vector = np.radians(point.rotation_deg)
            angle = float(np.linalg.norm(vector))
            if angle > 1e-3:
                axis = np.array(point.pose.rotation) @ vector / angle
                assert moment @ axis == pytest.approx(k_tilt * angle, abs=1e-5 * PUSH * R)


def test_the_torque_is_that_of_the_contacts_about_the_axis(paths: list[AssemblyPath]) -> None:
    for path in paths:
        for point in path.points:
            moment = np.zeros(3)
            for contact in point.contacts:
                moment += np.cross(np.array(contact.point) - point.pose.translation, contact.force)
            assert point.torque == pytest.approx(-moment[2], abs=1e-9 * PUSH * R)


def test_steps_and_drops_are_bounded(paths: list[AssemblyPath]) -> None:
    """Steps are at most 2 deg; where the origin goes farther than 0.01 r beside the turn, a fall is listed."""
    for path in paths:
        fallen = {event.phase_deg for event in path.events if event.kind in (PathEventKind.FALL, PathEventKind.BRIDGED)}
        for before, after in pairwise(path.points):
            assert 0.0 < abs(after.phase_deg - before.phase_deg) <= 2.0 + 1e-9
            way = math.dist(before.pose.translation, after.pose.translation)
            assert way < 0.012 * R or after.phase_deg in fallen


CLOCKWISE = (1.0, -2.0, 10.0, Strategy.CW)
"""A pose whose bolt is in the thread already, turned clockwise at once."""

HELD_AND_TURNED = [
    (DEVICE, CLOCKWISE),
    (replace(DEVICE, about=About.BOLT), (2.0, -4.0, 345.0, Strategy.CCW_THEN_CW)),
    (replace(DEVICE, centre=10.0), CLOCKWISE),
    (replace(DEVICE, centre=-10.0, about=About.BOLT), CLOCKWISE),
]


@pytest.mark.parametrize(("device", "turned"), HELD_AND_TURNED)
def test_energy_is_balanced(device: Device, turned: tuple[float, float, float, Strategy]) -> None:
    """The work of hand and push is elastic energy or lost in falls: the torque is the potential's derivative."""
    roll, pitch, phase, strategy = turned
    path = assemble_pose(UNC, roll, pitch, phase, device, strategy)
    assert path.outcome is AssemblyOutcome.ENGAGED
    energy = path.energy
    assert energy is not None
    assert energy.work + energy.push - energy.elastic - energy.falls == pytest.approx(energy.balance, abs=1e-12)
    assert abs(energy.balance) < 2e-5 * PUSH * R
    assert abs(energy.work) > 1e-2 * PUSH * R
    for event in path.events:
        if event.kind is PathEventKind.FALL:
            assert event.energy is not None
            assert event.energy > 0.0


def test_a_level_screw_in_phase_goes_down_by_its_lead(level: AssemblyPath) -> None:
    """It lies on a strip of flank, at the limit of the axial play; its torque is that of a screw without friction."""
    assert level.outcome is AssemblyOutcome.ENGAGED
    on_strip = [point for point in level.points if point.held is Held.STRIP]
    assert on_strip[-1] is level.points[-1]
    down = axial_limits(UNC)[0]
    for point in on_strip:
        turn = math.radians(point.phase_deg)
        assert height(point) == pytest.approx(UNC.lead * turn / (2.0 * math.pi) - down - UNC.lead, abs=1e-12)
        assert np.allclose(point.pose.translation[:2], 0.0)
        assert point.torque == pytest.approx(PUSH * UNC.lead / (2.0 * math.pi), rel=1e-8)


def test_deep_in_the_nut_samples_of_all_boundaries_touch_and_do_not_overlap(paper: AssemblyPath) -> None:
    """A brute force that samples both threads finds the height of a bolt deeper than half a pitch."""
    point = paper.points[-1]
    command = pose_rotation(0.0, -4.0, point.phase_deg)
    held = HeldBolt(UNC, command, np.zeros((6, 6)), centre=0.0, push=PUSH, first=0.0)
    place = np.array([*np.radians(point.rotation_deg[:2]), 0.0, *point.shift[:2]])
    assert held.overlap(place, height(point)) == pytest.approx(0.0, abs=1e-8)
    assert held.overlap(place, height(point) - 1e-6) > 1e-8


def test_a_left_hand_pair_is_the_mirror_image(paper: AssemblyPath) -> None:
    left = replace(UNC, designation="left", hand=Hand.LEFT)
    other = assemble_pose(left, 0.0, -4.0, -300.0)
    assert (other.outcome, len(other.points)) == (paper.outcome, len(paper.points))
    assert other.points[-1].phase_deg == pytest.approx(-paper.points[-1].phase_deg, abs=1e-9)
    assert height(other.points[-1]) == pytest.approx(height(paper.points[-1]), abs=1e-9)
    assert other.points[-1].torque == pytest.approx(-paper.points[-1].torque, abs=1e-6 * PUSH * R)


def test_the_same_path_in_millimetres(paper: AssemblyPath) -> None:
    same = assemble_pose(UNC.in_unit(LengthUnit.MILLIMETRE), *PAPER)
    assert same.outcome is paper.outcome
    assert same.points[-1].phase_deg == pytest.approx(paper.points[-1].phase_deg, abs=0.01)
    assert height(same.points[-1]) == pytest.approx(25.4 * height(paper.points[-1]), abs=1e-3)


def test_clockwise_at_once_from_the_surface_is_idle() -> None:
    path = assemble_pose(UNC, -2.0, 2.0, 200.0, strategy=Strategy.CW)
    assert path.outcome is AssemblyOutcome.IDLE
    assert path.points[-1].phase_deg == pytest.approx(-70.0)
    assert path.margins is not None
    assert path.margins.snap is None
    assert path.margins.lead is not None
    assert path.margins.lead < 0.0


def test_another_thread_engages() -> None:
    path = assemble_pose(pair_by_designation("M6-6g/6H"), 0.0, 0.0, 330.0)
    assert path.outcome is AssemblyOutcome.ENGAGED


@pytest.mark.parametrize("longest_step", [2.0, 1.5, 1.0, 0.5])
@pytest.mark.parametrize("phase", [0.0, 30.0, 100.0])
def test_a_level_bolt_in_phase_comes_to_lie_on_the_strip(phase: float, longest_step: float) -> None:
    """Its last tilt, below 1e-5 deg, is passed in a bridged step: before, a step that led too far ended some paths."""
    path = assemble_pose(UNC, 0.0, 0.0, phase, strategy=Strategy.CW, longest_step=longest_step)
    assert (path.outcome, path.flags) == (AssemblyOutcome.ENGAGED, ())
    assert [event.kind for event in path.events].count(PathEventKind.ON_STRIP) == 1
