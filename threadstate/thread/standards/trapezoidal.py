"""Limits of ISO metric trapezoidal threads, ISO 2903 and DIN 103, in millimetres.

Tolerances of the pitch diameter follow the rule of ISO metric threads; those of several starts are wider, by factors
from memory. Deviations and tolerances of bolts are those that GOST 24739-81 prints for the same system; where the
tolerance of the minor diameter ends in a fraction it is uncertain by a micrometre.
"""

from __future__ import annotations

import math

from threadstate.errors import InvalidValueError
from threadstate.thread.standards.limits import Diameter, Limits, rounded
from threadstate.thread.standards.metric import metric_class, pitch_tolerance_um

PITCHES_MM = (1.5, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 18, 20, 22, 24, 28, 32, 36, 40, 44)


def _row(text: str) -> dict[float, int]:
    return dict(zip(PITCHES_MM, map(int, text.split()), strict=True))


DEVIATION_C_UM = _row("140 150 170 190 212 236 250 265 280 300 335 355 375 400 425 450 475 500 530 560 600 630")
DEVIATION_E_UM = _row("67 71 85 95 106 118 125 132 140 150 160 180 190 200 212 224 236 250 265 280 300 315")
MINOR_4_UM = _row("190 236 315 375 450 500 560 630 670 710 800 900 1000 1120 1180 1250 1320 1500 1600 1800 1900 2000")
CREST_4_UM = _row("150 180 236 300 335 375 425 450 500 530 600 670 710 800 850 900 950 1060 1120 1250 1320 1400")
"""The standard's tables: how far a bolt's pitch diameter lies below the basic one, tolerances of crests."""

SIZES_MM = (
    *(
        (8, 1.5),
        (9, 2),
        (10, 2),
        (11, 2),
        (12, 3),
        (14, 3),
        (16, 4),
        (18, 4),
        (20, 4),
        (22, 5),
        (24, 5),
        (26, 5),
        (28, 5),
    ),
    *((30, 6), (32, 6), (36, 6), (40, 7), (44, 7), (48, 8), (50, 8), (52, 8), (55, 9), (60, 9)),
)
"""Diameters with the pitch that is preferred for them."""

OF_STARTS = {1: 1.0, 2: 1.12, 3: 1.25, 4: 1.4}
"""Tolerance of the pitch diameter of a thread of several starts over that of one, from memory of ISO 2903."""


def crest_clearance_mm(pitch_mm: float) -> float:
    """The play ac between crest and root, on the radius."""
    if pitch_mm < 2.0:
        return 0.15
    if pitch_mm <= 5.0:
        return 0.25
    return 0.5 if pitch_mm <= 12.0 else 1.0


def bolt_limits(diameter_mm: float, pitch_mm: float, tolerance_class: str, starts: int = 1) -> Limits:
    """Limits of a bolt of grade 7, 8 or 9 in position c or e, with up to four starts.

    Raises:
        InvalidValueError: another class, or a pitch that the standard does not have.
    """
    grade, position = _checked(tolerance_class, pitch_mm, "ce")
    below = (DEVIATION_C_UM if position == "c" else DEVIATION_E_UM)[pitch_mm] / 1000.0
    tolerance = _pitch_tolerance(diameter_mm, pitch_mm, grade, starts, nut=False)
    pitch_greatest = round(diameter_mm - 0.5 * pitch_mm - below, 3)
    minor_greatest = round(diameter_mm - pitch_mm - 2.0 * crest_clearance_mm(pitch_mm), 3)
    return Limits(
        Diameter(round(diameter_mm - CREST_4_UM[pitch_mm] / 1000.0, 3), float(diameter_mm)),
        Diameter(round(pitch_greatest - tolerance, 3), pitch_greatest),
        Diameter(round(minor_greatest - minor_tolerance_mm(tolerance, below), 3), minor_greatest),
    )


def nut_limits(diameter_mm: float, pitch_mm: float, tolerance_class: str, starts: int = 1) -> Limits:
    """Limits of a nut of grade 7, 8 or 9 in position H, with up to four starts; its major diameter has no greatest one.

    Raises:
        InvalidValueError: another class, or a pitch that the standard does not have.
    """
    grade, _ = _checked(tolerance_class, pitch_mm, "H")
    pitch_least = round(diameter_mm - 0.5 * pitch_mm, 3)
    minor_least = round(diameter_mm - pitch_mm, 3)
    tolerance = _pitch_tolerance(diameter_mm, pitch_mm, grade, starts, nut=True)
    return Limits(
        Diameter(round(diameter_mm + 2.0 * crest_clearance_mm(pitch_mm), 3), None),
        Diameter(pitch_least, round(pitch_least + tolerance, 3)),
        Diameter(minor_least, round(minor_least + MINOR_4_UM[pitch_mm] / 1000.0, 3)),
    )


def minor_tolerance_mm(pitch_tolerance_mm: float, below_mm: float) -> float:
    """Of a bolt's minor diameter, in whole micrometres, halves up: 1.25 of the pitch diameter's, and its deviation."""
    return math.floor(1000.0 * (1.25 * pitch_tolerance_mm + below_mm) + 0.5 + 1e-6) / 1000.0


def _pitch_tolerance(diameter_mm: float, pitch_mm: float, grade: int, starts: int, *, nut: bool) -> float:
    """In whole micrometres."""
    return rounded(OF_STARTS[starts] * pitch_tolerance_um(diameter_mm, pitch_mm, grade, nut=nut), 0) / 1000.0


def _checked(tolerance_class: str, pitch_mm: float, positions: str) -> tuple[int, str]:
    given = metric_class(tolerance_class)
    if len(tolerance_class) != 2 or given.pitch_grade not in (7, 8, 9) or given.pitch_position not in positions:
        valid = f"grade 7, 8 or 9 in position {' or '.join(positions)}"
        raise InvalidValueError("tolerance class", tolerance_class, valid)
    if pitch_mm not in PITCHES_MM:
        raise InvalidValueError("thread pitch", pitch_mm, f"one of {', '.join(map(str, PITCHES_MM))} mm")
    return given.pitch_grade, given.pitch_position
