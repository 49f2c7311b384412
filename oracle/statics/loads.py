"""How well contacts support a load, and what forces that takes (docs/forces.md, section 3).

Distances between wrenches depend on the point about which moments are taken: ``about``, by default the origin of the
frame of the points. The load is the same wherever its own moment's point lies.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, islice

import clarabel
import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import nnls

from oracle.statics.certificates import ROUND_OFF
from oracle.statics.cones import RoundCone, solve_conic
from oracle.statics.friction import BLENDS, RANK, split, wedge
from oracle.statics.friction import corrections as forces_from
from oracle.statics.wrenches import Contacts, Floats, Twist, Wrench

ORIGIN = (0.0, 0.0, 0.0)
FACET_BATCH = 4096
"""Sets of generators whose planes are tried at once."""
INSIDE = 1e-12
"""Minus the load lies in the cone of normal forces when it is this near to it."""


@dataclass(frozen=True, eq=False)
class SupportMargin:
    """The signed distance lies in [lower, upper]; infinite inside a cone without boundary.

    Outside, ``normal_forces`` (k,) give the nearest wrench of the cone and ``twist`` the plane that separates. Inside,
    ``twist`` is the normal of the nearest facet: no contact resists it, and the load resists it least.
    """

    lower: float
    upper: float
    normal_forces: Floats
    twist: Twist | None


@dataclass(frozen=True, eq=False)
class Reaction:
    """The least wrench to be added: ``wrench`` (mx, my, mz, fx, fy, fz) about ``about``; its norm in [lower, upper].

    The norm has moments over r. ``forces`` (k, 3) are contact forces that balance load and wrench where no contacts
    wedge; those of contacts that do may be completed without limit. ``twist`` proves ``lower``.
    """

    lower: float
    upper: float
    wrench: Floats
    forces: Floats
    twist: Twist


@dataclass(frozen=True, eq=False)
class NormalRange:
    """The least normal force of a contact (N) among balancing forces lies in ``least``, the largest in ``largest``.

    Each is an interval (from below, from above), whose outer end a twist proves and whose inner one forces do.
    """

    least: tuple[float, float]
    largest: tuple[float, float]


@dataclass(frozen=True, eq=False)
class LargestForce:
    """The least largest normal force (N) lies in [lower, upper]; ``upper`` None: no balancing forces are known.

    ``forces`` (k, 3) balance the load within cones of ``friction``, which exceeds the given one by the solver's error,
    1e-10 or so; ``lower`` holds for the given friction.
    ``lower`` is infinite where ``twist`` proves that nothing balances.
    """

    lower: float
    upper: float | None
    forces: Floats | None
    friction: float
    twist: Twist


def support_margin(
    points: ArrayLike, normals: ArrayLike, load: Wrench, r: float, about: ArrayLike = ORIGIN
) -> SupportMargin:
    """Signed distance of ``-w/|w|`` from the cone of frictionless contacts, moments about ``about`` over ``r``.

    Negative outside: minus the distance from the cone. Inside: the distance from the cone's relative boundary, within
    the linear span of the cone. The number is not continuous where the cone has no interior: a little outside of the
    span it is about 0, within it positive. Facets are enumerated: fit for up to about 20 contacts.
    """
    contacts = Contacts.of(points, normals, r, about)
    coordinates = contacts.coordinates(load)
    aim = -coordinates / np.linalg.norm(coordinates)
    generators = contacts.maps[:, :, 0]
    forces, distance = nnls(generators.T, aim)
    if distance > INSIDE:
        pull = _distance(contacts.maps, -aim, 0.0)
        return SupportMargin(-distance, -pull.lower, forces, contacts.twist(pull.twist))
    nearest, margin = None, math.inf
    for facets in _facets(generators):
        margins = facets @ aim
        if margins.min() < margin:
            margin, nearest = float(margins.min()), facets[margins.argmin()]
    margin = max(margin, 0.0)
    return SupportMargin(margin, margin, forces, None if nearest is None else contacts.twist(nearest))


def _facets(generators: Floats) -> Iterator[Floats]:
    """Inward unit normals, within the span, of the facets of the cone of generators (k, 6), in batches (m, 6)."""
    _, sizes, right = np.linalg.svd(generators)
    span = right[: int((sizes > RANK * sizes[0]).sum())]
    inside = generators @ span.T
    size = len(span)
    if size == 1:
        # The boundary of a half-line is its end; a line has none.
        if abs(np.sign(inside).sum()) == len(inside):
            yield np.sign(inside[0, 0]) * span
        return
    subsets = combinations(range(len(inside)), size - 1)
    while batch := list(islice(subsets, FACET_BATCH)):
        _, across, rows = np.linalg.svd(inside[np.array(batch)])
        normals = rows[across[:, -1] > RANK, -1]
        sides = normals @ inside.T
        normals = np.concatenate([normals[sides.min(axis=1) >= -RANK], -normals[sides.max(axis=1) <= RANK]])
        if len(normals):
            yield np.asarray(normals @ span)


def reaction(
    points: ArrayLike, normals: ArrayLike, load: Wrench, r: float, mu: float, about: ArrayLike = ORIGIN
) -> Reaction:
    """The least wrench that must be added so that contacts of friction ``mu`` balance the load, moments over ``r``.

    Where contacts wedge it is the infimum over contact forces without limit. Within round-off of the friction of
    wedging, where the cone of wrenches changes at once, the interval may be wide.
    """
    contacts = Contacts.of(points, normals, r, about)
    found = _distance(contacts.maps, contacts.coordinates(load), mu)
    wrench = found.wrench * np.repeat([contacts.length, 1.0], 3)
    return Reaction(found.lower, found.upper, wrench, contacts.vectors(found.forces), contacts.twist(found.twist))


@dataclass(frozen=True, eq=False)
class _Distance:
    lower: float
    upper: float
    wrench: Floats
    forces: Floats
    twist: Floats


def _distance(maps: Floats, load: Floats, mu: float) -> _Distance:
    """Of minus the load from the (closed) cone of contact wrenches: the projection, and the twist that proves it.

    What contacts that wedge below ``mu`` can balance is divided out first; without friction, what the normal forces
    can that balance each other. The twist meets no resistance and has size 1, or is zero: by Moreau's theorem the
    load's power on it is at most the distance.
    """
    if mu < 0.0 or not math.isfinite(mu):
        raise ValueError(f"friction must be finite and at least 0: {mu}")
    cone = RoundCone()
    forces, q = np.zeros((len(maps), 3)), maps.shape[1]
    if np.linalg.norm(load) == 0.0 or q == 0 or len(maps) == 0:
        size = float(np.linalg.norm(load))
        return _Distance(size, size, -load, forces, load / (size or 1.0))
    wedging = wedge(maps, cone)
    if wedging.forces is not None and (wedging.upper < mu or wedging.upper == mu == 0.0):
        pressed, parts = wedging.forces[:, 0] > 0.0, 3 if mu else 1
        carried, free = split(maps[:, :, :parts], pressed)
        inner = _distance(np.einsum("qp,kqc->kpc", free, maps[~pressed]), free.T @ load, mu)
        forces[~pressed] = inner.forces
        missing = load + free @ inner.wrench + np.einsum("kqc,kc->q", maps, forces)
        forces[pressed, :parts] = -np.linalg.lstsq(carried, missing, rcond=RANK)[0].reshape(-1, parts)
        return _Distance(inner.lower, inner.upper, free @ inner.wrench, forces, free @ inner.twist)
    twist, proposed = cone.hold(maps, load / np.linalg.norm(load), mu)
    opening, _ = cone.wedge(maps, mu)
    lower, best = 0.0, np.zeros(q)
    for blend in BLENDS:
        blended = twist + blend * opening
        blended /= max(float(np.linalg.norm(blended)), 1e-300)
        if _resistance(maps, blended, mu).max() <= 0.1 * ROUND_OFF and load @ blended > lower:
            lower, best = float(load @ blended), blended
    forces = proposed * np.linalg.norm(load)
    for needed, corrected in forces_from(maps, load, forces, cone, mu):
        if needed <= mu * (1.0 + ROUND_OFF) + ROUND_OFF:
            forces = corrected
            break
    across = cone.force_size(forces[:, 1:])
    forces = np.maximum(forces, [0.0, -math.inf, -math.inf])
    forces[:, 1:] *= np.minimum(1.0, mu * forces[:, 0] / np.where(across > 0.0, across, 1.0))[:, None]
    wrench = -(load + np.einsum("kqc,kc->q", maps, forces))
    return _Distance(lower, float(np.linalg.norm(wrench)), wrench, forces, best)


def _resistance(maps: Floats, twist: Floats, mu: float) -> Floats:
    """The greatest power against a scaled twist, per unit of normal force, of each contact's force; at least 0."""
    velocities = np.einsum("kqc,q->kc", maps, twist)
    return np.maximum(mu * RoundCone().velocity_size(velocities[:, 1:]) - velocities[:, 0], 0.0)


