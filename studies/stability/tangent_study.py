"""Where the paper's angles fail: beside the axes, and along the tangents and pivot axes of states.

The paper's Eqs. 7, 9 and 11 are one formula for three directions: ``first = acos(x / sin(acos z))`` about z and
``second = acos(z) - pi / 2`` about y. Beside it stands the same by atan2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from oracle.solids import Floats
from oracle.state_turns import first_tangent
from studies.stability.change import SolvedCase, leading_contacts


def printed_angles(direction: Floats) -> tuple[float, float]:
    """The paper's formula, for a unit vector of shape (3,): angles in rad, NaN where it gives no number."""
    x, _, z = (np.float64(part) for part in direction)
    with np.errstate(invalid="ignore", divide="ignore"):
        across = np.sin(np.arccos(z))
        return float(np.arccos(x / across)), float(np.arccos(z) - math.pi / 2.0)


def two_argument_angles(direction: Floats) -> tuple[float, float]:
    """The same angles by atan2, in rad: numbers everywhere; along +-z the first one is free, and is 0 or pi."""
    x, y, z = (float(part) for part in direction)
    return math.atan2(y, x), -math.atan2(z, math.hypot(x, y))


def turned_x(first: float, second: float) -> Floats:
    """Where Rz(first) Ry(second) takes the x axis; unit vector of shape (3,)."""
    return np.array([math.cos(second) * math.cos(first), math.cos(second) * math.sin(first), -math.sin(second)])


def error_deg(angles: tuple[float, float], direction: Floats) -> float:
    """The angle between a direction and the one that its angles give, in degrees; NaN where they are none."""
    if any(map(math.isnan, angles)):
        return math.nan
    found = turned_x(*angles)
    return math.degrees(math.atan2(float(np.linalg.norm(np.cross(found, direction))), float(found @ direction)))


def frame_along(direction: Floats) -> Floats:
    """A rotation whose first column is the direction, by the angles of atan2; shape (3, 3)."""
    first, second = two_argument_angles(direction)
    c, s, d, e = math.cos(first), math.sin(first), math.cos(second), math.sin(second)
    return np.array([[c * d, -s, c * e], [s * d, c, s * e], [-e, 0.0, d]])


OFFSETS = (0.0, 1e-16, 1e-12, 1e-8, 1e-4, 1e-2)
"""Angles (rad) between a direction and the axis that it is beside."""
AROUND = 16
"""Directions at each angle."""
WRONG_DEG = 1e-6
"""An angle that is off by more is wrong."""


@dataclass(frozen=True)
class BesideAxis:
    """One axis: how many of the directions beside it have no angles as printed, and the largest errors in degrees."""

    axis: str
    directions: int
    without_number: int
    wrong: int
    printed_deg: float
    two_argument_deg: float


@dataclass(frozen=True)
class DirectionErrors:
    """The printed formula's errors in degrees for one state: Eqs. 7, 9 and 11; NaN where it gives no number.

    None where the state has no such direction.
    """

    nut_tangent: float | None
    bolt_tangent: float | None
    pivot_axis: float | None


def beside_axes() -> list[BesideAxis]:
    """Both formulas beside the six axes."""
    found = []
    for name, along, across in (("x", 0, 1), ("y", 1, 2), ("z", 2, 0)):
        for sign, mark in ((1.0, "+"), (-1.0, "-")):
            directions = [_beside(sign, along, across, k, offset) for offset in OFFSETS for k in range(AROUND)]
            printed = [error_deg(printed_angles(one), one) for one in directions]
            numbers = [error for error in printed if not math.isnan(error)]
            found.append(
                BesideAxis(
                    axis=mark + name,
                    directions=len(directions),
                    without_number=len(printed) - len(numbers),
                    wrong=sum(error > WRONG_DEG for error in numbers),
                    printed_deg=max(numbers, default=math.nan),
                    two_argument_deg=max(error_deg(two_argument_angles(one), one) for one in directions),
                )
            )
    return found


def _beside(sign: float, along: int, across: int, k: int, offset: float) -> Floats:
    around = 2.0 * math.pi * (k + 0.5) / AROUND
    direction = np.zeros(3)
    direction[along] = sign
    direction[across] = offset * math.cos(around)
    direction[3 - along - across] = offset * math.sin(around)
    return np.asarray(direction / np.linalg.norm(direction))


def direction_errors(solved: SolvedCase) -> DirectionErrors:
    """The printed formula along the tangent at CP0, in the nut's and the bolt's frame, and along CP0-CP1."""
    state = solved.state
    held = leading_contacts(state)
    if 1 not in held:
        return DirectionErrors(None, None, None)
    tangent = first_tangent(solved.case.pair, state)
    in_bolt = np.array(state.poses[0].rotation).T @ tangent
    pivot = None
    if 2 in held:
        axis = np.array(held[2].point) - np.array(held[1].point)
        in_contact_frame = frame_along(tangent).T @ (axis / np.linalg.norm(axis))
        pivot = error_deg(printed_angles(in_contact_frame), in_contact_frame)
    return DirectionErrors(
        error_deg(printed_angles(tangent), tangent), error_deg(printed_angles(in_bolt), in_bolt), pivot
    )


def is_wrong(error: float | None) -> bool:
    """Whether the printed formula is off, or gives no number."""
    return error is not None and not error <= WRONG_DEG
