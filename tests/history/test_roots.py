"""Brackets of roots beside functions whose roots are known."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from threadstate.history.roots import narrowed_root

WIDTH = 1e-9
FUNCTIONS: dict[str, tuple[Callable[[float], float], float]] = {
    "line": (lambda x: x - 0.3, 0.3),
    "falling": (lambda x: math.exp(-x) - 0.5, math.log(2.0)),
    "steep": (lambda x: math.tanh(1e4 * (x - 0.123456)), 0.123456),
    "flat": (lambda x: (x - 0.7) ** 7, 0.7),
    "step": (lambda x: 1.0 if x >= 0.4142135 else -1e-6, 0.4142135),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_root_is_bracketed_and_takes_no_more_samples_than_bisection_but_one(name: str) -> None:
    function, root = FUNCTIONS[name]
    sampled: list[float] = []

    def counted(x: float) -> float:
        sampled.append(x)
        return function(x)

    low, high = narrowed_root(counted, 0.0, 1.0, function(0.0), function(1.0), WIDTH)
    assert 0.0 <= low <= root + 1e-12
    assert root - 1e-12 <= high <= 1.0
    assert 0.0 < high - low <= WIDTH
    assert len(sampled) <= math.ceil(math.log2(1.0 / WIDTH)) + 1


@pytest.mark.parametrize("name", ["line", "falling"])
def test_a_smooth_root_takes_few_samples(name: str) -> None:
    function, _ = FUNCTIONS[name]
    calls = 0

    def counted(x: float) -> float:
        nonlocal calls
        calls += 1
        return function(x)

    narrowed_root(counted, 0.0, 1.0, function(0.0), function(1.0), WIDTH)
    assert calls <= 12


def test_a_zero_counts_as_the_high_side() -> None:
    function: Callable[[float], float] = lambda x: min(x - 0.25, 0.0)  # noqa: E731 - zero from 0.25 on
    low, high = narrowed_root(function, 0.0, 1.0, -0.25, 0.0, WIDTH)
    assert low < 0.25 <= high
    assert high - low <= WIDTH
