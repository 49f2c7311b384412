"""Bolt and nut as closed triangle meshes, for the mesh library that the exact method is measured against.

The thread surface is cut along helices at chosen points of the profile, so that across a strip only the fillets are
approximated; every vertex lies on the true surface. With the constants below each part has 60,476 triangles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.thread.pair import Pair
from threadstate.thread.profile import Profile

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SEGMENTS = 720
"""Segments a turn: chords of half a degree, 1.2e-6 in below the arc at the largest radius of 1/4-20."""
FILLET_CUTS, STRAIGHT_CUTS = 6, 2
"""Strips per fillet, and per flat or flank."""
RINGS = 2
"""Rings of faces on each cut end, so that no triangle is much longer than the others: slivers slow a search tree."""
BOLT_BORE, NUT_WALL = 0.9, 1.06
"""As in the paper, the bolt is hollow and the nut a thin ring: only what can touch is there to be searched."""


@dataclass(frozen=True)
class Mesh:
    """Vertices, shape (n, 3), in the part's frame and the pair's unit; triangles, shape (m, 3), normals outward."""

    vertices: Floats
    triangles: Ints

    def volume(self) -> float:
        """The enclosed volume; positive where normals point outward."""
        a, b, c = (self.vertices[self.triangles[:, k]] for k in range(3))
        return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)

    def is_closed(self) -> bool:
        """Whether every edge is used once in each direction."""
        edges = np.concatenate([self.triangles[:, [0, 1]], self.triangles[:, [1, 2]], self.triangles[:, [2, 0]]])
        n = len(self.vertices)
        forward = np.sort(edges[:, 0] * n + edges[:, 1])
        backward = np.sort(edges[:, 1] * n + edges[:, 0])
        return bool(np.all(np.diff(forward) > 0) and np.array_equal(forward, backward))


def profile_cuts(profile: Profile) -> Floats:
    """Axial positions in one period, ascending from -p/4, at which the profile is cut."""
    p = profile.thread_pitch
    flat, flank, crest, top = profile.boundaries
    ends = [-p / 4, flat, flank, crest, top, p / 4]
    counts = [STRAIGHT_CUTS, FILLET_CUTS, STRAIGHT_CUTS, FILLET_CUTS, STRAIGHT_CUTS]
    rising = np.concatenate(
        [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(ends, ends[1:], counts, strict=False)]
    )
    falling = p / 2 - rising[1:][::-1]
    return np.concatenate([rising, [p / 4], falling])


def _thread(profile: Profile, z_low: float) -> tuple[list[Floats], list[Floats]]:
    """Per azimuth: the vertices' axial positions from z_low to z_low + p, and their radii."""
    p = profile.thread_pitch
    cuts = profile_cuts(profile)
    heights, radii = [], []
    for i in range(SEGMENTS):
        start = z_low - p * i / SEGMENTS
        first = math.floor((start - cuts[0]) / p)
        s = np.concatenate([cuts + p * (first + k) for k in range(3)])
        margin = 1e-6 * p
        inside = s[(s > start + margin) & (s < start + p - margin)]
        s = np.concatenate([[start], inside, [start + p]])
        z = s - start + z_low
        z[0], z[-1] = z_low, z_low + p
        heights.append(z)
        radii.append(np.array([profile.radius(float(v)) for v in s]))
    return heights, radii


def _strip(low: Ints, high: Ints, s_low: Floats, s_high: Floats) -> list[tuple[int, int, int]]:
    """Triangles between two columns of vertices, paired by their position along the profile."""
    triangles = []
    i = j = 0
    while i < len(low) - 1 or j < len(high) - 1:
        if j == len(high) - 1 or (i < len(low) - 1 and s_low[i + 1] <= s_high[j + 1]):
            triangles.append((int(low[i]), int(high[j]), int(low[i + 1])))
            i += 1
        else:
            triangles.append((int(low[i]), int(high[j]), int(high[j + 1])))
            j += 1
    return triangles


