"""Paths of a bolt that a device settles on the nut and turns (forces, section 5)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from threadstate.device import _chart_kernel as ck
from threadstate.device import _friction_kernel as fk
from threadstate.device import _friction_step_kernel as fs
from threadstate.device import _rest_kernel as rest
from threadstate.device import _settle_kernel as sk
from threadstate.device import _strip_kernel as st
from threadstate.device import _turn_kernel as tk
from threadstate.device._certificate_kernel import FREE
from threadstate.device.assembly_model import (
    AssemblyEnergy,
    AssemblyOutcome,
    AssemblyPath,
    AssemblyPoint,
    AssemblyTravel,
    Held,
    PathEvent,
    PathEventKind,
)
from threadstate.device.assembly_outcome import Ending, first_beyond, outcome_of
from threadstate.device.branches import Followed, FollowedLeg, KnownPaths, PlannedLeg, all_paths
from threadstate.device.command import (
    LONGEST_STEP_DEG,
    LONGEST_STEP_WITH_FRICTION_DEG,
    command_numbers,
    strip_numbers,
)
from threadstate.device.flush import level_numbers
from threadstate.device.friction import REASONS as FRICTION_REASONS
from threadstate.device.friction import FrictionPath, settled_with_friction, snap_event
from threadstate.device.model import (
    Device,
    Limits,
    LoadedContact,
    Outcome,
    SettledFlag,
    SettledState,
    default_device,
)
from threadstate.device.settle import (
    FEATURES,
    REASONS,
    check_friction,
    check_pair,
    device_numbers,
    growing_push,
    path_with_friction,
    settled_rows,
    settled_state,
    vector_of,
)
from threadstate.device.strategy import CLOCKWISE_DEG, Strategy
from threadstate.device.watch import PathWatch
from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.state.model import FeaturePair, StagePose
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair

__all__ = ["assemble_pose"]

Floats = NDArray[np.float64]

LEAST_LONGEST_STEP_DEG = 0.25
"""The least longest step: with shorter ones the farthest turn has more points than a leg has room for."""

EVENTS = {
    tk.GAINED: PathEventKind.GAINED,
    tk.LOST: PathEventKind.LOST,
    tk.MOVED: PathEventKind.MOVED,
    tk.FALL: PathEventKind.FALL,
    tk.ON_FLUSH: PathEventKind.ON_SURFACE,
    tk.OFF_FLUSH: PathEventKind.OFF_SURFACE,
    tk.ON_FLANK: PathEventKind.ON_STRIP,
    tk.OFF_STRIP: PathEventKind.OFF_STRIP,
    tk.BRIDGED: PathEventKind.BRIDGED,
}

HELD = (Held.CONTACTS, Held.SURFACE, Held.STRIP)


def assemble_pose(
    pair: Pair,
    roll_deg: float,
    pitch_deg: float,
    phase_deg: float,
    device: Device | None = None,
    strategy: Strategy = Strategy.CCW_THEN_CW,
    *,
    mu: float = 0.0,
    longest_step: float | None = None,
    watch: PathWatch | None = None,
    known: KnownPaths | None = None,
) -> AssemblyPath:
    """The path of a bolt that settles at a commanded pose and is turned; angles in degrees.

    Forces, section 5; a left-hand bolt is turned the other way round. The device is the default one of forces, section
    4, unless another is given. The path is a sequence of equilibria, at most ``longest_step`` (deg) of phase apart, and
    0.05 deg where contacts change. It is 2 deg, or 1 deg with friction, unless another is given, and with friction the
    push grows by at most 1/16 of its whole a step, in proportion. The same input gives the same bits. By ``watch``
    another thread sees how far it is, and stops it. With friction ``known`` are paths from other phases, of the same
    command else: one that comes to within 1e-4 nominal radii of one goes on as that does. It is added to them if it is
    the only one from its phase, and its outcome is certain and no other's that it has come to.

    Raises:
        InvalidValueError: as :func:`threadstate.device.settle.settle_pose`; a longest step outside 0.25 to 2 deg.
        PathStoppedError: the path was stopped.
    """
    watch = watch or PathWatch()
    wanted = checked_poses([(roll_deg, pitch_deg, phase_deg)])
    check_friction(mu)
    check_pair(pair)
    longest = _checked_step(longest_step, mu)
    held = (device or default_device()).in_unit(pair.unit)
    numbers = device_numbers(pair, held)
    rotations, rows = settled_rows(pair, held, numbers, wanted)
    row = tuple(part[0] for part in rows)
    command = command_numbers(held, float(wanted[0, 0]), float(wanted[0, 1]), float(row[0][sk.R_HEIGHT]), longest)
    plan = plan_of(pair, strategy, held)
    phase = math.radians(wanted[0, 2])
    if mu == 0.0:
        start = settled_state(pair, held, numbers, wanted[0], rotations[0], row)
        if start.outcome is not Outcome.SETTLED:
            return _unsettled(start, strategy, mu)
        course = _without_friction(pair, held, numbers, command, row, phase, plan, watch)
        return _path(pair, held, start, strategy, mu, course)
    path = path_with_friction(pair, held, numbers, wanted[0], row[0], mu, watch, longest_step_deg=longest)
    if isinstance(path, SettledState):
        return _unsettled(path, strategy, mu)
    alone = path.copy()
    plan.insert(0, growing_push(held))
    followed = all_paths(path, phase, plan, known)
    ends = _ends(path, held, wanted[0], strategy, followed)
    if known and any(end.points and SettledFlag.OVERLAP in end.flags for end in ends):
        # A point of a known path may overlap by as much as a step leaves where the certificate of an end does not.
        followed = all_paths(alone, phase, plan)
        ends = _ends(alone, held, wanted[0], strategy, followed)
    first = ends[0]
    if known is not None:
        known.add(followed, first.outcome)
    if followed.first_ends > 1:
        flags = (*first.start.flags, SettledFlag.AMBIGUOUS)
        first = replace(first, start=replace(first.start, flags=flags))
    if followed.is_whole and all(end.outcome is first.outcome for end in ends):
        return first
    return replace(first, outcome=AssemblyOutcome.UNDECIDED, flags=(SettledFlag.AMBIGUOUS,))


def _ends(
    path: FrictionPath, held: Device, pose_deg: Floats, strategy: Strategy, followed: Followed
) -> list[AssemblyPath]:
    """The paths with friction that have been followed from a pose (deg); ``path`` is the bolt of the first."""
    ends = []
    for legs in followed.paths:
        start = settled_with_friction(held, pose_deg, path, legs[0].rows)
        if start.outcome is Outcome.SETTLED:
            ends.append(_path(path.pair, held, start, strategy, path.mu, _with_friction(path, held, legs[1:])))
        else:
            ends.append(_unsettled(start, strategy, path.mu))
    return ends


def _unsettled(start: SettledState, strategy: Strategy, mu: float) -> AssemblyPath:
    """The path of a bolt that has not settled."""
    outcome = AssemblyOutcome.SLIPPED if start.outcome is Outcome.SLIPPED else AssemblyOutcome.UNDECIDED
    return AssemblyPath(start, strategy, mu, outcome, start.flags, (), (), None, None, None)


def _checked_step(longest_step: float | None, mu: float) -> float:
    """The longest step of the phase in degrees, that where none is given.

    Raises:
        InvalidValueError: it is not a number of the valid range.
    """
    if longest_step is None:
        return LONGEST_STEP_WITH_FRICTION_DEG if mu > 0.0 else LONGEST_STEP_DEG
    if not LEAST_LONGEST_STEP_DEG <= longest_step <= LONGEST_STEP_DEG:
        valid = f"{number_text(LEAST_LONGEST_STEP_DEG)} to {number_text(LONGEST_STEP_DEG)} deg"
        raise InvalidValueError("longest_step", longest_step, valid)
    return longest_step


@dataclass
class Course:
    """A path as it is followed: its points, leg by leg, events and losses, and how it ended.

    ``work`` is the hand's, ``is_free`` whether overlaps are excluded at the end; ``reason`` why a step has no end.
    """

    legs: list[list[AssemblyPoint]] = field(default_factory=list)
    events: list[PathEvent] = field(default_factory=list)
    friction: float = 0.0
    falls: float = 0.0
    ending: Ending = Ending.TURNED
    reason: SettledFlag | None = None
    is_free: bool = True

    def add_leg(self, limits: Limits, points: list[AssemblyPoint], events: list[PathEvent]) -> int:
        """Adds a leg, up to its first point beyond a device's limits, which then ends the path; returns how many points
        that are.
        """
        beyond = first_beyond(limits, points)
        if beyond is not None:
            last, self.ending = beyond
            points = points[: last + 1]
            events = events_up_to(points[-1].phase_deg, points[0].phase_deg, events)
        self.legs.append(points)
        self.events += events
        return len(points)

    @property
    def work(self) -> float:
        """The torque summed over the phase, by trapezoids."""
        return sum(
            0.5 * (before.torque + after.torque) * math.radians(after.phase_deg - before.phase_deg)
            for leg in self.legs
            for before, after in pairwise(leg)
        )


def plan_of(pair: Pair, strategy: Strategy, device: Device) -> list[PlannedLeg]:
    """The turns of a strategy. A left-hand bolt is turned the other way round."""
    hand = math.copysign(1.0, pair.lead)
    pushes = (device.push, device.push)
    plan = [PlannedLeg(-math.radians(CLOCKWISE_DEG) * hand, pushes)]
    if strategy is Strategy.CCW_THEN_CW:
        plan.insert(0, PlannedLeg(math.radians(device.ccw_turn_deg) * hand, pushes, stops_at_snap=True))
    return plan


def _without_friction(
    pair: Pair,
    device: Device,
    numbers: Floats,
    command: Floats,
    row: tuple[Floats, ...],
    phase: float,
    plan: list[PlannedLeg],
    watch: PathWatch,
) -> Course:
    """The course of a plan, from the settled state's row on."""
    course = Course()
    numbers = numbers.copy()
    is_flush = row[0][sk.R_STATUS] == rest.FLUSH
    q = row[1].copy()
    if is_flush:
        tk.set_phase(phase, command, numbers)
        q, _ = level_numbers(numbers)
    kind = tk.ON_SURFACE if is_flush else tk.ON_CONTACTS
    strip = strip_numbers(pair)
    for planned in plan:
        leg = new_leg()
        ends = (phase, phase + planned.turn)
        stops_at_snap = planned.stops_at_snap
        bolt, nut = pair.bolt.packed, pair.nut.packed
        watch.begin_turn()
        watch.begin_leg(RunningTurn(leg))
        status, kind = tk.turn_with(q, kind, *ends, stops_at_snap, command, numbers, strip, bolt, nut, leg)
        watch.end_leg()
        result, rows, contacts, happened = leg
        count = int(result[tk.L_POINTS])
        events = [_event(event) for event in happened[: int(result[tk.L_EVENTS])]]
        points = [_point(rows[i], contacts[i], numbers, command) for i in range(count)]
        if status == tk.SNAPPED:
            events.append(snap_event(points))
        before = len(course.events)
        course.add_leg(device.limits, points, events)
        course.falls += sum(event.energy or 0.0 for event in course.events[before:] if event.kind is PathEventKind.FALL)
        watch.end_turn(course.events)
        if course.ending is not Ending.TURNED:
            break
        course.is_free = int(result[tk.L_OVERLAP]) == FREE
        phase = float(rows[count - 1, tk.T_PHASE])
        if status == tk.TORQUE_PASSED:
            course.ending = Ending.TORQUE
        elif status == tk.FAILED + rest.SLIPPED:
            course.ending = Ending.SLIPPED
        elif status not in (tk.TURNED, tk.SNAPPED):
            course.ending = Ending.FAILED
            course.reason = REASONS.get(status - tk.FAILED, SettledFlag.UNSETTLED)
        if status != (tk.SNAPPED if stops_at_snap else tk.TURNED):
            break
    return course


