"""Onsets of overlap along one part's edge curve: their place and time by root finding.

An onset is where a new arc of the edge curve enters the other solid (``_box_kernel`` gives the equations).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._beside_kernel import BESIDE, nearest_contact, values_beside
from threadstate.contact._box_kernel import ONE_EDGE, ONE_THREAD
from threadstate.contact._branchless_kernel import profile_numbers, second_derivative_range
from threadstate.contact._edge_kernel import Box, Edge
from threadstate.contact._geometry_kernel import (
    M_COPLANAR,
    M_KIND,
    M_SIGMA,
    TWO_PI,
    motion_scale,
    place_by_time,
    position,
    set_path,
    turn_vector,
    velocity,
)
from threadstate.contact._range_kernel import size_numbers
from threadstate.contact._refined_edge_kernel import (
    REFINED_ERROR,
    differences,
    is_refined,
    placement_at,
    refined_points,
    there_beside,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# A candidate contact: time, kind (ONE_EDGE, ONE_THREAD or ONE_PLANE), azimuth on the edge curve, azimuth on the solid,
# point in the solid's frame.
C_TIME, C_KIND, C_THETA, C_OTHER_THETA, C_X, C_Y, C_Z = range(7)
CANDIDATE_SIZE = 7
MAX_CANDIDATES = 16

STALLS = 4
"""After so many steps that were not half as long as the one before Newton's method has come to round-off."""

TIME_SLACK = 1e-13
"""How far beside a box in time, in units of ``motion_scale``, a root still counts as in it."""

# A jet: g, phi and their derivatives by theta and tau; their second derivatives by theta twice and by theta and tau;
# the position of the edge point.
J_G, J_G_THETA, J_G_TAU, J_PHI, J_PHI_THETA, J_PHI_TAU = range(6)
J_G_THETA_THETA, J_G_THETA_TAU, J_PHI_THETA_THETA, J_PHI_THETA_TAU, J_X, J_Y, J_Z = range(6, 13)
JET_SIZE = 13


NO_ROOT, ROOT_INSIDE, ROOT_BESIDE, ROOT_AT_SIDE = range(4)
"""Where Newton's method ends: at no root, in the box, certainly beside it, beside it by less than its round-off."""


@kernel()
def set_jet(
    theta: float, tau: float, motion: Array, curve_profile: Array, solid_profile: Array, path: Array, jet: Array
) -> None:
    """Sets g and phi, whose zeros are onsets, and their derivatives at one edge point and time."""
    is_turn = motion[M_KIND] != 0.0
    sigma = motion[M_SIGMA]
    k = curve_profile[pk.LEAD] / TWO_PI
    r, d1, d2 = pk.jet(-k * theta, curve_profile)
    c = math.cos(theta)
    s = math.sin(theta)
    dr = -k * d1
    ddr = k * k * d2
    cx, cy = dr * c - r * s, dr * s + r * c
    ccx, ccy = (ddr - r) * c - 2.0 * dr * s, (ddr - r) * s + 2.0 * dr * c
    set_path(r * c, r * s, motion, path)
    x, y, z = position(path, tau, is_turn)
    tx, ty, tz = turn_vector(cx, cy, 0.0, motion, tau)
    bx, by, bz = turn_vector(ccx, ccy, 0.0, motion, tau)
    vx, vy, vz = velocity(path, tau, is_turn)
    wx, wy, wz = 0.0, 0.0, 0.0
    if is_turn:
        ax, ay, az = motion[16], motion[17], motion[18]
        wx, wy, wz = ay * tz - az * ty, az * tx - ax * tz, ax * ty - ay * tx
    rr = math.sqrt(x * x + y * y)
    f, f1, f2 = pk.jet(z - k * math.atan2(y, x), solid_profile)
    ex, ey = x / rr, y / rr
    kr = k / rr
    tr, tt = tx * ex + ty * ey, ty * ex - tx * ey
    vr, vt = vx * ex + vy * ey, vy * ex - vx * ey
    br, bt = bx * ex + by * ey, by * ex - bx * ey
    wr, wt = wx * ex + wy * ey, wy * ex - wx * ey
    ts, vs, bs, ws = tz - kr * tt, vz - kr * vt, bz - kr * bt, wz - kr * wt
    jet[J_PHI] = sigma * (rr - f)
    jet[J_PHI_THETA] = sigma * (tr - f1 * ts)
    jet[J_PHI_TAU] = sigma * (vr - f1 * vs)
    jet[J_PHI_THETA_THETA] = sigma * (br - f1 * bs + tt * tt / rr - f2 * ts * ts - 2.0 * f1 * kr / rr * tr * tt)
    jet[J_PHI_THETA_TAU] = sigma * (wr - f1 * ws + tt * vt / rr - f2 * ts * vs - f1 * kr / rr * (tr * vt + tt * vr))
    jet[J_X] = x
    jet[J_Y] = y
    jet[J_Z] = z
    if motion[M_COPLANAR] != 0.0:
        jet[J_G] = -sigma * (path[2] + path[5])
        jet[J_G_THETA] = -sigma * (motion[6] * cx + motion[7] * cy)
        jet[J_G_THETA_THETA] = -sigma * (motion[6] * ccx + motion[7] * ccy)
        jet[J_G_TAU] = 0.0
        jet[J_G_THETA_TAU] = 0.0
        return
    jet[J_G] = -sigma * z
    jet[J_G_THETA] = -sigma * tz
    jet[J_G_TAU] = -sigma * vz
    jet[J_G_THETA_THETA] = -sigma * bz
    jet[J_G_THETA_TAU] = -sigma * wz


