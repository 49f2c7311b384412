"""Both solids once more, written from the method (section 1) with the oracle's profile; lengths in the pair's unit."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from oracle.profile import LEAD, P, radius

Floats = NDArray[np.float64]


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


def slope(s: float, profile: Floats) -> float:
    """``f'`` by differences; good to 1e-8 off the boundaries of regions."""
    step = 1e-7 * profile[P]
    return (radius(s + step, profile) - radius(s - step, profile)) / (2.0 * step)


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
