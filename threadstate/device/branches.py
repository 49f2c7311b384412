"""Every path of a bolt with friction: where a step has several solutions the path branches (forces, section 5).

A branch that comes back to a path that is followed already, at the same phase, is that path from there on; so is one
that comes to a branch that has come back. So is a path that comes to one from another starting phase
(:class:`KnownPaths`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from threadstate.device import _chart_kernel as ck
from threadstate.device import _friction_kernel as fk
from threadstate.device import _friction_step_kernel as fs
from threadstate.device._settle_kernel import distance
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPoint, PathEvent
from threadstate.device.friction import FrictionBranch, FrictionLeg, FrictionPath, friction_events, point_of, snap_event

Floats = NDArray[np.float64]

MOST_PATHS = 16
"""The most paths that are followed of one start."""

MOST_STARTS = 64
"""The most that are begun of one start: most of them come back to a path that is followed already."""

SAME = 1e-4
"""How near (nominal radii) to a path at the same phase, and at the whole push, a branch is that path."""

SAME_AS_IT_GROWS = 1e-6
"""How near (nominal radii) to a path it is that path while the push grows: one that rests has moved by less than SAME
from one that slides, step after step."""

LOOKED_AFTER, LOOKED_AFTER_START = math.radians(30.0), math.radians(10.0)
"""After which turn a branch is looked at whether it has come back to a path, and a path whether it has come to a known
one."""

TURN = 2.0 * math.pi


@dataclass(frozen=True)
class PlannedLeg:
    """A leg to be followed: by how much the phase turns (rad), the pushes (N) at its ends, whether a snap ends it."""

    turn: float
    pushes: tuple[float, float]
    stops_at_snap: bool = False


@dataclass(frozen=True)
class FollowedLeg:
    """A leg as the kernels' rows, its points, and the events between them."""

    rows: FrictionLeg
    points: list[AssemblyPoint]
    events: list[PathEvent]


@dataclass(frozen=True)
class _Start:
    path: FrictionPath
    legs: tuple[FollowedLeg, ...]
    begun: FrictionBranch | None


@dataclass(frozen=True)
class Followed:
    """The paths of a plan, leg by leg, whether these are all, and how many ends their first leg has.

    The first path has the solutions that go on as before; ``joined`` are the outcomes of the known paths it has come
    to.
    """

    paths: list[list[FollowedLeg]]
    is_whole: bool
    first_ends: int
    joined: frozenset[AssemblyOutcome] = frozenset()


@dataclass(frozen=True)
class _Known:
    """A known path, leg by leg, and how it ends."""

    legs: list[FollowedLeg]
    outcome: AssemblyOutcome


class KnownPaths:
    """Paths from other starting phases, of one pair, device, commanded tilt, strategy and friction.

    After a whole turn the command is what it was: a path that is where a known one is, whole turns apart, goes on as it
    does. Of a start that has several paths none is known.
    """

    def __init__(self) -> None:
        self._paths: list[_Known] = []

    def add(self, followed: Followed, outcome: AssemblyOutcome) -> None:
        """Keeps the path of a start that has only one, with a certain outcome, if none that it has come to ends so."""
        is_single = followed.is_whole and len(followed.paths) == 1
        if is_single and outcome is not AssemblyOutcome.UNDECIDED and outcome not in followed.joined:
            self._paths.append(_Known(followed.paths[0], outcome))

    def forget_last(self) -> None:
        """Drops the path that was added last."""
        self._paths.pop()

    def __len__(self) -> int:
        return len(self._paths)

    def rest_of(self, leg: FrictionLeg, number: int, end: float, path: FrictionPath) -> _Rest | None:
        """How a turn that has come to a known path's leg of that number goes on, up to the phase ``end`` (rad)."""
        rows = leg.points
        at = float(rows[-1, fk.P_PHASE])
        sense = math.copysign(1.0, end - at)
        for other in self._paths:
            legs = other.legs
            if len(legs) <= number:
                continue
            known = legs[number].rows
            for turns in (-1.0, 0.0, 1.0):
                shift = turns * TURN
                if not _is_there(rows[-1], at - shift, fk.P_PHASE, sense, known.points, path.numbers, SAME):
                    continue
                ahead = sense * (known.points[:, fk.P_PHASE] + shift)
                whole = bool(ahead[-1] <= sense * end)
                chosen = (ahead > sense * at) & (ahead <= sense * end)
                count = len(rows) + int(chosen.sum())
                if count > fk.MAX_POINTS or not chosen.any():
                    continue
                points = np.vstack([rows, _shifted(known.points[chosen], shift)])
                contacts = np.concatenate([leg.contacts, known.contacts[chosen]])
                ended = whole and known.status != fs.REACHED
                status = known.status if ended else fs.REACHED
                later = [_turned(one, shift, path) for one in legs[number + 1 :]] if ended else []
                joined = replace(leg, status=status, points=points, contacts=contacts)
                return _Rest(joined, other.outcome, ended, later)
        return None


