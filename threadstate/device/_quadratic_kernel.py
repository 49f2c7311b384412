"""Strictly convex quadratic programs of a few variables, by the dual active-set method (Goldfarb and Idnani 1983).

Minimise ``x . B x / 2 + g . x`` subject to ``a_i . x <= b_i``.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MAX_ROUNDS = 100

SOLVED, INFEASIBLE, ENDLESS = range(3)


@kernel()
def cholesky(matrix: Array, n: int, factor: Array) -> bool:
    """Sets the lower factor of a symmetric matrix (its first n rows); False where it is not positive definite."""
    for i in range(n):
        for j in range(i + 1):
            total = matrix[i, j]
            for m in range(j):
                total -= factor[i, m] * factor[j, m]
            if i == j:
                if not total > 1e-13 * abs(matrix[i, i]):
                    return False
                factor[i, i] = math.sqrt(total)
            else:
                factor[i, j] = total / factor[j, j]
    return True


@kernel()
def solve_lower(factor: Array, n: int, vector: Array) -> None:
    """Solves ``L x = v`` in place."""
    for i in range(n):
        total = vector[i]
        for m in range(i):
            total -= factor[i, m] * vector[m]
        vector[i] = total / factor[i, i]


@kernel()
def solve_upper(factor: Array, n: int, vector: Array) -> None:
    """Solves ``L^T x = v`` in place."""
    for i in range(n - 1, -1, -1):
        total = vector[i]
        for m in range(i + 1, n):
            total -= factor[m, i] * vector[m]
        vector[i] = total / factor[i, i]


@kernel()
def solve_program(
    n: int,
    factor: Array,
    gradient: Array,
    count: int,
    normals: Array,
    limits: Array,
    slack: float,
    work: Array,
    active: Indices,
    x: Array,
    forces: Array,
) -> int:
    """Sets the solution and the multipliers of all constraints; ``factor`` is the lower factor of B.

    A constraint counts as kept where it is violated by ``slack`` at most. Of constraints that cannot all be kept the
    status is INFEASIBLE, and ``x`` is the point reached.
    """
    # Columns of L^-1 a for each constraint, as in the coordinates y = L^T x the Hessian is the unit matrix.
    columns = work[0 : 6 * count].reshape((count, 6))
    gram = work[6 * count : 6 * count + 36].reshape((6, 6))
    gram_factor = work[6 * count + 36 : 6 * count + 72].reshape((6, 6))
    y = work[6 * count + 72 : 6 * count + 78]
    rates = work[6 * count + 78 : 6 * count + 84]
    move = work[6 * count + 84 : 6 * count + 90]
    for i in range(count):
        for j in range(n):
            columns[i, j] = normals[i, j]
        solve_lower(factor, n, columns[i])
        forces[i] = 0.0
    for j in range(n):
        y[j] = -gradient[j]
    solve_lower(factor, n, y)
    size = 0
    for _ in range(MAX_ROUNDS):
        worst, entering = slack, -1
        for i in range(count):
            excess = -limits[i]
            for j in range(n):
                excess += columns[i, j] * y[j]
            taken = False
            for m in range(size):
                taken = taken or active[m] == i
            if not taken and excess > worst:
                worst, entering = excess, i
        if entering < 0:
            for j in range(n):
                x[j] = y[j]
            solve_upper(factor, n, x)
            return SOLVED
        while True:
            excess = -limits[entering]
            for j in range(n):
                excess += columns[entering, j] * y[j]
            # The part of the entering constraint's normal that the active ones do not span.
            for m in range(size):
                rates[m] = 0.0
                for j in range(n):
                    rates[m] += columns[active[m], j] * columns[entering, j]
                for h in range(size):
                    gram[m, h] = 0.0
                    for j in range(n):
                        gram[m, h] += columns[active[m], j] * columns[active[h], j]
            independent = size < n and cholesky(gram, size, gram_factor)
            if size == n:
                independent = False
                if not cholesky(gram, size, gram_factor):
                    return ENDLESS
            elif not independent:
                return ENDLESS
            solve_lower(gram_factor, size, rates)
            solve_upper(gram_factor, size, rates)
            full, rest = 0.0, 0.0
            for j in range(n):
                move[j] = columns[entering, j]
                for m in range(size):
                    move[j] -= rates[m] * columns[active[m], j]
                rest += move[j] * move[j]
                full += columns[entering, j] * columns[entering, j]
            independent = independent and rest > 1e-20 * full
            limit, leaving = math.inf, -1
            for m in range(size):
                if rates[m] > 1e-14 and forces[active[m]] / rates[m] < limit:
                    limit, leaving = forces[active[m]] / rates[m], m
            step = excess / rest if independent else math.inf
            if not independent and leaving < 0:
                for j in range(n):
                    x[j] = y[j]
                solve_upper(factor, n, x)
                return INFEASIBLE
            taken_step = min(limit, step)
            for m in range(size):
                forces[active[m]] -= taken_step * rates[m]
            forces[entering] += taken_step
            if independent:
                for j in range(n):
                    y[j] -= taken_step * move[j]
            if step <= limit:
                active[size] = entering
                size += 1
                break
            forces[active[leaving]] = 0.0
            for m in range(leaving, size - 1):
                active[m] = active[m + 1]
            size -= 1
    return ENDLESS
