"""The same histories from a denser start: whether their boundaries are the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from threadstate.history.build import RESOLUTION, histories_of
from threadstate.history.model import CIRCLE_DEG, Boundary, History
from threadstate.thread.pair import Pair

SAME_DEG = 1e-6
"""Brackets no farther apart than this are of the same boundary."""


@dataclass(frozen=True, slots=True)
class Unmatched:
    """A boundary that one history has and the other has not; angles in degrees.

    ``dense`` says whether the one from the denser start has it. ``hidden`` are those whose place no search can tell:
    beside an undecided stretch, or where round-off decides the labels. ``nearest_deg`` is how far off the other
    history's nearest bracket is.
    """

    roll_deg: float
    pitch_deg: float
    phase_deg: float
    dense: bool
    hidden: bool
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


def _without_partner(history: History, other: History, *, dense: bool) -> list[Unmatched]:
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
            found.append(Unmatched(*place, dense, _hidden(boundary), nearest))
    return found


def _hidden(boundary: Boundary) -> bool:
    return boundary.flickers or not boundary.decided
