"""Boundaries of histories looked at from outside: states a little beside each, solved one by one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from threadstate.errors import UnresolvedPoseError
from threadstate.history.labels import UNDECIDED, Labels, labels_of
from threadstate.history.model import CIRCLE_DEG, Boundary, History, Interval
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

    Of ``boundaries`` ``undecided`` have an undecided stretch on one side, ``flickering`` are brackets over which
    round-off decides the labels, ``flicker_deg`` wide in all; ``alike`` have the same labels on both sides, and nothing
    in between that moves or differs. On ``sides`` sides a state was solved, and ``failures`` are those of other labels.
    """

    boundaries: int
    undecided: int
    flickering: int
    flicker_deg: float
    alike: int
    sides: int
    failures: tuple[Failure, ...]


def check_boundaries(pair: Pair, histories: Sequence[History]) -> BoundaryCheck:
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
    flickers = [boundary.width_deg for boundary in boundaries if boundary.flickers]
    return BoundaryCheck(
        boundaries=len(boundaries),
        undecided=sum(not one.decided for one in boundaries),
        flickering=len(flickers),
        flicker_deg=sum(flickers),
        alike=sum(before.labels == after.labels and _nothing_happens(one) for _, before, one, after in around),
        sides=sides,
        failures=tuple(failures),
    )


def _around(history: History) -> list[tuple[Interval, Boundary, Interval]]:
    earlier = history.intervals[-1:] + history.intervals[:-1]
    return list(zip(earlier, history.boundaries, history.intervals, strict=bool(history.boundaries)))


def _nothing_happens(boundary: Boundary) -> bool:
    moves = any(change.moved for change in boundary.changes)
    return not (boundary.through or moves or boundary.last_height_jump)


def _labels_at(pair: Pair, history: History, phase_deg: float) -> Labels:
    try:
        return labels_of(solve_pose(pair, history.roll_deg, history.pitch_deg, phase_deg % CIRCLE_DEG))
    except UnresolvedPoseError:
        return UNDECIDED
