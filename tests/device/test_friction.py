"""Held bolts with friction: cones, slips, energy, limits, and the aligned screw that locks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.device import _friction_kernel as fk
from threadstate.device import _friction_step_kernel as fs
from threadstate.device import _modes_kernel as mk
from threadstate.device import _strip_kernel as st
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import (
    AssemblyOutcome,
    AssemblyPath,
    AssemblyPoint,
    ContactMotion,
    Held,
    PathEventKind,
)
from threadstate.device.command import command_numbers, strip_numbers
from threadstate.device.contact_changes import contact_changes
from threadstate.device.friction import FrictionLeg, FrictionPath, begin_friction, point_of
from threadstate.device.model import Outcome, SettledFlag, default_device
from threadstate.device.settle import device_numbers, path_with_friction, settle_pose, settled_rows
from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.state.model import FeaturePair
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc
from threadstate.thread.pair import Pair

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()
R = UNC.nominal_diameter / 2.0
DEVICE = default_device()
PUSH = DEVICE.push
MU = 0.02


@dataclass(frozen=True)
class Course:
    """The paper's case with little friction: counter-clockwise to the snap, then clockwise by 35 deg."""

    legs: list[FrictionLeg]
    points: list[AssemblyPoint]
    path: FrictionPath


@pytest.fixture(scope="module")
def course() -> Course:
    """It settles, snaps and begins to go down."""
    held = DEVICE.in_unit(UNC.unit)
    numbers = device_numbers(UNC, held)
    pose = np.array([0.0, -4.0, 300.0])
    _, rows = settled_rows(UNC, held, numbers, pose[None])
    path = path_with_friction(UNC, held, numbers, pose, rows[0][0], MU)
    assert isinstance(path, FrictionPath)
    start = math.radians(300.0)
    assert path.follow((start, start), (0.0, PUSH)).status == fs.REACHED
    first = path.follow((start, start + 2.0 * math.pi), (PUSH, PUSH), stops_at_snap=True)
    snap = float(first.points[-1, fk.P_PHASE])
    second = path.follow((snap, snap - math.radians(35.0)), (PUSH, PUSH))
    assert (first.status, second.status) == (fs.SNAP_REACHED, fs.REACHED)
    points = [
        point_of(row, contacts, path.numbers, path.command)
        for leg in (first, second)
        for row, contacts in zip(leg.points, leg.contacts, strict=True)
    ]
    return Course([first, second], points, path)


def parts(force: tuple[float, float, float], normal: tuple[float, float, float]) -> tuple[float, Floats]:
    """The normal part of a force, and the rest."""
    along = float(np.dot(force, normal))
    return along, np.array(force) - along * np.array(normal)


def test_the_snap_comes_a_little_later_than_without_friction(course: Course) -> None:
    """The friction of the contact on the surface delays it by 0.2 deg."""
    assert math.degrees(course.legs[0].points[-1, fk.P_PHASE]) - 357.67 == pytest.approx(0.19, abs=0.02)
    assert course.path.is_free(course.legs[0].points[-1])


def test_forces_lie_in_their_cones_and_on_them_where_contacts_slide(course: Course) -> None:
    seen = set()
    for point in course.points[1:]:
        for contact, motion in zip(point.contacts, point.motions, strict=True):
            if point.held is Held.STRIP:
                continue
            normal, tangential = parts(contact.force, contact.normal)
            size = float(np.linalg.norm(tangential))
            assert size <= MU * normal + 1e-7 * PUSH
            if motion is ContactMotion.SLIDES:
                assert size == pytest.approx(MU * normal, abs=1e-7 * PUSH)
            seen.add(motion)
    assert ContactMotion.SLIDES in seen


def test_energy_is_balanced_and_friction_loses(course: Course) -> None:
    """Leg by leg: the torque's work and the push's are elastic energy, friction and falls."""
    for leg in course.legs:
        rows = leg.points
        work = float((0.5 * (rows[1:, fk.P_TORQUE] + rows[:-1, fk.P_TORQUE]) * np.diff(rows[:, fk.P_PHASE])).sum())
        friction, falls = float(rows[:, fk.P_FRICTION].sum()), float(rows[:, fk.P_FALL].sum())
        gained = rows[-1, fk.P_POTENTIAL] - rows[0, fk.P_POTENTIAL]
        assert friction > 1e-3 * PUSH * R
        assert (rows[:, fk.P_FRICTION] > -1e-9 * PUSH * R).all()
        assert work - gained - friction - falls == pytest.approx(0.0, abs=5e-3 * friction)


