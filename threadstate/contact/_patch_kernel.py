"""Thread on thread: tangencies of the two helical surfaces along a motion.

The bolt's thread is parametrised by azimuth and axial position (theta, z), 0 <= z <= p, in the bolt's frame. With the
nut's phi along it, a tangency is a point with phi = 0 and both derivatives zero; it is a contact where phi has a
maximum. Moving along the bolt's helix (theta, z + k theta) keeps both profiles' positions nearly fixed, so that the
derivatives used are A (along the helix) and B (along the axis). A rectangle of (theta, z) is closed when
at every time up to the limit it is wholly outside the nut, or wholly inside (an overlap that is open already), or A or
B cannot vanish in it: each by its first-order expansion plus a bound on the second derivatives. Otherwise it is split;
small rectangles are handed to Newton's method on (phi, A, B) = 0.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from threadstate.contact._bound_kernel import (
    B_BEND,
    B_C1,
    B_DRIFT,
    B_LIPSCHITZ,
    B_OFFSET,
    B_R_LOW,
    BOUNDS_SIZE,
    MOST_STEPS,
    set_bounds,
    sine_of_tilt,
)
from threadstate.contact._entry_kernel import NEVER, THREAD, entry, half_space
from threadstate.contact._geometry_kernel import (
    M_COPLANAR,
    M_KIND,
    PATH_SIZE,
    TWO_PI,
    field,
    position,
    set_path_from,
    turn_vector,
    velocity,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

MAX_RECTANGLES = 4000
MOST_LOOKS = 200_000
OVERFLOW = -1

# A rectangle of the bolt's thread: middle and half-widths.
R_THETA = 0
R_Z = 1
R_HALF_THETA = 2
R_HALF_Z = 3
RECTANGLE_SIZE = 4

# A tangency: time, theta and z on the bolt, point in the nut's frame.
T_TIME = 0
T_THETA = 1
T_Z = 2
T_X = 3
T_Y = 4
T_POINT_Z = 5
TANGENCY_SIZE = 6
MAX_TANGENCIES = 8

AZIMUTHS = 24
SMALL_THETA = 0.03
SLICE = math.radians(1.5)
FOLLOW = math.radians(0.5)
TINY_THETA = 2e-3

OPEN, CLEAR, OUT = range(3)


@njit(cache=True, error_model="numpy")
def thread_point(theta: float, z: float, row: Array) -> tuple[float, float, float]:
    """Radius, slope and second derivative of the profile at (theta, z)."""
    return pk.jet(z - row[pk.P] / TWO_PI * theta, row)


@njit(cache=True, error_model="numpy")
def judge(rect: Array, limit: float, motion: Array, bolt: Array, nut: Array, bounds: Array, path: Array) -> int:
    """What a bound says of a rectangle before ``limit``."""
    is_turn = motion[M_KIND] != 0.0
    theta = rect[R_THETA]
    z = rect[R_Z]
    h = rect[R_HALF_THETA]
    hz = rect[R_HALF_Z]
    k = bolt[pk.P] / TWO_PI
    cot = nut[pk.COT]
    c1 = bounds[B_C1]
    big = bolt[pk.R_MAJOR]
    hs = hz + k * h
    r_b, slope_b, _ = thread_point(theta, z, bolt)
    cosine = math.cos(theta)
    sine = math.sin(theta)
    set_path_from(r_b * cosine, r_b * sine, z, motion, path)
    tilt = sine_of_tilt(motion, bounds, limit)
    pad = tilt * c1 * h + hz * (1.0 + bolt[pk.COT] * tilt)
    start, stop = half_space(-path[2] + pad, -path[5], -path[8], is_turn)
    if start >= limit:
        return OUT
    end = min(stop, limit)
    tau = start
    own_low, own_high = pk.bend_range(z - k * theta, hs, bolt)
    size_own = max(own_high, -own_low)
    extent = c1 * h + hs * (1.0 + bolt[pk.COT])
    k_r = k / bounds[B_R_LOW]
    place = (cot * k_r * 2.0 + 1.0) / bounds[B_R_LOW]
    v = path[9] + (extent if is_turn else 0.0)
    fastest = bounds[B_LIPSCHITZ] * v
    hx0, hy0, hz0 = -r_b * sine, r_b * cosine, k
    zx0, zy0, zz0 = slope_b * cosine, slope_b * sine, 1.0
    for _ in range(MOST_STEPS):
        x, y, zz = position(path, tau, is_turn)
        value, gx, gy, gz = field(x, y, zz, nut, 1.0)
        hx, hy, hzz = turn_vector(hx0, hy0, hz0, motion, tau)
        ax, ay, az = turn_vector(zx0, zy0, zz0, motion, tau)
        a = gx * hx + gy * hy + gz * hzz
        b = gx * ax + gy * ay + gz * az
        vx, vy, vz = velocity(path, tau, is_turn)
        rate = gx * vx + gy * vy + gz * vz
        r2 = x * x + y * y
        r = math.sqrt(r2)
        r_low = max(r - extent, bounds[B_R_LOW])
        s_mid = zz - k * math.atan2(y, x)
        s_h0 = abs(hzz - k * (x * hy - y * hx) / r2)
        s_z0 = abs(az - k * (x * ay - y * ax) / r2)
        s_t0 = abs(vz - k * (x * vy - y * vx) / r2)
        level0 = math.sqrt(vx * vx + vy * vy)
        span = 0.0
        verdict = OPEN
        for attempt in range(4):
            # First the instant tau, then spans of time: the whole rest, an eighth of it, a sixty-fourth.
            if attempt > 0:
                span = (end - tau) * (1.0, 0.125, 0.015625)[attempt - 1]
            t = sine_of_tilt(motion, bounds, tau + span)
            away = (bounds[B_OFFSET] + bounds[B_DRIFT] * (tau + span) + big * t * t + (z + hz) * t) / r_low
            s_hh = t * big + (k / r_low) * away * big * 4.0
            s_hz = t * bolt[pk.COT] + (k / r_low) * away * (2.0 + bolt[pk.COT])
            swing = span if is_turn else 0.0
            s_h = s_h0 + s_hh * h + s_hz * hs + c1 * swing
            s_z = s_z0 + s_hz * h + t * size_own * hs + (1.0 + bolt[pk.COT]) * swing
            s_t = s_t0 + (1.0 + k_r) * (v - path[9] + v * swing)
            level = level0 + v - path[9] + v * swing
            low, high = pk.bend_range(s_mid, s_h * h + s_z * hs + s_t * span, nut)
            f2 = max(high, -low)
            side = t * (1.0 + cot) * size_own + 4.0 * away
            bend_hh = f2 * s_h * s_h + cot * s_hh + away * big * 3.0
            bend_hz = f2 * s_h * s_z + cot * s_hz + 2.0 * away * (1.0 + bolt[pk.COT])
            up_zz = own_high - low * s_z * s_z + side
            down_zz = high * s_z * s_z - own_low + side
            if attempt == 0:
                spread = abs(a) * h + abs(b) * hs + 0.5 * bend_hh * h * h + bend_hz * h * hs
                above = spread + 0.5 * max(up_zz, 0.0) * hs * hs
                below = spread + 0.5 * max(down_zz, 0.0) * hs * hs
                room = -value - above
                if room <= 0.0:
                    room = value - below
                    rate = -rate
                if room > 0.0:
                    verdict = CLEAR
                continue
            turning = bounds[B_LIPSCHITZ] if is_turn else 0.0
            bend_ht = f2 * s_t * s_h + place * level * c1 + turning * c1
            bend_zt = f2 * s_t * s_z + (place * level + turning) * (1.0 + bolt[pk.COT])
            if verdict == CLEAR:
                bend_tt = f2 * s_t * s_t + place * level * v + turning * v
                if (rate + bend_ht * h + bend_zt * hs + 0.5 * bend_tt * span) * span <= room:
                    break
            elif abs(a) > bend_hh * h + bend_hz * hs + bend_ht * span or abs(b) > (
                bend_hz * h + max(up_zz, down_zz) * hs + bend_zt * span
            ):
                break
            if attempt == 3:
                if verdict == OPEN:
                    return OPEN
                span = room / fastest
        if tau + span >= end:
            return CLEAR
        tau += span
    return OPEN


@njit(cache=True, error_model="numpy")
def residual(
    theta: float, z: float, tau: float, motion: Array, bolt: Array, nut: Array, path: Array, out: Array
) -> None:
    """phi, A and B at (theta, z, tau), and the rate of phi."""
    is_turn = motion[M_KIND] != 0.0
    k = bolt[pk.P] / TWO_PI
    r, slope, _ = thread_point(theta, z, bolt)
    c = math.cos(theta)
    s = math.sin(theta)
    set_path_from(r * c, r * s, z, motion, path)
    x, y, zz = position(path, tau, is_turn)
    value, gx, gy, gz = field(x, y, zz, nut, 1.0)
    hx, hy, hz = turn_vector(-r * s, r * c, k, motion, tau)
    ax, ay, az = turn_vector(slope * c, slope * s, 1.0, motion, tau)
    vx, vy, vz = velocity(path, tau, is_turn)
    out[0] = value
    out[1] = gx * hx + gy * hy + gz * hz
    out[2] = gx * ax + gy * ay + gz * az
    out[3] = gx * vx + gy * vy + gz * vz
    out[4] = x
    out[5] = y
    out[6] = zz


@njit(cache=True, error_model="numpy")
def touch(rect: Array, limit: float, motion: Array, bolt: Array, nut: Array, bounds: Array, path: Array) -> float:
    """When the middle of a rectangle meets the nut's thread, a little beyond the limit at the most; else NEVER."""
    theta = rect[R_THETA]
    r, _, _ = thread_point(theta, rect[R_Z], bolt)
    set_path_from(r * math.cos(theta), r * math.sin(theta), rect[R_Z], motion, path)
    tau, how = entry(
        path,
        motion[M_KIND] != 0.0,
        motion[M_COPLANAR] != 0.0,
        nut,
        1.0,
        0.0,
        2.0 * limit,
        bounds[B_LIPSCHITZ],
        bounds[B_BEND],
        bounds[B_R_LOW],
    )
    return tau if how == THREAD else NEVER


