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
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import (
    Numbers,
    ProfileCourse,
    course_over,
    larger,
    larger_or_nan,
    second_derivative_range,
    smaller,
    smaller_or_nan,
)
from threadstate.contact._curve_point_kernel import CurvePoint, GPoint, PhiPoint, curve_at, g_at, phi_at
from threadstate.contact._geometry_kernel import M_KIND, M_OFF, M_POINT, M_ROUNDED, TWO_PI
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]


UNIT = 2.0**-53
"""The unit round-off of double precision."""

LARGEST_MISALIGNMENT = 0.5
"""Up to which the bounds that vanish with the misalignment are derived."""

OUTWARD = 1.0 + 2.0**-46
"""More than what rounds off in a bound that is a sum and in products of two of them."""

AXIAL_SHARE = 1.0 / 16.0
"""How much of a turn's speed counts as across the solid's axis, beyond what is; of a translation all of it. Of a point
that goes along the axis bounds would else be attained, which balls cannot confirm."""

GROWTH = 1.72
"""exp(x) <= 1 + GROWTH x for 0 <= x <= 1: it is more than e - 1."""


class Ranges(NamedTuple):
    """Of g or phi over a box: the value in its middle, and what bounds it elsewhere.

    ``by_theta`` and ``by_tau`` are its derivatives in the middle. ``tt_low`` to ``tt_high`` is the range of the second
    one by theta; ``tv`` is the mixed one in the middle, ``tv_var`` bounds its variation, ``vv`` the size of the second
    one by tau. ``theta_low`` to ``theta_high`` is the range of the derivative by theta, unbounded of g.
    ``theta_change`` and ``tau_change`` bound how far the derivatives by theta and tau change, infinite for g's by tau:
    at a corner, where second derivatives are large, these are what bounds the function. ``below`` and ``above`` bound
    how far the function is below and above its linear expansion, infinite of g. ``error``, ``theta_error`` and
    ``tau_error`` bound the round-off of the value and of its two derivatives; that of all else is a part of the bounds.
    """

    value: float
    by_theta: float
    by_tau: float
    tt_low: float
    tt_high: float
    tv: float
    tv_var: float
    vv: float
    theta_low: float
    theta_high: float
    theta_change: float
    tau_change: float
    below: float
    above: float
    error: float
    theta_error: float
    tau_error: float


class Changes(NamedTuple):
    """Bounds over a box, from its middle on (docs/certificate.md, section 3).

    ``c1`` bounds T, ``r2`` the size of r'', ``speed`` V and ``across`` its part across the solid's axis; ``d_r1`` how
    far r' changes and ``c2_a`` how far T does in its own frame; ``sine`` bounds that of the angle between the axes;
    ``position_error`` and ``velocity_error`` round-off; ``move`` how far the point goes across the axis; ``inverse_r``
    is the largest 1 / r, ``k_r`` and ``helix`` the absolute k / r and one more; ``azimuth`` and ``directions`` how far
    the solid's and both parts' directions turn, ``by_time`` the latter by time alone; ``d_t`` how far T changes, and
    ``d_v`` how far V does across the axis, both in the cylindrical directions, and ``d_v_space`` how far all of V does.
    ``w_across`` is the part of X_theta tau across the axis in the middle, ``d_w_across`` and ``d_w_axial`` are how far
    that and the axial one change.
    """

    c1: float
    r2: float
    speed: float
    across: float
    d_r1: float
    c2_a: float
    sine: float
    position_error: float
    velocity_error: float
    move: float
    inverse_r: float
    k_r: float
    helix: float
    azimuth: float
    directions: float
    by_time: float
    d_t: float
    d_v: float
    w_across: float
    d_w_across: float
    d_w_axial: float
    d_v_space: float


class Alignment(NamedTuple):
    """Whether two parts are so nearly coaxial that the :func:`third_derivative_bounds` hold, and these."""

    aligned: bool
    radial_3: float
    helical_3: float
    factor_r: float
    factor_s: float


class Bends(NamedTuple):
    """Bounds of second derivatives of phi by theta, by theta and tau, and by tau."""

    tt: float
    tv: float
    vv: float


