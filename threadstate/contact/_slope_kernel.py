"""Phi and its slopes A and B without branches or library calls, for loops that the compiler can vectorise."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import Numbers, azimuth, radius_and_slope
from threadstate.contact._tangency_kernel import PLACEMENT_OFF

Array = NDArray[np.float64]


@kernel(contract=True, forceinline=True)
def placement_numbers(placement: Array) -> Numbers:
    """The rotation of a placement by rows, and its offset."""
    return (
        placement[0],
        placement[1],
        placement[2],
        placement[3],
        placement[4],
        placement[5],
        placement[6],
        placement[7],
        placement[8],
        placement[PLACEMENT_OFF],
        placement[PLACEMENT_OFF + 1],
        placement[PLACEMENT_OFF + 2],
    )


@kernel(contract=True, forceinline=True)
def slopes(
    bx: float, by: float, z: float, dx: float, dy: float, k: float, placement_values: Numbers, numbers: Numbers
) -> tuple[float, float, float]:
    """Phi, A and B at a point of the bolt.

    (dx, dy, 1) is its derivative along the axis, ``placement_values`` the :func:`placement_numbers` and ``numbers`` the
    :func:`profile_numbers` of the nut.
    """
    xx, xy, xz, yx, yy, yz, zx, zy, zz, off_x, off_y, off_z = placement_values
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
    inverse_r = 1.0 / r
    radius, slope, _, _ = radius_and_slope(height - k * azimuth(x, y, r), numbers)
    x *= inverse_r
    y *= inverse_r
    k_r = k * inverse_r
    a = x * ux + y * uy - slope * (uz - k_r * (x * uy - y * ux))
    b = x * ax + y * ay - slope * (az - k_r * (x * ay - y * ax))
    return r - radius, a, b
