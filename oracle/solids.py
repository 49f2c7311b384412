"""Both solids once more, written from the method (section 1) with the oracle's profile; lengths in the pair's unit."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from oracle.profile import COT, LEAD, Q_FLANK_LARGE, Q_FLANK_SMALL, Q_LARGE, Q_SMALL, RHO_LARGE, RHO_SMALL, P, radius

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
    x = (axial_position(point, profile) - 0.25 * profile[P]) / profile[P]
    q = profile[P] * abs(x - math.floor(x + 0.5))
    corners = (profile[RHO_LARGE], profile[Q_LARGE]), (profile[RHO_SMALL], profile[Q_SMALL])
    return any(rho == 0.0 and abs(q - at) < CORNER_PITCHES * profile[P] for rho, at in corners)


def slope(s: float, profile: Floats) -> float:
    """``f'``; at a sharp corner that of the flat beside it."""
    p = profile[P]
    x = (s - 0.25 * p) / p
    x -= math.floor(x + 0.5)
    q, falling = p * abs(x), math.copysign(1.0, -x)
    if q <= profile[Q_LARGE] or q >= profile[Q_SMALL]:
        return 0.0
    if q < profile[Q_FLANK_LARGE]:
        d = q - profile[Q_LARGE]
        return falling * d / math.sqrt(profile[RHO_LARGE] ** 2 - d * d)
    if q <= profile[Q_FLANK_SMALL]:
        return falling * profile[COT]
    d = profile[Q_SMALL] - q
    return falling * d / math.sqrt(profile[RHO_SMALL] ** 2 - d * d)


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