class Helix(NamedTuple):
    """The helical coordinate s and the solid's profile f over a box (docs/certificate.md, section 5).

    ``d_s_theta`` is how far s_T changes, ``s_theta_low``, ``s_theta_high`` and ``s_tau_high`` bounds on the sizes of
    s_T and s_V; ``f2_low`` to ``f2_high`` is the range of f'', ``f2`` bounds its size, ``d_f1`` how far f' changes,
    ``steep`` the size of f' and ``gradient`` that of grad phi; ``course`` is what f does within reach, f' no more than
    f'' allows.
    """

    d_s_theta: float
    s_theta_low: float
    s_theta_high: float
    s_tau_high: float
    f2_low: float
    f2_high: float
    f2: float
    d_f1: float
    steep: float
    gradient: float
    course: ProfileCourse


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
    unit = UNIT * (1.0 + motion[M_ROUNDED])
    arm = math.sqrt(dx * dx + dy * dy + dz * dz)
    return (
        k,
        r,
        r1,
        solid_profile[pk.STEEPEST],
        solid_profile[pk.R_MINOR],
        unit * (24.0 * r + 64.0 * r1 + 110.0 * abs(k) + 8.0 * offset),
        unit * (20.0 * r + 17.0 * arm) if turning != 0.0 else 4.0 * unit,
        unit * 8.0 * arm * turning,
    )


@kernel(contract=True, forceinline=True)
def error_beside(tau: float, sizes: Numbers) -> float:
    """The error of g and phi as differences from a contact, per rad of distance (docs/certificate.md, section 6)."""
    k, r, r1, cot, r_minor, base_error, error_by_time, _ = sizes
    time = abs(tau)
    c1 = math.sqrt(r * r + r1 * r1)
    way = UNIT * (16.0 * r + 96.0 * r1 + 16.0 * (1.0 + time) * c1)
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
def changes_over(
    a: float, b: float, tau: float, rest: Numbers, edge: CurvePoint, middle: PhiPoint, sizes: Numbers
) -> Changes:
    """How far position, directions and speed of the curve, and the solid's directions, change over a box at most."""
    k, r_bound, r1_bound, _, r_minor, base_error, error_by_time, rate_error = sizes
    turning, _, _, ax, ay, az = rest
    upright, level = turning * abs(az), turning * math.sqrt(ax * ax + ay * ay)
    v_, w_ = edge.v, edge.w
    c1 = math.sqrt(r_bound * r_bound + r1_bound * r1_bound)
    r2_bound = larger(edge.r2_high, -edge.r2_low)
    speed = math.sqrt(v_[0] * v_[0] + v_[1] * v_[1] + v_[2] * v_[2])
    speed_bound = speed + turning * c1 * a
    # Over a corner r' changes by no more than it can as a whole, however large r'' is there.
    d_r1 = smaller(r2_bound * a, edge.dr_change)
    position_error = base_error + error_by_time * abs(tau)
    error = turning * position_error
    sine = smaller(math.sqrt(edge.m1z * edge.m1z + edge.m2z * edge.m2z) + turning * b, 1.0)
    path = c1 * a + speed_bound * b
    d_across = upright * path + level * (sine * c1 * a + speed_bound * b) + error + turning * rate_error
    across = math.sqrt(v_[0] * v_[0] + v_[1] * v_[1])
    across_bound = across + d_across + (AXIAL_SHARE * speed_bound if turning > 0.0 else speed_bound)
    move = c1 * a + across_bound * b + 2.0 * position_error
    r_low = larger(0.5 * r_minor, middle.radius - move)
    inverse_r = 1.0 / r_low
    k_r_bound = abs(k) * inverse_r
    azimuth_change = move * inverse_r
    direction_change = a + turning * b + azimuth_change
    change_by_time = b * (turning + across_bound * inverse_r)
    c2_a = d_r1 + (r_bound + 2.0 * r1_bound) * a
    d_t = c1 * direction_change + d_r1 + r1_bound * a
    # How far T changes in space, and the part across the solid's axis of its cross product with the turn's.
    d_t_space = c2_a + turning * c1 * b
    d_w_across = upright * d_t_space + level * (sine * c2_a + level * c1 * b) + error
    v_error = turning * (position_error + rate_error) + 2.0 * position_error * speed_bound * inverse_r
    return Changes(
        c1,
        r2_bound,
        speed_bound,
        across_bound,
        d_r1,
        c2_a,
        sine,
        position_error,
        v_error,
        move,
        inverse_r,
        k_r_bound,
        1.0 + k_r_bound,
        azimuth_change,
        direction_change,
        change_by_time,
        d_t,
        d_across + across * azimuth_change,
        abs(w_[0]) + abs(w_[1]),
        d_w_across,
        level * d_t_space + error,
        speed_bound * direction_change + speed_bound - speed,
    )


