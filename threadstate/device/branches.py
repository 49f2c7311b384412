"""Every path of a bolt with friction: where a step has several solutions the path branches (forces, section 5).

A branch that comes back to a path that is followed already, at the same phase, is that path from there on.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.device import _chart_kernel as ck
from threadstate.device import _friction_kernel as fk
from threadstate.device import _friction_step_kernel as fs
from threadstate.device._settle_kernel import distance
from threadstate.device.assembly_model import AssemblyPoint, PathEvent
from threadstate.device.friction import FrictionBranch, FrictionLeg, FrictionPath, friction_events, point_of

Floats = NDArray[np.float64]

MOST_PATHS = 16
"""The most paths that are followed of one start."""

SAME = 1e-4
"""How near (nominal radii) to a path at the same phase a branch is that path."""


@dataclass(frozen=True)
class FollowedLeg:
    """A leg as the kernels' rows, its points, and the events between them."""

    rows: FrictionLeg
    points: list[AssemblyPoint]
    events: list[PathEvent]


@dataclass(frozen=True)
class FollowedPath:
    """A path, leg by leg, and whether overlaps are excluded at its end."""

    legs: tuple[FollowedLeg, ...]
    is_free: bool


@dataclass(frozen=True)
class _Start:
    path: FrictionPath
    legs: tuple[FollowedLeg, ...]
    begun: FrictionBranch | None


def all_paths(
    path: FrictionPath, phase: float, plan: Sequence[tuple[float, bool]], push: float
) -> tuple[list[FollowedPath], bool]:
    """The paths of a plan (turns in rad, and whether a snap ends each) from a phase (rad) on; whether these are all.

    The first one is that of the solutions that go on as before.

    Raises:
        PathStoppedError: the path was stopped.
    """
    to_do = [_Start(path, (), None)]
    found: list[FollowedPath] = []
    is_whole = True
    while to_do:
        start = to_do.pop(0)
        if start.begun is not None and any(_joins(start, other, path.numbers) for other in found):
            continue
        if len(found) == MOST_PATHS:
            return found, False
        legs = list(start.legs)
        begun = start.begun
        bolt = start.path
        for turn, stops_at_snap in plan[len(legs) :]:
            at = float(legs[-1].rows.points[-1, fk.P_PHASE]) if legs else phase
            before = bolt.copy()
            if not found:
                bolt.watch.begin_turn()
            leg = bolt.follow((at, at + turn), (push, push), stops_at_snap=stops_at_snap, begun=begun)
            begun = None
            to_do += [_Start(before.copy(), tuple(legs), branch) for branch in leg.branches]
            is_whole = is_whole and not leg.has_more
            legs.append(_followed(leg, path))
            if not found:
                bolt.watch.end_turn([event for earlier in legs for event in earlier.events])
            if leg.status != (fs.SNAP_REACHED if stops_at_snap else fs.REACHED):
                break
        found.append(FollowedPath(tuple(legs), bolt.is_free()))
    return found, is_whole


def _followed(leg: FrictionLeg, path: FrictionPath) -> FollowedLeg:
    points = [
        point_of(row, contacts, path.numbers, path.command)
        for row, contacts in zip(leg.points, leg.contacts, strict=True)
    ]
    return FollowedLeg(leg, points, friction_events(points, leg.points))


def _joins(start: _Start, other: FollowedPath, numbers: Floats) -> bool:
    """Whether a branch is, at its phase, where a path is."""
    if start.begun is None or len(other.legs) <= len(start.legs):
        return False
    row = start.begun.points[-1]
    rows = other.legs[len(start.legs)].rows.points
    turned = np.abs(rows[:, fk.P_PHASE] - rows[0, fk.P_PHASE])
    at = abs(row[fk.P_PHASE] - rows[0, fk.P_PHASE])
    if not math.isclose(start.begun.points[0, fk.P_PHASE], rows[0, fk.P_PHASE]) or at > turned[-1]:
        return False
    coordinates = slice(fk.P_COORDINATES, fk.P_COORDINATES + ck.COORDINATES)
    there = np.array([np.interp(at, turned, column) for column in rows[:, coordinates].T])
    return bool(distance(row[coordinates].copy(), there, numbers) < SAME * numbers[ck.D_SCALE])
