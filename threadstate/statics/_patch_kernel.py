"""The hull of the patch on which a bolt's base lies flush on the nut's surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._flush_kernel import base_outline, distance_outside, outline_root
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._hull_kernel import convex_hull

Array = NDArray[np.float64]

OUTLINE_SAMPLES = 360
"""Points of the bolt's outline from which the hull is made."""


@kernel()
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
def patch_hull(pose: Array, bolt: Array, nut: Array, hull: Array) -> int:
    """The extreme points of the patch of a flush bolt, counter-clockwise, into ``hull`` (2 OUTLINE_SAMPLES + 1, 2).

    The patch is what the bolt's base covers of the nut's surface; its hull is that of the arcs of the bolt's outline
    outside the nut's, with their ends. Returns how many there are.
    """
    points = np.empty((2 * OUTLINE_SAMPLES, 2))
    count = patch_points(pose, bolt, nut, points)
    return convex_hull(points, count, hull) if count > 2 else 0
