"""The patch on which a bolt lies flush, between the two meshes' outlines (method, section 5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from threadstate.mesh.frames import apply
from threadstate.mesh.solid import Floats, Solid

SAME = 1e-6
"""Extreme points nearer than this share of the radius are one."""


@dataclass(frozen=True, eq=False)
class Extreme:
    """An extreme point in the nut's plane (2,), its azimuth on the bolt (rad), whether it is on both outlines."""

    point: Floats
    bolt_azimuth: float
    corner: bool


def extreme_points(bolt: Solid, nut: Solid, T_nut_bolt: Floats, axis: Floats) -> list[Extreme]:
    """The farthest points across a horizontal axis (left, right) and along it (forth, back), each once.

    The bolt is flush; the patch's outer bound is its outline where that lies outside the nut's, with the places where
    they cross. Empty where they do not overlap.
    """
    own = bolt.vertices[bolt.edge]
    points = apply(T_nut_bolt, own)[:, :2]
    azimuths = np.unwrap(np.arctan2(own[:, 1], own[:, 0]))
    over = np.hypot(points[:, 0], points[:, 1]) - _outline_radius(nut, np.arctan2(points[:, 1], points[:, 0]))
    after, over_after = np.roll(points, -1, axis=0), np.roll(over, -1)
    step = (np.roll(azimuths, -1) - azimuths) % (2.0 * np.pi)
    crossing = (over > 0.0) != (over_after > 0.0)
    share = (over[crossing] / (over[crossing] - over_after[crossing]))[:, None]
    corners = points[crossing] + share * (after[crossing] - points[crossing])
    outside = over > 0.0
    candidates = np.vstack([points[outside], corners])
    candidate_azimuths = np.concatenate([azimuths[outside], azimuths[crossing] + share[:, 0] * step[crossing]])
    if len(candidates) == 0:
        return []
    x, y = float(axis[0]), float(axis[1])
    found: list[Extreme] = []
    for direction in ((-y, x), (y, -x), (x, y), (-x, -y)):
        best = int(np.argmax(candidates @ np.array(direction)))
        point = candidates[best]
        if all(np.abs(point - other.point).sum() >= SAME * np.hypot(*point) for other in found):
            found.append(Extreme(point, float(candidate_azimuths[best]), best >= int(outside.sum())))
    return found


def _outline_radius(nut: Solid, azimuths: Floats) -> Floats:
    """The radius of the nut's outline, a polygon, at azimuths (rad)."""
    edge = nut.vertices[nut.edge]
    corners = np.arctan2(edge[:, 1], edge[:, 0]) % (2.0 * np.pi)
    radii = np.hypot(edge[:, 0], edge[:, 1])
    wanted = azimuths % (2.0 * np.pi)
    i = np.searchsorted(corners, wanted, side="right") - 1
    j = (i + 1) % len(corners)
    since, until = wanted - corners[i], (corners[j] - wanted) % (2.0 * np.pi)
    since = since % (2.0 * np.pi)
    return np.asarray(
        radii[i] * radii[j] * np.sin(since + until) / (radii[i] * np.sin(since) + radii[j] * np.sin(until))
    )
