"""Edges with arrays of their own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate.contact._beside_kernel import KEPT_SIZE
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._geometry_kernel import PATH_SIZE
from threadstate.contact._refined_edge_kernel import set_refined_motions
from threadstate.contact._wide_kernel import WIDE_MOTION_SIZE, widen_motion

Array = NDArray[np.float64]


def new_kept(room: int) -> Array:
    """An empty list with room for so many earlier contacts."""
    return np.zeros((1 + room, KEPT_SIZE))


def new_edge(motion: Array, curve: Array, solid: Array, kept: Array) -> Edge:
    """An edge that is not refined."""
    return Edge(motion, curve, solid, kept, np.empty(PATH_SIZE), np.empty((0, 2)))


def wide_motion(motion: Array) -> Array:
    """A motion in sums of two doubles, (18, 2)."""
    wide = np.empty((WIDE_MOTION_SIZE, 2))
    widen_motion(motion, wide)
    return wide


def refined_edges(bolt_edge: Edge, nut_edge: Edge, wide: Array) -> tuple[Edge, Edge]:
    """Both edges with the bolt's motion in sums of two doubles."""
    bolt_wide, nut_wide = np.empty_like(wide), np.empty_like(wide)
    set_refined_motions(wide, bolt_edge.motion, nut_edge.motion, bolt_wide, nut_wide)
    return bolt_edge._replace(wide=bolt_wide), nut_edge._replace(wide=nut_wide)
