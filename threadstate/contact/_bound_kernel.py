"""Bounds over a cell of the edge curve: that nothing of it enters, and that its entry time is monotone.

Over azimuths theta +- half the plane's function and ``phi`` are replaced by their first-order expansion plus a bound
on the second derivative. With the curve's own radius ``r_c``, the other profile ``f``, sigma = +1 and k = p / 2 pi,

    phi'' = r'' - f''(s) s'^2 - f'(s) s''.

For coaxial parts r'' = r_c'' and s' = -k. Tilt T and offset o of the axes add at most a misalignment
e = (o + R sin^2 T) / r to every direction cosine, and sin T to every axial component; that gives the error terms below.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from threadstate.contact._entry_kernel import NEVER, half_space
from threadstate.contact._geometry_kernel import M_COPLANAR, M_KIND, M_SIGMA, TWO_PI, edge_point, set_path
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# Constants of one search.
B_LIPSCHITZ = 0
"""Bound on |grad phi|."""
B_BEND = 1
"""Bound on the second derivative of phi as a function of place."""
B_TILT = 2
"""Angle between the axes at the start."""
B_OFFSET = 3
"""Distance of the walker's origin from the other axis at the start, and its speed."""
B_DRIFT = 4
B_C1 = 5
"""Bound on |C'| of the edge curve."""
B_R_LOW = 6
B_C2 = 7
"""Bound on |C''|."""
BOUNDS_SIZE = 8

MOST_STEPS = 120
FEW_STEPS = 40
FAILING_STEPS = 4
FINE = 1e-4
LONG_TURN = 0.13
"""Turns (rad) beyond which it pays to keep how far a cell that fails at the end is clear."""


@njit(cache=True, error_model="numpy")
def second_derivative_bound(row: Array) -> float:
    """Largest |f''| of a profile; infinite for a sharp corner."""
    cube = (1.0 + row[pk.COT] * row[pk.COT]) ** 1.5
    rho = min(row[pk.RHO_MINOR], row[pk.RHO_MAJOR])
    return cube / rho if rho > 0.0 else math.inf


@njit(cache=True, error_model="numpy")
def set_bounds(motion: Array, row_c: Array, row_s: Array, bounds: Array) -> None:
    """The constants of a search for the edge curve of ``row_c`` in the solid of ``row_s``."""
    k = row_c[pk.P] / TWO_PI
    cot = row_s[pk.COT]
    r_low = 0.5 * row_s[pk.R_MINOR]
    k_r = k / r_low
    bounds[B_LIPSCHITZ] = math.sqrt(1.0 + cot * cot * (1.0 + k_r * k_r))
    bounds[B_BEND] = second_derivative_bound(row_s) * (1.0 + k_r * k_r) + (cot * k_r + 1.0) / r_low
    bounds[B_TILT] = math.asin(min(1.0, math.hypot(motion[2], motion[5])))
    bounds[B_OFFSET] = math.hypot(motion[9], motion[10])
    if motion[M_KIND] == 0.0:
        bounds[B_DRIFT] = math.hypot(motion[16], motion[17])
    else:
        dx = motion[9] - motion[13]
        dy = motion[10] - motion[14]
        dz = motion[11] - motion[15]
        bounds[B_DRIFT] = math.sqrt(dx * dx + dy * dy + dz * dz)
    bounds[B_C1] = math.hypot(row_c[pk.R_MAJOR], k * row_c[pk.COT])
    bounds[B_R_LOW] = r_low
    own = k * k * second_derivative_bound(row_c)
    bounds[B_C2] = own + row_c[pk.R_MAJOR] + 2.0 * k * row_c[pk.COT]


@njit(cache=True, error_model="numpy")
def sine_of_tilt(motion: Array, bounds: Array, tau: float) -> float:
    """Bound on the sine of the angle between the axes up to ``tau``."""
    if motion[M_KIND] == 0.0:
        return math.sin(bounds[B_TILT])
    return math.sin(min(bounds[B_TILT] + tau, 0.5 * math.pi))