@dataclass(frozen=True)
class _Rest:
    """A leg with what a known path of that outcome adds, whether it ended there, and the legs after it then."""

    leg: FrictionLeg
    outcome: AssemblyOutcome
    ended: bool
    later: list[FollowedLeg]


def all_paths(
    path: FrictionPath, phase: float, plan: Sequence[PlannedLeg], known: KnownPaths | None = None
) -> Followed:
    """The paths of a plan from a phase (rad) on; ``path`` is the bolt of the first one, which may come to known ones.

    Raises:
        PathStoppedError: the path was stopped.
    """
    to_do = [_Start(path, (), None)]
    found: list[list[FollowedLeg]] = []
    followed: list[list[Floats]] = [[] for _ in plan]
    is_whole = True
    begun, first_ends = 0, 0
    joined: set[AssemblyOutcome] = set()
    while to_do:
        start = to_do.pop(0)
        number = len(start.legs)
        if start.begun is not None:
            same = SAME if plan[number].turn != 0.0 else SAME_AS_IT_GROWS
            if _joins(start.begun.points, followed[number], path.numbers, same):
                continue
        if len(found) == MOST_PATHS or begun == MOST_STARTS:
            return Followed(found, False, first_ends, frozenset(joined))
        begun += 1
        legs = list(start.legs)
        for planned in plan[number:]:
            at = float(legs[-1].rows.points[-1, fk.P_PHASE]) if legs else phase
            before = start.path.copy()
            rows = followed[len(legs)]
            leg, joins, later = _leg_of(start, planned, at, len(legs), rows, known, joined, is_first=not found)
            rows.append(leg.points)
            for i, one in enumerate(later, len(legs) + 1):
                followed[i].append(one.rows.points)
            to_do += [_Start(before.copy(), tuple(legs), branch) for branch in leg.branches]
            is_whole = is_whole and not leg.has_more
            if joins:
                break
            first_ends += 0 if legs else 1
            legs.append(_followed(leg, path))
            legs += later
            if planned.turn != 0.0 and not found:
                path.watch.end_turn(_events_of_turns(legs, plan))
            if later or leg.status != (fs.SNAP_REACHED if planned.stops_at_snap else fs.REACHED):
                found.append(legs)
                break
        else:
            found.append(legs)
    return Followed(found, is_whole, first_ends, frozenset(joined))


