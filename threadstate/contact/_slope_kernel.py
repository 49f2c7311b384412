"""Phi and its slopes A and B without branches or library calls, for loops that the compiler can vectorise."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import Numbers, coarse_azimuth, radius_and_slope
from threadstate.contact._tangency_kernel import PLACEMENT_OFF

Array = NDArray[np.float64]
Vector = tuple[float, float, float]


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
def in_nut(x: float, y: float, z: float, m: Numbers) -> Vector:
    """A vector of the bolt's frame in the nut's; ``m`` are the :func:`placement_numbers`."""
    return m[0] * x + m[1] * y + m[2] * z, m[3] * x + m[4] * y + m[5] * z, m[6] * x + m[7] * y + m[8] * z


@kernel(contract=True, forceinline=True)
def gradient_at(at: Vector, k: float, numbers: Numbers) -> tuple[float, Vector]:
    """Phi at a point of the nut's frame and its gradient; ``numbers`` are the :func:`profile_numbers` of the nut."""
    x, y, z = at
    r = math.sqrt(x * x + y * y)
    around, inverse_r = coarse_azimuth(x, y, r)
    radius, slope, _, _ = radius_and_slope(z - k * around, numbers)
    x *= inverse_r
    y *= inverse_r
    turn = slope * (k * inverse_r)
    return r - radius, (x - turn * y, y + turn * x, -slope)


@kernel(contract=True, forceinline=True)
def along(gradient: Vector, way: Vector) -> float:
    """The derivative along a way."""
    return gradient[0] * way[0] + gradient[1] * way[1] + gradient[2] * way[2]


@kernel(contract=True, forceinline=True)
def slopes(
    bx: float, by: float, z: float, dx: float, dy: float, k: float, m: Numbers, numbers: Numbers
) -> tuple[float, float, float]:
    """Phi, A and B at a point of the bolt.

    (dx, dy, 1) is its derivative along the axis, ``m`` are the :func:`placement_numbers` and ``numbers`` the
    :func:`profile_numbers` of the nut.
    """
    x, y, height = in_nut(bx, by, z, m)
    phi, gradient = gradient_at((x + m[9], y + m[10], height + m[11]), k, numbers)
    return phi, along(gradient, in_nut(-by, bx, k, m)), along(gradient, in_nut(dx, dy, 1.0, m))
