"""Where an integer code changes along many lines at once, and where numbers jump although it does not.

The search knows codes and numbers alone, not what they stand for. Each line is sampled at even steps; a stretch between
two samples whose codes differ is cut, and its parts are tested in the same way, down to the resolution. It is cut in
its middle, or on both sides of where one who knows more estimates the change to be, so close that what is between is
narrow enough: such an estimate decides what is sampled and nothing else. Where it is said that a number rises without a
jump that is believed once a sample in between confirms it. What then lies between two changes is sampled in its middle,
too, and near an end where changes are crowded, and searched where the code differs from its ends. All stretches of all
lines are cut together, so that few calls sample many points.

Resolution: a code that differs from both its neighbours is certain to be found where it lasts for a start step or
longer, and where it lies between two different codes that are seen. One that comes and goes between two samples of the
same code may be missed. A jump by more than 1 is found where the numbers bend by less than it within a step.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from threadstate.history.stretches import (
    LASTING_HALVINGS,
    UNDECIDED_CODE,
    Floats,
    Integers,
    Samples,
    Stretches,
    jumps,
    parts_of,
    unsearched,
)

MOST_FAILURES = 16
FAILURE = 4
"""What still changes after so many estimates that found a change is bisected: where codes are random each would find
more changes. One that found none counts for so many of them."""

SURE_WIDTHS = 16.0
"""What still changes after an estimate and is no wider than so many widths of a change is bisected, too: round-off may
decide there."""

WIDENING = 16.0
"""Ratio of the distances from an estimate that failed at which the next samples are taken."""

CLUSTERED = 0.5
CLUSTERED_WIDTH = 1.0 / 16.0
CLUSTERED_LEAST = 4.0
"""Changes nearer to each other than this share of half the stretch beside them, and than this part of the width down to
which stretches are bisected, are a cluster; nearer than this many widths of a change round-off may decide where they
are."""

CLUSTER_FACTORS = (1.0 / 64.0, 0.25, 4.0, 64.0, 1024.0)
"""Multiples of the distance of such changes at which the stretch beside them is sampled, up to its middle."""

ASIDE = 0.4
"""How far on either side of an estimate samples are taken, as a share of the width that is wanted."""

ROUNDING = 8.0
PRECISION = 1024.0
"""Estimates are rounded to one part, and wanted to within the other, of the width that is wanted: so searches of the
same change sample the same places."""

Sampler = Callable[[Integers, Floats], Samples]
"""Samples lines (integers of shape (n,)) at places (of shape (n,)); the same line and place give the same sample."""

Estimator = Callable[[Integers, Floats, Floats, Floats], Floats]
"""Estimates of where stretches of lines change: from the lines, both ends, which were sampled, and how near they are to
be.

