"""Where an integer code changes along many lines at once, and where numbers jump although it does not.

The search knows codes and numbers alone, not what they stand for. Each line is sampled at even steps; a stretch between
two samples whose codes differ is bisected, and both halves are tested in the same way, down to the resolution. What
then lies between two changes is sampled in its middle, too, and searched where the code there differs from its ends.
All stretches of all lines are halved together, so that one call samples one point of each.

Resolution: a code that differs from both its neighbours is certain to be found where it lasts for a start step or
longer, and where it lies between two different codes that are seen. One that comes and goes between two samples of the
same code may be missed. A jump by more than 1 is found where the numbers bend by less than it within a step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


LASTING_HALVINGS = 3
"""Number of bisections over which a jump stays in one half; a steep rise, as where a square root begins, spreads.

Of the rise of a root the steeper half has 0.71.
"""

LASTING_SHARE = 0.9
"""The share of a rise that one half has to have."""

UNDECIDED_CODE = -1
"""The code of an undecided place; the ends of undecided stretches have a resolution of their own."""


@dataclass(frozen=True, slots=True)
class Samples:
    """Codes of shape (n,), UNDECIDED_CODE where undecided, and numbers of shape (n, k), NaN where a code has none."""

    codes: Integers
    values: Floats


Sampler = Callable[[Integers, Floats], Samples]
"""Samples lines (integers of shape (n,)) at places (of shape (n,)); the same line and place give the same sample."""


@dataclass(frozen=True, slots=True)
class Resolution:
    """How finely to search.

    ``step`` is that of the first samples; ``width`` is the final width of a change, ``jump_width`` that of a jump of
    the first number, ``undecided_width`` that of the ends of an undecided stretch. A jump is a change of a number by
    more than 1.
    """

    step: float
    width: float
    jump_width: float
    undecided_width: float


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


@dataclass(slots=True)
class _Stretches:
    """Stretches between two sampled places, and how the numbers rise beside them (NaN: not known).

    ``lasting`` says over how many halvings in a row the rise has stayed in one half.
    """

    line: Integers
    low: Floats
    high: Floats
    low_code: Integers
    high_code: Integers
    low_value: Floats
    high_value: Floats
    low_slope: Floats
    high_slope: Floats
    lasting: Integers

    def __len__(self) -> int:
        return len(self.line)

    def __getitem__(self, chosen: NDArray[np.bool_]) -> _Stretches:
        return _Stretches(*(getattr(self, name)[chosen] for name in self.__slots__))

    @staticmethod
    def joined(parts: list[_Stretches]) -> _Stretches:
        return _Stretches(*(np.concatenate([getattr(p, name) for p in parts]) for name in _Stretches.__slots__))


def changes_on_circles(sample: Sampler, line_count: int, period: float, resolution: Resolution) -> Changes:
    """All changes on the lines 0 to ``line_count`` - 1, each from 0 to ``period``, where it joins its start.

    ``resolution.step`` is shortened to divide the period. Ends of stretches are in [0, period].
    """
    stretches = _start(sample, line_count, period, resolution.step)
    counts = np.bincount(stretches.line, minlength=line_count)
    every = _narrowed(sample, stretches, resolution, counts)
    unsure = np.ones(line_count, dtype=np.bool_)
    while unsure.any():
        more = _unlike_their_middle(sample, every[unsure[every.line]], counts)
        unsure = np.bincount(more.line, minlength=line_count) > 0
        every = _Stretches.joined([every, _narrowed(sample, more, resolution, counts)])
    order = np.lexsort((every.low, every.line))
    return Changes(
        every.line[order],
        every.low[order],
        every.high[order],
        every.low_code[order],
        every.high_code[order],
        counts,
    )


def _narrowed(sample: Sampler, stretches: _Stretches, resolution: Resolution, counts: Integers) -> _Stretches:
    """The changes within stretches, bisected down to the resolution; samples are added to the lines' ``counts``."""
    found: list[_Stretches] = []
    while True:
        changing = (stretches.low_code != stretches.high_code) | _jumps(stretches)
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
            return _Stretches.joined(found)
        middle = 0.5 * (wide.low + wide.high)
        counts += np.bincount(wide.line, minlength=len(counts))
        stretches = _halved(wide, middle, sample(wide.line, middle))


