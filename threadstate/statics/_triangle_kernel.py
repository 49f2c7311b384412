"""Three contacts that are not on one line: when two of them wedge, when all do, and what follows for a load.

Three forces that balance each other lie in the plane of their points, so that wedging is a question of the plane
sectors in which that plane cuts the friction cones. Where two contacts wedge they carry any force without moment
about the line between them, and the third has to balance that moment alone (forces, section 3).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch

Array = NDArray[np.float64]


@kernel()
def inner(a: Array, b: Array) -> float:
    """The product of two vectors of three numbers."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel()
def set_cross(a: Array, b: Array, out: Array) -> None:
    """Sets the cross product."""
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@kernel()
def friction_along(normal: Array, along: Array) -> float:
    """The friction at which a force along a unit vector lies on the cone's boundary; infinite if it pulls."""
    n = inner(normal, along)
    if n <= 0.0:
        return math.inf
    x = along[1] * normal[2] - along[2] * normal[1]
    y = along[2] * normal[0] - along[0] * normal[2]
    z = along[0] * normal[1] - along[1] * normal[0]
    return math.sqrt(x * x + y * y + z * z) / n


@kernel(allocates=True)
def pair_friction(points: Array, normals: Array, i: int, j: int, along: Array) -> tuple[float, float]:
    """The friction that contacts i and j need to press against each other, at i and at j; both infinite if they cannot.

    ``along`` is set to the unit vector of the force at i.
    """
    for m in range(3):
        along[m] = points[i, m] - points[j, m]
    length = math.sqrt(inner(along, along))
    if length == 0.0:
        return math.inf, math.inf
    sign = 1.0 if inner(along, normals[i]) > 0.0 else -1.0
    for m in range(3):
        along[m] *= sign / length
    at_i = friction_along(normals[i], along)
    at_j = friction_along(normals[j], -along)
    if at_i == math.inf or at_j == math.inf:
        return math.inf, math.inf
    return at_i, at_j


@kernel(allocates=True)
def sectors_wedge(mu: float, points: Array, normals: Array) -> bool:
    """Whether forces within the cones that lie in the plane of three points, and are not all zero, balance each other.

    The wrenches of the sectors' edges span all plane wrenches unless a plane through two of them has all on one side.
    """
    across = scratch(3)
    first = points[1] - points[0]
    set_cross(first, points[2] - points[0], across)
    size = math.sqrt(inner(across, across))
    length = math.sqrt(inner(first, first))
    u = first / length
    across /= size
    v = scratch(3)
    set_cross(across, u, v)
    rays = scratch(6, 3)
    count = 0
    for i in range(3):
        a, b = inner(normals[i], u), inner(normals[i], v)
        inside = math.hypot(a, b)
        if inside * math.sqrt(1.0 + mu * mu) <= 1.0:
            continue
        half = math.acos(1.0 / (inside * math.sqrt(1.0 + mu * mu)))
        middle = math.atan2(b, a)
        x, y = inner(points[i] - points[0], u), inner(points[i] - points[0], v)
        for side in (-1.0, 1.0):
            c, s = math.cos(middle + side * half), math.sin(middle + side * half)
            rays[count, 0], rays[count, 1], rays[count, 2] = c, s, (x * s - y * c) / length
            count += 1
    if count < 4:
        return False
    normal = scratch(3)
    for a in range(count):
        for b in range(a + 1, count):
            set_cross(rays[a], rays[b], normal)
            low, high = 0.0, 0.0
            for m in range(count):
                if m != a and m != b:
                    side = inner(normal, rays[m])
                    low = min(low, side)
                    high = max(high, side)
            if low == 0.0 or high == 0.0:
                return False
    return True


