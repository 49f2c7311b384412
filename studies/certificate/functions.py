"""Functions of several variables with their gradients and second derivatives, in ball arithmetic."""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb

from studies.certificate.balls import ZERO, Triple

FunctionVector = tuple["Function", "Function", "Function"]


@dataclass(frozen=True, slots=True)
class Function:
    """A function of n variables: its value, its n first derivatives and its n by n second ones."""

    value: arb
    first: tuple[arb, ...]
    second: tuple[tuple[arb, ...], ...]

    def __add__(self, other: Function) -> Function:
        return Function(
            self.value + other.value,
            tuple(a + b for a, b in zip(self.first, other.first, strict=True)),
            tuple(
                tuple(a + b for a, b in zip(row, other_row, strict=True))
                for row, other_row in zip(self.second, other.second, strict=True)
            ),
        )

    def __sub__(self, other: Function) -> Function:
        return self + other.scaled(arb(-1))

    def __mul__(self, other: Function) -> Function:
        a, b, order = self, other, range(len(self.first))
        return Function(
            a.value * b.value,
            tuple(a.first[i] * b.value + a.value * b.first[i] for i in order),
            tuple(
                tuple(
                    a.second[i][j] * b.value
                    + a.first[i] * b.first[j]
                    + a.first[j] * b.first[i]
                    + a.value * b.second[i][j]
                    for j in order
                )
                for i in order
            ),
        )

    def scaled(self, factor: arb) -> Function:
        """The function times a number."""
        return Function(
            self.value * factor,
            tuple(a * factor for a in self.first),
            tuple(tuple(a * factor for a in row) for row in self.second),
        )

    def shifted(self, constant: arb) -> Function:
        """The function plus a number."""
        return Function(self.value + constant, self.first, self.second)

    def composed(self, outer: Triple) -> Function:
        """A function of this one, of which ``outer`` holds the value and the first two derivatives."""
        value, first, second = outer
        order = range(len(self.first))
        return Function(
            value,
            tuple(first * a for a in self.first),
            tuple(
                tuple(first * self.second[i][j] + second * self.first[i] * self.first[j] for j in order) for i in order
            ),
        )

    def root(self) -> Function:
        """The square root of a function that is positive."""
        root = self.value.sqrt()
        first = 1 / (2 * root)
        return self.composed((root, first, -first / (2 * self.value)))

    def reciprocal(self) -> Function:
        """One over the function."""
        inverse = 1 / self.value
        return self.composed((inverse, -(inverse**2), 2 * inverse**3))

    def arc_tangent(self) -> Function:
        """The arc tangent."""
        first = 1 / (1 + self.value**2)
        return self.composed((self.value.atan(), first, -2 * self.value * first**2))

    def sine_and_cosine(self) -> tuple[Function, Function]:
        """The sine and the cosine."""
        sine, cosine = self.value.sin_cos()
        return self.composed((sine, cosine, -sine)), self.composed((cosine, -sine, -cosine))


def variables(values: tuple[arb, ...]) -> tuple[Function, ...]:
    """The variables themselves as functions, at the values given."""
    order = range(len(values))
    still = ((ZERO,) * len(values),) * len(values)
    return tuple(Function(values[i], tuple(arb(int(i == j)) for j in order), still) for i in order)
