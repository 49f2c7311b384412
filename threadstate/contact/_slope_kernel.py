"""Phi and its slopes A and B without a branch or a call of a library, for loops that the compiler can vectorise."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._lane_kernel import Numbers, azimuth, radius_and_slope
from threadstate.contact._tangency_kernel import S_OFF

Array = NDArray[np.float64]


@kernel(contract=True, forceinline=True)
def standing_numbers(standing: Array) -> Numbers:
    """Rotation by rows and offset."""
    return (
        standing[0],
        standing[1],
        standing[2],
        standing[3],
        standing[4],
        standing[5],
        standing[6],
        standing[7],
        standing[8],
        standing[S_OFF],
        standing[S_OFF + 1],
        standing[S_OFF + 2],
    )


@kernel(contract=True, forceinline=True)
def slopes(
    bx: float, by: float, z: float, dx: float, dy: float, k: float, place: Numbers, numbers: Numbers
) -> tuple[float, float, float]:
    """Phi, A and B at a point of the bolt.

    (dx, dy, 1) is its derivative along the axis, ``place`` the ``standing_numbers`` and ``numbers`` the nut's.
    """
    xx, xy, xz, yx, yy, yz, zx, zy, zz, off_x, off_y, off_z = place
    x = xx * bx + xy * by + xz * z + off_x
    y = yx * bx + yy * by + yz * z + off_y
    height = zx * bx + zy * by + zz * z + off_z
    ux = xy * bx - xx * by + xz * k
    uy = yy * bx - yx * by + yz * k
    uz = zy * bx - zx * by + zz * k
    ax = xx * dx + xy * dy + xz
    ay = yx * dx + yy * dy + yz
    az = zx * dx + zy * dy + zz
    r = math.sqrt(x * x + y * y)
    per_r = 1.0 / r
    radius, slope, _ = radius_and_slope(height - k * azimuth(x, y, r), numbers)
    x *= per_r
    y *= per_r
    k_r = k * per_r
    a = x * ux + y * uy - slope * (uz - k_r * (x * uy - y * ux))
    b = x * ax + y * ay - slope * (az - k_r * (x * ay - y * ax))
    return r - radius, a, b
