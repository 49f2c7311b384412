"""A cut end: the flat face from a thread's outline to a regular polygon around the axis."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from threadstate.mesh.solid import Floats, Ints, strip

SIDES = 16
"""Sides of the prism that the nut is cut from (the paper, section 4), and of the bolt's bore."""
NEAREST_RING = 0.5
"""Rings of faces end at this share of the way to the polygon: beyond it a few triangles are enough."""


@dataclass(frozen=True, eq=False)
class EndFace:
    """Vertices to append, triangles with normals up, and the numbers of the polygon's vertices."""

    vertices: Floats
    triangles: Ints
    polygon: Ints


def polygon_vertices(inradius: float, z: float) -> Floats:
    """The corners of the polygon by azimuth, from 0 on; shape (SIDES, 3)."""
    azimuths = 2.0 * math.pi * np.arange(SIDES) / SIDES
    r = inradius / math.cos(math.pi / SIDES)
    return np.column_stack([r * np.cos(azimuths), r * np.sin(azimuths), np.full(SIDES, z)])


def end_face(outline: Floats, numbers: Ints, inradius: float, first_number: int, *, halving: bool = False) -> EndFace:
    """The face between an outline and the polygon of that inradius, which lies wholly inside it or wholly outside.

    ``outline`` holds its points by azimuth, shape (n, 3), all at one height, ``numbers`` (n,) their vertex numbers; new
    vertices are numbered from ``first_number`` on. Beside the outline the face is divided into rings, each twice as
    wide as the one before, so that triangles there are small in both directions; with ``halving`` each but the first
    has half the vertices of the one before, too.
    """
    z = float(outline[0, 2])
    radii = np.hypot(outline[:, 0], outline[:, 1])
    azimuths = np.arctan2(outline[:, 1], outline[:, 0]) % (2.0 * math.pi)
    start = int(np.argmin(azimuths))
    radii, azimuths, ring = np.roll(radii, -start), np.roll(azimuths, -start), np.roll(numbers, -start)
    outward = bool(inradius > radii.max())
    side = 2.0 * math.pi / SIDES
    to_polygon = inradius / np.cos((azimuths + side / 2.0) % side - side / 2.0) - radii

    new: list[Floats] = []
    triangles: list[tuple[int, int, int]] = []
    number = first_number
    for k, share in enumerate(_ring_shares(radii, to_polygon)):
        step = 2 if halving and k and len(radii) > 2 * SIDES else 1
        radii, to_polygon, ring_azimuths = radii[::step], to_polygon[::step], azimuths[::step]
        r = radii + share * to_polygon
        after = number + np.arange(len(r))
        new.append(np.column_stack([r * np.cos(ring_azimuths), r * np.sin(ring_azimuths), np.full(len(r), z)]))
        triangles += _between(ring, azimuths, after, ring_azimuths, outward)
        ring, azimuths, number = after, ring_azimuths, number + len(r)
    polygon = number + np.arange(SIDES)
    new.append(polygon_vertices(inradius, z))
    triangles += _between(ring, azimuths, polygon, side * np.arange(SIDES, dtype=np.float64), outward)
    return EndFace(np.vstack(new), np.array(triangles, dtype=np.int64), polygon)


def _ring_shares(radii: Floats, to_polygon: Floats) -> list[float]:
    """Shares of the way from the outline to the polygon at which rings lie, ascending."""
    first = 2.0 * math.pi * radii.mean() / len(radii) / np.abs(to_polygon).mean()
    shares = []
    share = width = float(first)
    while share < NEAREST_RING:
        shares.append(share)
        width *= 2.0
        share += width
    return shares


def _between(
    ring: Ints, azimuths: Floats, other: Ints, other_azimuths: Floats, outward: bool
) -> list[tuple[int, int, int]]:
    """Triangles, normals up, between two rings by azimuth; ``other`` lies outside ``ring`` if ``outward``."""
    rows = [(ring, azimuths), (other, other_azimuths)]
    (outer, outer_azimuths), (inner, inner_azimuths) = reversed(rows) if outward else rows
    closed_outer, closed_inner = np.append(outer, outer[0]), np.append(inner, inner[0])
    first_inner = len(closed_outer)
    numbers = np.concatenate([closed_outer, closed_inner]).tolist()
    # Seen from above and running counter-clockwise, what lies outside is to the right.
    local = strip(_closed(inner_azimuths), _closed(outer_azimuths), first_inner, 0)
    return [(numbers[a], numbers[b], numbers[c]) for a, b, c in local]


def _closed(azimuths: Floats) -> Floats:
    return np.append(azimuths, azimuths[0] + 2.0 * math.pi)
