"""The two solids as array functions: how far points are inside the thread, by closed form."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate.state.model import StagePose
from threadstate.thread.pair import Pair

Array = NDArray[np.float64]

TABLE = 200_000
"""Entries of a tabulated profile: straight lines between them are within 1e-11 in of it."""


class Solids:
    """Bolt and nut of a pair; points have shape (..., 3), lengths are in the pair's unit."""

    def __init__(self, pair: Pair) -> None:
        self.thread_pitch = pair.thread_pitch
        self._s = np.linspace(0.0, pair.thread_pitch, TABLE + 1)
        self._bolt, self._nut = (
            np.array([profile.radius(s) for s in self._s.tolist()]) for profile in (pair.bolt, pair.nut)
        )

    def bolt_outline(self, theta: Array, z: float) -> Array:
        """Points of the bolt's outline at height ``z`` of its own frame and azimuths in rad, shape (n, 3)."""
        return self._outline(theta, z, self._bolt)

    def nut_outline(self, theta: Array, z: float) -> Array:
        """Points of the nut's outline at height ``z`` of its own frame and azimuths in rad, shape (n, 3)."""
        return self._outline(theta, z, self._nut)

    def inside_nut(self, points: Array) -> Array:
        """How far points of the nut's frame are inside the nut: beyond its thread and between its two faces."""
        depth = np.hypot(points[..., 0], points[..., 1]) - self._radii(points, self._nut)
        z = points[..., 2]
        return np.minimum(depth, np.minimum(-z, z + self.thread_pitch))

    def inside_bolt(self, points: Array) -> Array:
        """How far points of the bolt's frame are inside the bolt: within its thread and between its two faces."""
        depth = self._radii(points, self._bolt) - np.hypot(points[..., 0], points[..., 1])
        z = points[..., 2]
        return np.minimum(depth, np.minimum(z, self.thread_pitch - z))

    def _outline(self, theta: Array, z: float, table: Array) -> Array:
        radius = self._at(z - self.thread_pitch * theta / (2.0 * np.pi), table)
        return np.stack([radius * np.cos(theta), radius * np.sin(theta), np.full_like(theta, z)], axis=-1)

    def _radii(self, points: Array, table: Array) -> Array:
        theta = np.arctan2(points[..., 1], points[..., 0])
        return self._at(points[..., 2] - self.thread_pitch * theta / (2.0 * np.pi), table)

    def _at(self, s: Array, table: Array) -> Array:
        radii: Array = np.interp(np.mod(s, self.thread_pitch), self._s, table)
        return radii


def to_nut(pose: StagePose, points: Array) -> Array:
    """Points of the bolt's frame, shape (n, 3), in the nut's."""
    turned = points @ np.array(pose.rotation).T
    moved: Array = turned + np.array(pose.translation)
    return moved


def to_bolt(pose: StagePose, points: Array) -> Array:
    """Points of the nut's frame, shape (n, 3), in the bolt's."""
    turned: Array = (points - np.array(pose.translation)) @ np.array(pose.rotation)
    return turned
