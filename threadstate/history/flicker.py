"""Stretches of phase over which round-off decides the labels, as brackets as wide as these.

At the onset of a contact close to an earlier one, within some 1e-3 thread pitches, the curve between them leaves the
overlap by less than round-off: neighbouring phases have the contact or not, at random. A change there has
no phase of its own, so its bracket is widened until the labels beside it are steady.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import replace

import numpy as np

from threadstate.history.brackets import Bracket, joined_brackets
from threadstate.history.changes import Sampler
from threadstate.history.model import CIRCLE_DEG, POINT_DEG

NEAREST_DEG = 1e-6
"""The least distance from a bracket at which labels are sampled."""

DISTANCE_FACTOR = 2.0
"""Ratio of the distances from a bracket of successive samples."""

WIDTH_DIVISOR = 16.0
"""A wide bracket's width divided by this is the least distance from it at which labels are sampled."""

LATER_REACH = 64.0
"""A bracket that was widened is sampled up to this many of its widths away: farther off that was done before."""

MARGIN = 0.5
"""Part of its width by which a bracket is finally widened on either side: towards its ends other labels are rare."""

GAP_DEG = 1e-3
"""Stretches over which labels flicker, no farther apart than this, are one."""

MAX_ROUNDS = 12
"""How many times a bracket is widened at most."""


def widened(sample: Sampler, brackets: Sequence[Bracket], line: int, doubtful: Set[Bracket]) -> list[Bracket]:
    """A line's brackets in order, the ``doubtful`` ones as wide as their labels flicker, joined where they nearly meet.

    One that flickers up to a neighbour is joined with it.
    """
    known, unsteady = _joined(brackets, [bracket in doubtful for bracket in brackets])
    wide = list(known)
    for number, bracket in enumerate(known):
        if unsteady[number]:
            before = known[number - 1].high - (CIRCLE_DEG if number == 0 else 0.0)
            after = known[(number + 1) % len(known)].low + (CIRCLE_DEG if number + 1 == len(known) else 0.0)
            wide[number] = _widened(sample, line, bracket, max(before, 0.0), min(after, CIRCLE_DEG))
    return _joined(wide, unsteady)[0]


def _joined(brackets: Sequence[Bracket], unsteady: Sequence[bool]) -> tuple[list[Bracket], list[bool]]:
    """The brackets, those joined that are near each other, and which of them are unsteady.

    An unsteady one is near where it is no farther than the wider one is wide, two of them are within GAP_DEG, too.
    """
    joined: list[Bracket] = []
    which: list[bool] = []
    for bracket, flickers in zip(brackets, unsteady, strict=True):
        near = -1.0
        if joined and (flickers or which[-1]) and bracket.decided and joined[-1].decided:
            near = max(bracket.width, joined[-1].width, GAP_DEG if flickers and which[-1] else 0.0)
        if joined and bracket.low - joined[-1].high <= near:
            joined[-1] = joined_brackets(joined[-1], bracket)
            which[-1] = True
        else:
            joined.append(bracket)
            which.append(flickers)
    return joined, which


def _widened(sample: Sampler, line: int, bracket: Bracket, lowest: float, highest: float) -> Bracket:
    for number in range(MAX_ROUNDS):
        nearest = max(NEAREST_DEG, bracket.width / WIDTH_DIVISOR)
        reach = LATER_REACH * bracket.width if number else CIRCLE_DEG
        low = _steady(sample, line, bracket.low, max(lowest, bracket.low - reach), -nearest, bracket.low_code)
        high = _steady(sample, line, bracket.high, min(highest, bracket.high + reach), nearest, bracket.high_code)
        if (low, high) == (bracket.low, bracket.high):
            break
        bracket = replace(bracket, low=low, high=high)
    if bracket.width <= POINT_DEG:
        return bracket
    margin = MARGIN * bracket.width
    ends = np.array([max(bracket.low - margin, lowest), min(bracket.high + margin, highest)])
    low_code, high_code = sample(np.full(2, line, dtype=np.int64), ends).codes.tolist()
    return replace(
        bracket,
        low=float(ends[0]) if low_code == bracket.low_code else bracket.low,
        high=float(ends[1]) if high_code == bracket.high_code else bracket.high,
    )


def _steady(sample: Sampler, line: int, start: float, limit: float, step: float, code: int) -> float:
    """The nearest sampled place from the start towards the limit beyond which none has another code."""
    reach = abs(limit - start)
    if reach <= abs(step):
        return start
    count = 1 + int(np.log(reach / abs(step)) / np.log(DISTANCE_FACTOR))
    places = np.append(start + step * DISTANCE_FACTOR ** np.arange(count), limit)
    codes = sample(np.full(len(places), line, dtype=np.int64), places).codes
    other = np.flatnonzero(codes != code)
    return start if not len(other) else float(places[min(int(other[-1]) + 1, count)])
