"""The statics of a state under a load: what is supported, held or wedged (forces, section 3)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from threadstate.state.model import ContactState, Vector
from threadstate.statics import _friction_kernel as fk
from threadstate.statics import _numbers_kernel as nk
from threadstate.statics._effort_kernel import turn_effort
from threadstate.statics._support_kernel import support_margin
from threadstate.statics.load import Load, checked_friction
from threadstate.statics.scene import scene_of
from threadstate.statics.touching import Touching
from threadstate.statics.verdict import FrictionBounds, Verdict, verdict_at
from threadstate.statics.wrench_cone import (
    carried,
    contact_maps,
    deepest_forces,
    driven,
    least_forces,
    null_space,
    opening,
    slacks,
    withstood,
)
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
    numbers = np.zeros(nk.NUMBERS_SIZE)
    points, normals = scaled.points[scaled.carriers], scaled.normals[scaled.carriers]
    if scaled.patch:
        nk.patch_numbers(wrench, points[:, :2].copy(), numbers)
    elif scaled.strip:
        strip_numbers(wrench, points, normals, scaled.own, numbers)
    else:
        nk.contact_numbers(fk.search_addresses(), wrench, points, normals, numbers)
    return numbers


def strip_numbers(wrench: Floats, points: Floats, normals: Floats, corners: int, numbers: Floats) -> None:
    """Sets the numbers of a strip's outline; its holding friction is left open unless it is supported.

    A strip wedges where its corners do, which a motion that opens every point of the outline proves.
    """
    ends = len(points) // 2
    at = [0, ends - 1, ends, len(points) - 1][:corners]
    nk.contact_numbers(fk.search_addresses(), wrench, points[at], normals[at], numbers)
    lower = numbers[nk.N_WEDGE]
    numbers[nk.N_WEDGE] = 0.0
    for step in STEPS:
        rate, _, _ = opening(contact_maps(points, normals, lower * (1.0 - step)))
        if rate > 0.0:
            numbers[nk.N_WEDGE] = lower * (1.0 - step)
            break
    numbers[nk.N_MARGIN] = support_margin(wrench, points, normals)
    supported = numbers[nk.N_MARGIN] >= 0.0
    numbers[nk.N_STATUS] = nk.DONE if supported else nk.OPEN_PATCH
    numbers[nk.N_HOLD : nk.N_HOLD + 2] = 0.0 if supported else (0.0, math.inf)


LOOSE = 1e-9
"""Relative width of bounds that are sharpened."""
STEPS = (1e-9, 1e-8, 1e-7, 1e-6)
"""How far below a friction, over it, motions are sought that prove a lower bound."""
MOST_HALVINGS = 60
BLENDS = tuple(10.0**-n for n in range(13, 6, -1))
MOST_CARRIERS = 24
"""Forces are sought among all points of an outline that has no more."""
SHARES = (0.5, 0.9, 0.1, 0.99)
"""Where between the bounds motions and forces are sought, in turn until something is proved."""
BALANCED = 1e-12
"""What forces may leave of a load, over it and themselves."""
NEAR = 1e-8
"""The same, while points of an outline are added."""
LEAST_POWER = 1e-11
"""Over the load, of what it does on a motion."""


def sharpened(
    bounds: FrictionBounds,
    wedge: FrictionBounds,
    wrench: Floats,
    points: Floats,
    normals: Floats,
    pressed: Sequence[int] | None = None,
) -> FrictionBounds:
    """Narrower bounds of the friction that holds a load, which motions prove from below and forces from above.

    The friction at which the first contact withstands a motion that the load drives is a lower bound, however it was
    found; above the friction that wedges a kernel's lower bound is not one of forces without limit, and is left. Sought
    is just below the upper bound and the friction that wedges, then between the bounds. ``pressed`` are the contacts
    among which forces are sought; by default all.
    """
    if math.isinf(bounds.upper):
        return bounds
    lower, upper = min(bounds.lower, wedge.lower), bounds.upper
    for step in STEPS:
        for friction in (upper * (1.0 - step), wedge.lower * (1.0 - step)):
            if upper - lower > LOOSE * upper and lower < friction < upper:
                lower = max(lower, _withstood_from(wrench, points, normals, friction))
    among = list(range(len(points)) if pressed is None or len(points) <= MOST_CARRIERS else pressed)
    for _ in range(MOST_HALVINGS):
        before = lower, upper
        for share in SHARES:
            if upper - lower <= LOOSE * upper:
                return FrictionBounds(min(lower, upper), upper)
            friction = lower + share * (upper - lower)
            lower = max(lower, min(upper, _withstood_from(wrench, points, normals, friction)))
            upper = min(upper, deep_forces(wrench, points[among], normals[among], friction)[1])
            if (lower, upper) != before:
                break
        else:
            break
    return FrictionBounds(min(lower, upper), upper)


def _withstood_from(wrench: Floats, points: Floats, normals: Floats, friction: float) -> float:
    """A lower bound of the friction that holds a load, by a motion sought at a friction; 0 where none proves one.

    A little of the motion that opens all contacts is added, which makes up for what the solver leaves.
    """
    unit, maps = wrench / np.linalg.norm(wrench), contact_maps(points, normals, friction)
    twist, _ = driven(maps, unit)
    if not unit @ twist > LEAST_POWER:
        return 0.0
    _, away, _ = opening(maps)
    blended = [twist, *(twist + blend * away for blend in BLENDS)]
    return max(0.0, *(float(withstood(points, normals, one).min()) for one in blended if unit @ one > LEAST_POWER))


def deep_forces(wrench: Floats, points: Floats, normals: Floats, friction: float) -> tuple[Floats, float]:
    """Forces (k, 3) that balance a load deep in their cones at a friction, and the friction that they need.

    It is infinite where none were found.
    """
    maps = contact_maps(points, normals, friction)
    columns = np.concatenate(list(maps), axis=1)
    parts = maps.shape[2]
    found = deepest_forces(least_forces(columns, wrench), null_space(columns), parts).reshape(-1, parts)
    size = float(np.linalg.norm(wrench)) + float(np.abs(found).sum())
    left = np.abs(wrench + carried(maps, found)).max()
    if found[:, 0].min() < 0.0 or left > BALANCED * size or slacks(found).min() < 0.0:
        return np.zeros_like(points), math.inf
    share = np.linalg.norm(found[:, 1:], axis=1) / np.where(found[:, 0] > 0.0, found[:, 0], 1.0)
    return np.einsum("kac,kc->ka", maps[:, 3:], found), friction * float(share.max(initial=0.0))


FIRST_POINTS = 6
"""Points of a hull, spread evenly, that are tried first."""
MOST_ADDITIONS = 40


def outline_hold(
    wrench: Floats, hull: Floats, normals: Floats, wedge: FrictionBounds
) -> tuple[FrictionBounds, list[int]]:
    """Bounds for a patch with a hull (n, 3), or a strip with such an outline, and the points that carry the load.

    Lengths are over the nominal radius, about the point of the load (6); the points are those at the upper bound.

    The twist that proves the lower bound of some points is tried on the whole hull; points against which it fails are
    added until none is left.
    """
    count, unit = len(hull), wrench / np.linalg.norm(wrench)
    chosen = sorted(
        {0, count // 2 - 1, count // 2, count - 1, *(count * i // FIRST_POINTS for i in range(FIRST_POINTS))}
    )
    lower = 0.0
    for _ in range(MOST_ADDITIONS):
        forces, twist, none = np.zeros(3 * len(chosen)), np.zeros(6), np.zeros(3 * len(chosen))
        status, low, upper = fk.hold_friction(
            wrench, hull[chosen], normals[chosen], math.inf, none, np.zeros(6), forces, twist
        )
        bounds = FrictionBounds(0.0, math.inf) if status == fk.OPEN else FrictionBounds(float(low), float(upper))
        proved = bounds.lower
        if 0.0 < bounds.upper < math.inf:
            near, _ = driven(contact_maps(hull[chosen], normals[chosen], bounds.upper * (1.0 - NEAR)), unit)
            if unit @ near > LEAST_POWER:
                twist, proved = near, bounds.upper
        ratio = withstood(hull, normals, twist)
        lower = max(lower, min(float(ratio.min()), proved))
        # Where the motion presses into the nut no friction lets it: the deepest first.
        inwards = np.einsum("ka,ka->k", twist[3:] + np.cross(twist[:3], hull), normals)
        worst = int(np.argmin(inwards if np.isneginf(ratio).any() else ratio))
        if ratio[worst] >= bounds.lower * (1.0 - NEAR) or worst in chosen:
            break
        chosen = sorted({*chosen, worst})
    found = FrictionBounds(min(lower, bounds.upper), bounds.upper)
    return sharpened(found, wedge, wrench, hull, normals, chosen), chosen


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
    if not needed <= mu * (1.0 + NEAR) + NEAR:
        vectors, needed = deep_forces(wrench, scaled.points[chosen], scaled.normals[chosen], mu)
        if math.isinf(needed):
            return ()
    rows = []
    for number, force in zip(chosen, vectors, strict=True):
        normal = float(force @ scaled.normals[number])
        x, y, z = (force - normal * scaled.normals[number]).tolist()
        rows.append(ContactForce(number + 1, normal, (x, y, z)))
    return tuple(rows)
