"""How finely a solid is tessellated, and the settings that have a name."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text

SMALLEST_CHORD, LARGEST_CHORD = 2e-6, 0.02
"""Bounds of the chord height in thread pitches: about 4 million triangles a part, and about a thousand."""


@dataclass(frozen=True, slots=True)
class Tessellation:
    """Chord height and angle control, as a solid modeller's export takes them.

    ``chord_height`` is the largest distance between mesh and surface, in thread pitches: a tessellation is of the same
    quality for every pair. ``angle_control``, 0 to 1, lowers it for curves of small radius: of a curve whose radius r
    is less than r0, a tenth of the part's size (the diagonal of its box), the chord height is (r / r0)^angle_control
    times as large (PTC, *Controlling the Quality of Export*; the paper, section 4, names the setting and no rule).

    Raises:
        InvalidValueError: a value out of range.
    """

    chord_height: float
    angle_control: float

    def __post_init__(self) -> None:
        for name, low, high in (
            ("chord_height", SMALLEST_CHORD, LARGEST_CHORD),
            ("angle_control", 0.0, 1.0),
        ):
            value = getattr(self, name)
            if not (math.isfinite(value) and low <= value <= high):
                unit = " thread pitches" if name == "chord_height" else ""
                raise InvalidValueError(name, value, f"{number_text(low)} to {number_text(high)}{unit}")

    def chord_at(self, radius: float, part_size: float) -> float:
        """The chord height, in thread pitches, along a curve of that radius; both lengths in one unit."""
        return self.chord_height * min(1.0, 10.0 * radius / part_size) ** self.angle_control


class Preset(StrEnum):
    """A named tessellation."""

    COARSE = "coarse"
    PAPER = "paper"
    MEDIUM = "medium"
    FINE = "fine"
    FINEST = "finest"

    @property
    def tessellation(self) -> Tessellation:
        """Its chord height (in thread pitches) and angle control."""
        return _TESSELLATIONS[self]


_TESSELLATIONS = {
    Preset.COARSE: Tessellation(1e-2, 0.5),
    Preset.PAPER: Tessellation(2e-3, 0.5),
    Preset.MEDIUM: Tessellation(4e-4, 0.5),
    Preset.FINE: Tessellation(1e-4, 0.5),
    Preset.FINEST: Tessellation(2e-5, 0.5),
}
"""The paper's chord of 1e-4 in is 2e-3 pitches of its thread."""
