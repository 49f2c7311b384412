"""The record of a path that was followed to its end: its visits of formations, and how far it was turned."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from threadstate.chances.model import Formation, Leaving, LegName, Reading, Record, Visit
from threadstate.chances.sampling import Approach
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath, AssemblyPoint, Held, PathEventKind
from threadstate.device.strategy import Strategy

FOLLOWED_DEG, FOLLOWED = 90.0, 0.05
"""The height follows the lead to the end within this part of what the lead makes of this turn, as at engagement."""
DIGITS = 6
"""Significant digits of torques and forces of a reading."""
PHASE_DECIMALS = 9
"""Of the phase of a reading in degrees: what is beyond is round-off."""

HELD_CHANGES = {
    (Held.SURFACE, Held.CONTACTS): Leaving.OFF_SURFACE,
    (Held.STRIP, Held.CONTACTS): Leaving.OFF_STRIP,
    (Held.CONTACTS, Held.SURFACE): Leaving.ON_SURFACE,
    (Held.STRIP, Held.SURFACE): Leaving.ON_SURFACE,
    (Held.CONTACTS, Held.STRIP): Leaving.ON_STRIP,
    (Held.SURFACE, Held.STRIP): Leaving.ON_STRIP,
}


def record_of(path: AssemblyPath, approach: Approach, lead: float) -> Record:
    """The record of a path; ``lead`` is the pair's, negative of a left-hand thread."""
    points, travel = path.points, path.travel
    if not points or travel is None:
        return Record(approach, path.outcome, path.flags, False, None, None, None, None, None, ())
    steps = [abs(after.phase_deg - before.phase_deg) for before, after in pairwise(points)]
    engages = path.outcome is AssemblyOutcome.ENGAGED
    return Record(
        approach,
        path.outcome,
        path.flags,
        False,
        math.fsum(steps),
        math.fsum(steps[: following_from(points, lead)]) if engages else None,
        travel.torque,
        travel.tilt_deg,
        travel.shift,
        visits_of(path),
    )


def following_from(points: Sequence[AssemblyPoint], lead: float) -> int:
    """The number of the first point from which on the height follows the lead to the end of a path.

    That is: within 5 % of what the lead makes of 90 deg, from the line through the last point.
    """
    last = points[-1]
    allowed = FOLLOWED * abs(lead) * FOLLOWED_DEG / 360.0
    first = len(points)
    for k in range(len(points) - 1, -1, -1):
        turned = points[k].phase_deg - last.phase_deg
        if abs(points[k].pose.translation[2] - last.pose.translation[2] - lead * turned / 360.0) > allowed:
            break
        first = k
    return first


def visits_of(path: AssemblyPath) -> tuple[Visit, ...]:
    """The visits of a path, in its order: points of one leg that follow each other with one formation."""
    points = path.points
    legs = _legs(path)
    begins = [
        k
        for k in range(len(points))
        if k == 0 or legs[k] is not legs[k - 1] or formation_of(points[k]) != formation_of(points[k - 1])
    ]
    visits = []
    from_deg = _phase(points[0])
    for begin, end in pairwise([*begins, len(points)]):
        left = _leaving(path, legs, end)
        # The next leg begins where this one ends: at its last point.
        last = end - 1 if left in (Leaving.END, Leaving.SNAP) else end
        to_deg = _phase(points[last])
        readings = tuple(reading_of(point) for point in points[begin:end])
        visits.append(Visit(formation_of(points[begin]), legs[begin], from_deg, to_deg, left, readings))
        from_deg = to_deg
    return tuple(visits)


def formation_of(point: AssemblyPoint) -> Formation:
    """What holds the bolt at a point."""
    return Formation(point.held, tuple(sorted(contact.features for contact in point.contacts)))


def reading_of(point: AssemblyPoint) -> Reading:
    """What is measured at a point."""
    fx, fy, fz = (math.fsum(contact.force[axis] for contact in point.contacts) for axis in range(3))
    return Reading(_phase(point), _rounded(point.torque), (_rounded(fx), _rounded(fy), _rounded(fz)))


def _legs(path: AssemblyPath) -> list[LegName]:
    """The leg of each point; the point at the snap belongs to the first one."""
    points = path.points
    if path.strategy is Strategy.CW:
        return [LegName.CW] * len(points)
    if all(event.kind is not PathEventKind.SNAP for event in path.events):
        return [LegName.CCW] * len(points)
    first = _turning(points) + 1
    return [LegName.CCW] * first + [LegName.CW] * (len(points) - first)


def _turning(points: Sequence[AssemblyPoint]) -> int:
    """The number of the last point before the hand turns back."""
    sense = 0.0
    for k, (before, after) in enumerate(pairwise(points)):
        step = after.phase_deg - before.phase_deg
        if step * sense < 0.0:
            return k
        sense = sense or step
    return len(points) - 1


def _leaving(path: AssemblyPath, legs: Sequence[LegName], end: int) -> Leaving:
    """How a visit is left of which ``end`` is the number of the first point after it."""
    points = path.points
    if end == len(points):
        return Leaving.END
    before, after = points[end - 1], points[end]
    if legs[end] is not legs[end - 1]:
        return Leaving.SNAP
    # An event has the phases of the points before and after it: one that ends at the first point is over there.
    phases = (before.phase_deg, after.phase_deg)
    if any(event.kind is PathEventKind.FALL and (event.from_deg, event.phase_deg) == phases for event in path.events):
        return Leaving.FALL
    if before.held is not after.held:
        return HELD_CHANGES[before.held, after.held]
    more = len(after.contacts) - len(before.contacts)
    return Leaving.MOVED if more == 0 else Leaving.GAINED if more > 0 else Leaving.LOST


def _phase(point: AssemblyPoint) -> float:
    return round(point.phase_deg, PHASE_DECIMALS) + 0.0


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}") + 0.0
