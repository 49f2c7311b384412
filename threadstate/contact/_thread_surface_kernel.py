"""The bolt's thread on the nut's surface, away from both edges (method, section 4).

Where the bolt's axis is tilted by more than the flank's half-angle its thread has lowest points: one in each turn of
the helix, on the crest's fillet or at its corner. One that comes down on the nut's surface is a contact. The nut's
thread has none over the bolt's base, as it curves round the bolt.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._geometry_kernel import M_KIND, M_POINT, TWO_PI, motion_scale
from threadstate.contact._tangency_kernel import (
    PLACEMENT_OFF,
    PLACEMENT_ROT,
    PLACEMENT_SIZE,
    T_POINT_Z,
    T_THETA,
    T_TIME,
    T_X,
    T_Y,
    T_Z,
    set_placement,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# The lowest point of one turn of the thread: whether there is one (NO_POINT, or AT_FLANK where the flank beside the
# fillet goes on down, or LOWEST), azimuth and axial position on the bolt's thread, and height over the nut's surface.
L_KIND, L_THETA, L_Z, L_HEIGHT = range(4)
LOWEST_SIZE = 4
NO_POINT, AT_FLANK, LOWEST = range(3)

LEAST_STEP = 1e-6
"""Shortest step of a motion (in units of ``motion_scale``): a touch that lasts less long is not found. Its depth is at
most of the order of the square of that."""

TOUCHING = 1e-12
"""Height (thread pitches) up to which a lowest point counts as touching already: an earlier contact's is round-off."""

MAX_FOUND = 11
"""One contact of each turn that is followed, of the most starts that a thread may have (``most_turns``)."""

MAX_RADIUS_STEPS = 60
"""Steps to the radius of a lowest point. Each brings it nearer by a factor of some ``rho k^2 / f^3``, 1e-4 or less."""


@kernel()
def least_tilt(bolt: Array) -> float:
    """Tilt of the bolt's axis (rad) below which its thread has no lowest point."""
    return max(math.atan(1.0 / bolt[pk.COT]), math.atan(abs(bolt[pk.LEAD]) / (TWO_PI * bolt[pk.R_MAJOR])))


@kernel()
def set_lowest(turn: float, near: float, placement: Array, bolt: Array, lowest: Array) -> None:
    """Sets the lowest point of a turn of the bolt's thread, the azimuth down the tilt taken within pi of ``near``.

    ``turn`` counts thread pitches along the axis. With the direction up in the bolt's frame, ``(n_h, n_z)`` across
    and along the axis, and ``psi`` the azimuth from down the tilt, the height is
    ``-n_h f(s) cos(psi) + n_z (s + k theta)``. It is lowest where ``sin(psi) = -n_z k / (n_h f)`` and
    ``f'(s) = n_z / (n_h cos(psi))``, a place of the fillet at the crest that is known in closed form but for ``f``.
    """
    nx, ny, nz = placement[PLACEMENT_ROT + 6], placement[PLACEMENT_ROT + 7], placement[PLACEMENT_ROT + 8]
    k = bolt[pk.LEAD] / TWO_PI
    across = math.hypot(nx, ny)
    rho = bolt[pk.RHO_MAJOR]
    lowest[L_KIND] = NO_POINT
    f, u, sine, cosine, sine_beta, cosine_beta = bolt[pk.R_MAJOR], bolt[pk.U_TOP], 0.0, 1.0, 0.0, 1.0
    for _ in range(MAX_RADIUS_STEPS):
        if not abs(nz * k) < across * f:
            return
        sine = -nz * k / (across * f)
        cosine = math.sqrt((1.0 - sine) * (1.0 + sine))
        slope = abs(nz) / (across * cosine)
        lowest[L_KIND] = LOWEST if slope < bolt[pk.COT] else AT_FLANK
        slope = min(slope, bolt[pk.COT])
        cosine_beta = 1.0 / math.sqrt(1.0 + slope * slope)
        sine_beta = slope * cosine_beta
        u = max(bolt[pk.U_TOP] - rho * sine_beta, bolt[pk.U_CREST])
        before = f
        f = bolt[pk.R_MAJOR] - rho * (1.0 - cosine_beta)
        if f == before:
            break
    # Elsewhere the height has a saddle there: its second derivatives are f and 1 / f'', and f' tan(psi) mixed.
    if not f * cosine * cosine > rho * cosine_beta * (sine_beta * sine) ** 2:
        lowest[L_KIND] = NO_POINT
        return
    down = math.atan2(-ny, -nx) - near
    theta = near + down - TWO_PI * np.floor(down / TWO_PI + 0.5) + math.atan2(sine, cosine)
    s = u if nz >= 0.0 else 0.5 * bolt[pk.P] - u
    z = s + k * theta + turn * bolt[pk.P]
    lowest[L_THETA] = theta
    lowest[L_Z] = z
    lowest[L_HEIGHT] = f * (nx * math.cos(theta) + ny * math.sin(theta)) + nz * z + placement[PLACEMENT_OFF + 2]


