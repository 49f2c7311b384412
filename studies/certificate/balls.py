"""Functions of azimuth and time with their derivatives up to the second order, in ball arithmetic.

A ball is an interval whose operations round outward (``flint.arb``): what comes out of balls holds every value that the
numbers in them give. Nothing here knows the kernels' formulas: derivatives follow from the rules for sums, products,
quotients and compositions alone.
"""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb, ctx

ctx.prec = 96
ZERO = arb(0)
Triple = tuple[arb, arb, arb]


def square(one: arb) -> arb:
    """The square of a ball (its power of 2 is not a number where it holds 0)."""
    least, most = one.abs_lower(), one.abs_upper()
    return (least * least).union(most * most)


@dataclass(slots=True)
class Taylor:
    """A function of azimuth and time: its value, its derivatives by theta and by tau, and the three second ones."""

    value: arb
    t: arb
    u: arb
    tt: arb
    tu: arb
    uu: arb

    def __add__(self, other: Taylor) -> Taylor:
        return Taylor(
            self.value + other.value,
            self.t + other.t,
            self.u + other.u,
            self.tt + other.tt,
            self.tu + other.tu,
            self.uu + other.uu,
        )

    def __sub__(self, other: Taylor) -> Taylor:
        return self + other.scaled(arb(-1))

    def __mul__(self, other: Taylor) -> Taylor:
        a, b = self, other
        return Taylor(
            a.value * b.value,
            a.t * b.value + a.value * b.t,
            a.u * b.value + a.value * b.u,
            a.tt * b.value + 2 * (a.t * b.t) + a.value * b.tt,
            a.tu * b.value + a.t * b.u + a.u * b.t + a.value * b.tu,
            a.uu * b.value + 2 * (a.u * b.u) + a.value * b.uu,
        )

    def scaled(self, factor: arb) -> Taylor:
        """The function times a number."""
        return Taylor(
            self.value * factor,
            self.t * factor,
            self.u * factor,
            self.tt * factor,
            self.tu * factor,
            self.uu * factor,
        )

    def squared(self) -> Taylor:
        """The function's square; sharper than the product of two functions that may differ."""
        return Taylor(
            square(self.value),
            2 * (self.value * self.t),
            2 * (self.value * self.u),
            2 * (square(self.t) + self.value * self.tt),
            2 * (self.t * self.u + self.value * self.tu),
            2 * (square(self.u) + self.value * self.uu),
        )

    def composed(self, outer: Triple) -> Taylor:
        """A function of this one, of which ``outer`` holds the value and the first two derivatives."""
        value, first, second = outer
        return Taylor(
            value,
            first * self.t,
            first * self.u,
            first * self.tt + second * square(self.t),
            first * self.tu + second * (self.t * self.u),
            first * self.uu + second * square(self.u),
        )

    def root(self) -> Taylor:
        """The square root."""
        root = self.value.sqrt()
        first = 1 / (2 * root)
        return self.composed((root, first, -first / (2 * self.value)))

    def reciprocal(self) -> Taylor:
        """One over the function."""
        inverse = 1 / self.value
        return self.composed((inverse, -(inverse * inverse), 2 * inverse * inverse * inverse))

    def arc_tangent(self) -> Taylor:
        """The arc tangent."""
        first = 1 / (1 + square(self.value))
        return self.composed((self.value.atan(), first, -2 * self.value * first * first))

    def arc_sine(self) -> Taylor:
        """The arc sine of a function that stays between -1 and 1."""
        inside = 1 - square(self.value)
        first = inside.rsqrt()
        return self.composed((self.value.asin(), first, self.value * first * first * first))

    def union(self, other: Taylor) -> Taylor:
        """A function that is one or the other."""
        return Taylor(*(getattr(self, name).union(getattr(other, name)) for name in Taylor.__slots__))

    def intersection(self, other: Taylor) -> Taylor:
        """The same function, of whose values two enclosures are known."""
        return Taylor(*(both(getattr(self, name), getattr(other, name)) for name in Taylor.__slots__))


def constant(value: arb) -> Taylor:
    """A function that is the same everywhere."""
    return Taylor(value, ZERO, ZERO, ZERO, ZERO, ZERO)


def both(one: arb, other: arb) -> arb:
    """What two enclosures of one number have in common."""
    if not one.is_finite():
        return other
    return one.intersection(other) if other.is_finite() else one