All are of shape (n,). NaN where there is none, infinite where numbers rise and nothing jumps. The same stretch gives
the same estimate.
"""


@dataclass(frozen=True, slots=True)
class Resolution:
    """How finely to search.

    ``step`` is that of the first samples; ``width`` is the final width of a change, ``jump_width`` that of a jump of
    the first number, ``undecided_width`` that of the ends of an undecided stretch. A jump is a change of a number by
    more than 1. Stretches wider than ``aimed_width`` are bisected whatever is estimated: changes come in clusters, and
    a code that comes and goes near another change is met so.
    """

    step: float
    width: float
    jump_width: float
    undecided_width: float
    aimed_width: float = math.inf


@dataclass(frozen=True, slots=True)
class Changes:
    """Every stretch, not wider than the resolution's width, over which the code changes or a number jumps.

    Arrays of shape (n,), in order of line and place: the line, both ends, which were sampled, and their codes.
    ``sample_counts``, of shape (lines,), says how often each line was sampled.
    """

    line: Integers
    low: Floats
    high: Floats
    low_code: Integers
    high_code: Integers
    sample_counts: Integers


def changes_on_circles(
    sample: Sampler, line_count: int, period: float, resolution: Resolution, estimate: Estimator | None = None
) -> Changes:
    """All changes on the lines 0 to ``line_count`` - 1, each from 0 to ``period``, where it joins its start.

    ``resolution.step`` is shortened to divide the period. Ends of stretches are in [0, period]. Without an estimator
    stretches are bisected.
    """
    stretches = _start(sample, line_count, period, resolution.step)
    counts = np.bincount(stretches.line, minlength=line_count)
    every = _narrowed(sample, stretches, resolution, counts, estimate)
    cluster = (CLUSTERED_LEAST * resolution.width, CLUSTERED_WIDTH * resolution.aimed_width)
    unsure = np.ones(line_count, dtype=np.bool_)
    while unsure.any():
        more = _unlike_their_ends(sample, every[unsure[every.line]], cluster, counts)
        # Once only: where codes are random every change that is found would have others beside it.
        cluster = (0.0, 0.0)
        unsure = np.bincount(more.line, minlength=line_count) > 0
        every = Stretches.joined([every, _narrowed(sample, more, resolution, counts, estimate)])
    order = np.lexsort((every.low, every.line))
    return Changes(
        every.line[order],
        every.low[order],
        every.high[order],
        every.low_code[order],
        every.high_code[order],
        counts,
    )


def _narrowed(
    sample: Sampler, stretches: Stretches, resolution: Resolution, counts: Integers, estimate: Estimator | None
) -> Stretches:
    """The changes within stretches, cut down to the resolution; samples are added to the lines' ``counts``."""
    found: list[Stretches] = []
    while True:
        changing = (stretches.low_code != stretches.high_code) | jumps(stretches)
        decided = (stretches.low_code != UNDECIDED_CODE) & (stretches.high_code != UNDECIDED_CODE)
        jumping = np.abs(stretches.high_value[:, 0] - stretches.low_value[:, 0]) > 1.0
        wanted = np.where(jumping, resolution.jump_width, resolution.width)
        wanted[~decided] = resolution.undecided_width
        spreads = (stretches.low_code == stretches.high_code) & (stretches.lasting < LASTING_HALVINGS)
        wanted[spreads] = resolution.jump_width
        narrow = stretches.high - stretches.low <= wanted
        found.append(stretches[changing & narrow])
        wide = stretches[changing & ~narrow]
        if not len(wide):
            return Stretches.joined(found)
        first, second = _places_to_cut(wide, resolution, estimate)
        stretches = _cut(sample, wide, first, second, counts)


def _places_to_cut(wide: Stretches, resolution: Resolution, estimate: Estimator | None) -> tuple[Floats, Floats]:
    """Where stretches are cut: before and after an estimate, or at one place alone, the other one NaN.

    That one is beside an estimate that failed, or in the middle. What estimates say of stretches is set in ``wide``.
    """
    half = 0.5 * (wide.high - wide.low)
    middle = 0.5 * (wide.low + wide.high)
    beside_low, beside_high = ((one > 0.0) & (one < half) for one in (wide.from_low, wide.from_high))
    first = np.where(beside_low, wide.low + wide.from_low, np.where(beside_high, wide.high - wide.from_high, middle))
    second = np.full_like(first, np.nan)
    decided = (wide.low_code != UNDECIDED_CODE) & (wide.high_code != UNDECIDED_CODE)
    decided &= 2.0 * half <= resolution.aimed_width
    decided &= (wide.failures == 0) | (2.0 * half > SURE_WIDTHS * resolution.width)
    aimed = np.flatnonzero(decided & (wide.failures < MOST_FAILURES) & (wide.from_low == 0.0) & (wide.from_high == 0.0))
    if estimate is None or not len(aimed):
        return first, second
    low, high = wide.low[aimed], wide.high[aimed]
    target = np.where(high - low > resolution.width, resolution.width, resolution.jump_width)
    place = estimate(wide.line[aimed], low, high, target / PRECISION)
    wide.explained[aimed] = np.isposinf(place)
    # Rounded to a power of two, which is exact.
    grain = 2.0 ** np.floor(np.log2(target / ROUNDING))
    place = np.round(place / grain) * grain
    before, after = place - ASIDE * target, place + ASIDE * target
    has_before, has_after = ((low < aside) & (aside < high) for aside in (before, after))
    first[aimed] = np.where(has_before, before, np.where(has_after, after, first[aimed]))
    second[aimed] = np.where(has_before & has_after, after, np.nan)
    # Beside an end one cut may be too far from the estimate: it counts as a failure, so that it is not tried for ever.
    wide.failures[aimed] += np.where(has_before != has_after, FAILURE, 0)
    return first, second


