"""Which parts of a closed polygon of an edge curve lie inside the other part, by the closed form of its thread."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

TWO_PI = 2.0 * math.pi


@kernel()
def depths(points: Array, T: Array, profile: Array, sigma: float, out: Array) -> None:
    """How deep points of shape (n, 3) are behind the cut plane and within the thread, both positive inside; (n, 2).

    ``T`` (4, 4) takes them to the frame of the solid, whose thread is ``profile``; ``sigma`` is +1 for the nut, -1 for
    the bolt.
    """
    k = profile[pk.LEAD] / TWO_PI
    for i in range(points.shape[0]):
        a, b, c = points[i, 0], points[i, 1], points[i, 2]
        x = T[0, 0] * a + T[0, 1] * b + T[0, 2] * c + T[0, 3]
        y = T[1, 0] * a + T[1, 1] * b + T[1, 2] * c + T[1, 3]
        z = T[2, 0] * a + T[2, 1] * b + T[2, 2] * c + T[2, 3]
        out[i, 0] = -sigma * z
        out[i, 1] = sigma * (math.sqrt(x * x + y * y) - pk.radius(z - k * math.atan2(y, x), profile))


@kernel()
def part_above(a: float, b: float) -> tuple[float, float]:
    """Where along a segment (0 to 1) a linear function with these ends is positive; an empty part is (1, 0)."""
    if a > 0.0:
        return 0.0, (1.0 if b > 0.0 else a / (a - b))
    return (a / (a - b), 1.0) if b > 0.0 else (1.0, 0.0)


@kernel()
def runs(depth: Array, out: Array) -> int:
    """The parts of a closed polygon at which both depths, linear along its sides, are positive.

    Starts and ends, in sides from the first corner on, go to ``out`` (m, 2), a run through the first corner with its
    end beyond n; their number is returned. A polygon wholly inside is one run from 0 to n.
    """
    n = depth.shape[0]
    count = 0
    joined = False
    for i in range(n):
        j = (i + 1) % n
        a, b = part_above(depth[i, 0], depth[j, 0])
        c, d = part_above(depth[i, 1], depth[j, 1])
        start, end = max(a, c), min(b, d)
        if start >= end:
            joined = False
            continue
        if joined and start == 0.0:
            out[count - 1, 1] = i + end
        elif count < out.shape[0]:
            out[count, 0] = i + start
            out[count, 1] = i + end
            count += 1
        joined = end == 1.0
    if count > 1 and joined and out[0, 0] == 0.0:
        out[0, 0] = out[count - 1, 0]
        out[0, 1] += n
        count -= 1
    return count