@kernel(allocates=True)
def third_contact_friction(load: Array, points: Array, normals: Array, i: int, j: int, k: int) -> float:
    """The least friction at which contact k balances a load's moment about the line of contacts i and j.

    Not positive where it does without; infinite where the line and k's normal are such that no friction does.
    """
    along = points[j] - points[i]
    along /= math.sqrt(inner(along, along))
    arm = scratch(3)
    set_cross(along, points[k] - points[i], arm)
    moment = scratch(3)
    set_cross(points[i], load[3:], moment)
    turning = inner(along, load[:3]) - inner(along, moment)
    if turning == 0.0:
        return 0.0
    if turning > 0.0:
        arm = -arm
    n = inner(arm, normals[k])
    t = math.sqrt(max(inner(arm, arm) - n * n, 0.0))
    if n >= 0.0:
        return 0.0
    return -n / t if t > 0.0 else math.inf


@kernel(allocates=True)
def hinge_twist(load: Array, points: Array, i: int, j: int, twist: Array) -> None:
    """Sets the rotation about the line of contacts i and j that the load drives."""
    along = points[j] - points[i]
    along /= math.sqrt(inner(along, along))
    moment = scratch(3)
    set_cross(points[i], load[3:], moment)
    sign = 1.0 if inner(along, load[:3]) - inner(along, moment) > 0.0 else -1.0
    linear = scratch(3)
    set_cross(points[i], along, linear)
    for m in range(3):
        twist[m] = sign * along[m]
        twist[3 + m] = sign * linear[m]


@kernel()
def set_twist_about(angular: Array, point: Array, twist: Array) -> None:
    """Sets the twist (angular, linear at the origin) that turns about a point at rest."""
    linear = scratch(3)
    set_cross(point, angular, linear)
    for m in range(3):
        twist[m] = angular[m]
        twist[3 + m] = linear[m]


@kernel(allocates=True)
def sliding_twist(
    load: Array, mu: float, points: Array, normals: Array, i: int, j: int, k: int, along: Array, twist: Array
) -> bool:
    """Sets a motion against which, at ``mu``, no contact works and the load does not either.

    Contact i slides at the boundary of its cone under the force ``along`` it, j is at rest, and k moves within what its
    cone withstands. Returns whether there is one.
    """
    lever = points[i] - points[j]
    squared = inner(lever, lever)
    n = inner(normals[i], along)
    velocity = scratch(3)
    tangential = along - n * normals[i]
    size = math.sqrt(inner(tangential, tangential))
    if size == 0.0:
        return False
    for m in range(3):
        velocity[m] = mu * normals[i, m] - tangential[m] / size
    fixed = scratch(3)
    set_cross(lever, velocity, fixed)
    fixed /= squared
    axis = lever / math.sqrt(squared)
    arm = points[k] - points[j]
    base, slope = scratch(3), scratch(3)
    set_cross(fixed, arm, base)
    set_cross(axis, arm, slope)
    nb, ns = inner(normals[k], base), inner(normals[k], slope)
    a = ns * ns * (1.0 + mu * mu) - mu * mu * inner(slope, slope)
    b = nb * ns * (1.0 + mu * mu) - mu * mu * inner(base, slope)
    c = nb * nb * (1.0 + mu * mu) - mu * mu * inner(base, base)
    scale = math.sqrt(inner(base, base) / inner(slope, slope))
    candidates = np.array([0.0, -1e3 * scale, 1e3 * scale, 0.0, 0.0, 0.0, 0.0, 0.0])
    count = 3
    root = b * b - a * c
    if root >= 0.0 and a != 0.0:
        root = math.sqrt(root)
        # Just inside of the ends of what the cone of k withstands, on either side of them.
        for m in range(2):
            end = (-b + (2 * m - 1) * root) / a
            candidates[3 + 2 * m] = end * (1.0 - 1e-13)
            candidates[4 + 2 * m] = end * (1.0 + 1e-13)
        candidates[7] = -b / a
        count = 8
    best, found = -math.inf, 0.0
    for m in range(count):
        s = candidates[m]
        if nb + s * ns < 0.0 or a * s * s + 2.0 * b * s + c < 0.0:
            continue
        set_twist_about(fixed + s * axis, points[j], twist)
        power = 0.0
        length = 0.0
        for q in range(6):
            power += load[q] * twist[q]
            length += twist[q] * twist[q]
        power /= math.sqrt(length)
        if power > best:
            best, found = power, s
    if best == -math.inf:
        return False
    set_twist_about(fixed + found * axis, points[j], twist)
    return best >= 0.0