@njit(cache=True, error_model="numpy")
def polish(
    rect: Array,
    tau: float,
    limit: float,
    motion: Array,
    bolt: Array,
    nut: Array,
    path: Array,
    found: Array,
    count: int,
) -> int:
    """Newton's method from the middle of a rectangle at ``tau``; adds the tangency if it is a contact.

    Steps in (u, z) with u along the helix; derivatives of A and B by central differences, which set the speed and not
    the result.
    """
    k = bolt[pk.P] / TWO_PI
    theta = rect[R_THETA]
    z = rect[R_Z]
    here = np.empty(7)
    there = np.empty(7)
    jac = np.empty((3, 3))
    residual(theta, z, tau, motion, bolt, nut, path, here)
    eps = (1e-6, 1e-6 * bolt[pk.P], 1e-6 * limit)
    converged = False
    for _ in range(30):
        for j in range(3):
            for sign in (1.0, -1.0):
                d = sign * eps[j]
                residual(
                    theta + (d if j == 0 else 0.0),
                    z + (k * d if j == 0 else (d if j == 1 else 0.0)),
                    tau + (d if j == 2 else 0.0),
                    motion,
                    bolt,
                    nut,
                    path,
                    there,
                )
                for i in range(3):
                    if sign > 0.0:
                        jac[i, j] = there[i]
                    else:
                        jac[i, j] = (jac[i, j] - there[i]) / (2.0 * eps[j])
        m00, m01, m02 = here[1], here[2], here[3]
        det = (
            m00 * (jac[1, 1] * jac[2, 2] - jac[1, 2] * jac[2, 1])
            - m01 * (jac[1, 0] * jac[2, 2] - jac[1, 2] * jac[2, 0])
            + m02 * (jac[1, 0] * jac[2, 1] - jac[1, 1] * jac[2, 0])
        )
        if det == 0.0:
            return count
        r0, r1, r2 = -here[0], -here[1], -here[2]
        du = (
            r0 * (jac[1, 1] * jac[2, 2] - jac[1, 2] * jac[2, 1])
            - m01 * (r1 * jac[2, 2] - jac[1, 2] * r2)
            + m02 * (r1 * jac[2, 1] - jac[1, 1] * r2)
        ) / det
        dz = (
            m00 * (r1 * jac[2, 2] - jac[1, 2] * r2)
            - r0 * (jac[1, 0] * jac[2, 2] - jac[1, 2] * jac[2, 0])
            + m02 * (jac[1, 0] * r2 - r1 * jac[2, 0])
        ) / det
        dt = (
            m00 * (jac[1, 1] * r2 - r1 * jac[2, 1])
            - m01 * (jac[1, 0] * r2 - r1 * jac[2, 0])
            + r0 * (jac[1, 0] * jac[2, 1] - jac[1, 1] * jac[2, 0])
        ) / det
        theta += du
        z += k * du + dz
        tau += dt
        if (
            abs(theta - rect[R_THETA]) > max(4.0 * SMALL_THETA, 2.0 * rect[R_HALF_THETA])
            or abs(z - rect[R_Z]) > 0.2 * bolt[pk.P]
        ):
            return count
        residual(theta, z, tau, motion, bolt, nut, path, here)
        if abs(du) < 1e-11 and abs(dz) < 1e-11 * bolt[pk.P] and abs(dt) < 1e-14 * (1.0 + abs(tau)):
            converged = True
            break
        if abs(here[0]) < 1e-17 and abs(du) < 1e-8 and abs(dz) < 1e-8 * bolt[pk.P]:
            converged = True
            break
    # Both parts are one thread pitch long.
    if (
        not converged
        or z < 0.0
        or z > bolt[pk.P]
        or here[6] > 0.0
        or here[6] < -bolt[pk.P]
        or tau <= 0.0
        or tau > limit
        or here[3] <= 0.0
    ):
        return count
    # A contact: phi has a maximum, i.e. the Hessian in (u, z) is negative definite.
    if not (jac[1, 0] < 0.0 and jac[1, 0] * jac[2, 1] - jac[1, 1] * jac[2, 0] > 0.0):
        return count
    for i in range(count):
        if abs(found[i, T_X] - here[4]) + abs(found[i, T_Y] - here[5]) < 1e-6 * bolt[pk.P]:
            return count
    if count == MAX_TANGENCIES:
        return count
    i = count
    while i > 0 and found[i - 1, T_TIME] > tau:
        found[i] = found[i - 1]
        i -= 1
    found[i, T_TIME] = tau
    found[i, T_THETA] = theta
    found[i, T_Z] = z
    found[i, T_X] = here[4]
    found[i, T_Y] = here[5]
    found[i, T_POINT_Z] = here[6]
    return count + 1


