"""No second tangency where flanks and flats meet: the sign of phi_thetathetatheta from a contact on.

Where the profiles of curve and solid are straight all derivatives of phi from the third on vanish with the misalignment
of the two parts, whatever the time. With complex numbers for points of the solid's plane the edge point is at

    w = A exp(i theta) r (1 + epsilon),    epsilon = o exp(-i theta) / (A r) + (B / A) exp(-2 i theta),

so that radius and azimuth are those of A exp(i theta) r, of no third derivative, and the parts of log(1 + epsilon):
docs/certificate.md, section 7, derives the bounds.
"""

from __future__ import annotations

import cmath
import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import Numbers, profile_numbers, radius_and_slope, second_derivative_range
from threadstate.contact._frame_kernel import (
    linear_combination,
    motion_coefficients,
    motion_numbers,
    moved_vector,
    vector_rate,
)
from threadstate.contact._range_kernel import UNIT, size_numbers

Array = NDArray[np.float64]

LARGEST_DEVIATION = 0.0625
"""Up to which bounds of log(1 + epsilon) are derived: farther from coaxial nothing is claimed."""

ROUND_OFF_FACTOR = 64.0
"""More than the sum of the factors by which errors of epsilon enter the third derivative."""


@kernel()
def logarithm_bounds(deviation: float, tilt: float, mu: float) -> tuple[float, float, float, float]:
    """Bounds on the first four derivatives of log(1 + epsilon) by azimuth, from those of its two parts.

    ``mu`` bounds |r'| / r.
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
def third_derivatives(deviation: complex, tilt: complex, mu: float) -> tuple[float, float]:
    """Of |w| / r and of the azimuth of w, the former with what r' adds, from the two parts of epsilon.

    ``mu`` is r' / r.
    """
    # The derivatives of exp(-i theta) / r: r' is constant.
    d1 = deviation * complex(-mu, -1.0)
    d2 = deviation * complex(2.0 * mu * mu - 1.0, 2.0 * mu)
    d3 = deviation * complex(3.0 * mu - 6.0 * mu**3, 1.0 - 6.0 * mu * mu)
    inverse = 1.0 / (1.0 + deviation + tilt)
    e1 = inverse * (d1 - 2.0j * tilt)
    e2 = inverse * (d2 - 4.0 * tilt)
    e3 = inverse * (d3 + 8.0j * tilt)
    l1, l2, l3 = e1, e2 - e1 * e1, e3 - 3.0 * e1 * e2 + 2.0 * e1 * e1 * e1
    u1, u2, u3 = l1.real, l2.real, l3.real
    return abs(1.0 + deviation + tilt) * (u3 + 3.0 * u2 * u1 + u1**3 + 3.0 * mu * (u2 + u1 * u1)), l3.imag


@kernel()
def rate_bound(c: Numbers, v: Numbers, radius: float, inverse_r: float, f1: float, k: float) -> float:
    """A bound on the derivative of phi_thetathetatheta by time.

    ``c`` bounds the first three derivatives of the position by azimuth, ``v`` the rates of the position and of these.
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
) -> tuple[bool, bool]:
    """Whether phi_thetathetatheta keeps its sign from ``contact`` over ``way`` (rad) at all times of a span.

    Where phi = phi_theta = 0 at the contact at all times there is no second place with phi = phi_theta = 0 then. False
    also where either profile is not straight there. Then whether the span's length is most of what leaves it undecided.

    One bound whose terms share their factors, in the order of the certificate's derivation (docs/certificate.md).
    """
    k, r_bound, _, _, _, base_error, error_by_time, _ = size_numbers(motion, curve_profile, solid_profile)
    theta, a = contact + 0.5 * way, 0.5 * abs(way) * (1.0 + 4.0 * UNIT) + 8.0 * UNIT
    tau, b = 0.5 * (start + end), 0.5 * (end - start) + 4.0 * UNIT * abs(end)
    error = base_error + error_by_time * abs(tau)
    curve = profile_numbers(curve_profile)
    r, slope, u, rises = radius_and_slope(-k * theta, curve)
    low, high = second_derivative_range(u, abs(k) * a + error, rises, curve)
    if not (low == 0.0 and high == 0.0):
        return False, False
    r1 = -k * slope
    r_low = r - abs(r1) * a - error

    x_axis, y_axis, origin, rest = motion_numbers(motion)
    turning = rest[0]
    by_sine, by_versine, d_sine, d_versine = motion_coefficients(tau, turning)
    m1 = moved_vector(x_axis, by_sine, by_versine)
    m2 = moved_vector(y_axis, by_sine, by_versine)
    o = moved_vector(origin, by_sine, by_versine)
    speed_o = vector_rate(origin, d_sine, d_versine)
    p = linear_combination(m1, m2, math.cos(theta), math.sin(theta))
    q = linear_combination(m2, m1, math.cos(theta), -math.sin(theta))
    speed = math.sqrt(speed_o[0] * speed_o[0] + speed_o[1] * speed_o[1] + speed_o[2] * speed_o[2])

    # How far from coaxial: in the middle, and bounds over the box.
    a_ = complex(0.5 * (m1[0] + m2[1]), 0.5 * (m1[1] - m2[0]))
    e_ = cmath.exp(complex(0.0, -theta)) / a_
    deviation = complex(o[0], o[1]) * e_ / r
    tilt = complex(0.5 * (m1[0] - m2[1]), 0.5 * (m1[1] + m2[0])) * (e_ * e_ * a_)
    least_a = abs(a_) - turning * b
    sine = math.sqrt(m1[2] * m1[2] + m2[2] * m2[2]) + turning * b + error / r
    farthest = (math.hypot(o[0], o[1]) + speed * b + error) / (least_a * r_low)
    tilted = sine * sine
    if not (least_a > 0.75 and farthest + tilted < LARGEST_DEVIATION):
        return False, False
    mu = abs(r1) / r_low
    l1, l2, l3, l4 = logarithm_bounds(farthest, tilted, mu)
    e3 = l3 + 3.0 * l1 * l2 + l1**3
    e4 = l4 + 4.0 * l1 * l3 + 3.0 * l2 * l2 + 6.0 * l1 * l1 * l2 + l1**4
    larger_r = (1.0 + farthest + tilted) * (r + abs(r1) * a)
    inverse_r = 1.0 / (least_a * (1.0 - farthest - tilted) * r_low)
    helix = 1.0 + abs(k) * inverse_r

    # The solid's flank.
    x, y, z = r * p[0] + o[0], r * p[1] + o[1], r * p[2] + o[2]
    solid = profile_numbers(solid_profile)
    _, f1, u, rises = radius_and_slope(z - k * math.atan2(y, x), solid)
    speed += turning * r_bound
    s_theta = sine * (r + abs(r1) * (1.0 + a)) + abs(k) * (1.0 + l1)
    low, high = second_derivative_range(u, s_theta * a + helix * (speed * b + 2.0 * error), rises, solid)
    if not (low == 0.0 and high == 0.0):
        return False, False

    radial, around = third_derivatives(deviation, tilt, r1 / r)
    third = abs(a_) * r * radial + f1 * (3.0 * r1 * p[2] + r * q[2] + k * around)
    fourth = larger_r * e4 + 4.0 * (1.0 + farthest + tilted) * abs(r1) * e3
    fourth += abs(f1) * (sine * (r + abs(r1) * (a + 4.0)) + abs(k) * l4)
    c = (r_bound + abs(r1), r_bound + 2.0 * abs(r1), r_bound + 3.0 * abs(r1))
    rate = rate_bound(c, (speed, turning * c[0], turning * c[1], turning * c[2]), larger_r, inverse_r, f1, k)
    round_off = UNIT * r_bound * (6.0 + 28.0 * abs(tau)) + error_by_time * abs(tau) + UNIT * 8.0 * speed
    round_off += UNIT * 8.0 * math.sqrt(origin[0] ** 2 + origin[1] ** 2 + origin[2] ** 2)
    certain = abs(third) - fourth * a - ROUND_OFF_FACTOR * (1.0 + abs(f1) * helix) * round_off
    return certain > rate * b, certain > 0.0 or rate * b > fourth * a
