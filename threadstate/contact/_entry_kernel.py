"""The time at which one point first enters a solid: closed form for the plane, safe steps and Newton for the thread.

Every step towards the thread is one of two kinds. A *safe* step is no longer than the clearance divided by the
largest speed at which ``phi`` can grow (its Lipschitz constant), so that it cannot jump over material. A *Newton*
step is taken only where Kantorovich's condition ``2 |phi| K < phi'^2`` holds (K bounds the second derivative):
then the root is the only one within reach, and the first.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import larger
from threadstate.contact._geometry_kernel import TWO_PI, phi_and_gradient, position, velocity
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

NEVER = math.inf

NO_ENTRY = 0
"""No entry up to the limit."""
PLANE = 1
"""Entry through the flat face."""
THREAD = 2
"""Entry through the thread."""
INSIDE_ALREADY = 3
"""Inside from the start."""


@kernel()
def half_space(g0: float, gc: float, gs: float, is_turn: bool) -> tuple[float, float]:
    """First interval of ``tau >= 0`` on which g = g0 + gc cos(tau) + gs sin(tau) (or g0 + gs tau) is >= 0.

    For a turn only ``tau < pi`` is meant. Empty: (NEVER, NEVER). Where a coefficient is NaN, nothing is excluded.
    """
    if math.isnan(g0 + gc + gs):
        return 0.0, NEVER
    if not is_turn:
        if g0 >= 0.0:
            return 0.0, (NEVER if gs >= 0.0 else -g0 / gs)
        return (-g0 / gs, NEVER) if gs > 0.0 else (NEVER, NEVER)
    # With t = tan(tau / 2) the sign of g is that of a t^2 + 2 b t + c.
    a = g0 - gc
    b = gs
    c = g0 + gc
    disc = b * b - a * c
    if disc < 0.0:
        return (0.0, NEVER) if c >= 0.0 else (NEVER, NEVER)
    q = -(b + math.copysign(math.sqrt(disc), b))
    t1 = c / q if q != 0.0 else NEVER
    t2 = q / a if a != 0.0 else NEVER
    if t1 <= 0.0:
        t1 = NEVER
    if t2 <= 0.0:
        t2 = NEVER
    lo = min(t1, t2)
    hi = max(t1, t2)
    first = 2.0 * math.atan(lo)
    time_second_derivative = 2.0 * math.atan(hi) if hi < NEVER else NEVER
    if c >= 0.0:
        return 0.0, (first if lo < NEVER else NEVER)
    return (first, time_second_derivative) if lo < NEVER else (NEVER, NEVER)


@kernel()
def second_time_derivative(
    span: float,
    s: float,
    speed: float,
    transverse_speed: float,
    is_turn: bool,
    profile: Array,
    lipschitz: float,
    r_low: float,
) -> float:
    """Bound on the second derivative of phi by tau along a path during ``span``.

    At the start ``s`` is the helical coordinate and ``transverse_speed`` the speed across the axis: motion along the
    axis changes the gradient by f'' alone.
    """
    k_r = abs(profile[pk.LEAD]) / (TWO_PI * r_low)
    s_rate = (1.0 + k_r) * speed
    low, high = pk.second_derivative_range(s, s_rate * span, profile)
    f2 = larger(high, -low)
    turning_term = lipschitz if is_turn else 0.0
    transverse_speed += speed * span if is_turn else 0.0
    return (
        f2 * s_rate * s_rate
        + (profile[pk.STEEPEST] * k_r * 2.0 + 1.0) / r_low * transverse_speed * speed
        + turning_term * speed
    )


@kernel()
def entry_time(
    path: Array,
    is_turn: bool,
    profile: Array,
    sigma: float,
    since: float,
    limit: float,
    lipschitz: float,
    second_derivative: float,
    r_low: float,
) -> tuple[float, int]:
    """First ``tau`` in [0, limit] at which the point is in the solid, and how it entered.

    Until ``since`` it is known to be outside. ``lipschitz`` bounds |grad phi|, ``second_derivative`` the norm of the
    Hessian of phi, ``r_low`` the radius from below.
    """
    start, stop = half_space(-sigma * path[2], -sigma * path[5], -sigma * path[8], is_turn)
    if start > limit:
        return NEVER, NO_ENTRY
    end = min(stop, limit)
    speed = path[9]
    time_second_derivative = second_derivative * speed * speed + (lipschitz * speed if is_turn else 0.0)
    k = profile[pk.LEAD] / TWO_PI
    tau = max(start, since)
    certain = False
    for step in range(400):
        x, y, z = position(path, tau, is_turn)
        value, gx, gy, gz = phi_and_gradient(x, y, z, profile, sigma)
        if value >= 0.0 and step == 0:
            return (tau, PLANE) if start > 0.0 else (0.0, INSIDE_ALREADY)
        vx, vy, vz = velocity(path, tau, is_turn)
        rate = gx * vx + gy * vy + gz * vz
        if certain or (rate > 0.0 and -2.0 * value * time_second_derivative < rate * rate):
            certain = True
            move = -value / rate
            if abs(move) <= 3e-16 * (1.0 + tau):
                break
        elif speed > 0.0:
            move = -value / (lipschitz * speed)
            if step > 3:
                transverse_speed = math.sqrt(vx * vx + vy * vy)
                span = min(12.0 * move, end - tau)
                s = z - k * math.atan2(y, x)
                rate_growth = (
                    0.5
                    * second_time_derivative(span, s, speed, transverse_speed, is_turn, profile, lipschitz, r_low)
                    * span
                )
                if (rate + rate_growth) * span <= -0.9 * value:
                    move = max(move, span)
        else:
            # A point on the axis of a turn stays where it is.
            return NEVER, NO_ENTRY
        if certain:
            tau += move
        elif tau >= end:
            return NEVER, NO_ENTRY
        else:
            tau = min(tau + move, end)
    return (tau, THREAD) if tau <= end else (NEVER, NO_ENTRY)