@njit(cache=True, error_model="numpy")
def tangencies(motion: Array, bolt: Array, nut: Array, limit: float, rects: Array, found: Array) -> tuple[int, int]:
    """All contacts of thread with thread before ``limit``, earliest first, and the number of rectangles looked at.

    ``motion`` is the bolt's, seen from the nut.
    """
    bounds = np.empty(BOUNDS_SIZE)
    path = np.empty(PATH_SIZE)
    set_bounds(motion, bolt, nut, bounds)
    p = bolt[pk.P]
    count = 0
    looked = 0
    best = limit
    depth = 0
    for i in range(AZIMUTHS):
        low = 0.0
        high = p / 32.0
        while low < p:
            r = rects[depth]
            r[R_THETA] = TWO_PI * (i + 0.5) / AZIMUTHS
            r[R_HALF_THETA] = math.pi / AZIMUTHS
            r[R_Z] = 0.5 * (low + high)
            r[R_HALF_Z] = 0.5 * (high - low)
            verdict = judge(r, best, motion, bolt, nut, bounds, path)
            looked += 1
            if verdict == OUT:
                break
            if verdict == OPEN:
                depth += 1
            low = high
            high = min(2.0 * high, p)
    quad = np.empty(RECTANGLE_SIZE)
    while depth > 0:
        depth -= 1
        for j in range(RECTANGLE_SIZE):
            quad[j] = rects[depth, j]
        split_theta = quad[R_HALF_THETA] > 40.0 / p * quad[R_HALF_Z]
        for side in (-1.0, 1.0):
            r = rects[depth]
            for j in range(RECTANGLE_SIZE):
                r[j] = quad[j]
            if split_theta:
                r[R_HALF_THETA] = 0.5 * quad[R_HALF_THETA]
                r[R_THETA] = quad[R_THETA] + side * r[R_HALF_THETA]
            else:
                r[R_HALF_Z] = 0.5 * quad[R_HALF_Z]
                r[R_Z] = quad[R_Z] + side * r[R_HALF_Z]
            looked += 1
            if judge(r, best, motion, bolt, nut, bounds, path) != OPEN:
                continue
            if r[R_HALF_THETA] < SMALL_THETA:
                tau = touch(r, limit, motion, bolt, nut, bounds, path)
                if tau < NEVER:
                    count = polish(r, tau, limit, motion, bolt, nut, path, found, count)
                if count > 0:
                    best = min(best, found[0, T_TIME])
            if r[R_HALF_THETA] < TINY_THETA:
                continue
            depth += 1
            if depth + 2 >= MAX_RECTANGLES or looked > MOST_LOOKS:
                return count, OVERFLOW
    return count, looked