@kernel(contract=True, forceinline=True)
def near_alignment(a: float, middle: PhiPoint, change: Changes, sizes: Numbers) -> Alignment:
    """What bounds third derivatives where both parts are nearly coaxial."""
    r_bound, r1_bound = sizes[1], sizes[2]
    inverse_r, sine = change.inverse_r, change.sine
    # P_t, Q_r, 1 - T_t / r grow by azimuth at a rate in proportion to themselves (Gronwall).
    rate = 1.0 + inverse_r * (change.r2 + (1.0 + 0.5 * LARGEST_MISALIGNMENT) * r_bound + 2.0 * r1_bound)
    misaligned = larger(abs(middle.p[1]), abs(middle.qr)) + abs(1.0 - middle.t[1] * middle.inverse)
    misaligned = misaligned + 8.0 * change.position_error * inverse_r
    misaligned = (misaligned + sine * sine + change.by_time * (1.0 + 2.0 * change.c1 * inverse_r)) * (
        1.0 + GROWTH * rate * a
    )
    radial_3, helical_3, factor_r, factor_s = third_derivative_bounds(
        misaligned, sine, change.r2, r_bound, r1_bound, inverse_r, change.k_r
    )
    aligned = rate * a < 1.0 and misaligned < LARGEST_MISALIGNMENT
    return Alignment(aligned, radial_3, helical_3, factor_r, factor_s)


@kernel(contract=True, forceinline=True)
def helix_over(
    a: float,
    b: float,
    turning: float,
    middle: PhiPoint,
    change: Changes,
    near: Alignment,
    sizes: Numbers,
    solid: Numbers,
) -> Helix:
    """The helical coordinate of the curve, and with it f' and f'', over a box."""
    r_bound, r1_bound, cot = sizes[1], sizes[2], sizes[3]
    _, _, ts = middle.t
    _, _, vs = middle.v
    _, _, ps = middle.p
    c1, r2_bound, inverse_r, k_r_bound, helix = change.c1, change.r2, change.inverse_r, change.k_r, change.helix
    s_tt = helix * ((r_bound + 2.0 * r1_bound + r2_bound) * change.directions + r1_bound * a + 2.0 * change.d_r1) + (
        2.0 * k_r_bound * inverse_r * c1 * (change.d_t + c1 * change.azimuth)
    )
    near_s_tt = (near.helical_3 + r2_bound * near.factor_s) * a + (
        helix * (r_bound + 2.0 * r1_bound + r2_bound) + 2.0 * k_r_bound * inverse_r * c1 * c1
    ) * change.by_time
    s_tt = abs(middle.flat_s_tt) + r2_bound * abs(ps) + (smaller(near_s_tt, s_tt) if near.aligned else s_tt)
    s_tv = turning * c1 * helix + k_r_bound * c1 * change.speed * inverse_r
    s_vv = turning * change.speed * helix + k_r_bound * change.speed * change.speed * inverse_r
    s_error = change.position_error * (1.0 + c1 * inverse_r) * helix
    corner_change = (abs(ps) + helix * change.directions) * change.d_r1 + helix * (
        r1_bound * a + c1 * change.directions
    )
    d_s_theta = s_error + smaller(s_tt * a + s_tv * b, corner_change)
    s_theta_high = OUTWARD * (abs(ts) + d_s_theta)
    d_s_tau = s_tv * a + s_vv * b + helix * change.velocity_error
    s_tau_high = OUTWARD * (abs(vs) + d_s_tau)
    # Integrals: what the slopes change by grows from 0 on the way.
    on_average = s_error + smaller(0.5 * (s_tt * a + s_tv * b), corner_change)
    reach = (abs(ts) + on_average) * a + (abs(vs) + 0.5 * (s_tv * a + s_vv * b) + helix * change.velocity_error) * b
    f2_low, f2_high = second_derivative_range(middle.u, reach, middle.rises, solid)
    f2 = larger(f2_high, -f2_low)
    farther = reach + helix * change.position_error
    course = course_over(middle.radius - middle.phi, middle.f1, middle.u, farther, middle.rises, solid)
    slope_high = smaller(course.slope_high, f2 * reach)
    slope_low = -smaller(-course.slope_low, f2 * reach)
    d_f1 = larger(slope_high, -slope_low)
    steep = smaller(abs(middle.f1) + d_f1, cot)
    return Helix(
        d_s_theta,
        larger(abs(ts) - d_s_theta, 0.0),
        s_theta_high,
        s_tau_high,
        f2_low,
        f2_high,
        f2,
        d_f1,
        steep,
        1.0 + steep * helix,
        ProfileCourse(slope_low, slope_high, course.low, course.high),
    )


