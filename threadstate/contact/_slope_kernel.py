"""The slopes A and B of phi without a branch or a call of a library, for loops that the compiler can vectorise.

They are good to 1e-8, which is enough for where their signs change; ``_tangency_kernel`` has them to round-off.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from threadstate.contact._tangency_kernel import S_OFF
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Numbers = tuple[float, ...]

ROUNDER = 1.5 * 2.0**52
"""Adding and taking it away rounds to the nearest whole number."""
TINY = 1e-300
ARC_TANGENT = (
    0.999999999939,
    -0.333333315182,
    0.199999099569,
    -0.142839484195,
    0.110929847752,
    -0.089790509961,
    0.0724228399726,
    -0.0542153058452,
    0.0341334200475,
    -0.0160551585434,
    0.0048272269218,
    -0.000680497122084,
)
"""Coefficients of atan(t) / t in powers of t^2, 0 <= t <= 1, by a least-squares fit: 5e-11 off at the most."""


@njit(cache=True, error_model="numpy", forceinline=True)
def profile_numbers(row: Array) -> Numbers:
    """What ``radius_and_slope`` needs of a profile's row."""
    return (
        row[pk.P],
        1.0 / row[pk.P],
        row[pk.U_FLAT],
        row[pk.U_FLANK],
        row[pk.R_PITCH],
        row[pk.COT],
        row[pk.U_CREST],
        row[pk.U_TOP],
        row[pk.R_MINOR] + row[pk.RHO_MINOR],
        row[pk.R_MAJOR] - row[pk.RHO_MAJOR],
        row[pk.RHO_MINOR] * row[pk.RHO_MINOR],
        row[pk.RHO_MAJOR] * row[pk.RHO_MAJOR],
    )


@njit(cache=True, error_model="numpy", forceinline=True)
def radius_and_slope(s: float, numbers: Numbers) -> tuple[float, float]:
    """The profile's radius and slope at ``s``, without a branch."""
    p, per_p, u_flat, u_flank, r_pitch, cot, u_crest, u_top, low_middle, high_middle, minor2, major2 = numbers
    turns = s * per_p + 0.25
    q = (turns - ((turns + ROUNDER) - ROUNDER)) * p
    u = abs(q) - 0.25 * p
    low = u < 0.5 * (u_flank + u_crest)
    du = u - u_flat if low else u_top - u
    du = du if du > 0.0 else 0.0
    # On the flank, and at a corner without a fillet, this is not a square: the flank's own numbers are taken below.
    left = (minor2 if low else major2) - du * du
    c = math.sqrt(left if left > TINY else TINY)
    slope = du / c
    radius = low_middle - c if low else high_middle + c
    on_flank = slope >= cot
    radius = r_pitch + u * cot if on_flank else radius
    slope = cot if on_flank else slope
    return radius, (slope if q > 0.0 else -slope)


@njit(cache=True, error_model="numpy", forceinline=True)
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


@njit(cache=True, error_model="numpy", forceinline=True)
def slopes(
    bx: float, by: float, z: float, dx: float, dy: float, k: float, place: Numbers, numbers: Numbers
) -> tuple[float, float]:
    """A and B at a point of the bolt.

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
    t = abs(y) / (r + abs(x))
    w = t * t
    angle = ARC_TANGENT[11]
    angle = angle * w + ARC_TANGENT[10]
    angle = angle * w + ARC_TANGENT[9]
    angle = angle * w + ARC_TANGENT[8]
    angle = angle * w + ARC_TANGENT[7]
    angle = angle * w + ARC_TANGENT[6]
    angle = angle * w + ARC_TANGENT[5]
    angle = angle * w + ARC_TANGENT[4]
    angle = angle * w + ARC_TANGENT[3]
    angle = angle * w + ARC_TANGENT[2]
    angle = angle * w + ARC_TANGENT[1]
    # The angle of half the azimuth has the tangent t.
    angle = 2.0 * t * (angle * w + ARC_TANGENT[0])
    angle = math.pi - angle if x < 0.0 else angle
    angle = -angle if y < 0.0 else angle
    _, slope = radius_and_slope(height - k * angle, numbers)
    x *= per_r
    y *= per_r
    k_r = k * per_r
    a = x * ux + y * uy - slope * (uz - k_r * (x * uy - y * ux))
    b = x * ax + y * ay - slope * (az - k_r * (x * ay - y * ax))
    return a, b
