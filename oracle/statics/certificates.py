"""What contact forces or twists prove about the least friction, in plain arithmetic (docs/forces.md, section 2).

Forces that balance the load within cones of friction ``mu`` show that the least friction is at most ``mu``. A twist
whose power against every force within cones of friction ``mu`` is not negative, and on which the load does work, shows
that no such forces balance the load. Both are read in the frame of the points, without the maps that found them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from oracle.statics.wrenches import Floats, Twist, Wrench

Size = Callable[[Floats], Floats]
"""Of tangential vectors (k, 3): the Euclidean norm for a round cone."""

ROUND_OFF = 1e-12
"""A velocity is zero below this share of the twist's own size, a balance below this share of the forces in it."""
POWER_ROUND_OFF = 1e-14
"""The load's power is positive above this share of what adds up to it."""
PRESSING = 1e-12
"""A ray presses on a contact where its normal part exceeds this share of its largest one."""
EXCLUDED = 1e-9
"""A contact opens under a twist where its normal velocity exceeds this share of the twist's size."""


def norms(vectors: Floats) -> Floats:
    """Euclidean norms of rows."""
    return np.asarray(np.linalg.norm(vectors, axis=1))


def imbalance(points: Floats, forces: Floats, load: Wrench | None) -> float:
    """What is left of forces (k, 3) and load, moments over the points' extent, as a share of all forces in it."""
    centre = points.mean(axis=0)
    force, moment = forces.sum(axis=0), np.cross(points - centre, forces).sum(axis=0)
    extent = float(norms(points - centre).max())
    total = float(norms(forces).sum())
    if load is not None:
        moved = load.about(centre)
        force, moment = force + moved.force, moment + moved.moment
        extent = max(extent, float(np.linalg.norm(load.point - centre)))
        total += float(np.linalg.norm(load.force))
        total += float(np.linalg.norm(load.moment)) / extent if extent else 0.0
    extent = extent or 1.0
    return float(np.hypot(np.linalg.norm(force), np.linalg.norm(moment) / extent)) / (total or 1.0)


def pressing(normal: Floats) -> NDArray[np.bool_]:
    """On which contacts a ray of these normal parts (k) presses: a part that is round-off beside the others is none."""
    return np.asarray(normal > PRESSING * normal.max(initial=0.0))


def forces_bound(
    points: Floats,
    normals: Floats,
    load: Wrench | None,
    forces: Floats,
    rays: Sequence[Floats] = (),
    size: Size = norms,
) -> float:
    """The friction above which ``forces``, with enough of ``rays`` added, balance the load; infinite: no proof.

    A ray is a set of forces (k, 3) that balance each other. Where it presses it can be added without limit, so neither
    later rays nor ``forces`` need to lie in the cones of the contacts on which it presses. Without a load, ``forces``
    must not be all zero: they prove that the contacts wedge.
    """
    free = np.zeros(len(points), dtype=bool)
    bound = 0.0
    for number, given in enumerate((*rays, forces)):
        last = number == len(rays)
        # Contacts that press already may be pulled at; elsewhere what does not press is round-off.
        kept = free | pressing(np.einsum("ka,ka->k", normals, given)) | last
        ray = np.where(kept[:, None], given, 0.0)
        if imbalance(points, ray, load if last else None) > ROUND_OFF:
            return math.inf
        normal = np.einsum("ka,ka->k", normals, ray)
        across = size(ray - normal[:, None] * normals)
        pressed = ray.any(axis=1) & ~free
        if np.any(normal[pressed] <= 0.0) or ((load is None or not last) and not pressed.any()):
            return math.inf
        if pressed.any():
            slight = across[pressed] <= 8.0 * np.finfo(float).eps * normal[pressed]
            bound = max(bound, float(np.where(slight, 0.0, across[pressed] / normal[pressed]).max()))
        free |= pressed
    return bound


def twist_bound(
    points: Floats,
    normals: Floats,
    load: Wrench | None,
    twist: Twist | None,
    exclusions: Sequence[Twist] = (),
    size: Size = norms,
) -> float:
    """The friction below which no forces balance the load (without a load: each other); 0 where nothing is proved.

    An exclusion moves the points of the contacts that are still in question along their normals alone, outwards or not
    at all, and the load does not resist it. Whatever the friction, contacts that open carry no force; where the load
    does work, or without a load no contact is left, nothing balances at any friction: infinite.
    ``size`` is the greatest power of a tangential force of unit size against a velocity.
    """
    left = np.ones(len(points), dtype=bool)
    for exclusion in exclusions:
        along, across, scale = _velocities(points, normals, exclusion, size)
        power, unit = (load.power(exclusion), load.power_scale(exclusion)) if load is not None else (0.0, 1.0)
        if np.any(left & ((across > ROUND_OFF * scale) | (along < -ROUND_OFF * scale))) or power < -ROUND_OFF * unit:
            return 0.0
        if power > EXCLUDED * unit:
            return math.inf
        left &= along <= EXCLUDED * scale
    if load is None and not left.any():
        return math.inf
    if twist is None or not left.any():
        return 0.0
    along, across, scale = _velocities(points, normals, twist, size)
    if load is not None:
        if load.power(twist) <= POWER_ROUND_OFF * load.power_scale(twist):
            return 0.0
        left &= np.maximum(np.abs(along), across) > ROUND_OFF * scale
    if np.any(along[left] <= 0.0):
        return 0.0
    with np.errstate(divide="ignore"):
        return float((along[left] / across[left]).min(initial=math.inf))


def _velocities(points: Floats, normals: Floats, twist: Twist, size: Size) -> tuple[Floats, Floats, float]:
    velocities = twist.at(points)
    along = np.einsum("ka,ka->k", normals, velocities)
    reach = float(norms(points - twist.point).max()) or 1.0
    scale = float(np.linalg.norm(twist.linear)) + float(np.linalg.norm(twist.angular)) * reach
    return along, size(-(velocities - along[:, None] * normals)), scale
