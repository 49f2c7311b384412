"""A part as a closed triangle mesh, and how far that is from the true surface."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from threadstate.thread.profile import Profile

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Face(IntEnum):
    """What a triangle belongs to."""

    THREAD = 0
    CUT = 1
    """The cut end that can touch: the bolt's base, the nut's surface."""
    FAR_END = 2
    WALL = 3
    """The bolt's bore, or the sides of the prism that the nut is cut from."""
    CHAMFER = 4
    """The cone of a chamfered bolt."""


@dataclass(frozen=True, eq=False)
class Solid:
    """A closed mesh in the part's own frame, lengths in the pair's unit; its arrays are made read-only.

    ``vertices`` has shape (n, 3); ``triangles`` (m, 3) indexes them, counter-clockwise seen from outside; ``faces``
    (m,) holds each triangle's :class:`Face`. ``edge`` (k,) indexes the vertices of the edge curve that can touch (the
    outline of the cut end), in order of growing azimuth.
    """

    vertices: Floats
    triangles: Ints
    faces: NDArray[np.int8]
    edge: Ints

    def __post_init__(self) -> None:
        for array in (self.vertices, self.triangles, self.faces, self.edge):
            array.setflags(write=False)


@dataclass(frozen=True, slots=True)
class Deviation:
    """Largest distances from the mesh: ``surface`` to the thread, ``edge`` to the edge curve; in the pair's unit."""

    surface: float
    edge: float


def deviation(solid: Solid, profile: Profile) -> Deviation:
    """The deviation of a part of that profile, by the closed form of the profile.

    Every triangle of the thread is sampled at 15 points, every segment of the edge at 4; flat faces are exact.
    """
    from threadstate.mesh import _deviation_kernel as kernel

    threads = np.ascontiguousarray(solid.triangles[solid.faces == Face.THREAD])
    vertices = np.array(solid.vertices)
    return Deviation(
        surface=float(kernel.largest_of_triangles(vertices, threads, profile.packed)),
        edge=float(kernel.largest_of_outline(vertices[solid.edge], profile.packed)),
    )


def strip(low: Floats, high: Floats, first_low: int, first_high: int) -> list[tuple[int, int, int]]:
    """Triangles between two rows, whose vertices are numbered from ``first_low`` and ``first_high`` on.

    ``low`` and ``high`` say where each vertex lies along its row, ascending; the row that lags behind goes on. Seen
    with ``high`` to the right of ``low`` and both running up, triangles are counter-clockwise.
    """
    triangles = []
    i, j = 0, 0
    last_i, last_j = len(low) - 1, len(high) - 1
    along_low, along_high = low.tolist(), high.tolist()
    while i < last_i or j < last_j:
        if j == last_j or (i < last_i and along_low[i + 1] <= along_high[j + 1]):
            triangles.append((first_low + i, first_high + j, first_low + i + 1))
            i += 1
        else:
            triangles.append((first_low + i, first_high + j, first_high + j + 1))
            j += 1
    return triangles
