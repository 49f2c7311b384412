"""Collision and distance of two solids by coal; the one file that imports it."""

from __future__ import annotations

import coal
import numpy as np

from threadstate.mesh.collision import MAX_PAIRS, TooManyPairsError
from threadstate.mesh.solid import Floats, Ints, Solid


class CoalEngine:
    """As ``threadstate.mesh.collision.Collider``, by coal's trees of boxes and spheres."""

    def __init__(self, bolt: Solid, nut: Solid) -> None:
        self._bolt, self._nut = _tree(bolt), _tree(nut)
        self._at_rest = coal.Transform3s.Identity()
        self._any, self._all = (coal.CollisionRequest(coal.CONTACT, count) for count in (1, MAX_PAIRS))
        for request in (self._any, self._all):
            request.enable_contact = False
        self._distance = coal.DistanceRequest()

    def collides(self, T_nut_bolt: Floats) -> bool:
        """Whether any triangles meet."""
        return bool(coal.collide(*self._placed(T_nut_bolt), self._any, coal.CollisionResult()))

    def pairs(self, T_nut_bolt: Floats) -> Ints:
        """The triangles that meet, (k, 2), ascending."""
        result = coal.CollisionResult()
        if coal.collide(*self._placed(T_nut_bolt), self._all, result) >= MAX_PAIRS:
            raise TooManyPairsError(f"more than {MAX_PAIRS} pairs of triangles collide")
        pairs = [(contact.b1, contact.b2) for contact in result.getContacts()]
        return np.unique(np.array(pairs, dtype=np.int64).reshape(-1, 2), axis=0)

    def distance(self, T_nut_bolt: Floats) -> float:
        """The least distance of the surfaces."""
        return max(0.0, float(coal.distance(*self._placed(T_nut_bolt), self._distance, coal.DistanceResult())))

    def _placed(self, T_nut_bolt: Floats) -> tuple[object, object, object, object]:
        placed = coal.Transform3s(T_nut_bolt[:3, :3], T_nut_bolt[:3, 3])
        return self._bolt, placed, self._nut, self._at_rest


def _tree(solid: Solid) -> object:
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(solid.triangles), len(solid.vertices))
    model.addVertices(np.array(solid.vertices))
    model.addTriangles(np.array(solid.triangles))
    model.endModel()
    return model
