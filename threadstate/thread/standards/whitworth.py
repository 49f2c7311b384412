"""Limits of British Standard Whitworth threads, BS 84, in inches.

The tolerances are the standard's formulas; allowances of bolts rest on memory. No printed limits were found.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

from threadstate.errors import InvalidValueError
from threadstate.thread.standards.limits import Diameter, Limits, rounded

HEIGHT = 0.640327
"""Of the rounded thread over the pitch."""
LARGEST_ALLOWED, SMALLEST = 0.75, 0.25
"""Bolts up to the first diameter have an allowance, below the second that of the second."""
ALLOWANCE = 0.3
"""Of a bolt of class medium or free, over the tolerance of the effective diameter."""


class Series(StrEnum):
    """A series of diameters with their pitches."""

    BSW = "BSW"
    BSF = "BSF"


class BoltClass(StrEnum):
    """The classes of bolts."""

    CLOSE = "close"
    MEDIUM = "medium"
    FREE = "free"


class NutClass(StrEnum):
    """The classes of nuts."""

    CLOSE = "close"
    MEDIUM = "medium"
    NORMAL = "normal"


_SHARE = {"close": 2.0 / 3.0, "medium": 1.0, "free": 1.5, "normal": 1.5}
_MINOR = {BoltClass.CLOSE: 0.013, BoltClass.MEDIUM: 0.02, BoltClass.FREE: 0.02}

_SIZES = {
    Series.BSW: "1/8-40 3/16-24 1/4-20 5/16-18 3/8-16 7/16-14 1/2-12 9/16-12 5/8-11 3/4-10 7/8-9 1-8 1+1/8-7 1+1/4-7 "
    "1+1/2-6 1+3/4-5 2-4.5",
    Series.BSF: "3/16-32 7/32-28 1/4-26 9/32-26 5/16-22 3/8-20 7/16-18 1/2-16 9/16-16 5/8-14 3/4-12 7/8-11 1-10 "
    "1+1/8-9 1+1/4-9 1+3/8-8 1+1/2-8 1+3/4-7 2-7",
}


@dataclass(frozen=True, slots=True)
class WhitworthSize:
    """A size: its name (``1/4-20``), its diameter in inches and its threads per inch."""

    name: str
    diameter: float
    threads_per_inch: float
    series: Series

    @property
    def thread_pitch(self) -> float:
        """The pitch in inches."""
        return 1.0 / self.threads_per_inch


def sizes(series: Series) -> tuple[WhitworthSize, ...]:
    """The sizes of a series, the smallest first."""
    found = []
    for name in _SIZES[series].split():
        diameter, threads = name.split("-")
        inches = float(sum(Fraction(part) for part in diameter.split("+")))
        found.append(WhitworthSize(name.replace("+", " "), inches, float(threads), series))
    return tuple(found)


def effective_tolerance(size: WhitworthSize) -> float:
    """T: that of the effective diameter of a medium bolt, in inches."""
    return _tolerance(size.diameter, size.thread_pitch)


def _tolerance(diameter: float, pitch: float) -> float:
    return float(0.002 * diameter ** (1.0 / 3.0) + 0.003 * math.sqrt(diameter) + 0.005 * math.sqrt(pitch))


def allowance(size: WhitworthSize, bolt_class: BoltClass) -> float:
    """By how much all diameters of a bolt lie below the basic ones."""
    if bolt_class is BoltClass.CLOSE or size.diameter > LARGEST_ALLOWED:
        return 0.0
    if size.diameter < SMALLEST:
        return rounded(ALLOWANCE * _tolerance(SMALLEST, 1.0 / 20.0), 4)
    return rounded(ALLOWANCE * effective_tolerance(size), 4)


def bolt_limits(size: WhitworthSize, tolerance_class: str) -> Limits:
    """Limits of a bolt.

    Raises:
        InvalidValueError: a class that bolts do not have.
    """
    if tolerance_class not in tuple(BoltClass):
        raise InvalidValueError("tolerance class", tolerance_class, f"{', '.join(BoltClass)} of a bolt")
    given, pitch = BoltClass(tolerance_class), size.thread_pitch
    share, below = _SHARE[given] * effective_tolerance(size), allowance(size, given)

    def between(basic: float, tolerance: float) -> Diameter:
        greatest = rounded(basic - below, 4)
        return Diameter(rounded(greatest - rounded(tolerance, 4), 4), greatest)

    return Limits(
        between(size.diameter, share + 0.01 * math.sqrt(pitch)),
        between(size.diameter - HEIGHT * pitch, share),
        between(size.diameter - 2.0 * HEIGHT * pitch, share + _MINOR[given] * math.sqrt(pitch)),
    )


def nut_limits(size: WhitworthSize, tolerance_class: str) -> Limits:
    """Limits of a nut; its major diameter has no greatest one.

    Raises:
        InvalidValueError: a class that nuts do not have.
    """
    if tolerance_class not in tuple(NutClass):
        raise InvalidValueError("tolerance class", tolerance_class, f"{', '.join(NutClass)} of a nut")
    pitch = size.thread_pitch
    pitch_least = rounded(size.diameter - HEIGHT * pitch, 4)
    minor_least = rounded(size.diameter - 2.0 * HEIGHT * pitch, 4)
    share = _SHARE[tolerance_class] * effective_tolerance(size)
    return Limits(
        Diameter(size.diameter, None),
        Diameter(pitch_least, rounded(pitch_least + rounded(share, 4), 4)),
        Diameter(minor_least, rounded(minor_least + _nut_minor_tolerance(size), 4)),
    )


def _nut_minor_tolerance(size: WhitworthSize) -> float:
    threads = size.threads_per_inch
    added = 0.004 if threads >= 26 else 0.005 if threads >= 22 else 0.007
    return rounded(0.2 * size.thread_pitch + added, 4)
