"""The two angles that turn the x axis into a given direction: as the paper prints them, and by atan2.

The paper's Eqs. 7, 9 and 11 are one formula for three directions: ``first = acos(x / sin(acos z))`` about z and
``second = acos(z) - pi / 2`` about y.
"""

from __future__ import annotations

import math

import numpy as np

from oracle.solids import Floats


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
