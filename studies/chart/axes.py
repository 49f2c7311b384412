"""A pair of logarithmic axes in a rectangle of a drawing."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Axes:
    """Left, top, width and height in the drawing's units; the data's ranges, both positive."""

    left: float
    top: float
    width: float
    height: float
    x_range: tuple[float, float]
    y_range: tuple[float, float]

    def x(self, value: float) -> float:
        """Where a value is across; outside the range, at its end."""
        return self.left + self.width * _share(value, self.x_range)

    def y(self, value: float) -> float:
        """Where a value is, large ones above; outside the range, at its end."""
        return self.top + self.height * (1.0 - _share(value, self.y_range))


def _share(value: float, ends: tuple[float, float]) -> float:
    low, high = (math.log10(end) for end in ends)
    return min(1.0, max(0.0, (math.log10(value) - low) / (high - low)))


def decades(ends: tuple[float, float], every: int) -> list[int]:
    """The exponents of the powers of ten within a range that are multiples of ``every``."""
    low, high = (math.log10(end) for end in ends)
    return [k for k in range(math.ceil(low - 1e-9), math.floor(high + 1e-9) + 1) if k % every == 0]


def range_about(values: list[float], margin: float) -> tuple[float, float]:
    """From the least value to the largest, and that many decades more at either end."""
    return min(values) * 10.0**-margin, max(values) * 10.0**margin


def spread_out(wanted: list[float], gap: float, low: float, high: float) -> list[float]:
    """Places near those wanted, in their order, at least ``gap`` apart and within bounds if there is room."""
    order = sorted(range(len(wanted)), key=lambda k: wanted[k])
    found = list(wanted)
    place = low
    for k in order:
        place = max(place, wanted[k])
        found[k] = place
        place += gap
    ceiling = high
    for k in reversed(order):
        found[k] = min(found[k], ceiling)
        ceiling = found[k] - gap
    return found
