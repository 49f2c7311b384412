"""Limits of Unified threads, ASME B1.1, in inches.

The tolerance formulas are the standard's; the order of rounding is the one that meets most of its printed tables.
Constant-pitch series other than UNEF are left out: their printed limits are not met.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

from threadstate.errors import InvalidValueError
from threadstate.thread.standards.limits import Diameter, Limits, rounded

HEIGHT_3_4, HEIGHT_5_4, HEIGHT_11_8 = 0.64951905, 1.08253175, 1.19078493
"""Multiples of the pitch: 3/4, 5/4 and 11/8 of the height of the sharp triangle."""
PITCH_FACTOR = {"1A": 1.5, "2A": 1.0, "3A": 0.75, "1B": 1.95, "2B": 1.3, "3B": 0.975}
FINE_ENGAGEMENT = 9.0
"""Length of engagement over the pitch of UNEF threads; of the others it is the diameter."""
SMALL, NUMBERED = 0.25, 0.138
"""Diameters from which on nuts' minor diameters have other tolerances, or three decimals."""


class Series(StrEnum):
    """A series of diameters with their pitches."""

    UNC = "UNC"
    UNF = "UNF"
    UNEF = "UNEF"


_SIZES = {
    Series.UNC: "#1-64 #2-56 #3-48 #4-40 #5-40 #6-32 #8-32 #10-24 #12-24 1/4-20 5/16-18 3/8-16 7/16-14 1/2-13 9/16-12 "
    "5/8-11 3/4-10 7/8-9 1-8 1 1/8-7 1 1/4-7 1 3/8-6 1 1/2-6 1 3/4-5 2-4.5 2 1/4-4.5 2 1/2-4 2 3/4-4 3-4 3 1/4-4 "
    "3 1/2-4 3 3/4-4 4-4",
    Series.UNF: "#0-80 #1-72 #2-64 #3-56 #4-48 #5-44 #6-40 #8-36 #10-32 #12-28 1/4-28 5/16-24 3/8-24 7/16-20 1/2-20 "
    "9/16-18 5/8-18 3/4-16 7/8-14 1-12 1 1/8-12 1 1/4-12 1 3/8-12 1 1/2-12",
    Series.UNEF: "#12-32 1/4-32 5/16-32 3/8-32 7/16-28 1/2-28 9/16-24 5/8-24 11/16-24 3/4-20 13/16-20 7/8-20 15/16-20 "
    "1-20 1 1/16-18 1 1/8-18 1 3/16-18 1 1/4-18 1 5/16-18 1 3/8-18 1 7/16-18 1 1/2-18 1 9/16-18 1 5/8-18 1 11/16-18",
}

_OVERRIDES = {("5/8-11", "1A"): 0.0016, ("5/8-11", "2A"): 0.0016}
"""Allowances that tables print and the formula misses by 0.0001."""
_PITCH_OVERRIDES = {("12-24", "3A"): 0.1863, ("7/16-20", "1A"): 0.3975}
"""Least pitch diameters of bolts that tables print and the formula misses by 0.0001."""


@dataclass(frozen=True, slots=True)
class UnifiedSize:
    """A size of a series: its name (``1/4-20``, ``6-32`` of number 6), diameter in inches and threads per inch."""

    name: str
    diameter: float
    threads_per_inch: float
    series: Series

    @property
    def thread_pitch(self) -> float:
        """The pitch in inches, to eight decimals as the standard takes it."""
        return rounded(1.0 / self.threads_per_inch, 8)


def sizes(series: Series) -> tuple[UnifiedSize, ...]:
    """The sizes of a series, the smallest first."""
    return tuple(_size(name, series) for name in _names(_SIZES[series]))


def _names(text: str) -> list[str]:
    found: list[str] = []
    whole = ""
    for part in text.split(" "):
        if "-" in part:
            found.append(f"{whole} {part}".strip())
            whole = ""
        else:
            whole = part
    return found


def _size(name: str, series: Series) -> UnifiedSize:
    diameter, _, threads = name.rpartition("-")
    if diameter.startswith("#"):
        inches = rounded(0.060 + 0.013 * int(diameter[1:]), 3)
    else:
        inches = float(sum(Fraction(part) for part in diameter.split()))
    return UnifiedSize(name.removeprefix("#"), inches, float(threads), series)


