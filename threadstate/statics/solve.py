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
from threadstate.statics.load import Load, checked_friction
from threadstate.statics.scene import scene_of
from threadstate.statics.touching import Touching
from threadstate.statics.verdict import FrictionBounds, Verdict, verdict_at
from threadstate.statics.wrench_cone import contact_maps, driven, withstood
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
        forces: balancing forces of least largest normal part; empty where there are none.
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
    numbers = _numbers(wrench, scaled)
    hold = _hold(wrench, scaled, numbers)
    return Statics(
        pose_deg=(state.roll_deg, state.pitch_deg, state.phase_deg),
        load=replace(load, point=load.point or scaled.origin),
        mu=mu,
        penetrating=scaled.penetrating,
        support_margin=float(numbers[nk.N_MARGIN]),
        hold=hold,
        wedge=_bounds(numbers[nk.N_WEDGE :]),
        turn_effort_ccw=_effort(wrench, scaled, radius, mu, 1.0),
        turn_effort_cw=_effort(wrench, scaled, radius, mu, -1.0),
        forces=_forces(wrench, scaled, mu) if mu >= hold.upper else (),
    )


def _numbers(wrench: Floats, scaled: Touching) -> Floats:
    """A row of numbers; ``scaled`` has points over r about the bolt's origin."""
    numbers = np.zeros(nk.NUMBERS_SIZE)
    if scaled.patch:
        nk.patch_numbers(wrench, scaled.points[scaled.own :, :2].copy(), numbers)
    else:
        nk.contact_numbers(fk.search_addresses(), wrench, scaled.points, scaled.normals, numbers)
    return numbers


def _hold(wrench: Floats, scaled: Touching, numbers: Floats) -> FrictionBounds:
    if numbers[nk.N_STATUS] == nk.OPEN_PATCH:
        return patch_hold(wrench, scaled.points[scaled.own :])[0]
    bounds = _bounds(numbers[nk.N_HOLD :])
    if scaled.patch or len(scaled.points) <= TIGHT_CONTACTS:
        return bounds
    return sharpened(bounds, _bounds(numbers[nk.N_WEDGE :]), wrench, scaled.points, scaled.normals)


TIGHT_CONTACTS = 3
"""So many contacts at most have tight bounds by the kernels alone."""
LOOSE = 1e-9
"""Relative width of bounds that are sharpened."""
STEPS = (1e-9, 1e-8, 1e-7, 1e-6)
"""How far below a friction, over it, motions are sought that prove a lower bound."""
LEAST_POWER = 1e-12
"""Over the load, of what it does on a motion."""


def sharpened(
    bounds: FrictionBounds, wedge: FrictionBounds, wrench: Floats, points: Floats, normals: Floats
) -> FrictionBounds:
    """Bounds of the friction that holds a load on many contacts; the lower one is proved by motions that it drives.

    The friction at which the first contact withstands such a motion is a lower bound, however it was found: motions are
    sought just below the upper bound, and just below the friction that wedges. Above that the kernels' lower bound is
    not one of forces without limit, and is left.
    """
    lower, load = min(bounds.lower, wedge.lower), wrench / np.linalg.norm(wrench)
    for step in STEPS:
        for friction in (bounds.upper * (1.0 - step), wedge.lower * (1.0 - step)):
            if math.isinf(bounds.upper) or bounds.upper - lower <= LOOSE * bounds.upper:
                return FrictionBounds(min(lower, bounds.upper), bounds.upper)
            if lower < friction < bounds.upper:
                twist, _ = driven(contact_maps(points, normals, friction), load)
                if load @ twist > LEAST_POWER:
                    lower = max(lower, float(withstood(points, normals, twist).min()))
    return FrictionBounds(min(lower, bounds.upper), bounds.upper)


FIRST_POINTS = 6
"""Points of a hull, spread evenly, that are tried first."""
MOST_ADDITIONS = 40


def patch_hold(wrench: Floats, hull: Floats) -> tuple[FrictionBounds, list[int]]:
    """Bounds for a level patch with a hull (n, 3), and the points of it that carry the load at the upper one.

    Lengths are over the nominal radius, about the point of the load (6).

    The twist that proves the lower bound of some points is tried on the whole hull; points against which it fails are
    added until none is left.
    """
    chosen = sorted({len(hull) * i // FIRST_POINTS for i in range(FIRST_POINTS)})
    everywhere = np.tile([0.0, 0.0, 1.0], (len(hull), 1))
    lower = 0.0
    for _ in range(MOST_ADDITIONS):
        forces, twist, none = np.zeros(3 * len(chosen)), np.zeros(6), np.zeros(3 * len(chosen))
        status, low, upper = fk.hold_friction(
            wrench, hull[chosen], everywhere[chosen], math.inf, none, np.zeros(6), forces, twist
        )
        bounds = FrictionBounds(0.0, math.inf) if status == fk.OPEN else FrictionBounds(float(low), float(upper))
        ratio = withstood(hull, everywhere, twist)
        # Where the motion presses into the nut no friction lets it: the deepest first.
        worst = int(np.argmin((twist[3:] + np.cross(twist[:3], hull))[:, 2] if np.isneginf(ratio).any() else ratio))
        if ratio[worst] >= bounds.lower * (1.0 - 1e-12) or worst in chosen:
            lower = max(lower, min(float(ratio[worst]), bounds.lower))
            break
        lower = max(lower, float(ratio[worst]))
        chosen = sorted({*chosen, worst})
    found = FrictionBounds(min(lower, bounds.upper), bounds.upper)
    return sharpened(found, FrictionBounds(math.inf, math.inf), wrench, hull, everywhere), chosen


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


def _forces(wrench: Floats, scaled: Touching, mu: float) -> tuple[ContactForce, ...]:
    """Balancing forces at ``mu`` of least largest normal part."""
    chosen = list(range(len(scaled.points)))
    if scaled.patch:
        chosen = [scaled.own + i for i in patch_hold(wrench, scaled.points[scaled.own :])[1]]
    forces = np.zeros(3 * len(chosen))
    fk.least_forces(wrench, mu, scaled.points[chosen], scaled.normals[chosen], forces)
    rows = []
    for number, force in zip(chosen, forces.reshape(-1, 3), strict=True):
        normal = float(force @ scaled.normals[number])
        x, y, z = (force - normal * scaled.normals[number]).tolist()
        rows.append(ContactForce(number + 1, normal, (x, y, z)))
    return tuple(rows)
