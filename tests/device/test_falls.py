"""Bolts that fall with friction, bolts that tip off the surface, and paths that branch."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.device import _chart_kernel as ck
from threadstate.device import _friction_fall_kernel as ff
from threadstate.device import _friction_kernel as fk
from threadstate.device import _friction_step_kernel as fs
from threadstate.device import _leg_kernel as lk
from threadstate.device import _modes_kernel as mk
from threadstate.device import _settle_kernel as sk
from threadstate.device import _slide_kernel as sl
from threadstate.device import _turn_kernel as tk
from threadstate.device import assemble
from threadstate.device._descent_kernel import AT_REST
from threadstate.device._places_kernel import new_threads
from threadstate.device._rest_kernel import new_work
from threadstate.device._step_modes_kernel import new_solutions
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath, ContactMotion, Held, PathEventKind
from threadstate.device.branches import MOST_PATHS, MOST_STARTS, SAME, Followed, FollowedLeg, PlannedLeg, all_paths
from threadstate.device.command import command_numbers, strip_numbers
from threadstate.device.equilibrium import BALANCED, balance
from threadstate.device.friction import FrictionBranch, FrictionLeg, FrictionPath, contact_of
from threadstate.device.model import LoadedContact, Outcome, SettledFlag, default_device
from threadstate.device.settle import device_numbers, path_with_friction, settle_pose, settled_rows
from threadstate.device.strategy import Strategy
from threadstate.device.watch import PathWatch
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()
HELD = default_device().in_unit(UNC.unit)
PUSH = HELD.push
R = UNC.nominal_diameter / 2.0


class Falling:
    """A bolt at its first contact under the whole push, which nothing balances there."""

    def __init__(self, roll_deg: float, pitch_deg: float, phase_deg: float) -> None:
        self.numbers = device_numbers(UNC, HELD)
        pose = np.array([roll_deg, pitch_deg, phase_deg])
        _, rows = settled_rows(UNC, HELD, self.numbers, pose[None])
        height = float(rows[0][0][sk.R_HEIGHT])
        self.command = command_numbers(HELD, roll_deg, pitch_deg, height)
        lk.set_phase(math.radians(phase_deg), self.command, self.numbers)
        self.q = np.zeros(ck.COORDINATES)
        self.q[3:] = self.numbers[ck.D_PLACE : ck.D_PLACE + 3]
        bolt, nut = UNC.bolt.packed, UNC.nut.packed
        self.setting = (
            self.command,
            self.numbers,
            strip_numbers(UNC),
            bolt,
            nut,
            new_threads(bolt),
            new_work(),
            mk.new_modes_work(),
        )
        self.contacts = np.zeros((8, mk.CONTACT_SIZE))
        self.losses = np.zeros(4)

    def potential(self) -> float:
        return float(ck.elastic_energy(self.q, self.numbers, np.empty(ck.COORDINATES)) + PUSH * self.q[5])

    def place(self) -> Floats:
        place = np.empty(ck.PLACE_SIZE)
        ck.set_place(self.q, self.numbers, place)
        return place

    def flow(self, mu: float) -> tuple[int, int, int]:
        solutions = new_solutions()
        ended = ff.flow(
            self.q,
            PUSH,
            mu,
            ff.LOWERED,
            False,
            self.place(),
            0,
            self.contacts,
            self.setting,
            solutions,
            self.losses,
        )
        ff.end_drag(self.setting[7])
        return cast("tuple[int, int, int]", ended)


COMMANDS = [(0.0, -4.0, 300.0), (3.0, 2.0, 40.0), (-2.0, -3.0, 170.0)]


@pytest.mark.parametrize("pose_deg", COMMANDS)
def test_next_to_without_friction_a_fall_ends_where_the_steepest_descent_does(
    pose_deg: tuple[float, float, float],
) -> None:
    flowing, descending = Falling(*pose_deg), Falling(*pose_deg)
    kind, count, ended = flowing.flow(1e-7)
    assert (kind, ended) == (lk.ON_CONTACTS, fs.GOES_ON)
    _, device, _, bolt, nut, threads, work, _ = descending.setting
    status, _ = tk.fall_down(descending.q, PUSH, device, bolt, nut, threads, work)
    assert status == AT_REST
    assert count > 0
    assert sk.distance(flowing.q, descending.q, flowing.numbers) < 1e-5 * R


@pytest.mark.parametrize("pose_deg", COMMANDS)
@pytest.mark.parametrize("mu", [0.05, 0.3])
def test_a_fall_ends_in_equilibrium_inside_the_cones_and_takes_energy(
    pose_deg: tuple[float, float, float], mu: float
) -> None:
    fall = Falling(*pose_deg)
    before = fall.potential()
    kind, count, ended = fall.flow(mu)
    assert (kind, ended) == (lk.ON_CONTACTS, fs.GOES_ON)
    contacts = [contact_of(row) for row in fall.contacts[:count]]
    assert balance(UNC, HELD, fall.q, fall.place()[:12], fall.numbers, contacts) <= BALANCED
    for contact in contacts:
        force, normal = np.array(contact.force), np.array(contact.normal)
        along = float(force @ normal)
        assert along > 0.0
        assert np.linalg.norm(force - along * normal) <= mu * along + 1e-8 * PUSH
    lost = before - fall.potential()
    assert 0.0 <= fall.losses[0] <= lost
    has_slid = (fall.contacts[:count, mk.K_MODE] == mk.SLIPS).any()
    assert fall.losses[0] > 0.0 or not has_slid


def friction(contact: LoadedContact) -> float:
    """The size of the force across a contact's normal."""
    force, normal = np.array(contact.force), np.array(contact.normal)
    return float(np.linalg.norm(force - (force @ normal) * normal))


