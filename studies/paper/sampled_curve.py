"""A curve of height through samples alone, for revolutions in which the tilt does not go round with the phase."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from threadstate.history.height_curve import ROUND_OFF, Gap, HeightCurve, Segment
from threadstate.history.model import CIRCLE_DEG

Array = NDArray[np.float64]


def sampled_curve(heights: Array, step_deg: float, thread_pitch: float) -> HeightCurve:
    """The curve that is straight between heights, shape (n,), from phase 0 on in steps that make up a turn.

    What falls and rises again between two samples is not in it.
    """
    round_off = ROUND_OFF * thread_pitch
    closed = np.append(heights, heights[0])
    rises = np.diff(closed)
    signs = np.where(np.abs(rises) <= round_off, 0.0, np.sign(rises))
    ends = [0, *(np.flatnonzero(np.diff(signs)) + 1).tolist(), len(heights)]
    segments = tuple(
        Segment(low * step_deg, high * step_deg, float(closed[low]), float(closed[high]))
        for low, high in pairwise(ends)
    )
    gaps = tuple(Gap(one.start_deg, one.start_deg, one.start_height, one.start_height) for one in segments)
    phases = np.arange(len(closed)) * step_deg

    def height(at_deg: Array) -> Array:
        found: Array = np.interp(at_deg % CIRCLE_DEG, phases, closed)
        return found

    def slope(at_deg: Array) -> Array:
        steps = (at_deg % CIRCLE_DEG // step_deg).astype(np.intp)
        found: Array = rises[steps] / step_deg
        return found

    return HeightCurve(segments, gaps, height, slope, round_off)
