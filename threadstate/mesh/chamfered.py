"""The side of a chamfered bolt: thread and cone in one mesh that is cut along their edge.

Seen from the axis the side is one surface, whose radius is the lesser of the thread's and the cone's at every azimuth
and height. Triangles of the thread's mesh that the edge crosses are divided where it does; what lies beyond it comes
to lie on the cone. So vertices of the edge lie on both surfaces, and the mesh is as closed as the thread's was.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.mesh.solid import Face, Floats, Ints
from threadstate.mesh.thread_surface import ThreadSurface
from threadstate.thread.chamfer import Chamfer
from threadstate.thread.profile import Profile

SNAP = 0.15
"""A vertex is moved along its helix onto the edge where that is within this share of a side: fewer slivers."""
SAME_HELIX = 1e-9
"""In thread pitches, by how much axial positions on one helix may differ."""
BISECTIONS = 60


@dataclass(frozen=True, eq=False)
class Side:
    """The side as vertices (n, 3), triangles (m, 3), their faces (m,), and the outlines' vertices by azimuth."""

    vertices: Floats
    triangles: Ints
    faces: NDArray[np.int8]
    low: Ints
    high: Ints


def whole_thread(surface: ThreadSurface) -> Side:
    """The side of a part without a chamfer: its thread."""
    faces = np.full(len(surface.triangles), Face.THREAD, dtype=np.int8)
    return Side(surface.vertices, surface.triangles, faces, surface.low, surface.high)


def chamfered_side(surface: ThreadSurface, profile: Profile, chamfer: Chamfer) -> Side:
    """The side of a bolt whose thread's surface begins at z = 0."""
    cut = _Cut(surface, profile, chamfer)
    cut.move_near_vertices()
    return cut.divided()


