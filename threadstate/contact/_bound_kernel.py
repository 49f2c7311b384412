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

from threadstate.contact._entry_kernel import half_space
from threadstate.contact._geometry_kernel import M_KIND, M_SIGMA, TWO_PI, edge_point, field, position, set_path, turn_vector, velocity
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
FINE = 1e-4


@njit(cache=True)
def second_derivative_bound(row: Array) -> float:
    """Largest |f''| of a profile; infinite for a sharp corner."""
    cube = (1.0 + row[pk.COT] * row[pk.COT]) ** 1.5
    rho = min(row[pk.RHO_MINOR], row[pk.RHO_MAJOR])
    return cube / rho if rho > 0.0 else math.inf


@njit(cache=True)
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


@njit(cache=True)
def sine_of_tilt(motion: Array, bounds: Array, tau: float) -> float:
    """Bound on the sine of the angle between the axes up to ``tau``."""
    if motion[M_KIND] == 0.0:
        return math.sin(bounds[B_TILT])
    return math.sin(min(bounds[B_TILT] + tau, 0.5 * math.pi))


@njit(cache=True)
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


@njit(cache=True)
def helical(x: float, y: float, z: float, tx: float, ty: float, tz: float, k: float) -> tuple[float, float, float]:
    """``s``, its derivative along (tx, ty, tz), and the radius."""
    r2 = x * x + y * y
    return z - k * math.atan2(y, x), tz - k * (x * ty - y * tx) / r2, math.sqrt(r2)


@njit(cache=True)
def plane_start(theta: float, half: float, limit: float, motion: Array, row_c: Array, bounds: Array, path: Array) -> tuple[float, float]:
    """A time before which no point of the cell is in the half space, and one after which none is.

    ``path`` receives the path of the cell's middle.
    """
    is_turn = motion[M_KIND] != 0.0
    sigma = motion[M_SIGMA]
    k = row_c[pk.P] / TWO_PI
    x, y, dx, dy = edge_point(theta, row_c)
    set_path(x, y, motion, path)
    own_low, own_high = pk.bend_range(-k * theta, k * half, row_c)
    c2 = k * k * max(own_high, -own_low) + row_c[pk.R_MAJOR] + 2.0 * k * row_c[pk.COT]
    pad = 0.5 * sine_of_tilt(motion, bounds, limit) * c2 * half * half
    g0 = -sigma * path[2]
    gc = -sigma * path[5]
    gs = -sigma * path[8]
    tx, ty, tz = turn_vector(dx, dy, 0.0, motion, 0.0)
    if is_turn:
        ax, ay, az = motion[16], motion[17], motion[18]
        h = ax * tx + ay * ty + az * tz
        t0 = -sigma * h * az
        tc = -sigma * (tz - h * az)
        ts = -sigma * (ax * ty - ay * tx)
    else:
        t0 = -sigma * tz
        tc = 0.0
        ts = 0.0
    lo1, hi1 = half_space(g0 + half * t0 + pad, gc + half * tc, gs + half * ts, is_turn)
    lo2, hi2 = half_space(g0 - half * t0 + pad, gc - half * tc, gs - half * ts, is_turn)
    start = min(lo1, lo2)
    if lo1 == math.inf:
        return start, hi2
    if lo2 == math.inf:
        return start, hi1
    return start, max(hi1, hi2)


@njit(cache=True)
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


@njit(cache=True)
def headroom(
    theta: float,
    half: float,
    tau: float,
    dx: float,
    dy: float,
    motion: Array,
    row_c: Array,
    row_s: Array,
    bounds: Array,
    path: Array,
) -> tuple[float, float, float, float, float]:
    """At ``tau``: a lower bound of -phi over the cell (0 or less: none), and of its middle the rate of phi, s, ds/dtheta
    and the speed across the axis."""
    is_turn = motion[M_KIND] != 0.0
    x, y, z = position(path, tau, is_turn)
    value, gx, gy, gz = field(x, y, z, row_s, motion[M_SIGMA])
    vx, vy, vz = velocity(path, tau, is_turn)
    rate = gx * vx + gy * vy + gz * vz
    level = math.sqrt(vx * vx + vy * vy)
    tx, ty, tz = turn_vector(dx, dy, 0.0, motion, tau)
    s, s_slope, r = helical(x, y, z, tx, ty, tz, row_s[pk.P] / TWO_PI)
    room = -value - abs(gx * tx + gy * ty + gz * tz) * half
    if room > 0.0 and half > 0.0:
        _, high = thread_bend(theta, half, s, s_slope, r, tau, motion, row_c, row_s, bounds)
        room -= 0.5 * max(high, 0.0) * half * half
    return room, rate, s, s_slope, level


@njit(cache=True)
def clear(
    theta: float, half: float, limit: float, motion: Array, row_c: Array, row_s: Array, bounds: Array, path: Array
) -> bool:
    """Whether no point of the curve within ``half`` of ``theta`` enters before ``limit``. False: not proved."""
    is_turn = motion[M_KIND] != 0.0
    tau, stop = plane_start(theta, half, limit, motion, row_c, bounds, path)
    if tau >= limit:
        return True
    end = min(stop, limit)
    _, _, dx, dy = edge_point(theta, row_c)
    speed = path[9]
    cross = 0.0
    if is_turn:
        # Velocity is axis x place, so that its derivative along the curve is axis x tangent.
        tx, ty, tz = turn_vector(dx, dy, 0.0, motion, 0.0)
        h = motion[16] * tx + motion[17] * ty + motion[18] * tz
        cross = math.sqrt(max(dx * dx + dy * dy - h * h, 0.0)) + bounds[B_C2] * half
    # The end first: there phi is highest as a rule, and a cell that fails there fails at once.
    room, rate, s, s_slope, level = headroom(theta, half, end, dx, dy, motion, row_c, row_s, bounds, path)
    if room <= 0.0:
        return False
    span = end - tau
    by_time, by_theta = growth_bounds(half, span, s, s_slope, speed, cross, level, is_turn, row_s, bounds)
    slowest = rate - by_time * span - by_theta * half
    if slowest >= 0.0 or -(rate - by_theta * half - 0.5 * by_time * span) * span <= room:
        return True
    fastest = bounds[B_LIPSCHITZ] * (speed + cross * half)
    end -= room / fastest
    for _ in range(MOST_STEPS if half < FINE else FEW_STEPS):
        if tau >= end:
            return True
        room, rate, s, s_slope, level = headroom(theta, half, tau, dx, dy, motion, row_c, row_s, bounds, path)
        if room <= 0.0:
            return False
        step = room / fastest
        if tau + step >= end:
            return True
        span = end - tau
        by_time, by_theta = growth_bounds(half, span, s, s_slope, speed, cross, level, is_turn, row_s, bounds)
        if rate > by_time * span + by_theta * half:
            return True
        if (rate + by_theta * half + 0.5 * by_time * span) * span <= room:
            return True
        span = min(12.0 * step, span)
        by_time, by_theta = growth_bounds(half, span, s, s_slope, speed, cross, level, is_turn, row_s, bounds)
        if (rate + by_theta * half + 0.5 * by_time * span) * span <= room:
            step = span
        tau += step
    return False
