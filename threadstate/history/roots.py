"""Where a number along a line changes its sign, by few samples."""

from __future__ import annotations

from collections.abc import Callable

AVERAGE_SHARE = 0.2
"""The truncation of the ITP method, as a share of the first bracket's width over its square."""

SLACK = 1
"""How many samples more than bisection takes it may take at most."""

HALF = 0.49
"""Of the width, less than a half: so that round-off takes no further sample."""


def narrowed_root(
    value: Callable[[float], float], low: float, high: float, at_low: float, at_high: float, width: float
) -> tuple[float, float]:
    """A bracket at most ``width`` wide in which a number changes its sign, between two places where it is not the same.

    The ITP method: secants, truncated and projected so that no more samples are taken than by bisection, but for one
    (Oliveira and Takahashi, An enhancement of the bisection method average performance preserving minmax optimality,
    ACM Transactions on Mathematical Software 47, 2020). A zero counts as having the high end's sign.
    """
    rises = at_low < at_high
    first = high - low
    halvings = 0
    while first * 0.5**halvings > width:
        halvings += 1
    reach = HALF * width * 2.0 ** (halvings + SLACK)
    while high - low > width:
        middle = 0.5 * (low + high)
        secant = low - at_low * (high - low) / (at_high - at_low)
        toward = 1.0 if secant < middle else -1.0
        truncation = AVERAGE_SHARE / first * (high - low) ** 2
        place = secant + toward * truncation if truncation <= abs(middle - secant) else middle
        radius = max(reach - 0.5 * (high - low), 0.0)
        reach *= 0.5
        if abs(place - middle) > radius:
            place = middle - toward * radius
        if not low < place < high:
            place = middle
        at_place = value(place)
        if (at_place < 0.0) if rises else (at_place > 0.0):
            low, at_low = place, at_place
        else:
            high, at_high = place, at_place
    return low, high