@kernel(contract=True, forceinline=True)
def variations(
    a: float,
    b: float,
    turning: float,
    middle: PhiPoint,
    change: Changes,
    near: Alignment,
    over: Helix,
    sizes: Numbers,
) -> tuple[Bends, Bends]:
    """By how much the second derivatives of phi, without the terms of r'' and f'', vary over a box; first with f' held
    at its value in the middle.

    Each is of a radial part less f' times a helical one.
    """
    r_bound, r1_bound = sizes[1], sizes[2]
    tr, tt, _ = middle.t
    vr, vt, _ = middle.v
    c1, inverse_r, k_r_bound, across, helix = change.c1, change.inverse_r, change.k_r, change.across, change.helix
    d_t, d_v, slope, steep = change.d_t, change.d_v, abs(middle.f1), over.steep
    radius_change = smaller(((abs(tr) + d_t) * a + (abs(vr) + d_v) * b) * inverse_r, change.azimuth)
    frame = (r_bound + 2.0 * r1_bound) * change.directions + r1_bound * a + 2.0 * change.d_r1
    squared = inverse_r * (c1 * d_t + c1 * c1 * radius_change)
    by_time = inverse_r * c1 * c1
    tt_r, tt_s = frame + squared + inverse_r * c1 * d_t, helix * frame + 2.0 * k_r_bound * squared
    near_r = near.radial_3 * a + (r_bound + 2.0 * r1_bound + 2.0 * by_time) * change.by_time
    near_s = near.helical_3 * a + (helix * (r_bound + 2.0 * r1_bound) + 2.0 * k_r_bound * by_time) * change.by_time
    smooth_tt = tt_r + slope * tt_s
    whole_tt = tt_r + steep * tt_s
    smooth_tt = smaller(near_r + slope * near_s, smooth_tt) if near.aligned else smooth_tt
    whole_tt = smaller(near_r + steep * near_s, whole_tt) if near.aligned else whole_tt
    turned = change.d_w_across + change.w_across * change.azimuth
    mixed = inverse_r * (c1 * d_v + across * d_t + c1 * across * radius_change)
    tv_r = turned + mixed
    tv_s = k_r_bound * (turned + radius_change * change.w_across + 2.0 * mixed) + change.d_w_axial
    turned = turning * change.d_v_space
    mixed = inverse_r * (2.0 * across * d_v + across * across * radius_change)
    vv_r = turned + mixed
    vv_s = helix * turned + 2.0 * k_r_bound * mixed
    arm = 1.0 + c1 * inverse_r
    tt_error = 4.0 * over.gradient * change.position_error * arm * arm
    tv_error = 4.0 * over.gradient * change.velocity_error * arm
    vv_error = 4.0 * over.gradient * change.velocity_error * (turning + change.speed * inverse_r)
    return (
        Bends(smooth_tt + tt_error, tv_r + slope * tv_s + tv_error, vv_r + slope * vv_s + vv_error),
        Bends(
            whole_tt + over.d_f1 * abs(middle.flat_s_tt) + tt_error,
            tv_r + steep * tv_s + over.d_f1 * (abs(middle.ws) + middle.k_rr * abs(tr * vt + tt * vr)) + tv_error,
            vv_r + steep * vv_s + over.d_f1 * (abs(middle.a_s) + 2.0 * middle.k_rr * abs(vr * vt)) + vv_error,
        ),
    )


