"""Thread on thread by branch and bound: every tangency of the two helical surfaces along a motion, as a proof.

A rectangle of the bolt's thread (theta, z) is excluded when at every time up to the limit it is wholly outside the nut,
or wholly inside (an overlap that is open already), or A or B cannot vanish in it (``_tangency_kernel`` defines them):
each by its first-order expansion plus a bound on the second derivatives. Otherwise it is split; small rectangles are
handed to Newton's method.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._bound_kernel import (
    B_CURVE_DERIVATIVE,
    B_LEAST_RADIUS,
    B_LIPSCHITZ,
    B_OFFSET,
    B_OFFSET_RATE,
    B_SECOND_DERIVATIVE,
    BOUNDS_SIZE,
    set_bounds,
    sine_of_tilt,
)
from threadstate.contact._branchless_kernel import larger, larger_or_nan
from threadstate.contact._edge_search_kernel import OVERFLOW
from threadstate.contact._entry_kernel import NEVER, THREAD, entry_time, half_space
from threadstate.contact._geometry_kernel import (
    M_KIND,
    PATH_SIZE,
    TWO_PI,
    phi_and_gradient,
    position,
    set_path_from,
    turn_vector,
    velocity,
)
from threadstate.contact._tangency_kernel import PLACEMENT_SIZE, T_TIME, TANGENCY_JET_SIZE, newton_tangency
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

MAX_RECTANGLES = 4000
MAX_RECTANGLE_STEPS = 120
MAX_EVALUATIONS = 200_000

# A rectangle of the bolt's thread: middle and half-widths.
R_THETA = 0
R_Z = 1
R_HALF_THETA = 2
R_HALF_Z = 3
RECTANGLE_SIZE = 4

AZIMUTHS = 24
NEWTON_HALF_THETA = 0.03
LEAST_HALF_THETA = 2e-3

RECT_UNDECIDED, RECT_EXCLUDED, ABOVE_SURFACE = range(3)


@kernel()
def classify_rectangle(
    rect: Array, limit: float, motion: Array, bolt: Array, nut: Array, bounds: Array, path: Array
) -> int:
    """The class of a rectangle up to ``limit``: RECT_UNDECIDED, RECT_EXCLUDED or, all the time, ABOVE_SURFACE.

    One expansion whose terms share their factors: parts of it would pass two dozen numbers to each other.
    """
    is_turn = motion[M_KIND] != 0.0
    theta = rect[R_THETA]
    z = rect[R_Z]
    h = rect[R_HALF_THETA]
    hz = rect[R_HALF_Z]
    k = bolt[pk.LEAD] / TWO_PI
    cot = nut[pk.STEEPEST]
    c1 = bounds[B_CURVE_DERIVATIVE]
    largest_radius = bolt[pk.R_MAJOR]
    hs = hz + abs(k) * h
    r_b, slope_b, _ = pk.jet(z - k * theta, bolt)
    cosine = math.cos(theta)
    sine = math.sin(theta)
    set_path_from(r_b * cosine, r_b * sine, z, motion, path)
    tilt = sine_of_tilt(motion, bounds, limit)
    margin = tilt * c1 * h + hz * (1.0 + bolt[pk.STEEPEST] * tilt)
    start, stop = half_space(-path[2] + margin, -path[5], -path[8], is_turn)
    if start >= limit:
        return ABOVE_SURFACE
    end = min(stop, limit)
    tau = start
    bolt_f2_low, bolt_f2_high = pk.second_derivative_range(z - k * theta, hs, bolt)
    bolt_f2 = larger(bolt_f2_high, -bolt_f2_low)
    extent = c1 * h + hs * (1.0 + bolt[pk.STEEPEST])
    k_r = abs(k) / bounds[B_LEAST_RADIUS]
    curvature_factor = (cot * k_r * 2.0 + 1.0) / bounds[B_LEAST_RADIUS]
    v = path[9] + (extent if is_turn else 0.0)
    fastest = bounds[B_LIPSCHITZ] * v
    hx0, hy0, hz0 = -r_b * sine, r_b * cosine, k
    zx0, zy0, zz0 = slope_b * cosine, slope_b * sine, 1.0
    for _ in range(MAX_RECTANGLE_STEPS):
        x, y, zz = position(path, tau, is_turn)
        value, gx, gy, gz = phi_and_gradient(x, y, zz, nut, 1.0)
        hx, hy, hzz = turn_vector(hx0, hy0, hz0, motion, tau)
        ax, ay, az = turn_vector(zx0, zy0, zz0, motion, tau)
        a = gx * hx + gy * hy + gz * hzz
        b = gx * ax + gy * ay + gz * az
        vx, vy, vz = velocity(path, tau, is_turn)
        rate = gx * vx + gy * vy + gz * vz
        r2 = x * x + y * y
        r = math.sqrt(r2)
        r_low = larger(bounds[B_LEAST_RADIUS], r - extent)
        s_mid = zz - k * math.atan2(y, x)
        s_h0 = abs(hzz - k * (x * hy - y * hx) / r2)
        s_z0 = abs(az - k * (x * ay - y * ax) / r2)
        s_t0 = abs(vz - k * (x * vy - y * vx) / r2)
        transverse_speed0 = math.sqrt(vx * vx + vy * vy)
        span = 0.0
        outcome = RECT_UNDECIDED
        for attempt in range(4):
            # First the instant tau, then spans of time: all that is left, an eighth of it, a sixty-fourth.
            if attempt > 0:
                span = (end - tau) * (1.0, 0.125, 0.015625)[attempt - 1]
            t = sine_of_tilt(motion, bounds, tau + span)
            axis_distance_ratio = (
                bounds[B_OFFSET] + bounds[B_OFFSET_RATE] * (tau + span) + largest_radius * t * t + (z + hz) * t
            ) / r_low
            s_hh = t * largest_radius + (abs(k) / r_low) * axis_distance_ratio * largest_radius * 4.0
            s_hz = t * bolt[pk.STEEPEST] + (abs(k) / r_low) * axis_distance_ratio * (2.0 + bolt[pk.STEEPEST])
            turn_angle = span if is_turn else 0.0
            s_h = s_h0 + s_hh * h + s_hz * hs + c1 * turn_angle
            s_z = s_z0 + s_hz * h + t * bolt_f2 * hs + (1.0 + bolt[pk.STEEPEST]) * turn_angle
            s_t = s_t0 + (1.0 + k_r) * (v - path[9] + v * turn_angle)
            transverse_speed = transverse_speed0 + v - path[9] + v * turn_angle
            low, high = pk.second_derivative_range(s_mid, s_h * h + s_z * hs + s_t * span, nut)
            f2 = larger(high, -low)
            side = t * (1.0 + cot) * bolt_f2 + 4.0 * axis_distance_ratio
            phi_hh = f2 * s_h * s_h + cot * s_hh + axis_distance_ratio * largest_radius * 3.0
            phi_hz = f2 * s_h * s_z + cot * s_hz + 2.0 * axis_distance_ratio * (1.0 + bolt[pk.STEEPEST])
            phi_zz_high = bolt_f2_high - low * s_z * s_z + side
            minus_phi_zz_high = high * s_z * s_z - bolt_f2_low + side
            if attempt == 0:
                spread = abs(a) * h + abs(b) * hs + 0.5 * phi_hh * h * h + phi_hz * h * hs
                above = spread + 0.5 * larger(0.0, phi_zz_high) * hs * hs
                below = spread + 0.5 * larger(0.0, minus_phi_zz_high) * hs * hs
                clearance = -value - above
                if clearance <= 0.0:
                    clearance = value - below
                    rate = -rate
                if clearance > 0.0:
                    outcome = RECT_EXCLUDED
                continue
            turning = bounds[B_LIPSCHITZ] if is_turn else 0.0
            phi_ht = f2 * s_t * s_h + curvature_factor * transverse_speed * c1 + turning * c1
            phi_zt = f2 * s_t * s_z + (curvature_factor * transverse_speed + turning) * (1.0 + bolt[pk.STEEPEST])
            if outcome == RECT_EXCLUDED:
                phi_tt = f2 * s_t * s_t + curvature_factor * transverse_speed * v + turning * v
                if (rate + phi_ht * h + phi_zt * hs + 0.5 * phi_tt * span) * span <= clearance:
                    break
            elif abs(a) > phi_hh * h + phi_hz * hs + phi_ht * span or abs(b) > (
                phi_hz * h + larger_or_nan(phi_zz_high, minus_phi_zz_high) * hs + phi_zt * span
            ):
                break
            if attempt == 3:
                if outcome == RECT_UNDECIDED:
                    return RECT_UNDECIDED
                span = clearance / fastest
        if tau + span >= end:
            return RECT_EXCLUDED
        tau += span
    return RECT_UNDECIDED


@kernel()
def touch_time(rect: Array, limit: float, motion: Array, bolt: Array, nut: Array, bounds: Array, path: Array) -> float:
    """When the middle of a rectangle meets the nut's thread, a little beyond the limit at the most; else NEVER."""
    theta = rect[R_THETA]
    r = pk.radius(rect[R_Z] - bolt[pk.LEAD] / TWO_PI * theta, bolt)
    set_path_from(r * math.cos(theta), r * math.sin(theta), rect[R_Z], motion, path)
    tau, how = entry_time(
        path,
        motion[M_KIND] != 0.0,
        nut,
        1.0,
        0.0,
        2.0 * limit,
        bounds[B_LIPSCHITZ],
        bounds[B_SECOND_DERIVATIVE],
        bounds[B_LEAST_RADIUS],
    )
    return tau if how == THREAD else NEVER


