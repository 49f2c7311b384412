"""The edge curve and phi in the middle of a box of azimuth and time, with their derivatives.

Exact but for round-off; the names are those of ``_range_kernel``, which bounds what they are elsewhere in the box.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import (
    Numbers,
    azimuth,
    radius_and_slope,
    second_derivative_range,
    sine_cosine,
    slope_change_limit,
)
from threadstate.contact._frame_kernel import (
    cylindrical_components,
    linear_combination,
    motion_coefficients,
    moved_vector,
    vector_rate,
)

Vector = tuple[float, float, float]
"""In the solid's frame, or its radial and azimuthal components and that along its helical coordinate s."""


class CurvePoint(NamedTuple):
    """The edge curve in the middle of a box: its radius, frame and derivatives, in the solid's frame.

    ``r`` and ``dr`` are the radius and its derivative by theta, ``r2_low`` to ``r2_high`` the range of the second one
    over the box, ``dr_change`` a bound on how far ``dr`` changes there. ``m1z``, ``m2z`` and ``height`` are the axial
    components of the curve's x and y axes and of its origin. ``place`` is X, ``p`` and ``q`` are P and Q, ``t``, ``v``,
    ``w`` and ``a`` the derivatives of X by theta, tau, both, and tau twice.
    """

    cos_theta: float
    sin_theta: float
    r: float
    dr: float
    r2_low: float
    r2_high: float
    dr_change: float
    m1z: float
    m2z: float
    height: float
    place: Vector
    p: Vector
    q: Vector
    t: Vector
    v: Vector
    w: Vector
    a: Vector


class PhiPoint(NamedTuple):
    """Phi in the middle of a box, with what it is made of.

    ``inverse`` is 1 / r at ``radius`` r, ``k_rr`` is k / r^2, ``f1`` is f' at the profile's place ``u``, which rises
    there or not. ``t``, ``v`` and ``p`` are components of T, V and P; ``qr``, ``ws`` and ``a_s`` one each of Q, X_theta
    tau and X_tau tau. ``phi_t`` and ``phi_v`` are derivatives by theta and tau; the ``flat`` ones are second
    derivatives, of s by theta and of phi, without the terms of r'' and f''.
    """

    radius: float
    inverse: float
    k_rr: float
    f1: float
    u: float
    rises: bool
    t: Vector
    v: Vector
    p: Vector
    qr: float
    ws: float
    a_s: float
    phi: float
    phi_t: float
    phi_v: float
    flat_s_tt: float
    flat_tt: float
    flat_tv: float
    flat_vv: float


class GPoint(NamedTuple):
    """G in the middle of a box, with what it is made of.

    ``p`` and ``q`` are the components of P and Q along g, ``sine`` is that of the angle between the curve's plane and
    the solid's; ``by_theta`` and ``by_tau`` are derivatives, ``flat`` the second one by theta without the term of r'',
    ``by_both`` that by theta and tau.
    """

    p: float
    q: float
    sine: float
    value: float
    by_theta: float
    by_tau: float
    flat: float
    by_both: float


