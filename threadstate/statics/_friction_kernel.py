"""The least friction at which contact forces can balance a load, or each other (forces, section 3).

All forces that balance a load are an affine family: one of them, and the internal forces, which balance each other. Over
that family the largest ratio of a contact's tangential to its normal force is quasi-convex. It is minimised by
Dinkelbach's iteration for ratios, whose steps are second-order cone programs.

Lengths are over the pair's nominal radius, so that moments and forces are of one kind; wrenches are (moment, force).
Forces act on the bolt.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.statics._cone_kernel import solve_program
from threadstate.statics._triangle_kernel import (
    inner,
    hinge_twist,
    pair_friction,
    sectors_wedge,
    sliding_twist,
    third_contact_friction,
)

Array = NDArray[np.float64]

RANK_TOLERANCE = 1e-10
"""Relative size below which a direction of the contacts' wrenches is none."""
FORCE_LIMIT = 1e6
"""Contact forces beyond this multiple of the load are not considered."""
MOST_ROUNDS = 40
ROUND_OFF = 1e-12
"""Relative width that is left between bounds which closed forms decide."""


@kernel()
def set_frames(normals: Array, frames: Array) -> None:
    """Two unit vectors across each normal; normals of shape (k, 3), frames of shape (k, 2, 3)."""
    for i in range(normals.shape[0]):
        x, y, z = normals[i, 0], normals[i, 1], normals[i, 2]
        # The axis farthest from the normal.
        least = min(abs(x), abs(y), abs(z))
        ax, ay, az = 0.0, 0.0, 0.0
        if abs(z) == least:
            az = 1.0
        elif abs(y) == least:
            ay = 1.0
        else:
            ax = 1.0
        dot = ax * x + ay * y + az * z
        ax -= dot * x
        ay -= dot * y
        az -= dot * z
        size = math.sqrt(ax * ax + ay * ay + az * az)
        ax /= size
        ay /= size
        az /= size
        frames[i, 0, 0], frames[i, 0, 1], frames[i, 0, 2] = ax, ay, az
        frames[i, 1, 0] = y * az - z * ay
        frames[i, 1, 1] = z * ax - x * az
        frames[i, 1, 2] = x * ay - y * ax


@kernel()
def set_grasp(points: Array, grasp: Array) -> None:
    """The transposed grasp matrix: row 3 i + j is the wrench of a unit force along axis j at point i; (3 k, 6)."""
    for i in range(points.shape[0]):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        for j in range(3):
            for m in range(6):
                grasp[3 * i + j, m] = 0.0
            grasp[3 * i + j, 3 + j] = 1.0
        grasp[3 * i, 1], grasp[3 * i, 2] = z, -y
        grasp[3 * i + 1, 0], grasp[3 * i + 1, 2] = -z, x
        grasp[3 * i + 2, 0], grasp[3 * i + 2, 1] = y, -x


@kernel()
def orthogonal_factor(grasp: Array, reflections: Array, upper: Array, order: NDArray[np.intp]) -> int:
    """Householder's QR of the transposed grasp matrix, columns by size: ``grasp[:, order] = Q R``; its rank.

    ``reflections`` (6, 3 k) are Q's unit vectors; ``upper`` (6, 6) is R.
    """
    rows = grasp.shape[0]
    left = grasp.copy()
    for j in range(6):
        order[j] = j
    largest = 0.0
    upper[:, :] = 0.0
    for j in range(min(6, rows)):
        best, at = -1.0, j
        for m in range(j, 6):
            size = 0.0
            for i in range(j, rows):
                size += left[i, m] * left[i, m]
            if size > best:
                best, at = size, m
        if at != j:
            for i in range(rows):
                left[i, j], left[i, at] = left[i, at], left[i, j]
            order[j], order[at] = order[at], order[j]
        size = math.sqrt(best)
        if j == 0:
            largest = size
        if size <= RANK_TOLERANCE * largest:
            for m in range(j, 6):
                for i in range(j):
                    upper[i, m] = left[i, m]
            return j
        sign = -1.0 if left[j, j] > 0.0 else 1.0
        norm = 0.0
        for i in range(rows):
            reflections[j, i] = left[i, j] if i >= j else 0.0
        reflections[j, j] -= sign * size
        for i in range(j, rows):
            norm += reflections[j, i] * reflections[j, i]
        norm = math.sqrt(norm)
        for i in range(j, rows):
            reflections[j, i] /= norm
        for m in range(j, 6):
            dot = 0.0
            for i in range(j, rows):
                dot += reflections[j, i] * left[i, m]
            for i in range(j, rows):
                left[i, m] -= 2.0 * dot * reflections[j, i]
        for m in range(j, 6):
            upper[j, m] = left[j, m]
        for i in range(j):
            upper[i, j] = left[i, j]
    for m in range(6):
        for i in range(min(m + 1, rows)):
            upper[i, m] = left[i, m]
    return min(6, rows)


