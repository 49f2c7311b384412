"""Friction cones, round or pyramids, and the two programs that propose twists and contact forces.

Both programs maximise over scaled twists ``v`` of size at most 1 and are bounded and strictly feasible, so that solvers
have an easy task; their multipliers are contact forces. With ``u = maps^T v`` the velocity of a contact's point:

- ``hold``: the greatest power of the load over twists against which no contact resists, ``u_n >= mu |u_t|``.
  Its value is the distance of minus the load from the cone of wrenches.
- ``wedge``: the greatest ``t`` with ``cos(phi) u_n - sin(phi) |u_t| >= t`` for each contact, ``tan(phi) = mu``. Its
  value is the least imbalance of forces on the cones' edges whose sizes sum to 1.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import clarabel
import numpy as np
from scipy import sparse
from scipy.optimize import linprog

from oracle.statics.wrenches import Floats

TOLERANCE = 1e-13
"""Asked of Clarabel, which stops earlier where it gets no further."""
LINEAR_TOLERANCE = 1e-10
"""The least that HiGHS accepts."""


class Cone(Protocol):
    """A friction cone: how its cross-section measures forces and velocities, and its two programs.

    ``maps`` (k, q, 3) take (normal, tangential, tangential) forces to wrenches with q coordinates; q is 6 or, where
    wrenches that are balanced anyway were divided out, less. Programs return a twist (q,) and forces (k, 3).
    """

    def force_size(self, across: Floats) -> Floats:
        """The least friction times normal force that allows tangential forces (k, 2)."""

    def velocity_size(self, across: Floats) -> Floats:
        """The greatest power of an allowed tangential force, over friction times normal force, on velocities (k, 2)."""

    def hold(self, maps: Floats, load: Floats, friction: float) -> tuple[Floats, Floats]:
        """A twist that the load drives and no contact resists; forces that nearly balance the load."""

    def wedge(self, maps: Floats, friction: float) -> tuple[Floats, Floats]:
        """A twist that opens each contact however it slides; forces that nearly balance each other."""


def solve_conic(
    objective: Floats, blocks: Sequence[tuple[Floats, Floats]], kinds: Sequence[object]
) -> tuple[Floats, Floats]:
    """Minimise ``objective @ x`` with ``b - A x`` of each block (A, b) in its cone: ``x`` and the multipliers."""
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.presolve_enable = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = TOLERANCE
    matrix = sparse.csc_matrix(np.concatenate([block[0] for block in blocks]))
    right = np.concatenate([block[1] for block in blocks])
    nothing = sparse.csc_matrix((len(objective), len(objective)))
    solution = clarabel.DefaultSolver(nothing, objective, matrix, right, list(kinds), settings).solve()
    return np.array(solution.x), np.array(solution.z)


@dataclass(frozen=True)
class RoundCone:
    """The exact cone of Coulomb friction: |t| <= mu N."""

    def force_size(self, across: Floats) -> Floats:
        """Euclidean norms."""
        return np.asarray(np.hypot(across[:, 0], across[:, 1]))

    def velocity_size(self, across: Floats) -> Floats:
        """Euclidean norms."""
        return np.asarray(np.hypot(across[:, 0], across[:, 1]))

    def hold(self, maps: Floats, load: Floats, friction: float) -> tuple[Floats, Floats]:
        """By Clarabel."""
        return self._solve(maps, load, friction, wedge=False)

    def wedge(self, maps: Floats, friction: float) -> tuple[Floats, Floats]:
        """By Clarabel."""
        return self._solve(maps, np.zeros(maps.shape[1]), friction, wedge=True)

    def _solve(self, maps: Floats, load: Floats, friction: float, *, wedge: bool) -> tuple[Floats, Floats]:
        k, q, _ = maps.shape
        shares = _shares(friction)
        least = np.array([1.0, 0.0, 0.0]) if wedge else np.zeros(3)
        blocks = [(np.column_stack([-shares[:, None] * m.T, least]), np.zeros(3)) for m in maps]
        unit = np.zeros((q + 1, q + 1))
        unit[1:, :q] = -np.eye(q)
        blocks.append((unit, np.eye(q + 1)[0]))
        kinds = [clarabel.SecondOrderConeT(3)] * k + [clarabel.SecondOrderConeT(q + 1)]
        if not wedge:  # the last variable is t
            blocks.append((np.eye(1, q + 1, q), np.zeros(1)))
            kinds.append(clarabel.ZeroConeT(1))
        x, multipliers = solve_conic(-np.append(load, float(wedge)), blocks, kinds)
        return x[:q], multipliers[: 3 * k].reshape(k, 3) * shares


@dataclass(frozen=True)
class Pyramid:
    """The pyramid of ``sides`` sides inscribed in the exact cone, its edges at equal angles from the first tangent.

    The circumscribed pyramid with the same edges is the inscribed one of friction ``mu / cos(pi / sides)``.
    """

    sides: int

    def __post_init__(self) -> None:
        if self.sides < 3:
            raise ValueError(f"a pyramid has at least three sides: {self.sides}")

    @property
    def edges(self) -> Floats:
        """Directions of the edges across the normal, shape (sides, 2)."""
        return self._directions(0.0)

    @property
    def inner_share(self) -> float:
        """Radius of the circle within the cross-section, over that of the circle about it."""
        return math.cos(math.pi / self.sides)

    def _directions(self, turn: float) -> Floats:
        angles = 2.0 * math.pi * (np.arange(self.sides) + turn) / self.sides
        return np.column_stack([np.cos(angles), np.sin(angles)])

    def force_size(self, across: Floats) -> Floats:
        """By the sides, whose middles lie between the edges."""
        return np.asarray((across @ self._directions(0.5).T).max(axis=1) / self.inner_share)

    def velocity_size(self, across: Floats) -> Floats:
        """By the edges."""
        return np.asarray((across @ self.edges.T).max(axis=1))

    def hold(self, maps: Floats, load: Floats, friction: float) -> tuple[Floats, Floats]:
        """By HiGHS."""
        return self._solve(maps, load, friction, wedge=False)

    def wedge(self, maps: Floats, friction: float) -> tuple[Floats, Floats]:
        """By HiGHS."""
        return self._solve(maps, np.zeros(maps.shape[1]), friction, wedge=True)

    def _solve(self, maps: Floats, load: Floats, friction: float, *, wedge: bool) -> tuple[Floats, Floats]:
        k, q, _ = maps.shape
        edges = np.column_stack([np.ones(self.sides), self.edges]) * _shares(friction)
        rows = np.einsum("kqc,sc->ksq", maps, edges).reshape(k * self.sides, q)
        result = linprog(
            -np.append(load, float(wedge)),
            A_ub=np.column_stack([-rows, np.full(len(rows), float(wedge))]),
            b_ub=np.zeros(len(rows)),
            bounds=[(-1.0, 1.0)] * q + [(None, None) if wedge else (0.0, 0.0)],
            method="highs",
            options={"primal_feasibility_tolerance": LINEAR_TOLERANCE, "dual_feasibility_tolerance": LINEAR_TOLERANCE},
        )
        if result.x is None:
            return np.zeros(q), np.zeros((k, 3))
        return np.asarray(result.x[:q]), np.asarray(-result.ineqlin.marginals.reshape(k, self.sides) @ edges)


def _shares(friction: float) -> Floats:
    angle = math.atan(friction)
    return np.array([math.cos(angle), math.sin(angle), math.sin(angle)])
