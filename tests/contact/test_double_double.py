"""Sums of two doubles beside ball arithmetic."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from flint import arb, ctx

from threadstate.contact import _double_double_kernel as dd
from threadstate.contact._double_double_kernel import Pair

UNIT = 2.0**-106
"""The round-off of a sum of two doubles."""


@pytest.fixture(autouse=True)
def precise() -> Iterator[None]:
    with ctx.workprec(250):
        yield


def ball(x: Pair) -> arb:
    return arb(x[0]) + arb(x[1])


def pairs(count: int, seed: int) -> list[Pair]:
    """Numbers of up to 10 in size, whose low halves are anything that they can be."""
    rng = np.random.default_rng([29, seed])
    return [dd.exact_sum(float(a), float(a * b)) for a, b in rng.uniform(-1.0, 1.0, (count, 2)) * [10.0, 1e-16]]


def wrong(found: Pair, exact: arb, size: arb | float = 1.0) -> float:
    """The error over a size."""
    return abs(float((ball(found) - exact) / size))


def test_constants_have_their_low_halves() -> None:
    assert wrong(dd.HALF_PI, arb.pi() / 2) < UNIT
    assert wrong(dd.WIDE_TWO_PI, 2 * arb.pi()) < 4 * UNIT
    for n in range(dd.TERMS):
        exact = 1 / arb(2 * n + 2).gamma()
        assert wrong((dd.SINE_HIGH[n], dd.SINE_LOW[n]), (-1) ** n * exact, exact) < UNIT


def test_arithmetic() -> None:
    for x, y in zip(pairs(300, 1), pairs(300, 2), strict=True):
        a, b = ball(x), ball(y)
        assert wrong(dd.add(x, y), a + b, abs(a) + abs(b)) < 4 * UNIT
        assert wrong(dd.subtract(x, y), a - b, abs(a) + abs(b)) < 4 * UNIT
        assert wrong(dd.multiply(x, y), a * b, a * b) < 8 * UNIT
        assert wrong(dd.divide(x, y), a / b, a / b) < 8 * UNIT
        if x[0] > 0.0:
            assert wrong(dd.square_root(x), a.sqrt(), a.sqrt()) < 8 * UNIT
    assert dd.square_root((-1e-40, 0.0)) == (0.0, 0.0)


def test_a_product_is_exact() -> None:
    for (x, _), (y, _) in zip(pairs(300, 3), pairs(300, 4), strict=True):
        assert ball(dd.exact_product(x, y)).overlaps(arb(x) * arb(y))


WITHOUT_THE_INSTRUCTION = """
from fractions import Fraction
import numpy as np
from threadstate.contact._double_double_kernel import exact_product

factors = np.random.default_rng(7).uniform(-1.0, 1.0, (200, 2)).tolist()
products = [exact_product(x, y) for x, y in factors]
print(sum(sum(map(Fraction, p)) == Fraction(x) * Fraction(y) for p, (x, y) in zip(products, factors)))
"""


def test_a_product_is_exact_on_a_processor_without_fused_multiply_add(tmp_path: Path) -> None:
    settings = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": "", "THREADSTATE_NUMBA_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-c", WITHOUT_THE_INSTRUCTION]
    run = subprocess.run(command, env={**os.environ, **settings}, check=True, capture_output=True, text=True)
    assert run.stdout.split() == ["200"]


def test_angles() -> None:
    for x, y in zip(pairs(300, 5), pairs(300, 6), strict=True):
        sine, cosine = dd.sine_cosine(x)
        assert wrong(sine, ball(x).sin()) < 8 * UNIT
        assert wrong(cosine, ball(x).cos()) < 8 * UNIT
        assert wrong(dd.azimuth(x, y), arb.atan2(ball(y), ball(x))) < 16 * UNIT


@pytest.mark.parametrize("size", [1e-12, 1e-6, 1e-2, 0.78])
def test_small_turns_keep_their_digits(size: float) -> None:
    sine, versine = dd.sine_versine((size, 0.0))
    half = (arb(size) / 2).sin()
    assert wrong(sine, arb(size).sin(), arb(size).sin()) < 8 * UNIT
    assert wrong(versine, 2 * half * half, 2 * half * half) < 16 * UNIT