@njit(cache=True, error_model="numpy")
def thread_bend(
    theta: float,
    half: float,
    s: float,
    s_slope: float,
    r: float,
    tau: float,
    motion: Array,
    row_c: Array,
    row_s: Array,
    bounds: Array,
) -> tuple[float, float]:
    """Lower and upper bound of phi'' along the curve over theta +- half at ``tau``.

    ``s``, ``s_slope``, ``r`` are the walker's helical coordinate in the solid, its derivative by theta, its radius.
    """
    k = row_c[pk.P] / TWO_PI
    cot = row_s[pk.COT]
    big = row_c[pk.R_MAJOR]
    r_prime = k * row_c[pk.COT]
    sine = sine_of_tilt(motion, bounds, tau)
    r_low = max(r - bounds[B_C1] * half, bounds[B_R_LOW])
    away = (bounds[B_OFFSET] + bounds[B_DRIFT] * tau + big * sine * sine) / r_low
    own_low, own_high = pk.bend_range(-k * theta, k * half, row_c)
    own_low *= k * k
    own_high *= k * k
    c2 = max(own_high, -own_low) + big + 2.0 * r_prime
    turn = bounds[B_C1] / r_low
    s_bend = sine * c2 + (k / r_low) * (2.0 * r_prime + away * c2 + 2.0 * (r_prime + away * bounds[B_C1]) * turn)
    reach = (abs(s_slope) + s_bend * half) * half
    low, high = pk.bend_range(s, reach, row_s)
    fastest = abs(s_slope) + s_bend * half
    error = (
        away * (2.0 * big + 4.0 * r_prime + max(own_high, -own_low))
        + r_prime * r_prime * 2.0 / r_low * away
        + cot * s_bend
    )
    if motion[M_SIGMA] > 0.0:
        return own_low - high * fastest * fastest - error, own_high - low * fastest * fastest + error
    return -own_high + low * fastest * fastest - error, -own_low + high * fastest * fastest + error


@njit(cache=True, error_model="numpy")
def helical(x: float, y: float, z: float, tx: float, ty: float, tz: float, k: float) -> tuple[float, float, float]:
    """``s``, its derivative along (tx, ty, tz), and the radius."""
    r2 = x * x + y * y
    return z - k * math.atan2(y, x), tz - k * (x * ty - y * tx) / r2, math.sqrt(r2)


@njit(cache=True, error_model="numpy")
def stays_negative(g0: float, gc: float, gs: float, limit: float, is_turn: bool) -> bool:
    """Whether g = g0 + gc cos(tau) + gs sin(tau) (or g0 + gs tau) is surely negative on [0, limit]; False: not known.

    Between the ends g exceeds their larger value by at most |g''| limit^2 / 8.
    """
    if not is_turn:
        return g0 < 0.0 and g0 + gs * limit < 0.0
    first = g0 + gc
    last = g0 + gc * math.cos(limit) + gs * math.sin(limit)
    return max(first, last) + (abs(gc) + abs(gs)) * limit * limit * 0.125 < 0.0