@kernel()
def reflect(reflections: Array, rank: int, vector: Array) -> None:
    """Multiplies by Q, in place."""
    for j in range(rank - 1, -1, -1):
        dot = 0.0
        for i in range(j, vector.shape[0]):
            dot += reflections[j, i] * vector[i]
        for i in range(j, vector.shape[0]):
            vector[i] -= 2.0 * dot * reflections[j, i]


@kernel()
def balancing_forces(
    load: Array, grasp: Array, reflections: Array, upper: Array, order: NDArray[np.intp], rank: int, forces: Array
) -> float:
    """The forces (3 k) of least norm whose wrenches sum to ``-load``, as far as any do; the norm of what is left over."""
    forces[:] = 0.0
    # grasp' f = -load, grasp[:, order] = Q R: solve R' u = -load[order], f = Q u.
    for j in range(rank):
        total = -load[order[j]]
        for i in range(j):
            total -= upper[i, j] * forces[i]
        forces[j] = total / upper[j, j]
    reflect(reflections, rank, forces)
    left = 0.0
    for m in range(6):
        total = load[m]
        for i in range(grasp.shape[0]):
            total += grasp[i, m] * forces[i]
        left += total * total
    return math.sqrt(left)


@kernel()
def set_internal_forces(reflections: Array, rank: int, basis: Array) -> None:
    """An orthonormal basis of the forces that balance each other: the last columns of Q, as rows of (3 k - rank, 3 k)."""
    for j in range(basis.shape[0]):
        for i in range(basis.shape[1]):
            basis[j, i] = 0.0
        basis[j, rank + j] = 1.0
        reflect(reflections, rank, basis[j])


@kernel()
def normal_part(forces: Array, normals: Array, i: int) -> float:
    """The normal force of contact i."""
    return forces[3 * i] * normals[i, 0] + forces[3 * i + 1] * normals[i, 1] + forces[3 * i + 2] * normals[i, 2]


@kernel()
def tangential_part(forces: Array, frames: Array, i: int) -> tuple[float, float]:
    """The tangential force of contact i in its frame."""
    return (
        forces[3 * i] * frames[i, 0, 0] + forces[3 * i + 1] * frames[i, 0, 1] + forces[3 * i + 2] * frames[i, 0, 2],
        forces[3 * i] * frames[i, 1, 0] + forces[3 * i + 1] * frames[i, 1, 1] + forces[3 * i + 2] * frames[i, 1, 2],
    )


@kernel()
def friction_of(forces: Array, normals: Array, frames: Array) -> float:
    """The least friction that every contact force needs; infinite if one of them pulls.

    A force smaller than 1e-14 of the largest counts as none.
    """
    largest = 0.0
    for i in range(forces.shape[0]):
        largest = max(largest, abs(forces[i]))
    worst = 0.0
    for i in range(normals.shape[0]):
        n = normal_part(forces, normals, i)
        a, b = tangential_part(forces, frames, i)
        t = math.hypot(a, b)
        if t <= 1e-14 * largest and n >= -1e-14 * largest:
            continue
        if not (n > 0.0 and t < math.inf):
            return math.inf
        worst = max(worst, t / n)
    return worst


