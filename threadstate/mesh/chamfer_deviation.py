"""How far the mesh of a chamfered bolt is from its true surfaces."""

from __future__ import annotations

import math

import numpy as np

from threadstate.mesh.solid import Deviation, Face, Floats, Solid, deviation
from threadstate.thread.chamfer import Chamfer
from threadstate.thread.profile import Profile

DIVISIONS = 4
"""As of :mod:`threadstate.mesh._deviation_kernel`."""


def chamfered_deviation(solid: Solid, profile: Profile, chamfer: Chamfer | None) -> Deviation:
    """As :func:`threadstate.mesh.solid.deviation`, of a bolt that may have a chamfer.

    Points of either surface count, too, as far as they lie beyond the other; the outline is that of both. Contacts may
    be on the edge between them, so that ``edge`` is at least ``surface``.
    """
    if chamfer is None:
        return deviation(solid, profile)
    of_thread = deviation(solid, profile).surface
    thread, cone = (_samples(solid, face) for face in (Face.THREAD, Face.CHAMFER))
    normal = math.sqrt(1.0 + chamfer.slope * chamfer.slope)
    surface = max(
        of_thread,
        float(_beyond_cone(thread, chamfer).max()) / normal,
        float(np.abs(_beyond_cone(cone, chamfer)).max(initial=0.0)) / normal,
        float(_beyond_thread(cone, profile).max(initial=0.0)),
    )
    outline = solid.vertices[solid.edge]
    after = np.roll(outline, -1, axis=0)
    on_sides = np.vstack([outline + k / DIVISIONS * (after - outline) for k in range(DIVISIONS)])
    gaps = np.maximum(_beyond_cone(on_sides, chamfer), _beyond_thread(on_sides, profile))
    return Deviation(surface=surface, edge=max(surface, float(np.abs(gaps).max())))


def _samples(solid: Solid, face: Face) -> Floats:
    """Points of a face's triangles, on a grid that divides their sides; (n, 3)."""
    a, b, c = solid.vertices[solid.triangles[solid.faces == face]].transpose(1, 0, 2)
    shares = [(i / DIVISIONS, j / DIVISIONS) for i in range(DIVISIONS + 1) for j in range(DIVISIONS + 1 - i)]
    return np.vstack([u * a + v * b + (1.0 - u - v) * c for u, v in shares])


def _beyond_cone(points: Floats, chamfer: Chamfer) -> Floats:
    radii = np.hypot(points[:, 0], points[:, 1])
    return np.asarray(radii - chamfer.end_diameter / 2.0 - points[:, 2] * chamfer.slope)


def _beyond_thread(points: Floats, profile: Profile) -> Floats:
    s = points[:, 2] - profile.advance * np.arctan2(points[:, 1], points[:, 0])
    return np.hypot(points[:, 0], points[:, 1]) - np.array([profile.radius(place) for place in s.tolist()])
