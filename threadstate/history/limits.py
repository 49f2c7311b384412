"""Heights of first contact as the phase nears a boundary from either side."""

from __future__ import annotations

import math
from dataclasses import dataclass

from threadstate.history.codes import HEIGHT_JUMP
from threadstate.history.fold import Fold, fold_near
from threadstate.history.model import CIRCLE_DEG, Boundary, Interval, SolvedHistory
from threadstate.state.model import ContactState, FeaturePair
from threadstate.thread.pair import Pair


@dataclass(frozen=True, slots=True)
class Limit:
    """The height of first contact at a boundary, seen from one side, in the pair's unit; its error is an estimate.

    Where it nears the boundary as a root does it is that of the fold. Elsewhere it is that of the solved phase at
    the bracket's end, and the error what the height changes over the bracket at its mean rate beside it.
    """

    height: float
    error: float


def limit_before(pair: Pair, history: SolvedHistory, number: int) -> Limit | None:
    """The limit as the phase grows towards the boundary of that number; None where undecided."""
    boundary = history.boundaries[number]
    return _limit(pair, history, boundary, boundary.before, boundary.low_deg, history.intervals[number - 1])


def limit_after(pair: Pair, history: SolvedHistory, number: int) -> Limit | None:
    """The limit as the phase falls towards the boundary of that number; None where undecided."""
    boundary = history.boundaries[number]
    return _limit(pair, history, boundary, boundary.after, boundary.high_deg, history.intervals[number])


def _limit(
    pair: Pair,
    history: SolvedHistory,
    boundary: Boundary,
    side: ContactState | None,
    phase_deg: float,
    beside: Interval,
) -> Limit | None:
    if side is None:
        return None
    if abs(boundary.first_height_jump or 0.0) > HEIGHT_JUMP * pair.thread_pitch:
        fold = _fold(pair, history, boundary, side, phase_deg)
        if fold is not None:
            return Limit(fold.height, fold.height_error)
    height = side.poses[0].translation[2]
    if beside.state is None:
        return Limit(height, HEIGHT_JUMP * pair.thread_pitch)
    apart = abs((beside.middle_deg - phase_deg + 0.5 * CIRCLE_DEG) % CIRCLE_DEG - 0.5 * CIRCLE_DEG)
    rate = abs(beside.state.poses[0].translation[2] - height) / apart
    return Limit(height, rate * boundary.width_deg)


def _fold(pair: Pair, history: SolvedHistory, boundary: Boundary, side: ContactState, phase_deg: float) -> Fold | None:
    """The fold at which the first contact of a side ends, None where it does not end at one within the bracket."""
    first = side.contacts[0]
    if first.features is not FeaturePair.EDGE_EDGE:
        return None
    azimuth = math.atan2(first.point_bolt[1], first.point_bolt[0])
    return fold_in(pair, history.roll_deg, history.pitch_deg, boundary.low_deg, boundary.high_deg, phase_deg, azimuth)


def fold_in(
    pair: Pair, roll_deg: float, pitch_deg: float, low_deg: float, high_deg: float, phase_deg: float, azimuth: float
) -> Fold | None:
    """The fold near a phase and an azimuth (rad) on the bolt's edge, None if the bracket contains none."""
    fold = fold_near(pair, roll_deg, pitch_deg, phase_deg, azimuth)
    if fold is None:
        return None
    slack = high_deg - low_deg + fold.phase_error_deg
    return fold if low_deg - slack <= fold.phase_deg <= high_deg + slack else None