@kernel()
def friction_program(
    mu: float, weights: Array, start: Array, basis: Array, normals: Array, frames: Array, limit: float, solution: Array
) -> float:
    """Finds the forces of the family that are deepest in their cones at ``mu``, and the twist that says so.

    Minimises s with ``|t_i| <= mu N_i + s weights_i`` and the sum of the N_i at most ``limit``, over the family
    ``start + y basis``.

    Args:
        solution: shape (2, 3 k), filled in with the forces and with the multipliers: velocities of the contacts.

    Returns:
        s: forces within the cones exist where it is not positive; infinite if the program could not be solved.
    """
    k = normals.shape[0]
    d = basis.shape[0]
    m = 3 * k + 1
    c = np.zeros(d + 1)
    c[d] = 1.0
    g = np.zeros((m, d + 1))
    h = np.zeros(m)
    sizes = np.empty(k + 1, np.intp)
    x = np.zeros(d + 1)
    z = np.zeros(m)
    h[m - 1] = 1.0
    sizes[k] = 1
    per = 1.0 / limit
    for i in range(k):
        sizes[i] = 3
        n = normal_part(start, normals, i)
        h[3 * i] = mu * n
        h[3 * i + 1], h[3 * i + 2] = tangential_part(start, frames, i)
        g[3 * i, d] = -weights[i]
        h[m - 1] -= n * per
        for j in range(d):
            n = normal_part(basis[j], normals, i)
            a, b = tangential_part(basis[j], frames, i)
            g[3 * i, j] = -mu * n
            g[3 * i + 1, j] = -a
            g[3 * i + 2, j] = -b
            g[m - 1, j] += n * per
    gap = solve_program(c, g, h, sizes, x, z)
    for i in range(3 * k):
        total = start[i]
        for j in range(d):
            total += x[j] * basis[j, i]
        solution[0, i] = total
    for i in range(k):
        for j in range(3):
            solution[1, 3 * i + j] = (
                mu * z[3 * i] * normals[i, j] + z[3 * i + 1] * frames[i, 0, j] + z[3 * i + 2] * frames[i, 1, j]
            )
    return x[d] if gap < math.inf else math.inf


@kernel()
def twist_of(
    velocities: Array, reflections: Array, upper: Array, order: NDArray[np.intp], rank: int, twist: Array
) -> None:
    """The twist (angular, linear at the origin) that gives the contacts these velocities (3 k), by least squares."""
    moved = velocities.copy()
    for j in range(rank):
        dot = 0.0
        for i in range(j, moved.shape[0]):
            dot += reflections[j, i] * moved[i]
        for i in range(j, moved.shape[0]):
            moved[i] -= 2.0 * dot * reflections[j, i]
    twist[:] = 0.0
    for j in range(rank - 1, -1, -1):
        total = moved[j]
        for m in range(j + 1, rank):
            total -= upper[j, m] * twist[order[m]]
        twist[order[j]] = total / upper[j, j]


@kernel()
def withstands(twist: Array, mu: float, load: Array, grasp: Array, normals: Array, frames: Array) -> float:
    """How large contact forces at ``mu`` must be, over the load, to withstand a motion that the load drives.

    Along the twist the load does work and contact forces within their cones do none against it but for round-off: infinite
    where they do none at all. Not positive where the load does not drive the motion.
    """
    power = 0.0
    size = 0.0
    for m in range(6):
        power += load[m] * twist[m]
        size += load[m] * load[m]
    worst = 0.0
    for i in range(normals.shape[0]):
        velocity = np.zeros(3)
        for j in range(3):
            for m in range(6):
                velocity[j] += grasp[3 * i + j, m] * twist[m]
        n, a, b = 0.0, 0.0, 0.0
        for j in range(3):
            n += velocity[j] * normals[i, j]
            a += velocity[j] * frames[i, 0, j]
            b += velocity[j] * frames[i, 1, j]
        worst = max(worst, mu * math.hypot(a, b) - n)
    if power <= 0.0:
        return power
    return power / (worst * math.sqrt(size)) if worst > 0.0 else math.inf


BALANCE_TOLERANCE = 1e-9
"""Part of a load (moments over r) that contact forces may leave unbalanced."""

LEAST_WEIGHT = 1e-3
SLIDING = 1e-7
"""Contacts slide whose velocity is more than this part of the largest one's."""
REGULAR = 1e-11
"""Added to the diagonal of Newton's equations: forces that no sliding contact feels stay as they are."""

# What became of a search: a least friction, none at any friction, or no certain answer.
FOUND, NEVER, OPEN = range(3)