def _thread_mesh(profile: Profile, z_low: float) -> tuple[Floats, list[tuple[int, int, int]], Ints, Ints]:
    """Vertices and triangles of a thread surface (normals away from the axis), its lower ring and its upper ring."""
    p = profile.thread_pitch
    heights, radii = _thread(profile, z_low)
    counts = np.array([len(z) for z in heights])
    offsets = np.concatenate([[0], np.cumsum(counts)])
    azimuths = 2 * math.pi * np.repeat(np.arange(SEGMENTS), counts) / SEGMENTS
    r, z = np.concatenate(radii), np.concatenate(heights)
    vertices = np.column_stack([r * np.cos(azimuths), r * np.sin(azimuths), z])
    triangles: list[tuple[int, int, int]] = []
    for i in range(SEGMENTS):
        after = (i + 1) % SEGMENTS
        low = np.arange(offsets[i], offsets[i + 1])
        high = np.arange(offsets[after], offsets[after + 1])
        # The next column's profile is shifted by a segment's share of the helix.
        triangles += _strip(low, high, heights[i], heights[after] - p / SEGMENTS)
    return vertices, triangles, offsets[:-1], offsets[1:] - 1


def _ring(r: Floats, z: float) -> Floats:
    a = 2 * math.pi * np.arange(SEGMENTS) / SEGMENTS
    return np.column_stack([r * np.cos(a), r * np.sin(a), np.full(SEGMENTS, z)])


def _annulus(inner: Ints, outer: Ints, upward: bool) -> list[tuple[int, int, int]]:
    triangles = []
    for i in range(SEGMENTS):
        k = (i + 1) % SEGMENTS
        pair = [(inner[i], outer[i], outer[k]), (inner[i], outer[k], inner[k])]
        triangles += [(int(a), int(b), int(c)) if upward else (int(a), int(c), int(b)) for a, b, c in pair]
    return triangles


def _ring_radii(start: Floats, end: float) -> list[Floats]:
    """Radii of the rings from an outline to a circle, the circle last."""
    return [start + (end - start) * k / RINGS for k in range(1, RINGS + 1)]


def _part(profile: Profile, z_low: float, wall_radius: float, outward: bool) -> Mesh:
    """A thread closed by two rings of faces and a cylindrical wall: inside the thread (bolt) or outside it (nut)."""
    vertices, triangles, low, high = _thread_mesh(profile, z_low)
    if not outward:
        triangles = [(a, c, b) for a, b, c in triangles]
    z_high = z_low + profile.thread_pitch
    walls = []
    for outline, z, upward in ((low, z_low, False), (high, z_high, True)):
        ring = outline
        for radii in _ring_radii(np.hypot(vertices[outline, 0], vertices[outline, 1]), wall_radius):
            after = len(vertices) + np.arange(SEGMENTS)
            vertices = np.vstack([vertices, _ring(radii, z)])
            inner, outer = (after, ring) if outward else (ring, after)
            triangles += _annulus(inner, outer, upward)
            ring = after
        walls.append(ring)
    bottom, top = walls
    for i in range(SEGMENTS):
        k = (i + 1) % SEGMENTS
        for a, b, c in ((bottom[i], bottom[k], top[k]), (bottom[i], top[k], top[i])):
            triangles.append((int(a), int(c), int(b)) if outward else (int(a), int(b), int(c)))
    return Mesh(vertices, np.array(triangles))


def bolt_mesh(pair: Pair) -> Mesh:
    """The bolt, 0 <= z <= p, base at z = 0; hollow inside ``BOLT_BORE`` of its minor radius, where no nut reaches."""
    return _part(pair.bolt, 0.0, BOLT_BORE * pair.fit.bolt_minor_diameter / 2, outward=True)


def nut_mesh(pair: Pair) -> Mesh:
    """The nut, -p <= z <= 0, surface at z = 0; as a ring of ``NUT_WALL`` major radii, farther than any bolt reaches."""
    return _part(pair.nut, -pair.thread_pitch, NUT_WALL * pair.fit.nut_major_diameter / 2, outward=False)
