"""The least friction of an affine family of contact forces.

All forces that balance a load are one of them plus the internal forces, which balance each other. Over such a family
``start + y basis`` the largest ratio of a contact's tangential to its normal force is quasi-convex. It is minimised by
Dinkelbach's iteration for ratios, whose steps are second-order cone programs, and by Newton's method at the end.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.statics._cone_kernel import solve_program
from threadstate.statics._grasp_kernel import (
    RANK_TOLERANCE,
    Grasp,
    contact_velocities,
    friction_of,
    least_ratio,
    normal_part,
    tangential_part,
    twist_of,
    withstands,
)

Array = NDArray[np.float64]

FORCE_LIMIT = 1e6
"""Contact forces beyond this multiple of the load are not considered."""
MOST_ROUNDS = 40
ROUND_OFF = 1e-12
"""Relative width that is left between bounds which closed forms decide."""
LEAST_WEIGHT = 1e-3
SLIDING = 1e-7
"""Contacts slide whose velocity is more than this part of the largest one's."""
REGULAR = 1e-11
"""Added to the diagonal of Newton's equations: forces that no sliding contact feels stay as they are."""


@kernel(allocates=True)
def deepest_forces(mu: float, weights: Array, start: Array, basis: Array, grasp: Grasp, solution: Array) -> float:
    """Finds the forces of the family that are deepest in their cones at ``mu``, and the twist that says so.

    Minimises s with ``|t_i| <= mu N_i + s weights_i`` and the sum of the N_i at most ``FORCE_LIMIT``.

    ``solution`` (2, 3 k) is filled in with the forces and with the multipliers, which are velocities of the contacts.

    Returns:
        s: forces within the cones exist where it is not positive; infinite if the program could not be solved.
    """
    k = grasp.normals.shape[0]
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
    per = 1.0 / FORCE_LIMIT
    for i in range(k):
        sizes[i] = 3
        n = normal_part(start, grasp, i)
        h[3 * i] = mu * n
        h[3 * i + 1], h[3 * i + 2] = tangential_part(start, grasp, i)
        g[3 * i, d] = -weights[i]
        h[m - 1] -= n * per
        for j in range(d):
            n = normal_part(basis[j], grasp, i)
            a, b = tangential_part(basis[j], grasp, i)
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
                mu * z[3 * i] * grasp.normals[i, j]
                + z[3 * i + 1] * grasp.frames[i, 0, j]
                + z[3 * i + 2] * grasp.frames[i, 1, j]
            )
    return float(x[d]) if gap < math.inf else math.inf


@kernel()
def set_solution(target: Array, solution: Array) -> None:
    """Sets both rows."""
    copy_numbers(solution[0], target[0])
    copy_numbers(solution[1], target[1])


