"""Edges whose g and phi are taken of sums of two doubles: for what round-off hides (docs/certificate.md, section 6)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact import _branchless_kernel as branchless
from threadstate.contact._beside_kernel import BESIDE, K_G, K_PHI, nearest_contact
from threadstate.contact._box_kernel import X_CLASS, X_DEEPEST, X_HALF, X_THETA, box_times, set_class, with_value
from threadstate.contact._curve_point_kernel import CurvePoint, GPoint, PhiPoint
from threadstate.contact._double_double_kernel import (
    Pair,
    add,
    azimuth,
    divide,
    multiply,
    scale,
    sine_cosine,
    sine_versine,
    square_root,
    subtract,
)
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._frame_kernel import motion_numbers
from threadstate.contact._geometry_kernel import M_COPLANAR, M_KIND, M_ROUNDED, M_SIGMA
from threadstate.contact._range_kernel import UNIT, Ranges, error_beside, ranges_about, size_numbers
from threadstate.contact._wide_kernel import (
    MINUS_ONE,
    W_AXIS,
    W_POINT,
    ZERO,
    Vector,
    advance,
    arm_turned,
    cross,
    plus,
    product_sum,
    radius_and_slope,
    set_inverse_motion,
    set_nearest_motion,
    times,
    vector_at,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

REFINED_ERROR = 1e-7
"""The errors of g, phi and their derivatives then over those of doubles: more than what is left of an earlier contact's
residuals, and far more than what the sums round off."""

NOWHERE: Vector = (ZERO, ZERO, ZERO)


@kernel()
def set_refined_motions(wide: Array, bolt_motion: Array, nut_motion: Array, bolt_wide: Array, nut_wide: Array) -> None:
    """Sets both edges' motions in sums of two doubles from the bolt's: that is meant, and their numbers are rounded."""
    bolt_motion[M_ROUNDED] = nut_motion[M_ROUNDED] = 1.0
    set_nearest_motion(wide, bolt_wide)
    set_inverse_motion(bolt_wide, nut_wide)


@kernel(forceinline=True)
def is_refined(edge: Edge) -> bool:
    """Whether g and phi are taken of sums of two doubles where they are all but zero."""
    return edge.wide.shape[0] > 0


class Placement(NamedTuple):
    """The frame of an edge curve in a motion, as its column vectors, and its origin; then that from which g is taken.

    ``m1``, ``m2`` and ``origin`` are at the time, ``z1``, ``z2`` and ``height`` axial components, at the time or, of a
    motion about an axis in both planes, at the start. ``centre`` and ``axis`` are those of the motion.
    """

    m1: Vector
    m2: Vector
    origin: Vector
    z1: Pair
    z2: Pair
    height: Pair
    centre: Vector
    axis: Vector


@kernel()
def placement_at(tau: Pair, motion: Array, wide: Array) -> Placement:
    """The frame of an edge curve after a time."""
    m1 = (wide[0, 0], wide[0, 1]), (wide[3, 0], wide[3, 1]), (wide[6, 0], wide[6, 1])
    m2 = (wide[1, 0], wide[1, 1]), (wide[4, 0], wide[4, 1]), (wide[7, 0], wide[7, 1])
    origin, centre, axis = vector_at(wide, 9), vector_at(wide, W_POINT), vector_at(wide, W_AXIS)
    z1, z2, height = m1[2], m2[2], origin[2]
    if motion[M_KIND] != 0.0:
        sine, versine = sine_versine(tau)
        m1, m2 = arm_turned(axis, m1, sine, versine), arm_turned(axis, m2, sine, versine)
        origin = plus(centre, arm_turned(axis, plus(origin, times(centre, MINUS_ONE)), sine, versine))
    else:
        origin = plus(origin, times(axis, tau))
    if motion[M_COPLANAR] == 0.0:
        z1, z2, height = m1[2], m2[2], origin[2]
    return Placement(m1, m2, origin, z1, z2, height, centre, axis)


@kernel()
def rounded(v: Vector) -> tuple[float, float, float]:
    """A vector in doubles."""
    return v[0][0], v[1][0], v[2][0]


@kernel()
def components(v: Vector, rx: Pair, ry: Pair, k_r: Pair) -> Vector:
    """A vector's components along the solid's radius and azimuth, and the derivative of s along it."""
    azimuthal = subtract(multiply(v[1], rx), multiply(v[0], ry))
    return product_sum(v[0], rx, v[1], ry), azimuthal, subtract(v[2], multiply(k_r, azimuthal))


@kernel()
def refined_points(theta: float, a: float, place: Placement, edge: Edge) -> tuple[CurvePoint, PhiPoint, GPoint]:
    """The edge curve, phi and g at azimuth theta, rounded to doubles, and the range of r'' over +- ``a``.

    The equations are those of ``_curve_point_kernel``.
    """
    motion, solid, curve = edge.motion, edge.solid, edge.curve
    k = advance(curve)
    sin, cos = sine_cosine((theta, 0.0))
    r, rise = radius_and_slope(multiply((-theta, 0.0), k), curve)
    dr = scale(multiply(k, rise), -1.0)
    p = plus(times(place.m1, cos), times(place.m2, sin))
    q = plus(times(place.m2, cos), times(place.m1, scale(sin, -1.0)))
    x = plus(times(p, r), place.origin)
    t = plus(times(p, dr), times(q, r))
    if motion[M_KIND] != 0.0:
        v = cross(place.axis, plus(x, times(place.centre, MINUS_ONE)))
        w, at = cross(place.axis, t), cross(place.axis, v)
    else:
        v, w, at = place.axis, NOWHERE, NOWHERE
    numbers = branchless.profile_numbers(curve)
    _, slope, u, rises = branchless.radius_and_slope(-k[0] * theta, numbers)
    r2_low, r2_high = branchless.second_derivative_range(u, abs(k[0]) * a, rises, numbers)
    of_curve = CurvePoint(
        cos[0],
        sin[0],
        r[0],
        dr[0],
        r2_low * k[0] * k[0],
        r2_high * k[0] * k[0],
        abs(k[0]) * branchless.slope_change_limit(slope, u, abs(k[0]) * a, rises, numbers),
        place.m1[2][0],
        place.m2[2][0],
        place.origin[2][0],
        rounded(x),
        rounded(p),
        rounded(q),
        rounded(t),
        rounded(v),
        rounded(w),
        rounded(at),
    )
    return of_curve, refined_phi(r, dr, x, p, q, t, v, w, at, k, solid), refined_g(r, dr, cos, sin, v, w, place, motion)


@kernel()
def refined_phi(
    r: Pair,
    dr: Pair,
    x: Vector,
    p: Vector,
    q: Vector,
    t: Vector,
    v: Vector,
    w: Vector,
    at: Vector,
    k: Pair,
    solid: Array,
) -> PhiPoint:
    """Phi and its derivatives at a point of the edge curve."""
    radius = square_root(product_sum(x[0], x[0], x[1], x[1]))
    inverse = divide((1.0, 0.0), radius)
    rx, ry = multiply(x[0], inverse), multiply(x[1], inverse)
    k_r = multiply(k, inverse)
    k_rr = multiply(k_r, inverse)
    s = subtract(x[2], multiply(k, azimuth(x[0], x[1])))
    f, f1 = radius_and_slope(s, solid)
    _, _, u, rises = branchless.radius_and_slope(s[0], branchless.profile_numbers(solid))
    tr, tt, ts = components(t, rx, ry, k_r)
    vr, vt, vs = components(v, rx, ry, k_r)
    pr, pt, ps = components(p, rx, ry, k_r)
    qr, _, qs = components(q, rx, ry, k_r)
    wr, _, ws = components(w, rx, ry, k_r)
    ar, _, a_s = components(at, rx, ry, k_r)
    both = scale(multiply(k_rr, multiply(tr, tt)), 2.0)
    flat_s_tt = add(subtract(scale(multiply(dr, qs), 2.0), multiply(r, ps)), both)
    flat_tt = add(subtract(scale(multiply(dr, qr), 2.0), multiply(r, pr)), multiply(multiply(tt, tt), inverse))
    crossed = multiply(k_rr, add(multiply(tr, vt), multiply(tt, vr)))
    flat_tv = subtract(add(wr, multiply(multiply(tt, vt), inverse)), multiply(f1, add(ws, crossed)))
    twice = scale(multiply(k_rr, multiply(vr, vt)), 2.0)
    flat_vv = subtract(add(ar, multiply(multiply(vt, vt), inverse)), multiply(f1, add(a_s, twice)))
    return PhiPoint(
        radius[0],
        inverse[0],
        k_rr[0],
        f1[0],
        u,
        rises,
        (tr[0], tt[0], ts[0]),
        (vr[0], vt[0], vs[0]),
        (pr[0], pt[0], ps[0]),
        qr[0],
        ws[0],
        a_s[0],
        subtract(radius, f)[0],
        subtract(tr, multiply(f1, ts))[0],
        subtract(vr, multiply(f1, vs))[0],
        flat_s_tt[0],
        subtract(flat_tt, multiply(f1, flat_s_tt))[0],
        flat_tv[0],
        flat_vv[0],
    )


@kernel()
def refined_g(r: Pair, dr: Pair, cos: Pair, sin: Pair, v: Vector, w: Vector, place: Placement, motion: Array) -> GPoint:
    """G and its derivatives at a point of the edge curve."""
    sigma = motion[M_SIGMA]
    moving = 0.0 if motion[M_COPLANAR] != 0.0 else 1.0
    p = scale(product_sum(place.z1, cos, place.z2, sin), -sigma)
    q = scale(subtract(multiply(place.z2, cos), multiply(place.z1, sin)), -sigma)
    return GPoint(
        p[0],
        q[0],
        math.hypot(place.z1[0], place.z2[0]),
        subtract(multiply(r, p), scale(place.height, sigma))[0],
        product_sum(dr, p, r, q)[0],
        -sigma * v[2][0] * moving,
        subtract(scale(multiply(dr, q), 2.0), multiply(r, p))[0],
        -sigma * w[2][0] * moving * motion[M_KIND],
    )


class There(NamedTuple):
    """Phi and g at an azimuth of an edge at a time."""

    azimuth: float
    phi: float
    g: float


NOT_THERE = There(math.nan, math.nan, math.nan)


@kernel()
def there_beside(theta: float, place: Placement, edge: Edge) -> There:
    """Phi and g at the earlier contact that is the nearest to an azimuth; NaN where none is beside it."""
    gap, contact, _ = nearest_contact(theta, edge.kept)
    if not abs(gap) < BESIDE:
        return NOT_THERE
    _, phi, g = refined_points(contact, 0.0, place, edge)
    return There(contact, edge.motion[M_SIGMA] * phi.phi, g.value)


@kernel()
def differences(theta: float, phi: float, g: float, there: There, edge: Edge) -> tuple[float, float, float]:
    """Phi, g and the distance (rad) from the nearest earlier contact, where they are differences from it; else NaN."""
    gap, _, row = nearest_contact(theta, edge.kept)
    if not abs(gap) < BESIDE:
        return math.nan, math.nan, math.nan
    return (
        phi - there.phi if edge.kept[row, K_PHI] != 0.0 else math.nan,
        g - there.g if edge.kept[row, K_G] != 0.0 else math.nan,
        abs(gap),
    )


@kernel(contract=True, forceinline=True)
def with_rounding(of_one: Ranges) -> Ranges:
    """Ranges with what the rounding to doubles adds: 8 units of each quantity, of which their use rounds off less."""
    unit = 8.0 * UNIT
    tt = unit * max(abs(of_one.tt_low), abs(of_one.tt_high))
    theta, tau = unit * abs(of_one.by_theta), unit * abs(of_one.by_tau)
    return Ranges(
        of_one.value,
        of_one.by_theta,
        of_one.by_tau,
        of_one.tt_low - tt,
        of_one.tt_high + tt,
        of_one.tv,
        of_one.tv_var + unit * abs(of_one.tv),
        of_one.vv * (1.0 + unit),
        of_one.theta_low - theta,
        of_one.theta_high + theta,
        of_one.theta_change + theta,
        of_one.tau_change + tau,
        of_one.below * (1.0 + unit),
        of_one.above * (1.0 + unit),
        of_one.error + unit * abs(of_one.value),
        of_one.theta_error + theta,
        of_one.tau_error + tau,
    )


@kernel(contract=True, forceinline=True)
def refined_ranges(
    theta: float, a: float, tau: float, b: float, place: Placement, there: There, edge: Edge
) -> tuple[Ranges, Ranges, float]:
    """The ranges of phi and g over theta +- a, tau +- b, and the least depth, as ``_range_kernel.ranges`` has them.

    Beside an earlier contact phi and g are differences from it. ``place`` is that at tau, ``there`` what is
    :func:`there_beside` theta then.
    """
    _, _, _, rest = motion_numbers(edge.motion)
    sizes = size_numbers(edge.motion, edge.curve, edge.solid)
    of_curve, of_phi, of_g = refined_points(theta, a, place, edge)
    solid = branchless.profile_numbers(edge.solid)
    phi, g, depth = ranges_about(a, tau, b, rest, of_curve, of_phi, of_g, solid, sizes, REFINED_ERROR)
    phi_beside, g_beside, gap = differences(theta, phi.value, g.value, there, edge)
    error = REFINED_ERROR * error_beside(tau, sizes) * gap
    return with_rounding(with_value(phi, phi_beside, error)), with_rounding(with_value(g, g_beside, error)), depth


@kernel(contract=True)
def classify_refined(count: int, least: float, narrow: float, deepest: float, edge: Edge, boxes: Array) -> None:
    """Sets the classes of boxes from ranges about their middles that are taken of sums of two doubles.

    Of those above the class ``least`` that are no wider than ``narrow`` (half-width, rad), or in which no point is as
    deep as ``deepest``. What one box and the next have in common is computed once: they are often parts of one.
    """
    at = math.nan
    place = placement_at(ZERO, edge.motion, edge.wide)
    there = NOT_THERE
    for i in range(count):
        theta, a = boxes[X_THETA + i], boxes[X_HALF + i]
        is_close = 0.0 < a <= narrow or 0.0 < boxes[X_DEEPEST + i] < deepest
        if not (boxes[X_CLASS + i] > least and is_close):
            continue
        tau, b = box_times(i, boxes)
        _, contact, _ = nearest_contact(theta, edge.kept)
        if tau != at:
            place = placement_at((tau, 0.0), edge.motion, edge.wide)
        if tau != at or contact != there.azimuth:
            there = there_beside(theta, place, edge)
        at = tau
        phi, g, depth = refined_ranges(theta, a, tau, b, place, there, edge)
        set_class(i, a, b, phi, g, depth, edge.solid[pk.P], boxes)
