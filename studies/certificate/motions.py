"""g and phi of an edge point in balls: the definitions of docs/certificate.md, section 1, evaluated as they stand."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from flint import arb
from numpy.typing import NDArray

from studies.certificate.balls import ZERO, Taylor, constant
from studies.certificate.profiles import BallProfile, ball_profile
from threadstate.contact._geometry_kernel import M_AXIS, M_COPLANAR, M_KIND, M_OFF, M_POINT, M_SIGMA
from threadstate.thread.profile import Profile

Floats = NDArray[np.float64]
Vector = tuple[arb, arb, arb]
TaylorVector = tuple[Taylor, Taylor, Taylor]


def _sum(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _times(a: Vector, factor: arb) -> Vector:
    return a[0] * factor, a[1] * factor, a[2] * factor


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@dataclass(frozen=True, slots=True)
class Values:
    """phi, g and depth over a ball; of their second derivatives by theta the balls whose hull is meant, each alone.

    One ball for both sides of a corner would be a millionth of the largest wider than they are.
    """

    phi: Taylor
    g: Taylor
    depth: Taylor
    phi_tt: list[arb]
    g_tt: list[arb]

    def union(self, other: Values) -> Values:
        """Either of two."""
        return Values(
            self.phi.union(other.phi),
            self.g.union(other.g),
            self.depth.union(other.depth),
            self.phi_tt + other.phi_tt,
            self.g_tt + other.g_tt,
        )


@dataclass(frozen=True)
class EdgeMotion:
    """One part's edge curve that moves, and the solid of the other part; numbers of a packed motion are exact."""

    curve: BallProfile
    solid: BallProfile
    sigma: float
    is_turn: bool
    coplanar: bool
    columns: tuple[Vector, Vector]
    origin: Vector
    point: Vector
    axis: Vector

    def columns_at(self, tau: arb) -> tuple[TaylorVector, TaylorVector, TaylorVector]:
        """The directions x and y of the curve's frame and its origin, in the solid's frame, as functions of time."""
        if not self.is_turn:
            still = tuple(tuple(constant(one) for one in column) for column in self.columns)
            moved = tuple(
                Taylor(start + tau * rate, ZERO, rate, ZERO, ZERO, ZERO)
                for start, rate in zip(self.origin, self.axis, strict=True)
            )
            return still[0], still[1], moved  # type: ignore[return-value]
        arm = _sum(self.origin, _times(self.point, arb(-1)))
        x, y, o = (_turned(vector, self.axis, tau) for vector in (*self.columns, arm))
        return x, y, (o[0] + constant(self.point[0]), o[1] + constant(self.point[1]), o[2] + constant(self.point[2]))

    def over(self, theta: arb, tau: arb, *, sharp: bool = False) -> Values:
        """Balls that hold phi, g and the depth below the solid's plane, with derivatives, over a ball of both.

        ``sharp`` evaluates phi in two ways, and keeps what they have in common.
        """
        curve, sigma = self.curve, arb(self.sigma)
        # The curve's frame is turned to the middle of the ball: of a small angle sine and cosine are sharp.
        azimuth = Taylor(theta - theta.mid(), arb(1), ZERO, ZERO, ZERO, ZERO)
        along = azimuth.scaled(-curve.advance)
        radii = [along.composed(triple) for triple in curve.over(-curve.advance * theta).triples()]
        sine, cosine = azimuth.value.sin_cos()
        c, s = azimuth.composed((cosine, -sine, -cosine)), azimuth.composed((sine, cosine, -sine))
        turn = theta.mid().sin_cos()
        columns = _turned_frame(self.columns_at(tau), turn)
        still: TaylorVector | None = None
        if self.coplanar:
            # The sign of g is that of the start throughout: g stands for its value there.
            x, y, o = _turned_frame(self.columns_at(ZERO), turn)
            still = constant(x[2].value), constant(y[2].value), constant(o[2].value)

        def evaluated(r: Taylor) -> Values:
            place = Place(azimuth, r, c, s, *columns)
            z = r * (c * columns[0][2] + s * columns[1][2]) + columns[2][2]
            depth = z.scaled(-sigma)
            phis = self._phi(place.polar(), z)
            sharper = place.polar_beside_curve(z) if sharp else None
            if sharper is not None:
                again = self._phi(sharper, z)
                # With two ends of f'' each, the ends may differ: the sharper are taken alone.
                phis = [phis[0].intersection(again[0])] if len(phis) == len(again) == 1 else again
            phis = [one.scaled(sigma) for one in phis]
            g = depth if still is None else (r * (c * still[0] + s * still[1]) + still[2]).scaled(-sigma)
            phi = phis[0] if len(phis) == 1 else phis[0].union(phis[1])
            return Values(phi, g, depth, [one.tt for one in phis], [g.tt])

        # All second derivatives by theta are linear in r'': its two ends hold what is between them.
        found = evaluated(radii[0])
        for r in radii[1:]:
            found = found.union(evaluated(r))
        return found

    def _phi(self, polar: tuple[Taylor, Taylor], z: Taylor) -> list[Taylor]:
        """R - f(s), the solid's radius and azimuth of the point given; with each end of f'' where it has two."""
        radius, around = polar
        s = z - around.scaled(self.solid.advance)
        return [radius - s.composed(triple) for triple in self.solid.over(s.value).triples()]


