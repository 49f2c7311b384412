"""The height of first contact along the phase, cut into segments over which it rises, falls or is level throughout.

Between two changes of the first contact's labels the height h is smooth. Where the bolt's edge is on the nut's surface
it is constant; where a thread of the nut is touched it grows by the lead, as a turn with the lead's advance maps that
thread onto itself. Elsewhere the contact gives the slope in closed form: the bolt's material moves at the contact point
by z x point dphase + z dh, which stays in the common tangent plane, so that

    dh / dphase = (n_x y - n_y x) / n_z.

Extremes within a stretch lie where that changes its sign. Edge on edge has none: there h' is a product of the slopes of
the bolt's edge and of the nut's outline, each of which keeps its sign within one region.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from threadstate.contact import _record_kernel as rk
from threadstate.contact._stage_kernel import BASE_EDGE, EDGE_EDGE, THREAD_EDGE
from threadstate.history.brackets import Bracket, brackets_of
from threadstate.history.build import RESOLUTION
from threadstate.history.changes import changes_on_circles
from threadstate.history.codes import HEIGHT_JUMP, LabelCodes
from threadstate.history.estimates import ChangeEstimates
from threadstate.history.limits import fold_in
from threadstate.history.model import CIRCLE_DEG
from threadstate.history.records import FirstContactStore, Floats, Integers, RecordStore
from threadstate.history.roots import narrowed_root
from threadstate.history.stretches import UNDECIDED_CODE, Samples
from threadstate.state.options import SolveOptions
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair

ROUND_OFF = 1e-12
"""A change of the height by no more than this many thread pitches is ignored."""

SAMPLES_DEG = 1.0
"""Slopes are sampled where the phase is a multiple of this, as the poses of a library are."""

EXTREME_DEG = 1e-9
"""Resolution of a phase at which the slope changes its sign."""

CURVED = (EDGE_EDGE, BASE_EDGE, THREAD_EDGE)
"""Features of a first contact along which the height is no straight line."""

Evaluate = Callable[[Floats], Floats]
"""A number at every phase of shape (n,), in degrees."""


@dataclass(frozen=True, slots=True)
class Segment:
    """A stretch of phase, in degrees, over which the height of first contact rises, falls or is level throughout."""

    start_deg: float
    end_deg: float
    start_height: float
    end_height: float


@dataclass(frozen=True, slots=True)
class Gap:
    """What lies between two segments: the bracket of an event, an undecided stretch, or nothing, at an extreme.

    ``jumps`` is whether the height jumps there: then both phases are the same, certain to half of ``width_deg``, and
    heights are the limits from both sides. ``height_error`` estimates by how much either may be wrong.
    """

    start_deg: float
    end_deg: float
    start_height: float
    end_height: float
    height_error: float = 0.0
    width_deg: float = 0.0
    jumps: bool = False
    undecided: bool = False


@dataclass(frozen=True, slots=True)
class HeightCurve:
    """The height of first contact over a turn: ``gaps[i]`` comes before ``segments[i]``, the first after the last.

    Phases are in degrees and grow by less than a turn from the first segment's start in [0, 360) to the last one's end.
    ``height`` and ``slope`` (per degree) evaluate phases of shape (n,) within segments; lengths are in the pair's unit,
    ``round_off`` among them. There are no segments where nothing is decided.
    """

    segments: tuple[Segment, ...]
    gaps: tuple[Gap, ...]
    height: Evaluate
    slope: Evaluate
    round_off: float


def height_curve(
    pair: Pair,
    roll_deg: float,
    pitch_deg: float,
    options: SolveOptions | None = None,
    store: RecordStore | None = None,
) -> HeightCurve:
    """The curve of an orientation; the same bits whatever poses are in the ``store``, of the same pair and options.

    Raises:
        InvalidValueError: a value not finite, roll or pitch beyond 10 deg.
    """
    ((roll, pitch, _),) = checked_poses([(roll_deg, pitch_deg, 0.0)]).tolist()
    options = options or SolveOptions()
    contacts = _FirstContacts(pair, roll, pitch, options, store or RecordStore(pair, options))
    segments: list[Segment] = []
    gaps: list[Gap] = []
    for gap, start, end in contacts.stretches():
        found = contacts.segments(start, end)
        at_extremes = [Gap(one.start_deg, one.start_deg, one.start_height, one.start_height) for one in found[1:]]
        gaps += [gap, *at_extremes]
        segments += found
    return HeightCurve(tuple(segments), tuple(gaps), contacts.height, contacts.slope, ROUND_OFF * pair.thread_pitch)


def monotone_segments(
    height: Evaluate, slope: Evaluate, start_deg: float, end_deg: float, level_slope: float = 0.0
) -> list[Segment]:
    """A stretch over which the height is smooth, cut at its extremes.

    Slopes are sampled where the phase is a multiple of SAMPLES_DEG, at both ends and in the middle; where the sign
    changes between two of these the root is narrowed down. A slope of at most ``level_slope`` per degree has no
    sign.
    """

    def steep(phases: Floats) -> Floats:
        slopes = np.nan_to_num(slope(phases))
        return np.where(np.abs(slopes) > level_slope, slopes, 0.0)

    whole = np.arange(np.floor(start_deg / SAMPLES_DEG) + 1.0, np.ceil(end_deg / SAMPLES_DEG)) * SAMPLES_DEG
    phases = np.unique(np.concatenate([[start_deg, 0.5 * (start_deg + end_deg), end_deg], whole]))
    slopes = steep(phases)
    turns = [(a, b) for a, b in pairwise(np.flatnonzero(slopes)) if (slopes[a] < 0.0) != (slopes[b] < 0.0)]
    cuts = []
    for a, b in turns:
        ends = float(phases[a]), float(phases[b]), float(slopes[a]), float(slopes[b])
        low, high = narrowed_root(lambda phase: float(steep(np.array([phase]))[0]), *ends, EXTREME_DEG)
        cuts.append(0.5 * (low + high))
    return _segments(height, [start_deg, *cuts, end_deg])


def _segments(height: Evaluate, ends_deg: list[float]) -> list[Segment]:
    heights = height(np.array(ends_deg)).tolist()
    return [
        Segment(low, high, at_low, at_high)
        for (low, high), (at_low, at_high) in zip(pairwise(ends_deg), pairwise(heights), strict=True)
    ]


def _between_decided(brackets: list[Bracket]) -> list[tuple[Bracket, bool]]:
    """The brackets in order of phase over one turn, the two about an undecided stretch as one; whether each is such."""
    first = next(number for number, bracket in enumerate(brackets) if bracket.low_code != UNDECIDED_CODE)
    later = [replace(one, low=one.low + CIRCLE_DEG, high=one.high + CIRCLE_DEG) for one in brackets[:first]]
    merged: list[tuple[Bracket, bool]] = []
    for bracket in [*brackets[first:], *later]:
        if bracket.low_code == UNDECIDED_CODE:
            before, _ = merged.pop()
            merged.append((replace(before, high=bracket.high, high_code=bracket.high_code), True))
        else:
            merged.append((bracket, False))
    return merged


class _FirstContacts:
    """The first contacts of an orientation by phase, each pose solved once."""

    def __init__(self, pair: Pair, roll: float, pitch: float, options: SolveOptions, store: RecordStore) -> None:
        self._pair = pair
        self._tilt = (roll, pitch)
        self._first = FirstContactStore(pair, options, store)
        self._codes = LabelCodes(pair, options, store, first_contact_only=True)
        self._estimates = ChangeEstimates(pair, options, store, first_contact_only=True)

    def stretches(self) -> list[tuple[Gap, float, float]]:
        """The decided stretches of phase over which no label changes, each with the gap before it."""

        def sample(_: Integers, phases: Floats) -> Samples:
            return self._codes.samples(self._poses(phases))

        def estimate(_: Integers, low: Floats, high: Floats, within: Floats) -> Floats:
            return self._estimates.places(np.full((len(low), 2), self._tilt), low, high, within)

        brackets = brackets_of(changes_on_circles(sample, 1, CIRCLE_DEG, RESOLUTION, estimate), 0)
        if not brackets:
            at_zero = np.array([0.0])
            if self._codes.samples(self._poses(at_zero)).codes[0] == UNDECIDED_CODE:
                return []
            start = float(self.height(at_zero)[0])
            return [(Gap(0.0, 0.0, start, start), 0.0, CIRCLE_DEG)]
        events = _between_decided(brackets)
        ends = [*(event.low for event, _ in events[1:]), events[0][0].low + CIRCLE_DEG]
        turns = CIRCLE_DEG * (events[0][0].high // CIRCLE_DEG)
        return [
            (self._gap(event, undecided=undecided), event.high - turns, end - turns)
            for (event, undecided), end in zip(events, ends, strict=True)
        ]

    def segments(self, start_deg: float, end_deg: float) -> list[Segment]:
        """A stretch without a change, cut where the height changes between rising and falling."""
        contact = self._records(np.array([0.5 * (start_deg + end_deg)]))[0, rk.O_CONTACT :]
        if int(contact[rk.P_PAIR]) in CURVED:
            level_slope = ROUND_OFF * self._pair.thread_pitch
            return monotone_segments(self.height, self.slope, start_deg, end_deg, level_slope)
        return _segments(self.height, [start_deg, end_deg])

    def height(self, phases: Floats) -> Floats:
        """Heights; NaN where undecided."""
        records = self._records(phases)
        return np.where(records[:, rk.O_POSES] > 0.0, records[:, rk.O_POSE + 11], np.nan)

    def slope(self, phases: Floats) -> Floats:
        """Slopes of the height, per degree; NaN where undecided."""
        records = self._records(phases)
        x, y = (records[:, rk.O_CONTACT + rk.P_POINT + i] for i in range(2))
        n_x, n_y, n_z = (records[:, rk.O_CONTACT + rk.P_NORMAL + i] for i in range(3))
        with np.errstate(divide="ignore", invalid="ignore"):
            found = np.radians((n_x * y - n_y * x) / n_z)
        return np.where(records[:, rk.O_POSES] > 0.0, found, np.nan)

    def _gap(self, event: Bracket, *, undecided: bool) -> Gap:
        sides = np.array([event.low, event.high])
        before, after = self.height(sides).tolist()
        if undecided or abs(after - before) <= HEIGHT_JUMP * self._pair.thread_pitch:
            return Gap(event.low, event.high, before, after, abs(after - before), undecided=undecided)
        rates = np.abs(np.nan_to_num(self.slope(sides), posinf=0.0, neginf=0.0)) * event.width
        phase, width = 0.5 * (event.low + event.high), event.width
        heights, errors = [before, after], rates.tolist()
        for side, record in enumerate(self._records(sides)):
            contact = record[rk.O_CONTACT :]
            if int(contact[rk.P_PAIR]) != EDGE_EDGE:
                continue
            azimuth = math.atan2(contact[rk.P_BOLT_POINT + 1], contact[rk.P_BOLT_POINT])
            fold = fold_in(self._pair, *self._tilt, event.low, event.high, float(sides[side]), azimuth)
            if fold is not None:
                heights[side], errors[side] = fold.height, fold.height_error
                phase, width = fold.phase_deg, 2.0 * fold.phase_error_deg
        return Gap(phase, phase, heights[0], heights[1], max(errors), width, jumps=True)

    def _poses(self, phases: Floats) -> Floats:
        return np.column_stack([np.full((len(phases), 2), self._tilt), phases % CIRCLE_DEG])

    def _records(self, phases: Floats) -> Floats:
        return self._first.records(self._poses(phases))