@kernel()
def solve_dense(matrix: Array, right: Array) -> bool:
    """Solves linear equations in place by elimination with pivots; False where they are singular."""
    n = right.shape[0]
    for j in range(n):
        at = j
        for i in range(j + 1, n):
            if abs(matrix[i, j]) > abs(matrix[at, j]):
                at = i
        if abs(matrix[at, j]) < 1e-300:
            return False
        if at != j:
            for m in range(j, n):
                matrix[j, m], matrix[at, m] = matrix[at, m], matrix[j, m]
            right[j], right[at] = right[at], right[j]
        for i in range(j + 1, n):
            by = matrix[i, j] / matrix[j, j]
            if by != 0.0:
                for m in range(j + 1, n):
                    matrix[i, m] -= by * matrix[j, m]
                right[i] -= by * right[j]
    for j in range(n - 1, -1, -1):
        for m in range(j + 1, n):
            right[j] -= matrix[j, m] * right[m]
        right[j] /= matrix[j, j]
    return True


@kernel()
def polish(mu: float, basis: Array, normals: Array, frames: Array, solution: Array) -> float:
    """Newton's method on the conditions of a least friction, from forces near them; the friction it comes to.

    The sliding contacts i satisfy ``|t_i| = mu N_i``, and with multipliers that sum to 1 the velocities
    ``multiplier_i (mu n_i - t_i / |t_i|)`` do no work on internal forces. ``solution`` has the forces, and the velocities,
    of which only those of sliding contacts are not zero.
    """
    k = normals.shape[0]
    d = basis.shape[0]
    sliding = np.empty(k, np.intp)
    count = 0
    largest = 0.0
    for i in range(k):
        largest = max(largest, normal_part(solution[1], normals, i))
    for i in range(k):
        if normal_part(solution[1], normals, i) > SLIDING * largest:
            sliding[count] = i
            count += 1
    size = d + count + 1
    matrix = np.empty((size, size))
    right = np.empty(size)
    multipliers = np.zeros(count)
    total = 0.0
    for m in range(count):
        i = sliding[m]
        for j in range(3):
            multipliers[m] += solution[1, 3 * i + j] * normals[i, j]
        multipliers[m] = max(multipliers[m], 0.0)
        total += multipliers[m]
    if not total > 0.0:
        return math.inf
    for m in range(count):
        multipliers[m] /= total
    across = np.empty((count, 2))
    for _ in range(8):
        matrix[:, :] = 0.0
        right[:] = 0.0
        for m in range(count):
            i = sliding[m]
            a, b = tangential_part(solution[0], frames, i)
            n = normal_part(solution[0], normals, i)
            t = math.hypot(a, b)
            across[m, 0], across[m, 1] = a / t, b / t
            right[d + m] = mu * n - t
            matrix[d + m, size - 1] = -n
            matrix[size - 1, d + m] = 1.0
            for j in range(d):
                nj = normal_part(basis[j], normals, i)
                aj, bj = tangential_part(basis[j], frames, i)
                along = (a * aj + b * bj) / t
                matrix[d + m, j] = along - mu * nj
                matrix[j, d + m] = along - mu * nj
                matrix[j, size - 1] -= multipliers[m] * nj
                right[j] -= multipliers[m] * (along - mu * nj)
                for l in range(d):
                    al, bl = tangential_part(basis[l], frames, i)
                    matrix[j, l] += multipliers[m] * (aj * al + bj * bl - along * (a * al + b * bl) / t) / t
        right[size - 1] = 1.0
        for j in range(d):
            matrix[j, j] += REGULAR
        for m in range(count):
            right[size - 1] -= multipliers[m]
        if not solve_dense(matrix, right):
            return math.inf
        change = 0.0
        for i in range(3 * k):
            for j in range(d):
                solution[0, i] += right[j] * basis[j, i]
        for m in range(count):
            multipliers[m] += right[d + m]
            change = max(change, abs(right[d + m]))
        mu += right[size - 1]
        change = max(change, abs(right[size - 1]) / max(mu, 1e-3))
        if not change < 1.0:
            return math.inf
        if change < 1e-15:
            break
    for i in range(3 * k):
        solution[1, i] = 0.0
    for m in range(count):
        if multipliers[m] < 0.0:
            return math.inf
        i = sliding[m]
        a, b = tangential_part(solution[0], frames, i)
        t = math.hypot(a, b)
        for j in range(3):
            solution[1, 3 * i + j] = multipliers[m] * (
                mu * normals[i, j] - (a * frames[i, 0, j] + b * frames[i, 1, j]) / t
            )
    return mu