@pytest.mark.parametrize(
    ("roll_deg", "pitch_deg"),
    [
        pytest.param(0.0, -4.0, id="a contact moves from an edge to the thread beside it"),
        pytest.param(-2.0, -4.0, id="a third contact is held at last by friction"),
        pytest.param(-4.0, -4.0, id="a thread's place is close to a crossing of both edges"),
        pytest.param(4.0, 0.0, id="an open contact overlaps where another one is met"),
    ],
)
def test_falls_on_a_path_end_with_friction(roll_deg: float, pitch_deg: float) -> None:
    path = assemble_pose(UNC, roll_deg, pitch_deg, 30.0, mu=0.3)
    ends = [point for point in path.points if point.solutions == 0 and point.held is Held.CONTACTS]
    assert ends
    for point in ends:
        assert max(friction(contact) for contact in point.contacts) > 1e-3 * PUSH


@pytest.mark.parametrize(("phase_deg", "longest_step"), [(15.0, 1.0), (60.0, 0.35), (180.0, 1.0)])
def test_a_fall_beside_a_ridge_ends_where_friction_holds_the_bolt(phase_deg: float, longest_step: float) -> None:
    """Its steps have no solution unless contacts of the threads are frozen, and without friction it snaps."""
    path = assemble_pose(UNC, -3.0, -1.0, phase_deg, mu=0.3, longest_step=longest_step)
    assert path.outcome is AssemblyOutcome.NO_SNAP
    assert path.margins is not None
    assert path.margins.snap is not None
    assert 1.0 + path.margins.snap / (0.05 * UNC.thread_pitch) == pytest.approx(0.8, abs=0.03)
    assert not bare_falls(path)


def test_a_long_fall_ends_with_friction() -> None:
    """It takes hundreds of steps: in most of them the bolt goes by some 1e-5 nominal radii."""
    path = assemble_pose(UNC, 3.0, -4.0, 75.0, mu=0.1)
    assert path.outcome is AssemblyOutcome.ENGAGED
    snap = next(event for event in path.events if event.kind is PathEventKind.SNAP)
    at = next(i for i, point in enumerate(path.points) if point.phase_deg == snap.phase_deg)
    assert path.points[at].solutions == 0
    assert max(friction(contact) for contact in path.points[at].contacts) > 1e-3 * PUSH


@pytest.mark.parametrize("longest_step", [1.0, 0.5])
def test_a_solution_of_the_shortest_step_that_is_a_finite_way_off_is_a_fall(longest_step: float) -> None:
    """From phase 2.44 deg on a step has one that is lower by 0.02 pitches; the fall ends after 0.004."""
    path = assemble_pose(UNC, -3.0, 0.0, 0.0, mu=0.1, longest_step=longest_step)
    assert path.outcome is AssemblyOutcome.NO_SNAP
    falls = [event for event in path.events if event.kind is PathEventKind.FALL and event.phase_deg < 3.0]
    assert max(event.drop or 0.0 for event in falls) < 0.005 * UNC.thread_pitch


