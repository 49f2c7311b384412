"""Length units and their conversion."""

from __future__ import annotations

from enum import StrEnum


class LengthUnit(StrEnum):
    """A unit of length, as stored with every library."""

    INCH = "in"
    MILLIMETRE = "mm"


MILLIMETRES_PER_INCH = 25.4


def conversion_factor(source: LengthUnit, target: LengthUnit) -> float:
    """The number that a length in ``source`` is multiplied by to be in ``target``."""
    if source is target:
        return 1.0
    return MILLIMETRES_PER_INCH if target is LengthUnit.MILLIMETRE else 1.0 / MILLIMETRES_PER_INCH


def scale_length(length: float | None, factor: float) -> float | None:
    """A length in another unit, None if there is no length; -0.0 becomes 0.0."""
    return None if length is None else length * factor + 0.0


def scale_pair(before: float | None, after: float | None, factor: float) -> tuple[float | None, float | None]:
    """The lengths before and after a change, in another unit."""
    return scale_length(before, factor), scale_length(after, factor)
