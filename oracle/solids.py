"""Both solids once more, written from the method (section 1) with the oracle's profile; lengths in the pair's unit."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from oracle.profile import (
    COT,
    FALLING,
    LEAD,
    Q_FLANK_LARGE,
    Q_FLANK_SMALL,
    Q_LARGE,
    Q_SMALL,
    RHO_LARGE,
    RHO_SMALL,
    RISING,
    P,
    beyond_quarter,
    radius,
    radius_of_side,
)

Floats = NDArray[np.float64]

CORNER_PITCHES = 1e-7
"""A point as near to a sharp corner, in thread pitches along the axis, is on it."""


def axial_position(point: Floats, profile: Floats) -> float:
    """``s = z - lead theta / 2 pi`` of a point in the thread's own frame."""
    return float(point[2] - profile[LEAD] * math.atan2(point[1], point[0]) / (2.0 * math.pi))


def outside_thread(point: Floats, profile: Floats) -> float:
    """``r - f(s)``: how far a point lies outside the thread's surface, in radius."""
    return math.hypot(point[0], point[1]) - radius(axial_position(point, profile), profile)


def outside_bolt(point: Floats, bolt: Floats) -> float:
    """> 0 off the closed bolt, point in the bolt's frame."""
    return max(outside_thread(point, bolt), -float(point[2]), float(point[2] - bolt[P]))


def outside_nut(point: Floats, nut: Floats) -> float:
    """> 0 off the closed nut, point in the nut's frame."""
    return max(-outside_thread(point, nut), float(point[2]), -float(point[2] + nut[P]))


def at_sharp_corner(point: Floats, profile: Floats) -> bool:
    """Whether a point of the thread is on a corner without a fillet, or as near to it as makes no difference."""
    q, side, _ = _beside_ridge(axial_position(point, profile), profile)
    corners = (profile[RHO_LARGE], profile[Q_LARGE + side]), (profile[RHO_SMALL], profile[Q_SMALL + side])
    return any(rho == 0.0 and abs(q - at) < CORNER_PITCHES * profile[P] for rho, at in corners)


def slope(s: float, profile: Floats) -> float:
    """``f'``; at a sharp corner that of the flat beside it."""
    q, side, sign = _beside_ridge(s, profile)
    if q <= profile[Q_LARGE + side] or q >= profile[Q_SMALL + side]:
        return 0.0
    if q < profile[Q_FLANK_LARGE + side]:
        d = q - profile[Q_LARGE + side]
        return sign * d / math.sqrt(profile[RHO_LARGE] ** 2 - d * d)
    if q <= profile[Q_FLANK_SMALL + side]:
        return float(sign * profile[COT + side])
    d = profile[Q_SMALL + side] - q
    return sign * d / math.sqrt(profile[RHO_SMALL] ** 2 - d * d)


def _beside_ridge(s: float, profile: Floats) -> tuple[float, int, float]:
    """Distance from s = p/4 on the side that bounds the ridge there, that side, and the sign of the slope on it."""
    x = beyond_quarter(s, profile)
    if radius_of_side(-x, RISING, profile) < radius_of_side(x, FALLING, profile) or (
        # On the flats, whose corners belong to the nearer side.
        radius_of_side(-x, RISING, profile) == radius_of_side(x, FALLING, profile)
        and abs(-x - profile[Q_LARGE]) < abs(x - profile[Q_LARGE + FALLING])
    ):
        return -x, RISING, 1.0
    return x, FALLING, -1.0


def outward_of_faces(point: Floats, profile: Floats) -> tuple[Floats, ...]:
    """As :func:`outward`; at a sharp corner the normals of both faces that meet there."""
    if not at_sharp_corner(point, profile):
        return (outward(point, profile),)
    beside = 2.0 * CORNER_PITCHES * profile[P]
    return tuple(outward(point + np.array([0.0, 0.0, shift]), profile) for shift in (-beside, beside))


def outward(point: Floats, profile: Floats) -> Floats:
    """Unit normal of the thread's surface that points to greater radii, in the thread's frame."""
    r, azimuth = math.hypot(point[0], point[1]), math.atan2(point[1], point[0])
    steepness = slope(axial_position(point, profile), profile)
    along = steepness * profile[LEAD] / (2.0 * math.pi * r)
    c, s = math.cos(azimuth), math.sin(azimuth)
    normal = np.array([c - along * s, s + along * c, -steepness])
    return np.asarray(normal / np.linalg.norm(normal))


def edge_tangent(point: Floats, profile: Floats) -> Floats:
    """Unit counter-clockwise tangent of the edge ``r = f(-lead theta / 2 pi)`` at a point on it, thread's frame."""
    azimuth, k = math.atan2(point[1], point[0]), profile[LEAD] / (2.0 * math.pi)
    r, dr = radius(-k * azimuth, profile), -k * slope(-k * azimuth, profile)
    c, s = math.cos(azimuth), math.sin(azimuth)
    tangent = np.array([dr * c - r * s, dr * s + r * c, 0.0])
    return np.asarray(tangent / np.linalg.norm(tangent))
