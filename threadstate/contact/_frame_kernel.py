"""The frame of a moving edge curve along a motion, as tuples of numbers for loops without branches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import Numbers, sine_cosine
from threadstate.contact._geometry_kernel import M_AXIS, M_COPLANAR, M_KIND, M_OFF, M_POINT, M_SIGMA

Array = NDArray[np.float64]


@kernel(contract=True, forceinline=True)
def cross_product(ax: float, ay: float, az: float, x: float, y: float, z: float) -> tuple[float, float, float]:
    """The cross product of two vectors."""
    return ay * z - az * y, az * x - ax * z, ax * y - ay * x


@kernel(contract=True, forceinline=True)
def motion_numbers(motion: Array) -> tuple[Numbers, Numbers, Numbers, Numbers]:
    """A motion as tuples: the curve's x direction, y direction and origin; then the rest.

    Each vector comes with its coefficients of sine and versine (of a translation: of the distance), nine numbers. The
    rest: 1 for a turn and 0 for a translation, sigma, 0 where the axis lies in both planes and 1 elsewhere, the axis.
    """
    turning, sigma = motion[M_KIND], motion[M_SIGMA]
    moving = 0.0 if motion[M_COPLANAR] != 0.0 else 1.0
    ax, ay, az = motion[M_AXIS], motion[M_AXIS + 1], motion[M_AXIS + 2]
    ox, oy, oz = motion[M_OFF], motion[M_OFF + 1], motion[M_OFF + 2]
    x1, y1, z1 = cross_product(turning * ax, turning * ay, turning * az, motion[0], motion[3], motion[6])
    x2, y2, z2 = cross_product(turning * ax, turning * ay, turning * az, motion[1], motion[4], motion[7])
    if turning != 0.0:
        x3, y3, z3 = cross_product(ax, ay, az, ox - motion[M_POINT], oy - motion[M_POINT + 1], oz - motion[M_POINT + 2])
    else:
        x3, y3, z3 = ax, ay, az
    x11, y11, z11 = cross_product(turning * ax, turning * ay, turning * az, x1, y1, z1)
    x22, y22, z22 = cross_product(turning * ax, turning * ay, turning * az, x2, y2, z2)
    x33, y33, z33 = cross_product(turning * ax, turning * ay, turning * az, x3, y3, z3)
    return (
        (motion[0], motion[3], motion[6], x1, y1, z1, x11, y11, z11),
        (motion[1], motion[4], motion[7], x2, y2, z2, x22, y22, z22),
        (ox, oy, oz, x3, y3, z3, x33, y33, z33),
        (turning, sigma, moving, ax, ay, az),
    )


@kernel(contract=True, forceinline=True)
def motion_coefficients(tau: float, turning: float) -> tuple[float, float, float, float]:
    """The sine and the versine of a turn (of a translation: the distance and 0), and their derivatives."""
    sine, cosine = sine_cosine(tau)
    if turning != 0.0:
        return sine, sine * sine / (1.0 + cosine), cosine, sine
    return tau, 0.0, 1.0, 0.0


@kernel(contract=True, forceinline=True)
def moved_vector(vector: Numbers, by_sine: float, by_versine: float) -> tuple[float, float, float]:
    """A vector of :func:`motion_numbers` after a motion."""
    x, y, z, xs, ys, zs, xv, yv, zv = vector
    return x + by_sine * xs + by_versine * xv, y + by_sine * ys + by_versine * yv, z + by_sine * zs + by_versine * zv


@kernel(contract=True, forceinline=True)
def vector_rate(vector: Numbers, by_sine: float, by_versine: float) -> tuple[float, float, float]:
    """The derivative of such a vector by tau; the coefficients are those of the derivative."""
    _, _, _, xs, ys, zs, xv, yv, zv = vector
    return by_sine * xs + by_versine * xv, by_sine * ys + by_versine * yv, by_sine * zs + by_versine * zv


@kernel(contract=True, forceinline=True)
def linear_combination(
    u: tuple[float, float, float], v: tuple[float, float, float], cosine: float, sine: float
) -> tuple[float, float, float]:
    """``u cos + v sin``."""
    return u[0] * cosine + v[0] * sine, u[1] * cosine + v[1] * sine, u[2] * cosine + v[2] * sine


@kernel(contract=True, forceinline=True)
def cylindrical_components(
    u: tuple[float, float, float], rx: float, ry: float, k_r: float
) -> tuple[float, float, float]:
    """A vector's components along the solid's radius and azimuth, and the derivative of s along it."""
    azimuthal = u[1] * rx - u[0] * ry
    return u[0] * rx + u[1] * ry, azimuthal, u[2] - k_r * azimuthal
