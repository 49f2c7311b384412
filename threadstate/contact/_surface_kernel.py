"""A bolt that comes down on the nut's surface: its lowest point, and how high it starts."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import TWO_PI, edge_point
from threadstate.contact._stage_kernel import EDGE_SURFACE, K_BOLT_AZIMUTH, K_NUT_AZIMUTH, K_PAIR, K_TIME, K_X, K_Y, K_Z
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]


@kernel()
def lowest_outline_point(pose: Array, bolt: Array) -> float:
    """Azimuth at which a convex outline is lowest: the root of :func:`height_slope` down the tilt (Illinois)."""
    # Down the tilt the height falls fastest: azimuth of -(r31, r32) in the bolt's frame. The lowest point of a convex
    # outline r = f lies within a quarter turn of it.
    down = math.atan2(-pose[7], -pose[6])
    a, b = down - 0.5 * math.pi, down + 0.5 * math.pi
    fa, fb = height_slope(a, pose, bolt), height_slope(b, pose, bolt)
    wa, wb = fa, fb
    side = 0
    for _ in range(100):
        c = (a * wb - b * wa) / (wb - wa)
        if not a < c < b:
            c = 0.5 * (a + b)
        fc = height_slope(c, pose, bolt)
        if fc < 0.0:
            a, fa, wa = c, fc, fc
            if side == -1:
                wb *= 0.5
            side = -1
        else:
            b, fb, wb = c, fc, fc
            if side == 1:
                wa *= 0.5
            side = 1
        if fc == 0.0 or b - a <= 4e-16 * (1.0 + abs(a)):
            break
    return a if abs(fa) < abs(fb) else b


@kernel()
def height_slope(theta: float, pose: Array, bolt: Array) -> float:
    """Derivative by azimuth of the height of the bolt's outline."""
    _, _, dx, dy = edge_point(theta, bolt)
    return pose[6] * dx + pose[7] * dy


@kernel()
def meets_surface_first(pose: Array, bolt: Array, nut: Array, out: Array) -> bool:
    """Whether the lowest point of a convex outline meets the nut's surface; then that is the first contact.

    Proof: until its lowest point is at z = 0 the whole bolt is above the nut's surface (its thread's outward normals
    are nearer the horizontal than the tilt, so that it is lowest at the outline), and the nut is below it. Sets the
    contact; its time is the height of the origin.
    """
    theta = lowest_outline_point(pose, bolt)
    x, y, _, _ = edge_point(theta, bolt)
    px = pose[0] * x + pose[1] * y
    py = pose[3] * x + pose[4] * y
    other = math.atan2(py, px)
    if not math.hypot(px, py) >= pk.radius(-bolt[pk.LEAD] / TWO_PI * other, nut):
        return False
    out[K_TIME] = -(pose[6] * x + pose[7] * y)
    out[K_PAIR] = EDGE_SURFACE
    out[K_BOLT_AZIMUTH] = theta
    out[K_NUT_AZIMUTH] = other
    out[K_X] = px
    out[K_Y] = py
    out[K_Z] = 0.0
    return True


@kernel()
def start_height(pose: Array, bolt: Array) -> float:
    """A height of the bolt's origin at which the whole bolt is above the nut."""
    return bolt[pk.R_MAJOR] * math.hypot(pose[2], pose[5]) * (1.0 + 1e-9) + 1e-4 * bolt[pk.P]