@kernel(contract=True, forceinline=True)
def curve_at(
    theta: float,
    a: float,
    tau: float,
    x_axis: Numbers,
    y_axis: Numbers,
    origin: Numbers,
    rest: Numbers,
    curve: Numbers,
    k: float,
) -> CurvePoint:
    """The edge curve at azimuth theta and time tau, and the range of r'' over theta +- ``a``; see :func:`ranges`."""
    turning, _, _, ax, ay, az = rest
    sin_theta, cos_theta = sine_cosine(theta)
    r, slope, u, rises = radius_and_slope(-k * theta, curve)
    dr = -k * slope
    r2_low, r2_high = second_derivative_range(u, abs(k) * a, rises, curve)
    r2_low *= k * k
    r2_high *= k * k
    dr_change = abs(k) * slope_change_limit(slope, u, abs(k) * a, rises, curve)
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
    v_ = (r * p_tau[0] + speed_o[0], r * p_tau[1] + speed_o[1], r * p_tau[2] + speed_o[2])
    return CurvePoint(
        cos_theta,
        sin_theta,
        r,
        dr,
        r2_low,
        r2_high,
        dr_change,
        m1[2],
        m2[2],
        place_o[2],
        (r * p_[0] + place_o[0], r * p_[1] + place_o[1], r * p_[2] + place_o[2]),
        p_,
        q_,
        (dr * p_[0] + r * q_[0], dr * p_[1] + r * q_[1], dr * p_[2] + r * q_[2]),
        v_,
        (dr * p_tau[0] + r * q_tau[0], dr * p_tau[1] + r * q_tau[1], dr * p_tau[2] + r * q_tau[2]),
        (
            (ay * v_[2] - az * v_[1]) * turning,
            (az * v_[0] - ax * v_[2]) * turning,
            (ax * v_[1] - ay * v_[0]) * turning,
        ),
    )


@kernel(contract=True, forceinline=True)
def phi_at(edge: CurvePoint, k: float, solid: Numbers) -> PhiPoint:
    """Phi in the middle of a box, and its derivatives there."""
    x, y, z = edge.place
    radius = math.sqrt(x * x + y * y)
    inverse = 1.0 / radius
    rx, ry = x * inverse, y * inverse
    k_r = k * inverse
    k_rr = k_r * inverse
    f, f1, u, rises = radius_and_slope(z - k * azimuth(x, y, radius), solid)
    tr, tt, ts = cylindrical_components(edge.t, rx, ry, k_r)
    vr, vt, vs = cylindrical_components(edge.v, rx, ry, k_r)
    pr, pt, ps = cylindrical_components(edge.p, rx, ry, k_r)
    qr, _, qs = cylindrical_components(edge.q, rx, ry, k_r)
    wr, _, ws = cylindrical_components(edge.w, rx, ry, k_r)
    ar, _, a_s = cylindrical_components(edge.a, rx, ry, k_r)
    flat_s_tt = -edge.r * ps + 2.0 * edge.dr * qs + 2.0 * k_rr * tr * tt
    return PhiPoint(
        radius,
        inverse,
        k_rr,
        f1,
        u,
        rises,
        (tr, tt, ts),
        (vr, vt, vs),
        (pr, pt, ps),
        qr,
        ws,
        a_s,
        radius - f,
        tr - f1 * ts,
        vr - f1 * vs,
        flat_s_tt,
        -edge.r * pr + 2.0 * edge.dr * qr + tt * tt * inverse - f1 * flat_s_tt,
        wr - f1 * ws + tt * vt * inverse - f1 * k_rr * (tr * vt + tt * vr),
        ar - f1 * a_s + vt * vt * inverse - 2.0 * f1 * k_rr * vr * vt,
    )


@kernel(contract=True, forceinline=True)
def g_at(edge: CurvePoint, x_axis: Numbers, y_axis: Numbers, origin: Numbers, rest: Numbers) -> GPoint:
    """G in the middle of a box, and its derivatives there.

    Where the axis lies in both planes its sign stays that of the start, whose value is used instead.
    """
    turning, sigma, moving = rest[0], rest[1], rest[2]
    r, dr = edge.r, edge.dr
    m1z = edge.m1z if moving > 0.0 else x_axis[2]
    m2z = edge.m2z if moving > 0.0 else y_axis[2]
    height = edge.height if moving > 0.0 else origin[2]
    p_g = -sigma * (m1z * edge.cos_theta + m2z * edge.sin_theta)
    q_g = -sigma * (m2z * edge.cos_theta - m1z * edge.sin_theta)
    return GPoint(
        p_g,
        q_g,
        math.sqrt(m1z * m1z + m2z * m2z),
        r * p_g - sigma * height,
        dr * p_g + r * q_g,
        -sigma * edge.v[2] * moving,
        2.0 * dr * q_g - r * p_g,
        -sigma * edge.w[2] * (turning * moving),
    )
