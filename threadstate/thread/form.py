"""Thread forms: the shape of a profile in units of its pitch."""

from __future__ import annotations

import math
from dataclasses import dataclass

from threadstate.errors import ImpossibleThreadError


@dataclass(frozen=True)
class Form:
    """A form: flank half-angle, and the four fillet radii as multiples of the thread pitch.

    Raises:
        ImpossibleThreadError: an angle outside (0, 90) deg or a ratio that is not a number >= 0.
    """

    name: str
    flank_half_angle_deg: float
    bolt_root_fillet: float
    bolt_crest_fillet: float
    nut_root_fillet: float
    nut_crest_fillet: float

    def __post_init__(self) -> None:
        if not 0.0 < self.flank_half_angle_deg < 90.0:
            raise ImpossibleThreadError("flank_half_angle_deg", self.flank_half_angle_deg, "0 < angle < 90 deg")
        for name in ("bolt_root_fillet", "bolt_crest_fillet", "nut_root_fillet", "nut_crest_fillet"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise ImpossibleThreadError(name, value, "a finite ratio >= 0")
