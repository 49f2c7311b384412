"""How much is measured."""

from __future__ import annotations

from dataclasses import dataclass

from threadstate.mesh.presets import Preset

TURN_LIMIT_DEG = 10.0
"""Where a turn ends without a contact, in this study.

Hardly any second and one third contact in thirty come later; on the way to 45 deg a mesh takes seconds to find nothing.
"""


@dataclass(frozen=True)
class Scale:
    """Poses that every contestant solves, that the finest mesh is compared on, and that are extrapolated; and presets.

    ``bracketings`` are numbers of boxes of azimuth that the exact search begins with, beside its own; ``chords`` the
    chord heights (thread pitches) that heights are extrapolated from.
    """

    poses: int
    compared: int
    extrapolated: int
    presets: tuple[Preset, ...]
    bracketings: tuple[int, ...]
    chords: tuple[float, ...]


FULL = Scale(
    poses=30,
    compared=100,
    extrapolated=20,
    presets=tuple(Preset),
    bracketings=(16, 64),
    chords=tuple(4e-4 * 0.66**k for k in range(8)),
)
