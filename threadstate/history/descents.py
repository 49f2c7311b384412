"""Finds where a bolt that is turned counter-clockwise goes down, from its curve of height (method, section 8).

A descent ends and begins where the bolt goes down: where the height is level at its ends is not a part of it, a level
stretch between two falls is. Heights are those of first contact.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from threadstate.history.falls import SPAN_DEG, Descent, Falls, Jump, SteepestFall
from threadstate.history.height_curve import Gap, HeightCurve, Segment
from threadstate.history.model import CIRCLE_DEG
from threadstate.history.roots import narrowed_root

LEAST_FALL = 2e-8
"""A descent by no more than this many thread pitches is ignored: 1e-9 in of 1/4-20."""

NARROW_DEG = 0.25
"""Stretches on which the steepest fall may lie are cut to this width, and then searched by slope."""

WHOLE_DEG = 1.0
"""Stretches are cut at multiples of this while they can be, where a library has its states."""

STEEPEST_DEG = 1e-8
"""Resolution of the phase of the steepest fall where the slopes at its two ends agree."""


def falls_of(curve: HeightCurve, thread_pitch: float, span_deg: float = SPAN_DEG) -> Falls:
    """The falls of an orientation from its curve; ``thread_pitch`` in the curve's unit."""
    descents = _descents(curve, LEAST_FALL * thread_pitch)
    if not descents:
        return Falls((), None)
    fall, start, end = _Steepest(curve, span_deg).found()
    shares = [_fall_within(curve, descent, start, end) for descent in descents]
    return Falls(descents, SteepestFall(fall, start % CIRCLE_DEG, int(np.argmax(shares))))


Step = Segment | Gap


