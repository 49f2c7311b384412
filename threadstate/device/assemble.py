"""Paths of a bolt that a device settles on the nut and turns (forces, section 5)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from threadstate.device import _settle_kernel as sk
from threadstate.device.assembly_model import (
    AssemblyEnergy,
    AssemblyOutcome,
    AssemblyPath,
    AssemblyTravel,
)
from threadstate.device.assembly_outcome import Ending, outcome_of
from threadstate.device.branches import Followed, KnownPaths, all_paths
from threadstate.device.command import (
    LONGEST_STEP_DEG,
    LONGEST_STEP_WITH_FRICTION_DEG,
    command_numbers,
)
from threadstate.device.confirmation import confirmed
from threadstate.device.course import Course, plan_of, with_friction, without_friction
from threadstate.device.friction import FrictionPath, settled_with_friction
from threadstate.device.model import (
    Device,
    Outcome,
    SettledFlag,
    SettledState,
    default_device,
)
from threadstate.device.settle import (
    check_friction,
    check_pair,
    device_numbers,
    growing_push,
    path_with_friction,
    settled_rows,
    settled_state,
)
from threadstate.device.strategy import Strategy
from threadstate.device.watch import PathWatch
from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair

__all__ = ["assemble_pose"]

Floats = NDArray[np.float64]

LEAST_LONGEST_STEP_DEG = 0.25
"""The least longest step: with shorter ones the farthest turn has more points than a leg has room for."""


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
    confirm: bool = False,
    watch: PathWatch | None = None,
    known: KnownPaths | None = None,
) -> AssemblyPath:
    """The path of a bolt that settles at a commanded pose and is turned; angles in degrees.

    Forces, section 5; a left-hand bolt is turned the other way round. The device is the default one of forces, section
    4, unless another is given. The path is a sequence of equilibria, at most ``longest_step`` (deg) of phase apart, and
    0.005 deg where contacts change, 0.05 deg with friction. It is 2 deg, or 1 deg with friction, unless another is
    given, and with friction the push grows by at most 1/16 of its whole a step, in proportion. The same input gives the
    same bits. By ``watch`` another thread sees how far it is, and stops it. With friction ``known`` are paths from
    other phases, of the same command else: one that comes to within 1e-4 nominal radii of one goes on as that does. It
    is added to them if it is the only one from its phase, and its outcome is certain and no other's that it has come
    to.

    With ``confirm`` a path that has an outcome is followed with half the step as well, and flagged where that changes
    it (:func:`threadstate.device.confirmation.confirmed`); what ``watch`` shows stays that of the path meanwhile.

    Raises:
        InvalidValueError: as :func:`threadstate.device.settle.settle_pose`; a longest step outside 0.25 to 2 deg, or
            0.5 to 2 deg of a path that is to be confirmed.
        PathStoppedError: the path was stopped.
    """
    watch = watch or PathWatch()
    wanted = checked_poses([(roll_deg, pitch_deg, phase_deg)])
    check_friction(mu)
    check_pair(pair)
    longest = checked_step(longest_step, mu, confirm=confirm)
    held = (device or default_device()).in_unit(pair.unit)
    path = _followed(pair, wanted, held, strategy, mu, longest, watch, known)
    if not confirm or path.outcome is AssemblyOutcome.UNDECIDED:
        return path
    watch.begin_confirmation()
    half = _followed(pair, wanted, held, strategy, mu, longest / 2.0, watch, None)
    return confirmed(path, half, longest, held.push * pair.nominal_diameter / 2.0)


def _followed(
    pair: Pair,
    wanted: Floats,
    held: Device,
    strategy: Strategy,
    mu: float,
    longest: float,
    watch: PathWatch,
    known: KnownPaths | None,
) -> AssemblyPath:
    """The path of a pose, shape (1, 3), in steps of at most ``longest`` (deg)."""
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
        course = without_friction(pair, held, numbers, command, row, phase, plan, watch)
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
            ends.append(_path(path.pair, held, start, strategy, path.mu, with_friction(path, held, legs[1:])))
        else:
            ends.append(_unsettled(start, strategy, path.mu))
    return ends


def _unsettled(start: SettledState, strategy: Strategy, mu: float) -> AssemblyPath:
    """The path of a bolt that has not settled."""
    outcome = AssemblyOutcome.SLIPPED if start.outcome is Outcome.SLIPPED else AssemblyOutcome.UNDECIDED
    return AssemblyPath(start, strategy, mu, outcome, start.flags, (), (), None, None, None)


def checked_step(longest_step: float | None, mu: float, *, confirm: bool = False) -> float:
    """The longest step of the phase in degrees, that where none is given; of one to be ``confirm``-ed a half is valid.

    Raises:
        InvalidValueError: it is not a number of the valid range.
    """
    if longest_step is None:
        return LONGEST_STEP_WITH_FRICTION_DEG if mu > 0.0 else LONGEST_STEP_DEG
    least = 2.0 * LEAST_LONGEST_STEP_DEG if confirm else LEAST_LONGEST_STEP_DEG
    if not least <= longest_step <= LONGEST_STEP_DEG:
        valid = f"{number_text(least)} to {number_text(LONGEST_STEP_DEG)} deg" + (" with `confirm`" if confirm else "")
        raise InvalidValueError("longest_step", longest_step, valid)
    return longest_step


def _path(
    pair: Pair, device: Device, start: SettledState, strategy: Strategy, mu: float, course: Course
) -> AssemblyPath:
    """The path of a course."""
    points = course.points
    first, last = points[0], points[-1]
    elastic = last.elastic_energy - first.elastic_energy
    push = (first.potential - first.elastic_energy) - (last.potential - last.elastic_energy)
    balance = course.work + push - elastic - course.friction - course.falls
    energy = AssemblyEnergy(course.work, push, elastic, course.friction, course.falls, balance)
    outcome, margins = outcome_of(pair, device, strategy, course.ending, course.legs)
    flags: tuple[SettledFlag, ...] = (SettledFlag.STEP_DEPENDENT,) if course.step_dependent else ()
    flags += () if course.reason is None else (course.reason,)
    if course.ending is Ending.TURNED and not course.is_free:
        outcome, flags = AssemblyOutcome.UNDECIDED, (*flags, SettledFlag.OVERLAP)
    travel = AssemblyTravel(
        max(abs(point.torque) for point in points),
        max(math.hypot(*point.rotation_deg) for point in points),
        max(math.hypot(*point.shift[:2]) for point in points),
    )
    return AssemblyPath(
        start, strategy, mu, outcome, flags, tuple(course.events), tuple(points), energy, margins, travel
    )