@kernel()
def improved(
    mu: float, start: Array, basis: Array, normals: Array, frames: Array, limit: float, solution: Array
) -> float:
    """The least friction in the family ``start + y basis`` by Dinkelbach's iteration, from forces that ``mu`` suffices for.

    ``solution`` has those forces at first, then those of the least friction and the velocities that go with them.
    """
    k = normals.shape[0]
    weights = np.empty(k)
    best = solution.copy()
    for _ in range(MOST_ROUNDS):
        largest = 0.0
        for i in range(k):
            weights[i] = normal_part(best[0], normals, i)
            largest = max(largest, weights[i])
        for i in range(k):
            weights[i] = max(weights[i] / largest, LEAST_WEIGHT)
        friction_program(mu, weights, start, basis, normals, frames, limit, solution)
        lower = friction_of(solution[0], normals, frames)
        if not lower < mu:
            weights[:] = 1.0
            friction_program(mu, weights, start, basis, normals, frames, limit, solution)
            lower = friction_of(solution[0], normals, frames)
            if not lower < mu:
                break
        best[:, :] = solution
        near = lower > mu * (1.0 - 1e-6)
        mu = lower
        if near:
            polished = polish(mu, basis, normals, frames, solution)
            if polished < math.inf:
                lower = friction_of(solution[0], normals, frames)
                if lower <= mu * (1.0 + 1e-13):
                    return lower
            if mu - lower < 1e-12 * mu:
                break
    solution[:, :] = best
    return mu


@kernel()
def contact_velocities(twist: Array, grasp: Array, normals: Array, frames: Array, found: Array) -> float:
    """Normal and tangential velocity of every contact, into ``found`` (k, 2); the largest of them."""
    largest = 0.0
    for i in range(normals.shape[0]):
        n, a, b = 0.0, 0.0, 0.0
        for j in range(3):
            velocity = 0.0
            for m in range(6):
                velocity += grasp[3 * i + j, m] * twist[m]
            n += velocity * normals[i, j]
            a += velocity * frames[i, 0, j]
            b += velocity * frames[i, 1, j]
        found[i, 0] = n
        found[i, 1] = math.hypot(a, b)
        largest = max(largest, abs(n), found[i, 1])
    return largest


@kernel()
def least_ratio(found: Array, largest: float) -> float:
    """The least ratio of normal to tangential velocity of contacts that move; friction below it does no work against them.

    Velocities below 1e-12 of the largest count as none.
    """
    least = math.inf
    for i in range(found.shape[0]):
        if abs(found[i, 0]) + found[i, 1] <= 1e-12 * largest:
            continue
        if found[i, 1] > 0.0:
            least = min(least, found[i, 0] / found[i, 1])
        elif found[i, 0] < 0.0:
            return -math.inf
    return least


