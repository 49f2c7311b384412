"""The least friction at which contacts balance a load, and at which they wedge (docs/forces.md, section 3)."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linprog

from oracle.statics.certificates import POWER_ROUND_OFF, ROUND_OFF, forces_bound, norms, pressing, twist_bound
from oracle.statics.cones import Cone, Pyramid, RoundCone
from oracle.statics.wrenches import Contacts, Floats, Twist, Wrench

Mask = NDArray[np.bool_]
Chain = tuple[Floats, ...]

WIDTH = 1e-12
"""Bisection ends when the friction angle is known to this, in rad, or when no further step proves anything."""
STEPS = 100
"""Of bisection, at most."""
SHARES = (0.5, 0.2, 0.8, 0.05, 0.95, 0.01, 0.99)
"""Where in the interval the next friction is tried, in turn until one proves something."""
BLENDS = (0.0, *(10.0**-n for n in range(15, 0, -1)))
"""Of a twist that opens each contact to one that the load drives: undoes the solver's round-off."""
DROPS = (0.0, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4)
"""Shares of the largest force below which a contact's force is taken as zero when forces are corrected."""
POWER = 10.0 * POWER_ROUND_OFF
"""Share of the load that its power on a twist of size 1 must exceed, so that a change of frame keeps its sign."""
SLACK = 1e-14
"""Share of a twist that its velocities are trusted to."""
RANK = 1e-9
"""Singular values below this are zero where it is asked which wrenches forces can balance."""


@dataclass(frozen=True, eq=False)
class FrictionBounds:
    """The least friction lies in [lower, upper]; what proves it.

    ``upper`` is None where no balancing forces are known; then ``lower`` is infinite where none exist at any friction.
    ``forces`` (k, 3), with ``rays`` added without limit, prove ``upper``; ``twist`` proves ``lower``, after
    ``exclusions`` have shown which contacts carry nothing at any friction (``certificates``).
    """

    lower: float
    upper: float | None
    forces: Floats | None
    rays: Chain
    twist: Twist | None
    exclusions: tuple[Twist, ...]


def hold_friction(points: ArrayLike, normals: ArrayLike, load: Wrench, r: float) -> FrictionBounds:
    """``mu_hold``: the least friction at which contacts balance the load.

    Points and normals (k, 3), into the bolt; ``r`` makes moments comparable, and the result does not depend on it.
    The least friction is an infimum: where it is the friction of wedging, no finite forces may balance at it.
    """
    return _bounds(Contacts.of(points, normals, r), load, RoundCone())


def wedge_friction(points: ArrayLike, normals: ArrayLike, r: float) -> FrictionBounds:
    """``mu_wedge``: the least friction at which contact forces that are not all zero balance each other."""
    return _bounds(Contacts.of(points, normals, r), None, RoundCone())


def hold_friction_by_pyramids(
    points: ArrayLike, normals: ArrayLike, load: Wrench, r: float, sides: int
) -> tuple[float, float | None]:
    """Bracket of ``mu_hold`` by the circumscribed and the inscribed pyramid, by linear programs alone."""
    return _bracket(_bounds(Contacts.of(points, normals, r), load, Pyramid(sides)), sides)


def wedge_friction_by_pyramids(
    points: ArrayLike, normals: ArrayLike, r: float, sides: int
) -> tuple[float, float | None]:
    """Bracket of ``mu_wedge`` by the circumscribed and the inscribed pyramid, by linear programs alone."""
    return _bracket(_bounds(Contacts.of(points, normals, r), None, Pyramid(sides)), sides)


def _bracket(inner: FrictionBounds, sides: int) -> tuple[float, float | None]:
    return inner.lower * Pyramid(sides).inner_share, inner.upper


def _bounds(contacts: Contacts, load: Wrench | None, cone: Cone) -> FrictionBounds:
    """Finds certificates in scaled coordinates, and says what they prove in the frame of the points."""
    coordinates = None if load is None else contacts.coordinates(load)
    left, exclusions, never = excluded(contacts.maps, coordinates)
    found = _Found()
    if not never and coordinates is None:
        found = wedge(contacts.maps[left], cone)
    elif not never and coordinates is not None:
        found = _hold(contacts.maps[left], coordinates, cone, 0.0, float(np.linalg.norm(coordinates)))

    def in_frame(some: Floats) -> Floats:
        return contacts.vectors(_spread(some, left))

    def sizes(of: Callable[[Floats], Floats]) -> Callable[[Floats], Floats]:
        if isinstance(cone, RoundCone):
            return norms
        return lambda vectors: of(np.einsum("kac,ka->kc", contacts.axes[:, :, 1:], vectors))

    twist = None if found.twist is None else contacts.twist(found.twist)
    twists = tuple(contacts.twist(exclusion) for exclusion in exclusions)
    forces = None if found.forces is None else in_frame(found.forces)
    rays = tuple(in_frame(ray) for ray in found.rays)
    points, normals = contacts.points, contacts.normals
    lower = twist_bound(points, normals, load, twist, twists, sizes(cone.velocity_size))
    upper = math.inf
    if forces is not None:
        upper = forces_bound(points, normals, load, forces, rays, sizes(cone.force_size))
    return FrictionBounds(lower, upper if upper < math.inf else None, forces, rays, twist, twists)


