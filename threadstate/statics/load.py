"""A load on the bolt: a force, and a moment about a point (forces, section 1)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from threadstate.errors import InvalidValueError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Load:
    """A wrench on the bolt, in the nut's frame: force in N, moment in N times the pair's length unit.

    ``point`` is the one about which the moment is given, a length in the pair's unit; None: the bolt's origin. The
    default is a push of 1 N along -z through the bolt's origin.

    Raises:
        InvalidValueError: a vector is not three finite numbers, or both force and moment are zero.
    """

    force: Vector = (0.0, 0.0, -1.0)
    moment: Vector = (0.0, 0.0, 0.0)
    point: Vector | None = None

    def __post_init__(self) -> None:
        for name in ("force", "moment", "point"):
            value = getattr(self, name)
            if value is None and name == "point":
                continue
            if len(value) != 3 or not all(math.isfinite(number) for number in value):
                raise InvalidValueError(name, value, "three finite numbers")
        if not any(self.force) and not any(self.moment):
            raise InvalidValueError("force", self.force, "a force or a moment that is not zero")

    def about(self, origin: Vector) -> NDArray[np.float64]:
        """The wrench (moment, force) about a point of the nut's frame: six numbers."""
        import numpy as np

        arm = np.subtract(self.point or origin, origin)
        return np.array([*(np.array(self.moment) + np.cross(arm, self.force)), *self.force])
