"""A cluster of colliding triangles as one contact: its place and the features that touch."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from threadstate.contact import _stage_kernel as stage
from threadstate.mesh.clusters import Cluster
from threadstate.mesh.frames import apply, inverse
from threadstate.mesh.segments import Intersection, Segments, intersection_segments
from threadstate.mesh.solid import Face, Floats, Ints, Solid

EDGE = frozenset({Face.THREAD, Face.CUT})
_FEATURES = {
    (EDGE, EDGE): stage.EDGE_EDGE,
    (EDGE, frozenset({Face.CUT})): stage.EDGE_SURFACE,
    (EDGE, frozenset({Face.THREAD})): stage.EDGE_THREAD,
    (frozenset({Face.CUT}), EDGE): stage.BASE_EDGE,
    (frozenset({Face.CUT}), frozenset({Face.THREAD})): stage.BASE_EDGE,
    (frozenset({Face.THREAD}), EDGE): stage.THREAD_EDGE,
    (frozenset({Face.THREAD}), frozenset({Face.THREAD})): stage.THREAD_THREAD,
    (frozenset({Face.THREAD}), frozenset({Face.CUT})): stage.THREAD_SURFACE,
}
"""Features by the faces whose triangles collide: a part's edge is where its thread and its cut end both do. A thread
alone against the base touches it with its edge, where it is cut off; so does one that reaches its edge, against the
surface."""


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
    on_bolt = frozenset(_side(Face(face)) for face in bolt.faces[cluster.pairs[:, 0]].tolist())
    on_nut = frozenset(Face(face) for face in nut.faces[cluster.pairs[:, 1]].tolist())
    features = _FEATURES.get((on_bolt, on_nut))
    if features == stage.THREAD_SURFACE and np.isin(bolt.triangles[cluster.pairs[:, 0]], bolt.edge).any():
        return stage.EDGE_SURFACE
    if features is None:
        names = [" and ".join(sorted(face.name.lower() for face in faces)) for faces in (on_bolt, on_nut)]
        raise NoContactPointError(f"the bolt's {names[0]} against the nut's {names[1]} is not a contact of the method")
    return features


def _side(face: Face) -> Face:
    """What a face is as a feature: the cone of a chamfered bolt is part of its side, as its thread is."""
    return Face.THREAD if face is Face.CHAMFER else face


def closes_a_gap(contact: Touch, bolt: Solid, nut: Solid, T_nut_bolt: Floats, T_later: Floats) -> bool:
    """Whether a contact that has just appeared begins a new overlap; ``T_later`` is the pose a moment later.

    Otherwise its cluster bounds a hole in an overlap that is open already, which is no contact. Along the common normal
    (that of the part which meets with a face, the cross product of the two edges where both meet with an edge) a gap
    closes where the outward normals of the two parts are opposed and the bolt moves against the nut's.
    """
    pairs = contact.cluster.pairs
    on_bolt = [T_nut_bolt[:3, :3] @ normal for normal in _face_normals(bolt, pairs[:, 0])]
    on_nut = _face_normals(nut, pairs[:, 1])
    if len(on_bolt) > 1 and len(on_nut) > 1:
        common = np.cross(np.cross(on_bolt[0], on_bolt[1]), np.cross(on_nut[0], on_nut[1]))
    else:
        common = on_nut[0] if len(on_nut) == 1 else on_bolt[0]
    from_nut = common if common @ sum(on_nut) > 0.0 else -common
    moved = apply(T_later, apply(inverse(T_nut_bolt), contact.point)) - contact.point
    return bool(from_nut @ sum(on_bolt) < 0.0 and from_nut @ moved < 0.0)


def _face_normals(solid: Solid, triangles: Ints) -> list[Floats]:
    """The mean unit normals of the faces that triangles belong to, by :class:`Face`."""
    corners = solid.vertices[solid.triangles[triangles]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    faces = solid.faces[triangles]
    means = [normals[faces == face].mean(axis=0) for face in np.unique(faces)]
    return [mean / np.linalg.norm(mean) for mean in means]
