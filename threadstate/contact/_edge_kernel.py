"""What a search along one part's edge curve stands on, and a box of it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Edge(NamedTuple):
    """The edge curve of one part that moves relative to the other part's solid.

    Attributes:
        motion: as in ``_geometry_kernel``, of the curve's part in the frame of the solid.
        curve: packed profile of the part that has the curve.
        solid: packed profile of the other part.
        kept: earlier contacts on the curve (``_beside_kernel``).
        path: scratch of a point's path.
        wide: the motion in sums of two doubles (``_refined_edge_kernel``); no rows: the edge is not refined.
    """

    motion: Array
    curve: Array
    solid: Array
    kept: Array
    path: Array
    wide: Array


class Box(NamedTuple):
    """A box of azimuth and time: middle and half-width of its azimuths (rad), start and end of its times."""

    theta: float
    half: float
    start: float
    end: float
