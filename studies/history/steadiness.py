"""Whether labels are steady beside contacts close to each other, where round-off would decide first."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np

from threadstate.history.codes import LabelCodes
from threadstate.history.model import CIRCLE_DEG, SolvedHistory
from threadstate.history.records import RecordStore
from threadstate.state.model import ContactState, FeaturePair
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair

CLOSE_CONTACT = 1e-3
"""Contacts nearer to each other, in thread pitches, are close."""

REACH_DEG = 0.02
NEAREST_DEG = 2e-6
"""How far from a boundary, and from the next one, phases are solved."""


@dataclass(frozen=True, slots=True)
class Change:
    """Two neighbouring phases within an interval that have other labels; angles in degrees."""

    roll_deg: float
    pitch_deg: float
    low_deg: float
    high_deg: float


@dataclass(frozen=True, slots=True)
class Steadiness:
    """What was found beside boundaries: at how many of them contacts are close, the phases solved, and the changes."""

    boundaries: int
    phases: int
    changes: tuple[Change, ...]


def check_steadiness(pair: Pair, histories: Sequence[SolvedHistory], count: int) -> Steadiness:
    """Solves ``count`` evenly spaced phases of each interval beside a boundary at which contacts are close."""
    options = SolveOptions()
    boundaries, phases = 0, 0
    changes: list[Change] = []
    for history in histories:
        codes = LabelCodes(pair, options, RecordStore(pair, options))
        for stretches in _beside_close_contacts(pair, history):
            boundaries += 1
            for low, high in stretches:
                places = np.linspace(low, high, count)
                tilts = np.full((count, 2), (history.roll_deg, history.pitch_deg))
                phases += count
                found = codes.samples(np.column_stack([tilts, places % CIRCLE_DEG])).codes.tolist()
                for (a, one), (b, other) in pairwise(zip(places.tolist(), found, strict=True)):
                    if one != other:
                        changes.append(Change(history.roll_deg, history.pitch_deg, a, b))
    return Steadiness(boundaries, phases, tuple(changes))


def _beside_close_contacts(pair: Pair, history: SolvedHistory) -> Iterator[list[tuple[float, float]]]:
    """The stretches of decided phases before and after each boundary at which contacts are close."""
    earlier = [history.intervals[-1], *history.intervals[:-1]]
    for before, boundary, after in zip(earlier, history.boundaries, history.intervals, strict=True):
        if not any(_has_close_contacts(pair, state) for state in (boundary.before, boundary.after)):
            continue
        widths = [
            min(REACH_DEG, interval.width_deg - NEAREST_DEG) if interval.labels.decided else 0.0
            for interval in (before, after)
        ]
        stretches = [
            (boundary.low_deg - widths[0], boundary.low_deg - NEAREST_DEG),
            (boundary.high_deg + NEAREST_DEG, boundary.high_deg + widths[1]),
        ]
        yield [(low, high) for low, high in stretches if low < high]


def _has_close_contacts(pair: Pair, state: ContactState | None) -> bool:
    if state is None:
        return False
    points = [one.point for one in state.contacts if one.features is not FeaturePair.FLUSH]
    return any(math.dist(*two) < CLOSE_CONTACT * pair.thread_pitch for two in combinations(points, 2))
