"""Histories of orientations: from the search's brackets to boundaries and intervals with their states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from threadstate.history.changes import NO_ANSWER, Changes, Floats, Integers, Resolution, Samples, changes_on_circles
from threadstate.history.codes import LabelCodes
from threadstate.history.differences import contact_changes
from threadstate.history.labels import labels_of
from threadstate.history.model import CIRCLE_DEG, Boundary, History, Interval
from threadstate.history.records import RecordStore, SolvedPoses
from threadstate.state.decode import decoded_answers
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair

RESOLUTION = Resolution(step=1.0, width=5e-7, jump_width=1e-11, no_answer_width=1e-3)
"""In degrees; what a denser start finds is in decision 7."""

POINT_DEG = 1e-6
"""Labels that hold over less phase than this belong to a boundary: they are those of a point, a tie for instance."""

TOGETHER = 8
"""Orientations that are searched together: so many keep their poses' records in some 20 MB."""

UNDECIDED_GAP_DEG = 0.02
"""Undecided stretches no farther apart than this are one: where the search ends early is no property of the parts."""


@dataclass(frozen=True, slots=True)
class _Bracket:
    """Two phases between which something changes, the codes at them, and places in between with codes of their own."""

    low: float
    high: float
    low_code: int
    high_code: int
    through: tuple[float, ...] = ()


def history_of(pair: Pair, roll_deg: float, pitch_deg: float, options: SolveOptions | None = None) -> History:
    """The history of one orientation; as :func:`histories_of` of this orientation alone."""
    return histories_of(pair, [(roll_deg, pitch_deg)], options)[0]


def histories_of(
    pair: Pair,
    orientations_deg: Sequence[tuple[float, float]],
    options: SolveOptions | None = None,
    resolution: Resolution = RESOLUTION,
    solved: SolvedPoses | None = None,
) -> list[History]:
    """The histories of orientations, (roll, pitch) in degrees, in their order; ``resolution`` in degrees.

    The same orientation gives the same bits whatever the others are, and whatever poses are known as ``solved``.

    Raises:
        InvalidValueError: a value not finite, roll or pitch beyond 10 deg.
    """
    options = options or SolveOptions()
    orientations = checked_poses([(roll, pitch, 0.0) for roll, pitch in orientations_deg])[:, :2]
    histories: list[History] = []
    for first in range(0, len(orientations), TOGETHER):
        store = RecordStore(pair, options, solved)
        histories += _histories(pair, options, orientations[first : first + TOGETHER], resolution, store)
    return histories


def _histories(
    pair: Pair, options: SolveOptions, orientations_deg: Floats, resolution: Resolution, store: RecordStore
) -> list[History]:
    """The histories of orientations of shape (n, 2) whose poses are all kept in one store."""
    codes = LabelCodes(pair, options, store)

    def sample(line: Integers, phases: Floats) -> Samples:
        return codes.samples(np.column_stack([orientations_deg[line], phases]))

    changes = changes_on_circles(sample, len(orientations_deg), CIRCLE_DEG, resolution)
    brackets = [_brackets(changes, line) for line in range(len(orientations_deg))]
    wanted = [(*orientations_deg[line], phase) for line, found in enumerate(brackets) for phase in _phases(found)]
    states = iter(_states(pair, options, np.array(wanted), store))
    histories = []
    for (roll, pitch), found, count in zip(
        orientations_deg.tolist(), brackets, changes.sample_counts.tolist(), strict=True
    ):
        boundaries, intervals = _cut(found, [next(states) for _ in _phases(found)])
        histories.append(History(roll, pitch, tuple(intervals), tuple(boundaries), count))
    return histories


def _brackets(changes: Changes, line: int) -> list[_Bracket]:
    """The brackets of a line in order, those joined that bound a point, those left out that part undecided phases."""
    on_line = changes.line == line
    columns = (changes.low, changes.high, changes.low_code, changes.high_code)
    rows = zip(*(column[on_line].tolist() for column in columns), strict=True)
    joined: list[_Bracket] = []
    for bracket in (_Bracket(*row) for row in rows):
        if joined and bracket.high - joined[-1].low < POINT_DEG:
            joined[-1] = _joined(joined[-1], bracket)
        else:
            joined.append(bracket)
    over_start = joined[0].high + CIRCLE_DEG - joined[-1].low if joined else CIRCLE_DEG
    if len(joined) > 1 and over_start < POINT_DEG:
        first = joined.pop(0)
        later = tuple(phase + CIRCLE_DEG for phase in first.through)
        once_more = replace(first, low=first.low + CIRCLE_DEG, high=first.high + CIRCLE_DEG, through=later)
        joined[-1] = _joined(joined[-1], once_more)
    kept: list[_Bracket] = []
    for bracket in joined:
        if (
            kept
            and kept[-1].low_code == bracket.high_code == NO_ANSWER
            and bracket.low - kept[-1].high < UNDECIDED_GAP_DEG
        ):
            kept.pop()
        else:
            kept.append(bracket)
    return kept


def _joined(one: _Bracket, other: _Bracket) -> _Bracket:
    through = (*one.through, 0.5 * (one.high + other.low), *other.through)
    return _Bracket(one.low, other.high, one.low_code, other.high_code, through)


def _phases(brackets: list[_Bracket]) -> list[float]:
    """The phases whose states are wanted: of every bracket its ends, what is in it, the middle after it."""
    if not brackets:
        return [0.5 * CIRCLE_DEG]
    phases = []
    for bracket, start, end in _with_intervals(brackets):
        phases += [bracket.low, bracket.high, *bracket.through, 0.5 * (start + end)]
    return [phase % CIRCLE_DEG for phase in phases]


def _with_intervals(brackets: list[_Bracket]) -> list[tuple[_Bracket, float, float]]:
    """Every bracket with the start and the end of the interval after it."""
    starts = [0.5 * (bracket.low + bracket.high) for bracket in brackets]
    ends = [*starts[1:], starts[0] + CIRCLE_DEG]
    return list(zip(brackets, starts, ends, strict=True))


def _cut(brackets: list[_Bracket], states: list[ContactState | None]) -> tuple[list[Boundary], list[Interval]]:
    """Boundaries and intervals in order of phase, from the states at :func:`_phases`."""
    if not brackets:
        return [], [Interval(0.0, CIRCLE_DEG, labels_of(states[0]), states[0])]
    boundaries, intervals = [], []
    remaining = iter(states)
    for bracket, start, end in _with_intervals(brackets):
        before, after = next(remaining), next(remaining)
        through = tuple(labels_of(next(remaining)) for _ in bracket.through)
        middle = next(remaining)
        changes = contact_changes(before, after)
        boundaries.append(Boundary(bracket.low, bracket.high, before, after, through, changes))
        if bracket.high_code == NO_ANSWER:
            middle = None
        shift = CIRCLE_DEG if start >= CIRCLE_DEG else 0.0
        intervals.append(Interval(start - shift, end - shift, labels_of(middle), middle))
    if boundaries[-1].high_deg >= CIRCLE_DEG and intervals[-1].start_deg < intervals[0].start_deg:
        boundaries.insert(0, boundaries.pop())
        intervals.insert(0, intervals.pop())
    return boundaries, intervals


def _states(pair: Pair, options: SolveOptions, poses_deg: Floats, store: RecordStore) -> list[ContactState | None]:
    """The states of poses; None where undecided."""
    answers = decoded_answers(pair, options, poses_deg, store.records(poses_deg))
    return [answer if isinstance(answer, ContactState) else None for answer in answers]