@kernel()
def set_first_rectangles(
    limit: float, motion: Array, bolt: Array, nut: Array, bounds: Array, path: Array, rects: Array
) -> tuple[int, int]:
    """Sets the undecided rectangles that cover the thread, up to where it is above the surface; how many, and of how
    many.
    """
    p = bolt[pk.P]
    count, evaluated = 0, 0
    for i in range(AZIMUTHS):
        low = 0.0
        high = p / 32.0
        while low < p:
            r = rects[count]
            r[R_THETA] = TWO_PI * (i + 0.5) / AZIMUTHS
            r[R_HALF_THETA] = math.pi / AZIMUTHS
            r[R_Z] = 0.5 * (low + high)
            r[R_HALF_Z] = 0.5 * (high - low)
            outcome = classify_rectangle(r, limit, motion, bolt, nut, bounds, path)
            evaluated += 1
            if outcome == ABOVE_SURFACE:
                break
            if outcome == RECT_UNDECIDED:
                count += 1
            low = high
            high = min(2.0 * high, p)
    return count, evaluated


@kernel()
def tangencies(motion: Array, bolt: Array, nut: Array, limit: float, rects: Array, found: Array) -> tuple[int, int]:
    """All contacts of thread with thread before ``limit``, earliest first, and the number of rectangles evaluated.

    ``motion`` is the bolt's, seen from the nut.
    """
    bounds = scratch(BOUNDS_SIZE)
    path = scratch(PATH_SIZE)
    placement = scratch(PLACEMENT_SIZE)
    jet = scratch(TANGENCY_JET_SIZE)
    set_bounds(motion, bolt, nut, bounds)
    p = bolt[pk.P]
    count = 0
    best = limit
    depth, evaluated = set_first_rectangles(limit, motion, bolt, nut, bounds, path, rects)
    parent = scratch(RECTANGLE_SIZE)
    while depth > 0:
        depth -= 1
        for j in range(RECTANGLE_SIZE):
            parent[j] = rects[depth, j]
        split_theta = parent[R_HALF_THETA] > 40.0 / p * parent[R_HALF_Z]
        for side in (-1.0, 1.0):
            r = rects[depth]
            for j in range(RECTANGLE_SIZE):
                r[j] = parent[j]
            if split_theta:
                r[R_HALF_THETA] = 0.5 * parent[R_HALF_THETA]
                r[R_THETA] = parent[R_THETA] + side * r[R_HALF_THETA]
            else:
                r[R_HALF_Z] = 0.5 * parent[R_HALF_Z]
                r[R_Z] = parent[R_Z] + side * r[R_HALF_Z]
            evaluated += 1
            if classify_rectangle(r, best, motion, bolt, nut, bounds, path) != RECT_UNDECIDED:
                continue
            if r[R_HALF_THETA] < NEWTON_HALF_THETA:
                tau = touch_time(r, limit, motion, bolt, nut, bounds, path)
                if tau < NEVER:
                    count = newton_tangency(
                        r[R_THETA], r[R_Z], tau, limit, motion, bolt, nut, placement, jet, found, count
                    )
                if count > 0:
                    best = min(best, found[0, T_TIME])
            if r[R_HALF_THETA] < LEAST_HALF_THETA:
                continue
            depth += 1
            if depth + 2 >= MAX_RECTANGLES or evaluated > MAX_EVALUATIONS:
                return count, OVERFLOW
    return count, evaluated
