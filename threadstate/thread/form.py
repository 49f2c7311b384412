"""Thread forms: the shape of a profile in units of its pitch."""

from __future__ import annotations

import math
from dataclasses import dataclass

from threadstate.errors import ImpossibleThreadError


def check_flanks(half_angle_deg: float, negative_deg: float | None) -> None:
    """Check the half-angle of both flanks, or of the positive one and of the negative one where that differs.

    Raises:
        ImpossibleThreadError: an angle outside (0, 90) deg, or a negative flank that does not differ.
    """
    for name, angle in (("flank_half_angle_deg", half_angle_deg), ("flank_half_angle_neg_deg", negative_deg)):
        if angle is not None and not 0.0 < angle < 90.0:
            raise ImpossibleThreadError(name, angle, "0 < angle < 90 deg")
    if negative_deg == half_angle_deg:
        raise ImpossibleThreadError("flank_half_angle_neg_deg", negative_deg, "another angle, or none")


def flank_half_angles(half_angle_deg: float, negative_deg: float | None) -> tuple[float, float]:
    """The half-angles (rad) of the positive flank and of the negative one, which is the same where none is given."""
    return math.radians(half_angle_deg), math.radians(half_angle_deg if negative_deg is None else negative_deg)


@dataclass(frozen=True)
class Form:
    """A form: flank half-angle, and the four fillet radii as multiples of the thread pitch.

    ``flank_half_angle_neg_deg`` is that of the negative flank where it differs (method, section 3).

    Raises:
        ImpossibleThreadError: an angle outside (0, 90) deg or a ratio that is not a number >= 0.
    """

    name: str
    flank_half_angle_deg: float
    bolt_root_fillet: float
    bolt_crest_fillet: float
    nut_root_fillet: float
    nut_crest_fillet: float
    flank_half_angle_neg_deg: float | None = None

    def __post_init__(self) -> None:
        check_flanks(self.flank_half_angle_deg, self.flank_half_angle_neg_deg)
        for name in ("bolt_root_fillet", "bolt_crest_fillet", "nut_root_fillet", "nut_crest_fillet"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0.0):
                raise ImpossibleThreadError(name, value, "a finite ratio >= 0")
