"""Fits: the diameters of a bolt and of its nut."""

from __future__ import annotations

import math
from dataclasses import dataclass

from threadstate.errors import ImpossibleThreadError


@dataclass(frozen=True)
class Fit:
    """A fit by its six diameters, in the pair's unit; each of the bolt's is at most the nut's.

    Raises:
        ImpossibleThreadError: a diameter is not a positive number, or the bolt is larger than the nut.
    """

    name: str
    bolt_major_diameter: float
    bolt_pitch_diameter: float
    bolt_minor_diameter: float
    nut_major_diameter: float
    nut_pitch_diameter: float
    nut_minor_diameter: float

    def __post_init__(self) -> None:
        for which in ("major", "pitch", "minor"):
            bolt = getattr(self, f"bolt_{which}_diameter")
            nut = getattr(self, f"nut_{which}_diameter")
            for name, value in ((f"bolt_{which}_diameter", bolt), (f"nut_{which}_diameter", nut)):
                if not (math.isfinite(value) and value > 0.0):
                    raise ImpossibleThreadError(name, value, "a finite length > 0")
            if bolt > nut:
                raise ImpossibleThreadError(f"bolt_{which}_diameter", bolt, f"at most the nut's, {nut!r}")
