"""The hull of the patch on which a bolt's base lies flush on the nut's surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._flush_kernel import base_outline, distance_of_point, outline_root
from threadstate.contact._geometry_kernel import TWO_PI, edge_point
from threadstate.contact._hull_kernel import convex_hull

Array = NDArray[np.float64]

OUTLINE_SAMPLES = 360
"""Points of the bolt's outline from which the hull is made."""


@kernel()
def set_outline(bolt: Array, outline: Array) -> None:
    """Sets the points of the bolt's edge at ``OUTLINE_SAMPLES`` azimuths and at the end, in its own plane."""
    for i in range(OUTLINE_SAMPLES + 1):
        outline[i, 0], outline[i, 1], _, _ = edge_point(TWO_PI * i / OUTLINE_SAMPLES, bolt)


@kernel()
def patch_points(pose: Array, outline: Array, bolt: Array, nut: Array, points: Array) -> int:
    """Points of the bolt's outline outside the nut's, and where they cross, into ``points`` (2 OUTLINE_SAMPLES, 2).

    Returns how many there are.
    """
    count = 0
    was_outside = False
    for i in range(OUTLINE_SAMPLES + 1):
        x = pose[0] * outline[i, 0] + pose[1] * outline[i, 1] + pose[9]
        y = pose[3] * outline[i, 0] + pose[4] * outline[i, 1] + pose[10]
        outside = distance_of_point(x, y, nut)
        if i > 0 and (outside > 0.0) != was_outside:
            theta, following = TWO_PI * (i - 1) / OUTLINE_SAMPLES, TWO_PI * i / OUTLINE_SAMPLES
            crossing = outline_root(theta, following, True, 0.0, 0.0, pose, bolt, nut)
            points[count, 0], points[count, 1], _, _ = base_outline(crossing, pose, bolt)
            count += 1
        was_outside = outside > 0.0
        if outside >= 0.0 and i < OUTLINE_SAMPLES:
            points[count, 0], points[count, 1] = x, y
            count += 1
    return count


@kernel(allocates=True)
def hull_with(pose: Array, outline: Array, bolt: Array, nut: Array, hull: Array) -> int:
    """As :func:`patch_hull`, with the ``outline`` that :func:`set_outline` sets."""
    points = np.empty((2 * OUTLINE_SAMPLES, 2))
    count = patch_points(pose, outline, bolt, nut, points)
    return convex_hull(points, count, hull) if count > 2 else 0


@kernel(allocates=True)
def patch_hull(pose: Array, bolt: Array, nut: Array, hull: Array) -> int:
    """The extreme points of the patch of a flush bolt, counter-clockwise, into ``hull`` (2 OUTLINE_SAMPLES + 1, 2).

    The patch is what the bolt's base covers of the nut's surface; its hull is that of the arcs of the bolt's outline
    outside the nut's, with their ends. Returns how many there are.
    """
    outline = np.empty((OUTLINE_SAMPLES + 1, 2))
    set_outline(bolt, outline)
    return hull_with(pose, outline, bolt, nut, hull)
