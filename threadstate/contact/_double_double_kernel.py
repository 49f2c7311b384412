"""Arithmetic on unevaluated sums of two doubles, with errors of a few units of 1e-32 (Dekker 1971).

A number is ``(high, low)``, ``low`` at most half a unit in the last place of ``high``.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

from numba import types
from numba.extending import intrinsic

from threadstate._compile import kernel

Pair = tuple[float, float]

HALF_PI: Pair = (math.pi / 2.0, 6.123233995736766e-17)
WIDE_TWO_PI: Pair = (2.0 * math.pi, 2.4492935982947064e-16)


def _two_doubles(number: Fraction) -> Pair:
    high = float(number)
    return high, float(number - Fraction(high))


TERMS = 9
_SINE = [_two_doubles(Fraction((-1) ** n, math.factorial(2 * n + 1))) for n in range(TERMS)]
_VERSINE = [_two_doubles(Fraction((-1) ** n, math.factorial(2 * n + 2))) for n in range(TERMS)]
SINE_HIGH, SINE_LOW = (tuple(one[i] for one in _SINE) for i in range(2))
VERSINE_HIGH, VERSINE_LOW = (tuple(one[i] for one in _VERSINE) for i in range(2))
"""Coefficients of sin(x) / x and (1 - cos(x)) / x^2 in powers of x^2: to 1e-33 up to pi / 32."""

LEAST_TERM = 1e-33
"""Of a series: smaller powers are left out, in sums of two doubles they would not be seen."""


@kernel(forceinline=True)
def ordered_sum(a: float, b: float) -> Pair:
    """The exact sum of two doubles, ``a`` the larger one."""
    s = a + b
    return s, b - (s - a)


@kernel(forceinline=True)
def exact_sum(a: float, b: float) -> Pair:
    """The exact sum of two doubles."""
    s = a + b
    v = s - a
    return s, (a - (s - v)) + (b - v)


def _fused(_typing: Any, _a: Any, _b: Any, _c: Any) -> tuple[Any, Any]:
    """``a b + c``, rounded once: an instruction of the processor, or a function of the C library with the same bits."""

    def code(_context: Any, builder: Any, _signature: Any, numbers: tuple[Any, ...]) -> Any:
        return builder.fma(*numbers)

    return types.float64(types.float64, types.float64, types.float64), code


fused: Any = intrinsic(_fused)


@kernel(forceinline=True)
def exact_product(a: float, b: float) -> Pair:
    """The exact product of two doubles: what rounding leaves of it is a double."""
    p = a * b
    return p, fused(a, b, -p)


@kernel(forceinline=True)
def add(x: Pair, y: Pair) -> Pair:
    """The sum."""
    s, e = exact_sum(x[0], y[0])
    t, f = exact_sum(x[1], y[1])
    s, e = ordered_sum(s, e + t)
    return ordered_sum(s, e + f)


@kernel(forceinline=True)
def subtract(x: Pair, y: Pair) -> Pair:
    """The difference."""
    return add(x, (-y[0], -y[1]))


@kernel(forceinline=True)
def multiply(x: Pair, y: Pair) -> Pair:
    """The product."""
    p, e = exact_product(x[0], y[0])
    return ordered_sum(p, e + (x[0] * y[1] + x[1] * y[0]))


@kernel(forceinline=True)
def scale(x: Pair, power: float) -> Pair:
    """The product with a power of two."""
    return x[0] * power, x[1] * power


@kernel()
def divide(x: Pair, y: Pair) -> Pair:
    """The quotient."""
    first = x[0] / y[0]
    rest = subtract(x, multiply(y, (first, 0.0)))
    second = rest[0] / y[0]
    rest = subtract(rest, multiply(y, (second, 0.0)))
    return add(ordered_sum(first, second), (rest[0] / y[0], 0.0))


@kernel()
def square_root(x: Pair) -> Pair:
    """The square root; zero of what is not positive."""
    if not x[0] > 0.0:
        return 0.0, 0.0
    root = math.sqrt(x[0])
    rest = subtract(x, exact_product(root, root))
    return ordered_sum(root, rest[0] / (2.0 * root))


@kernel()
def sine_versine(x: Pair) -> tuple[Pair, Pair]:
    """The sine and 1 less the cosine of an angle (rad) of up to pi / 4 in size: series, and three times doubled."""
    y = scale(x, 0.125)
    w = multiply(y, y)
    terms, size = 1, w[0]
    while terms < TERMS and size > LEAST_TERM:
        terms, size = terms + 1, size * w[0]
    s, v = (0.0, 0.0), (0.0, 0.0)
    for i in range(terms):
        n = terms - 1 - i
        s = add(multiply(w, s), (SINE_HIGH[n], SINE_LOW[n]))
        v = add(multiply(w, v), (VERSINE_HIGH[n], VERSINE_LOW[n]))
    s, v = multiply(y, s), multiply(w, v)
    for _ in range(3):
        s, v = scale(subtract(s, multiply(s, v)), 2.0), scale(multiply(s, s), 2.0)
    return s, v


@kernel()
def sine_cosine(x: Pair) -> tuple[Pair, Pair]:
    """The sine and the cosine of an angle (rad) of a few turns at most."""
    n = float(math.floor(x[0] / HALF_PI[0] + 0.5))
    s, v = sine_versine(subtract(x, multiply((n, 0.0), HALF_PI)))
    c = subtract((1.0, 0.0), v)
    quarter = n - 4.0 * math.floor(0.25 * n)
    if quarter == 1.0 or quarter == 3.0:
        s, c = c, s
    if quarter >= 2.0:
        s = scale(s, -1.0)
    if quarter == 1.0 or quarter == 2.0:
        c = scale(c, -1.0)
    return s, c


@kernel()
def azimuth(x: Pair, y: Pair) -> Pair:
    """The azimuth of (x, y) (rad): that of doubles, and by how much it is wrong, an angle that is its own sine."""
    rough = math.atan2(y[0], x[0])
    s, c = sine_cosine((rough, 0.0))
    across = subtract(multiply(y, c), multiply(x, s))
    along = add(multiply(x, c), multiply(y, s))
    return add((rough, 0.0), (across[0] / along[0], 0.0))
