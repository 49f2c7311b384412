"""The statics of a state under a load: what is supported, held or wedged (forces, section 3)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from threadstate.state.model import ContactState, Vector
from threadstate.statics import _friction_kernel as fk
from threadstate.statics import _numbers_kernel as nk
from threadstate.statics._effort_kernel import turn_effort
from threadstate.statics.hold_bounds import BALANCED, LOOSE, STEPS, deep_forces, outline_hold, sharpened
from threadstate.statics.load import Load, checked_friction
from threadstate.statics.numbers import contact_numbers
from threadstate.statics.scene import scene_of
from threadstate.statics.touching import Touching
from threadstate.statics.verdict import FrictionBounds, Verdict, verdict_at
from threadstate.statics.wrench_cone import contact_maps, opening
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class ContactForce:
    """The force on the bolt at a contact, in N: its normal part, and its tangential one in the nut's frame.

    ``contact`` counts from 1: the state's contacts, then the hull of its patch.
    """

    contact: int
    normal: float
    tangential: Vector


@dataclass(frozen=True, slots=True)
class Statics:
    """The statics of a state under a load (forces, section 3).

    Attributes:
        pose_deg: roll, pitch and phase.
        load: with the point about which its moment is taken.
        penetrating: whether the solids overlap in the last pose: no forces can be real there.
        support_margin: distance of the load from the boundary of what is balanced without friction, moments over the
            nominal radius about the bolt's origin; negative outside.
        hold: the least friction at which contacts can balance the load.
        wedge: the least friction at which contact forces can balance each other.
        turn_effort_ccw, turn_effort_cw: torque over the push times the nominal radius at which the bolt begins to turn,
            held by a rigid device; infinite where it is locked, None without a push on a contact.
        forces: balancing forces of least largest normal part; empty where none were found that lie in
            their cones but for round-off.
    """

    pose_deg: Vector
    load: Load
    mu: float
    penetrating: bool
    support_margin: float
    hold: FrictionBounds
    wedge: FrictionBounds
    turn_effort_ccw: float | None
    turn_effort_cw: float | None
    forces: tuple[ContactForce, ...]

    @property
    def supported(self) -> bool:
        """Whether the contacts balance the load without friction."""
        return self.support_margin >= 0.0

    @property
    def verdict(self) -> Verdict:
        """What the bolt can do."""
        return verdict_at(self.mu, self.hold, self.wedge)


def statics_of(pair: Pair, state: ContactState, load: Load | None = None, mu: float = 0.0) -> Statics:
    """The statics of a state under a load at a friction; see :class:`Statics`.

    Raises:
        InvalidValueError: ``mu`` is negative or not finite.
        UnresolvedPoseError: a contact has no certain normal.
    """
    checked_friction(mu)
    load = load or Load()
    scene = scene_of(pair, state, load)
    wrench, scaled, radius = scene.load, scene.contacts, scene.radius
    margin, hold, wedge = numbers_of(wrench, scaled)
    return Statics(
        pose_deg=(state.roll_deg, state.pitch_deg, state.phase_deg),
        load=replace(load, point=load.point or scaled.origin),
        mu=mu,
        penetrating=scaled.penetrating,
        support_margin=margin,
        hold=hold,
        wedge=wedge,
        turn_effort_ccw=_effort(wrench, scaled, radius, mu, 1.0),
        turn_effort_cw=_effort(wrench, scaled, radius, mu, -1.0),
        forces=_forces(wrench, scaled, wedge, mu) if mu >= hold.upper else (),
    )


def numbers_of(wrench: Floats, scaled: Touching) -> tuple[float, FrictionBounds, FrictionBounds]:
    """The margin of a load (6), and bounds of the frictions that hold it and that wedge.

    Lengths are over the nominal radius, about the point of the load.
    """
    numbers = _numbers(wrench, scaled)
    points, normals = scaled.points[scaled.carriers], scaled.normals[scaled.carriers]
    hold, wedge = _bounds(numbers[nk.N_HOLD :]), _bounds(numbers[nk.N_WEDGE :])
    if numbers[nk.N_STATUS] == nk.OPEN_PATCH:
        hold, _ = outline_hold(wrench, points, normals, wedge)
    elif not scaled.patch and hold.upper - hold.lower > LOOSE * hold.upper:
        hold = sharpened(hold, wedge, wrench, points, normals)
    return float(numbers[nk.N_MARGIN]), hold, wedge


def _numbers(wrench: Floats, scaled: Touching) -> Floats:
    """A row of numbers; ``scaled`` has points over r about the bolt's origin."""
    points, normals = scaled.points[scaled.carriers], scaled.normals[scaled.carriers]
    if scaled.strip:
        return strip_numbers(wrench, points, normals, scaled.own)
    if not scaled.patch:
        return contact_numbers(nk.EVERY_NUMBER, wrench, points, normals).row
    numbers = np.zeros(nk.NUMBERS_SIZE)
    nk.patch_numbers(wrench, points[:, :2].copy(), numbers)
    return numbers


