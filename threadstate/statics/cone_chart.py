"""The farthest loads that a cone of wrenches carries, in directions of a bounded chart of them, with their proofs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from threadstate.statics.cone_program import solved_program
from threadstate.statics.cone_reduction import (
    ACTIVE,
    CONSTANT,
    Floats,
    Reduced,
    inner_forces,
    null_space,
    opening_motion,
    row_space,
)

FLAT = 1e-10
"""Part of a slice's size by which a straight edge may leave the line between its ends."""
ROUND_OFF = 1e-12
"""Part of a slice's size that supports leave open where programs end well."""
WELL_ENDED = 1e-8
"""Part of a slice's size that a support may leave open before other programs are tried."""
SIZES = (1.0, 8.0, 0.125, 64.0)
"""What directions are multiplied by, one after the other, until the solver does not end early."""
FEW = 6
"""Of so many blocks all are used at once."""
WELL_INSIDE = 1e-3
"""Depth of forces in their cones, of a sum of 1, at which programs with them end well."""


@dataclass(frozen=True, slots=True)
class Support:
    """The farthest point of a chart in a direction, with what proves it.

    Attributes:
        direction: shape (b), of norm 1.
        point: shape (b); balanced by forces in their cones.
        value: no point is farther along the direction.
        motion: shape (r); no block withstands it, and it does no work at ``point``.
        forces: shape (m); those that balance the load there.
    """

    direction: Floats
    point: Floats
    value: float
    motion: Floats
    forces: Floats

    @property
    def gap(self) -> float:
        """How far the point may be from the farthest."""
        return self.value - float(self.direction @ self.point)