@kernel(allocates=True)
def least_pull(start: Array, basis: Array, grasp: Grasp, solution: Array) -> float:
    """The least pull that a contact needs where contacts carry any tangential force, over all forces of the family.

    Internal forces that change no normal force are left out, since they would leave the program without a unique
    solution. ``solution`` is filled in as by :func:`deepest_forces`.

    Returns:
        The pull: normal forces that only press exist where it is not positive; infinite if the program was not solved.
    """
    k = grasp.normals.shape[0]
    d = basis.shape[0]
    left = basis.copy()
    parts = np.empty((d, k))
    for j in range(d):
        for i in range(k):
            parts[j, i] = normal_part(left[j], grasp, i)
    count = 0
    largest = 0.0
    # Gram and Schmidt on the normal parts, the longest first.
    while count < d:
        at, size = count, 0.0
        for j in range(count, d):
            squared = 0.0
            for i in range(k):
                squared += parts[j, i] * parts[j, i]
            if squared > size:
                at, size = j, squared
        size = math.sqrt(size)
        if count == 0:
            largest = size
        if size <= RANK_TOLERANCE * max(largest, 1.0):
            break
        for i in range(k):
            parts[count, i], parts[at, i] = parts[at, i], parts[count, i]
            parts[count, i] /= size
        for i in range(3 * k):
            left[count, i], left[at, i] = left[at, i], left[count, i]
            left[count, i] /= size
        for j in range(count + 1, d):
            along = 0.0
            for i in range(k):
                along += parts[count, i] * parts[j, i]
            for i in range(k):
                parts[j, i] -= along * parts[count, i]
            for i in range(3 * k):
                left[j, i] -= along * left[count, i]
        count += 1
    c = np.zeros(count + 1)
    c[count] = 1.0
    g = np.zeros((k + 1, count + 1))
    h = np.zeros(k + 1)
    x = np.zeros(count + 1)
    z = np.zeros(k + 1)
    per = 1.0 / FORCE_LIMIT
    h[k] = 1.0
    for i in range(k):
        h[i] = normal_part(start, grasp, i)
        h[k] -= h[i] * per
        g[i, count] = -1.0
        for j in range(count):
            n = normal_part(left[j], grasp, i)
            g[i, j] = -n
            g[k, j] += n * per
    gap = solve_program(c, g, h, np.ones(k + 1, np.intp), x, z)
    for i in range(3 * k):
        solution[0, i] = start[i]
        for j in range(count):
            solution[0, i] += x[j] * left[j, i]
        solution[1, i] = z[i // 3] * grasp.normals[i // 3, i % 3]
    return float(x[count]) if gap < math.inf else math.inf


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


@kernel(allocates=True)
def newton_friction(mu: float, basis: Array, grasp: Grasp, solution: Array) -> float:
    """Newton's method on the conditions of a least friction, from forces near them; the friction it comes to.

    The sliding contacts i satisfy ``|t_i| = mu N_i``, and with multipliers that sum to 1 the velocities
    ``multiplier_i (mu n_i - t_i / |t_i|)`` do no work on internal forces. ``solution`` has the forces
    and the velocities, of which only those of sliding contacts are not zero.
    """
    k = grasp.normals.shape[0]
    d = basis.shape[0]
    sliding = np.empty(k, np.intp)
    count = 0
    largest = 0.0
    for i in range(k):
        largest = max(largest, normal_part(solution[1], grasp, i))
    for i in range(k):
        if normal_part(solution[1], grasp, i) > SLIDING * largest:
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
            multipliers[m] += solution[1, 3 * i + j] * grasp.normals[i, j]
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
            a, b = tangential_part(solution[0], grasp, i)
            n = normal_part(solution[0], grasp, i)
            t = math.hypot(a, b)
            across[m, 0], across[m, 1] = a / t, b / t
            right[d + m] = mu * n - t
            matrix[d + m, size - 1] = -n
            matrix[size - 1, d + m] = 1.0
            for j in range(d):
                nj = normal_part(basis[j], grasp, i)
                aj, bj = tangential_part(basis[j], grasp, i)
                along = (a * aj + b * bj) / t
                matrix[d + m, j] = along - mu * nj
                matrix[j, d + m] = along - mu * nj
                matrix[j, size - 1] -= multipliers[m] * nj
                right[j] -= multipliers[m] * (along - mu * nj)
                for q in range(d):
                    al, bl = tangential_part(basis[q], grasp, i)
                    matrix[j, q] += multipliers[m] * (aj * al + bj * bl - along * (a * al + b * bl) / t) / t
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
        a, b = tangential_part(solution[0], grasp, i)
        t = math.hypot(a, b)
        for j in range(3):
            solution[1, 3 * i + j] = multipliers[m] * (
                mu * grasp.normals[i, j] - (a * grasp.frames[i, 0, j] + b * grasp.frames[i, 1, j]) / t
            )
    return mu


@kernel(allocates=True)
def improved(mu: float, start: Array, basis: Array, grasp: Grasp, solution: Array) -> float:
    """The least friction of the family, by Dinkelbach's iteration from forces that ``mu`` suffices for.

    ``solution`` has those forces at first, then those of the least friction and the velocities that go with them.
    """
    k = grasp.normals.shape[0]
    weights = np.empty(k)
    best = solution.copy()
    for _ in range(MOST_ROUNDS):
        largest = 0.0
        for i in range(k):
            weights[i] = normal_part(best[0], grasp, i)
            largest = max(largest, weights[i])
        for i in range(k):
            weights[i] = max(weights[i] / largest, LEAST_WEIGHT)
        deepest_forces(mu, weights, start, basis, grasp, solution)
        lower = friction_of(solution[0], grasp)
        if not lower < mu:
            weights[:] = 1.0
            deepest_forces(mu, weights, start, basis, grasp, solution)
            lower = friction_of(solution[0], grasp)
            if not lower < mu:
                break
        set_solution(best, solution)
        is_settled = lower > mu * (1.0 - 1e-6)
        mu = lower
        polished = newton_friction(mu, basis, grasp, solution)
        if polished < math.inf:
            # The conditions of a least friction hold if no contact needs more, and a quasi-convex ratio has no other.
            lower = friction_of(solution[0], grasp)
            if lower <= min(mu, polished) * (1.0 + 1e-13):
                return lower
        if is_settled and mu - lower < 1e-12 * mu:
            break
    set_solution(solution, best)
    return mu


@kernel(allocates=True)
def narrowed(
    mu: float,
    load: Array,
    start: Array,
    basis: Array,
    grasp: Grasp,
    solution: Array,
    twist: Array,
) -> tuple[float, float]:
    """Bounds of a least friction that the iteration for ratios did not settle, by programs at frictions below ``mu``.

    Each gives forces that need less than ``mu``, or a twist that proves that less does not do, or ends the search.
    The load has norm 1, or is zero where forces that balance each other are sought. ``solution`` has forces that need
    ``mu`` at first, then those of the upper bound.
    """
    k = grasp.normals.shape[0]
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
        deepest_forces(tried, weights, start, basis, grasp, tried_solution)
        lower = friction_of(tried_solution[0], grasp)
        if lower < mu * (1.0 - ROUND_OFF):
            mu = lower
            set_solution(solution, tried_solution)
            continue
        if wedging:
            work = 0.0
            for i in range(3 * k):
                work += start[i] * tried_solution[1, i]
            for i in range(k):
                for j in range(3):
                    tried_solution[1, 3 * i + j] -= work * grasp.normals[i, j]
        twist_of(tried_solution[1], grasp, twist)
        if wedging:
            contact_velocities(twist, grasp, found)
            proved = least_ratio(found, 0.0) >= tried
        else:
            proved = withstands(twist, tried, load, grasp) >= FORCE_LIMIT
        if proved:
            low = tried
        elif low > 0.0 or part >= 0.1:
            break
        else:
            part *= 10.0
    set_solution(tried_solution, solution)
    if low < mu * (1.0 - 1e-9) and newton_friction(mu, basis, grasp, tried_solution) < math.inf:
        lower = friction_of(tried_solution[0], grasp)
        if lower <= mu * (1.0 + ROUND_OFF):
            mu = min(mu, lower)
            set_solution(solution, tried_solution)
            twist_of(solution[1], grasp, twist)
            power = 0.0
            for m in range(6):
                power += load[m] * twist[m]
            largest = contact_velocities(twist, grasp, found)
            if power >= -ROUND_OFF * largest:
                low = max(low, min(mu, least_ratio(found, largest)))
    return low, mu