def _cut(sample: Sampler, wide: Stretches, first: Floats, second: Floats, counts: Integers) -> Stretches:
    """The parts of every stretch, cut at one or at two places (see :func:`_places_to_cut`)."""
    twice = ~np.isnan(second)
    lines = np.concatenate([wide.line, wide.line[twice]])
    counts += np.bincount(lines, minlength=len(counts))
    samples = sample(lines, np.concatenate([first, second[twice]]))
    once = wide[~twice]
    lower, upper = parts_of(once, first[~twice], samples[np.flatnonzero(~twice)])
    half = 0.5 * (once.high - once.low)
    upper.from_low = np.where(once.from_low < half, WIDENING * once.from_low, 0.0)
    lower.from_high = np.where(once.from_high < half, WIDENING * once.from_high, 0.0)
    before, after = samples[np.flatnonzero(twice)], samples[np.arange(len(wide), len(lines))]
    return Stretches.joined(
        [lower, upper, *_parts_of_two_cuts(wide[twice], first[twice], second[twice], before, after)]
    )


def _parts_of_two_cuts(
    whole: Stretches, first: Floats, second: Floats, before: Samples, after: Samples
) -> list[Stretches]:
    """The three parts of every stretch, cut before and after an estimate.

    Where a sample is undecided the stretch is left as it is, to be bisected: so it is narrowed as far as it can be.
    """
    undecided = (before.codes == UNDECIDED_CODE) | (after.codes == UNDECIDED_CODE)
    left = whole[undecided]
    left.failures[:] = MOST_FAILURES
    decided = np.flatnonzero(~undecided)
    whole, first, second = whole[~undecided], first[decided], second[decided]
    before, after = before[decided], after[decided]
    failed = (before.codes == after.codes) & ~(np.abs(after.values - before.values) > 1.0).any(axis=1)
    whole.failures = whole.failures + np.where(failed, FAILURE, 1)
    lower, upper = parts_of(whole, second, after)
    lowest, middle = parts_of(lower, first, before)
    # What is left outside changes again, or the estimate failed; what is between may still have to be narrower.
    middle.failures = np.zeros_like(middle.failures)
    # Where codes agree nothing but a jump is looked for, of which the middle of a stretch tells as much.
    aside = failed & (whole.low_code != whole.high_code)
    upper.from_low = lowest.from_high = np.where(aside, WIDENING * 0.5 * (second - first), 0.0)
    return [left, lowest, middle, upper]