def _leg_of(
    start: _Start,
    planned: PlannedLeg,
    at: float,
    number: int,
    followed: list[Floats],
    known: KnownPaths | None,
    joined: set[AssemblyOutcome],
    *,
    is_first: bool,
) -> tuple[FrictionLeg, bool, list[FollowedLeg]]:
    """The leg of a start from a phase (rad) on, whether it comes to one that is followed, and those of a known path
    after it.

    ``followed`` are the points of the legs of that number that have been followed. The first path's is followed as a
    whole where none is known; ``joined`` gains the outcomes of those it comes to.
    """
    bolt, begun = start.path, start.begun if number == len(start.legs) else None
    if planned.turn != 0.0 and is_first:
        bolt.watch.begin_turn()
    part_size = LOOKED_AFTER_START if is_first and known else math.inf if is_first else LOOKED_AFTER
    parts = max(math.ceil(abs(planned.turn) / part_size), 1)
    branches: list[FrictionBranch] = []
    has_more = False
    later: list[FollowedLeg] = []
    for part in range(1, parts + 1):
        end = at + planned.turn * part / parts
        if begun is not None and abs(float(begun.points[-1, fk.P_PHASE]) - at) > abs(end - at):
            continue
        leg = bolt.follow((at, end), planned.pushes, stops_at_snap=planned.stops_at_snap, begun=begun)
        branches += leg.branches
        has_more = has_more or leg.has_more
        joins = _joins(leg.points, followed, bolt.numbers, SAME)
        if joins or leg.status != fs.REACHED:
            break
        rest = known.rest_of(leg, number, at + planned.turn, bolt) if known and is_first and part < parts else None
        if rest is not None:
            leg, later = rest.leg, rest.later
            joined.add(rest.outcome)
            if rest.ended:
                break
        begun = FrictionBranch(leg.points, leg.contacts)
    return replace(leg, branches=tuple(branches), has_more=has_more), joins, later


def _shifted(rows: Floats, shift: float) -> Floats:
    """Rows of points at other phases (rad)."""
    rows = rows.copy()
    rows[:, fk.P_PHASE] += shift
    return rows


def _turned(leg: FollowedLeg, shift: float, path: FrictionPath) -> FollowedLeg:
    """A leg at other phases (rad)."""
    return _followed(replace(leg.rows, points=_shifted(leg.rows.points, shift)), path)


def _followed(leg: FrictionLeg, path: FrictionPath) -> FollowedLeg:
    points = [
        point_of(row, contacts, path.numbers, path.command)
        for row, contacts in zip(leg.points, leg.contacts, strict=True)
    ]
    events = friction_events(points, leg.points)
    if leg.status == fs.SNAP_REACHED:
        events.append(snap_event(points))
    return FollowedLeg(leg, points, events)


def _events_of_turns(legs: Sequence[FollowedLeg], plan: Sequence[PlannedLeg]) -> list[PathEvent]:
    """The events of a path but those while the push grew."""
    turns = [leg for leg, planned in zip(legs, plan, strict=False) if planned.turn != 0.0]
    return [event for leg in turns for event in leg.events]


def _joins(rows: Floats, followed: Sequence[Floats], numbers: Floats, same: float) -> bool:
    """Whether the last of a leg's rows is, at its phase and push, where one of the legs that are followed is.

    ``same`` is how far apart they are at most, in nominal radii.
    """
    column = fk.P_PHASE if (rows[:, fk.P_PHASE] != rows[0, fk.P_PHASE]).any() else fk.P_PUSH
    sense = math.copysign(1.0, rows[-1, column] - rows[0, column])
    at = float(rows[-1, column])
    return any(_is_there(rows[-1], at, column, sense, others, numbers, same) for others in followed)


def _is_there(row: Floats, at: float, column: int, sense: float, others: Floats, numbers: Floats, same: float) -> bool:
    """Whether the bolt is at a row's place where ``column`` of a leg's rows, which goes in a sense, is ``at``."""
    coordinates = slice(fk.P_COORDINATES, fk.P_COORDINATES + ck.COORDINATES)
    passed = sense * others[:, column]
    if not passed[0] <= sense * at <= passed[-1]:
        return False
    there = np.array([np.interp(sense * at, passed, values) for values in others[:, coordinates].T])
    return distance(row[coordinates].copy(), there, numbers) < same * numbers[ck.D_SCALE]
