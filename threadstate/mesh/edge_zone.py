"""A part whose triangles are fine along its edge curve and coarser away from it."""

from __future__ import annotations

import math

import numpy as np

from threadstate.mesh.end_face import end_face
from threadstate.mesh.presets import LARGEST_CHORD, Tessellation
from threadstate.mesh.solid import Face, Floats, Ints, Solid, strip
from threadstate.mesh.thread_surface import ThreadSurface, profile_cuts, thread_surface
from threadstate.thread.profile import Profile

ZONE = 0.3
"""How far, in thread pitches, the thread is as fine as its edge curve.

Within 4 deg of tilt first and second contacts lie at most 0.21 from a cut end, 99 of 100 third ones within 0.31.
"""
COARSER = 10.0
"""How many times as large the chord height is beyond."""
BETWEEN = 0.5
"""Rows of the coarser thread, mean ones, that are between the two."""


def edge_zone_part(
    profile: Profile, inradius: float, part_size: float, tessellation: Tessellation, *, outward: bool
) -> Solid:
    """Thread and cut end of a part, in its own frame; ``outward`` is the bolt, which ends at z = 0 below, not above.

    The mesh is open: at the thread's far rim, whose triangles count as a far end (a contact there does not count), and
    at the polygon of that inradius, which the cut end extends to.
    """
    p = profile.thread_pitch
    coarse = Tessellation(min(COARSER * tessellation.chord_height, LARGEST_CHORD), tessellation.angle_control)
    fine = thread_surface(profile, 0.0, tessellation, part_size, ZONE * p)
    start = (ZONE + BETWEEN / (len(profile_cuts(profile, coarse, part_size)) - 1)) * p
    far = thread_surface(profile, start, coarse, part_size, p - start)
    offset = len(fine.vertices)
    cut = end_face(fine.vertices[fine.low], fine.low, inradius, offset + len(far.vertices), halving=True)

    vertices = np.vstack([fine.vertices, far.vertices, cut.vertices])
    thread = np.vstack([fine.triangles, _joined(fine, far), far.triangles + offset])
    rim = np.zeros(len(vertices), dtype=bool)
    rim[far.high + offset] = True
    faces = np.where(rim[thread].any(axis=1), Face.FAR_END, Face.THREAD).astype(np.int8)
    triangles = np.vstack([thread if outward else thread[:, ::-1], cut.triangles[:, ::-1]])
    placed = vertices if outward else _turned_upside_down(vertices, profile.starts)
    azimuths = _azimuths(placed[fine.low])
    return Solid(
        vertices=placed,
        triangles=triangles,
        faces=np.concatenate([faces, np.full(len(cut.triangles), Face.CUT, dtype=np.int8)]),
        edge=fine.low[np.argsort(azimuths)],
    )


def _turned_upside_down(vertices: Floats, starts: int) -> Floats:
    """By half a turn about an axis across it, at an odd multiple of a quarter turn over the starts, a thread comes to
    lie on itself: its profile is symmetric.
    """
    if starts % 2:
        return np.asarray(vertices * (-1.0, 1.0, -1.0) + 0.0)
    cosine, sine = math.cos(math.pi / starts), math.sin(math.pi / starts)
    x, y, z = vertices.T
    return np.column_stack([cosine * x + sine * y, sine * x - cosine * y, -z])


def _joined(low: ThreadSurface, high: ThreadSurface) -> Ints:
    """Triangles, normals away from the axis, from one surface's top to the bottom of that above it."""
    rows = []
    for surface, ring, first in ((high, high.low, len(low.vertices)), (low, low.high, 0)):
        azimuths = _azimuths(surface.vertices[ring])
        order = np.argsort(azimuths)
        numbers = ring[order] + first
        rows.append((np.append(azimuths[order], azimuths[order[0]] + 2.0 * math.pi), np.append(numbers, numbers[0])))
    (above, above_numbers), (below, below_numbers) = rows
    numbers = np.concatenate([above_numbers, below_numbers])
    # Seen from outside and running to the right, what lies below is to the right.
    return np.asarray(numbers[np.array(strip(above, below, 0, len(above)), dtype=np.int64)])


def _azimuths(points: Floats) -> Floats:
    return np.asarray(np.arctan2(points[:, 1], points[:, 0]) % (2.0 * math.pi))
