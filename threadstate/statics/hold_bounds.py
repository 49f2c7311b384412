"""Bounds of the friction that holds a load, proved by motions from below and by forces from above (forces, section 3).

Lengths are over the nominal radius, about the point of the load; wrenches are (moment, force).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from threadstate.statics import _numbers_kernel as nk
from threadstate.statics.numbers import contact_numbers
from threadstate.statics.verdict import FrictionBounds
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

Floats = NDArray[np.float64]

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
        row, _, twist = contact_numbers(nk.HOLD_ALONE, wrench, hull[chosen], normals[chosen])
        bounds = FrictionBounds(*row[nk.N_HOLD : nk.N_HOLD + 2].tolist())
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
