"""Wrenches, twists, and the maps from contact forces to wrenches (docs/forces.md, sections 1 and 2)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

UNIT_TOLERANCE = 1e-6
"""Of a normal's length; it is scaled to length 1 afterwards."""


def _vector(values: ArrayLike) -> Floats:
    vector = np.array(values, dtype=float)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise ValueError(f"not three finite numbers: {values!r}")
    vector.flags.writeable = False
    return vector


@dataclass(frozen=True, eq=False)
class Twist:
    """Velocity of the bolt: ``angular`` (1/s), ``linear`` (length/s) of the body's point at ``point``; each (3,)."""

    angular: Floats
    linear: Floats
    point: Floats

    def at(self, points: Floats) -> Floats:
        """Velocities of the body's points, shape (k, 3)."""
        return np.asarray(self.linear + np.cross(self.angular, points - self.point))


@dataclass(frozen=True, eq=False)
class Wrench:
    """A load on the bolt: ``force`` (N), ``moment`` (N length) about ``point``; each (3,), in the contacts' frame."""

    force: Floats
    moment: Floats
    point: Floats

    @classmethod
    def of(cls, force: ArrayLike, moment: ArrayLike = (0.0, 0.0, 0.0), point: ArrayLike = (0.0, 0.0, 0.0)) -> Wrench:
        """The wrench from anything that makes arrays; ``ValueError`` where it is zero or not finite."""
        wrench = cls(_vector(force), _vector(moment), _vector(point))
        if not (wrench.force.any() or wrench.moment.any()):
            raise ValueError("the load is zero")
        return wrench

    def about(self, point: ArrayLike) -> Wrench:
        """The same wrench with its moment about another point: ``m_q = m_p + (p - q) x f``."""
        other = _vector(point)
        return Wrench(self.force, np.asarray(self.moment + np.cross(self.point - other, self.force)), other)

    def power(self, twist: Twist) -> float:
        """Of the wrench on a moving bolt."""
        return float(self.force @ twist.at(self.point[None, :])[0] + self.moment @ twist.angular)

    def power_scale(self, twist: Twist) -> float:
        """The sum of the sizes of what ``power`` adds: round-off is measured by it."""
        return float(
            np.linalg.norm(self.force)
            * (np.linalg.norm(twist.linear) + np.linalg.norm(twist.angular) * np.linalg.norm(self.point - twist.point))
            + np.linalg.norm(self.moment) * np.linalg.norm(twist.angular)
        )


@dataclass(frozen=True, eq=False)
class Contacts:
    """Points and unit normals (k, 3), with the point and the length by which moments become comparable with forces."""

    points: Floats
    normals: Floats
    reference: Floats
    length: float

    @classmethod
    def of(
        cls, points: ArrayLike, normals: ArrayLike, length: float | None = None, reference: ArrayLike | None = None
    ) -> Contacts:
        """Checked contacts; by default about their centroid, with their root mean square distance from it."""
        places, directions = np.array(points, dtype=float), np.array(normals, dtype=float)
        if places.ndim != 2 or places.shape[1] != 3 or places.shape != directions.shape or len(places) == 0:
            raise ValueError(f"points and normals must be (k, 3) with k > 0: {places.shape}, {directions.shape}")
        sizes = np.linalg.norm(directions, axis=1)
        if not (np.isfinite(places).all() and np.all(np.abs(sizes - 1.0) <= UNIT_TOLERANCE)):
            raise ValueError("points must be finite and normals of unit length")
        centre = places.mean(axis=0) if reference is None else _vector(reference)
        if length is None:
            length = float(np.sqrt(((places - centre) ** 2).sum(axis=1).mean())) or 1.0
        if not (np.isfinite(length) and length > 0.0):
            raise ValueError(f"the length must be positive: {length}")
        return cls(places, directions / sizes[:, None], centre, float(length))

    @cached_property
    def axes(self) -> Floats:
        """Normal and two tangents of each contact as columns, shape (k, 3, 3); the tangents' turn is arbitrary."""
        helper = np.eye(3)[np.argmin(np.abs(self.normals), axis=1)]
        first = np.cross(self.normals, helper)
        first /= np.linalg.norm(first, axis=1)[:, None]
        return np.stack([self.normals, first, np.cross(self.normals, first)], axis=2)

    @cached_property
    def maps(self) -> Floats:
        """From (normal, first, second tangential force) of each contact to (moment / length, force), (k, 6, 3).

        The transpose takes a scaled twist (angular * length, linear) to the same components of the point's velocity.
        """
        arms = (self.points - self.reference) / self.length
        moments = np.cross(arms[:, :, None], self.axes, axis=1)
        return np.concatenate([moments, self.axes], axis=1)

    def coordinates(self, load: Wrench) -> Floats:
        """(moment / length, force) of a wrench, shape (6,)."""
        moved = load.about(self.reference)
        return np.concatenate([moved.moment / self.length, moved.force])

    def twist(self, scaled: Floats) -> Twist:
        """The twist of coordinates (angular * length, linear)."""
        return Twist(scaled[:3] / self.length, scaled[3:].copy(), self.reference)

    def vectors(self, forces: Floats) -> Floats:
        """Forces in the frame from components along ``axes``; both (k, 3)."""
        return np.asarray(np.einsum("kac,kc->ka", self.axes, forces))
