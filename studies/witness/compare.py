"""One scene by the closed forms, by the witness and by pyramids."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from oracle.statics.certificates import forces_bound
from oracle.statics.friction import hold_friction, wedge_friction
from oracle.statics.loads import support_margin
from oracle.statics.wrenches import Wrench
from studies.witness.scenes import Scene
from threadstate.statics import _numbers_kernel as nk
from threadstate.statics.hold_bounds import deep_forces
from threadstate.statics.solve import numbers_of
from threadstate.statics.touching import Touching

Floats = NDArray[np.float64]

AGREE = 1e-7
"""Of angles of friction (rad), and of margins."""
SIDES = 64
"""Of the pyramids."""
BRACKETS = (1e-5, 1e-4, 1e-3, 1e-2)
"""Angles (rad) from the closed form's friction at which pyramids are tried, in turn, until they tell."""
LARGEST = 20.0
"""The friction at which pyramids are tried where none holds."""


class Number(StrEnum):
    """What is compared."""

    HOLD = "mu_hold"
    WEDGE = "mu_wedge"
    MARGIN = "support_margin"


class Outcome(StrEnum):
    """What a comparison says."""

    AGREE = "agree to 1e-7"
    VERIFIED = "agree to 1e-7: the witness verifies the closed form's forces"
    WEAK_WITNESS = "the witness proves less"
    WEAK_FORMS = "the closed form is less certain"
    APART = "apart"


class Bracket(StrEnum):
    """What the pyramids say of a least friction."""

    HOLDS = "bracketed"
    OPEN = "too near to tell"
    VIOLATED = "violated"


@dataclass(frozen=True)
class Compared:
    """A number by both: intervals, angles of friction or margins; how far they are apart, and what pyramids say."""

    number: Number
    ours: tuple[float, float]
    theirs: tuple[float, float]
    apart: float
    outcome: Outcome
    bracket: Bracket | None
    bracket_angle: float


def compare(scene: Scene) -> list[Compared]:
    """All three numbers of a scene."""
    row = _closed_forms(scene)
    load = Wrench.of(scene.load[3:], scene.load[:3])
    hold = hold_friction(scene.points, scene.normals, load, 1.0)
    wedge = wedge_friction(scene.points, scene.normals, 1.0)
    margin = support_margin(scene.points, scene.normals, load, 1.0)
    found = []
    for number, at, theirs in ((Number.HOLD, nk.N_HOLD, hold), (Number.WEDGE, nk.N_WEDGE, wedge)):
        upper = math.inf if theirs.upper is None else theirs.upper
        ours = math.atan(row[at]), math.atan(row[at + 1])
        angle, bracket = _bracketed(scene, number, ours)
        one = _compared(number, ours, (math.atan(theirs.lower), math.atan(upper)), bracket, angle)
        if one.outcome is Outcome.WEAK_WITNESS and number is Number.HOLD and _verified(scene, load, one):
            one = replace(one, outcome=Outcome.VERIFIED)
        found.append(one)
    own = float(row[nk.N_MARGIN])
    # Of a supported load on dependent rays the closed form says no more than that it is supported.
    deepest = math.inf if own == 0.0 and _are_dependent(scene) else own
    found.append(_compared(Number.MARGIN, (own, deepest), (margin.lower, margin.upper), None, 0.0))
    return found


def _compared(
    number: Number,
    ours: tuple[float, float],
    theirs: tuple[float, float],
    bracket: Bracket | None,
    angle: float,
) -> Compared:
    apart = max(ours[0] - theirs[1], theirs[0] - ours[1], 0.0)
    if math.isinf(ours[0]) and ours == theirs:
        apart = 0.0
    spread = [high - low if high > low else 0.0 for low, high in (ours, theirs)]
    if not apart <= AGREE:
        outcome = Outcome.APART
    elif spread[1] > AGREE:
        outcome = Outcome.WEAK_WITNESS
    elif spread[0] > AGREE:
        outcome = Outcome.WEAK_FORMS
    else:
        outcome = Outcome.AGREE
    return Compared(number, ours, theirs, apart, outcome, bracket, angle)


def _verified(scene: Scene, load: Wrench, one: Compared) -> bool:
    """Whether the witness's twist, and the closed form's forces in its arithmetic, prove the closed form's friction."""
    angle = one.ours[1]
    forces, _ = deep_forces(scene.load, scene.points, scene.normals, math.tan(angle + 0.5 * AGREE))
    bound = forces_bound(scene.points, scene.normals, load, forces)
    return math.atan(bound) - AGREE <= angle <= one.theirs[0] + AGREE


def _are_dependent(scene: Scene) -> bool:
    rays = np.hstack([np.cross(scene.points, scene.normals), scene.normals])
    return int(np.linalg.matrix_rank(rays)) < len(rays)


def _closed_forms(scene: Scene) -> Floats:
    """A row of numbers, as ``_numbers_kernel`` lays them out."""
    contacts = Touching(scene.points, scene.normals, 0, (0.0, 0.0, 0.0), scene.patch, False, 0.0, False)
    margin, hold, wedge = numbers_of(scene.load, contacts)
    return np.array([nk.DONE, margin, hold.lower, hold.upper, wedge.lower, wedge.upper])


def _bracketed(scene: Scene, number: Number, angles: tuple[float, float]) -> tuple[float, Bracket]:
    """The least angle beside those of the closed form at which pyramids hold above and do not below, and whether.

    An inscribed pyramid of friction ``mu / cos(pi / SIDES)`` is the one circumscribed about the cone of ``mu``: what a
    cone holds it holds, and what it holds that larger cone does.
    """
    low, high = angles
    never = high >= math.pi / 2.0
    for step in BRACKETS:
        below = low - step
        fails = below <= 0.0 or not _holds(
            scene, number, LARGEST if never and low > math.atan(LARGEST) else math.tan(below)
        )
        above = high + step
        holds = never or above >= math.pi / 2.0 or _holds(scene, number, math.tan(above) / math.cos(math.pi / SIDES))
        if fails and holds:
            return step, Bracket.HOLDS
    return BRACKETS[-1], Bracket.VIOLATED


def _holds(scene: Scene, number: Number, mu: float) -> bool:
    """Whether pyramids inscribed in cones of a friction balance the load, or each other, by a linear program."""
    rays = _rays(scene, mu)
    if number is Number.HOLD:
        matrix, right = rays, -scene.load / np.linalg.norm(scene.load)
    else:
        matrix, right = np.vstack([rays, np.ones(rays.shape[1])]), np.append(np.zeros(6), 1.0)
    options = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
    found = linprog(
        np.zeros(rays.shape[1]), A_eq=matrix, b_eq=right, bounds=(0.0, None), method="highs", options=options
    )
    return bool(found.status == 0)


def _rays(scene: Scene, mu: float) -> Floats:
    """The wrenches (6, k SIDES) of forces of size 1 along the pyramids' edges."""
    angles = np.linspace(0.0, 2.0 * math.pi, SIDES, endpoint=False)
    rays = []
    for point, normal in zip(scene.points, scene.normals, strict=True):
        across = np.linalg.svd(normal[np.newaxis])[2][1:]
        forces = normal + mu * (np.outer(np.cos(angles), across[0]) + np.outer(np.sin(angles), across[1]))
        forces /= math.hypot(1.0, mu)
        rays.append(np.hstack([np.cross(point, forces), forces]))
    return np.vstack(rays).T
