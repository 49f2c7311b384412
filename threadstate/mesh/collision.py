"""Collision and distance of two solids; the one file that imports fcl."""

from __future__ import annotations

from typing import Protocol

import fcl
import numpy as np

from threadstate.errors import ThreadstateError
from threadstate.mesh.solid import Floats, Ints, Solid

MAX_PAIRS = 200_000


class TooManyPairsError(ThreadstateError):
    """More triangles collide than are listed."""


class Engine(Protocol):
    """Collision queries of two meshes; a pose ``T_nut_bolt`` is a (4, 4) array, lengths in the pair's unit."""

    def collides(self, T_nut_bolt: Floats) -> bool:
        """Whether any triangle of the bolt meets one of the nut: the surfaces, not the solids."""

    def pairs(self, T_nut_bolt: Floats) -> Ints:
        """The numbers of the triangles that meet, the bolt's first, shape (k, 2), in ascending order."""

    def distance(self, T_nut_bolt: Floats) -> float:
        """The least distance of the surfaces; 0 where they meet."""


class Collider:
    """Bolt and nut with fcl's search trees: an :class:`Engine`."""

    def __init__(self, bolt: Solid, nut: Solid) -> None:
        self._bolt, self._nut = fcl.CollisionObject(_tree(bolt)), fcl.CollisionObject(_tree(nut))
        self._any = fcl.CollisionRequest(num_max_contacts=1, enable_contact=False)
        # Without positions: those that fcl gives of meshes are vertices of the triangles.
        self._all = fcl.CollisionRequest(num_max_contacts=MAX_PAIRS, enable_contact=False)
        self._distance = fcl.DistanceRequest()

    def collides(self, T_nut_bolt: Floats) -> bool:
        """Whether any triangle of the bolt meets one of the nut: the surfaces, not the solids."""
        self._place(T_nut_bolt)
        return bool(fcl.collide(self._bolt, self._nut, self._any, fcl.CollisionResult()))

    def pairs(self, T_nut_bolt: Floats) -> Ints:
        """The numbers of the triangles that meet, the bolt's first, shape (k, 2), in ascending order.

        Raises:
            TooManyPairsError: there are more than ``MAX_PAIRS``.
        """
        self._place(T_nut_bolt)
        result = fcl.CollisionResult()
        if fcl.collide(self._bolt, self._nut, self._all, result) >= MAX_PAIRS:
            raise TooManyPairsError(f"more than {MAX_PAIRS} pairs of triangles collide")
        found = np.array([(contact.b1, contact.b2) for contact in result.contacts], dtype=np.int64).reshape(-1, 2)
        return np.unique(found, axis=0)

    def distance(self, T_nut_bolt: Floats) -> float:
        """The least distance of the surfaces; 0 where they meet."""
        self._place(T_nut_bolt)
        return max(0.0, float(fcl.distance(self._bolt, self._nut, self._distance, fcl.DistanceResult())))

    def _place(self, T_nut_bolt: Floats) -> None:
        self._bolt.setTransform(fcl.Transform(T_nut_bolt[:3, :3], T_nut_bolt[:3, 3]))


def _tree(solid: Solid) -> fcl.BVHModel:
    model = fcl.BVHModel()
    model.beginModel(len(solid.vertices), len(solid.triangles))
    model.addSubModel(np.array(solid.vertices), np.array(solid.triangles))
    model.endModel()
    return model