def strip_numbers(wrench: Floats, points: Floats, normals: Floats, corners: int) -> Floats:
    """The numbers of a strip's outline; its holding friction is left open unless it is supported.

    A strip wedges where its corners do, which a motion that opens every point of the outline proves.
    """
    ends = len(points) // 2
    at = [0, ends - 1, ends, len(points) - 1][:corners]
    numbers = contact_numbers(nk.EVERY_NUMBER, wrench, points[at], normals[at]).row
    lower = numbers[nk.N_WEDGE]
    numbers[nk.N_WEDGE] = 0.0
    for step in STEPS:
        rate, _, _ = opening(contact_maps(points, normals, lower * (1.0 - step)))
        if rate > 0.0:
            numbers[nk.N_WEDGE] = lower * (1.0 - step)
            break
    numbers[nk.N_MARGIN] = contact_numbers(nk.MARGIN_ALONE, wrench, points, normals).row[nk.N_MARGIN]
    supported = numbers[nk.N_MARGIN] >= 0.0
    numbers[nk.N_STATUS] = nk.DONE if supported else nk.OPEN_PATCH
    numbers[nk.N_HOLD : nk.N_HOLD + 2] = 0.0 if supported else (0.0, math.inf)
    return numbers


def _bounds(bounds: Floats) -> FrictionBounds:
    return FrictionBounds(float(bounds[0]), float(bounds[1]))


def _effort(wrench: Floats, scaled: Touching, radius: float, mu: float, sense: float) -> float | None:
    """The torque over (push r) at which the bolt begins to turn; None without a push on a contact."""
    push = -float(wrench[5])
    if not push > 0.0:
        return None
    # About the nut's axis; x and y of the bolt's origin are not zero after the turns of the second and third stage.
    shift = np.array([scaled.origin[0], scaled.origin[1], 0.0]) / radius
    torque = float(wrench[2] + shift[0] * wrench[4] - shift[1] * wrench[3])
    effort = float(turn_effort(push, torque, scaled.points + shift, scaled.normals, mu, sense))
    return None if math.isnan(effort) else effort / push


def _forces(wrench: Floats, scaled: Touching, wedge: FrictionBounds, mu: float) -> tuple[ContactForce, ...]:
    """Balancing forces at ``mu`` of least largest normal part."""
    points, normals = scaled.points[scaled.carriers], scaled.normals[scaled.carriers]
    first = scaled.carriers.start or 0
    outline = scaled.patch or scaled.strip
    chosen = [first + i for i in (outline_hold(wrench, points, normals, wedge)[1] if outline else range(len(points)))]
    forces = np.zeros(3 * len(chosen))
    needed = fk.least_forces(wrench, mu, scaled.points[chosen], scaled.normals[chosen], forces)
    vectors = forces.reshape(-1, 3)
    if not needed <= mu * (1.0 + BALANCED) + BALANCED:
        vectors, needed = deep_forces(wrench, scaled.points[chosen], scaled.normals[chosen], mu)
        if math.isinf(needed):
            return ()
    rows = []
    for number, force in zip(chosen, vectors, strict=True):
        normal = float(force @ scaled.normals[number])
        x, y, z = (force - normal * scaled.normals[number]).tolist()
        rows.append(ContactForce(number + 1, normal, (x, y, z)))
    return tuple(rows)