def _turned(vector: Vector, axis: Vector, tau: arb) -> TaylorVector:
    """A vector that turns about an axis through the origin (Rodrigues), as a function of the angle."""
    parallel = _times(axis, _dot(axis, vector))
    across = _sum(vector, _times(parallel, arb(-1)))
    normal = _cross(axis, across)
    sine, cosine = tau.mid().sin_cos()
    across, normal = (
        _sum(_times(across, cosine), _times(normal, sine)),
        _sum(_times(normal, cosine), _times(across, -sine)),
    )
    sine, cosine = (tau - tau.mid()).sin_cos()
    parts = [
        Taylor(p + cosine * q + sine * n, ZERO, cosine * n - sine * q, ZERO, ZERO, -cosine * q - sine * n)
        for p, q, n in zip(parallel, across, normal, strict=True)
    ]
    return parts[0], parts[1], parts[2]


def _turned_frame(
    columns: tuple[TaylorVector, TaylorVector, TaylorVector], turn: tuple[arb, arb]
) -> tuple[TaylorVector, TaylorVector, TaylorVector]:
    """The two directions of the curve's frame turned in their plane by an angle of that sine and cosine."""
    x, y, o = columns
    sine, cosine = turn
    forward = [x[i].scaled(cosine) + y[i].scaled(sine) for i in range(3)]
    sideways = [y[i].scaled(cosine) - x[i].scaled(sine) for i in range(3)]
    return (forward[0], forward[1], forward[2]), (sideways[0], sideways[1], sideways[2]), o


