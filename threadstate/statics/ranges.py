"""How far the contact forces that balance a load are from unique (forces, section 3)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.statics.cone_program import solved_program
from threadstate.statics.scene import Scene
from threadstate.statics.wrench_cone import (
    Divided,
    contact_maps,
    deepest_forces,
    divided,
    into_cones,
    least_forces,
    moved,
    null_space,
    slacks,
)

Floats = NDArray[np.float64]

MOST_CENTRES = 6
NARROW = 1e-9
"""Part of a force, or of the load, by which a range may be uncertain before it is sought from another centre."""


@dataclass(frozen=True, slots=True)
class NormalRange:
    """The least and the largest normal force of a contact, in N, among all forces that balance a load.

    ``contact`` counts from 1. The largest is infinite where contacts that wedge press on it. Both are of forces that
    balance the load; the true ends lie no more than ``uncertainty`` beyond.
    """

    contact: int
    normal_min: float
    normal_max: float
    uncertainty: float


@dataclass(frozen=True, slots=True)
class ForcesRange:
    """How far balancing forces are from unique.

    Attributes:
        contacts: one for each contact; empty where no forces balance the load, and on a patch.
        internal_dimension: of the forces that balance each other, those across the normals counted where there is
            friction; None on a patch, which presses at any number of points.
    """

    contacts: tuple[NormalRange, ...]
    internal_dimension: int | None


def forces_range_of(scene: Scene, mu: float, *, held: bool) -> ForcesRange:
    """The range of forces in a scene at a friction; ``held``: whether the contacts are known to hold the load."""
    if scene.contacts.patch or scene.contacts.strip:
        return ForcesRange((), None)
    maps = contact_maps(scene.points, scene.normals, mu)
    internal = null_space(np.concatenate(list(maps), axis=1)).shape[1]
    if not held:
        return ForcesRange((), internal)
    size = float(np.linalg.norm(scene.load))
    cosine = 1.0 / math.hypot(1.0, mu)
    ranges = []
    for i, (least, largest, uncertainty) in enumerate(normal_ranges(maps, scene.load / size)):
        ranges.append(NormalRange(i + 1, *(size * cosine * number for number in (least, largest, uncertainty))))
    return ForcesRange(tuple(ranges), internal)


def normal_ranges(maps: Floats, load: Floats) -> list[tuple[float, float, float]]:
    """For each contact the least and the largest s of forces that balance a load of size 1, and how uncertain they are.

    What wedges without a contact has no bound and is divided out before that contact's range is sought.
    """
    wedging = divided(maps)
    found = []
    for i in range(len(maps)):
        others = np.arange(len(maps)) != i
        apart = divided(maps[others])
        pressed = np.zeros(len(maps), dtype=np.bool_)
        pressed[others] = apart.pressed
        rest = np.einsum("qp,kqc->kpc", apart.free, maps[~pressed])
        family = _Family(rest, apart.free.T @ load, int((~pressed[:i]).sum()))
        least, below = family.least(apart)
        if wedging.pressed[i]:
            largest, above = math.inf, 0.0
        else:
            largest, above = family.largest(wedging)
        found.append((least, max(least, largest), max(below, above)))
    return found


class _Family:
    """The forces with maps (k, q, parts) that balance a load (q): deep ones, and the internal ones that are added."""

    def __init__(self, maps: Floats, load: Floats, place: int) -> None:
        self._maps, self._load = maps, load
        k, q, self._parts = maps.shape
        columns = np.swapaxes(maps, 0, 1).reshape(q, k * self._parts)
        self._basis = null_space(columns)
        self._row = place * self._parts
        start = least_forces(columns, load)
        self._deep = deepest_forces(start, self._basis, self._parts)

    def least(self, apart: Divided) -> tuple[float, float]:
        """The least s of the contact, and how far below it may be; ``apart`` divides the other contacts."""
        own = 0.0
        if len(apart.maps):
            place = self._row // self._parts
            own = max(0.0, -float(slacks(moved(self._maps[place : place + 1], apart.twist))[0]))
        return self._end(1.0, float(np.linalg.norm(self._load)) / apart.rate, 1.0 + own / apart.rate)

    def largest(self, bounded: Divided) -> tuple[float, float]:
        """The largest s of the contact, and how far above it may be; ``bounded`` divides all contacts."""
        return self._end(-1.0, float(np.linalg.norm(self._load)) / bounded.rate, 0.0)

    def _end(self, sense: float, total: float, total_each: float) -> tuple[float, float]:
        """The least s (the largest, where ``sense`` is -1), and how far beyond the true end may be.

        All s of forces at which the contact's is v sum to no more than ``total + v total_each``.
        """
        if self._basis.shape[1] == 0:
            return max(0.0, float(self._deep[self._row])), 0.0
        centre, best, bound = self._deep, math.inf, -math.inf
        for _ in range(MOST_CENTRES):
            forces, multipliers = self._extreme(centre, sense)
            best = min(best, sense * float(forces[self._row]))
            bound = max(bound, self._bound(sense, centre, multipliers, total + max(0.0, best) * total_each))
            if best - bound <= NARROW * (1.0 + abs(best)):
                break
            centre = 0.5 * (centre + forces)
        return max(0.0, sense * best), max(0.0, best - bound)

    def _extreme(self, centre: Floats, sense: float) -> tuple[Floats, Floats]:
        """Forces at an end, and the multipliers that prove it; the set of forces may be long and narrow.

        About a centre that lies within all cones it is nearly round in other coordinates.
        """
        k, d = len(self._maps), self._basis.shape[1]
        deep = float(slacks(centre.reshape(k, -1)).min())
        cones, round_ = np.broadcast_to(np.eye(self._parts), (k, self._parts, self._parts)), np.eye(d)
        if deep > 0.0:
            cones = _on_the_axes(centre.reshape(k, -1))
            _, upper = np.linalg.qr(_mapped(cones, self._basis))
            round_ = np.linalg.inv(upper)
        basis = self._basis @ round_
        size = float(np.linalg.norm(basis[self._row])) or 1.0
        x, z = solved_program(
            sense / size * basis[self._row],
            -_mapped(cones, basis),
            _mapped(cones, centre[:, np.newaxis])[:, 0],
            [self._parts] * k,
        )
        change = basis @ x
        short = float(slacks((centre + change).reshape(k, -1)).min())
        if short < 0.0 < deep:
            change *= deep / (deep - short)
        return centre + change, into_cones(size * np.einsum("kab,ka->kb", cones, z.reshape(k, -1))).ravel()

    def _bound(self, sense: float, centre: Floats, multipliers: Floats, total: float) -> float:
        """What multipliers prove of ``sense`` times s, of forces whose s sum to ``total`` at most."""
        left = sense * self._basis[self._row] - self._basis.T @ multipliers
        size = math.sqrt(2.0) * total + float(np.linalg.norm(centre))
        return float(sense * centre[self._row] - centre @ multipliers - np.linalg.norm(left) * size)


def _on_the_axes(forces: Floats) -> Floats:
    """Maps (k, parts, parts) of each cone on itself that take forces (k, parts) to its axis, at the same distance."""
    parts = forces.shape[1]
    sizes = np.sqrt(slacks(forces) * (forces[:, 0] + np.linalg.norm(forces[:, 1:], axis=1)))
    head, across = forces[:, 0] / sizes, forces[:, 1:] / sizes[:, np.newaxis]
    cones = np.zeros((len(forces), parts, parts))
    cones[:, 0, 0] = head
    cones[:, 0, 1:] = cones[:, 1:, 0] = -across
    cones[:, 1:, 1:] = np.eye(parts - 1) + np.einsum("ka,kb,k->kab", across, across, 1.0 / (1.0 + head))
    return np.asarray(cones / sizes[:, np.newaxis, np.newaxis])


def _mapped(cones: Floats, columns: Floats) -> Floats:
    """Columns (k parts, n) of forces in the coordinates that maps of each cone give."""
    k, parts, _ = cones.shape
    return np.einsum("kab,kbn->kan", cones, columns.reshape(k, parts, -1)).reshape(k * parts, -1)
