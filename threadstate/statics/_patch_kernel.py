"""The hull of the patch on which a bolt's base lies flush on the nut's surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._flush_kernel import base_outline, distance_outside, outline_root
from threadstate.contact._geometry_kernel import TWO_PI

Array = NDArray[np.float64]

OUTLINE_SAMPLES = 360
"""Points of the bolt's outline from which the hull is made."""


@kernel(allocates=True)
def patch_points(pose: Array, bolt: Array, nut: Array, points: Array) -> int:
    """Points of the bolt's outline outside the nut's, and where they cross, into ``points`` (2 OUTLINE_SAMPLES, 2).

    Returns how many there are.
    """
    count = 0
    before = distance_outside(0.0, pose, bolt, nut)
    for i in range(OUTLINE_SAMPLES):
        theta = TWO_PI * i / OUTLINE_SAMPLES
        following = TWO_PI * (i + 1) / OUTLINE_SAMPLES
        if before >= 0.0:
            points[count, 0], points[count, 1], _, _ = base_outline(theta, pose, bolt)
            count += 1
        after = distance_outside(following, pose, bolt, nut)
        if (before > 0.0) != (after > 0.0):
            crossing = outline_root(theta, following, True, 0.0, 0.0, pose, bolt, nut)
            points[count, 0], points[count, 1], _, _ = base_outline(crossing, pose, bolt)
            count += 1
        before = after
    return count


@kernel(allocates=True)
def turns_left(a: Array, b: Array, c: Array) -> bool:
    """Whether c lies to the left of the line from a to b."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0


@kernel(allocates=True)
def convex_hull(points: Array, hull: Array) -> int:
    """The extreme points of points (n, 2), counter-clockwise, into ``hull`` (n + 1, 2): Andrew's monotone chain.

    Sorts the points by x. Returns how many are extreme.
    """
    n = points.shape[0]
    order = np.argsort(points[:, 0])
    count = 0
    for i in range(n):
        while count > 1 and not turns_left(hull[count - 2], hull[count - 1], points[order[i]]):
            count -= 1
        hull[count, 0], hull[count, 1] = points[order[i], 0], points[order[i], 1]
        count += 1
    lower = count + 1
    for i in range(n - 2, -1, -1):
        while count >= lower and not turns_left(hull[count - 2], hull[count - 1], points[order[i]]):
            count -= 1
        hull[count, 0], hull[count, 1] = points[order[i], 0], points[order[i], 1]
        count += 1
    return count - 1


@kernel(allocates=True)
def patch_hull(pose: Array, bolt: Array, nut: Array, hull: Array) -> int:
    """The extreme points of the patch of a flush bolt, counter-clockwise, into ``hull`` (2 OUTLINE_SAMPLES + 1, 2).

    The patch is what the bolt's base covers of the nut's surface; its hull is that of the arcs of the bolt's outline
    outside the nut's, with their ends. Returns how many there are.
    """
    points = np.empty((2 * OUTLINE_SAMPLES, 2))
    count = patch_points(pose, bolt, nut, points)
    return convex_hull(points[:count], hull) if count > 2 else 0