def test_a_fall_that_friction_ends_early_is_no_snap() -> None:
    """Without friction this bolt falls by 1.3 times what a snap is; the witness has 0.91 of it, with half the steps
    0.96 (decision 44)."""
    path = assemble_pose(UNC, -4.0, -3.0, 30.0, mu=0.3)
    assert path.outcome is AssemblyOutcome.NO_SNAP
    assert path.margins is not None
    assert path.margins.snap is not None
    assert 0.9 < 1.0 + path.margins.snap / (0.05 * UNC.thread_pitch) < 1.0


def test_a_bolt_tips_off_the_surface_without_a_fall() -> None:
    """Where the centre of pressure leaves the hull both contacts that are left carry what the pressure did."""
    path = assemble_pose(UNC, 1.0, -1.0, 300.0, mu=0.2)
    points = path.points
    tips = next(
        i for i in range(1, len(points)) if points[i].held is not Held.SURFACE and points[i - 1].held is Held.SURFACE
    )
    before, after = points[tips - 1], points[tips]
    assert len(after.contacts) == 2
    tilt_deg = math.degrees(math.hypot(*after.pose.rotation[2][:2]))
    assert 0.0 < tilt_deg < 0.02
    assert after.torque == pytest.approx(before.torque, rel=1e-2)
    falls = [event.phase_deg for event in path.events if event.kind is PathEventKind.FALL]
    assert all(abs(phase - after.phase_deg) > 1.0 for phase in falls)
    assert path.outcome is AssemblyOutcome.ENGAGED


@pytest.mark.parametrize("inside", [1e-2, 1e-4, 1e-6, 1e-9])
def test_weights_are_found_beside_the_hulls_outline(inside: float) -> None:
    """However near the centre of pressure is to a side, the weights of greatest entropy have it as their centre."""
    angles = np.linspace(0.0, 2.0 * math.pi, 40, endpoint=False)
    points = np.zeros((40, 4))
    points[:, 0], points[:, 1] = np.cos(angles), np.sin(angles)
    middle = 0.5 * (points[3, :2] + points[4, :2])
    x, y = (1.0 - inside) * middle
    weights = np.empty(40)
    assert sl.set_weights(40, points, x, y, 1.0, np.zeros(2), weights)
    assert weights.min() >= 0.0
    assert weights @ points[:, :2] == pytest.approx((x, y), abs=1e-11)
    assert not sl.set_weights(40, points, *(1.001 * middle), 1.0, np.zeros(2), weights)
    assert sl.set_weights_inside(40, points, *(1.001 * middle), 1.0, np.zeros(2), weights)


def test_a_leg_that_has_begun_goes_on_as_it_did() -> None:
    pose = np.array([0.0, -4.0, 300.0])
    numbers = device_numbers(UNC, HELD)
    _, rows = settled_rows(UNC, HELD, numbers, pose[None])
    path = path_with_friction(UNC, HELD, numbers, pose, rows[0][0], 0.1)
    assert isinstance(path, FrictionPath)
    assert path.follow((math.radians(300.0),) * 2, (0.0, PUSH)).status == fs.REACHED
    again = path.copy()
    phases = (math.radians(300.0), math.radians(330.0))
    whole = path.follow(phases, (PUSH, PUSH))
    part = FrictionBranch(whole.points[:20], whole.contacts[:20])
    rest = again.follow(phases, (PUSH, PUSH), begun=part)
    assert rest.status == whole.status == fs.REACHED
    assert (rest.points[:20] == whole.points[:20]).all()
    assert sk.distance(path.q, again.q, path.numbers) < 1e-3 * R


class Scripted:
    """A bolt whose legs are written down: what all_paths makes of branches."""

    def __init__(self, script: dict[float, FrictionLeg], numbers: Floats, begun_at: list[float]) -> None:
        self.script, self.numbers, self.command = script, numbers, np.zeros(1)
        self.begun_at = begun_at
        self.watch = PathWatch()

    def copy(self) -> Scripted:
        return self

    def follow(
        self, _phases: tuple[float, float], _pushes: tuple[float, float], *, begun: FrictionBranch | None, **_: Any
    ) -> FrictionLeg:
        height = math.nan if begun is None else float(begun.points[-1, fk.P_COORDINATES + 5])
        self.begun_at.append(height)
        return self.script[0.0 if begun is None else height]


def rows_at(heights: list[float]) -> Floats:
    rows = np.zeros((len(heights), fk.POINT_SIZE))
    rows[:, fk.P_PHASE] = np.linspace(0.0, 1.0, 5)[: len(heights)]
    rows[:, fk.P_COORDINATES + 5] = heights
    return rows


