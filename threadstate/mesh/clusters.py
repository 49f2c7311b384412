"""Colliding pairs of triangles, grouped where the meshes connect them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from threadstate.mesh.solid import Ints, Solid

Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Cluster:
    """A connected component of the curve in which two meshes meet: pairs of triangles, the bolt's first, (k, 2)."""

    pairs: Ints
    joints: Ints
    """Its pairs of vertices, one of each mesh, as single numbers; clusters that share one are connected. Ascending."""


@dataclass(frozen=True, eq=False)
class Neighbourhood:
    """A place on both meshes: masks of its vertices."""

    bolt: Mask
    nut: Mask


class Connectivity:
    """What is connected with what on two meshes."""

    def __init__(self, bolt: Solid, nut: Solid) -> None:
        self._bolt, self._nut = bolt, nut

    def clusters(self, pairs: Ints) -> tuple[Cluster, ...]:
        """Colliding pairs, shape (k, 2), by component; the order is that of the first pair of each.

        Two pairs are connected where their bolt triangles share a vertex and their nut triangles do.
        """
        if len(pairs) == 0:
            return ()
        joints = self._joints(pairs)
        numbers, inverse = np.unique(joints.ravel(), return_inverse=True)
        rows = np.repeat(np.arange(len(pairs)), 9)
        size = len(pairs) + len(numbers)
        graph = coo_array((np.ones(len(rows), dtype=np.int8), (rows, len(pairs) + inverse.ravel())), shape=(size, size))
        _, labels = connected_components(graph, directed=False)
        of_pairs = labels[: len(pairs)]
        _, first = np.unique(of_pairs, return_index=True)
        return tuple(
            Cluster(pairs[mine], np.unique(joints[mine]))
            for label in of_pairs[np.sort(first)]
            for mine in (of_pairs == label,)
        )

    def neighbourhood(self, cluster: Cluster, rings: int = 0) -> Neighbourhood:
        """The vertices of a cluster's triangles, and of that many rings of triangles about them."""
        return Neighbourhood(
            _vertices(self._bolt, cluster.pairs[:, 0], rings), _vertices(self._nut, cluster.pairs[:, 1], rings)
        )

    def reaches(self, cluster: Cluster, place: Neighbourhood) -> bool:
        """Whether both triangles of a pair of the cluster have vertices in a place."""
        on_bolt = place.bolt[self._bolt.triangles[cluster.pairs[:, 0]]].any(axis=1)
        on_nut = place.nut[self._nut.triangles[cluster.pairs[:, 1]]].any(axis=1)
        return bool((on_bolt & on_nut).any())

    def _joints(self, pairs: Ints) -> Ints:
        bolt = self._bolt.triangles[pairs[:, 0]]
        nut = self._nut.triangles[pairs[:, 1]]
        return (bolt[:, :, None] * len(self._nut.vertices) + nut[:, None, :]).reshape(len(pairs), 9)


def connected(one: Cluster, other: Cluster) -> bool:
    """Whether two clusters, of poses that follow each other, have a pair of vertices in common."""
    return bool(np.isin(one.joints, other.joints, assume_unique=True).any())


def _vertices(solid: Solid, triangles: Ints, rings: int) -> Mask:
    found = np.zeros(len(solid.vertices), dtype=bool)
    found[solid.triangles[triangles]] = True
    for _ in range(rings):
        found[solid.triangles[found[solid.triangles].any(axis=1)]] = True
    return found
