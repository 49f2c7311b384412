"""A part as a closed triangle mesh."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

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