def test_a_contact_that_slides_on_the_surface_takes_its_friction_times_its_radius(course: Course) -> None:
    """On the surface, before the snap: the torque is mu N times the distance of the contact from the nut's axis."""
    point = next(point for point in course.points if 330.0 < point.phase_deg <= 331.0 and len(point.contacts) == 1)
    (contact,) = point.contacts
    normal, _ = parts(contact.force, contact.normal)
    assert point.torque == pytest.approx(MU * normal * math.hypot(*contact.point[:2]), rel=1e-2)


def test_without_friction_it_is_the_frictionless_state() -> None:
    """Next to none: every contact slides, and the bolt is where it is without any."""
    for pose in ((0.0, -4.0, 300.0), (1.0, -2.0, 100.0)):
        smooth, rough = settle_pose(UNC, *pose), settle_pose(UNC, *pose, mu=1e-9)
        assert smooth.outcome is rough.outcome is Outcome.SETTLED
        assert smooth.pose is not None
        assert rough.pose is not None
        assert np.allclose(smooth.pose.translation, rough.pose.translation, rtol=0.0, atol=1e-7 * R)


def test_much_friction_holds_the_point_of_a_single_contact() -> None:
    """The bolt turns about the point in which it has touched first, and its centre is pushed aside."""
    smooth, rough = settle_pose(UNC, 0.0, -4.0, 300.0), settle_pose(UNC, 0.0, -4.0, 300.0, mu=0.5)
    assert rough.outcome is Outcome.SETTLED
    assert smooth.shift is not None
    assert rough.shift is not None
    assert math.hypot(*rough.shift[:2]) > 10.0 * math.hypot(*smooth.shift[:2])
    (contact,) = rough.contacts
    normal, tangential = parts(contact.force, contact.normal)
    assert 0.0 < np.linalg.norm(tangential) < 0.5 * normal


def strip_torque(pair: Pair, mu: float) -> float:
    """The torque, over the push, of a level bolt a pitch and a half deep that is turned clockwise along its strip."""
    held = DEVICE.in_unit(pair.unit)
    numbers = device_numbers(pair, held)
    path = begin_friction(pair, numbers, command_numbers(held, 0.0, 0.0, 0.0), strip_numbers(pair), 0.0, mu)
    assert st.set_strip(-1.5 * pair.thread_pitch, path.numbers, path.strip, pair.bolt.packed, path.q)
    start = path.q[5]
    leg = path.follow((0.0, -0.3), (held.push, held.push))
    points = [
        point_of(row, contacts, path.numbers, path.command)
        for row, contacts in zip(leg.points, leg.contacts, strict=True)
    ]
    assert all(point.held is Held.STRIP for point in points[1:])
    for before, after in pairwise(points[1:]):
        assert after.pose.translation[2] < before.pose.translation[2]
    sunk = start - path.q[5]
    assert sunk == pytest.approx(pair.lead * 0.3 / (2.0 * math.pi), rel=1e-9)
    return points[-1].torque / held.push


@pytest.mark.parametrize("name", ["1/4-20 UNC", "M20"])
def test_an_aligned_screw_locks_between_the_frictions_of_its_radii(name: str) -> None:
    """It has to be held back below, and driven above, tan(lead) cos(half-angle) of the radius at which it bears."""
    pair = UNC if name == "1/4-20 UNC" else pair_by_designation("M20x2.5-6g/6H")
    strip = strip_numbers(pair)
    k = pair.lead / (2.0 * math.pi)
    least, largest = (k / radius * math.cos(math.radians(30.0)) for radius in (strip[st.S_HIGH], strip[st.S_LOW]))
    published = {"1/4-20 UNC": 0.0634, "M20": 0.0375}[name]
    assert least < published < largest
    # To second order in the lead the friction of a radius is larger: 0.5 % at 4 deg.
    assert strip_torque(pair, 0.99 * least) > 0.0
    assert strip_torque(pair, 1.02 * largest) < 0.0
    assert strip_torque(pair, 0.0) == pytest.approx(k, rel=1e-8)


