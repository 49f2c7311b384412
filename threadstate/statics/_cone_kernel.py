"""Second-order cone programs of a few variables, by a primal-dual interior-point method.

    minimise c . x    subject to    s = h - G x in K
    maximise -h . z   subject to    G' z + c = 0, z in K

K is a product of second-order cones, ``|s_1..| <= s_0``, of the given sizes; one of size 1 is the half-line. The
method is Mehrotra's predictor and corrector with the scaling of Nesterov and Todd, as in L. Vandenberghe, *The
CVXOPT linear and quadratic cone program solvers* (2010); it converges wherever both problems have interior points.
What it returns is an approximation: callers make certificates of x and z by arithmetic of their own.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import copy_numbers

Array = NDArray[np.float64]
Integers = NDArray[np.intp]

MOST_STEPS = 80
STEP_TO_BOUNDARY = 0.995
ACCURACY = 1e-14
"""Residuals and gap, relative to the data's size, at which the iteration ends."""
MOST_STALLED = 5
"""The iteration ends after so many steps that take a tenth neither off the residuals nor off residuals and gap."""


@kernel()
def boundary_step(point: Array, direction: Array, start: int, size: int) -> float:
    """The largest step that keeps ``point + step direction`` in the cone at ``start``; infinite if every one does."""
    d0, p0 = direction[start], point[start]
    if size == 1:
        return -p0 / d0 if d0 < 0.0 else math.inf
    a, b, c = d0 * d0, p0 * d0, p0 * p0
    for i in range(start + 1, start + size):
        a -= direction[i] * direction[i]
        b -= point[i] * direction[i]
        c -= point[i] * point[i]
    if a >= 0.0 and d0 >= 0.0:
        return math.inf
    # Negative by round-off alone: both roots are one where point and direction lie along the cone's axis.
    root = max(b * b - a * c, 0.0)
    # The smallest positive root of a t^2 + 2 b t + c, with c > 0.
    bottom = math.sqrt(root) - b
    return c / bottom if bottom > 0.0 else math.inf


@kernel()
def into_cones(point: Array, sizes: Integers) -> None:
    """Shifts ``point`` along the cones' axes into their interior, unless it lies there."""
    worst = -math.inf
    start = 0
    for size in sizes:
        norm = 0.0
        for i in range(start + 1, start + size):
            norm += point[i] * point[i]
        worst = max(worst, math.sqrt(norm) - point[start])
        start += size
    scale = 0.0
    for i in range(point.shape[0]):
        scale = max(scale, abs(point[i]))
    if worst >= -1e-8 * max(1.0, scale):
        start = 0
        for size in sizes:
            point[start] += 1.0 + worst
            start += size


@kernel()
def factor(matrix: Array) -> bool:
    """Cholesky's factor of a symmetric positive matrix, in its lower triangle; False if it is not positive."""
    n = matrix.shape[0]
    for j in range(n):
        pivot = matrix[j, j]
        least = 1e-30 * pivot
        for k in range(j):
            pivot -= matrix[j, k] * matrix[j, k]
        if not pivot > least:
            return False
        pivot = math.sqrt(pivot)
        matrix[j, j] = pivot
        for i in range(j + 1, n):
            rest = matrix[i, j]
            for k in range(j):
                rest -= matrix[i, k] * matrix[j, k]
            matrix[i, j] = rest / pivot
    return True