def _with_friction(path: FrictionPath, device: Device, legs: list[FollowedLeg]) -> Course:
    """The course of the turns of a path with friction; ``path`` is the bolt that was followed."""
    course = Course()
    for leg in legs:
        count = course.add_leg(device.limits, leg.points, leg.events)
        course.friction += float(leg.rows.points[:count, fk.P_FRICTION].sum())
        course.falls += float(leg.rows.points[:count, fk.P_FALL].sum())
        if course.ending is not Ending.TURNED:
            return course
    last = legs[-1]
    status = last.rows.status
    if status == fs.TORQUE_OVER:
        course.ending = Ending.TORQUE
    elif status == fs.SLIPPED_OFF:
        course.ending = Ending.SLIPPED
    elif status not in (fs.REACHED, fs.SNAP_REACHED):
        course.ending, course.reason = Ending.FAILED, FRICTION_REASONS[status]
    course.is_free = last.points[-1].held is not Held.CONTACTS or path.is_free(last.rows.points[-1])
    return course


def events_up_to(phase_deg: float, start_deg: float, events: list[PathEvent]) -> list[PathEvent]:
    """The events of a turn from a phase up to another one."""
    return [event for event in events if abs(event.phase_deg - start_deg) <= abs(phase_deg - start_deg)]