def _unlike_their_ends(sample: Sampler, found: Stretches, cluster: tuple[float, float], counts: Integers) -> Stretches:
    """The parts of every stretch between changes within which the code is sampled to be another than at its ends.

    It is sampled in the middle, and near an end beyond which another change is near, as changes come in clusters;
    ``cluster`` are the least and the largest distance of changes that are one.
    """
    order = np.lexsort((found.low, found.line))
    line, low, high = found.line[order], found.low[order], found.high[order]
    gap = np.where(line[1:] == line[:-1], low[1:] - high[:-1], np.inf)
    between = (
        (gap > 0.0)
        & (gap < np.inf)
        & (found.high_code[order[:-1]] == found.low_code[order[1:]])
        & (found.high_code[order[:-1]] != UNDECIDED_CODE)
    )
    number = np.flatnonzero(between)
    after, before = order[number], order[number + 1]
    whole = Stretches(
        found.line[after],
        found.high[after],
        found.low[before],
        found.high_code[after],
        found.low_code[before],
        found.high_value[after],
        found.low_value[before],
        np.full_like(found.low_slope[after], np.nan),
        np.full_like(found.low_slope[after], np.nan),
        *unsearched(len(after)),
    )
    gaps = np.concatenate([[np.inf], gap, [np.inf]])
    which, places = _places_between(whole.low, whole.high, gaps[number], gaps[number + 2], cluster)
    counts += np.bincount(whole.line[which], minlength=len(counts))
    samples = sample(whole.line[which], places)
    unlike = np.unique(which[samples.codes != whole.low_code[which]])
    parts = [whole[np.zeros(len(whole), dtype=np.bool_)]]
    for one in unlike.tolist():
        rest = whole[np.arange(len(whole)) == one]
        for place in np.flatnonzero(which == one):
            lower, rest = parts_of(rest, places[[place]], samples[np.array([place])])
            parts.append(lower)
        parts.append(rest)
    return Stretches.joined(parts)


def _places_between(
    low: Floats, high: Floats, gap_low: Floats, gap_high: Floats, cluster: tuple[float, float]
) -> tuple[Integers, Floats]:
    """Where stretches between changes are sampled: the stretches' numbers, and places, in order of both.

    ``gap_low`` and ``gap_high`` are the widths of the stretches before and after, ``cluster`` is the range of those of
    a cluster.
    """
    least, widest = cluster
    half = 0.5 * (high - low)
    number = np.arange(len(low))
    chosen, places = [number], [0.5 * (low + high)]
    for end, gap, sign in ((low, gap_low, 1.0), (high, gap_high, -1.0)):
        for factor in CLUSTER_FACTORS:
            distance = np.where((least < gap) & (gap < np.minimum(CLUSTERED * half, widest)), factor * gap, np.inf)
            inside = (least < distance) & (distance < half)
            chosen.append(number[inside])
            places.append((end + sign * distance)[inside])
    which, where = np.concatenate(chosen), np.concatenate(places)
    order = np.lexsort((where, which))
    which, where = which[order], where[order]
    # Of a stretch a few numbers wide two of them may be the same.
    is_new = np.append(True, (np.diff(which) != 0) | (np.diff(where) > 0.0))[: len(which)]
    kept = is_new & (low[which] < where) & (where < high[which])
    return which[kept], where[kept]


def _start(sample: Sampler, line_count: int, period: float, step: float) -> Stretches:
    """The stretches between evenly spaced samples of every line."""
    steps = int(np.ceil(period / step - 1e-9))
    places = np.arange(steps + 1) * (period / steps)
    line = np.repeat(np.arange(line_count, dtype=np.int64), steps)
    samples = sample(line, np.tile(places[:-1], line_count))
    codes = samples.codes.reshape(line_count, steps)
    values = samples.values.reshape(line_count, steps, -1)
    next_codes, next_values = np.roll(codes, -1, axis=1), np.roll(values, -1, axis=1)
    slope = (next_values - values) * (steps / period)
    slope[codes != next_codes] = np.nan
    width = values.shape[2]
    stretches = Stretches(
        line,
        np.tile(places[:-1], line_count),
        np.tile(places[1:], line_count),
        codes.ravel(),
        next_codes.ravel(),
        values.reshape(-1, width),
        next_values.reshape(-1, width),
        np.roll(slope, 1, axis=1).reshape(-1, width),
        np.roll(slope, -1, axis=1).reshape(-1, width),
        *unsearched(len(line)),
    )
    # Beside a stretch of another code the slope is not that of this code's numbers.
    before, after = np.roll(codes, 1, axis=1).ravel(), np.roll(next_codes, -1, axis=1).ravel()
    stretches.low_slope[before != stretches.low_code] = np.nan
    stretches.high_slope[after != stretches.high_code] = np.nan
    return stretches
