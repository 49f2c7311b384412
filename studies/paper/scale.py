"""How much is computed."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Scale:
    """The grid of poses and the sample beside it.

    ``tilts_deg`` are the values of roll and of pitch, symmetric, 0 and 4 among them; ``phase_step_deg`` is a whole
    number of degrees that divides 360; ``sampled`` poses are drawn off the grid.
    """

    tilts_deg: tuple[int, ...]
    phase_step_deg: int
    sampled: int

    @property
    def phases_deg(self) -> range:
        """The phases of a revolution."""
        return range(0, 360, self.phase_step_deg)


FULL = Scale(tilts_deg=tuple(range(-4, 5)), phase_step_deg=1, sampled=20_000)
"""The paper's 81 orientations at every degree of phase."""