@dataclass
class _Found:
    """The best certificates so far, in the coordinates of some maps, with what they prove there."""

    lower: float = 0.0
    upper: float = math.inf
    twist: Floats | None = None
    forces: Floats | None = None
    rays: Chain = field(default=())

    def add_twist(self, value: float, twist: Floats) -> None:
        if value > self.lower:
            self.lower, self.twist = value, twist

    def add_forces(self, value: float, forces: Floats) -> None:
        if value < self.upper:
            self.upper, self.forces = value, forces


def wedge(maps: Floats, cone: Cone) -> _Found:
    """Certificates of the least friction of wedging; forces sum to 1 along the normals."""
    found = _Found()
    left, _, never = excluded(maps, None)
    if never:
        found.lower = math.inf
        return found

    def attempt(friction: float) -> None:
        twist, forces = cone.wedge(maps[left], friction)
        full, _ = (twist, forces) if left.all() else cone.wedge(maps, friction)
        found.add_twist(_twist_friction(maps, full, cone, loaded=False), full)
        for value, corrected in corrections(maps[left], np.zeros(maps.shape[1]), forces, cone, friction):
            found.add_forces(value, _spread(corrected / corrected[:, 0].sum(), left))

    attempt(0.0)
    _narrow(found, attempt, math.inf)
    return found


def _hold(maps: Floats, load: Floats, cone: Cone, floor: float, scale: float) -> _Found:
    """Certificates of the least friction from ``floor`` on that balances the load.

    Above the friction of wedging, contacts that wedge carry any force: what they can balance is divided out, and the
    question is put again to the others. Below it, contact forces are bounded by the load, and bisection is safe.
    """
    if np.linalg.norm(load) <= 0.1 * RANK * scale:
        return _Found(floor, floor, forces=np.zeros((len(maps), 3)))
    if len(maps) == 0:
        return _Found(floor)
    wedging = wedge(maps, cone)
    above, top = None, math.inf
    if wedging.forces is not None:
        above = _hold_wedged(maps, load, cone, max(floor, wedging.upper), scale, wedging.forces)
        top = wedging.lower
        if above.lower > max(floor, wedging.upper):
            return above
    found = _Found(floor)

    def attempt(friction: float) -> None:
        twist, forces = cone.hold(maps, load, friction)
        opening, _ = cone.wedge(maps, friction)
        for blend in BLENDS:
            blended = twist + blend * opening
            if load @ blended > POWER * scale * np.linalg.norm(blended):
                found.add_twist(_twist_friction(maps, blended, cone, loaded=True), blended)
        for value, corrected in corrections(maps, load, forces, cone, friction):
            found.add_forces(value, corrected)

    if top > floor:
        attempt(floor)
        _narrow(found, attempt, top)
    if above is not None and above.upper < found.upper:
        found.upper, found.forces, found.rays = above.upper, above.forces, above.rays
        if above.twist is not None and found.twist is None:
            found.lower, found.twist = above.lower, above.twist
    return found


def _hold_wedged(maps: Floats, load: Floats, cone: Cone, floor: float, scale: float, ray: Floats) -> _Found:
    """``_hold`` where the contacts on which ``ray`` presses carry any force."""
    rest = ~pressing(ray[:, 0])
    carried, free = split(maps, ~rest)
    inner = _hold(np.einsum("qp,kqc->kpc", free, maps[rest]), free.T @ load, cone, floor, scale)

    def completed(forces: Floats, wrench: Floats) -> Floats:
        full = _spread(forces, rest)
        missing = wrench + np.einsum("kqc,kc->q", maps, full)
        full[~rest] = -np.linalg.lstsq(carried, missing, rcond=RANK)[0].reshape(-1, 3)
        return full

    if inner.forces is not None:
        inner.forces = completed(inner.forces, load)
        inner.rays = (ray, *(completed(some, np.zeros_like(load)) for some in inner.rays))
    if inner.twist is not None:
        inner.twist = free @ inner.twist
    return inner


def split(maps: Floats, chosen: Mask) -> tuple[Floats, Floats]:
    """Wrenches (q, 3 k') of the chosen contacts' forces, and an orthonormal basis (q, p) of what these cannot do."""
    columns = np.concatenate(list(maps[chosen]), axis=1)
    left, sizes, _ = np.linalg.svd(columns)
    return columns, np.asarray(left[:, int((sizes > RANK * sizes[0]).sum()) :])


def _spread(forces: Floats, chosen: Mask) -> Floats:
    full = np.zeros((len(chosen), 3))
    full[chosen] = forces
    return full