@kernel()
def narrowed(
    mu: float,
    load: Array,
    start: Array,
    basis: Array,
    normals: Array,
    frames: Array,
    grasp: Array,
    reflections: Array,
    upper: Array,
    order: NDArray[np.intp],
    rank: int,
    solution: Array,
    twist: Array,
) -> tuple[float, float]:
    """Bounds of a least friction that the iteration for ratios did not settle, by programs at frictions below ``mu``.

    Each gives forces that need less than ``mu``, or a twist that proves that less than it does not do, or ends the search.

    Args:
        load: of norm 1, zero where forces that balance each other are sought.
        solution: has forces that need ``mu`` at first, then those of the upper bound.
    """
    k = normals.shape[0]
    weights = np.ones(k)
    tried_solution = solution.copy()
    found = np.empty((k, 2))
    wedging = True
    for m in range(6):
        if load[m] != 0.0:
            wedging = False
    low = 0.0
    part = 1e-9
    for _ in range(MOST_ROUNDS):
        if mu - low <= 1e-9 * mu:
            break
        tried = mu * (1.0 - part) if low == 0.0 else 0.5 * (low + mu)
        friction_program(tried, weights, start, basis, normals, frames, FORCE_LIMIT, tried_solution)
        lower = friction_of(tried_solution[0], normals, frames)
        if lower < mu * (1.0 - ROUND_OFF):
            mu = lower
            solution[:, :] = tried_solution
            continue
        if wedging:
            work = 0.0
            for i in range(3 * k):
                work += start[i] * tried_solution[1, i]
            for i in range(k):
                for j in range(3):
                    tried_solution[1, 3 * i + j] -= work * normals[i, j]
        twist_of(tried_solution[1], reflections, upper, order, rank, twist)
        if wedging:
            contact_velocities(twist, grasp, normals, frames, found)
            proved = least_ratio(found, 0.0) >= tried
        else:
            proved = withstands(twist, tried, load, grasp, normals, frames) >= FORCE_LIMIT
        if proved:
            low = tried
        elif low > 0.0 or part >= 0.1:
            break
        else:
            part *= 10.0
    tried_solution[:, :] = solution
    if low < mu * (1.0 - 1e-9) and polish(mu, basis, normals, frames, tried_solution) < math.inf:
        lower = friction_of(tried_solution[0], normals, frames)
        if lower <= mu * (1.0 + ROUND_OFF):
            mu = min(mu, lower)
            solution[:, :] = tried_solution
            twist_of(solution[1], reflections, upper, order, rank, twist)
            power = 0.0
            for m in range(6):
                power += load[m] * twist[m]
            largest = contact_velocities(twist, grasp, normals, frames, found)
            if power >= -ROUND_OFF * largest:
                low = max(low, min(mu, least_ratio(found, largest)))
    return low, mu


@kernel()
def wedge_friction(points: Array, normals: Array, forces: Array, twist: Array) -> tuple[int, float, float]:
    """Bounds of the least friction at which forces at the contacts that are not all zero balance each other.

    Args:
        points, normals: shape (k, 3).
        forces: shape (3 k), filled in with such forces at the upper bound; their normal parts sum to 1.
        twist: shape (6), filled in with a motion against which no force within the cones at the lower bound does work.

    Returns:
        The status, the lower and the upper bound; both infinite where no friction wedges.
    """
    k = normals.shape[0]
    forces[:] = 0.0
    twist[:] = 0.0
    frames = np.empty((k, 2, 3))
    set_frames(normals, frames)
    grasp = np.empty((3 * k, 6))
    set_grasp(points, grasp)
    reflections = np.zeros((6, 3 * k))
    upper = np.zeros((6, 6))
    order = np.empty(6, np.intp)
    rank = orthogonal_factor(grasp, reflections, upper, order)
    d = 3 * k - rank
    if d == 0:
        return NEVER, math.inf, math.inf
    basis = np.empty((d, 3 * k))
    set_internal_forces(reflections, rank, basis)
    sums = np.zeros(d)
    size = 0.0
    for j in range(d):
        for i in range(k):
            sums[j] += normal_part(basis[j], normals, i)
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
    solution[0] = start
    if d == 1:
        mu = friction_of(start, normals, frames)
        for i in range(3 * k):
            forces[i] = start[i]
        return (FOUND if mu < math.inf else NEVER), mu, mu
    pair = math.inf
    along = np.empty(3)
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
    three = k == 3 and rank == 6
    if three:
        if pair < math.inf and not sectors_wedge(pair * (1.0 - ROUND_OFF), points, normals):
            return FOUND, pair * (1.0 - ROUND_OFF), pair
        if pair == math.inf and not sectors_wedge(1.0 / ROUND_OFF, points, normals):
            return NEVER, math.inf, math.inf
    mu = math.inf
    weights = np.ones(k)
    for guess in (0.5, 5.0, 50.0):
        friction_program(guess, weights, start, rest, normals, frames, FORCE_LIMIT, solution)
        mu = friction_of(solution[0], normals, frames)
        if mu < math.inf:
            break
    if mu == math.inf:
        least = friction_program(1.0, weights, start, rest, normals, np.zeros_like(frames), FORCE_LIMIT, solution)
        mu = friction_of(solution[0], normals, frames)
        if mu == math.inf:
            return (NEVER if least > 1e-12 else OPEN), math.inf, math.inf
    mu = improved(mu, start, rest, normals, frames, FORCE_LIMIT, solution)
    if mu < pair:
        for i in range(3 * k):
            forces[i] = solution[0, i]
    else:
        mu = pair
    found = np.empty((k, 2))
    twist_of(solution[1], reflections, upper, order, rank, twist)
    largest = contact_velocities(twist, grasp, normals, frames, found)
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
        friction_program(high, weights, start, rest, normals, frames, FORCE_LIMIT, solution)
        polished = polish(high, rest, normals, frames, solution)
        if abs(polished - high) <= 10.0 * ROUND_OFF * high:
            for i in range(3 * k):
                forces[i] = solution[0, i]
            twist_of(solution[1], reflections, upper, order, rank, twist)
        return FOUND, low, high
    none = np.zeros(6)
    solution[0] = forces
    low, mu = narrowed(mu, none, start, rest, normals, frames, grasp, reflections, upper, order, rank, solution, twist)
    for i in range(3 * k):
        forces[i] = solution[0, i]
    return FOUND, low, mu


