"""Limits of 7/45 deg buttress threads, ASME B1.9, in inches.

The diameters and the tolerance of class 2 are the standard's formulas; that class 3 has two thirds of it, and the
allowance of a screw, rest on memory. A flank of 7 deg bears the load, one of 45 deg is the clearance flank.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

from threadstate.errors import InvalidValueError
from threadstate.thread.standards.limits import Diameter, Limits, rounded

LOAD_FLANK_DEG, CLEARANCE_FLANK_DEG = 7.0, 45.0
HEIGHT = 0.6
"""Basic height of engagement over the pitch."""
ROOT_BEYOND = 0.12542
"""Over the pitch, on the diameter: by how much roots lie beyond the crest of the other part at maximum material."""
ROOT_LEAST = 0.80803
"""Beyond the pitch diameter, over the pitch: the root of the least radius, half of the greatest."""
RANGES = (0.5, 0.7, 1.0, 1.5, 2.5, 4.0, 6.0, 10.0, 16.0, 24.0)
"""Diameters between which a tolerance is one, over and up to, the first one included."""
OF_DIAMETER, OF_PITCH = 0.002, 0.0173
"""Of the tolerance of class 2: the factors of the cube root of the range's middle and of the square root of the pitch.

The second is the standard's for a length of engagement of ten pitches.
"""
SHARE = {"2": 1.0, "3": 2.0 / 3.0}
"""Tolerance of a class over that of class 2."""
ALLOWANCE = "3"
"""The class whose tolerance is a screw's allowance in any class."""


class ButtressForm(StrEnum):
    """Which way a screw bears load: one that is pulled by its head, or one that is pushed."""

    PULL = "Buttress"
    PUSH = "Push buttress"


SYMBOL = {ButtressForm.PULL: "BUTT", ButtressForm.PUSH: "PUSH-BUTT"}
"""As designations have it."""

_SIZES = (
    "1/2-12,16,20 5/8-12,16,20 3/4-12,16,20 7/8-10,12,16 1-10,12,16 1+1/4-8,10,12 1+3/8-8,10,12 1+1/2-8,10,12 "
    "1+3/4-6,8,10 2-4,6,8,10 2+1/4-6,8,10 2+1/2-6,8,10 2+3/4-5,6,8 3-5,6,8 3+1/2-5,6,8 4-5,6,8 4+1/2-4,5,6 5-4,5,6 "
    "5+1/2-4,5,6 6-4,5,6"
)


@dataclass(frozen=True, slots=True)
class ButtressSize:
    """A size: its name (``1/2-16``), its diameter in inches and its threads per inch."""

    name: str
    diameter: float
    threads_per_inch: int

    @property
    def thread_pitch(self) -> float:
        """The pitch in inches."""
        return 1.0 / self.threads_per_inch


def sizes() -> tuple[ButtressSize, ...]:
    """The preferred sizes, the smallest first."""
    found = []
    for name in _SIZES.split():
        diameter, _, threads = name.partition("-")
        inches = float(sum(Fraction(part) for part in diameter.split("+")))
        found += [ButtressSize(f"{diameter.replace('+', ' ')}-{n}", inches, int(n)) for n in threads.split(",")]
    return tuple(found)


def tolerance(size: ButtressSize, grade: str) -> float:
    """That of grade 2 or 3 of a pitch diameter, a screw's major and a nut's minor diameter, in inches.

    Raises:
        InvalidValueError: a diameter for which the standard has none.
    """
    at = max(bisect_left(RANGES, size.diameter), 1)
    if not (RANGES[0] <= size.diameter and at < len(RANGES)):
        raise InvalidValueError("nominal diameter", size.diameter, f"{RANGES[0]!r} to {RANGES[-1]!r} in")
    middle = (RANGES[at - 1] + RANGES[at]) / 2.0
    of_class_2 = OF_DIAMETER * middle ** (1.0 / 3.0) + OF_PITCH * math.sqrt(size.thread_pitch)
    return rounded(SHARE[grade] * of_class_2, 4)


def screw_limits(size: ButtressSize, tolerance_class: str) -> Limits:
    """Limits of a screw of class 2A or 3A.

    Raises:
        InvalidValueError: another class.
    """
    pitch, width = size.thread_pitch, tolerance(size, _grade(tolerance_class, "A", "screw"))
    greatest = rounded(size.diameter - tolerance(size, ALLOWANCE), 4)
    pitch_greatest = rounded(greatest - HEIGHT * pitch, 4)
    pitch_least = rounded(pitch_greatest - width, 4)
    minor = Diameter(
        rounded(pitch_least - ROOT_LEAST * pitch, 4), rounded(greatest - (2.0 * HEIGHT + ROOT_BEYOND) * pitch, 4)
    )
    return Limits(Diameter(rounded(greatest - width, 4), greatest), Diameter(pitch_least, pitch_greatest), minor)


def nut_limits(size: ButtressSize, tolerance_class: str) -> Limits:
    """Limits of a nut of class 2B or 3B.

    Raises:
        InvalidValueError: another class.
    """
    pitch, width = size.thread_pitch, tolerance(size, _grade(tolerance_class, "B", "nut"))
    pitch_least = rounded(size.diameter - HEIGHT * pitch, 4)
    pitch_greatest = rounded(pitch_least + width, 4)
    minor_least = rounded(size.diameter - 2.0 * HEIGHT * pitch, 4)
    return Limits(
        Diameter(rounded(size.diameter + ROOT_BEYOND * pitch, 4), rounded(pitch_greatest + ROOT_LEAST * pitch, 4)),
        Diameter(pitch_least, pitch_greatest),
        Diameter(minor_least, rounded(minor_least + width, 4)),
    )


def _grade(tolerance_class: str, letter: str, part: str) -> str:
    grade = tolerance_class.removesuffix(letter)
    if grade not in SHARE or grade == tolerance_class:
        valid = " or ".join(f"{one}{letter}" for one in SHARE)
        raise InvalidValueError("tolerance class", tolerance_class, f"{valid} for a {part} with a buttress thread")
    return grade
