"""The least wrench that a hand must add to a load so that the contacts balance it (forces, section 3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.state.model import Vector
from threadstate.statics.scene import Scene
from threadstate.statics.wrench_cone import (
    Divided,
    balanced_by_wedging,
    carried,
    contact_maps,
    divided,
    into_cones,
    moved,
    slacks,
    solved_program,
)

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Reaction:
    """A wrench on the bolt that must be added to a load at least, in the nut's frame.

    Attributes:
        force: in N.
        moment: about ``point``, in N times the pair's unit of length.
        point: the bolt's origin.
        size: of the wrench in N, moments over the nominal radius; contact forces within their cones balance load
            and wrench. Where contacts wedge it is approached by ever greater forces.
        lower: a bound of the size from below: a twist that no contact withstands proves it.
    """

    force: Vector
    moment: Vector
    point: Vector
    size: float
    lower: float


def reaction_of(scene: Scene, mu: float, *, held: bool) -> Reaction:
    """The reaction to the load of a scene at a friction; zero where the contacts are known to hold it."""
    wrench, lower = np.zeros(6), 0.0
    if not held:
        maps = contact_maps(scene.points, scene.normals, mu)
        lower, wrench = least_wrench(maps, scene.load)
    mx, my, mz = (wrench[:3] * scene.radius + 0.0).tolist()
    fx, fy, fz = (wrench[3:] + 0.0).tolist()
    return Reaction((fx, fy, fz), (mx, my, mz), scene.contacts.origin, float(np.linalg.norm(wrench)), lower)


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
    k, q, parts = found.maps.shape
    size = float(np.linalg.norm(load))
    if size == 0.0 or k == 0:
        return size, np.zeros((k, parts))
    g = np.zeros((k * parts + q + 1, q))
    g[: k * parts] = -np.swapaxes(found.maps, 1, 2).reshape(k * parts, q)
    g[k * parts + 1 :] = -np.eye(q)
    h = np.zeros(len(g))
    h[k * parts] = 1.0
    twist, z = solved_program(-load / size, g, h, [parts] * k + [q + 1])
    # With enough of the twist that leaves all contacts none withstands the sum.
    short = max(0.0, -float(slacks(moved(found.maps, twist)).min()))
    twist = twist + short / found.rate * found.twist
    lower = float(load @ twist) / max(float(np.linalg.norm(twist)), 1e-300)
    return max(lower, 0.0), into_cones(z[: k * parts].reshape(k, parts)) * size
