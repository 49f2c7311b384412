"""No second tangency where flanks and flats meet: the sign of phi_thetathetatheta from a contact on.

Where the curve's and the solid's profile are straight, all derivatives of phi from the third on vanish with the
misalignment of the two parts, whatever the time: docs/certificate.md, section 7, derives the bounds.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import (
    Numbers,
    profile_numbers,
    radius_and_slope,
    second_derivative_range,
    sine_cosine,
)
from threadstate.contact._frame_kernel import (
    linear_combination,
    motion_coefficients,
    motion_numbers,
    moved_vector,
    vector_rate,
)
from threadstate.contact._range_kernel import size_numbers

Array = NDArray[np.float64]

LARGEST_DEVIATION = 0.25
"""Up to which the logarithm of 1 + epsilon is expanded: farther from coaxial nothing is claimed."""


@kernel()
def logarithm_bounds(deviation: float, tilt: float, mu: float) -> tuple[float, float, float, float]:
    """Bounds on the first four derivatives of log(1 + epsilon); ``mu`` is |r'| / r.

    ``epsilon = deviation * exp(-i theta) r_low / r + tilt * exp(-2 i theta)`` but for constant phases.
    """
    inverse = 1.0 / (1.0 - deviation - tilt)
    a1 = inverse * (deviation * (1.0 + mu) + 2.0 * tilt)
    a2 = inverse * (deviation * (1.0 + 2.0 * mu * (1.0 + mu)) + 4.0 * tilt)
    a3 = inverse * (deviation * (1.0 + 3.0 * mu * (1.0 + 2.0 * mu * (1.0 + mu))) + 8.0 * tilt)
    a4 = inverse * (deviation * (1.0 + 4.0 * mu * (1.0 + 3.0 * mu * (1.0 + 2.0 * mu * (1.0 + mu)))) + 16.0 * tilt)
    return (
        a1,
        a2 + a1 * a1,
        a3 + 3.0 * a1 * a2 + 2.0 * a1**3,
        a4 + 4.0 * a1 * a3 + 3.0 * a2 * a2 + 12.0 * a1 * a1 * a2 + 6.0 * a1**4,
    )


@kernel()
def exponential_bounds(l1: float, l2: float, l3: float, l4: float) -> tuple[float, float]:
    """Bounds on the third and fourth derivatives of exp(L) over exp(L), from those of L."""
    return l3 + 3.0 * l1 * l2 + l1**3, l4 + 4.0 * l1 * l3 + 3.0 * l2 * l2 + 6.0 * l1 * l1 * l2 + l1**4


@kernel()
def planar_third_derivatives(w: complex, w1: complex, w2: complex, w3: complex) -> tuple[float, float]:
    """The third derivatives of radius and azimuth of a point of the plane, from its own derivatives."""
    l1 = w1 / w
    l2 = w2 / w - l1 * l1
    l3 = w3 / w - 3.0 * l1 * (w2 / w) + 2.0 * l1 * l1 * l1
    radial = l3.real + 3.0 * l2.real * l1.real + l1.real**3
    return abs(w) * radial, l3.imag


@kernel()
def rate_bound(c: Numbers, v: Numbers, radius: float, inverse_r: float, f1: float, k: float) -> float:
    """A bound on the derivative of phi_thetathetatheta by time.

    ``c`` and ``v`` bound the position's first three derivatives by azimuth and their rates, the latter from the
    position's own on, all of them vectors.
    """
    a1, a2, a3 = c[0] * inverse_r, c[1] * inverse_r, c[2] * inverse_r
    b0, b1, b2, b3 = v[0] * inverse_r, v[1] * inverse_r, v[2] * inverse_r, v[3] * inverse_r
    m1 = b1 + a1 * b0
    m2 = b2 + a2 * b0 + 2.0 * a1 * m1
    m3 = b3 + a3 * b0 + 3.0 * (m1 * a2 + a1 * (b2 + a2 * b0)) + 6.0 * a1 * a1 * m1
    l2 = a2 + a1 * a1
    l3 = a3 + 3.0 * a1 * a2 + 2.0 * a1**3
    radial = b0 * (l3 + 3.0 * l2 * a1 + a1**3) + m3 + 3.0 * (m2 * a1 + l2 * m1) + 3.0 * a1 * a1 * m1
    return radius * radial + abs(f1) * (v[3] + abs(k) * m3)


@kernel()
def no_tangency_on_flanks(
    contact: float,
    way: float,
    start: float,
    end: float,
    motion: Array,
    curve_profile: Array,
    solid_profile: Array,
) -> bool:
    """Whether phi_thetathetatheta keeps its sign from ``contact`` over ``way`` (rad) at all times of a span.

    At the contact phi = phi_theta = 0 at all times. False also where either profile is not straight there.
    """
    x_axis, y_axis, origin, rest = motion_numbers(motion)
    turning = rest[0]
    k, r_bound, _, _, _, base_error, error_by_time, _ = size_numbers(motion, curve_profile, solid_profile)
    theta, a = contact + 0.5 * way, 0.5 * abs(way) * (1.0 + 1e-15) + 1e-15
    tau, b = 0.5 * (start + end), 0.5 * (end - start) + 1e-15 * abs(end)
    error = base_error + error_by_time * abs(tau)
    curve = profile_numbers(curve_profile)
    r, slope, u, rises = radius_and_slope(-k * theta, curve)
    low, high = second_derivative_range(u, abs(k) * a + error, rises, curve)
    if not (low == 0.0 and high == 0.0):
        return False
    r1 = -k * slope
    r_low = r - abs(r1) * a - error
    mu = abs(r1) / r_low

    sin_theta, cos_theta = sine_cosine(theta)
    by_sine, by_versine, d_sine, d_versine = motion_coefficients(tau, turning)
    m1 = moved_vector(x_axis, by_sine, by_versine)
    m2 = moved_vector(y_axis, by_sine, by_versine)
    o = moved_vector(origin, by_sine, by_versine)
    ov = vector_rate(origin, d_sine, d_versine)
    p = linear_combination(m1, m2, cos_theta, sin_theta)
    q = linear_combination(m2, m1, cos_theta, -sin_theta)
    offset_speed = math.sqrt(ov[0] * ov[0] + ov[1] * ov[1] + ov[2] * ov[2])

    # How far from coaxial, over the box.
    sine = math.sqrt(m1[2] * m1[2] + m2[2] * m2[2]) + turning * b + error / r_low
    tilt = sine * sine
    offset = math.hypot(o[0], o[1]) + offset_speed * b + error
    cosine = m1[0] * m2[1] - m1[1] * m2[0]
    deviation = 2.0 * offset / ((1.0 + cosine - turning * b) * r_low)
    if not (cosine > turning * b + error and deviation + tilt < LARGEST_DEVIATION):
        return False
    l1, l2, l3, l4 = logarithm_bounds(deviation, tilt, mu)
    e3, e4 = exponential_bounds(l1, l2, l3, l4)
    high_r = (1.0 + deviation + tilt) * (r + abs(r1) * a)
    fourth_radial = high_r * e4 + 4.0 * (1.0 + deviation + tilt) * abs(r1) * e3
    fourth_helical = sine * (r + abs(r1) * (a + 4.0)) + abs(k) * l4

    # The solid's flank.
    w = complex(r * p[0] + o[0], r * p[1] + o[1])
    z = r * p[2] + o[2]
    _, f1, u, rises = radius_and_slope(z - k * math.atan2(w.imag, w.real), profile_numbers(solid_profile))
    speed = offset_speed + turning * r_bound
    inverse_r = 1.0 / ((1.0 - deviation - tilt) * r_low * 0.5 * (1.0 + cosine - turning * b))
    helix = 1.0 + abs(k) * inverse_r
    reach = (sine * (r + abs(r1) * (1.0 + a)) + abs(k) * (1.0 + l1)) * a + helix * (speed * b + 2.0 * error)
    low, high = second_derivative_range(u, reach, rises, profile_numbers(solid_profile))
    if not (low == 0.0 and high == 0.0):
        return False

    third_radial, third_azimuth = planar_third_derivatives(
        w,
        complex(r1 * p[0] + r * q[0], r1 * p[1] + r * q[1]),
        complex(2.0 * r1 * q[0] - r * p[0], 2.0 * r1 * q[1] - r * p[1]),
        complex(-3.0 * r1 * p[0] - r * q[0], -3.0 * r1 * p[1] - r * q[1]),
    )
    third = third_radial - f1 * (-3.0 * r1 * p[2] - r * q[2] - k * third_azimuth)
    c = (r_bound + abs(r1), r_bound + 2.0 * abs(r1), r_bound + 3.0 * abs(r1))
    rate = rate_bound(c, (speed, turning * c[0], turning * c[1], turning * c[2]), high_r, inverse_r, f1, k)
    size = c[2] * inverse_r
    round_off = 100.0 * (1.0 + abs(f1) * helix) * error * high_r * inverse_r * (1.0 + size) ** 3
    change = (fourth_radial + abs(f1) * fourth_helical) * a + rate * b + round_off
    return abs(third) > change
