"""A load on the bolt: a force, and a moment about a point; and the friction (forces, section 1)."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from threadstate.errors import InvalidValueError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Vector = tuple[float, float, float]

DEFAULT_FRICTION = 0.2
LARGEST_NUMBER = 1e12
"""Of a load: what is larger overflows where forces are squared and multiplied."""
LEAST_LOAD = 1e-12
"""The largest number of a force or a moment that is not zero: what is smaller underflows there."""


@dataclass(frozen=True, slots=True)
class Load:
    """A wrench on the bolt, in the nut's frame: force in N, moment in N times the pair's length unit.

    ``point`` is the one about which the moment is given, a length in the pair's unit; None: the bolt's origin. The
    default is a push of 1 N along -z through the bolt's origin.

    Raises:
        InvalidValueError: a vector is not three finite numbers up to ``LARGEST_NUMBER``, or both force and moment are
            zero.
    """

    force: Vector = (0.0, 0.0, -1.0)
    moment: Vector = (0.0, 0.0, 0.0)
    point: Vector | None = None

    def __post_init__(self) -> None:
        for name in ("force", "moment", "point"):
            value = getattr(self, name)
            if value is None and name == "point":
                continue
            if len(value) != 3 or not all(abs(number) <= LARGEST_NUMBER for number in value):
                raise InvalidValueError(
                    name, value, f"three finite numbers from -{LARGEST_NUMBER!r} to {LARGEST_NUMBER!r}"
                )
        if max(map(abs, (*self.force, *self.moment))) < LEAST_LOAD:
            valid = f"a force or a moment that is not zero: of at least {LEAST_LOAD!r}"
            raise InvalidValueError("force", self.force, valid)

    def about(self, origin: Vector) -> NDArray[np.float64]:
        """The wrench (moment, force) about a point of the nut's frame: six numbers."""
        import numpy as np

        arm = np.subtract(self.point or origin, origin)
        return np.array([*(np.array(self.moment) + np.cross(arm, self.force)), *self.force])

    def with_lengths_over(self, factor: float) -> Load:
        """The same load with its lengths over a factor, as from another unit to the pair's."""
        point = None if self.point is None else _over(self.point, factor)
        return replace(self, moment=_over(self.moment, factor), point=point)


def checked_friction(mu: float) -> None:
    """Check a coefficient of friction.

    Raises:
        InvalidValueError: it is negative or not finite.
    """
    if not 0.0 <= mu < math.inf:
        raise InvalidValueError("mu", mu, "a finite number >= 0")


def _over(lengths: Vector, factor: float) -> Vector:
    x, y, z = lengths
    return x / factor, y / factor, z / factor
