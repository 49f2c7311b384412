"""What is computed of a loaded state on request: reaction, range of forces, contact modes, contact wrenches."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from threadstate.errors import UnknownNameError
from threadstate.state.model import ContactState, Vector
from threadstate.statics.load import Load
from threadstate.statics.modes import ContactMode, modes_are_enumerated, modes_of
from threadstate.statics.ranges import ForcesRange, forces_range_of
from threadstate.statics.reaction import Reaction, reaction_in
from threadstate.statics.scene import Scene, scene_of
from threadstate.statics.solve import Statics
from threadstate.thread.pair import Pair


class Extra(StrEnum):
    """What can be requested."""

    REACTION = "reaction"
    FORCES_RANGE = "forces_range"
    MODES = "modes"
    WRENCHES = "wrenches"


@dataclass(frozen=True, slots=True)
class ContactWrench:
    """A contact that carries forces in the last pose, with the wrench of 1 N along its normal, in the nut's frame.

    Attributes:
        contact: counts from 1: the state's contacts, then the hull of its patch.
        point: in the pair's unit.
        normal: unit vector from the nut into the bolt, the force.
        moment: about the load's point, in N times the pair's unit.
    """

    contact: int
    point: Vector
    normal: Vector
    moment: Vector


@dataclass(frozen=True, slots=True)
class Extras:
    """What was requested; None what was not.

    ``modes`` are None as well where they are not enumerated, on a patch. ``origin`` is the bolt's: twists are about it.
    ``hull_gap`` is how far the hull of a true patch may reach beyond its contacts, in the pair's unit.
    """

    requested: frozenset[Extra]
    origin: Vector
    wrenches: tuple[ContactWrench, ...] | None
    hull_gap: float
    reaction: Reaction | None
    forces_range: ForcesRange | None
    modes: tuple[ContactMode, ...] | None


def requested_extras(names: str) -> frozenset[Extra]:
    """The extras of names that are separated by commas.

    Raises:
        UnknownNameError: a name is none of them.
    """
    given = [name.strip() for name in names.split(",")]
    for name in given:
        if name not in list(Extra):
            raise UnknownNameError("include", name, ", ".join(Extra))
    return frozenset(map(Extra, given))


def extras_of(pair: Pair, state: ContactState, statics: Statics, requested: Collection[Extra]) -> Extras:
    """What is requested of a state whose statics under a load are known.

    Raises:
        UnresolvedPoseError: a contact has no certain normal.
    """
    scene = scene_of(pair, state, statics.load)
    held = statics.mu >= statics.hold.upper
    has_modes = Extra.MODES in requested and modes_are_enumerated(state)
    return Extras(
        requested=frozenset(requested),
        origin=scene.contacts.origin,
        wrenches=_wrenches(scene, statics.load) if Extra.WRENCHES in requested else None,
        hull_gap=scene.contacts.gap,
        reaction=reaction_in(scene, statics.mu, held=held) if Extra.REACTION in requested else None,
        forces_range=forces_range_of(scene, statics.mu, held=held) if Extra.FORCES_RANGE in requested else None,
        modes=modes_of(scene, statics.mu) if has_modes else None,
    )


def _wrenches(scene: Scene, load: Load) -> tuple[ContactWrench, ...]:
    origin = np.array(scene.contacts.origin)
    points = origin + scene.radius * scene.points
    moments = np.cross(points - np.array(load.point or origin), scene.normals)
    first = 1 + (scene.carriers.start or 0)
    return tuple(
        ContactWrench(first + k, *map(_vector, rows))
        for k, rows in enumerate(zip(points, scene.normals, moments, strict=True))
    )


def _vector(values: NDArray[np.float64]) -> Vector:
    x, y, z = (values + 0.0).tolist()
    return x, y, z