def new_leg() -> tk.Leg:
    """The arrays of a leg for the kernels."""
    return (
        np.zeros(tk.LEG_SIZE),
        np.zeros((tk.MAX_POINTS, tk.POINT_SIZE)),
        np.zeros((tk.MAX_POINTS, st.MAX_CONTACTS, st.CONTACT_SIZE)),
        np.zeros((tk.MAX_EVENTS, tk.EVENT_SIZE)),
    )


@dataclass(frozen=True)
class RunningTurn:
    """A leg without friction, as :func:`threadstate.device._turn_kernel.turn_with` sets it."""

    leg: tk.Leg

    def reached(self) -> tuple[int, float | None]:
        """How many points it has, and the phase of the last one in degrees."""
        result, rows, _, _ = self.leg
        count = int(result[tk.L_POINTS])
        return count, math.degrees(rows[count - 1, tk.T_PHASE]) if count else None

    def events(self, phase_deg: float | None) -> list[PathEvent]:
        """The events up to a phase that it has reached: those of a step are all there once its point is."""
        result, rows, _, happened = self.leg
        if phase_deg is None:
            return []
        # The last row of a full list is overwritten.
        found = [_event(event) for event in happened[: min(int(result[tk.L_EVENTS]), tk.MAX_EVENTS - 1)]]
        return events_up_to(phase_deg, math.degrees(rows[0, tk.T_PHASE]), found)

    def stop(self) -> None:
        """Have the kernel end it, as after its last descent."""
        self.leg[0][tk.L_DESCENTS] = math.inf