@dataclass(frozen=True)
class Place:
    """An edge point: its azimuth and radius on the curve, and the curve's moving frame."""

    azimuth: Taylor
    r: Taylor
    cosine: Taylor
    sine: Taylor
    x_axis: TaylorVector
    y_axis: TaylorVector
    origin: TaylorVector

    def across(self) -> tuple[Taylor, Taylor]:
        """The coordinates x and y in the solid's frame."""
        c, s, r = self.cosine, self.sine, self.r
        x, y = (r * (c * self.x_axis[i] + s * self.y_axis[i]) + self.origin[i] for i in (0, 1))
        return x, y

    def polar(self) -> tuple[Taylor, Taylor]:
        """Radius and azimuth in the solid's frame; the azimuth is measured from near the middle of the ball."""
        x, y = self.across()
        around = math.atan2(float(y.value.mid()), float(x.value.mid()))
        sine, cosine = arb(around).sin_cos()
        forward = x.scaled(cosine) + y.scaled(sine)
        sideways = y.scaled(cosine) - x.scaled(sine)
        radius = (forward.squared() + sideways.squared()).root()
        return radius, (sideways * forward.reciprocal()).arc_tangent() + constant(arb(around))

    def polar_beside_curve(self, z: Taylor) -> tuple[Taylor, Taylor] | None:
        """The same as small changes of the curve's own radius and azimuth; None where they are not small.

        What nearly vanishes of nearly coaxial parts nearly vanishes here in balls, too. With P the direction of the
        point from the curve's origin o, radius^2 is r^2 + 2 r P.o + o^2 - z^2 and the sine of the difference of the
        azimuths is the point's component across the turned azimuth over the radius.
        """
        x, y = self.across()
        shift = math.atan2(float(y.value.mid()), float(x.value.mid()))
        a, b, c, d = self.x_axis[0], self.x_axis[1], self.y_axis[0], self.y_axis[1]
        turn = math.atan2(float((b - c).value.mid()), float((a + d).value.mid()))
        if not math.cos(shift - turn) > 0.8:
            return None
        half = arb(1) / 2
        sine, cosine = arb(turn).sin_cos()
        twice = (self.azimuth.value * 2 + arb(turn)).sin_cos()
        double = self.azimuth.scaled(arb(2))
        sine_2, cosine_2 = (
            double.composed((twice[0], twice[1], -twice[0])),
            double.composed((twice[1], -twice[0], -twice[1])),
        )
        aside = (
            (b - c).scaled(cosine * half)
            - (a + d).scaled(sine * half)
            + (b + c).scaled(half) * cosine_2
            + (d - a).scaled(half) * sine_2
        )
        once = (self.azimuth.value + arb(turn)).sin_cos()
        sine_1, cosine_1 = (
            self.azimuth.composed((once[0], once[1], -once[0])),
            self.azimuth.composed((once[1], -once[0], -once[1])),
        )
        o = self.origin
        sideways = self.r * aside + o[1] * cosine_1 - o[0] * sine_1
        inverse = self.r.reciprocal()
        x_origin, y_origin = (axis[0] * o[0] + axis[1] * o[1] + axis[2] * o[2] for axis in (self.x_axis, self.y_axis))
        along = self.cosine * x_origin + self.sine * y_origin
        far = o[0].squared() + o[1].squared() + o[2].squared() - z.squared()
        change = (along.scaled(arb(2)) + far * inverse) * inverse
        one = constant(arb(1))
        root = (one + change).root()
        radius = self.r + self.r * (change * (one + root).reciprocal())
        ratio = sideways * radius.reciprocal()
        if not ratio.value.abs_upper() < 0.8:
            return None
        return radius, ratio.arc_sine() + self.azimuth + constant(arb(turn))


def edge_motion(motion: Floats, curve: Profile, solid: Profile) -> EdgeMotion:
    """The motion of an edge curve, from the kernels' numbers.

    A rotation of doubles is one up to round-off: its first two columns are made orthonormal, as is the axis of a turn.
    """
    numbers = [arb(float(one)) for one in motion]
    axis = (numbers[M_AXIS], numbers[M_AXIS + 1], numbers[M_AXIS + 2])
    x_axis = _unit((numbers[0], numbers[3], numbers[6]))
    y_axis = (numbers[1], numbers[4], numbers[7])
    y_axis = _unit(_sum(y_axis, _times(x_axis, -_dot(x_axis, y_axis))))
    is_turn = bool(motion[M_KIND] != 0.0)
    return EdgeMotion(
        ball_profile(curve),
        ball_profile(solid),
        float(motion[M_SIGMA]),
        is_turn,
        bool(motion[M_COPLANAR] != 0.0),
        (x_axis, y_axis),
        (numbers[M_OFF], numbers[M_OFF + 1], numbers[M_OFF + 2]),
        (numbers[M_POINT], numbers[M_POINT + 1], numbers[M_POINT + 2]),
        _unit(axis) if is_turn else axis,
    )


def _dot(a: Vector, b: Vector) -> arb:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _unit(vector: Vector) -> Vector:
    return _times(vector, _dot(vector, vector).rsqrt())
