"""Ranges of g and phi at edge points over a box of azimuth and time; docs/certificate.md derives every bound.

The edge point at azimuth theta is at time tau at depth g = -sigma z below the solid's plane and at depth phi inside its
thread. With X its position, T = X_theta, V = X_tau, (r, t, z) the solid's cylindrical directions at X, and P and Q the
radial and azimuthal directions of the curve's own frame,

    s_U = U_z - (k / r) U_t,    grad phi . U = U_r - f' s_U,
    phi_UV = grad phi . X_UV + U_t V_t / r - f'' s_U s_V - f' (k / r^2) (U_r V_t + U_t V_r)      (sigma = +1).

Values and derivatives are exact in the middle of the box, but for round-off, whose bound is a part of every range. The
second derivatives of the two profiles (r'' and f'') are bounded by their ranges over it, all others by bounds on the
next derivatives. Those vanish with the misalignment of the two parts, so that the ranges stay sharp for nearly coaxial
parts, whose g and phi nearly vanish too.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import (
    Numbers,
    azimuth,
    larger,
    radius_and_slope,
    second_derivative_range,
    sine_cosine,
    smaller,
)
from threadstate.contact._frame_kernel import (
    cylindrical_components,
    linear_combination,
    motion_coefficients,
    moved_vector,
    vector_rate,
)
from threadstate.contact._geometry_kernel import M_KIND, M_OFF, M_POINT, TWO_PI
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]


UNIT = 2.0**-53
"""The unit round-off of double precision."""

LARGEST_MISALIGNMENT = 0.25
"""Up to which the bounds that vanish with the misalignment are derived."""

GROWTH = 1.72
"""exp(x) <= 1 + GROWTH x for 0 <= x <= 1: it is more than e - 1."""


@kernel(contract=True, forceinline=True)
def size_numbers(motion: Array, curve_profile: Array, solid_profile: Array) -> Numbers:
    """Sizes that bounds are made of, and what bounds round-off (docs/certificate.md, section 6).

    k, the curve's largest radius and largest dr / dtheta, the solid's cot of the flank and least radius; then the bound
    on the round-off of a position at the start and how it grows by time, and how much more that of a velocity has.
    """
    turning = motion[M_KIND]
    k = curve_profile[pk.LEAD] / TWO_PI
    r = curve_profile[pk.R_MAJOR]
    r1 = abs(k) * curve_profile[pk.STEEPEST]
    ox, oy, oz = motion[M_OFF], motion[M_OFF + 1], motion[M_OFF + 2]
    dx, dy, dz = ox - motion[M_POINT], oy - motion[M_POINT + 1], oz - motion[M_POINT + 2]
    offset = math.sqrt(ox * ox + oy * oy + oz * oz)
    arm = math.sqrt(dx * dx + dy * dy + dz * dz)
    return (
        k,
        r,
        r1,
        solid_profile[pk.STEEPEST],
        solid_profile[pk.R_MINOR],
        UNIT * (24.0 * r + 64.0 * r1 + 110.0 * abs(k) + 8.0 * offset),
        UNIT * (20.0 * r + 17.0 * arm) if turning != 0.0 else 4.0 * UNIT,
        UNIT * 8.0 * arm * turning,
    )


@kernel(contract=True, forceinline=True)
def error_beside(tau: float, sizes: Numbers) -> float:
    """The error of g and phi as differences from a contact, per rad of distance (docs/certificate.md, section 6)."""
    k, r, r1, cot, r_minor, base_error, error_by_time, _ = sizes
    time = abs(tau)
    c1 = math.sqrt(r * r + r1 * r1)
    way = UNIT * (12.0 * r + 72.0 * r1 + 16.0 * (1.0 + time) * c1)
    turned = (16.0 * UNIT + 2.0 * (base_error + error_by_time * time) / r_minor) * c1
    return (1.0 + cot * (1.0 + abs(k) / r_minor)) * (way + turned)


@kernel(contract=True, forceinline=True)
def third_derivative_bounds(
    misaligned: float, sine: float, r2_bound: float, r_bound: float, slope: float, inverse_r: float, k_r_bound: float
) -> tuple[float, float, float, float]:
    """Bounds, which vanish with the misalignment, on the derivatives by azimuth of four quantities over a box.

    They are the radial part of phi_thetatheta and its helical part (which f' multiplies), both without the terms of r''
    and f'', and the two parts of the factor of r'' (docs/certificate.md, section 4). ``misaligned`` bounds the sum of
    the larger of P_t and Q_r, of T_t / r - 1 and of the square of ``sine``, which bounds the axial parts of P and Q.
    """
    turned = sine * sine
    more = 1.0 + misaligned
    radial_speed = inverse_r * (slope + r_bound * misaligned)
    turning = inverse_r * misaligned * (r2_bound + r_bound * (1.0 + 0.5 * misaligned) + 2.0 * slope)
    both = turned + 0.25 * misaligned * misaligned
    radial = (
        3.0 * slope * (misaligned * misaligned + 2.0 * more * turned)
        + r_bound * (misaligned * (1.0 + 3.0 * misaligned * more) + 3.0 * more * turned)
        + 2.0 * r2_bound * both
    )
    azimuthal = (
        slope * (misaligned * (1.0 + 2.0 * misaligned * more) + 6.0 * more * turned)
        + r_bound * (turned * (1.0 + 2.0 * more * more) + misaligned * (1.0 + 2.0 * misaligned))
        + 2.0 * (slope + r_bound * misaligned) * turning
        + 2.0 * r2_bound * misaligned
        + misaligned * (r_bound * (1.0 + 2.0 * misaligned) + 2.0 * slope) * radial_speed
    )
    helical = sine * (3.0 * slope + r_bound + 2.0 * r2_bound) + k_r_bound * azimuthal
    return radial, helical, both, sine + k_r_bound * misaligned * (1.0 + radial_speed)


@kernel(contract=True, forceinline=True)
def ranges(
    theta: float,
    a: float,
    tau: float,
    b: float,
    x_axis: Numbers,
    y_axis: Numbers,
    origin: Numbers,
    rest: Numbers,
    curve: Numbers,
    solid: Numbers,
    sizes: Numbers,
) -> tuple[Numbers, Numbers, float]:
    """The ranges of phi and g over theta +- a, tau +- b, and the least depth below the solid's plane.

    ``x_axis`` to ``rest`` are the :func:`motion_numbers`, ``curve`` and ``solid`` the :func:`profile_numbers`,
    ``sizes`` the :func:`size_numbers`. Of either function: its value in the middle, its derivatives there by theta and
    tau, bounds from below and above on the second derivative by theta, the mixed one (in the middle, and a bound on its
    variation), a bound on the size of the second by tau, and one on how far the derivative by theta changes, of phi
    also that by tau: at a corner, where second derivatives are large, these are what bounds the function. Then the
    bounds on the round-off of the value and of its two derivatives; those on all else are parts of the bounds.
    """
    turning, sigma, moving, ax, ay, az = rest
    k, r_bound, r1_bound, cot, r_minor, base_error, error_by_time, rate_error = sizes
    c1 = math.sqrt(r_bound * r_bound + r1_bound * r1_bound)
    # The edge curve: r, r', the range of r''.
    sin_theta, cos_theta = sine_cosine(theta)
    r, slope, u, curve_rises = radius_and_slope(-k * theta, curve)
    dr = -k * slope
    r2_low, r2_high = second_derivative_range(u, abs(k) * a, curve_rises, curve)
    r2_low *= k * k
    r2_high *= k * k
    r2_bound = larger(r2_high, -r2_low)
    # Where it is at tau, and its derivatives.
    by_sine, by_versine, d_sine, d_versine = motion_coefficients(tau, turning)
    m1, m2, place_o = (
        moved_vector(x_axis, by_sine, by_versine),
        moved_vector(y_axis, by_sine, by_versine),
        moved_vector(origin, by_sine, by_versine),
    )
    n1, n2, speed_o = (
        vector_rate(x_axis, d_sine, d_versine),
        vector_rate(y_axis, d_sine, d_versine),
        vector_rate(origin, d_sine, d_versine),
    )
    p_ = linear_combination(m1, m2, cos_theta, sin_theta)
    q_ = linear_combination(m2, m1, cos_theta, -sin_theta)
    p_tau = linear_combination(n1, n2, cos_theta, sin_theta)
    q_tau = linear_combination(n2, n1, cos_theta, -sin_theta)
    x, y, z = r * p_[0] + place_o[0], r * p_[1] + place_o[1], r * p_[2] + place_o[2]
    t_ = (dr * p_[0] + r * q_[0], dr * p_[1] + r * q_[1], dr * p_[2] + r * q_[2])
    v_ = (r * p_tau[0] + speed_o[0], r * p_tau[1] + speed_o[1], r * p_tau[2] + speed_o[2])
    w_ = (dr * p_tau[0] + r * q_tau[0], dr * p_tau[1] + r * q_tau[1], dr * p_tau[2] + r * q_tau[2])
    a_ = (
        (ay * v_[2] - az * v_[1]) * turning,
        (az * v_[0] - ax * v_[2]) * turning,
        (ax * v_[1] - ay * v_[0]) * turning,
    )
    # phi in the middle; its second derivatives without the terms of r'' and f''.
    radius = math.sqrt(x * x + y * y)
    inverse = 1.0 / radius
    rx, ry = x * inverse, y * inverse
    k_r = k * inverse
    k_rr = k_r * inverse
    f, f1, u, rises = radius_and_slope(z - k * azimuth(x, y, radius), solid)
    tr, tt, ts = cylindrical_components(t_, rx, ry, k_r)
    vr, vt, vs = cylindrical_components(v_, rx, ry, k_r)
    pr, pt, ps = cylindrical_components(p_, rx, ry, k_r)
    qr, _, qs = cylindrical_components(q_, rx, ry, k_r)
    wr, _, ws = cylindrical_components(w_, rx, ry, k_r)
    ar, _, a_s = cylindrical_components(a_, rx, ry, k_r)
    phi, phi_t, phi_v = radius - f, tr - f1 * ts, vr - f1 * vs
    flat_s_tt = -r * ps + 2.0 * dr * qs + 2.0 * k_rr * tr * tt
    flat_tt = -r * pr + 2.0 * dr * qr + tt * tt * inverse - f1 * flat_s_tt
    flat_tv = wr - f1 * ws + tt * vt * inverse - f1 * k_rr * (tr * vt + tt * vr)
    flat_vv = ar - f1 * a_s + vt * vt * inverse - 2.0 * f1 * k_rr * vr * vt
    # Bounds on the speed of the curve in the box, and on the change of its directions and of the solid's.
    speed = math.sqrt(v_[0] * v_[0] + v_[1] * v_[1] + v_[2] * v_[2])
    speed_bound = speed + turning * c1 * a
    # Over a corner r' changes by no more than it can as a whole, however large r'' is there.
    d_r1 = smaller(r2_bound * a, 2.0 * r1_bound)
    c2_a = d_r1 + (r_bound + 2.0 * r1_bound) * a
    position_error = base_error + error_by_time * abs(tau)
    move = c1 * a + speed_bound * b + 2.0 * position_error
    r_low = larger(radius - move, 0.5 * r_minor)
    inverse_r = 1.0 / r_low
    k_r_bound = abs(k) * inverse_r
    azimuth_change = move * inverse_r
    direction_change = a + turning * b + azimuth_change
    change_by_time = b * (turning + speed_bound * inverse_r)
    sine = smaller(math.sqrt(m1[2] * m1[2] + m2[2] * m2[2]) + turning * b, 1.0)
    # P_t, Q_r, 1 - T_t / r grow by azimuth at a rate in proportion to themselves (Gronwall).
    rate = 1.0 + inverse_r * (r2_bound + (1.0 + 0.5 * LARGEST_MISALIGNMENT) * r_bound + 2.0 * r1_bound)
    misaligned = larger(abs(pt), abs(qr)) + abs(1.0 - tt * inverse) + 8.0 * position_error * inverse_r
    misaligned = (misaligned + sine * sine + change_by_time * (1.0 + 2.0 * c1 * inverse_r)) * (1.0 + GROWTH * rate * a)
    aligned = rate * a < 1.0 and misaligned < LARGEST_MISALIGNMENT
    radial_3, helical_3, factor_r, factor_s = third_derivative_bounds(
        misaligned, sine, r2_bound, r_bound, r1_bound, inverse_r, k_r_bound
    )
    # The helical coordinate, and with it f' and f'', over the box.
    d_t = c1 * direction_change + d_r1 + r1_bound * a
    d_v = speed_bound * direction_change + speed_bound - speed
    helix = 1.0 + k_r_bound
    s_tt = helix * ((r_bound + 2.0 * r1_bound + r2_bound) * direction_change + r1_bound * a + 2.0 * d_r1) + (
        2.0 * k_r_bound * inverse_r * c1 * (d_t + c1 * azimuth_change)
    )
    near_s_tt = (helical_3 + r2_bound * factor_s) * a + (
        helix * (r_bound + 2.0 * r1_bound + r2_bound) + 2.0 * k_r_bound * inverse_r * c1 * c1
    ) * change_by_time
    s_tt = abs(flat_s_tt) + r2_bound * abs(ps) + (smaller(near_s_tt, s_tt) if aligned else s_tt)
    s_tv = turning * c1 * helix + k_r_bound * c1 * speed_bound * inverse_r
    s_vv = turning * speed_bound * helix + k_r_bound * speed_bound * speed_bound * inverse_r
    # Round-off: of the helical coordinate, of vectors along the curve, of velocities.
    s_error = position_error * (1.0 + c1 * inverse_r) * helix
    v_error = turning * (position_error + rate_error) + 2.0 * position_error * speed_bound * inverse_r
    d_s_theta = s_error + smaller(
        s_tt * a + s_tv * b,
        (abs(ps) + helix * direction_change) * d_r1 + helix * (r1_bound * a + c1 * direction_change),
    )
    s_theta_high = abs(ts) + d_s_theta
    d_s_tau = s_tv * a + s_vv * b + helix * v_error
    s_tau_high = abs(vs) + d_s_tau
    s_theta_low = larger(abs(ts) - d_s_theta, 0.0)
    reach = s_theta_high * a + s_tau_high * b
    f2_low, f2_high = second_derivative_range(u, reach, rises, solid)
    f2 = larger(f2_high, -f2_low)
    d_f1 = smaller(f2 * reach, 2.0 * cot)
    steep = smaller(abs(f1) + d_f1, cot)
    gradient_bound = 1.0 + steep * helix
    # Variation of the second derivatives without the terms of r'' and f''.
    radius_change = smaller(((abs(tr) + d_t) * a + (abs(vr) + d_v) * b) * inverse_r, azimuth_change)
    curvature_factor = inverse_r * (1.0 + 2.0 * steep * k_r_bound)
    tt_error = 4.0 * gradient_bound * position_error * (1.0 + c1 * inverse_r) ** 2
    var_tt = (
        gradient_bound * ((r_bound + 2.0 * r1_bound) * direction_change + r1_bound * a + 2.0 * d_r1)
        + inverse_r * (2.0 * c1 * d_t + c1 * c1 * radius_change)
        + 2.0 * steep * k_r_bound * inverse_r * (c1 * d_t + c1 * c1 * radius_change)
    )
    near_tt = (radial_3 + steep * helical_3) * a + (
        gradient_bound * (r_bound + 2.0 * r1_bound) + 2.0 * inverse_r * c1 * c1 * (1.0 + steep * k_r_bound)
    ) * change_by_time
    var_tt = (smaller(near_tt, var_tt) if aligned else var_tt) + d_f1 * abs(flat_s_tt) + tt_error
    var_tv = (
        gradient_bound * turning * (c1 * direction_change + c2_a)
        + curvature_factor * (c1 * d_v + speed_bound * d_t + c1 * speed_bound * radius_change)
        + d_f1 * (abs(ws) + k_rr * abs(tr * vt + tt * vr))
        + 4.0 * gradient_bound * (1.0 + c1 * inverse_r) * v_error
    )
    var_vv = (
        gradient_bound * turning * d_v
        + curvature_factor * (2.0 * speed_bound * d_v + speed_bound * speed_bound * radius_change)
        + d_f1 * (abs(a_s) + 2.0 * k_rr * abs(vr * vt))
        + 4.0 * gradient_bound * (turning + speed_bound * inverse_r) * v_error
    )
    # The terms of r'' and f'': r'' times grad phi . P, less f'' s_U s_V.
    along = pr - f1 * ps
    near_along = (factor_r + steep * factor_s) * a + gradient_bound * change_by_time
    var_along = gradient_bound * direction_change
    var_along = (smaller(near_along, var_along) if aligned else var_along) + d_f1 * abs(ps)
    along_high = along + var_along
    along_low = along - var_along
    bend_high = larger(
        larger(r2_high * along_high, r2_high * along_low), larger(r2_low * along_high, r2_low * along_low)
    )
    bend_low = smaller(
        smaller(r2_high * along_high, r2_high * along_low), smaller(r2_low * along_high, r2_low * along_low)
    )
    rounded = 32.0 * UNIT * (larger(bend_high, -bend_low) + f2 * s_theta_high * s_theta_high + var_tt)
    tt_high = flat_tt + var_tt + bend_high + rounded
    tt_low = flat_tt - var_tt + bend_low - rounded
    tt_high -= f2_low * (s_theta_high * s_theta_high if f2_low < 0.0 else s_theta_low * s_theta_low)
    tt_low -= f2_high * (s_theta_high * s_theta_high if f2_high > 0.0 else s_theta_low * s_theta_low)
    tv_mid = flat_tv - 0.5 * (f2_low + f2_high) * ts * vs
    tv_var = var_tv + 0.5 * (f2_high - f2_low) * abs(ts * vs) + f2 * (s_theta_high * s_tau_high - abs(ts * vs))
    vv = abs(flat_vv) + var_vv + f2 * s_tau_high * s_tau_high
    outward = sigma > 0.0
    theta_error = gradient_bound * (1.0 + 2.0 * c1 * inverse_r) * position_error
    tau_error = gradient_bound * v_error
    of_phi = (
        sigma * phi,
        sigma * phi_t,
        sigma * phi_v,
        tt_low if outward else -tt_high,
        tt_high if outward else -tt_low,
        sigma * tv_mid,
        tv_var,
        vv,
        d_t + d_f1 * s_theta_high + abs(f1) * d_s_theta + theta_error,
        d_v + d_f1 * s_tau_high + abs(f1) * d_s_tau + tau_error,
        gradient_bound * position_error,
        theta_error,
        tau_error,
    )
    # Where the curve comes near the solid's axis phi bends without bound, but its sign is known from the radius alone.
    near_axis = radius - move < 0.5 * r_minor
    depth_there = r_minor - radius - move
    unknown = 0.0 if depth_there > 0.0 else math.inf
    of_phi = (
        (-sigma * depth_there if depth_there > 0.0 else 0.0) if near_axis else of_phi[0],
        0.0 if near_axis else of_phi[1],
        0.0 if near_axis else of_phi[2],
        -unknown if near_axis else of_phi[3],
        unknown if near_axis else of_phi[4],
        0.0 if near_axis else of_phi[5],
        0.0 if near_axis else of_phi[6],
        0.0 if near_axis else of_phi[7],
        unknown if near_axis else of_phi[8],
        0.0 if near_axis else of_phi[9],
        0.0 if near_axis else of_phi[10],
        0.0 if near_axis else of_phi[11],
        0.0 if near_axis else of_phi[12],
    )
    # g; where the axis lies in both planes its sign stays that of the start, whose value is used instead.
    m1z = m1[2] if moving > 0.0 else x_axis[2]
    m2z = m2[2] if moving > 0.0 else y_axis[2]
    height = place_o[2] if moving > 0.0 else origin[2]
    turning_moving = turning * moving
    p_g = -sigma * (m1z * cos_theta + m2z * sin_theta)
    q_g = -sigma * (m2z * cos_theta - m1z * sin_theta)
    sine_g = smaller(math.sqrt(m1z * m1z + m2z * m2z) + turning_moving * b, 1.0)
    tilting = sine_g * a + turning_moving * b
    var_g = sine_g * (a * (r_bound + 3.0 * r1_bound) + 2.0 * r2_bound * a) + turning_moving * b * (
        r_bound + 2.0 * r1_bound
    )
    var_g += r2_bound * (tilting + 32.0 * UNIT) + 4.0 * position_error
    flat_g = 2.0 * dr * q_g - r * p_g
    g_tau_error = turning_moving * (position_error + rate_error)
    of_g = (
        r * p_g - sigma * height,
        dr * p_g + r * q_g,
        -sigma * v_[2] * moving,
        flat_g - var_g + (r2_low if p_g > 0.0 else r2_high) * p_g,
        flat_g + var_g + (r2_high if p_g > 0.0 else r2_low) * p_g,
        -sigma * w_[2] * turning_moving,
        turning_moving * (c2_a + c1 * b + 4.0 * position_error),
        turning_moving * (abs(a_[2]) + c1 * a + speed_bound * b + 4.0 * (position_error + rate_error)),
        d_r1 * (abs(p_g) + tilting) + r1_bound * sine_g * a + c1 * tilting + position_error,
        position_error,
        position_error,
        g_tau_error,
    )
    sag = c2_a * a + turning * (c1 * a + speed_bound * b) * b + position_error * (1.0 + a + b)
    return of_phi, of_g, -sigma * z - abs(t_[2]) * a - abs(v_[2]) * b - sag