def _unlike_their_middle(sample: Sampler, found: _Stretches, counts: Integers) -> _Stretches:
    """Both halves of every stretch between changes in whose middle the code is another than at its ends."""
    order = np.lexsort((found.low, found.line))
    after, before = order[:-1], order[1:]
    between = (
        (found.line[after] == found.line[before])
        & (found.high_code[after] == found.low_code[before])
        & (found.high_code[after] != UNDECIDED_CODE)
        & (found.low[before] > found.high[after])
    )
    after, before = after[between], before[between]
    whole = _Stretches(
        found.line[after],
        found.high[after],
        found.low[before],
        found.high_code[after],
        found.low_code[before],
        found.high_value[after],
        found.low_value[before],
        np.full_like(found.low_slope[after], np.nan),
        np.full_like(found.low_slope[after], np.nan),
        np.zeros_like(found.lasting[after]),
    )
    middle = 0.5 * (whole.low + whole.high)
    counts += np.bincount(whole.line, minlength=len(counts))
    samples = sample(whole.line, middle)
    unlike = samples.codes != whole.low_code
    return _halved(whole[unlike], middle[unlike], Samples(samples.codes[unlike], samples.values[unlike]))


def _start(sample: Sampler, line_count: int, period: float, step: float) -> _Stretches:
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
    stretches = _Stretches(
        line,
        np.tile(places[:-1], line_count),
        np.tile(places[1:], line_count),
        codes.ravel(),
        next_codes.ravel(),
        values.reshape(-1, width),
        next_values.reshape(-1, width),
        np.roll(slope, 1, axis=1).reshape(-1, width),
        np.roll(slope, -1, axis=1).reshape(-1, width),
        np.zeros_like(line),
    )
    # Beside a stretch of another code the slope is not that of this code's numbers.
    before, after = np.roll(codes, 1, axis=1).ravel(), np.roll(next_codes, -1, axis=1).ravel()
    stretches.low_slope[before != stretches.low_code] = np.nan
    stretches.high_slope[after != stretches.high_code] = np.nan
    return stretches


def _jumps(stretches: _Stretches) -> NDArray[np.bool_]:
    """Where the code is the same at both ends, but a number changes by more than the slopes beside explain."""
    rise = stretches.high_value - stretches.low_value
    width = (stretches.high - stretches.low)[:, np.newaxis]
    low = np.abs(rise - stretches.low_slope * width)
    high = np.abs(rise - stretches.high_slope * width)
    unexplained = np.fmin(low, high)
    unexplained = np.where(np.isnan(unexplained), np.abs(rise), unexplained)
    same = stretches.low_code == stretches.high_code
    return same & (np.nan_to_num(unexplained, nan=0.0) > 1.0).any(axis=1)


def _halved(whole: _Stretches, middle: Floats, samples: Samples) -> _Stretches:
    """Both halves of every stretch."""
    below = (samples.values - whole.low_value) / (middle - whole.low)[:, np.newaxis]
    above = (whole.high_value - samples.values) / (whole.high - middle)[:, np.newaxis]
    below[samples.codes != whole.low_code] = np.nan
    above[samples.codes != whole.high_code] = np.nan
    first = _Stretches(
        whole.line,
        whole.low,
        middle,
        whole.low_code,
        samples.codes,
        whole.low_value,
        samples.values,
        whole.low_slope,
        above,
        _lasting(whole, samples.values - whole.low_value),
    )
    second = _Stretches(
        whole.line,
        middle,
        whole.high,
        samples.codes,
        whole.high_code,
        samples.values,
        whole.high_value,
        below,
        whole.high_slope,
        _lasting(whole, whole.high_value - samples.values),
    )
    return _Stretches.joined([first, second])


def _lasting(whole: _Stretches, rise: Floats) -> Integers:
    """Over how many halvings the whole's rise has stayed in one half, if that is the one of this ``rise``."""
    all_of_it = np.nan_to_num(np.abs(whole.high_value - whole.low_value)).max(axis=1)
    stays = np.nan_to_num(np.abs(rise)).max(axis=1) >= LASTING_SHARE * all_of_it
    return np.where(stays, whole.lasting + 1, 0)
