"""The height of the bolt against its phase, to a given tolerance at every phase (the paper's figures 7 to 10).

At first contact, and where the bolt rests: the last pose of a state that does not rest is no place of the bolt and has
no height here (method, section 8).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.history.model import CIRCLE_DEG
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

START_DEG = 5.0
"""Spacing of the first samples of a curve, which also begins with those of its boundaries."""

WHOLE_DEG = 1.0
"""Steps longer than this end at multiples of it, where a library has its states."""

NARROW_DEG = 1e-3
"""Within a stretch of this width a height is assumed to be monotone."""

LEAST_DEG = 1e-6
"""Narrower stretches are not bisected: boundaries, and the end of a fall as a square root."""


@dataclass(frozen=True, slots=True)
class Heights:
    """Arrays of shape (n,), read-only: phases in degrees, strictly ascending, and heights of the bolt's origin there.

    ``first`` is the height at first contact, NaN where undecided; ``rest`` that at which the bolt rests, NaN where it
    does not. Both are in the pair's unit.
    """

    phases_deg: Floats
    first: Floats
    rest: Floats


Solved = tuple[float, float]
"""Height at first contact, and where the bolt rests; NaN where it does not."""

KnownHeights = dict[float, Solved]
"""Heights by their phases in [0, 360)."""


def heights_of(
    pair: Pair,
    roll_deg: float,
    pitch_deg: float,
    boundaries_deg: Iterable[float],
    tolerance: float,
    known: KnownHeights | None = None,
    options: SolveOptions | None = None,
) -> Heights:
    """Heights from phase 0 to 360 that linear interpolation reproduces within the tolerance.

    Stretches are bisected until their middles lie no farther than ``tolerance``, a length in the pair's unit, from the
    line between their ends, so that a curve that bends evenly is within a quarter of it; where it ends as a root does
    the last stretch is LEAST_DEG wide or within the tolerance. ``boundaries_deg`` are both phases of every boundary of
    the orientation's history: a jump shows as two heights that near each other. What is ``known`` is not solved again.
    """
    found = dict(known or {})

    def heights(phases_deg: Floats) -> Floats:
        unknown = sorted({phase for phase in (phases_deg % CIRCLE_DEG).tolist() if phase not in found})
        if unknown:
            poses = np.column_stack([np.full((len(unknown), 2), (roll_deg, pitch_deg)), unknown])
            found.update(zip(unknown, _solved(pair, options or SolveOptions(), poses), strict=True))
        return np.array([found[phase] for phase in (phases_deg % CIRCLE_DEG).tolist()]).reshape(-1, 2)

    even = np.linspace(0.0, CIRCLE_DEG, 1 + round(CIRCLE_DEG / START_DEG))
    sides = np.array(list(boundaries_deg), dtype=np.float64) % CIRCLE_DEG
    phases = _refined(heights, np.unique(np.concatenate([even, sides])), tolerance)
    columns = phases, *heights(phases).T.copy()
    for column in columns:
        column.setflags(write=False)
    return Heights(*columns)


def _refined(heights: Callable[[Floats], Floats], phases: Floats, tolerance: float) -> Floats:
    """The phases, and those that linear interpolation needs between two neighbours, in order."""
    arrays = [phases]
    low, high = phases[:-1], phases[1:]
    while len(low):
        at_low, at_high = heights(low), heights(high)
        changes = (np.abs(at_high - at_low) > tolerance).any(axis=1)
        changes |= _rest_differs(at_low, at_high)
        candidates = (high - low > NARROW_DEG) | (changes & (high - low > LEAST_DEG))
        low, high, at_low, at_high = low[candidates], high[candidates], at_low[candidates], at_high[candidates]
        middle = _middles(low, high)
        share = ((middle - low) / (high - low))[:, np.newaxis]
        at_middle = heights(middle)
        refine = (np.abs(at_middle - (1.0 - share) * at_low - share * at_high) > tolerance).any(axis=1)
        refine |= np.isnan(at_middle).any(axis=1) & ~np.isnan(at_low + at_high).any(axis=1)
        refine |= _rest_differs(at_low, at_middle) | _rest_differs(at_middle, at_high)
        arrays.append(middle)
        low, high = np.concatenate([low[refine], middle[refine]]), np.concatenate([middle[refine], high[refine]])
    return np.sort(np.concatenate(arrays))


def _rest_differs(one: Floats, other: Floats) -> NDArray[np.bool_]:
    """Where the bolt rests at one of two decided phases alone."""
    decided = ~np.isnan(one[:, 0]) & ~np.isnan(other[:, 0])
    return decided & (np.isnan(one[:, 1]) != np.isnan(other[:, 1]))


def _middles(low: Floats, high: Floats) -> Floats:
    """Phases about half way between others: multiples of WHOLE_DEG where there are any in between."""
    middle = 0.5 * (low + high)
    whole = np.round(middle / WHOLE_DEG) * WHOLE_DEG
    return np.where((low < whole) & (whole < high), whole, middle)


def _solved(pair: Pair, options: SolveOptions, poses_deg: Floats) -> list[Solved]:
    """The heights of poses of shape (n, 3)."""
    records = solve_records(pair, options, poses_deg)
    heights = records[:, rk.O_POSE + 11 : rk.O_CONTACT : 12]
    last = heights[np.arange(len(heights)), np.maximum(records[:, rk.O_POSES].astype(np.intp) - 1, 0)]
    at_rest = np.where(_resting(pair, options, records), last, np.nan)
    both = np.column_stack([heights[:, 0], at_rest])
    both[records[:, rk.O_STATUS] != 0.0] = np.nan
    return [(first, rest) for first, rest in both.tolist()]


def _resting(pair: Pair, options: SolveOptions, records: Floats) -> NDArray[np.bool_]:
    """Whether each record is of a state that rests, as :func:`threadstate.library.read.rests` has it.

    A third contact and no embedment are enough: a state with both is of one of the stable classes.
    """
    flush = (records[:, rk.O_FLAGS].astype(np.int64) & rk.FLAG_FLUSH) != 0
    embedment = records[:, rk.O_EMBEDMENT]
    return flush | (~np.isnan(records[:, rk.O_MU]) & (embedment <= options.embedment_tolerance * pair.thread_pitch))