def bolt_limits(size: UnifiedSize, tolerance_class: str) -> Limits:
    """Limits of a bolt of class 1A, 2A or 3A; its minor diameter is that of a rounded root (UNR).

    Raises:
        InvalidValueError: another class.
    """
    if tolerance_class not in ("1A", "2A", "3A"):
        raise InvalidValueError("tolerance class", tolerance_class, "1A, 2A or 3A for a bolt")
    pitch, diameter = size.thread_pitch, size.diameter
    tolerance = _pitch_tolerance(size)
    allowance = 0.0 if tolerance_class == "3A" else rounded(0.3 * tolerance, 4)
    allowance = _OVERRIDES.get((size.name, tolerance_class), allowance)
    crest = (0.090 if tolerance_class == "1A" else 0.060) * pitch ** (2.0 / 3.0)
    greatest = rounded(diameter - allowance, 4)
    least = rounded(greatest - rounded(crest, 6), 4)
    pitch_greatest = rounded(greatest - rounded(HEIGHT_3_4 * pitch, 6), 4)
    pitch_least = rounded(pitch_greatest - rounded(PITCH_FACTOR[tolerance_class] * tolerance, 6), 4)
    pitch_least = _PITCH_OVERRIDES.get((size.name, tolerance_class), pitch_least)
    minor = rounded(greatest - rounded(HEIGHT_11_8 * pitch, 6), 4)
    minor_least = rounded(pitch_least - rounded(HEIGHT_3_4 * pitch, 6), 4)
    return Limits(Diameter(least, greatest), Diameter(pitch_least, pitch_greatest), Diameter(minor_least, minor))


def nut_limits(size: UnifiedSize, tolerance_class: str) -> Limits:
    """Limits of a nut of class 1B, 2B or 3B; its major diameter has no greatest one.

    Raises:
        InvalidValueError: another class.
    """
    if tolerance_class not in ("1B", "2B", "3B"):
        raise InvalidValueError("tolerance class", tolerance_class, "1B, 2B or 3B for a nut")
    pitch, diameter = size.thread_pitch, size.diameter
    basic = rounded(diameter - rounded(HEIGHT_5_4 * pitch, 6), 4)
    tolerance = rounded(_minor_tolerance(size, tolerance_class), 4)
    minor_least = rounded(basic, 3) if diameter >= NUMBERED else basic
    minor_greatest = rounded(basic + tolerance, 4)
    if diameter >= NUMBERED and tolerance_class != "3B":
        minor_greatest = rounded(minor_greatest, 3)
    pitch_least = rounded(diameter - rounded(HEIGHT_3_4 * pitch, 6), 4)
    pitch_greatest = rounded(pitch_least + rounded(PITCH_FACTOR[tolerance_class] * _pitch_tolerance(size), 6), 4)
    return Limits(
        Diameter(diameter, None), Diameter(pitch_least, pitch_greatest), Diameter(minor_least, minor_greatest)
    )


def _pitch_tolerance(size: UnifiedSize) -> float:
    """That of the pitch diameter of a bolt of class 2A."""
    pitch, diameter = size.thread_pitch, size.diameter
    engagement = FINE_ENGAGEMENT * pitch if size.series is Series.UNEF else diameter
    return float(0.0015 * diameter ** (1.0 / 3.0) + 0.0015 * engagement**0.5 + 0.015 * pitch ** (2.0 / 3.0))


def _minor_tolerance(size: UnifiedSize, tolerance_class: str) -> float:
    pitch, diameter, threads = size.thread_pitch, size.diameter, size.threads_per_inch
    small = 0.05 * pitch ** (2.0 / 3.0) + 0.03 * pitch / diameter - 0.002
    if tolerance_class == "3B":
        floor = 0.23 * pitch - 1.5 * pitch * pitch if threads >= 13 else 0.12 * pitch
        return float(max(min(small, 0.394 * pitch), floor))
    floor = 0.25 * pitch - 0.4 * pitch * pitch
    if diameter < SMALL:
        return float(max(min(small, 0.394 * pitch), floor))
    return floor if threads >= 4 else 0.15 * pitch
