"""Checks of histories' boundaries: by states solved a little beside each, and by histories from a denser start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from threadstate.errors import UnresolvedPoseError
from threadstate.history.build import RESOLUTION, histories_of
from threadstate.history.labels import UNDECIDED, Labels, labels_of
from threadstate.history.model import CIRCLE_DEG, Boundary, Interval, SolvedHistory
from threadstate.state.solve import solve_pose
from threadstate.thread.pair import Pair

BESIDE_DEG = 1e-5
"""How far beside a bracket a state is solved; less where the interval is narrow, a quarter into it."""


@dataclass(frozen=True, slots=True)
class Failure:
    """A side of a boundary on which the state has other labels than the interval there; angles in degrees."""

    roll_deg: float
    pitch_deg: float
    phase_deg: float


@dataclass(frozen=True, slots=True)
class BoundaryCheck:
    """What was found at the boundaries of some histories.

    Of ``boundaries`` ``undecided`` have an undecided stretch on one side; ``alike`` have the same labels on both sides,
    and nothing in between that moves or differs. On ``sides`` sides a state was solved, and ``failures`` are those of
    other labels.
    """

    boundaries: int
    undecided: int
    alike: int
    sides: int
    failures: tuple[Failure, ...]


def check_boundaries(pair: Pair, histories: Sequence[SolvedHistory]) -> BoundaryCheck:
    """Whether labels differ across the boundaries of histories and are those of the intervals beside them.

    Beside an undecided stretch a state may be undecided, too: where the solver stops is narrowed to 1e-3 deg alone.
    """
    around = [(history, *one) for history in histories for one in _around(history)]
    boundaries = [boundary for _, _, boundary, _ in around]
    failures: list[Failure] = []
    sides = 0
    for history, before, boundary, after in around:
        for interval, phase in (
            (before, boundary.low_deg - min(BESIDE_DEG, 0.25 * before.width_deg)),
            (after, boundary.high_deg + min(BESIDE_DEG, 0.25 * after.width_deg)),
        ):
            if interval.labels.decided:
                sides += 1
                allowed = {interval.labels} if boundary.decided else {interval.labels, UNDECIDED}
                if _labels_at(pair, history, phase) not in allowed:
                    failures.append(Failure(history.roll_deg, history.pitch_deg, phase % CIRCLE_DEG))
    return BoundaryCheck(
        boundaries=len(boundaries),
        undecided=sum(not one.decided for one in boundaries),
        alike=sum(before.labels == after.labels and _nothing_happens(one) for _, before, one, after in around),
        sides=sides,
        failures=tuple(failures),
    )


def _around(history: SolvedHistory) -> list[tuple[Interval, Boundary, Interval]]:
    earlier = history.intervals[-1:] + history.intervals[:-1]
    return list(zip(earlier, history.boundaries, history.intervals, strict=bool(history.boundaries)))


def _nothing_happens(boundary: Boundary) -> bool:
    moves = any(change.moved for change in boundary.changes)
    return not (boundary.through or moves or boundary.last_height_jump)


def _labels_at(pair: Pair, history: SolvedHistory, phase_deg: float) -> Labels:
    try:
        return labels_of(solve_pose(pair, history.roll_deg, history.pitch_deg, phase_deg % CIRCLE_DEG))
    except UnresolvedPoseError:
        return UNDECIDED


SAME_DEG = 1e-6
"""Brackets no farther apart than this are of the same boundary."""


@dataclass(frozen=True, slots=True)
class Unmatched:
    """A boundary that one history has and the other has not; angles in degrees.

    ``dense`` says whether the one from the denser start has it. ``undecided`` are those beside an undecided stretch,
    whose place no search can determine. ``nearest_deg`` is how far off the other history's nearest bracket is.
    """

    roll_deg: float
    pitch_deg: float
    phase_deg: float
    dense: bool
    undecided: bool
    nearest_deg: float


@dataclass(frozen=True, slots=True)
class DensityCheck:
    """Boundaries and solved poses of the usual histories and of those from a denser start, and what only one has."""

    boundaries: int
    dense_boundaries: int
    solves: int
    dense_solves: int
    unmatched: tuple[Unmatched, ...]


def check_density(pair: Pair, orientations_deg: Sequence[tuple[float, float]], times: int) -> DensityCheck:
    """What a start step ``times`` as short finds on orientations (roll, pitch), and what it does not find."""
    usual = histories_of(pair, orientations_deg)
    dense = histories_of(pair, orientations_deg, resolution=replace(RESOLUTION, step=RESOLUTION.step / times))
    unmatched = [
        one
        for few, many in zip(usual, dense, strict=True)
        for one in (*_without_partner(few, many, dense=False), *_without_partner(many, few, dense=True))
    ]
    return DensityCheck(
        sum(len(history.boundaries) for history in usual),
        sum(len(history.boundaries) for history in dense),
        sum(history.solve_count for history in usual),
        sum(history.solve_count for history in dense),
        tuple(unmatched),
    )


def _without_partner(history: SolvedHistory, other: SolvedHistory, *, dense: bool) -> list[Unmatched]:
    """The boundaries of ``history`` that are not in ``other``."""
    lows = np.array([boundary.low_deg for boundary in other.boundaries])
    highs = np.array([boundary.high_deg for boundary in other.boundaries])
    found = []
    for boundary in history.boundaries:
        shifts = np.array([[-CIRCLE_DEG], [0.0], [CIRCLE_DEG]])
        apart = np.maximum(lows + shifts - boundary.high_deg, boundary.low_deg - highs - shifts)
        nearest = float(np.maximum(apart, 0.0).min(initial=CIRCLE_DEG))
        if nearest > SAME_DEG:
            place = (history.roll_deg, history.pitch_deg, boundary.phase_deg)
            found.append(Unmatched(*place, dense, not boundary.decided, nearest))
    return found