@kernel()
def set_refined_jet(theta: float, tau: float, edge: Edge, jet: Array) -> None:
    """Sets a jet of a refined edge; beside earlier contacts g and phi are differences from them."""
    sigma = edge.motion[M_SIGMA]
    place = placement_at((tau, 0.0), edge.motion, edge.wide)
    of_curve, of_phi, of_g = refined_points(theta, 0.0, place, edge)
    there = there_beside(theta, place, edge)
    phi, g, _ = differences(theta, sigma * of_phi.phi, of_g.value, there, edge)
    r2 = 0.5 * (of_curve.r2_low + of_curve.r2_high)
    f2_low, f2_high = second_derivative_range(of_phi.u, 0.0, of_phi.rises, profile_numbers(edge.solid))
    f2 = 0.5 * (f2_low + f2_high)
    ts, vs = of_phi.t[2], of_phi.v[2]
    jet[J_G] = of_g.value if math.isnan(g) else g
    jet[J_PHI] = sigma * of_phi.phi if math.isnan(phi) else phi
    jet[J_G_THETA], jet[J_G_TAU] = of_g.by_theta, of_g.by_tau
    jet[J_PHI_THETA], jet[J_PHI_TAU] = sigma * of_phi.phi_t, sigma * of_phi.phi_v
    jet[J_G_THETA_THETA], jet[J_G_THETA_TAU] = of_g.flat + r2 * of_g.p, of_g.by_both
    jet[J_PHI_THETA_THETA] = sigma * (of_phi.flat_tt + r2 * (of_phi.p[0] - of_phi.f1 * of_phi.p[2]) - f2 * ts * ts)
    jet[J_PHI_THETA_TAU] = sigma * (of_phi.flat_tv - f2 * ts * vs)
    jet[J_X], jet[J_Y], jet[J_Z] = of_curve.place


@kernel()
def set_jet_beside(theta: float, tau: float, edge: Edge, jet: Array) -> None:
    """The same; beside earlier contacts g and phi are differences from them."""
    if is_refined(edge):
        set_refined_jet(theta, tau, edge, jet)
        return
    set_jet(theta, tau, edge.motion, edge.curve, edge.solid, edge.path, jet)
    if edge.kept[0, 0] != 0.0:
        g, phi, _ = values_beside(theta, tau, edge)
        jet[J_G] = jet[J_G] if math.isnan(g) else g
        jet[J_PHI] = jet[J_PHI] if math.isnan(phi) else phi


@kernel()
def jet_errors(tau: float, edge: Edge) -> tuple[float, float]:
    """Bounds on the round-off of g and phi and of their derivatives by theta (docs/certificate.md, section 6)."""
    k, r, r1, cot, r_minor, base_error, error_by_time, _ = size_numbers(edge.motion, edge.curve, edge.solid)
    error = (1.0 + cot * (1.0 + abs(k) / r_minor)) * (base_error + error_by_time * abs(tau))
    error *= REFINED_ERROR if is_refined(edge) else 1.0
    return error, error * (1.0 + 2.0 * math.sqrt(r * r + r1 * r1) / r_minor)


@kernel()
def onset_step(
    kind: int, jet: Array, value_error: float, slope_error: float
) -> tuple[float, float, float, float, float]:
    """Newton's step to an onset of a kind of box: the determinant, the changes of azimuth and time, their errors.

    The errors are what those of values and of slopes make of the step.
    """
    if kind == ONE_EDGE:
        f0, a, b = jet[J_G], jet[J_G_THETA], jet[J_G_TAU]
        f1, c, d = jet[J_PHI], jet[J_PHI_THETA], jet[J_PHI_TAU]
    elif kind == ONE_THREAD:
        f0, a, b = jet[J_PHI], jet[J_PHI_THETA], jet[J_PHI_TAU]
        f1, c, d = jet[J_PHI_THETA], jet[J_PHI_THETA_THETA], jet[J_PHI_THETA_TAU]
    else:
        f0, a, b = jet[J_G], jet[J_G_THETA], jet[J_G_TAU]
        f1, c, d = jet[J_G_THETA], jet[J_G_THETA_THETA], jet[J_G_THETA_TAU]
    det = a * d - b * c
    second_error = value_error if kind == ONE_EDGE else slope_error
    t_error = (abs(b) * second_error + abs(d) * value_error) / abs(det)
    tau_error = (abs(c) * value_error + abs(a) * second_error) / abs(det)
    return det, (f1 * b - f0 * d) / det, (f0 * c - f1 * a) / det, t_error, tau_error