def test_what_a_step_meets_is_one_of_its_contacts() -> None:
    """Steps have a solution also where the bolt meets what without friction it would not touch; two falls do not.

    With the contacts of the frictionless bolt alone 149 steps of this path had none.
    """
    path = assemble_pose(UNC, 2.0, 3.0, 13.0, strategy=Strategy.CW, mu=0.2)
    assert path.outcome is AssemblyOutcome.IDLE
    assert sum(event.kind is PathEventKind.FALL for event in path.events) == 2
    assert sum(point.solutions == 0 for point in path.points[1:]) < 10
    assert sum(event.kind is PathEventKind.GAINED for event in path.events) >= 5


def test_after_a_fall_friction_comes_up_again() -> None:
    """A path goes on from its snap in steps that are long enough: with the least ones none had a solution."""
    path = assemble_pose(UNC, -3.0, -2.0, 169.0, mu=0.1)
    assert path.outcome is AssemblyOutcome.ENGAGED
    assert path.energy is not None
    assert abs(path.energy.balance) < 1e-3 * path.energy.friction
    snap = next(event.phase_deg for event in path.events if event.kind is PathEventKind.SNAP)
    back = next(i for i, point in enumerate(path.points) if point.phase_deg == snap)
    assert all(point.solutions == 1 for point in path.points[back + 2 :])


@pytest.mark.parametrize("phase_deg", [0.0, 60.0, 180.0, 350.0])
def test_a_level_bolt_whose_patch_does_not_hold_it_tips_at_once(phase_deg: float) -> None:
    """Next to no friction it settles where it does without; with more nearer to where it was."""
    smooth, next_to_smooth, rough = (settle_pose(UNC, 0.0, 0.0, phase_deg, mu=mu) for mu in (0.0, 1e-6, 0.3))
    assert {state.outcome for state in (smooth, next_to_smooth, rough)} == {Outcome.SETTLED}
    assert SettledFlag.FLUSH not in smooth.flags + next_to_smooth.flags + rough.flags
    assert smooth.pose is not None
    assert next_to_smooth.pose is not None
    assert rough.pose is not None
    assert np.allclose(smooth.pose.translation, next_to_smooth.pose.translation, rtol=0.0, atol=1e-5 * R)
    assert len(next_to_smooth.contacts) == len(smooth.contacts)
    assert -rough.pose.translation[2] < -smooth.pose.translation[2]


def test_a_level_bolt_that_tips_at_once_is_turned() -> None:
    path = assemble_pose(UNC, 0.0, 0.0, 180.0, mu=0.1)
    assert (path.outcome, path.flags) == (AssemblyOutcome.ENGAGED, ())
    assert path.energy is not None
    assert abs(path.energy.balance) < 1e-3 * path.energy.friction


@pytest.mark.parametrize("mu", [-0.1, 1.5, math.nan, math.inf])
def test_bad_frictions_are_refused(mu: float) -> None:
    with pytest.raises(InvalidValueError, match=r"mu is .*; valid: 0 to 1"):
        settle_pose(UNC, 0.0, -4.0, 300.0, mu=mu)
    with pytest.raises(InvalidValueError, match="mu is"):
        assemble_pose(UNC, 0.0, -4.0, 300.0, mu=mu)


@pytest.mark.parametrize("step", [0.0, 0.2, 3.0, math.nan])
def test_bad_longest_steps_are_refused(step: float) -> None:
    with pytest.raises(InvalidValueError, match=r"longest_step is .*; valid: 0.25 to 2 deg"):
        assemble_pose(UNC, 0.0, -4.0, 300.0, longest_step=step)


def test_equations_of_a_step_are_solved_by_elimination() -> None:
    rng = np.random.default_rng(5)
    for size in (1, 4, 11):
        matrix = np.zeros((mk.MOST_UNKNOWNS, mk.MOST_UNKNOWNS + 1))
        left, right = rng.standard_normal((size, size)), rng.standard_normal(size)
        matrix[:size, :size], matrix[:size, size] = left, right
        assert mk.solve_linear(size, matrix)
        assert np.allclose(left @ matrix[:size, size], right)
    assert not mk.solve_linear(2, np.zeros((2, 3)))


def test_an_end_with_an_overlap_below_what_is_allowed_is_certified() -> None:
    """An edge overlaps by 2e-9 nominal radii (decision 53)."""
    state = settle_pose(UNC, 3.0, -4.0, 15.0, mu=0.2)
    assert (state.outcome, state.flags) == (Outcome.SETTLED, ())