def _path(
    pair: Pair, device: Device, start: SettledState, strategy: Strategy, mu: float, course: Course
) -> AssemblyPath:
    """The path of a course."""
    # A leg begins where the one before ended.
    points = [*course.legs[0], *(point for leg in course.legs[1:] for point in leg[1:])]
    first, last = points[0], points[-1]
    elastic = last.elastic_energy - first.elastic_energy
    push = (first.potential - first.elastic_energy) - (last.potential - last.elastic_energy)
    balance = course.work + push - elastic - course.friction - course.falls
    energy = AssemblyEnergy(course.work, push, elastic, course.friction, course.falls, balance)
    outcome, margins = outcome_of(pair, device, strategy, course.ending, course.legs)
    flags = () if course.reason is None else (course.reason,)
    if course.ending is Ending.TURNED and not course.is_free:
        outcome, flags = AssemblyOutcome.UNDECIDED, (SettledFlag.OVERLAP,)
    travel = AssemblyTravel(
        max(abs(point.torque) for point in points),
        max(math.hypot(*point.rotation_deg) for point in points),
        max(math.hypot(*point.shift[:2]) for point in points),
    )
    return AssemblyPath(
        start, strategy, mu, outcome, flags, tuple(course.events), tuple(points), energy, margins, travel
    )


def _point(row: Floats, contacts: Floats, numbers: Floats, command: Floats) -> AssemblyPoint:
    numbers = numbers.copy()
    tk.set_phase(row[tk.T_PHASE], command, numbers)
    q = row[tk.T_COORDINATES : tk.T_COORDINATES + ck.COORDINATES]
    pose = row[tk.T_POSE : tk.T_POSE + 12]
    return AssemblyPoint(
        math.degrees(row[tk.T_PHASE]),
        HELD[int(row[tk.T_KIND])],
        StagePose(tuple(vector_of(line) for line in pose[:9].reshape(3, 3)), vector_of(pose[9:])),  # type: ignore[arg-type]
        vector_of(q[3:] - numbers[ck.D_PLACE : ck.D_PLACE + 3]),
        vector_of(np.degrees(q[:3])),
        tuple(_contact(contact) for contact in contacts[: int(row[tk.T_COUNT])]),
        float(row[tk.T_TORQUE]),
        float(row[tk.T_ENERGY]),
        float(row[tk.T_POTENTIAL]),
    )


def _contact(contact: Floats) -> LoadedContact:
    normal = contact[st.C_NORMAL : st.C_NORMAL + 3]
    return LoadedContact(
        vector_of(contact[st.C_POINT : st.C_POINT + 3]),
        vector_of(normal),
        FEATURES[int(contact[st.C_PAIR])],
        vector_of(contact[st.C_FORCE] * normal),
    )


def _event(event: Floats) -> PathEvent:
    kind = EVENTS[int(event[tk.E_KIND])]
    phase_deg, from_deg = math.degrees(event[tk.E_PHASE]), math.degrees(event[tk.E_BEFORE])
    point = vector_of(event[tk.E_POINT : tk.E_POINT + 3])
    if kind is PathEventKind.FALL:
        drop, way, loss = (float(number) for number in event[[tk.E_DROP, tk.E_WAY, tk.E_LOSS]])
        return PathEvent(kind, phase_deg, from_deg, point=point, drop=drop, way=way, energy=loss)
    if kind in (PathEventKind.GAINED, PathEventKind.LOST, PathEventKind.MOVED):
        before, after = (_features(event[i]) for i in (tk.E_OLD_PAIR, tk.E_PAIR))
        return PathEvent(kind, phase_deg, from_deg, before, after, point)
    return PathEvent(kind, phase_deg, from_deg)


def _features(index: float) -> FeaturePair | None:
    return FEATURES[int(index)] if index >= 0.0 else None