@kernel(contract=True, forceinline=True)
def product_range(low: float, high: float, other_low: float, other_high: float) -> tuple[float, float]:
    """The smallest and the largest product of two factors within these ranges; NaN of NaN."""
    return (
        smaller_or_nan(
            smaller_or_nan(high * other_high, high * other_low), smaller_or_nan(low * other_high, low * other_low)
        ),
        larger_or_nan(
            larger_or_nan(high * other_high, high * other_low), larger_or_nan(low * other_high, low * other_low)
        ),
    )


@kernel(contract=True, forceinline=True)
def factor_of_r2(a: float, middle: PhiPoint, change: Changes, near: Alignment, over: Helix) -> tuple[float, float]:
    """What r'' is multiplied by in phi_thetatheta, grad phi . P, in the middle; and how far it varies, with f' held at
    its value in the middle.
    """
    pr, _, ps = middle.p
    near_along = (near.factor_r + over.steep * near.factor_s) * a + over.gradient * change.by_time
    var_along = over.gradient * change.directions
    return pr - middle.f1 * ps, (smaller(near_along, var_along) if near.aligned else var_along)


@kernel(contract=True, forceinline=True)
def smooth_part(
    a: float,
    b: float,
    middle: PhiPoint,
    change: Changes,
    along: float,
    var_along: float,
    varied: Bends,
) -> tuple[float, float, float]:
    """Of phi with the profile's tangent for the profile: how far it is from its linear expansion, and how far its
    derivatives by theta and tau change (B, B_theta and B_tau of docs/certificate.md, section 3).
    """
    tt, tv, vv = abs(middle.flat_tt) + varied.tt, abs(middle.flat_tv) + varied.tv, abs(middle.flat_vv) + varied.vv
    bend = (
        0.5 * tt * a * a
        + (abs(along) * smaller(0.5 * change.r2 * a, change.d_r1) + var_along * 0.5 * change.r2 * a) * a
        + tv * a * b
        + 0.5 * vv * b * b
    )
    return bend, tt * a + abs(along) * change.d_r1 + var_along * change.r2 * a + tv * b, tv * a + vv * b


