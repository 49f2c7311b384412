"""Limits of the diameters of a bolt's and a nut's thread."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import ROUND_HALF_EVEN, Decimal

NOISE_DIGITS = 11
"""Decimals to which a sum in floating point is taken before it is rounded, so that a tie is one."""


@dataclass(frozen=True, slots=True)
class Diameter:
    """The least and the greatest diameter that a standard allows; None where it sets no limit."""

    least: float | None
    greatest: float | None


@dataclass(frozen=True, slots=True)
class Limits:
    """The three diameters of a bolt's or a nut's thread, in the unit of its standard."""

    major: Diameter
    pitch: Diameter
    minor: Diameter


def rounded(value: float, decimals: int) -> float:
    """A number rounded half to even, as tables of inch threads have it."""
    exact = Decimal(repr(round(value, NOISE_DIGITS)))
    return float(exact.quantize(Decimal(1).scaleb(-decimals), ROUND_HALF_EVEN))