@njit(cache=True, error_model="numpy")
def ridge_point(
    theta: float, low: float, high: float, tau: float, motion: Array, bolt: Array, nut: Array, path: Array, out: Array
) -> float:
    """The z in [low, high] at which B falls through zero (phi is highest along the axis), by Illinois steps."""
    residual(theta, low, tau, motion, bolt, nut, path, out)
    fa = out[2]
    residual(theta, high, tau, motion, bolt, nut, path, out)
    fb = out[2]
    a, b, wa, wb = low, high, fa, fb
    side = 0
    for _ in range(40):
        c = (a * wb - b * wa) / (wb - wa)
        if not a < c < b:
            c = 0.5 * (a + b)
        residual(theta, c, tau, motion, bolt, nut, path, out)
        f = out[2]
        if f > 0.0:
            a, wa = c, f
            if side == -1:
                wb *= 0.5
            side = -1
        else:
            b, wb = c, f
            if side == 1:
                wa *= 0.5
            side = 1
        if b - a < 1e-6 * bolt[pk.P] or abs(f) < 1e-9:
            break
    return c


@njit(cache=True, error_model="numpy")
def settle(
    theta: float, z: float, tau: float, motion: Array, bolt: Array, nut: Array, path: Array, here: Array
) -> tuple[float, float, bool]:
    """The highest point of phi on the thread near (theta, z) at a fixed ``tau`` (A = B = 0), by Newton's method."""
    k = bolt[pk.P] / TWO_PI
    p = bolt[pk.P]
    there = np.empty(7)
    for _ in range(20):
        residual(theta, z, tau, motion, bolt, nut, path, here)
        a, b = here[1], here[2]
        residual(theta + 1e-5, z + k * 1e-5, tau, motion, bolt, nut, path, there)
        a_u, b_u = (there[1] - a) * 1e5, (there[2] - b) * 1e5
        step = 1e-6 * p
        residual(theta, z + step, tau, motion, bolt, nut, path, there)
        a_z, b_z = (there[1] - a) / step, (there[2] - b) / step
        det = a_u * b_z - a_z * b_u
        if not (b_z < 0.0 and det > 0.0):
            return theta, z, False
        du = min(max((a_z * b - b_z * a) / det, -0.1), 0.1)
        dz = min(max((b_u * a - a_u * b) / det, -0.02 * p), 0.02 * p)
        theta += du
        z += k * du + dz
        if abs(du) < 1e-7 and abs(dz) < 1e-7 * p:
            residual(theta, z, tau, motion, bolt, nut, path, here)
            return theta, z, True
    return theta, z, False


