"""Limits of threads with a controlled root radius: UNJ (ASME B1.15) in inches, MJ (ISO 5855) in millimetres.

Major and pitch diameters are those of Unified and of ISO metric threads. The bolt's root is one arc, whose greatest and
least radius give its minor diameters; the nut's minor diameter is larger, to leave room for it.
"""

from __future__ import annotations

from dataclasses import replace

from threadstate.errors import InvalidValueError
from threadstate.thread.standards import metric, unified
from threadstate.thread.standards.limits import Diameter, Limits, rounded

NUT_MINOR = 0.97427858
"""Below the major diameter, over the pitch: a nut's minor diameter, 9/8 of the height of the sharp triangle."""
ROOT_GREATEST_RADIUS, ROOT_LEAST_RADIUS = 0.18042, 0.15011
"""Of a bolt's root, over the pitch."""
MINOR_GREATEST, MINOR_LEAST = 0.505182, 0.565803
"""Below the pitch diameter, over the pitch: a bolt's minor diameter with the greatest and the least root radius."""
LARGEST_OF_6H_MM = 5.0
"""Nuts up to this diameter have grade 6 of the minor diameter, larger ones grade 5, as it is usual."""


def unj_bolt_limits(size: unified.UnifiedSize, tolerance_class: str) -> Limits:
    """Limits of a bolt of class 3A.

    Raises:
        InvalidValueError: another class.
    """
    _checked_unj(tolerance_class, "3A", "bolt")
    limits, pitch = unified.bolt_limits(size, tolerance_class), size.thread_pitch
    return replace(
        limits,
        minor=Diameter(
            _inches(limits.pitch.least, MINOR_LEAST * pitch), _inches(limits.pitch.greatest, MINOR_GREATEST * pitch)
        ),
    )


def unj_nut_limits(size: unified.UnifiedSize, tolerance_class: str) -> Limits:
    """Limits of a nut of class 3B; the tolerance of its minor diameter was not found, so that it has no greatest one.

    Raises:
        InvalidValueError: another class.
    """
    _checked_unj(tolerance_class, "3B", "nut")
    limits = unified.nut_limits(size, tolerance_class)
    return replace(limits, minor=Diameter(_inches(size.diameter, NUT_MINOR * size.thread_pitch), None))


def mj_classes(diameter_mm: float) -> tuple[str, str]:
    """The classes of bolt and nut that are usual for a diameter."""
    return "4h6h", "4H6H" if diameter_mm <= LARGEST_OF_6H_MM else "4H5H"


def mj_bolt_limits(diameter_mm: float, pitch_mm: float, tolerance_class: str) -> Limits:
    """Limits of a bolt, with the classes of ISO metric threads.

    Raises:
        InvalidValueError: no such class of a bolt.
    """
    limits = metric.bolt_limits(diameter_mm, pitch_mm, tolerance_class)
    return replace(
        limits,
        minor=Diameter(
            _millimetres(limits.pitch.least, MINOR_LEAST * pitch_mm),
            _millimetres(limits.pitch.greatest, MINOR_GREATEST * pitch_mm),
        ),
    )


def mj_nut_limits(diameter_mm: float, pitch_mm: float, tolerance_class: str) -> Limits:
    """Limits of a nut, with the classes of ISO metric threads; its major diameter has no greatest one.

    Raises:
        InvalidValueError: no such class of a nut.
    """
    limits = metric.nut_limits(diameter_mm, pitch_mm, tolerance_class)
    given = metric.metric_class(tolerance_class)
    above = -metric.deviation_um(pitch_mm, given.pitch_position) / 1000.0
    tolerance = metric.minor_tolerance_um(pitch_mm, given.crest_grade) / 1000.0
    least = _millimetres(diameter_mm, NUT_MINOR * pitch_mm)
    return replace(limits, minor=Diameter(round(least + above, 3), round(least + above + tolerance, 3)))


def _checked_unj(tolerance_class: str, valid: str, part: str) -> None:
    if tolerance_class != valid:
        raise InvalidValueError("tolerance class", tolerance_class, f"{valid} for a {part} with a UNJ thread")


def _inches(diameter: float | None, less: float) -> float:
    return rounded(_given(diameter) - rounded(less, 6), 4)


def _millimetres(diameter: float | None, less: float) -> float:
    return round(_given(diameter) - less + 1e-12, 3)


def _given(diameter: float | None) -> float:
    if diameter is None:
        raise AssertionError("the standards of Unified and metric threads limit pitch diameters at both ends")
    return diameter
