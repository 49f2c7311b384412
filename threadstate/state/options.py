"""What a user may choose about a solve."""

from __future__ import annotations

import math
from dataclasses import dataclass

from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text

TILT_LIMIT_DEG = 10.0
"""Largest roll and pitch, either way, for which states are defined here."""


@dataclass(frozen=True, slots=True)
class SolveOptions:
    """Limits, thresholds and tolerances of a solve.

    ``turn_limit_deg`` is where a turn ends without a contact, ``quasi_stable_fraction`` the q of the method's section
    5. Tolerances are multiples of the thread pitch: contacts nearer in height (or turn times major radius) than
    ``tie_tolerance`` are simultaneous, an embedment up to ``embedment_tolerance`` counts as 0.

    Raises:
        InvalidValueError: a value out of range.
    """

    turn_limit_deg: float = 45.0
    quasi_stable_fraction: float = 0.1
    tie_tolerance: float = 2e-11
    embedment_tolerance: float = 2e-8

    def __post_init__(self) -> None:
        for name, low, high in (
            ("turn_limit_deg", 0.0, 45.0),
            ("quasi_stable_fraction", 0.0, 1.0),
            ("tie_tolerance", 1e-14, 1e-4),
            ("embedment_tolerance", 1e-14, 1e-2),
        ):
            value = getattr(self, name)
            if not (math.isfinite(value) and low <= value <= high and (value > 0.0 or low > 0.0 or name[0] == "q")):
                raise InvalidValueError(name, value, f"{number_text(low)} to {number_text(high)}")