@njit(cache=True, error_model="numpy")
def follow(
    theta: float,
    z: float,
    tau: float,
    limit: float,
    motion: Array,
    bolt: Array,
    nut: Array,
    path: Array,
    rect: Array,
    found: Array,
    count: int,
) -> int:
    """Follows a highest point of phi through time to where phi vanishes there, in steps of at most ``FOLLOW``."""
    here = np.empty(7)
    for _ in range(60):
        theta, z, settled = settle(theta, z, tau, motion, bolt, nut, path, here)
        if not settled or z < -0.05 * bolt[pk.P] or here[6] > 0.05 * bolt[pk.P] or here[3] <= 0.0:
            return count
        move = -here[0] / here[3]
        tau += min(max(move, -FOLLOW), FOLLOW)
        if tau <= 0.0 or tau > limit + FOLLOW:
            return count
        if abs(move) < 1e-6:
            rect[R_THETA] = theta
            rect[R_Z] = z
            rect[R_HALF_THETA] = SMALL_THETA
            return polish(rect, tau, limit, motion, bolt, nut, path, found, count)
    return count


@njit(cache=True, error_model="numpy")
def ridges(motion: Array, bolt: Array, nut: Array, limit: float, azimuths: int, found: Array) -> int:
    """Contacts of thread with thread along a turn before ``limit``, earliest first.

    At instants up to the limit the ridge of phi over the bolt's thread below the nut's surface (B = 0) is followed
    round the azimuths; where its slope A falls through zero, Newton's method finds the tangency and its time. The
    number of azimuths is a resolution, not a bound: docs/method-notes.md says how it was checked.
    """
    bounds = np.empty(BOUNDS_SIZE)
    path = np.empty(PATH_SIZE)
    rect = np.empty(RECTANGLE_SIZE)
    here = np.empty(7)
    set_bounds(motion, bolt, nut, bounds)
    p = bolt[pk.P]
    count = 0
    slices = 1 + int(limit / SLICE)
    piece = p / 10.0
    for i in range(slices):
        tau = limit * (i + 1) / slices
        _, _, up = turn_vector(0.0, 0.0, 1.0, motion, tau)
        # Per ridge (numbered from the base up) the slope and place at the azimuth before.
        before = np.full((4, 3), math.nan)
        for j in range(azimuths + 1):
            theta = TWO_PI * j / azimuths
            residual(theta, 0.0, tau, motion, bolt, nut, path, here)
            depth = -here[6]
            now = np.full((4, 3), math.nan)
            if depth > 0.0:
                top = min(depth / up if up > 0.1 else p, p)
                pieces = min(1 + int(top / piece), 10)
                ridge = 0
                below = here[2]
                for m in range(pieces):
                    high = top * (m + 1) / pieces
                    residual(theta, high, tau, motion, bolt, nut, path, here)
                    above = here[2]
                    if below > 0.0 and above < 0.0 and ridge < 4:
                        z = ridge_point(theta, top * m / pieces, high, tau, motion, bolt, nut, path, here)
                        now[ridge, 0] = here[1]
                        now[ridge, 1] = theta
                        now[ridge, 2] = z
                        ridge += 1
                    below = above
            for m in range(4):
                # A maximum between two azimuths, or between an azimuth and the end of a ridge.
                falls = before[m, 0] > 0.0 and now[m, 0] < 0.0
                ends = before[m, 0] > 0.0 and math.isnan(now[m, 0])
                starts = now[m, 0] < 0.0 and math.isnan(before[m, 0])
                if falls or ends or starts:
                    rect[R_THETA] = now[m, 1] if starts else before[m, 1]
                    rect[R_Z] = now[m, 2] if starts else before[m, 2]
                    if falls:
                        w = before[m, 0] / (before[m, 0] - now[m, 0])
                        rect[R_THETA] += w * (now[m, 1] - before[m, 1])
                        rect[R_Z] += w * (now[m, 2] - before[m, 2])
                    rect[R_HALF_THETA] = TWO_PI / azimuths
                    count = follow(rect[R_THETA], rect[R_Z], tau, limit, motion, bolt, nut, path, rect, found, count)
            before = now
    return count
