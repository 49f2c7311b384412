"""The sense of the third turn: which way about CP0 -> CP1 the insertion force turns the bolt."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def origin_moment(cp0: ArrayLike, cp1: ArrayLike, origin: ArrayLike) -> float:
    """How fast the bolt's origin rises as the bolt turns about the unit axis from ``cp0`` to ``cp1``; a length.

    All three are points of the nut's frame. Its reverse is the moment of a unit force along -z through the origin.
    """
    a, b, o = (np.asarray(point, dtype=np.float64) for point in (cp0, cp1, origin))
    axis = (b - a) / np.linalg.norm(b - a)
    return float(np.cross(axis, o - a)[2])


def sense_by_moment(cp0: ArrayLike, cp1: ArrayLike, origin: ArrayLike) -> int:
    """+1 or -1: the sense in which the bolt's origin sinks; 0 where it lies over or under the axis (balanced)."""
    return -int(np.sign(origin_moment(cp0, cp1, origin)))


def sense_by_quadrants(cp0: ArrayLike, cp1: ArrayLike) -> int:
    """The sense by the paper's section 6.3: from the quadrants of the contacts, the intercept and the slope.

    Where the axis meets the X axis of the nut and which way it leads from there says on which side of it the **nut's**
    axis lies, taken for the bolt's origin; heights are ignored. It differs from the moment wherever the axis passes
    between the nut's axis and the bolt's origin, and says nothing (0) of an axis parallel to X, which has no intercept,
    or through the nut's axis.
    """
    (x0, y0), (x1, y1) = (np.asarray(point, dtype=np.float64)[:2] for point in (cp0, cp1))
    if y1 == y0:
        return 0
    intercept = x0 - y0 * (x1 - x0) / (y1 - y0)
    return -int(np.sign(intercept) * np.sign(y1 - y0))
