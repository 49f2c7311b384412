"""The course of a path: its turns one after the other, without friction and with it, and how the last one ends."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from threadstate.device import _descent_kernel as descents
from threadstate.device import _friction_kernel as fk
from threadstate.device import _friction_step_kernel as fs
from threadstate.device import _leg_kernel as lk
from threadstate.device import _settle_kernel as sk
from threadstate.device import _turn_kernel as tk
from threadstate.device._certificate_kernel import FREE
from threadstate.device.assembly_model import AssemblyPoint, Held, PathEvent, PathEventKind
from threadstate.device.assembly_outcome import Ending, first_beyond
from threadstate.device.branches import FollowedLeg, PlannedLeg
from threadstate.device.command import strip_numbers
from threadstate.device.flush import level_numbers
from threadstate.device.friction import REASONS as FRICTION_REASONS
from threadstate.device.friction import FrictionPath, snap_event
from threadstate.device.model import Device, Limits, SettledFlag
from threadstate.device.settle import REASONS
from threadstate.device.strategy import CLOCKWISE_DEG, Strategy
from threadstate.device.turned_leg import RunningTurn, events_up_to, new_leg, turned_event, turned_point
from threadstate.device.watch import PathWatch
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]


@dataclass
class Course:
    """A path as it is followed: its points, leg by leg, events and losses, and how it ended.

    ``work`` is the hand's, ``is_free`` whether overlaps are excluded at the end; ``reason`` why a step has no end. A
    course is ``step_dependent`` where a fall ends elsewhere in steps of another length.
    """

    legs: list[list[AssemblyPoint]] = field(default_factory=list)
    events: list[PathEvent] = field(default_factory=list)
    friction: float = 0.0
    falls: float = 0.0
    ending: Ending = Ending.TURNED
    reason: SettledFlag | None = None
    is_free: bool = True
    step_dependent: bool = False

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
    def points(self) -> list[AssemblyPoint]:
        """The points of all legs; a leg begins where the one before ended."""
        return [*self.legs[0], *(point for leg in self.legs[1:] for point in leg[1:])]

    @property
    def work(self) -> float:
        """The torque summed over the phase, by trapezoids."""
        return sum(
            0.5 * (before.torque + after.torque) * math.radians(after.phase_deg - before.phase_deg)
            for before, after in pairwise(self.points)
        )


def plan_of(pair: Pair, strategy: Strategy, device: Device) -> list[PlannedLeg]:
    """The turns of a strategy. A left-hand bolt is turned the other way round."""
    hand = math.copysign(1.0, pair.lead)
    pushes = (device.push, device.push)
    plan = [PlannedLeg(-math.radians(CLOCKWISE_DEG) * hand, pushes)]
    if strategy is Strategy.CCW_THEN_CW:
        plan.insert(0, PlannedLeg(math.radians(device.ccw_turn_deg) * hand, pushes, stops_at_snap=True))
    return plan


def without_friction(
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
    is_flush = row[0][sk.R_STATUS] == descents.FLUSH
    q = row[1].copy()
    if is_flush:
        lk.set_phase(phase, command, numbers)
        q, _ = level_numbers(numbers)
    kind = lk.ON_SURFACE if is_flush else lk.ON_CONTACTS
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
        count = int(result[lk.L_POINTS])
        events = [turned_event(event) for event in happened[: int(result[lk.L_EVENTS])]]
        points = [turned_point(rows[i], contacts[i], numbers, command) for i in range(count)]
        if status == lk.SNAPPED:
            events.append(snap_event(points))
        before = len(course.events)
        course.add_leg(device.limits, points, events)
        course.falls += sum(event.energy or 0.0 for event in course.events[before:] if event.kind is PathEventKind.FALL)
        watch.end_turn(course.events)
        if course.ending is not Ending.TURNED:
            break
        course.is_free = int(result[lk.L_OVERLAP]) == FREE
        course.step_dependent |= int(result[lk.L_UNCERTAIN]) > 0
        phase = float(rows[count - 1, lk.T_PHASE])
        if status == lk.TORQUE_PASSED:
            course.ending = Ending.TORQUE
        elif status == lk.FAILED + descents.SLIPPED:
            course.ending = Ending.SLIPPED
        elif status not in (lk.TURNED, lk.SNAPPED):
            course.ending = Ending.FAILED
            course.reason = REASONS.get(status - lk.FAILED, SettledFlag.UNSETTLED)
        if status != (lk.SNAPPED if stops_at_snap else lk.TURNED):
            break
    return course


def with_friction(path: FrictionPath, device: Device, legs: list[FollowedLeg]) -> Course:
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