class _Cut:
    """The thread's mesh unrolled to azimuths and heights, and by how much its vertices lie beyond the cone."""

    def __init__(self, surface: ThreadSurface, profile: Profile, chamfer: Chamfer) -> None:
        self._surface, self._profile, self._chamfer = surface, profile, chamfer
        x, y, self._z = surface.vertices.T
        self._azimuth = np.arctan2(y, x)
        self._z = self._z.copy()
        self._moved = np.zeros(len(self._z), dtype=bool)
        self._excess = self._excesses(self._azimuth, self._z)
        sides = np.sort(np.vstack([surface.triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]), axis=1)
        self._sides = np.unique(sides, axis=0)

    def _excesses(self, azimuths: Floats, heights: Floats) -> Floats:
        """How far the thread lies beyond the cone, along the radius."""
        s = heights - self._profile.advance * azimuths
        radii = np.array([self._profile.radius(place) for place in s.tolist()])
        return np.asarray(radii - self._chamfer.end_diameter / 2.0 - heights * self._chamfer.slope)

    def _crossings(self) -> tuple[Ints, Floats]:
        """The numbers of the sides that the edge crosses, and where on them, from 0 to 1."""
        a, b = self._excess[self._sides].T
        crossed = np.flatnonzero(a * b < 0.0)
        low, high = np.zeros(len(crossed)), np.ones(len(crossed))
        at_start = a[crossed] > 0.0
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            beyond = self._excesses(*self._places(crossed, middle)) > 0.0
            before = beyond == at_start
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        return crossed, 0.5 * (low + high)

    def _places(self, sides: Ints, shares: Floats) -> tuple[Floats, Floats]:
        """Azimuths and heights at shares of sides."""
        start, end = self._sides[sides].T
        turn = self._azimuth[end] - self._azimuth[start]
        turn -= 2.0 * math.pi * np.round(turn / (2.0 * math.pi))
        azimuths = self._azimuth[start] + shares * turn
        return azimuths, self._z[start] + shares * (self._z[end] - self._z[start])

    def move_near_vertices(self) -> None:
        """Move vertices onto the edge that it passes near to, along helices; those of the outlines stay.

        So a vertex at a corner of the profile stays at it.
        """
        crossed, shares = self._crossings()
        azimuths, heights = self._places(crossed, shares)
        start, end = self._sides[crossed].T
        from_start = shares < 0.5
        vertex = np.where(from_start, start, end)
        near = np.where(from_start, shares, 1.0 - shares)
        rise = self._z[end] - self._z[start]
        turn = self._azimuth[end] - self._azimuth[start]
        turn -= 2.0 * math.pi * np.round(turn / (2.0 * math.pi))
        on_helix = np.abs(rise - self._profile.advance * turn) < SAME_HELIX * self._profile.thread_pitch
        movable = on_helix & ~self._on_outline()[vertex]
        for i in np.argsort(near, kind="stable").tolist():
            if near[i] < SNAP and movable[i] and not self._moved[vertex[i]]:
                self._moved[vertex[i]] = True
                self._azimuth[vertex[i]], self._z[vertex[i]] = azimuths[i], heights[i]
                self._excess[vertex[i]] = 0.0

    def _on_outline(self) -> NDArray[np.bool_]:
        found = np.zeros(len(self._z), dtype=bool)
        found[self._surface.low] = found[self._surface.high] = True
        return found

    def divided(self) -> Side:
        """The side, its triangles divided along the edge."""
        crossed, shares = self._crossings()
        azimuths, heights = self._places(crossed, shares)
        count = len(self._z)
        between = {tuple(side): count + i for i, side in enumerate(self._sides[crossed].tolist())}
        excess = np.concatenate([self._excess, np.zeros(len(crossed))])
        azimuths, heights = np.concatenate([self._azimuth, azimuths]), np.concatenate([self._z, heights])

        signs = np.sign(self._excess[self._surface.triangles])
        whole = ~((signs > 0.0).any(axis=1) & (signs < 0.0).any(axis=1))
        triangles = self._surface.triangles[whole].tolist()
        for triangle in self._surface.triangles[~whole].tolist():
            triangles += _parts(triangle, self._excess, between)
        faces = np.array(triangles, dtype=np.int64)
        on_cone = excess[faces].sum(axis=1) > 0.0
        return Side(
            vertices=self._placed(azimuths, heights, excess),
            triangles=faces,
            faces=np.where(on_cone, Face.CHAMFER, Face.THREAD).astype(np.int8),
            low=self._outline(self._surface.low, between),
            high=self._surface.high,
        )

    def _placed(self, azimuths: Floats, heights: Floats, excess: Floats) -> Floats:
        """Points of the side; those of the thread alone that have not moved are the thread's, to the bit."""
        cone = self._chamfer.end_diameter / 2.0 + heights * self._chamfer.slope
        s = heights - self._profile.advance * azimuths
        thread = np.array([self._profile.radius(place) for place in s.tolist()])
        radii = np.where(excess < 0.0, thread, cone)
        points = np.column_stack([radii * np.cos(azimuths), radii * np.sin(azimuths), heights])
        old = np.flatnonzero((self._excess <= 0.0) & ~self._moved)
        points[old] = self._surface.vertices[old]
        return points

    def _outline(self, ring: Ints, between: dict[tuple[int, ...], int]) -> Ints:
        """An outline with the vertices at which the edge crosses it."""
        found: list[int] = []
        for a, b in zip(ring.tolist(), np.roll(ring, -1).tolist(), strict=True):
            found.append(a)
            if (middle := between.get((min(a, b), max(a, b)))) is not None:
                found.append(middle)
        return np.array(found, dtype=np.int64)


def _parts(triangle: list[int], excess: Floats, between: dict[tuple[int, ...], int]) -> list[list[int]]:
    """A triangle that the edge crosses, divided into those on both sides of it, turned as it was."""
    ring: list[int] = []
    for a, b in zip(triangle, [*triangle[1:], triangle[0]], strict=True):
        ring.append(a)
        if excess[a] * excess[b] < 0.0:
            ring.append(between[min(a, b), max(a, b)])
    # The edge runs between the two vertices of the ring that lie on it.
    on_edge = [i for i, v in enumerate(ring) if v >= len(excess) or excess[v] == 0.0]
    first, second = on_edge[0], on_edge[1]
    parts = (ring[first : second + 1], ring[second:] + ring[: first + 1])
    return [[part[0], part[i], part[i + 1]] for part in parts for i in range(1, len(part) - 1)]
