"""A state's contacts under a load, with lengths over the pair's nominal radius about the bolt's origin."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from threadstate.state.model import ContactState
from threadstate.statics.load import Load
from threadstate.statics.touching import Touching, touching
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Scene:
    """A loaded state.

    Attributes:
        load: the wrench (moment, force) about the bolt's origin, moments over the radius: shape (6).
        contacts: with points over the radius from the bolt's origin, which itself is in the pair's unit.
        radius: the pair's nominal radius.
    """

    load: Floats
    contacts: Touching
    radius: float

    @property
    def points(self) -> Floats:
        """Of the contacts that carry forces, shape (k, 3)."""
        return self.contacts.points[self.contacts.carriers]

    @property
    def normals(self) -> Floats:
        """Of the contacts that carry forces, shape (k, 3)."""
        return self.contacts.normals[self.contacts.carriers]


def scene_of(pair: Pair, state: ContactState, load: Load) -> Scene:
    """A state under a load.

    Raises:
        UnresolvedPoseError: a contact has no certain normal.
    """
    found = touching(pair, state)
    radius = pair.nominal_diameter / 2.0
    wrench = load.about(found.origin)
    wrench[:3] /= radius
    # Copies that can be written to: for others the kernels would be compiled again.
    scaled = replace(found, points=(found.points - found.origin) / radius, normals=found.normals.copy())
    return Scene(wrench, scaled, radius)
