"""A cluster of colliding triangles as one contact: its place and the features that touch."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from threadstate.contact import _stage_kernel as stage
from threadstate.mesh.clusters import Cluster
from threadstate.mesh.frames import apply, inverse
from threadstate.mesh.segments import Intersection, Segments, intersection_segments
from threadstate.mesh.solid import Face, Floats, Solid

EDGE = frozenset({Face.THREAD, Face.CUT})
_FEATURES = {
    (EDGE, EDGE): stage.EDGE_EDGE,
    (EDGE, frozenset({Face.CUT})): stage.EDGE_SURFACE,
    (EDGE, frozenset({Face.THREAD})): stage.EDGE_THREAD,
    (frozenset({Face.CUT}), EDGE): stage.BASE_EDGE,
    (frozenset({Face.CUT}), frozenset({Face.THREAD})): stage.BASE_EDGE,
    (frozenset({Face.THREAD}), EDGE): stage.THREAD_EDGE,
    (frozenset({Face.THREAD}), frozenset({Face.THREAD})): stage.THREAD_THREAD,
    (frozenset({Face.THREAD}), frozenset({Face.CUT})): stage.EDGE_SURFACE,
}
"""Features by the faces whose triangles collide: a part's edge is where its thread and its cut end both do. A thread
alone against a plane touches it with its edge, where it is cut off."""


class NoContactPointError(Exception):
    """A cluster has no contact point or no features; the message says why."""


@dataclass(frozen=True, eq=False)
class Touch:
    """A contact of two meshes: its cluster, the pair of features (as the kernels number them), its point (3,) in F."""

    cluster: Cluster
    features: int
    point: Floats

    def numbers(self, T_nut_bolt: Floats) -> Floats:
        """The contact as the kernels' row of numbers, at time 0."""
        at_bolt = apply(inverse(T_nut_bolt), self.point)
        row = np.zeros(stage.CONTACT_SIZE)
        row[stage.K_PAIR] = self.features
        row[stage.K_BOLT_AZIMUTH] = math.atan2(at_bolt[1], at_bolt[0])
        row[stage.K_NUT_AZIMUTH] = math.atan2(self.point[1], self.point[0])
        row[stage.K_X : stage.K_Z + 1] = self.point
        return row


def touch(cluster: Cluster, bolt: Solid, nut: Solid, T_nut_bolt: Floats) -> Touch:
    """The contact that a cluster is, in its pose.

    Raises:
        NoContactPointError: no two of its triangles meet in a segment, or its faces name no features.
    """
    return Touch(cluster, _features(cluster, bolt, nut), _point(cluster_segments(cluster, bolt, nut, T_nut_bolt)))


def touches_beyond(cluster: Cluster, bolt: Solid, nut: Solid) -> bool:
    """Whether a cluster holds a part's far end or walls, which do not exist there (method, section 1): no contact."""
    return any(
        np.isin(solid.faces[cluster.pairs[:, k]], (Face.FAR_END, Face.WALL)).any()
        for k, solid in enumerate((bolt, nut))
    )


def cluster_segments(cluster: Cluster, bolt: Solid, nut: Solid, T_nut_bolt: Floats) -> Segments:
    """The segments of a cluster's pairs of triangles, in the nut's frame."""
    on_bolt = apply(T_nut_bolt, bolt.vertices[bolt.triangles[cluster.pairs[:, 0]]])
    return intersection_segments(on_bolt, nut.vertices[nut.triangles[cluster.pairs[:, 1]]])


def _point(segments: Segments) -> Floats:
    """The mean of the midpoints; of pairs that do not meet (type IV) only where there are no others."""
    for types in ((Intersection.I, Intersection.II, Intersection.III), (Intersection.IV,)):
        chosen = np.isin(segments.types, types)
        if chosen.any():
            return np.asarray(segments.midpoints[chosen].mean(axis=0))
    raise NoContactPointError("colliding triangles lie in one plane and have no segment in common")


def _features(cluster: Cluster, bolt: Solid, nut: Solid) -> int:
    on_bolt = frozenset(Face(face) for face in bolt.faces[cluster.pairs[:, 0]].tolist())
    on_nut = frozenset(Face(face) for face in nut.faces[cluster.pairs[:, 1]].tolist())
    features = _FEATURES.get((on_bolt, on_nut))
    if features is None:
        names = [" and ".join(sorted(face.name.lower() for face in faces)) for faces in (on_bolt, on_nut)]
        raise NoContactPointError(f"the bolt's {names[0]} against the nut's {names[1]} is not a contact of the method")
    return features