@kernel(contract=True, forceinline=True)
def phi_ranges(
    a: float,
    b: float,
    sigma: float,
    edge: CurvePoint,
    middle: PhiPoint,
    change: Changes,
    near: Alignment,
    over: Helix,
    smooth: Bends,
    varied: Bends,
    profile_error: float,
) -> Ranges:
    """The ranges of phi; ``smooth`` and ``varied`` are the :func:`variations`, ``profile_error`` the round-off of the
    course.
    """
    var_tt, var_tv, var_vv = varied
    _, _, ts = middle.t
    _, _, vs = middle.v
    r2_low, r2_high, gradient_bound = edge.r2_low, edge.r2_high, over.gradient
    s_theta_low, s_theta_high, s_tau_high = over.s_theta_low, over.s_theta_high, over.s_tau_high
    f2_low, f2_high, f2 = over.f2_low, over.f2_high, over.f2
    # The terms of r'' and f'': r'' times grad phi . P, less f'' s_U s_V.
    along, var_smooth = factor_of_r2(a, middle, change, near, over)
    var_along = var_smooth + over.d_f1 * abs(middle.p[2])
    bend_low, bend_high = product_range(r2_low, r2_high, along - var_along, along + var_along)
    rounded = 32.0 * UNIT * (larger(bend_high, -bend_low) + f2 * s_theta_high * s_theta_high + var_tt)
    tt_high = middle.flat_tt + var_tt + bend_high + rounded
    tt_low = middle.flat_tt - var_tt + bend_low - rounded
    tt_high -= f2_low * (s_theta_high * s_theta_high if f2_low < 0.0 else s_theta_low * s_theta_low)
    tt_low -= f2_high * (s_theta_high * s_theta_high if f2_high > 0.0 else s_theta_low * s_theta_low)
    tv_mid = middle.flat_tv - 0.5 * (f2_low + f2_high) * ts * vs
    tv_var = var_tv + 0.5 * (f2_high - f2_low) * abs(ts * vs) + f2 * (s_theta_high * s_tau_high - abs(ts * vs))
    vv = abs(middle.flat_vv) + var_vv + f2 * s_tau_high * s_tau_high
    bend, theta_smooth, tau_smooth = smooth_part(a, b, middle, change, along, var_smooth, smooth)
    above, below = bend + profile_error - over.course.low, bend + profile_error + over.course.high
    # What f' differs by from its value in the middle, times s_theta.
    s_low, s_high = ts - over.d_s_theta, ts + over.d_s_theta
    profile_low, profile_high = product_range(over.course.slope_low, over.course.slope_high, s_low, s_high)
    outward = sigma > 0.0
    theta_error = gradient_bound * (1.0 + 2.0 * change.c1 * change.inverse_r) * change.position_error
    tau_error = gradient_bound * change.velocity_error
    theta_low = middle.phi_t - profile_high - theta_smooth - theta_error
    theta_high = middle.phi_t - profile_low + theta_smooth + theta_error
    return Ranges(
        sigma * middle.phi,
        sigma * middle.phi_t,
        sigma * middle.phi_v,
        tt_low if outward else -tt_high,
        tt_high if outward else -tt_low,
        sigma * tv_mid,
        tv_var,
        vv,
        theta_low if outward else -theta_high,
        theta_high if outward else -theta_low,
        theta_smooth + over.d_f1 * s_theta_high + theta_error,
        tau_smooth + over.d_f1 * s_tau_high + tau_error,
        below if outward else above,
        above if outward else below,
        gradient_bound * change.position_error,
        theta_error,
        tau_error,
    )


@kernel(contract=True, forceinline=True)
def known_by_radius(phi: Ranges, sigma: float, radius: float, move: float, r_minor: float) -> Ranges:
    """The ranges of phi, or those that the radius alone gives where the curve comes near the solid's axis.

    There phi bends without bound, but its sign is known.
    """
    near_axis = radius - move < 0.5 * r_minor
    depth_there = r_minor - radius - move
    unknown = 0.0 if depth_there > 0.0 else math.inf
    return Ranges(
        (-sigma * depth_there if depth_there > 0.0 else 0.0) if near_axis else phi.value,
        0.0 if near_axis else phi.by_theta,
        0.0 if near_axis else phi.by_tau,
        -unknown if near_axis else phi.tt_low,
        unknown if near_axis else phi.tt_high,
        0.0 if near_axis else phi.tv,
        0.0 if near_axis else phi.tv_var,
        0.0 if near_axis else phi.vv,
        -unknown if near_axis else phi.theta_low,
        unknown if near_axis else phi.theta_high,
        unknown if near_axis else phi.theta_change,
        0.0 if near_axis else phi.tau_change,
        unknown if near_axis else phi.below,
        unknown if near_axis else phi.above,
        0.0 if near_axis else phi.error,
        0.0 if near_axis else phi.theta_error,
        0.0 if near_axis else phi.tau_error,
    )