@dataclass(frozen=True, slots=True)
class _Course:
    """The steps of a curve one after the other, turn after turn: a step's number says in which turn it is."""

    steps: tuple[Step, ...]

    def step(self, number: int) -> Step:
        return self.steps[number % len(self.steps)]

    def turn_deg(self, number: int) -> float:
        """The phase to be added to that of the step."""
        return CIRCLE_DEG * (number // len(self.steps))


def _descents(curve: HeightCurve, least_fall: float) -> tuple[Descent, ...]:
    """The descents in order of their starts."""
    course = _Course(tuple(step for both in zip(curve.gaps, curve.segments, strict=True) for step in both))
    rises = [step.end_height - step.start_height > curve.round_off for step in course.steps]
    if not any(rises):
        return ()  # what never rises over a whole turn is level
    first = rises.index(True)
    after_rises = [first + k for k in range(len(rises) + 1) if rises[(first + k) % len(rises)]]
    runs = [range(one + 1, other) for one, other in pairwise(after_rises)]
    found = [_descent(course, run, curve.round_off) for run in runs]
    descents = [one for one in found if one is not None and one.fall > least_fall]
    return tuple(sorted(descents, key=lambda one: one.start_deg))


def _descent(course: _Course, run: range, round_off: float) -> Descent | None:
    """The descent of consecutive steps, none of which rises; None where all are level."""
    falling = [n for n in run if course.step(n).start_height - course.step(n).end_height > round_off]
    if not falling:
        return None
    first, last = falling[0], falling[-1]
    start = course.step(first).start_deg + course.turn_deg(first)
    turns = CIRCLE_DEG * (start // CIRCLE_DEG)
    gaps = [gap for n in range(first, last + 1) if isinstance(gap := course.step(n), Gap)]
    return Descent(
        start_deg=start - turns,
        end_deg=course.step(last).end_deg + course.turn_deg(last) - turns,
        start_height=course.step(first).start_height,
        end_height=course.step(last).end_height,
        fall_error=_error(course, first - 1, first) + _error(course, last, last + 1) + 2.0 * round_off,
        undecided_deg=sum((gap.end_deg - gap.start_deg for gap in gaps if gap.undecided), 0.0),
        jumps=tuple(
            Jump(gap.start_deg % CIRCLE_DEG, gap.width_deg, gap.start_height, gap.end_height, gap.height_error)
            for gap in gaps
            if gap.jumps
        ),
    )


def _error(course: _Course, *numbers: int) -> float:
    """By how much a height beside these steps may be wrong."""
    return max((step.height_error for n in numbers if isinstance(step := course.step(n), Gap)), default=0.0)


class _Steepest:
    """The search for the largest fall within a span of phase.

    Over a stretch of phase both ends of the span stay within one segment each. As these are monotone, the fall there is
    at most the difference of the heights at the stretch's ends: stretches that cannot hold more than was found are left
    out, the others cut in two. On narrow ones the fall is largest at an end, or where slopes at the span's ends agree.
    """

    def __init__(self, curve: HeightCurve, span_deg: float) -> None:
        self._curve = curve
        self._span = span_deg
        self._fall = 0.0
        self._start = self._end = 0.0

    def found(self) -> tuple[float, float, float]:
        """The fall, and the phases at which it begins and ends."""
        self._between_ends()
        this_turn = self._curve.segments
        next_turn = [_turned(segment) for segment in this_turn]
        stretches = []
        for low in this_turn:
            for high in (*this_turn, *next_turn):
                start = max(low.start_deg, high.start_deg - self._span)
                end = min(low.end_deg, high.end_deg - self._span)
                if start < end and _highest(low) - _lowest(high) > self._fall + self._curve.round_off:
                    stretches.append((start, end))
        self._within(stretches)
        return self._fall, self._start, self._end

    def _between_ends(self) -> None:
        """Falls from an end of a step to another, as where both are extremes."""
        curve = self._curve
        step_ends = [
            (phase, height)
            for gap, segment in zip(curve.gaps, curve.segments, strict=True)
            for phase, height in (
                (gap.start_deg, gap.start_height),
                (gap.end_deg, gap.end_height),
                (segment.start_deg, segment.start_height),
                (segment.end_deg, segment.end_height),
            )
        ]
        step_ends += [(phase + CIRCLE_DEG, height) for phase, height in step_ends]
        for number, (start, height) in enumerate(step_ends[: len(step_ends) // 2]):
            for end, lower in step_ends[number + 1 :]:
                if end - start > self._span:
                    break
                self._offer(height - lower, start, end)

    def _within(self, stretches: list[tuple[float, float]]) -> None:
        """Falls that begin within stretches and are a whole span wide."""
        while stretches:
            heights = self._heights(stretches)
            for (low, high), (at_low, at_high, later_low, later_high) in zip(stretches, heights, strict=True):
                self._offer(at_low - later_low, low, low + self._span)
                self._offer(at_high - later_high, high, high + self._span)
            bounds = [
                max(at_low, at_high) - min(later_low, later_high) for at_low, at_high, later_low, later_high in heights
            ]
            narrow = [
                (low, high)
                for (low, high), bound in zip(stretches, bounds, strict=True)
                if self._may_hold(bound) and high - low <= NARROW_DEG
            ]
            growth = iter(self._growth([end for ends in narrow for end in ends]))
            growths = dict(zip(narrow, zip(growth, growth, strict=True), strict=True))
            parts = []
            for (low, high), bound in zip(stretches, bounds, strict=True):
                if not self._may_hold(bound):
                    continue
                if high - low > NARROW_DEG:
                    middle = _middle(low, high)
                    parts += [(low, middle), (middle, high)]
                else:
                    # What is found may be less by round-off than what was, and leave one more that may hold more.
                    self._where_slopes_agree(low, high, *(growths.get((low, high)) or self._growth([low, high])))
            stretches = parts

    def _may_hold(self, bound: float) -> bool:
        """Whether a stretch may hold a larger fall than was found, if all in it are at most ``bound``."""
        return bound > self._fall + self._curve.round_off

    def _where_slopes_agree(self, low: float, high: float, at_low: float, at_high: float) -> None:
        """The fall that is largest within a narrow stretch, if one is; ``at_low`` and ``at_high`` is its growth."""
        if at_low > 0.0 >= at_high:
            low, high = narrowed_root(lambda start: self._growth([start])[0], low, high, at_low, at_high, STEEPEST_DEG)
            start = 0.5 * (low + high)
            ((height, _, lower, _),) = self._heights([(start, start)])
            self._offer(height - lower, start, start + self._span)

    def _growth(self, starts: Sequence[float]) -> list[float]:
        """How much the fall grows, per degree, as the span is moved on; 0 where a slope is unknown."""
        phases = np.array(starts)
        at_start, at_end = self._curve.slope(np.concatenate([phases, phases + self._span])).reshape(2, -1)
        growth: list[float] = np.nan_to_num(at_start - at_end).tolist()
        return growth

    def _heights(self, stretches: list[tuple[float, float]]) -> list[list[float]]:
        """The heights at both ends of every stretch, and a span later."""
        ends = np.array(stretches)
        heights: list[list[float]] = (
            self._curve.height(np.hstack([ends, ends + self._span]).ravel()).reshape(-1, 4).tolist()
        )
        return heights

    def _offer(self, fall: float, start: float, end: float) -> None:
        """Store a fall that is larger than the one found before, or as large within a narrower stretch."""
        more = fall - self._fall
        level = self._curve.round_off
        if more > level or (abs(more) <= level and self._fall > 0.0 and end - start < self._end - self._start):
            self._fall, self._start, self._end = fall, start, end


def _fall_within(curve: HeightCurve, descent: Descent, start_deg: float, end_deg: float) -> float:
    """How much of a fall from one phase to another belongs to a descent."""
    largest = 0.0
    for turn in (-CIRCLE_DEG, 0.0, CIRCLE_DEG):
        low, high = descent.start_deg + turn, descent.end_deg + turn
        if max(low, start_deg) <= min(high, end_deg):
            ends = curve.height(np.array([start_deg, end_deg])).tolist()
            upper = descent.start_height if low >= start_deg else ends[0]
            lower = descent.end_height if high <= end_deg else ends[1]
            largest = max(largest, upper - lower)
    return largest


def _middle(low: float, high: float) -> float:
    """The middle of a stretch, or the multiple of WHOLE_DEG next to it if one is inside."""
    middle = 0.5 * (low + high)
    whole = round(middle / WHOLE_DEG) * WHOLE_DEG
    return whole if low < whole < high else middle


def _turned(segment: Segment) -> Segment:
    return Segment(
        segment.start_deg + CIRCLE_DEG, segment.end_deg + CIRCLE_DEG, segment.start_height, segment.end_height
    )


def _highest(segment: Segment) -> float:
    return max(segment.start_height, segment.end_height)


def _lowest(segment: Segment) -> float:
    return min(segment.start_height, segment.end_height)
