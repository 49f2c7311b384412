"""Histories of orientations: from the search's brackets to boundaries and intervals with their states."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from threadstate.history.brackets import Bracket, brackets_of
from threadstate.history.changes import Resolution, changes_on_circles
from threadstate.history.codes import LabelCodes
from threadstate.history.differences import contact_changes
from threadstate.history.estimates import ChangeEstimates
from threadstate.history.labels import labels_of
from threadstate.history.model import CIRCLE_DEG, Boundary, Interval, SolvedHistory
from threadstate.history.records import RecordStore
from threadstate.history.stretches import UNDECIDED_CODE, Floats, Integers, Samples
from threadstate.state.decode import decoded_answers
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair

RESOLUTION = Resolution(step=1.0, width=5e-7, jump_width=1e-11, undecided_width=1e-3, aimed_width=0.125)
"""In degrees; what a denser start finds is in decision 7."""

BATCH_SIZE = 8
"""Orientations that are searched together; the records of their poses take about 20 MB."""


def history_of(pair: Pair, roll_deg: float, pitch_deg: float, options: SolveOptions | None = None) -> SolvedHistory:
    """The history of one orientation; as :func:`histories_of` of this orientation alone."""
    return histories_of(pair, [(roll_deg, pitch_deg)], options)[0]


def histories_of(
    pair: Pair,
    orientations_deg: Sequence[tuple[float, float]],
    options: SolveOptions | None = None,
    resolution: Resolution = RESOLUTION,
    store: RecordStore | None = None,
) -> list[SolvedHistory]:
    """The histories of orientations, (roll, pitch) in degrees, in their order; ``resolution`` in degrees.

    The same orientation gives the same bits whatever the others are, and whatever poses are in the ``store``.

    Raises:
        InvalidValueError: a value not finite, roll or pitch beyond 10 deg.
    """
    options = options or SolveOptions()
    orientations = checked_poses([(roll, pitch, 0.0) for roll, pitch in orientations_deg])[:, :2]
    histories: list[SolvedHistory] = []
    for first in range(0, len(orientations), BATCH_SIZE):
        batch = orientations[first : first + BATCH_SIZE]
        histories += _histories(pair, options, batch, resolution, store or RecordStore(pair, options))
    return histories


def _histories(
    pair: Pair, options: SolveOptions, orientations_deg: Floats, resolution: Resolution, store: RecordStore
) -> list[SolvedHistory]:
    """The histories of orientations of shape (n, 2) whose poses share one store."""
    codes = LabelCodes(pair, options, store)
    estimates = ChangeEstimates(pair, options, store)
    counts = np.zeros(len(orientations_deg), dtype=np.int64)

    def sample(line: Integers, phases: Floats) -> Samples:
        counts[:] += np.bincount(line, minlength=len(counts))
        return codes.samples(np.column_stack([orientations_deg[line], phases]))

    def estimate(line: Integers, low: Floats, high: Floats, within: Floats) -> Floats:
        return estimates.places(orientations_deg[line], low, high, within)

    changes = changes_on_circles(sample, len(orientations_deg), CIRCLE_DEG, resolution, estimate)
    brackets = [brackets_of(changes, line) for line in range(len(orientations_deg))]
    wanted = [(*orientations_deg[line], phase) for line, found in enumerate(brackets) for phase in _phases(found)]
    states = iter(_states(pair, options, np.array(wanted), store))
    histories = []
    for (roll, pitch), found, count in zip(orientations_deg.tolist(), brackets, counts.tolist(), strict=True):
        boundaries, intervals = _cut(found, [next(states) for _ in _phases(found)])
        histories.append(SolvedHistory(roll, pitch, tuple(intervals), tuple(boundaries), count))
    return histories


def _phases(brackets: list[Bracket]) -> list[float]:
    """The phases whose states are wanted: of every bracket its ends, what is in it, the middle after it."""
    if not brackets:
        return [0.5 * CIRCLE_DEG]
    phases = []
    for bracket, start, end in _with_intervals(brackets):
        phases += [bracket.low, bracket.high, *bracket.through, 0.5 * (start + end)]
    return [phase % CIRCLE_DEG for phase in phases]


def _with_intervals(brackets: list[Bracket]) -> list[tuple[Bracket, float, float]]:
    """Every bracket with the start and the end of the interval after it."""
    starts = [0.5 * (bracket.low + bracket.high) for bracket in brackets]
    ends = [*starts[1:], starts[0] + CIRCLE_DEG]
    return list(zip(brackets, starts, ends, strict=True))


def _cut(brackets: list[Bracket], states: list[ContactState | None]) -> tuple[list[Boundary], list[Interval]]:
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
        if bracket.high_code == UNDECIDED_CODE:
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
