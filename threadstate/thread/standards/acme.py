"""Limits of general-purpose and Stub Acme threads, ASME B1.5 and B1.8, in inches.

Limits of the stub form rest on memory: its diameters are the standard's, its tolerances those of the other form.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

from threadstate.errors import InvalidValueError
from threadstate.thread.standards.limits import Diameter, Limits, rounded

TOLERANCE = {"2G": (0.006, 0.030), "3G": (0.0028, 0.014), "4G": (0.002, 0.010)}
"""Of the pitch diameter: the factors of the square roots of diameter and pitch."""
ALLOWANCE = {"2G": 0.008, "3G": 0.006, "4G": 0.004}
"""Of the pitch diameter: the factor of the square root of the middle of the diameter's range."""
RANGES_16THS = (0, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 30, 34, 38, 42, 46, 52, 60, 68, 76, 88)
"""Diameters in sixteenths of an inch between which an allowance is one, over and up to."""
CREST, LEAST_CREST = 0.05, 0.005
"""Tolerance of a screw's major and a nut's minor diameter: over the pitch, and at least."""
COARSE_THREADS = 10
CLEARANCE, FINE_CLEARANCE = 0.020, 0.010
"""Of the minor diameter of a screw and the major one of a nut: up to so many threads per inch, and above."""


class AcmeForm(StrEnum):
    """The forms by their height."""

    ACME = "Acme"
    STUB = "Stub Acme"


HEIGHT = {AcmeForm.ACME: 0.5, AcmeForm.STUB: 0.3}
"""Basic height over the pitch."""

_SIZES = (
    "1/4-16 5/16-14 3/8-12 7/16-12 1/2-10 5/8-8 3/4-6 7/8-6 1-5 1+1/8-5 1+1/4-5 1+3/8-4 1+1/2-4 1+3/4-4 2-4 2+1/4-3 "
    "2+1/2-3 2+3/4-3 3-2 3+1/2-2 4-2 4+1/2-2 5-2"
)


@dataclass(frozen=True, slots=True)
class AcmeSize:
    """A size: its name (``1/4-16``), its diameter in inches and its threads per inch."""

    name: str
    diameter: float
    threads_per_inch: int

    @property
    def thread_pitch(self) -> float:
        """The pitch in inches."""
        return 1.0 / self.threads_per_inch


def sizes() -> tuple[AcmeSize, ...]:
    """The standard sizes, the smallest first."""
    found = []
    for name in _SIZES.split():
        diameter, threads = name.split("-")
        inches = float(sum(Fraction(part) for part in diameter.split("+")))
        found.append(AcmeSize(name.replace("+", " "), inches, int(threads)))
    return tuple(found)


def screw_limits(size: AcmeSize, tolerance_class: str, form: AcmeForm = AcmeForm.ACME) -> Limits:
    """Limits of a screw.

    Raises:
        InvalidValueError: a class that the form does not have.
    """
    _checked_class(tolerance_class, form)
    pitch, height, tolerance = size.thread_pitch, HEIGHT[form], _tolerance(size, tolerance_class)
    pitch_greatest = rounded(size.diameter - height * pitch - _allowance(size, tolerance_class), 4)
    minor_greatest = rounded(size.diameter - 2.0 * height * pitch - _clearance(size), 4)
    return Limits(
        Diameter(rounded(size.diameter - _crest(size), 4), size.diameter),
        Diameter(rounded(pitch_greatest - tolerance, 4), pitch_greatest),
        Diameter(rounded(minor_greatest - 1.5 * tolerance, 4), minor_greatest),
    )


def nut_limits(size: AcmeSize, tolerance_class: str, form: AcmeForm = AcmeForm.ACME) -> Limits:
    """Limits of a nut.

    Raises:
        InvalidValueError: a class that the form does not have.
    """
    _checked_class(tolerance_class, form)
    pitch, height, clearance = size.thread_pitch, HEIGHT[form], _clearance(size)
    pitch_least = rounded(size.diameter - height * pitch, 4)
    minor_least = rounded(size.diameter - 2.0 * height * pitch, 4)
    return Limits(
        Diameter(rounded(size.diameter + clearance, 4), rounded(size.diameter + 2.0 * clearance, 4)),
        Diameter(pitch_least, rounded(pitch_least + _tolerance(size, tolerance_class), 4)),
        Diameter(minor_least, rounded(minor_least + _crest(size), 4)),
    )


def _checked_class(tolerance_class: str, form: AcmeForm) -> None:
    valid = ("2G",) if form is AcmeForm.STUB else tuple(TOLERANCE)
    if tolerance_class not in valid:
        raise InvalidValueError("tolerance class", tolerance_class, f"{', '.join(valid)} of {form}")


def _tolerance(size: AcmeSize, tolerance_class: str) -> float:
    of_diameter, of_pitch = TOLERANCE[tolerance_class]
    return rounded(of_diameter * math.sqrt(size.diameter), 5) + rounded(of_pitch * math.sqrt(size.thread_pitch), 5)


def _allowance(size: AcmeSize, tolerance_class: str) -> float:
    at = bisect_left(RANGES_16THS, 16.0 * size.diameter)
    if not 0 < at < len(RANGES_16THS):
        raise InvalidValueError("nominal diameter", size.diameter, "over 0 to 5.5 in")
    middle = (RANGES_16THS[at - 1] + RANGES_16THS[at]) / 32.0
    return rounded(ALLOWANCE[tolerance_class] * math.sqrt(middle), 4)


def _crest(size: AcmeSize) -> float:
    return max(CREST * size.thread_pitch, LEAST_CREST)


def _clearance(size: AcmeSize) -> float:
    return CLEARANCE if size.threads_per_inch <= COARSE_THREADS else FINE_CLEARANCE