@kernel()
def least_ratio_of(twist: Array, grasp: Array, normals: Array, frames: Array) -> float:
    """As :func:`least_ratio`, of a twist; minus infinity if it is zero."""
    found = np.empty((normals.shape[0], 2))
    largest = contact_velocities(twist, grasp, normals, frames, found)
    return least_ratio(found, largest) if largest > 0.0 else -math.inf


@kernel()
def limit_of_pairs(load: Array, points: Array, normals: Array, twist: Array) -> float:
    """The friction from which on two of three contacts press against each other and the third balances what they do not.

    ``twist`` is set to a motion that may prove that no less does; to zero where there is none.
    """
    limit = math.inf
    twist[:] = 0.0
    along = np.empty(3)
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


@kernel()
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

    Args:
        load: the wrench (6) on the bolt.
        points, normals: shape (k, 3).
        wedge, wedge_forces, wedge_twist: the least friction that wedges (infinite if none does), its forces and its twist.
        forces: shape (3 k), filled in with forces that balance the load at the upper bound, or, where that is approached
            only, with ever greater forces, with the forces that wedge.
        twist: shape (6), filled in with a motion that no contact withstands at the lower bound.

    Returns:
        The status, the lower and the upper bound; both infinite where no friction holds the load.
    """
    k = normals.shape[0]
    frames = np.empty((k, 2, 3))
    set_frames(normals, frames)
    grasp = np.empty((3 * k, 6))
    set_grasp(points, grasp)
    reflections = np.zeros((6, 3 * k))
    upper = np.zeros((6, 6))
    order = np.empty(6, np.intp)
    rank = orthogonal_factor(grasp, reflections, upper, order)
    size = 0.0
    for m in range(6):
        size += load[m] * load[m]
    size = math.sqrt(size)
    left = balancing_forces(load, grasp, reflections, upper, order, rank, forces)
    if left > BALANCE_TOLERANCE * size:
        for m in range(6):
            twist[m] = load[m]
            for i in range(3 * k):
                twist[m] += grasp[i, m] * forces[i]
        return NEVER, math.inf, math.inf
    d = 3 * k - rank
    if d == 0:
        mu = friction_of(forces, normals, frames)
        twist[:] = 0.0
        return (FOUND if mu < math.inf else NEVER), mu, mu
    basis = np.empty((d, 3 * k))
    set_internal_forces(reflections, rank, basis)
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
            if not normal_part(wedge_forces, normals, i) > 1e-9:
                everywhere = False
        low = least_ratio_of(wedge_twist, grasp, normals, frames)
        if everywhere and power >= 0.0 and low >= wedge * (1.0 - 10.0 * ROUND_OFF):
            for m in range(6):
                twist[m] = wedge_twist[m]
            for i in range(3 * k):
                forces[i] = wedge_forces[i]
            return FOUND, min(low, wedge), wedge
    limit = wedge
    if k == 3 and rank == 6 and wedge < math.inf:
        limit = limit_of_pairs(load, points, normals, twist)
        if everywhere:
            limit = min(limit, wedge)
    mu = math.inf
    below = min(limit, 1e3)
    for part in (0.25, 0.9, 0.999, 0.999999):
        friction_program(part * below, weights, start, basis, normals, frames, FORCE_LIMIT, solution)
        mu = friction_of(solution[0], normals, frames)
        if mu < math.inf:
            break
    if k == 3 and rank == 6 and not mu < limit and limit < math.inf:
        low = least_ratio_of(twist, grasp, normals, frames)
        if low >= limit * (1.0 - ROUND_OFF):
            return FOUND, min(low, limit), limit
        # No program below the limit found forces, and no motion proves that there are none.
        solution[0] = wedge_forces
        low, mu = narrowed(
            limit, load / size, start, basis, normals, frames, grasp, reflections, upper, order, rank, solution, twist
        )
        for i in range(3 * k):
            forces[i] = solution[0, i] * size
        return FOUND, low, mu
    if mu == math.inf and wedge < math.inf:
        for part in (1.00001, 2.0, 100.0):
            friction_program(part * below, weights, start, basis, normals, frames, FORCE_LIMIT, solution)
            mu = friction_of(solution[0], normals, frames)
            if mu < math.inf:
                break
    if mu == math.inf:
        least = friction_program(1.0, weights, start, basis, normals, np.zeros_like(frames), FORCE_LIMIT, solution)
        mu = friction_of(solution[0], normals, frames)
        if mu == math.inf:
            twist_of(solution[1], reflections, upper, order, rank, twist)
            return (NEVER if least > 0.0 else OPEN), math.inf, math.inf
    mu = improved(mu, start, basis, normals, frames, FORCE_LIMIT, solution)
    for i in range(3 * k):
        forces[i] = solution[0, i] * size
    twist_of(solution[1], reflections, upper, order, rank, twist)
    largest = contact_velocities(twist, grasp, normals, frames, found)
    low = least_ratio(found, largest)
    power = 0.0
    for m in range(6):
        power += load[m] * twist[m]
    if low >= mu * (1.0 - 1e-9) and power >= -1e-12 * size * largest:
        return FOUND, min(low, mu), mu
    low, mu = narrowed(
        mu, load / size, start, basis, normals, frames, grasp, reflections, upper, order, rank, solution, twist
    )
    for i in range(3 * k):
        forces[i] = solution[0, i] * size
    return FOUND, low, mu


@kernel()
def least_forces(load: Array, mu: float, points: Array, normals: Array, forces: Array) -> float:
    """Forces within the cones at ``mu`` that balance a load, of least largest normal part, into ``forces`` (3 k).

    Returns:
        The least friction that they need; infinite if none were found.
    """
    k = normals.shape[0]
    frames = np.empty((k, 2, 3))
    set_frames(normals, frames)
    grasp = np.empty((3 * k, 6))
    set_grasp(points, grasp)
    reflections = np.zeros((6, 3 * k))
    upper = np.zeros((6, 6))
    order = np.empty(6, np.intp)
    rank = orthogonal_factor(grasp, reflections, upper, order)
    size = 0.0
    for m in range(6):
        size += load[m] * load[m]
    size = math.sqrt(size)
    left = balancing_forces(load / size, grasp, reflections, upper, order, rank, forces)
    if left > BALANCE_TOLERANCE:
        return math.inf
    d = 3 * k - rank
    basis = np.empty((d, 3 * k))
    set_internal_forces(reflections, rank, basis)
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
            n = normal_part(forces, normals, i)
            h[3 * i] = mu * n
            h[3 * i + 1], h[3 * i + 2] = tangential_part(forces, frames, i)
            h[3 * k + i] = -n
            g[3 * k + i, d] = -1.0
            for j in range(d):
                n = normal_part(basis[j], normals, i)
                a, b = tangential_part(basis[j], frames, i)
                g[3 * i, j] = -mu * n
                g[3 * i + 1, j] = -a
                g[3 * i + 2, j] = -b
                g[3 * k + i, j] = n
        solve_program(c, g, h, sizes, x, z)
        for j in range(d):
            for i in range(3 * k):
                forces[i] += x[j] * basis[j, i]
    needed = friction_of(forces, normals, frames)
    for i in range(3 * k):
        forces[i] *= size
    return needed
