"""All common zeros of trigonometric polynomials of one to three angles, by branch and bound.

A polynomial is the array of its coefficients, shape (5, ...) with one axis an angle: of 1, cos, sin, cos 2 and sin 2.
Boxes are excluded by the value and the gradient at their middle and by a bound of the second derivatives that the
coefficients give. A zero that Newton's method finds is the only one in a box about it, by the same bound. What is
neither excluded nor in such a box is halved.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FIRST_BOXES = 8
"""Of the circle of each angle."""
MOST_BOXES = 400_000
"""Boxes that are looked at before the search is given up."""
LEAST_BOX = 1e-12
"""Half width, in radians, below which boxes are not halved: zeros there are not isolated."""
AT_ONCE = 4096
"""Boxes that are evaluated together."""
NEWTON_STEPS = 12
NEWTON_STARTS = 64
"""Boxes, spread over those that are left, from whose middles Newton's method starts after each halving."""
ZERO = 1e-13
"""A polynomial whose coefficients' sizes sum to 1 is zero where its value is smaller."""
NEAR = 4.0
"""Half widths of a box from its middle to which Newton's method is followed."""
ISOLATED = 0.9
"""Part of the radius to which the Jacobian is certainly regular."""
ROUND_OFF = 1e-14

_DEGREES = np.array([0.0, 1.0, 1.0, 2.0, 2.0])


@dataclass(frozen=True, slots=True)
class Zeros:
    """Zeros, shape (n, angles) in radians, and whether there are certainly no others."""

    angles: Floats
    complete: bool


def padded(coefficients: Floats) -> Floats:
    """A polynomial given by coefficients of 1, cos and sin alone, shape (3, ...)."""
    return np.pad(coefficients, [(0, 2)] * coefficients.ndim)


def times_cosine(coefficients: Floats, axis: int) -> Floats:
    """A polynomial with coefficients of 1, cos and sin, shape (3, ...), times the cosine of an angle."""
    one, cosine, sine = np.moveaxis(coefficients, axis, 0)
    return _widened([cosine / 2.0, one, np.zeros_like(one), cosine / 2.0, sine / 2.0], axis)


def times_sine(coefficients: Floats, axis: int) -> Floats:
    """As :func:`times_cosine`, times the sine."""
    one, cosine, sine = np.moveaxis(coefficients, axis, 0)
    return _widened([sine / 2.0, np.zeros_like(one), one, -sine / 2.0, cosine / 2.0], axis)


def _widened(along: list[Floats], axis: int) -> Floats:
    stacked = np.stack(along, axis=axis)
    return np.pad(stacked, [(0, 5 - size) for size in stacked.shape])


def common_zeros(equations: list[Floats], signs: list[Floats]) -> Zeros:
    """The common zeros of equations, but for those at which two polynomials of ``signs`` have opposite signs.

    Of these some may be among what is found. There are at least as many equations as angles. A polynomial that is zero
    everywhere leaves the search incomplete, as do zeros that are not isolated.
    """
    return _Search(equations, signs).run()


