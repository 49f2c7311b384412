"""The chamfer of a bolt's base: a cone from a circle on the base plane out to the thread."""

from __future__ import annotations

import math
from dataclasses import dataclass

from threadstate.errors import ImpossibleThreadError

LEAST_ANGLE_DEG, LARGEST_ANGLE_DEG = 15.0, 75.0


@dataclass(frozen=True)
class Chamfer:
    """A cone that leaves of a bolt what is within ``end_diameter / 2 + z / tan(angle_deg)`` of its axis.

    Attributes:
        end_diameter: of the circle in which the cone meets the base plane, z = 0; in the pair's unit.
        angle_deg: between the cone and the base plane.

    Raises:
        ImpossibleThreadError: a diameter that is no positive number, or an angle that no chamfer has.
    """

    end_diameter: float
    angle_deg: float = 45.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.end_diameter) and self.end_diameter > 0.0):
            raise ImpossibleThreadError("end_diameter", self.end_diameter, "a finite length > 0")
        if not LEAST_ANGLE_DEG <= self.angle_deg <= LARGEST_ANGLE_DEG:
            valid = f"{LEAST_ANGLE_DEG:.0f} to {LARGEST_ANGLE_DEG:.0f} deg, from the base plane"
            raise ImpossibleThreadError("angle_deg", self.angle_deg, valid)

    @property
    def slope(self) -> float:
        """How fast the cone's radius grows along the axis."""
        return 1.0 / math.tan(math.radians(self.angle_deg))

    def radius(self, z: float) -> float:
        """The cone's radius at height ``z`` above the base plane, both in the pair's unit."""
        return self.end_diameter / 2.0 + z * self.slope

    def height(self, diameter: float) -> float:
        """The height at which the cone has this diameter, 0 where it is larger from the base plane on."""
        return max(0.0, (diameter - self.end_diameter) / 2.0 / self.slope)
