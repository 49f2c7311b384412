"""What a hand must supply to keep a state: the least wrench that must be added to a load (forces, section 3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.state.model import ContactState, Vector
from threadstate.statics.load import Load
from threadstate.statics.scene import Scene, scene_of
from threadstate.statics.solve import statics_of
from threadstate.statics.wrench_cone import (
    Divided,
    balanced_by_wedging,
    carried,
    contact_maps,
    divided,
    driven,
    into_cones,
    moved,
    slacks,
)
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Reaction:
    """The least wrench on the bolt that must be added to a load, in the nut's frame.

    Attributes:
        force: in N.
        moment: about the bolt's origin, in N times the pair's length unit.
        size: its norm in N, moments over the nominal radius; 0 where the contacts balance the load alone. Where some
            wedge it is approached by ever greater forces.
        least_size: no wrench of a smaller size will do: a twist that no contact withstands proves it.
    """

    force: Vector
    moment: Vector
    size: float
    least_size: float


def reaction_of(pair: Pair, state: ContactState, load: Load | None = None, mu: float = 0.0) -> Reaction:
    """The least wrench that must be added to a load so that the contacts of a state balance it at a friction.

    Raises:
        InvalidValueError: ``mu`` is negative or not finite.
        UnresolvedPoseError: a contact has no certain normal.
    """
    held = mu >= statics_of(pair, state, load, mu).hold.upper
    return reaction_in(scene_of(pair, state, load or Load()), mu, held=held)


def reaction_in(scene: Scene, mu: float, *, held: bool) -> Reaction:
    """The reaction to the load of a scene; zero where the contacts are known to hold it."""
    wrench, least = np.zeros(6), 0.0
    if not held:
        least, wrench = least_wrench(contact_maps(scene.points, scene.normals, mu), scene.load)
    mx, my, mz = (wrench[:3] * scene.radius + 0.0).tolist()
    fx, fy, fz = (wrench[3:] + 0.0).tolist()
    return Reaction((fx, fy, fz), (mx, my, mz), float(np.linalg.norm(wrench)), least)


def least_wrench(maps: Floats, load: Floats) -> tuple[float, Floats]:
    """A bound from below of the least wrench to be added to a load (6) on contacts, and such a wrench (6)."""
    found = divided(maps)
    rest = found.free.T @ load
    lower, inner = _distance(found, rest)
    forces = np.zeros((len(maps), maps.shape[2]))
    forces[~found.pressed] = inner
    if found.pressed.any():
        left = rest + carried(found.maps, inner)
        missing = load + carried(maps, forces) - found.free @ left
        forces[found.pressed] = balanced_by_wedging(maps[found.pressed], missing)
    wrench = -(load + carried(maps, forces))
    return min(lower, float(np.linalg.norm(wrench))), wrench


def _distance(found: Divided, load: Floats) -> tuple[float, Floats]:
    """Of minus the load from the cone of contacts that do not wedge: a bound from below, and forces in their cones.

    Maximises the load's power over twists of size at most 1 that no contact withstands; the multipliers are forces.
    """
    k, _, parts = found.maps.shape
    size = float(np.linalg.norm(load))
    if size == 0.0 or k == 0:
        return size, np.zeros((k, parts))
    twist, forces = driven(found.maps, load / size)
    # With enough of the twist that leaves all contacts none withstands the sum.
    short = max(0.0, -float(slacks(moved(found.maps, twist)).min()))
    twist = twist + short / found.rate * found.twist
    lower = float(load @ twist) / max(float(np.linalg.norm(twist)), 1e-300)
    return max(lower, 0.0), into_cones(forces) * size
