"""Cones of wrenches, and what of one can carry a family of loads (forces, section 2).

A cone of wrenches is the sum of what *blocks* carry. A block is a matrix of one or three rows, each a wrench of n
numbers; it carries ``rows' z`` for every z of the half-line or of the second-order cone. A motion v of n numbers is
withstood by no block where ``rows v`` lies in the same cone for each: these motions are the dual cone, and support the
cone of wrenches.

A family of loads has three columns: the constant load and two axes. The loads ``s w0 + x a + y b``, s >= 0, whose
negatives lie in the cone are a cone in three dimensions, (s, x, y).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.statics.cone_program import solved_program

Floats = NDArray[np.float64]

NEGLIGIBLE = 1e-9
"""Part of a unit below which a load, a force or a motion counts as none: half the digits of a double."""
ACTIVE = 1e-6
"""Part of the largest above which a force or a velocity of a degenerate program is not round-off."""
CONSTANT = -1
"""The owner of the block that keeps s from being negative."""


@dataclass(frozen=True, slots=True)
class Block:
    """What carries wrenches: matrix of shape (1 or 3, n), and the number of the contact it belongs to, from 0."""

    owner: int
    rows: Floats


@dataclass(frozen=True, slots=True)
class Reduced:
    """A cone without lines whose slice has an inside, made of one that need not be so.

    Attributes:
        blocks: in the coordinates of ``motions``.
        motions: shape (n, r); the motions that are left.
        family: shape (3, d); the loads (s, x, y) that are left, in orthonormal columns; the identity if all are.
        loads: shape (r, d); they in the coordinates of ``motions``.
        sticking: owners of blocks that wedge: motions leave them at rest.
        inner_forces, inner_load: forces (m) strictly inside their cones, and the load (d) that they balance.
        opening: shape (r); a motion that strictly opens every block.
    """

    blocks: tuple[Block, ...]
    motions: Floats
    family: Floats
    loads: Floats
    sticking: frozenset[int]
    inner_forces: Floats
    inner_load: Floats
    opening: Floats

    @property
    def matrix(self) -> Floats:
        """The rows of all blocks."""
        return np.vstack([block.rows for block in self.blocks])

    @property
    def sizes(self) -> NDArray[np.intp]:
        """The rows of each block."""
        return np.array([len(block.rows) for block in self.blocks], np.intp)


def reduced(blocks: Sequence[Block], loads: Floats) -> Reduced | None:
    """The cone of blocks over its lines, and the loads (n, 3) that it can carry at all; None where s > 0 is none.

    Blocks that can press against each other are at rest in all motions: their wrenches are a space of their own, and
    the rest of the cone is one over it. Blocks that cannot carry any part of the loads are left out, or carry what lies
    on one ray of their cone.
    """
    blocks, motions, sticking = _without_lines(tuple(blocks), loads.shape[0])
    while True:
        matrix = np.vstack([block.rows @ motions for block in blocks])
        inside, outside = row_space(matrix)
        family = null_space(outside.T @ motions.T @ loads)
        if family.shape[1] == 0:
            return None
        if family.shape[1] == 3:
            family = np.eye(3)
        basis = motions @ inside
        local = tuple(Block(block.owner, block.rows @ basis) for block in blocks)
        carried = basis.T @ loads @ family
        depth, found = inner_forces(local, carried)
        if depth > NEGLIGIBLE:
            load = -np.linalg.pinv(carried) @ (np.vstack([block.rows for block in local]).T @ found)
            _, opening, _ = opening_motion([block.rows for block in local])
            return Reduced(local, basis, family, carried, sticking, found, load, opening)
        kept = _restricted(blocks, found)
        if kept is None:
            return None
        blocks = kept


def _without_lines(blocks: tuple[Block, ...], n: int) -> tuple[tuple[Block, ...], Floats, frozenset[int]]:
    """The blocks that do not wedge, a basis of the motions that leave the others at rest, and those others' owners."""
    motions = np.eye(n)
    sticking: set[int] = set()
    while True:
        margin, _, forces = opening_motion([block.rows @ motions for block in blocks])
        if margin > NEGLIGIBLE:
            return blocks, motions, frozenset(sticking)
        left: list[Block] = []
        rest: list[Floats] = []
        start = 0
        for block in blocks:
            size = len(block.rows)
            force = forces[start : start + size]
            start += size
            if force[0] <= ACTIVE:
                left.append(block)
                continue
            sticking.add(block.owner)
            if size == 1 or force[0] - np.linalg.norm(force[1:]) > ACTIVE * force[0]:
                rest.append(block.rows)
            else:
                # Wedged on the border of its cone: what it withstands is a half-space, the closure of cone and line.
                axis = np.array([force[0], *-force[1:]]) / force[0]
                rest.append(null_space(axis[np.newaxis]).T @ block.rows)
                left.append(Block(block.owner, (axis @ block.rows)[np.newaxis]))
        blocks = tuple(left)
        motions = motions @ null_space(np.vstack(rest) @ motions)


