"""What a hand must supply to keep a state: the least wrench that must be added to a load (forces, section 3)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.errors import UnresolvedPoseError
from threadstate.state.model import ContactState, Vector
from threadstate.statics._program_kernel import program_address
from threadstate.statics._reaction_kernel import least_withstood, reaction_with
from threadstate.statics.load import Load
from threadstate.statics.solve import FIRST_POINTS, statics_of
from threadstate.statics.touching import touching
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

FORCES_CONSIDERED = 1e3
"""The bound of a reaction holds for contact forces up to this multiple of the load."""
WITHSTOOD = -1e-12
"""Work, over the forces' size, that counts as none."""


@dataclass(frozen=True, slots=True)
class Reaction:
    """The least wrench on the bolt that must be added to a load, in the nut's frame.

    Attributes:
        force: in N.
        moment: about the bolt's origin, in N times the pair's length unit.
        size: its norm in N, moments over the nominal radius; 0 where the contacts balance the load alone.
        least_size: no wrench of a smaller size will do, with contact forces up to ``FORCES_CONSIDERED`` times the load.
    """

    force: Vector
    moment: Vector
    size: float
    least_size: float


def reaction_of(pair: Pair, state: ContactState, load: Load | None = None, mu: float = 0.0) -> Reaction:
    """The least wrench that must be added to a load so that the contacts of a state balance it at a friction.

    Raises:
        InvalidValueError: ``mu`` is negative or not finite.
        UnresolvedPoseError: a contact has no certain normal, or the program was not solved.
    """
    statics = statics_of(pair, state, load, mu)
    if mu >= statics.hold.upper:
        return Reaction((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0, 0.0)
    found = touching(pair, state)
    radius = pair.nominal_diameter / 2.0
    wrench = (load or Load()).about(found.origin)
    wrench[:3] /= radius
    scale = float(np.linalg.norm(wrench))
    wrench /= scale
    points, normals = (found.points - found.origin) / radius, found.normals.copy()
    chosen = list(range(len(points)))
    if found.patch:
        # A few points of its hull suffice; those are added that work against the motion.
        points, normals = points[found.own :], normals[found.own :]
        chosen = sorted({len(points) * i // FIRST_POINTS for i in range(FIRST_POINTS)})
    reaction, twist = np.zeros(6), np.zeros(6)
    while True:
        size = reaction_with(program_address(), wrench, mu, points[chosen], normals[chosen], reaction, twist)
        if size == math.inf:
            pose = state.roll_deg, state.pitch_deg, state.phase_deg
            raise UnresolvedPoseError(*pose, "the program for the least reaction was not solved")
        work, worst = least_withstood(twist, mu, points, normals)
        if work >= WITHSTOOD or worst in chosen:
            break
        chosen = sorted({*chosen, worst})
    least = float(twist @ wrench) / max(1.0, float(np.linalg.norm(twist))) + FORCES_CONSIDERED * min(work, 0.0)
    mx, my, mz = (scale * radius * reaction[:3]).tolist()
    fx, fy, fz = (scale * reaction[3:]).tolist()
    return Reaction((fx, fy, fz), (mx, my, mz), scale * size, scale * max(0.0, min(size, least)))