@kernel()
def most_turns(bolt: Array) -> int:
    """The turns of the thread, counted from -n to n, that are in the bolt at some azimuth within 2 pi of 0."""
    return math.ceil(abs(bolt[pk.LEAD]) / bolt[pk.P]) + 1


@kernel()
def point_in_nut(lowest: Array, placement: Array, bolt: Array) -> tuple[float, float]:
    """The x and y of a lowest point in the nut's frame."""
    z = lowest[L_Z]
    r = pk.radius(z - bolt[pk.LEAD] / TWO_PI * lowest[L_THETA], bolt)
    bx, by = r * math.cos(lowest[L_THETA]), r * math.sin(lowest[L_THETA])
    m, off = placement[PLACEMENT_ROT : PLACEMENT_ROT + 9], placement[PLACEMENT_OFF : PLACEMENT_OFF + 3]
    return m[0] * bx + m[1] * by + m[2] * z + off[0], m[3] * bx + m[4] * by + m[5] * z + off[1]


@kernel()
def deepest_lowest_point(placement: Array, bolt: Array, nut: Array) -> tuple[float, float, float]:
    """The greatest depth in the nut of a lowest point of the bolt's thread, and its place (theta, z) on it.

    The depth is -inf where there is none.
    """
    lowest = scratch(LOWEST_SIZE)
    deepest, at_theta, at_z = -math.inf, 0.0, 0.0
    turns = most_turns(bolt)
    for turn in range(-turns, turns + 1):
        set_lowest(turn, 0.0, placement, bolt, lowest)
        if lowest[L_KIND] != LOWEST or not 0.0 < lowest[L_Z] < bolt[pk.P]:
            continue
        x, y = point_in_nut(lowest, placement, bolt)
        up = lowest[L_HEIGHT]
        radial = math.hypot(x, y) - pk.radius(up - nut[pk.LEAD] / TWO_PI * math.atan2(y, x), nut)
        depth = min(radial, -up, nut[pk.P] + up)
        if depth > deepest:
            deepest, at_theta, at_z = depth, lowest[L_THETA], lowest[L_Z]
    return deepest, at_theta, at_z


@kernel()
def thread_surface_contacts(motion: Array, bolt: Array, nut: Array, reach: float, found: Array, count: int) -> int:
    """Adds the contacts of the bolt's thread with the nut's surface up to ``reach``; returns their number then.

    Each turn's lowest point is followed by steps over which it cannot come down to the surface: its height changes no
    faster than a point of the bolt moves, as what a lowest point moves along the thread changes nothing in first
    order. An onset is where it comes down to the surface, over the nut and within the bolt's length.
    """
    placement = scratch(PLACEMENT_SIZE)
    is_turn = motion[M_KIND] > 0.0
    bound = least_tilt(bolt)
    tilt = math.atan2(math.hypot(motion[6], motion[7]), motion[8])
    if tilt + (reach if is_turn else 0.0) < bound:
        return count
    set_placement(motion, 0.5 * reach, placement)
    near = math.atan2(-placement[PLACEMENT_ROT + 7], -placement[PLACEMENT_ROT + 6])
    turns = most_turns(bolt)
    for turn in range(-turns, turns + 1):
        count = follow_turn(turn, near, bound, motion, bolt, nut, reach, placement, found, count)
    return count


