"""Stretches of lines between two sampled places, and the parts into which they are cut."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

LASTING_HALVINGS = 3
"""Number of halvings over which a jump stays in one part; a steep rise, as where a square root begins, spreads.

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

    def __getitem__(self, chosen: Integers) -> Samples:
        return Samples(self.codes[chosen], self.values[chosen])


@dataclass(slots=True)
class Stretches:
    """Stretches between two sampled places, and how the numbers rise beside them (NaN: not known).

    ``lasting`` says over how many halvings in a row the rise has stayed in one part, ``failures`` how many estimates
    have left it changing, those that found no change counted several times. After one that failed, ``from_low`` or
    ``from_high`` is how far from that end the next sample is taken; else 0. ``explained`` is whether the rise is known
    to be none of a jump.
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
    failures: Integers
    from_low: Floats
    from_high: Floats
    explained: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.line)

    def __getitem__(self, chosen: NDArray[np.bool_]) -> Stretches:
        return Stretches(*(getattr(self, name)[chosen] for name in self.__slots__))

    @staticmethod
    def joined(parts: list[Stretches]) -> Stretches:
        """All stretches of a list, one after the other."""
        return Stretches(*(np.concatenate([getattr(p, name) for p in parts]) for name in Stretches.__slots__))


def unsearched(count: int) -> tuple[Integers, Integers, Floats, Floats, NDArray[np.bool_]]:
    """How the search of stretches begins: ``lasting`` and what comes after it."""
    numbers = np.zeros((2, count), dtype=np.int64)
    return *numbers, *np.zeros((2, count)), np.zeros(count, dtype=np.bool_)


def jumps(stretches: Stretches) -> NDArray[np.bool_]:
    """Where the code is the same at both ends, but a number changes by more than the slopes beside explain."""
    rise = stretches.high_value - stretches.low_value
    width = (stretches.high - stretches.low)[:, np.newaxis]
    low = np.abs(rise - stretches.low_slope * width)
    high = np.abs(rise - stretches.high_slope * width)
    unexplained = np.fmin(low, high)
    unexplained = np.where(np.isnan(unexplained), np.abs(rise), unexplained)
    same = (stretches.low_code == stretches.high_code) & ~stretches.explained
    return same & (unexplained > 1.0).any(axis=1)


def parts_of(whole: Stretches, place: Floats, samples: Samples) -> list[Stretches]:
    """The lower and the upper parts of every stretch, cut at a place that was sampled."""
    below = (samples.values - whole.low_value) / (place - whole.low)[:, np.newaxis]
    above = (whole.high_value - samples.values) / (whole.high - place)[:, np.newaxis]
    below[samples.codes != whole.low_code] = np.nan
    above[samples.codes != whole.high_code] = np.nan
    none = np.zeros(len(whole))
    # Of a rise that is explained a sample in between confirms that it goes no detour.
    rise = np.abs(whole.high_value - whole.low_value) + 1.0
    detour = np.fmax(np.abs(samples.values - whole.low_value), np.abs(whole.high_value - samples.values)) > rise
    explained = whole.explained & ~detour.any(axis=1)
    lower = Stretches(
        whole.line,
        whole.low,
        place,
        whole.low_code,
        samples.codes,
        whole.low_value,
        samples.values,
        whole.low_slope,
        above,
        _lasting(whole, place - whole.low, samples.values - whole.low_value),
        whole.failures,
        none,
        none,
        explained,
    )
    upper = Stretches(
        whole.line,
        place,
        whole.high,
        samples.codes,
        whole.high_code,
        samples.values,
        whole.high_value,
        below,
        whole.high_slope,
        _lasting(whole, whole.high - place, whole.high_value - samples.values),
        whole.failures,
        none,
        none,
        explained,
    )
    return [lower, upper]


def _lasting(whole: Stretches, width: Floats, rise: Floats) -> Integers:
    """Over how many halvings the whole's rise has stayed in one part, if that is the one of this width and rise."""
    all_of_it = np.fmax(np.abs(whole.high_value - whole.low_value), 0.0).max(axis=1)
    stays = np.fmax(np.abs(rise), 0.0).max(axis=1) >= LASTING_SHARE * all_of_it
    halvings = np.rint(np.log2((whole.high - whole.low) / width)).astype(np.int64)
    return np.where(stays, whole.lasting + halvings, 0)
