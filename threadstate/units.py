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