class _Search:
    def __init__(self, equations: list[Floats], signs: list[Floats]) -> None:
        polynomials = np.stack([*equations, *signs])
        self._angles = polynomials.ndim - 1
        self._equations = len(equations)
        sizes = np.abs(polynomials).reshape(len(polynomials), -1).sum(axis=1)
        self._is_regular = bool((sizes[: self._equations] > 0.0).all())
        sizes[sizes == 0.0] = 1.0
        self._polynomials = polynomials / sizes.reshape(-1, *([1] * self._angles))
        self._bends = self._second_derivatives()
        self._exponents = np.nonzero(np.abs(self._polynomials).sum(axis=0))
        self._flat = self._polynomials[:, *self._exponents]
        self._found: list[Floats] = []
        self._radii: list[float] = []

    def _second_derivatives(self) -> Floats:
        """Bounds of the second derivatives of each polynomial: shape (polynomials, angles, angles)."""
        s = self._angles
        bounds = np.empty((len(self._polynomials), s, s))
        for i in range(s):
            for j in range(s):
                weights = np.ones([1] * s)
                for axis in (i, j):
                    weights = weights * _DEGREES.reshape([-1 if m == axis else 1 for m in range(s)])
                bounds[:, i, j] = np.abs(self._polynomials * weights).reshape(len(bounds), -1).sum(axis=1)
        return bounds

    def run(self) -> Zeros:
        if not self._is_regular:
            return self._zeros(complete=False)
        half = math.pi / FIRST_BOXES
        along = -math.pi + half * (2.0 * np.arange(FIRST_BOXES) + 1.0)
        middles = np.stack(np.meshgrid(*[along] * self._angles, indexing="ij"), axis=-1).reshape(-1, self._angles)
        corners = np.stack(np.meshgrid(*[[-0.5, 0.5]] * self._angles, indexing="ij"), axis=-1)
        corners = corners.reshape(-1, self._angles)
        looked_at = 0
        while len(middles):
            looked_at += len(middles)
            if looked_at > MOST_BOXES or half < LEAST_BOX:
                return self._zeros(complete=False)
            middles = self._left(middles, half)
            middles = (middles[:, np.newaxis, :] + half * corners).reshape(-1, self._angles)
            half /= 2.0
        return self._zeros(complete=True)

    def _zeros(self, *, complete: bool) -> Zeros:
        return Zeros(np.array(self._found).reshape(-1, self._angles), complete)

    def _left(self, middles: Floats, half: float) -> Floats:
        """The boxes that may hold a zero beside those found; new zeros are sought from them."""
        left = np.concatenate([self._not_excluded(part, half) for part in _parts(middles)])
        left = left[~self._known(left, half)]
        if len(left) == 0 or not self._seek(left[:: math.ceil(len(left) / NEWTON_STARTS)], half):
            return left
        return np.asarray(left[~self._known(left, half)])

    def _not_excluded(self, middles: Floats, half: float) -> Floats:
        values, gradients = self._values(middles)
        curved = 0.5 * half * half * self._bends.sum(axis=(1, 2)) + ROUND_OFF
        spread = half * np.abs(gradients).sum(axis=2) + curved
        low, high = values - spread, values + spread
        n = self._equations
        may = ((low[:, :n] <= 0.0) & (high[:, :n] >= 0.0)).all(axis=1)
        may &= (high[:, n:] >= 0.0).all(axis=1) | (low[:, n:] <= 0.0).all(axis=1)
        middles, values, gradients = middles[may], values[may, :n], gradients[may, :n]
        # Solved for the angles, all equations together: how far a zero lies from the middle at least.
        inverse = np.linalg.pinv(gradients)
        unsolved = np.abs(np.eye(self._angles) - inverse @ gradients).sum(axis=2)
        step = np.abs(np.einsum("nij,nj->ni", inverse, values)) - np.abs(inverse) @ curved[:n] - half * unsolved
        return np.asarray(middles[(step <= half).all(axis=1)])

    def _known(self, middles: Floats, half: float) -> NDArray[np.bool_]:
        """Which boxes lie in one about a zero that is the only one there."""
        known = np.zeros(len(middles), dtype=np.bool_)
        for zero, radius in zip(self._found, self._radii, strict=True):
            known |= (np.abs(_turned(middles - zero)) + half <= radius).all(axis=1)
        return known

    def _seek(self, starts: Floats, half: float) -> bool:
        """Newton's method from all starts at once; zeros near their starts are added. Whether there were any new."""
        n = self._equations
        places = starts
        for _ in range(NEWTON_STEPS):
            values, gradients = self._values(places)
            steps = np.einsum("nij,nj->ni", np.linalg.pinv(gradients[:, :n]), values[:, :n])
            places = places - steps / np.maximum(1.0, np.abs(steps).max(axis=1))[:, np.newaxis]
            near = (np.abs(places - starts) <= NEAR * half).all(axis=1)
            places, starts = places[near], starts[near]
            if not len(places):
                return False
        values, gradients = self._values(places)
        before = len(self._found)
        for place in places[np.abs(values[:, :n]).max(axis=1) <= ZERO]:
            if not self._is_found(place):
                self._add(place)
        return len(self._found) > before

    def _is_found(self, place: Floats) -> bool:
        return any(
            np.abs(_turned(place - zero)).max() <= radius for zero, radius in zip(self._found, self._radii, strict=True)
        )

    def _add(self, zero: Floats) -> None:
        """Adds a zero with the half width of a box in which the Jacobian stays regular."""
        n = self._equations
        jacobian = self._values(zero[np.newaxis])[1][0, :n]
        if np.linalg.matrix_rank(jacobian) == self._angles:
            growth = (np.abs(np.linalg.pinv(jacobian)) @ self._bends[:n].sum(axis=2)).sum(axis=1).max()
            self._found.append(_turned(zero))
            self._radii.append(ISOLATED / float(growth))

    def _values(self, places: Floats) -> tuple[Floats, Floats]:
        """Values (n, polynomials) and gradients (n, polynomials, angles) at places (n, angles)."""
        one, zero = np.ones_like(places), np.zeros_like(places)
        cosine, sine = np.cos(places), np.sin(places)
        twice_c, twice_s = cosine * cosine - sine * sine, 2.0 * sine * cosine
        basis = np.stack([one, cosine, sine, twice_c, twice_s], axis=2)
        slope = np.stack([zero, -sine, cosine, -2.0 * twice_s, 2.0 * twice_c], axis=2)
        gradients = np.empty((len(places), len(self._flat), self._angles))
        for by in range(self._angles):
            gradients[:, :, by] = self._terms(basis, slope, by) @ self._flat.T
        return self._terms(basis, slope, -1) @ self._flat.T, gradients

    def _terms(self, basis: Floats, slope: Floats, by: int) -> Floats:
        """The values (n, terms) of the products that have a coefficient, or their derivatives by an angle."""
        found = (slope if by == 0 else basis)[:, 0, self._exponents[0]]
        for axis in range(1, self._angles):
            found = found * (slope if by == axis else basis)[:, axis, self._exponents[axis]]
        return np.asarray(found)


def _parts(middles: Floats) -> list[Floats]:
    return np.array_split(middles, math.ceil(len(middles) / AT_ONCE))


def _turned(angles: Floats) -> Floats:
    """Angles in [-pi, pi)."""
    return np.asarray((angles + math.pi) % (2.0 * math.pi) - math.pi)