class Chart:
    """The loads ``base + axes t`` of a reduced cone, t of one or two numbers: a bounded set, by its supports.

    Of many blocks a few carry a load: blocks are added to some until none withstands the motion that supports these.
    """

    def __init__(self, cone: Reduced, base: Floats, axes: Floats) -> None:
        self.cone = cone
        self.base = base
        self.axes = axes
        self._blocks = [block.rows for block in cone.blocks]
        self._matrix = cone.matrix
        self._heads = np.cumsum([0, *cone.sizes[:-1]])
        self._load = cone.loads @ base
        self._moved = cone.loads @ axes
        self._solved = np.linalg.pinv(self._moved)
        self._free = null_space(self._moved.T)
        margin, opening, _ = opening_motion([rows @ self._free for rows in self._blocks])
        self._margin, self._opening = margin, self._free @ opening
        inner = np.linalg.pinv(np.column_stack([base, axes])) @ cone.inner_load
        self._inner = inner[1:] / inner[0]
        self._inner_forces = cone.inner_forces / inner[0]
        self._depth = -float(self._outside(self._inner_forces).max())
        self._reach = float(np.linalg.norm(base))
        self._always = _few_blocks(cone)
        self._chosen = self._always

    def support(self, direction: Floats) -> Support:
        """The farthest point in a direction of norm 1."""
        best = self._tried(direction, SIZES[0])
        for size in SIZES[1:]:
            if best.gap <= WELL_ENDED * self._reach:
                break
            best = min(best, self._tried(direction, size), key=_gap_of)
        return best

    def _tried(self, direction: Floats, size: float) -> Support:
        motion, forces = self._program(direction, size)
        found = self._certified(direction, motion, forces)
        if found.gap <= ROUND_OFF * self._reach:
            return found
        return min(found, self._certified(direction, *self._polished(motion, forces)), key=_gap_of)

    def _program(self, direction: Floats, size: float) -> tuple[Floats, Floats]:
        """Motion and forces, nearly, of the farthest point, by programs for ``size`` times the direction."""
        given = size * self._solved.T @ direction
        chosen = self._chosen
        while True:
            rows = np.concatenate([np.arange(self._heads[i], self._heads[i] + len(self._blocks[i])) for i in chosen])
            matrix = self._matrix[rows]
            sizes = [len(self._blocks[i]) for i in chosen]
            x, found = solved_program(-self._free.T @ self._load, -matrix @ self._free, matrix @ given, sizes)
            motion = (given + self._free @ x) / size
            outside = self._outside(self._matrix @ motion)
            worst = int(outside.argmax())
            if worst in chosen or outside[worst] <= FLAT * float(np.linalg.norm(motion)):
                break
            chosen = sorted({*chosen, worst})
        forces = np.zeros(len(self._matrix))
        forces[rows] = found
        carrying = np.flatnonzero(forces[self._heads] > ACTIVE * forces[self._heads].max())
        self._chosen = sorted({*self._always, *carrying.tolist()})
        return motion, forces

    def _polished(self, motion: Floats, forces: Floats) -> tuple[Floats, Floats]:
        """The motion without what blocks at rest move, and the forces without those of blocks that open.

        Where a motion is not unique the program ends early. What carries a force and what opens is known by then, and
        the rest is a system of linear equations.
        """
        velocities = self._matrix @ motion
        speed, load = np.abs(velocities).max(), np.abs(forces).max()
        still: list[Floats] = []
        rays: list[tuple[int, Floats]] = []
        for i in np.flatnonzero(forces[self._heads] > 0.0):
            rows, head = self._blocks[i], self._heads[i]
            u, z = velocities[head : head + len(rows)] / speed, forces[head : head + len(rows)] / load
            u_length, z_length = float(np.linalg.norm(u[1:])), float(np.linalg.norm(z[1:]))
            if u[0] - u_length > z[0]:
                continue
            if u_length == 0.0 or z[0] - z_length > u[0]:
                still.extend(rows)
                rays.extend((head, one) for one in np.eye(len(rows)))
            else:
                along = u[1:] / u_length
                still.append(rows[0] - along @ rows[1:])
                rays.append((head, np.array([1.0, *-along])))
        if not still:
            return motion, forces
        fixed = np.array(still)
        motion = motion - self._free @ np.linalg.lstsq(fixed @ self._free, fixed @ motion, rcond=None)[0]
        wrenches = np.array([ray @ self._matrix[head : head + len(ray)] for head, ray in rays])
        shares = np.array([ray @ forces[head : head + len(ray)] / (ray @ ray) for head, ray in rays])
        point = -self._solved @ (self._matrix.T @ forces + self._load)
        left = wrenches.T @ shares + self._moved @ point + self._load
        shares = shares - np.linalg.lstsq(np.hstack([wrenches.T, self._moved]), left, rcond=None)[0][: len(shares)]
        found = np.zeros(len(forces))
        for (head, ray), share in zip(rays, shares, strict=True):
            found[head : head + len(ray)] += share * ray
        return motion, found

    def _certified(self, direction: Floats, motion: Floats, forces: Floats) -> Support:
        """A support whose motion and forces lie in their cones, from one whose nearly do."""
        out = float(self._outside(self._matrix @ motion).max())
        if out > 0.0:
            motion = motion + out / self._margin * self._opening
        point = -self._solved @ (self._matrix.T @ forces + self._load)
        used = np.flatnonzero(forces)
        left = self._matrix.T @ forces + self._load + self._moved @ point
        forces = forces.copy()
        forces[used] -= np.linalg.lstsq(self._matrix[used].T, left, rcond=None)[0]
        out = float(self._outside(forces).max())
        if out > 0.0:
            part = out / (out + self._depth)
            point = (1.0 - part) * point + part * self._inner
            forces = (1.0 - part) * forces + part * self._inner_forces
        return Support(direction, point, -float(motion @ self._load), motion, forces)

    def loads(self, points: Floats) -> Floats:
        """The loads (s, x, y) of points (k, b): shape (k, 3)."""
        return (self.base + points @ self.axes.T) @ self.cone.family.T

    def places(self, points: Floats) -> Floats:
        """Where points (k, b) lie in the plane of (x, y): shape (k, 2)."""
        loads = self.loads(points)
        return loads[:, 1:] / loads[:, :1]

    def _outside(self, rows: Floats) -> Floats:
        """By how much vectors leave their cones; negative for those that lie inside."""
        heads = rows[self._heads]
        norms = np.sqrt(np.maximum(np.add.reduceat(rows * rows, self._heads) - heads * heads, 0.0))
        return norms - heads


def _gap_of(support: Support) -> float:
    return support.gap


def _few_blocks(cone: Reduced) -> list[int]:
    """Blocks, spread evenly, that balance loads inside the slice by themselves, and all that belong to no contact."""
    count = len(cone.blocks)
    own = [i for i, block in enumerate(cone.blocks) if block.owner > CONSTANT]
    rest = [i for i in range(count) if i not in own]
    few = FEW
    while few < len(own):
        chosen = sorted({own[len(own) * i // few] for i in range(few)} | set(rest))
        blocks = [cone.blocks[i] for i in chosen]
        rank = row_space(np.vstack([block.rows for block in blocks]))[0].shape[1]
        if rank == cone.motions.shape[1] and inner_forces(blocks, cone.loads)[0] >= WELL_INSIDE:
            return chosen
        few *= 2
    return list(range(count))


def bounded_chart(cone: Reduced) -> Chart:
    """The loads of a cone cut where a motion that opens all blocks does work 1: bounded, lines are still lines.

    (x, y) turn in it as they do in the plane. Lines of the cone are left out.
    """
    across, _ = row_space(cone.loads)
    functional = -across.T @ cone.loads.T @ cone.opening
    base = across @ functional / (functional @ functional)
    axes = across @ null_space(functional[np.newaxis])
    if axes.shape == (3, 2) and np.linalg.det(np.column_stack([base, axes])) < 0.0:
        axes = axes[:, ::-1]
    return Chart(cone, base, axes)