def opening_motion(blocks: Sequence[Floats]) -> tuple[float, Floats, Floats]:
    """By how much a motion of norm 1 can open all blocks, that motion, and the forces that prove that no more can.

    The forces' normal parts sum to 1; where no motion opens all, they balance each other.
    """
    matrix = np.vstack(blocks)
    m, n = matrix.shape
    g = np.zeros((m + 1 + n, n + 1))
    g[:m, :n] = -matrix
    g[np.cumsum([0, *(len(rows) for rows in blocks[:-1])]), n] = 1.0
    g[m + 1 :, :n] = -np.eye(n)
    h = np.zeros(m + 1 + n)
    h[m] = 1.0
    c = np.zeros(n + 1)
    c[n] = -1.0
    x, z = solved_program(c, g, h, [*(len(rows) for rows in blocks), n + 1])
    return float(x[n]), x[:n], z[:m]


def inner_forces(blocks: Sequence[Block], loads: Floats) -> tuple[float, Floats]:
    """How deep inside their cones forces can lie that balance a load of a family (r, d), and such forces.

    Their parts along the axes of the cones sum to 1. Where they lie on the border at best, the second are the
    velocities of blocks in a motion that proves it.
    """
    matrix = np.vstack([block.rows for block in blocks])
    heads = np.zeros(len(matrix))
    heads[np.cumsum([0, *(len(block.rows) for block in blocks[:-1])])] = 1.0
    count = len(blocks)
    still = matrix @ null_space(loads.T)
    if still.shape[1] == 0:
        return 1.0 / count, heads / count
    opening, *_ = np.linalg.lstsq(still, heads, rcond=None)
    if np.abs(still @ opening - heads).max() <= NEGLIGIBLE:
        return 0.0, heads
    weights = heads @ still
    g = np.outer(heads, weights) / count - still
    x, z = solved_program(-weights / count, g, heads / count, [len(block.rows) for block in blocks])
    depth = (1.0 - float(weights @ x)) / count
    if depth <= NEGLIGIBLE:
        return depth, still @ x
    return depth, z + (1.0 - float(heads @ z)) / count * heads


def _restricted(blocks: Sequence[Block], velocities: Floats) -> tuple[Block, ...] | None:
    """The blocks without what their velocities prove to carry nothing; None where that is the constant load."""
    kept: list[Block] = []
    start = 0
    for block in blocks:
        size = len(block.rows)
        velocity = velocities[start : start + size]
        start += size
        if velocity[0] <= ACTIVE * np.abs(velocities).max():
            kept.append(block)
        elif block.owner == CONSTANT:
            return None
        elif size > 1 and velocity[0] - np.linalg.norm(velocity[1:]) <= ACTIVE * velocity[0]:
            axis = np.array([velocity[0], *-velocity[1:]]) / velocity[0]
            kept.append(Block(block.owner, (axis @ block.rows)[np.newaxis]))
    return tuple(kept)


def row_space(matrix: Floats) -> tuple[Floats, Floats]:
    """Orthonormal columns that span the rows of a matrix, and columns that span what is normal to them."""
    _, values, rows = np.linalg.svd(matrix)
    rank = int((values > NEGLIGIBLE * max(1.0, values.max(initial=0.0))).sum())
    return rows[:rank].T, rows[rank:].T


def null_space(matrix: Floats) -> Floats:
    """Orthonormal columns that span what is normal to the rows of a matrix."""
    return row_space(matrix)[1] if matrix.shape[0] else np.eye(matrix.shape[1])
