"""The least friction at which contact forces can balance a load, or each other (forces, section 3).

Lengths are over the pair's nominal radius; wrenches are (moment, force) on the bolt.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch, zeros
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.statics._cone_kernel import solve_program
from threadstate.statics._family_kernel import (
    ROUND_OFF,
    deepest_forces,
    improved,
    least_pull,
    narrowed,
    newton_friction,
)
from threadstate.statics._grasp_kernel import (
    RANK_TOLERANCE,
    balancing_forces,
    contact_velocities,
    friction_of,
    internal_forces,
    least_ratio,
    least_ratio_of,
    new_grasp,
    normal_part,
    tangential_part,
    twist_of,
)
from threadstate.statics._triangle_kernel import (
    hinge_twist,
    inner,
    pair_friction,
    sectors_wedge,
    sliding_twist,
    third_contact_friction,
)

Array = NDArray[np.float64]

PULL = 1e-12
"""Contacts that would have to pull by more, over the load, cannot balance it at any friction."""
BALANCE_TOLERANCE = 1e-9
"""Part of a load (moments over r) that contact forces may leave unbalanced."""

# What became of a search: a least friction, none at any friction, or no certain answer.
FOUND, NEVER, OPEN = range(3)


@kernel(allocates=True)
def wedge_friction(points: Array, normals: Array, forces: Array, twist: Array) -> tuple[int, float, float]:
    """Bounds of the least friction at which forces at the contacts that are not all zero balance each other.

    The contacts' points and normals have shape (k, 3). ``forces`` (3 k) is filled in with such forces at the upper
    bound, their normal parts summing to 1, and ``twist`` (6) with a motion against which no forces within the cones
    at the lower bound do work; it is zero where plane sectors prove that bound.

    Returns:
        The status, the lower and the upper bound; both infinite where no friction wedges.
    """
    k = normals.shape[0]
    forces[:] = 0.0
    twist[:] = 0.0
    grasp = new_grasp(points, normals)
    d = 3 * k - grasp.rank
    if d == 0:
        return NEVER, math.inf, math.inf
    basis = internal_forces(grasp)
    sums = np.zeros(d)
    size = 0.0
    for j in range(d):
        for i in range(k):
            sums[j] += normal_part(basis[j], grasp, i)
        size += sums[j] * sums[j]
    if size <= RANK_TOLERANCE * RANK_TOLERANCE:
        return NEVER, math.inf, math.inf
    start = np.zeros(3 * k)
    for j in range(d):
        for i in range(3 * k):
            start[i] += sums[j] / size * basis[j, i]
    # Householder: the rows but the first of the reflection that takes the sums' direction to an axis.
    size = math.sqrt(size)
    sums[0] += size if sums[0] > 0.0 else -size
    norm = 0.0
    for j in range(d):
        norm += sums[j] * sums[j]
    rest = np.empty((d - 1, 3 * k))
    for i in range(3 * k):
        dot = 0.0
        for j in range(d):
            dot += sums[j] * basis[j, i]
        for j in range(1, d):
            rest[j - 1, i] = basis[j, i] - 2.0 * sums[j] * dot / norm
    solution = np.zeros((2, 3 * k))
    copy_numbers(start, solution[0])
    if d == 1:
        mu = friction_of(start, grasp)
        for i in range(3 * k):
            forces[i] = start[i]
        return (FOUND if mu < math.inf else NEVER), mu, mu
    pair = math.inf
    along = scratch(3)
    for i in range(k):
        for j in range(i):
            at_i, at_j = pair_friction(points, normals, i, j, along)
            if max(at_i, at_j) < pair:
                pair = max(at_i, at_j)
                forces[:] = 0.0
                total = inner(normals[i], along) - inner(normals[j], along)
                for m in range(3):
                    forces[3 * i + m] = along[m] / total
                    forces[3 * j + m] = -along[m] / total
    three = k == 3 and grasp.rank == 6
    if three:
        if pair < math.inf and not sectors_wedge(pair * (1.0 - ROUND_OFF), points, normals):
            return FOUND, pair * (1.0 - ROUND_OFF), pair
        if pair == math.inf and not sectors_wedge(1.0 / ROUND_OFF, points, normals):
            return NEVER, math.inf, math.inf
    mu = math.inf
    weights = np.ones(k)
    for guess in (0.5, 5.0, 50.0):
        deepest_forces(guess, weights, start, rest, grasp, solution)
        mu = friction_of(solution[0], grasp)
        if mu < math.inf:
            break
    if mu == math.inf:
        least = least_pull(start, rest, grasp, solution)
        mu = friction_of(solution[0], grasp)
        if mu == math.inf:
            return (NEVER if PULL < least < math.inf else OPEN), math.inf, math.inf
    mu = improved(mu, start, rest, grasp, solution)
    if mu < pair:
        for i in range(3 * k):
            forces[i] = solution[0, i]
    else:
        mu = pair
    found = np.empty((k, 2))
    twist_of(solution[1], grasp, twist)
    largest = contact_velocities(twist, grasp, found)
    low = least_ratio(found, largest)
    if low >= mu * (1.0 - 1e-9):
        return FOUND, min(low, mu), mu
    if three:
        # Halving between bounds of which the plane sectors are certain.
        low, high = 0.0, mu
        while high - low > ROUND_OFF * high:
            tried = 0.5 * (low + high)
            if sectors_wedge(tried, points, normals):
                high = tried
            else:
                low = tried
        deepest_forces(high, weights, start, rest, grasp, solution)
        polished = newton_friction(high, rest, grasp, solution)
        if abs(polished - high) <= 10.0 * ROUND_OFF * high:
            for i in range(3 * k):
                forces[i] = solution[0, i]
            twist_of(solution[1], grasp, twist)
        return FOUND, low, high
    none = zeros(6)
    copy_numbers(forces, solution[0])
    low, mu = narrowed(mu, none, start, rest, grasp, solution, twist)
    for i in range(3 * k):
        forces[i] = solution[0, i]
    return FOUND, low, mu


@kernel(allocates=True)
def limit_of_pairs(load: Array, points: Array, normals: Array, twist: Array) -> float:
    """The friction from which on two of three contacts wedge and the third balances what they do not.

    ``twist`` is set to a motion that may prove that no less does; to zero where there is none.
    """
    limit = math.inf
    twist[:] = 0.0
    along = scratch(3)
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        at_i, at_j = pair_friction(points, normals, i, j, along)
        pressing = max(at_i, at_j)
        if pressing == math.inf:
            continue
        turning = third_contact_friction(load, points, normals, i, j, k)
        if max(pressing, turning) < limit:
            limit = max(pressing, turning)
            twist[:] = 0.0
            if turning >= pressing:
                hinge_twist(load, points, i, j, twist)
            else:
                proved = False
                if at_i >= at_j:
                    proved = sliding_twist(load, at_i, points, normals, i, j, k, along, twist)
                else:
                    proved = sliding_twist(load, at_j, points, normals, j, i, k, -along, twist)
                if not proved:
                    twist[:] = 0.0
    return limit


@kernel(allocates=True)
def hold_friction(
    load: Array,
    points: Array,
    normals: Array,
    wedge: float,
    wedge_forces: Array,
    wedge_twist: Array,
    forces: Array,
    twist: Array,
) -> tuple[int, float, float]:
    """Bounds of the least friction at which forces at the contacts balance a load.

    The load has six numbers, the contacts' points and normals have shape (k, 3). ``wedge`` with its forces and twist
    is the upper bound that :func:`wedge_friction` gives. ``forces`` (3 k) is filled in with forces that balance the
    load at the upper bound, or, where it is only approached by ever greater forces, with those that wedge, and
    ``twist`` (6) with a motion that no contact withstands at the lower bound.

    Returns:
        The status, the lower and the upper bound; both infinite where no friction holds the load.
    """
    k = normals.shape[0]
    grasp = new_grasp(points, normals)
    size = 0.0
    for m in range(6):
        size += load[m] * load[m]
    size = math.sqrt(size)
    left = balancing_forces(load, grasp, forces)
    if left > BALANCE_TOLERANCE * size:
        for m in range(6):
            twist[m] = load[m]
            for i in range(3 * k):
                twist[m] += grasp.matrix[i, m] * forces[i]
        return NEVER, math.inf, math.inf
    d = 3 * k - grasp.rank
    if d == 0:
        mu = friction_of(forces, grasp)
        twist[:] = 0.0
        return (FOUND if mu < math.inf else NEVER), mu, mu
    basis = internal_forces(grasp)
    for i in range(3 * k):
        forces[i] /= size
    start = forces.copy()
    solution = np.empty((2, 3 * k))
    weights = np.ones(k)
    found = np.empty((k, 2))
    # Without wedging the forces are bounded; where all contacts wedge together every load is held from there on.
    if wedge < math.inf:
        power = 0.0
        for m in range(6):
            power += load[m] * wedge_twist[m]
        everywhere = True
        for i in range(k):
            if not normal_part(wedge_forces, grasp, i) > 1e-9:
                everywhere = False
        low = least_ratio_of(wedge_twist, grasp)
        if everywhere and power >= 0.0 and low >= wedge * (1.0 - 10.0 * ROUND_OFF):
            for m in range(6):
                twist[m] = wedge_twist[m]
            for i in range(3 * k):
                forces[i] = wedge_forces[i]
            return FOUND, min(low, wedge), wedge
    limit = wedge
    if k == 3 and grasp.rank == 6 and wedge < math.inf:
        limit = limit_of_pairs(load, points, normals, twist)
        if everywhere:
            limit = min(limit, wedge)
    mu = math.inf
    below = min(limit, 1e3)
    for part in (0.25, 0.9, 0.999, 0.999999):
        deepest_forces(part * below, weights, start, basis, grasp, solution)
        mu = friction_of(solution[0], grasp)
        if mu < math.inf:
            break
    if k == 3 and grasp.rank == 6 and not mu < limit and limit < math.inf:
        low = least_ratio_of(twist, grasp)
        if low >= limit * (1.0 - ROUND_OFF):
            return FOUND, min(low, limit), limit
        # No program below the limit found forces, and no motion proves that there are none.
        copy_numbers(wedge_forces, solution[0])
        low, mu = narrowed(limit, load / size, start, basis, grasp, solution, twist)
        for i in range(3 * k):
            forces[i] = solution[0, i] * size
        return FOUND, low, mu
    if mu == math.inf and wedge < math.inf:
        for part in (1.00001, 2.0, 100.0):
            deepest_forces(part * below, weights, start, basis, grasp, solution)
            mu = friction_of(solution[0], grasp)
            if mu < math.inf:
                break
    if mu == math.inf:
        least = least_pull(start, basis, grasp, solution)
        mu = friction_of(solution[0], grasp)
        if mu == math.inf:
            twist_of(solution[1], grasp, twist)
            return (NEVER if PULL < least < math.inf else OPEN), math.inf, math.inf
    mu = improved(mu, start, basis, grasp, solution)
    for i in range(3 * k):
        forces[i] = solution[0, i] * size
    twist_of(solution[1], grasp, twist)
    largest = contact_velocities(twist, grasp, found)
    low = least_ratio(found, largest)
    power = 0.0
    for m in range(6):
        power += load[m] * twist[m]
    if low >= mu * (1.0 - 1e-9) and power >= -1e-12 * size * largest:
        return FOUND, min(low, mu), mu
    low, mu = narrowed(mu, load / size, start, basis, grasp, solution, twist)
    for i in range(3 * k):
        forces[i] = solution[0, i] * size
    return FOUND, low, mu


@kernel(allocates=True)
def least_forces(load: Array, mu: float, points: Array, normals: Array, forces: Array) -> float:
    """Forces within the cones at ``mu`` that balance a load, of least largest normal part, into ``forces`` (3 k).

    Returns:
        The least friction that they need; infinite if none were found.
    """
    k = normals.shape[0]
    grasp = new_grasp(points, normals)
    size = 0.0
    for m in range(6):
        size += load[m] * load[m]
    size = math.sqrt(size)
    left = balancing_forces(load / size, grasp, forces)
    if left > BALANCE_TOLERANCE:
        return math.inf
    d = 3 * k - grasp.rank
    basis = internal_forces(grasp)
    if d > 0:
        c = np.zeros(d + 1)
        c[d] = 1.0
        g = np.zeros((4 * k, d + 1))
        h = np.zeros(4 * k)
        sizes = np.ones(2 * k, np.intp)
        x = np.zeros(d + 1)
        z = np.zeros(4 * k)
        for i in range(k):
            sizes[i] = 3
            n = normal_part(forces, grasp, i)
            h[3 * i] = mu * n
            h[3 * i + 1], h[3 * i + 2] = tangential_part(forces, grasp, i)
            h[3 * k + i] = -n
            g[3 * k + i, d] = -1.0
            for j in range(d):
                n = normal_part(basis[j], grasp, i)
                a, b = tangential_part(basis[j], grasp, i)
                g[3 * i, j] = -mu * n
                g[3 * i + 1, j] = -a
                g[3 * i + 2, j] = -b
                g[3 * k + i, j] = n
        solve_program(c, g, h, sizes, x, z)
        for j in range(d):
            for i in range(3 * k):
                forces[i] += x[j] * basis[j, i]
    needed = friction_of(forces, grasp)
    for i in range(3 * k):
        forces[i] *= size
    return needed