@kernel()
def greatest_speed(motion: Array, bolt: Array) -> float:
    """How fast a point of the thread moves at most, a unit of the motion's time."""
    if motion[M_KIND] == 0.0:
        return 1.0
    arm = 0.0
    for i in range(3):
        arm += (motion[9 + i] - motion[M_POINT + i]) ** 2
    return math.sqrt(arm) + bolt[pk.R_MAJOR] + 2.0 * (most_turns(bolt) + 1) * bolt[pk.P]


@kernel()
def time_of_touch(
    low: float, high: float, turn: float, near: float, motion: Array, bolt: Array, placement: Array, lowest: Array
) -> float:
    """When a turn's lowest point reaches the surface, bisected to the last digit; sets placement and point there."""
    middle = 0.5 * (low + high)
    while low < middle < high:
        set_placement(motion, middle, placement)
        set_lowest(turn, near, placement, bolt, lowest)
        if lowest[L_HEIGHT] > 0.0:
            low = middle
        else:
            high = middle
        middle = 0.5 * (low + high)
    set_placement(motion, high, placement)
    set_lowest(turn, near, placement, bolt, lowest)
    return high


@kernel()
def add_touch(time: float, lowest: Array, placement: Array, bolt: Array, nut: Array, found: Array, count: int) -> int:
    """Adds a touch of the surface, if it is the thread's own and not over the hole; how many there are then."""
    if not (lowest[L_KIND] == LOWEST and 0.0 < lowest[L_Z] < bolt[pk.P]):
        return count
    x, y = point_in_nut(lowest, placement, bolt)
    azimuth = math.atan2(y, x)
    if not math.hypot(x, y) > pk.radius(-nut[pk.LEAD] / TWO_PI * azimuth, nut):
        return count
    found[count, T_TIME] = time
    found[count, T_THETA] = lowest[L_THETA]
    found[count, T_Z] = lowest[L_Z]
    found[count, T_X] = x
    found[count, T_Y] = y
    found[count, T_POINT_Z] = 0.0
    return count + 1


@kernel()
def follow_turn(
    turn: float,
    near: float,
    bound: float,
    motion: Array,
    bolt: Array,
    nut: Array,
    reach: float,
    placement: Array,
    found: Array,
    count: int,
) -> int:
    """Adds the first contact of one turn's lowest point up to ``reach``; returns the number of contacts then."""
    lowest = scratch(LOWEST_SIZE)
    is_turn = motion[M_KIND] > 0.0
    least_step = LEAST_STEP * motion_scale(motion, bolt)
    speed = greatest_speed(motion, bolt)
    touching = TOUCHING * bolt[pk.P]
    tau, before = 0.0, 0.0
    is_above = False
    while True:
        set_placement(motion, tau, placement)
        set_lowest(turn, near, placement, bolt, lowest)
        if lowest[L_KIND] == NO_POINT:
            is_above = False
            if not is_turn:
                return count
            tilt = math.atan2(
                math.hypot(placement[PLACEMENT_ROT + 6], placement[PLACEMENT_ROT + 7]),
                abs(placement[PLACEMENT_ROT + 8]),
            )
            step = max(least_step, bound - tilt)
        else:
            height = lowest[L_HEIGHT]
            if is_above and height <= 0.0:
                time = time_of_touch(before, tau, turn, near, motion, bolt, placement, lowest)
                with_touch = add_touch(time, lowest, placement, bolt, nut, found, count)
                if with_touch > count:
                    return with_touch
                is_above = False
            elif height > touching:
                is_above = True
            step = max(least_step, abs(height) / speed)
        if tau >= reach:
            return count
        before = tau
        tau = min(tau + step, reach)