def least_largest_normal_forces(points: ArrayLike, normals: ArrayLike, load: Wrench, mu: float) -> LargestForce:
    """Contact forces that balance the load at friction ``mu`` with the least largest normal force.

    The value is unique, the forces need not be. For any twist the load's power is at most the largest normal force
    times the sum over contacts of the resistance for each unit of normal force: that is the lower bound.
    """
    if mu < 0.0 or not math.isfinite(mu):
        raise ValueError(f"friction must be finite and at least 0: {mu}")
    contacts = Contacts.of(points, normals)
    coordinates = contacts.coordinates(load)
    scale = float(np.linalg.norm(coordinates))
    twist, proposed = _least_largest(contacts.maps, coordinates / scale, mu)
    opening, _ = RoundCone().wedge(contacts.maps, mu)
    lower, best = 0.0, twist
    for blend in BLENDS:
        blended = twist + blend * float(np.linalg.norm(twist)) * opening
        power, resistance = float(coordinates @ blended), float(_resistance(contacts.maps, blended, mu).sum())
        if power > 1e-14 * scale * np.linalg.norm(blended):
            value = power / resistance if resistance > ROUND_OFF * np.linalg.norm(blended) else math.inf
            if value > lower:
                lower, best = value, blended
    options = [
        (needed, float(forces[:, 0].max()), forces)
        for needed, forces in forces_from(contacts.maps, coordinates, proposed * scale, RoundCone(), mu)
        if needed <= mu + 1e-6 * (1.0 + mu)
    ]
    if not options:
        return LargestForce(lower, None, None, mu, contacts.twist(best))
    needed, largest, forces = min(options, key=lambda option: max(option[0], mu))
    return LargestForce(lower, largest, contacts.vectors(forces), max(mu, needed), contacts.twist(best))