@njit(cache=True, error_model="numpy")
def plane_start(
    theta: float, half: float, limit: float, motion: Array, row_c: Array, bounds: Array, path: Array, tangent: Array
) -> tuple[float, float]:
    """A time before which no point of the cell is in the half space, and one after which none is.

    ``path`` receives the path of the cell's middle, ``tangent`` the path of the curve's tangent there.
    """
    is_turn = motion[M_KIND] != 0.0
    sigma = motion[M_SIGMA]
    k = row_c[pk.P] / TWO_PI
    x, y, dx, dy = edge_point(theta, row_c)
    set_path(x, y, motion, path)
    if half > 0.0:
        own_low, own_high = pk.bend_range(-k * theta, k * half, row_c)
        c2 = k * k * max(own_high, -own_low) + row_c[pk.R_MAJOR] + 2.0 * k * row_c[pk.COT]
        tilt = sine_of_tilt(motion, bounds, 0.0 if motion[M_COPLANAR] != 0.0 else limit)
        pad = 0.5 * tilt * c2 * half * half
    else:
        pad = 0.0
    g0 = -sigma * path[2] + pad
    gc = -sigma * path[5]
    gs = -sigma * path[8]
    tx = motion[0] * dx + motion[1] * dy
    ty = motion[3] * dx + motion[4] * dy
    tz = motion[6] * dx + motion[7] * dy
    if is_turn:
        ax, ay, az = motion[16], motion[17], motion[18]
        h = ax * tx + ay * ty + az * tz
        tangent[0] = h * ax
        tangent[1] = h * ay
        tangent[2] = h * az
        tangent[3] = tx - h * ax
        tangent[4] = ty - h * ay
        tangent[5] = tz - h * az
        tangent[6] = ay * tz - az * ty
        tangent[7] = az * tx - ax * tz
        tangent[8] = ax * ty - ay * tx
    else:
        tangent[0] = tx
        tangent[1] = ty
        tangent[2] = tz
        for i in range(3, 9):
            tangent[i] = 0.0
    t0 = -sigma * tangent[2] * half
    tc = -sigma * tangent[5] * half
    ts = -sigma * tangent[8] * half
    if motion[M_COPLANAR] != 0.0:
        return (0.0 if g0 + gc + abs(t0 + tc) >= 0.0 else NEVER), NEVER
    if stays_negative(g0 + t0, gc + tc, gs + ts, limit, is_turn) and stays_negative(
        g0 - t0, gc - tc, gs - ts, limit, is_turn
    ):
        return NEVER, NEVER
    lo1, hi1 = half_space(g0 + t0, gc + tc, gs + ts, is_turn)
    lo2, hi2 = half_space(g0 - t0, gc - tc, gs - ts, is_turn)
    start = min(lo1, lo2)
    if lo1 == NEVER:
        return start, hi2
    if lo2 == NEVER:
        return start, hi1
    return start, max(hi1, hi2)


@njit(cache=True, error_model="numpy")
def growth_bounds(
    half: float,
    span: float,
    s: float,
    s_slope: float,
    speed: float,
    cross: float,
    level: float,
    is_turn: bool,
    row_s: Array,
    bounds: Array,
) -> tuple[float, float]:
    """Bounds on the derivatives of d phi / d tau by tau and by theta, over a cell during ``span``.

    ``cross`` bounds the derivative of the velocity by theta, ``level`` is the walker's speed across the axis; motion
    along the axis changes the gradient by f'' alone.
    """
    k = row_s[pk.P] / TWO_PI
    c1 = bounds[B_C1]
    v = speed + cross * half
    k_r = k / bounds[B_R_LOW]
    along = (1.0 + k_r) * v
    across = abs(s_slope) + (1.0 + k_r) * c1 * half * (1.0 + c1 / bounds[B_R_LOW])
    low, high = pk.bend_range(s, along * span + across * half, row_s)
    f2 = max(high, -low)
    place = (row_s[pk.COT] * k_r * 2.0 + 1.0) / bounds[B_R_LOW]
    swing = bounds[B_LIPSCHITZ] if is_turn else 0.0
    level += v - speed + (v * span if is_turn else 0.0)
    return (
        f2 * along * along + place * level * v + swing * v,
        f2 * along * across + place * level * c1 + swing * cross,
    )


