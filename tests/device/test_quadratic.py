"""Quadratic programs of a few variables, beside all active sets."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.device import _quadratic_kernel as qk

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]


def by_enumeration(hessian: Floats, gradient: Floats, normals: Floats, limits: Floats) -> Floats | None:
    """The solution as the best point at which a set of constraints is active and all are kept."""
    n = len(gradient)
    best: Floats | None = None
    lowest = float(np.inf)
    for size in range(n + 1):
        for chosen in combinations(range(len(limits)), size):
            a = normals[list(chosen)]
            system = np.block([[hessian, a.T], [a, np.zeros((size, size))]])
            if abs(np.linalg.det(system)) < 1e-12:
                continue
            x = np.linalg.solve(system, np.concatenate([-gradient, limits[list(chosen)]]))[:n]
            value = 0.5 * x @ hessian @ x + gradient @ x
            if (normals @ x <= limits + 1e-9).all() and value < lowest - 1e-12:
                best, lowest = x, float(value)
    return best


def test_programs_have_the_solution_of_the_best_active_set() -> None:
    rng = np.random.default_rng(5)
    kept = infeasible = 0
    for _ in range(300):
        n, m = int(rng.integers(2, 5)), int(rng.integers(0, 7))
        root = rng.standard_normal((n, n))
        hessian = root @ root.T + 0.1 * np.eye(n)
        gradient, normals = rng.standard_normal(n), rng.standard_normal((m, n))
        limits = rng.standard_normal(m) * 0.5
        factor, work = np.zeros((6, 6)), np.zeros(6 * 24 + 90)
        square, rows = np.zeros((6, 6)), np.zeros((24, 6))
        square[:n, :n], rows[:m, :n] = hessian, normals
        assert qk.cholesky(square, n, factor)
        x, forces = np.zeros(6), np.zeros(24)
        padded = np.zeros(24)
        padded[:m] = limits
        g = np.zeros(6)
        g[:n] = gradient
        status = qk.solve_program(n, factor, g, m, rows, padded, 1e-13, work, np.zeros(8, dtype=np.int64), x, forces)
        expected = by_enumeration(hessian, gradient, normals, limits)
        if expected is None:
            infeasible += 1
            assert status == qk.INFEASIBLE
            continue
        kept += 1
        assert status == qk.SOLVED
        assert np.abs(x[:n] - expected).max() < 1e-8
        assert forces[:m].min(initial=0.0) >= 0.0
        assert np.abs(hessian @ x[:n] + gradient + forces[:m] @ normals).max() < 1e-9
    assert kept > 200
    assert infeasible > 5


def test_a_matrix_that_is_not_positive_definite_has_no_factor() -> None:
    assert not qk.cholesky(np.array([[1.0, 2.0], [2.0, 1.0]]), 2, np.zeros((2, 2)))
    assert not qk.cholesky(np.zeros((2, 2)), 2, np.zeros((2, 2)))