@kernel(contract=True, forceinline=True)
def g_ranges(
    a: float,
    b: float,
    turning: float,
    moving: float,
    edge: CurvePoint,
    g: GPoint,
    change: Changes,
    sizes: Numbers,
    precision: float,
) -> Ranges:
    """The ranges of g, as :func:`ranges` has them."""
    r_bound, r1_bound, rate_error = sizes[1], sizes[2], sizes[7] * precision
    r2_low, r2_high = edge.r2_low, edge.r2_high
    position_error, d_r1, c1, r2_bound = change.position_error, change.d_r1, change.c1, change.r2
    turning_moving = turning * moving
    sine_g = smaller(g.sine + turning_moving * b, 1.0)
    tilting = sine_g * a + turning_moving * b
    var_g = sine_g * (a * (r_bound + 3.0 * r1_bound) + 2.0 * r2_bound * a) + turning_moving * b * (
        r_bound + 2.0 * r1_bound
    )
    var_g += r2_bound * (tilting + 32.0 * UNIT) + 4.0 * position_error
    g_tau_error = turning_moving * (position_error + rate_error)
    return Ranges(
        g.value,
        g.by_theta,
        g.by_tau,
        g.flat - var_g + (r2_low if g.p > 0.0 else r2_high) * g.p,
        g.flat + var_g + (r2_high if g.p > 0.0 else r2_low) * g.p,
        g.by_both,
        turning_moving * (change.c2_a + c1 * b + 4.0 * position_error),
        turning_moving * (abs(edge.a[2]) + c1 * a + change.speed * b + 4.0 * (position_error + rate_error)),
        -math.inf,
        math.inf,
        d_r1 * (abs(g.p) + tilting) + r1_bound * sine_g * a + c1 * tilting + position_error,
        math.inf,
        math.inf,
        math.inf,
        position_error,
        position_error,
        g_tau_error,
    )


@kernel(contract=True, forceinline=True)
def with_errors(change: Changes, factor: float) -> Changes:
    """The same changes with so many times the round-off."""
    return Changes(
        change.c1,
        change.r2,
        change.speed,
        change.across,
        change.d_r1,
        change.c2_a,
        change.sine,
        change.position_error * factor,
        change.velocity_error * factor,
        change.move,
        change.inverse_r,
        change.k_r,
        change.helix,
        change.azimuth,
        change.directions,
        change.by_time,
        change.d_t,
        change.d_v,
        change.w_across,
        change.d_w_across,
        change.d_w_axial,
        change.d_v_space,
    )


@kernel(contract=True, forceinline=True)
def ranges_about(
    a: float,
    tau: float,
    b: float,
    rest: Numbers,
    edge: CurvePoint,
    middle: PhiPoint,
    of_g: GPoint,
    solid: Numbers,
    sizes: Numbers,
    precision: float,
) -> tuple[Ranges, Ranges, float]:
    """As :func:`ranges`, about what is known of the middle, with ``precision`` times the round-off of doubles."""
    turning, sigma, moving = rest[0], rest[1], rest[2]
    change = changes_over(a, b, tau, rest, edge, middle, sizes)
    near = near_alignment(a, middle, change, sizes)
    rounded = with_errors(change, precision)
    over = helix_over(a, b, turning, middle, rounded, near, sizes, solid)
    smooth, varied = variations(a, b, turning, middle, rounded, near, over, sizes)
    phi = phi_ranges(a, b, sigma, edge, middle, rounded, near, over, smooth, varied, 2.0 * change.position_error)
    phi = known_by_radius(phi, sigma, middle.radius, change.move, sizes[4])
    g = g_ranges(a, b, turning, moving, edge, of_g, rounded, sizes, precision)
    sag = change.c2_a * a + turning * (change.c1 * a + change.speed * b) * b + change.position_error * (1.0 + a + b)
    return phi, g, -sigma * edge.place[2] - abs(edge.t[2]) * a - abs(edge.v[2]) * b - sag


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
) -> tuple[Ranges, Ranges, float]:
    """The ranges of phi and g over theta +- a, tau +- b, and the least depth below the solid's plane.

    ``x_axis`` to ``rest`` are the :func:`motion_numbers`, ``curve`` and ``solid`` the :func:`profile_numbers`,
    ``sizes`` the :func:`size_numbers`.
    """
    edge = curve_at(theta, a, tau, x_axis, y_axis, origin, rest, curve, sizes[0])
    middle = phi_at(edge, sizes[0], solid)
    of_g = g_at(edge, x_axis, y_axis, origin, rest)
    return ranges_about(a, tau, b, rest, edge, middle, of_g, solid, sizes, 1.0)