@kernel()
def newton_onset(kind: int, box: Box, edge: Edge, jet: Array) -> tuple[int, float, float]:
    """The one onset or end of overlap in a box, or near it, by Newton's method: where it is, its azimuth and time.

    ``kind`` is the class of the box: g = phi = 0, phi = phi_theta = 0 or g = g_theta = 0. Where steps to a
    tangency away from earlier contacts have become as small as what round-off makes of them the root is in the box if
    it is no farther outside than that.
    """
    theta, half, start, end = box
    value_error, slope_error = 0.0, 0.0
    if kind != ONE_EDGE and not abs(nearest_contact(theta, edge.kept)[0]) < BESIDE:
        value_error, slope_error = jet_errors(0.5 * (start + end), edge)
    t = theta
    tau = 0.5 * (start + end)
    span = 0.5 * (end - start)
    step = motion_scale(edge.motion, edge.curve)
    # On the way to an onset in a box that is short for its width the time may leave it.
    farthest = max(2.0 * span, half * step)
    before, t_error_before, stalls = math.inf, 0.0, 0
    for _ in range(40):
        set_jet_beside(t, tau, edge, jet)
        determinant, dt, dtau, t_error, tau_error = onset_step(kind, jet, value_error, slope_error)
        if determinant == 0.0:
            return NO_ROOT, t, tau
        t += dt
        tau += dtau
        size = abs(dt) / (1.0 + abs(t)) + abs(dtau) / (step + abs(tau))
        # At a junction of flank and fillet steps of round-off lead from the one side to the other.
        t_error = max(t_error, 0.5 * t_error_before)
        if abs(t - theta) > 2.0 * half + t_error or abs(tau - 0.5 * (start + end)) > farthest + tau_error:
            return NO_ROOT, t, tau
        stalls += 1 if size >= 0.5 * before else 0
        round_off = stalls >= STALLS and abs(dt) <= t_error and abs(dtau) <= tau_error
        if size <= 4e-16 or (size < 1e-11 and size >= 0.5 * before) or round_off:
            t_slack, tau_slack = 1e-13 + t_error, TIME_SLACK * step + tau_error
            if abs(t - theta) <= half * (1.0 + 1e-9) + t_slack and start - tau_slack <= tau <= end + tau_slack:
                return ROOT_INSIDE, t, tau
            errors = jet_errors(tau, edge)
            _, _, _, t_error, tau_error = onset_step(kind, jet, errors[0], errors[1])
            if abs(t - theta) > half + t_error or not start - tau_error <= tau <= end + tau_error:
                return ROOT_BESIDE, t, tau
            return ROOT_AT_SIDE, t, tau
        before, t_error_before = size, t_error
    return NO_ROOT, t, tau


class Candidate(NamedTuple):
    """A candidate contact: time, class of its box, azimuths on the curve and the solid, point in the solid's frame."""

    time: float
    kind: int
    theta: float
    other_theta: float
    x: float
    y: float
    z: float


@kernel()
def insert_candidate(one: Candidate, count: int, found: Array) -> int:
    """Inserts a candidate by time unless it is listed; a full list drops the latest. Returns the number listed."""
    near = 1e-9 * (abs(one.x) + abs(one.y))
    for i in range(count):
        apart = abs(found[i, C_X] - one.x) + abs(found[i, C_Y] - one.y) + abs(found[i, C_Z] - one.z)
        if found[i, C_KIND] == one.kind and apart < near:
            return count
    i, listed = place_by_time(one.time, count, found)
    if i < 0:
        return listed
    found[i, C_TIME], found[i, C_KIND] = one.time, one.kind
    found[i, C_THETA], found[i, C_OTHER_THETA] = one.theta, one.other_theta
    found[i, C_X], found[i, C_Y], found[i, C_Z] = one.x, one.y, one.z
    return listed


@kernel()
def rises(kind: int, jet: Array) -> bool:
    """Whether the peak of min(g, phi) rises through zero there: an onset, and not the end of an overlap."""
    if kind == ONE_EDGE:
        fall = jet[J_PHI_THETA] - jet[J_G_THETA]
        return (jet[J_G_TAU] * jet[J_PHI_THETA] - jet[J_PHI_TAU] * jet[J_G_THETA]) * fall > 0.0
    return jet[J_PHI_TAU] > 0.0 if kind == ONE_THREAD else jet[J_G_TAU] > 0.0
