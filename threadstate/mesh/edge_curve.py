"""A part's edge curve as a polygon, and which runs of it lie inside the other part."""

from __future__ import annotations

import math

import numpy as np

from threadstate.contact._geometry_kernel import edge_point, phi_and_gradient
from threadstate.mesh import _curve_kernel as kernel
from threadstate.mesh.frames import apply
from threadstate.mesh.solid import Floats, Solid
from threadstate.thread.profile import Profile

MAX_RUNS = 256


class EdgeCurve:
    """The edge curve of a part with that profile; its corners are those of the part's mesh.

    Places on it are numbered in sides from the first corner on, modulo their number ``sides``. ``sigma`` is +1 for the
    nut, -1 for the bolt. Lengths are in the pair's unit.
    """

    def __init__(self, part: Solid, profile: Profile, sigma: float) -> None:
        self._points = part.vertices[part.edge]
        self._profile, self._sigma = profile.packed, sigma
        azimuths = np.unwrap(np.arctan2(self._points[:, 1], self._points[:, 0]))
        self._azimuths = np.append(azimuths, azimuths[0] + 2.0 * math.pi)
        self.sides = len(self._points)
        self.longest_side = float(np.linalg.norm(np.roll(self._points, -1, axis=0) - self._points, axis=1).max())
        self._depths = np.empty((self.sides, 2))
        self._runs = np.empty((MAX_RUNS, 2))

    def runs_inside(self, other: EdgeCurve, T_other_own: Floats) -> Floats:
        """Starts and ends of the runs inside the other curve's solid, shape (k, 2)."""
        kernel.depths(self._points, T_other_own, other._profile, other._sigma, self._depths)
        count = kernel.runs(self._depths, self._runs)
        return self._runs[:count].copy()

    def azimuth(self, place: float) -> float:
        """The azimuth (rad) of a place."""
        return float(np.interp(place % self.sides, np.arange(self.sides + 1), self._azimuths))

    def point(self, place: float) -> Floats:
        """The point of the true edge curve there, (3,)."""
        x, y, _, _ = edge_point(self.azimuth(place), self._profile)
        return np.array([x, y, 0.0])

    def points(self, run: Floats) -> Floats:
        """Points of the true edge curve along a run, its ends and about one a side, (k, 3)."""
        places = np.linspace(run[0], run[1], 2 + int(run[1] - run[0]))
        return np.array([self.point(float(place)) for place in places])

    def tangent(self, place: float) -> Floats:
        """The unit tangent there."""
        _, _, dx, dy = edge_point(self.azimuth(place), self._profile)
        return np.array([dx, dy, 0.0]) / math.hypot(dx, dy)

    def thread_depth(self, point: Floats) -> float:
        """How far a point of this part's frame is inside its thread, to first order."""
        x, y, z = point.tolist()
        phi, *gradient = phi_and_gradient(x, y, z, self._profile, self._sigma)
        return float(phi / np.linalg.norm(gradient))

    def thread_normal(self, point: Floats) -> Floats:
        """The outward unit normal of the thread at a point of this part's frame."""
        x, y, z = point.tolist()
        _, *gradient = phi_and_gradient(x, y, z, self._profile, -self._sigma)
        return np.array(gradient) / float(np.linalg.norm(gradient))

    @property
    def cut_normal(self) -> Floats:
        """The outward unit normal of the cut end."""
        return np.array([0.0, 0.0, self._sigma])

    def near(self, one: Floats, others: Floats, sides: float) -> bool:
        """Whether a run is no farther than that many sides from any of the others."""
        if len(others) == 0:
            return False
        half = 0.5 * (one[1] - one[0])
        apart = (others.mean(axis=1) - one.mean() + 0.5 * self.sides) % self.sides - 0.5 * self.sides
        return bool((np.abs(apart) <= half + 0.5 * (others[:, 1] - others[:, 0]) + sides).any())


def distance(one: EdgeCurve, run: Floats, other: EdgeCurve, other_run: Floats, T_other_own: Floats) -> float:
    """The distance of two runs, by points a side apart."""
    here, there = apply(T_other_own, one.points(run)), other.points(other_run)
    return float(np.linalg.norm(here[:, None] - there[None], axis=2).min())