@njit(cache=True, error_model="numpy")
def headroom(
    theta: float,
    half: float,
    tau: float,
    tangent: Array,
    motion: Array,
    row_c: Array,
    row_s: Array,
    bounds: Array,
    path: Array,
) -> tuple[float, float, float, float, float]:
    """At ``tau``: a lower bound of -phi over the cell (0 or less: none), and the state of its middle.

    That is the rate of phi, s, ds/dtheta and the speed across the axis. ``tangent`` is the curve's as a path: base,
    cosine and sine part.
    """
    if motion[M_KIND] != 0.0:
        c = math.cos(tau)
        n = math.sin(tau)
        x = path[0] + c * path[3] + n * path[6]
        y = path[1] + c * path[4] + n * path[7]
        z = path[2] + c * path[5] + n * path[8]
        vx = c * path[6] - n * path[3]
        vy = c * path[7] - n * path[4]
        vz = c * path[8] - n * path[5]
        tx = tangent[0] + c * tangent[3] + n * tangent[6]
        ty = tangent[1] + c * tangent[4] + n * tangent[7]
        tz = tangent[2] + c * tangent[5] + n * tangent[8]
    else:
        x = path[0] + tau * path[6]
        y = path[1] + tau * path[7]
        z = path[2] + tau * path[8]
        vx = path[6]
        vy = path[7]
        vz = path[8]
        tx = tangent[0]
        ty = tangent[1]
        tz = tangent[2]
    sigma = motion[M_SIGMA]
    k = row_s[pk.P] / TWO_PI
    r2 = x * x + y * y
    r = math.sqrt(r2)
    s = z - k * math.atan2(y, x)
    f, d1, _ = pk.jet(s, row_s)
    turn = d1 * k / r2
    gx = sigma * (x / r - turn * y)
    gy = sigma * (y / r + turn * x)
    gz = -sigma * d1
    rate = gx * vx + gy * vy + gz * vz
    level = math.sqrt(vx * vx + vy * vy)
    s_slope = tz - k * (x * ty - y * tx) / r2
    room = -sigma * (r - f) - abs(gx * tx + gy * ty + gz * tz) * half
    if room > 0.0 and half > 0.0:
        _, high = thread_bend(theta, half, s, s_slope, r, tau, motion, row_c, row_s, bounds)
        room -= 0.5 * max(high, 0.0) * half * half
    return room, rate, s, s_slope, level


@njit(cache=True, error_model="numpy")
def clear(
    theta: float,
    half: float,
    since: float,
    limit: float,
    motion: Array,
    row_c: Array,
    row_s: Array,
    bounds: Array,
    path: Array,
    tangent: Array,
) -> float:
    """Time until which no point of the curve within ``half`` of ``theta`` enters; NEVER if none does before ``limit``.

    None is known to enter until ``since``.
    """
    is_turn = motion[M_KIND] != 0.0
    tau, stop = plane_start(theta, half, limit, motion, row_c, bounds, path, tangent)
    if tau >= limit:
        return NEVER
    end = min(stop, limit)
    tau = max(tau, since)
    if tau >= end:
        return NEVER
    speed = path[9]
    # Velocity is axis x place, so that its derivative along the curve is axis x tangent.
    cross = 0.0
    if is_turn:
        cross = math.sqrt(tangent[6] * tangent[6] + tangent[7] * tangent[7] + tangent[8] * tangent[8])
        cross += bounds[B_C2] * half
    # The end first: there phi is highest as a rule, and a cell that fails there fails at once.
    room, rate, s, s_slope, level = headroom(theta, half, end, tangent, motion, row_c, row_s, bounds, path)
    open_end = room > 0.0
    span = end - tau
    by_time, by_theta = growth_bounds(half, span, s, s_slope, speed, cross, level, is_turn, row_s, bounds)
    slowest = rate - by_time * span - by_theta * half
    if open_end and (slowest >= 0.0 or -(rate - by_theta * half - 0.5 * by_time * span) * span <= room):
        return NEVER
    fastest = bounds[B_LIPSCHITZ] * (speed + cross * half)
    end -= max(room, 0.0) / fastest
    steps = MOST_STEPS
    if half > FINE:
        steps = FEW_STEPS if open_end else (FAILING_STEPS if limit > LONG_TURN else 0)
    elif half == 0.0 and not open_end:
        steps = FAILING_STEPS
    for _ in range(steps):
        if tau >= end:
            return NEVER if open_end else tau
        room, rate, s, s_slope, level = headroom(theta, half, tau, tangent, motion, row_c, row_s, bounds, path)
        if room <= 0.0:
            return tau
        step = room / fastest
        if tau + step >= end:
            return NEVER
        span = end - tau
        by_time, by_theta = growth_bounds(half, span, s, s_slope, speed, cross, level, is_turn, row_s, bounds)
        if open_end and rate > by_time * span + by_theta * half:
            return NEVER
        if (rate + by_theta * half + 0.5 * by_time * span) * span <= room:
            return NEVER
        span = min(12.0 * step, span)
        by_time, by_theta = growth_bounds(half, span, s, s_slope, speed, cross, level, is_turn, row_s, bounds)
        if (rate + by_theta * half + 0.5 * by_time * span) * span <= room:
            step = span
        tau += step
    return tau
