"""Vectors, poses of the bolt and its motions, in ball arithmetic."""

from __future__ import annotations

import math
from dataclasses import dataclass

from flint import arb

from studies.certificate.balls import ZERO
from studies.certificate.functions import Function, FunctionVector, variables

Vector = tuple[arb, arb, arb]
Matrix = tuple[Vector, Vector, Vector]
NOWHERE: Vector = (ZERO, ZERO, ZERO)


@dataclass(frozen=True)
class Pose:
    """Bolt to nut: ``x_nut = rotation x_bolt + origin``."""

    rotation: Matrix
    origin: Vector


def dot(a: Vector, b: Vector) -> arb:
    """The scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """The cross product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def added(a: Vector, b: Vector) -> Vector:
    """The sum of two vectors."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def scaled(a: Vector, factor: arb) -> Vector:
    """A vector times a number."""
    return a[0] * factor, a[1] * factor, a[2] * factor


def unit(a: Vector) -> Vector:
    """The vector of length 1."""
    return scaled(a, 1 / dot(a, a).sqrt())


def rotated(matrix: Matrix, vector: Vector) -> Vector:
    """The matrix times the vector."""
    return dot(matrix[0], vector), dot(matrix[1], vector), dot(matrix[2], vector)


def columns(matrix: Matrix) -> Matrix:
    """The transposed matrix."""
    x, y, z = ((matrix[0][i], matrix[1][i], matrix[2][i]) for i in range(3))
    return x, y, z


def azimuth(x: arb, y: arb) -> arb:
    """The azimuth of a point (rad), with no seam where the ball lies."""
    around = arb(math.atan2(float(y.mid()), float(x.mid())))
    sine, cosine = around.sin_cos()
    turned: arb = ((y * cosine - x * sine) / (x * cosine + y * sine)).atan() + around
    return turned


def constants(vector: Vector, like: Function) -> FunctionVector:
    """A vector that does not depend on the variables."""
    still = like.scaled(ZERO)
    return still.shifted(vector[0]), still.shifted(vector[1]), still.shifted(vector[2])


def transformed(matrix: Matrix, vector: FunctionVector) -> FunctionVector:
    """A matrix of numbers times a vector of functions."""
    x, y, z = (vector[0].scaled(a) + vector[1].scaled(b) + vector[2].scaled(c) for a, b, c in matrix)
    return x, y, z


def moved(vector: FunctionVector, by: Vector) -> FunctionVector:
    """A vector of functions plus one of numbers."""
    return vector[0].shifted(by[0]), vector[1].shifted(by[1]), vector[2].shifted(by[2])


@dataclass(frozen=True)
class Motion:
    """A motion of the bolt from a pose: a turn by ``time`` (rad) about an axis through ``point``.

    Without an axis it is the way along the nut's axis, and ``time`` is the height of the bolt's origin.
    """

    start: Pose
    point: Vector = NOWHERE
    axis: Vector | None = None

    def turned(self, arm: FunctionVector, sine: Function, cosine: Function) -> FunctionVector:
        """A vector turned about the axis (Rodrigues)."""
        assert self.axis is not None
        a, b, c = self.axis
        projected = transformed(((a * a, a * b, a * c), (a * b, b * b, b * c), (a * c, b * c, c * c)), arm)
        normal = transformed(((ZERO, -c, b), (c, ZERO, -a), (-b, a, ZERO)), arm)
        x, y, z = (projected[i] + (arm[i] - projected[i]) * cosine + normal[i] * sine for i in range(3))
        return x, y, z

    def to_nut(self, point: FunctionVector, time: Function) -> FunctionVector:
        """A point of the bolt's frame in the nut's."""
        turned = transformed(self.start.rotation, point)
        if self.axis is None:
            return turned[0], turned[1], turned[2] + time
        back = scaled(self.point, arb(-1))
        return moved(self.turned(moved(turned, added(self.start.origin, back)), *time.sine_and_cosine()), self.point)

    def to_bolt(self, point: FunctionVector, time: Function) -> FunctionVector:
        """A point of the nut's frame in the bolt's."""
        back = columns(self.start.rotation)
        if self.axis is None:
            return transformed(back, (point[0], point[1], point[2] - time))
        sine, cosine = time.sine_and_cosine()
        arm = self.turned(moved(point, scaled(self.point, arb(-1))), sine.scaled(arb(-1)), cosine)
        return transformed(back, moved(arm, added(self.point, scaled(self.start.origin, arb(-1)))))

    def pose(self, time: arb) -> Pose:
        """The pose after the motion."""
        (at,) = variables((time,))
        origin = values(self.to_nut(constants(NOWHERE, at), at))
        axes = []
        for i in range(3):
            end = (arb(int(i == 0)), arb(int(i == 1)), arb(int(i == 2)))
            axes.append(added(values(self.to_nut(constants(end, at), at)), scaled(origin, arb(-1))))
        return Pose(columns((axes[0], axes[1], axes[2])), origin)


def values(vector: FunctionVector) -> Vector:
    """The values of a vector of functions."""
    return vector[0].value, vector[1].value, vector[2].value
