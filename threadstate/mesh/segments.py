"""The segment in which two triangles meet (the paper, sections 4.1 and 4.2)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from threadstate.mesh.solid import Floats

PARALLEL = 1e-14
"""Planes whose unit normals have a smaller vector product have no line in common."""


class Intersection(IntEnum):
    """How the two triangles divide the line in which their planes meet; b are the bolt's ends on it, n the nut's."""

    I = 1  # noqa: E741 - the paper's name
    """n b n b: they overlap in part."""
    II = 2
    """b n n b: the nut's part lies within the bolt's."""
    III = 3
    """n b b n: the bolt's part lies within the nut's."""
    IV = 4
    """n n b b: both reach the line, apart from each other; the collision library was inexact."""
    V = 5
    """One of them does not reach the line, or there is no line."""


@dataclass(frozen=True, eq=False)
class Segments:
    """Types (k,) and ends (k, 3) of the segments.

    Of type IV the segment is the bolt's part of the line, as the paper has it; of type V, too, unless the bolt's
    triangle does not reach the line: then the ends are NaN.
    """

    types: NDArray[np.int8]
    starts: Floats
    ends: Floats

    @property
    def midpoints(self) -> Floats:
        """Shape (k, 3)."""
        return 0.5 * (self.starts + self.ends)


def intersection_segments(bolt: Floats, nut: Floats) -> Segments:
    """The segments of pairs of triangles, both of shape (k, 3, 3) by corner and coordinate, in one frame."""
    bolt_normals, nut_normals = _normals(bolt), _normals(nut)
    line = np.cross(bolt_normals, nut_normals)
    b, b_points = _part_of_line(bolt, nut[:, 0], nut_normals, line)
    n, n_points = _part_of_line(nut, bolt[:, 0], bolt_normals, line)
    apart = np.linalg.norm(line, axis=1) < PARALLEL
    b[apart], n[apart] = np.nan, np.nan
    b_points[apart] = np.nan

    with np.errstate(invalid="ignore"):
        none = np.isnan(b[:, 0]) | np.isnan(n[:, 0])
        disjoint = (n[:, 1] < b[:, 0]) | (b[:, 1] < n[:, 0])
        nut_within = (b[:, 0] <= n[:, 0]) & (n[:, 1] <= b[:, 1])
        bolt_within = (n[:, 0] <= b[:, 0]) & (b[:, 1] <= n[:, 1])
        types = np.select(
            [none, disjoint, nut_within, bolt_within],
            [Intersection.V, Intersection.IV, Intersection.II, Intersection.III],
            Intersection.I,
        )
        bolts_own = none | disjoint
        from_bolt = (bolts_own | (b[:, 0] >= n[:, 0]))[:, None]
        to_bolt = (bolts_own | (b[:, 1] <= n[:, 1]))[:, None]
    return Segments(
        types=types.astype(np.int8),
        starts=np.where(from_bolt, b_points[:, 0], n_points[:, 0]),
        ends=np.where(to_bolt, b_points[:, 1], n_points[:, 1]),
    )


def _normals(triangles: Floats) -> Floats:
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    return np.asarray(normals / np.linalg.norm(normals, axis=1, keepdims=True))


def _part_of_line(triangles: Floats, points: Floats, normals: Floats, line: Floats) -> tuple[Floats, Floats]:
    """Where triangles begin and end along the line: places (k, 2), ascending, and points (k, 2, 3); NaN where not.

    ``points`` and ``normals`` give the other triangles' planes.
    """
    height = np.einsum("kij,kj->ki", triangles - points[:, None], normals)
    crossings = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        a, b = height[:, i], height[:, j]
        across = (a > 0.0) != (b > 0.0)
        share = np.where(across, a / np.where(across, a - b, 1.0), np.nan)[:, None]
        crossings.append(triangles[:, i] + share * (triangles[:, j] - triangles[:, i]))
    found = np.stack(crossings, axis=1)
    places = np.einsum("kij,kj->ki", found, line)
    # A plane crosses two sides of a triangle or none; NaN sorts last.
    order = np.argsort(places, axis=1)[:, :2]
    rows = np.arange(len(triangles))[:, None]
    return places[rows, order], found[rows, order]
