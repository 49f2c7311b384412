"""How far points are from a thread's true surface, and points of an outline from the true edge curve."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import phi_and_gradient

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

DIVISIONS = 4
"""A triangle is sampled at the points of a grid with this many divisions of its sides, a segment likewise."""
STEPS = 3
"""Newton steps towards the surface."""


@kernel()
def distance(x: float, y: float, z: float, in_plane: bool, profile: Array) -> float:
    """The distance to a point of the surface that lies along the gradient: never less than the true distance.

    With ``in_plane`` steps keep their height, so that it is the distance to the outline at ``z``.
    """
    px, py, pz = x, y, z
    for _ in range(STEPS):
        phi, gx, gy, gz = phi_and_gradient(px, py, pz, profile, 1.0)
        if in_plane:
            gz = 0.0
        share = phi / (gx * gx + gy * gy + gz * gz)
        px -= share * gx
        py -= share * gy
        pz -= share * gz
    return math.sqrt((px - x) ** 2 + (py - y) ** 2 + (pz - z) ** 2)


@kernel()
def largest_of_triangles(vertices: Array, triangles: Indices, profile: Array) -> float:
    """The largest distance from triangles, of shape (m, 3), to the surface."""
    largest = 0.0
    for t in range(triangles.shape[0]):
        a, b, c = vertices[triangles[t, 0]], vertices[triangles[t, 1]], vertices[triangles[t, 2]]
        for i in range(DIVISIONS + 1):
            for j in range(DIVISIONS + 1 - i):
                u, v = i / DIVISIONS, j / DIVISIONS
                w = 1.0 - u - v
                x, y, z = (
                    u * a[0] + v * b[0] + w * c[0],
                    u * a[1] + v * b[1] + w * c[1],
                    u * a[2] + v * b[2] + w * c[2],
                )
                largest = max(largest, distance(x, y, z, False, profile))
    return largest


@kernel()
def largest_of_outline(points: Array, profile: Array) -> float:
    """The largest distance, within their plane, from a closed polygon of shape (k, 3) to the edge curve."""
    largest = 0.0
    for i in range(points.shape[0]):
        a, b = points[i], points[(i + 1) % points.shape[0]]
        for j in range(DIVISIONS):
            u = j / DIVISIONS
            x, y, z = a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1]), a[2] + u * (b[2] - a[2])
            largest = max(largest, distance(x, y, z, True, profile))
    return largest