@pytest.mark.parametrize("phase_deg", [-0.5, 0.1, 0.3])
def test_a_bolt_settles_with_friction_all_the_way(phase_deg: float) -> None:
    """Within 0.2 deg of phase 0 round-off decides: 1e-9 deg beside, one falls as without friction, another does not."""
    state = settle_pose(UNC, -3.0, 4.0, phase_deg, mu=0.1)
    assert (state.outcome, state.flags, state.falls) == (Outcome.SETTLED, (), ())


def changes(path: AssemblyPath, features: FeaturePair, low: float, high: float) -> list[tuple[PathEventKind, float]]:
    """Contacts of these features that a path gains and loses between two phases in degrees."""
    return [
        (change.kind, change.phase_deg)
        for change in contact_changes(path.events)
        if change.features is features and low < change.phase_deg < high
    ]


def turned(roll: float, pitch: float, phase: float, mu: float, step: float = 1.0) -> AssemblyPath:
    """A bolt that is turned clockwise; angles in degrees."""
    return assemble_pose(UNC, roll, pitch, phase, strategy=Strategy.CW, mu=mu, longest_step=step)


def test_two_points_of_a_nearly_level_ridge_are_one_contact() -> None:
    """On it the deepest point runs from one end to the other: for 50 deg two points shared the force."""
    path = turned(2.443398275329794, 2.0014407856355927, 143.00615586286324, 0.02)
    for point in path.points:
        places = [c.point for c in point.contacts if c.features is FeaturePair.THREAD_THREAD]
        assert all(math.dist(one, other) > 0.1 * R for one, other in combinations(places, 2))
    assert not changes(path, FeaturePair.THREAD_THREAD, -120.0, -75.0)


@pytest.mark.parametrize("step", [1.0, 0.5])
def test_a_contact_that_a_like_one_beside_it_takes_over_from_is_seen(step: float) -> None:
    """For 0.9 deg both touch, 0.02 rad apart on the bolt's edge."""
    path = turned(-0.22865815778796428, -1.8572114764081338, 8.660473603462236, 0.1, step)
    (first, gained_deg), (second, lost_deg) = changes(path, FeaturePair.EDGE_THREAD, -74.5, -73.0)
    assert (first, second) == (PathEventKind.GAINED, PathEventKind.LOST)
    assert gained_deg == pytest.approx(-73.3, abs=0.1)
    assert lost_deg == pytest.approx(-74.15, abs=0.1)


@pytest.mark.parametrize("step", [1.0, 0.5])
def test_a_bolt_tips_off_the_surface_where_it_would_lie_again_later_in_the_step(step: float) -> None:
    """Between phases -356.6 and -357.4 deg it does not lie on the surface."""
    path = turned(1.2777020959327414, 2.484915940493546, -168.16116983823713, 0.2, step)
    (tips,) = (event for event in path.events if event.kind is PathEventKind.OFF_SURFACE)
    assert tips.phase_deg == pytest.approx(-356.62, abs=0.1)


def test_a_bolt_that_begins_to_slide_on_the_surface_need_not_lie_in_parts_of_its_first_step() -> None:
    """In steps of less than 0.1 deg friction has not turned to where the bolt slides, and has it tip and fall back."""
    path = turned(2.763518232243178, 2.153431998152966, -115.55972364812288, 0.2)
    assert path.outcome is AssemblyOutcome.IDLE
    assert all(point.held is Held.SURFACE for point in path.points if point.phase_deg > -350.0)


def test_a_step_is_short_where_the_path_bends() -> None:
    """At phase -0.3 deg it bends, and a contact that comes 0.2 deg later is soon lost: steps of 0.25 deg missed it."""
    roll, pitch, phase, mu = -3.3353393116151597, -2.812265307131316, -0.26475808852978844, 0.02
    for step in (1.0, 0.5):
        found = changes(turned(roll, pitch, phase, mu, step), FeaturePair.THREAD_EDGE, -1.0, 0.0)
        assert [kind for kind, _ in found] == [PathEventKind.GAINED, PathEventKind.LOST]


def test_the_last_step_of_a_leg_is_not_one_of_round_off() -> None:
    """This one's was one of 2e-12 deg; in such a step another bolt lost a contact."""
    path = turned(3.6083457371164442, -1.8548811219210544, -34.61874938587022, 0.05)
    phases = [point.phase_deg for point in path.points]
    assert all(one - other > 1e-6 for one, other in pairwise(phases))
