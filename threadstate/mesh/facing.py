"""Whether two surfaces that begin to meet close a gap, or open one."""

from __future__ import annotations

import numpy as np

from threadstate.mesh.frames import apply, inverse
from threadstate.mesh.solid import Floats, Ints, Solid
from threadstate.mesh.touch import Touch


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