def leg_of(heights: list[float], *branches: list[float], has_more: bool = False) -> FrictionLeg:
    def contacts(count: int) -> Floats:
        return np.zeros((count, 8, mk.CONTACT_SIZE))

    others = tuple(FrictionBranch(rows_at(branch), contacts(len(branch))) for branch in branches)
    return FrictionLeg(fs.REACHED, rows_at(heights), contacts(len(heights)), others, has_more)


@pytest.fixture
def scripted(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setattr("threadstate.device.branches.point_of", lambda *_: None)
    monkeypatch.setattr("threadstate.device.branches.friction_events", lambda *_: [])

    def run(script: dict[float, FrictionLeg]) -> tuple[list[list[FollowedLeg]], bool, list[float]]:
        begun_at: list[float] = []
        bolt = Scripted(script, device_numbers(UNC, HELD), begun_at)
        followed = all_paths(cast("FrictionPath", bolt), 0.0, [PlannedLeg(1.0, (PUSH, PUSH))])
        return followed.paths, followed.is_whole, begun_at

    return run


def test_a_branch_is_followed_from_its_point_on(scripted: Any) -> None:
    other = 0.1 * R
    paths, is_whole, begun_at = scripted(
        {0.0: leg_of([0, 0, 0, 0, 0], [0, 0, other]), other: leg_of([0, 0, other, 0, other])}
    )
    assert (len(paths), is_whole) == (2, True)
    assert begun_at[1] == other


def test_a_branch_that_comes_back_to_a_path_is_not_followed(scripted: Any) -> None:
    """Two steps in a row have two solutions, and each the same two: there are two paths."""
    other = 0.1 * R
    near = other + 0.1 * SAME * R
    paths, is_whole, _ = scripted(
        {
            0.0: leg_of([0, 0, 0, 0, 0], [0, 0, other], [0, 0, 0, near]),
            other: leg_of([0, 0, other, other, other], [0, 0, other, 0.1 * SAME * R]),
        }
    )
    assert (len(paths), is_whole) == (2, True)


def test_a_branch_that_has_come_back_at_the_end_of_a_leg_is_the_path_from_there_on(scripted: Any) -> None:
    other = 0.1 * R
    paths, is_whole, begun_at = scripted(
        {0.0: leg_of([0, 0, 0, 0, 0], [0, 0, other]), other: leg_of([0, 0, other, 0, 0])}
    )
    assert (len(paths), is_whole) == (1, True)
    assert begun_at[1:] == [other]


def test_a_branch_that_comes_to_one_that_has_come_back_is_not_followed(scripted: Any) -> None:
    other, half = 0.1 * R, 0.05 * R
    paths, is_whole, begun_at = scripted(
        {0.0: leg_of([0, 0, 0, 0, 0], [0, 0, other], [0, 0, 0, half]), other: leg_of([0, 0, other, half, 0])}
    )
    assert (len(paths), is_whole) == (1, True)
    assert begun_at[1:] == [other]


def test_branches_that_come_back_again_and_again_leave_it_open(scripted: Any) -> None:
    """Each branch has another one: they are followed up to a number of them."""
    script = {0.0: leg_of([0, 0, 0, 0, 0], [0, 0, 0.1 * R])}
    for i in range(1, MOST_STARTS + 2):
        script[0.1 * R * i] = leg_of([0, 0, 0.1 * R * i, 0, 0], [0, 0, 0.1 * R * (i + 1)])
    paths, is_whole, begun_at = scripted(script)
    assert (len(paths), is_whole) == (1, False)
    assert len(begun_at) == MOST_STARTS


def test_more_branches_than_are_followed_leave_it_open(scripted: Any) -> None:
    script = {0.0: leg_of([0, 0, 0, 0, 0], *([0, 0, 0.1 * R * i] for i in range(1, MOST_PATHS + 2)))}
    for i in range(1, MOST_PATHS + 2):
        script[0.1 * R * i] = leg_of([0, 0, 0.1 * R * i, 0, 0.1 * R * i])
    paths, is_whole, _ = scripted(script)
    assert (len(paths), is_whole) == (MOST_PATHS, False)
    assert not scripted({0.0: leg_of([0, 0, 0, 0, 0], has_more=True)})[1]


def test_a_bolt_that_settles_in_several_places_is_ambiguous_but_may_have_one_outcome() -> None:
    """A contact may rest or slide as the push grows; the turn forgets which it was."""
    state = settle_pose(UNC, -1.0, 0.0, 0.0, mu=0.2)
    assert (state.outcome, state.flags) == (Outcome.UNDECIDED, (SettledFlag.AMBIGUOUS,))
    assert (state.pose, state.shift, state.rotation_deg, state.elastic_energy) == (None, None, None, None)
    assert state.contacts == ()
    assert len(state.path) > 1
    path = assemble_pose(UNC, -1.0, 0.0, 0.0, mu=0.2)
    assert (path.start.outcome, path.start.flags) == (Outcome.SETTLED, (SettledFlag.AMBIGUOUS,))
    assert path.outcome is AssemblyOutcome.NO_SNAP
    assert path.points[0].pose == path.start.pose


def test_after_a_snap_contacts_slide_back_in_the_shortest_step() -> None:
    """Their forces turn round at once: what the longer steps find begins the shorter ones."""
    path = assemble_pose(UNC, -2.0, -4.0, 30.0, mu=0.3)
    assert path.outcome is AssemblyOutcome.ENGAGED
    snap = next(event for event in path.events if event.kind is PathEventKind.SNAP)
    at = next(i for i, point in enumerate(path.points) if point.phase_deg == snap.phase_deg)
    assert abs(path.points[at + 1].phase_deg - snap.phase_deg) < 0.01
    assert path.points[at + 1].motions == (ContactMotion.SLIDES, ContactMotion.SLIDES, ContactMotion.STICKS)
    assert len(path.points) < 1000
    assert path.points[at + 1].solutions == 1


def bare_falls(path: AssemblyPath) -> list[int]:
    """The points of a path to which the bolt has fallen without friction."""
    return [
        i
        for i, point in enumerate(path.points)
        if point.solutions == 0 and all(friction(contact) < 1e-9 * PUSH for contact in point.contacts)
    ]


def test_after_a_fall_without_friction_it_grows_from_none() -> None:
    """No step of this fall off the surface goes on, and friction does not hold the bolt there."""
    path = assemble_pose(UNC, 1.0, -3.0, 210.0, strategy=Strategy.CW, mu=0.2)
    assert path.outcome is AssemblyOutcome.IDLE
    bare = bare_falls(path)
    assert bare
    told = [event.phase_deg for event in path.events if event.kind is PathEventKind.FRICTIONLESS_FALL]
    assert told == [path.points[i].phase_deg for i in bare]
    assert all(path.points[i + 1].solutions == 1 for i in bare)
    after = path.points[bare[0] + 1]
    sliding = [
        contact for contact, motion in zip(after.contacts, after.motions, strict=True) if motion is ContactMotion.SLIDES
    ]
    assert sliding
    for contact in sliding:
        assert friction(contact) == pytest.approx(0.2 * float(np.dot(contact.force, contact.normal)), abs=1e-7 * PUSH)


def test_a_path_that_falls_without_friction_again_and_again_is_undecided() -> None:
    """Its contacts wedge it in with more than a hundred times the push."""
    path = assemble_pose(UNC, 4.0, -1.0, 120.0, strategy=Strategy.CW, mu=0.2, longest_step=0.5)
    assert (path.outcome, path.flags) == (AssemblyOutcome.UNDECIDED, (SettledFlag.UNSETTLED,))
    last = len(path.points) - 1
    assert bare_falls(path) == list(range(last + 1 - fk.MOST_BARE, last + 1))


@pytest.mark.parametrize(("is_jammed", "is_whole"), [(False, True), (True, True), (False, False)])
def test_a_path_is_ambiguous_where_its_branches_end_otherwise(
    monkeypatch: pytest.MonkeyPatch, *, is_jammed: bool, is_whole: bool
) -> None:
    def branched(*arguments: Any) -> Followed:
        followed = all_paths(*arguments)
        (path,) = followed.paths
        legs = list(path)
        if is_jammed:
            legs[-1] = replace(legs[-1], rows=replace(legs[-1].rows, status=fs.TORQUE_OVER))
        return replace(followed, paths=[path, legs], is_whole=is_whole)

    monkeypatch.setattr(assemble, "all_paths", branched)
    path = assemble_pose(UNC, -4.0, 4.0, 300.0, mu=0.2)
    if is_jammed or not is_whole:
        assert (path.outcome, path.flags) == (AssemblyOutcome.UNDECIDED, (SettledFlag.AMBIGUOUS,))
    else:
        assert (path.outcome, path.flags) == (AssemblyOutcome.NO_SNAP, ())
