"""The convex hull of points of a plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import copy_numbers

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

X, Y = range(2)


@kernel()
def is_after(i: int, j: int, points: Array) -> bool:
    """Whether a point comes after another one: by x, then y, then as they are given."""
    if points[i, X] != points[j, X]:
        return points[i, X] > points[j, X]
    return points[i, Y] > points[j, Y] if points[i, Y] != points[j, Y] else i > j


@kernel()
def sift_down(root: int, count: int, points: Array, order: Indices) -> None:
    """Moves the root of a heap down until no child comes after its parent."""
    while 2 * root + 1 < count:
        child = 2 * root + 1
        if child + 1 < count and is_after(order[child + 1], order[child], points):
            child += 1
        if not is_after(order[child], order[root], points):
            return
        order[root], order[child] = order[child], order[root]
        root = child


@kernel()
def set_order(count: int, points: Array, order: Indices) -> None:
    """Sets the order of points, by heapsort: NumPy's sorting would be compiled into each kernel that makes a hull."""
    for i in range(count):
        order[i] = i
    for root in range(count // 2 - 1, -1, -1):
        sift_down(root, count, points, order)
    for last in range(count - 1, 0, -1):
        order[0], order[last] = order[last], order[0]
        sift_down(0, last, points, order)


@kernel(allocates=True)
def convex_hull(points: Array, count: int, hull: Array) -> int:
    """Sets the corners of the convex hull of the first ``count`` points, counter-clockwise: Andrew's monotone chains.

    A point's row begins with x and y, and is that of its corner as a whole; ``hull`` has one row more than there are
    points. Returns how many corners there are; those of less than two points are these.
    """
    if count < 2:
        for i in range(count):
            copy_numbers(points[i], hull[i])
        return count
    order = np.empty(count, dtype=np.int64)
    set_order(count, points, order)
    size = 0
    for chain in range(2):
        first = size
        for m in range(count):
            i = order[m] if chain == 0 else order[count - 1 - m]
            x, y = points[i, X], points[i, Y]
            while size - first > 1:
                ax, ay = hull[size - 1, X] - hull[size - 2, X], hull[size - 1, Y] - hull[size - 2, Y]
                if ax * (y - hull[size - 2, Y]) - ay * (x - hull[size - 2, X]) > 0.0:
                    break
                size -= 1
            copy_numbers(points[i], hull[size])
            size += 1
        # Its last point is the first of the other chain.
        size -= 1
    return size