def _least_largest(maps: Floats, load: Floats, mu: float) -> tuple[Floats, Floats]:
    """Twist and forces that Clarabel proposes; variables are N and t / mu of each contact, and the bound on N."""
    k, q, _ = maps.shape
    shares = np.array([1.0, mu, mu])
    columns = np.einsum("kqc,c->qkc", maps, shares).reshape(q, 3 * k)
    bound = np.zeros((k, 3 * k + 1))
    bound[np.arange(k), 3 * np.arange(k)] = 1.0
    bound[:, -1] = -1.0
    blocks = [
        (np.column_stack([columns, np.zeros(q)]), -load),
        (bound, np.zeros(k)),
        (np.column_stack([-np.eye(3 * k), np.zeros(3 * k)]), np.zeros(3 * k)),
    ]
    kinds = [clarabel.ZeroConeT(q), clarabel.NonnegativeConeT(k), *([clarabel.SecondOrderConeT(3)] * k)]
    x, multipliers = solve_conic(np.eye(1, 3 * k + 1, 3 * k)[0], blocks, kinds)
    return multipliers[:q], x[: 3 * k].reshape(k, 3) * shares


def normal_force_range(points: ArrayLike, normals: ArrayLike, load: Wrench, mu: float, contact: int) -> NormalRange:
    """The range of a contact's normal force among forces that balance the load at ``mu``, where no contacts wedge.

    For any twist whose power against the forces of every contact, less the contact's own normal force, is not negative,
    that force is at least the load's power on it.
    """
    contacts = Contacts.of(points, normals)
    coordinates = contacts.coordinates(load)
    least = _end(contacts.maps, coordinates, mu, contact, 1.0)
    largest = _end(contacts.maps, coordinates, mu, contact, -1.0)
    return NormalRange(least, (-largest[1], -largest[0]))


def _end(maps: Floats, load: Floats, mu: float, contact: int, sense: float) -> tuple[float, float]:
    """Bounds of the least ``sense`` times a normal force, from forces and a twist that Clarabel proposes."""
    k, q, _ = maps.shape
    shares = np.array([1.0, mu, mu])
    columns = np.einsum("kqc,c->qkc", maps, shares).reshape(q, 3 * k)
    blocks = [(columns, -load), (-np.eye(3 * k), np.zeros(3 * k))]
    kinds = [clarabel.ZeroConeT(q), *([clarabel.SecondOrderConeT(3)] * k)]
    x, multipliers = solve_conic(sense * np.eye(3 * k)[3 * contact], blocks, kinds)
    inner = [
        sense * float(forces[contact, 0])
        for needed, forces in forces_from(maps, load, x.reshape(k, 3) * shares, RoundCone(), mu)
        if needed <= mu + 1e-6 * (1.0 + mu)
    ]
    opening, _ = RoundCone().wedge(maps, mu)
    outer = -math.inf
    for blend in BLENDS:
        twist = multipliers[:q] + blend * (1.0 + float(np.linalg.norm(multipliers[:q]))) * opening
        velocities = np.einsum("kqc,q->kc", maps, twist)
        velocities[contact, 0] += sense
        if (mu * RoundCone().velocity_size(velocities[:, 1:]) <= velocities[:, 0] + ROUND_OFF).all():
            outer = max(outer, float(load @ twist))
    return outer, min(inner, default=math.inf)