@kernel()
def solve_factored(factored: Array, right: Array) -> None:
    """Solves by Cholesky's factor, in place."""
    n = right.shape[0]
    for i in range(n):
        for k in range(i):
            right[i] -= factored[i, k] * right[k]
        right[i] /= factored[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            right[i] -= factored[k, i] * right[k]
        right[i] /= factored[i, i]


@kernel()
def set_scaling(s: Array, z: Array, sizes: Integers, scaling: Array, eta: Array) -> bool:
    """Nesterov and Todd's scaling of each cone: its hyperbolic Householder vector and its factor.

    False where a point has left the interior by round-off.
    """
    start = 0
    for cone in range(sizes.shape[0]):
        size = sizes[cone]
        ss, zz, sz = s[start] * s[start], z[start] * z[start], s[start] * z[start]
        for i in range(start + 1, start + size):
            ss -= s[i] * s[i]
            zz -= z[i] * z[i]
            sz += s[i] * z[i]
        if not (ss > 0.0 and zz > 0.0 and s[start] > 0.0 and z[start] > 0.0):
            return False
        ss, zz = math.sqrt(ss), math.sqrt(zz)
        gamma = math.sqrt(0.5 * (1.0 + sz / (ss * zz)))
        scaling[start] = (s[start] / ss + z[start] / zz) / (2.0 * gamma)
        for i in range(start + 1, start + size):
            scaling[i] = (s[i] / ss - z[i] / zz) / (2.0 * gamma)
        eta[cone] = math.sqrt(ss / zz)
        start += size
    return True


@kernel()
def scale(vector: Array, sizes: Integers, scaling: Array, eta: Array, inverse: bool) -> None:
    """Multiplies by the scaling W, or by its inverse, in place."""
    sign = -1.0 if inverse else 1.0
    start = 0
    for cone in range(sizes.shape[0]):
        size = sizes[cone]
        by = 1.0 / eta[cone] if inverse else eta[cone]
        dot = 0.0
        for i in range(start + 1, start + size):
            dot += scaling[i] * vector[i]
        head = vector[start]
        along = sign * head + dot / (1.0 + scaling[start])
        vector[start] = by * (scaling[start] * head + sign * dot)
        for i in range(start + 1, start + size):
            vector[i] = by * (vector[i] + along * scaling[i])
        start += size


@kernel(allocates=True)
def solve_program(c: Array, g: Array, h: Array, sizes: Integers, x: Array, z: Array) -> float:
    """Solves a cone program into ``x`` (n) and ``z`` (m); the largest relative residual or gap it ended with.

    That is infinite where it could not begin.

    ``c`` has shape (n), ``g`` (m, n) and rank n, ``h`` (m); the ``sizes`` of the cones sum to m.
    """
    m, n = g.shape
    s = np.empty(m)
    scaling = np.empty(m)
    eta = np.empty(sizes.shape[0])
    lam = np.empty(m)
    scaled = np.empty((m, n))
    matrix = np.empty((n, n))
    column = np.empty(m)
    right = np.empty(n)
    rx = np.empty(n)
    rs = np.empty(m)
    target = np.empty(m)
    ds = np.empty(m)
    dz = np.empty(m)
    # Least squares for both starts.
    for i in range(n):
        for j in range(i + 1):
            dot = 0.0
            for k in range(m):
                dot += g[k, i] * g[k, j]
            matrix[i, j] = dot
    if not factor(matrix):
        return math.inf
    for i in range(n):
        x[i] = 0.0
        right[i] = -c[i]
        for k in range(m):
            x[i] += g[k, i] * h[k]
    solve_factored(matrix, x)
    solve_factored(matrix, right)
    size_h, size_c = 1.0, 1.0
    for k in range(m):
        s[k] = h[k]
        z[k] = 0.0
        for i in range(n):
            s[k] -= g[k, i] * x[i]
            z[k] += g[k, i] * right[i]
        size_h = max(size_h, abs(h[k]))
    for i in range(n):
        size_c = max(size_c, abs(c[i]))
    into_cones(s, sizes)
    into_cones(z, sizes)
    degree = sizes.shape[0]
    best = math.inf
    least = math.inf
    stalled = 0
    best_x = x.copy()
    best_z = z.copy()
    for _ in range(MOST_STEPS):
        worst_x, worst_s, gap = 0.0, 0.0, 0.0
        size_x = 1.0
        for i in range(n):
            rx[i] = -c[i]
            for k in range(m):
                rx[i] -= g[k, i] * z[k]
            worst_x += abs(rx[i])
            size_x = max(size_x, abs(x[i]))
        for k in range(m):
            rs[k] = h[k] - s[k]
            for i in range(n):
                rs[k] -= g[k, i] * x[i]
            worst_s += abs(rs[k])
            gap += s[k] * z[k]
        residual = max(worst_x / size_c, worst_s / max(size_h, size_x))
        error = max(residual, gap / size_x)
        if not worst_x + worst_s + gap < math.inf:
            break
        # The gap of a start that is far from feasible may grow for some steps while the residuals fall.
        stalled = 0 if error < 0.9 * best or residual < 0.9 * least else stalled + 1
        least = min(least, residual)
        if error < best:
            best = error
            copy_numbers(x, best_x)
            copy_numbers(z, best_z)
        if error <= ACCURACY or stalled == MOST_STALLED:
            break
        if not set_scaling(s, z, sizes, scaling, eta):
            break
        for k in range(m):
            lam[k] = z[k]
        scale(lam, sizes, scaling, eta, False)
        for i in range(n):
            for k in range(m):
                column[k] = g[k, i]
            scale(column, sizes, scaling, eta, True)
            for k in range(m):
                scaled[k, i] = column[k]
        for i in range(n):
            for j in range(i + 1):
                dot = 0.0
                for k in range(m):
                    dot += scaled[k, i] * scaled[k, j]
                matrix[i, j] = dot
        if not factor(matrix):
            break
        scale(rs, sizes, scaling, eta, True)
        for k in range(m):
            target[k] = -lam[k]
        step = search_direction(1.0, rx, rs, lam, target, scaled, matrix, sizes, right, ds, dz)
        sigma = (1.0 - min(1.0, step)) ** 3
        corrected_target(lam, ds, dz, sigma * gap / degree, sizes, target)
        step = search_direction(1.0 - sigma, rx, rs, lam, target, scaled, matrix, sizes, right, ds, dz)
        step = min(1.0, STEP_TO_BOUNDARY * step)
        scale(ds, sizes, scaling, eta, False)
        scale(dz, sizes, scaling, eta, True)
        for i in range(n):
            x[i] += step * right[i]
        for k in range(m):
            s[k] += step * ds[k]
            z[k] += step * dz[k]
    copy_numbers(best_x, x)
    copy_numbers(best_z, z)
    return best


@kernel()
def search_direction(
    residual: float,
    rx: Array,
    rs: Array,
    lam: Array,
    target: Array,
    scaled: Array,
    factored: Array,
    sizes: Integers,
    dx: Array,
    ds: Array,
    dz: Array,
) -> float:
    """Newton's direction, of s and z in scaled coordinates, and the step from it to the boundary.

    ``residual`` is the part of the residuals to be removed; ``rs`` is scaled.
    """
    m, n = scaled.shape
    for i in range(n):
        dx[i] = residual * rx[i]
        for k in range(m):
            dx[i] += scaled[k, i] * (residual * rs[k] - target[k])
    solve_factored(factored, dx)
    for k in range(m):
        dz[k] = target[k] - residual * rs[k]
        for i in range(n):
            dz[k] += scaled[k, i] * dx[i]
        ds[k] = target[k] - dz[k]
    step = math.inf
    start = 0
    for size in sizes:
        step = min(step, boundary_step(lam, ds, start, size), boundary_step(lam, dz, start, size))
        start += size
    return step


@kernel()
def corrected_target(lam: Array, ds: Array, dz: Array, centre: float, sizes: Integers, target: Array) -> None:
    """What the scaled directions shall sum to: ``lam`` divided into -lam o lam - ds o dz + centre e."""
    start = 0
    for size in sizes:
        head = centre
        det = lam[start] * lam[start]
        dot = 0.0
        for i in range(start, start + size):
            head -= lam[i] * lam[i] + ds[i] * dz[i]
        for i in range(start + 1, start + size):
            target[i] = -2.0 * lam[start] * lam[i] - ds[start] * dz[i] - dz[start] * ds[i]
            det -= lam[i] * lam[i]
            dot += lam[i] * target[i]
        target[start] = (lam[start] * head - dot) / det
        for i in range(start + 1, start + size):
            target[i] = (target[i] - target[start] * lam[i]) / lam[start]
        start += size