def _narrow(found: _Found, attempt: Callable[[float], None], top: float) -> None:
    """Halve the interval below ``top`` until nothing more can be proved."""
    for _ in range(STEPS):
        low, high = math.atan(found.lower), math.atan(min(found.upper, top))
        if high - low <= WIDTH:
            return
        for share in SHARES:
            attempt(math.tan(low + share * (high - low)))
            if math.atan(min(found.upper, top)) - math.atan(found.lower) < 0.995 * (high - low):
                break
        else:
            return


def _twist_friction(maps: Floats, twist: Floats, cone: Cone, *, loaded: bool) -> float:
    """The friction below which a scaled twist meets no resistance, less what round-off may change in another frame.

    Negative where a contact is pressed. Contacts that do not move prove something under a load alone.
    """
    velocities = np.einsum("kqc,q->kc", maps, twist)
    slack = SLACK * float(np.linalg.norm(twist))
    along, across = velocities[:, 0] - slack, cone.velocity_size(-velocities[:, 1:]) + slack
    if loaded:
        moving = np.abs(velocities).max(axis=1) > 0.1 * ROUND_OFF * np.linalg.norm(twist)
        along, across = along[moving], across[moving]
    if slack == 0.0 or np.any(along <= 0.0):
        return -1.0
    return float((along / across).min(initial=math.inf))


def corrections(maps: Floats, load: Floats, forces: Floats, cone: Cone, friction: float) -> list[tuple[float, Floats]]:
    """Forces that balance the load to round-off, from ones that nearly do, with the friction that they need."""
    found = []
    largest = float(forces[:, 0].max(initial=0.0))
    missing = float(np.linalg.norm(load + np.einsum("kqc,kc->q", maps, forces)))
    if largest <= 0.0 or missing > 1e-3 * max(largest, float(np.linalg.norm(load))):
        return []
    before = 0
    for drop in DROPS:
        active = forces[:, 0] > drop * largest
        if active.sum() == before:
            continue
        before = int(active.sum())
        # Each force is changed in proportion to its size, so that small ones stay within their cones.
        weights = forces[active, :1] * np.array([1.0, friction, friction])
        columns = np.einsum("kqc,kc->qkc", maps[active], weights).reshape(maps.shape[1], -1)
        corrected = np.where(active[:, None], forces, 0.0)
        for _ in range(2):
            missing_wrench = load + np.einsum("kqc,kc->q", maps, corrected)
            change = np.linalg.lstsq(columns, missing_wrench, rcond=1e-13)[0]
            corrected[active] -= weights * change.reshape(-1, 3)
        left = np.linalg.norm(load + np.einsum("kqc,kc->q", maps, corrected))
        total = np.linalg.norm(load) + np.abs(corrected).sum()
        if np.all(corrected[active, 0] > 0.0) and left <= 0.1 * ROUND_OFF * total:
            needed = cone.force_size(corrected[active, 1:]) / corrected[active, 0]
            found.append((float(needed.max()), corrected))
    return found


def excluded(maps: Floats, load: Floats | None) -> tuple[Mask, list[Floats], bool]:
    """Contacts that may carry something at some friction; the twists that exclude the others; whether nothing balances.

    At unlimited friction a contact carries each force with a positive normal part. A twist that moves points along
    their normals alone, outwards or not at all, meets no resistance then: linear programs find all that it opens.
    """
    left, twists = np.ones(len(maps), dtype=bool), list[Floats]()
    while True:
        basis = _null_space(np.concatenate([m[:, 1:].T for m in maps[left]])) if left.any() else np.eye(maps.shape[1])
        along = maps[left][:, :, 0] @ basis
        k, n = along.shape
        if n == 0:
            return left, twists, False
        limits = [(-1.0, 1.0)] * n
        power = np.zeros(n) if load is None else load @ basis / np.linalg.norm(load)
        power[np.abs(power) < 1e-12] = 0.0
        if load is not None:
            driven = linprog(-power, A_ub=-along, b_ub=np.zeros(k), bounds=limits, method="highs").x
            if power @ driven > RANK:
                return left, [*twists, basis @ driven], True
        if k == 0:
            return left, twists, load is None
        opened = linprog(
            np.concatenate([np.zeros(n), -np.ones(k)]),
            A_ub=np.block([[-along, np.eye(k)], [-power[None, :], np.zeros((1, k))]]),
            b_ub=np.zeros(k + 1),
            bounds=limits + [(0.0, 1.0)] * k,
            method="highs",
        ).x
        twist = basis @ opened[:n]
        gone = along @ opened[:n] > 10.0 * RANK
        if not gone.any():
            return left, twists, False
        twists.append(twist)
        left[np.flatnonzero(left)[gone]] = False


def _null_space(rows: Floats) -> Floats:
    _, sizes, right = np.linalg.svd(rows)
    return np.asarray(right[int((sizes > 0.1 * ROUND_OFF).sum()) :].T)
