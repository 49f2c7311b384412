"""What a bolt can do at a friction, quasi-statically (forces, section 3)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum


class Verdict(StrEnum):
    """What the bolt can do at a friction, quasi-statically."""

    MOVES = "moves"
    """No contact forces balance the load."""
    CAN_STAY = "can_stay"
    """Some do; other motions may be consistent as well."""
    CAN_WEDGE = "can_wedge"
    """Some do, and contacts can balance each other without any load."""
    UNDECIDED = "undecided"
    """The friction lies within the bounds of a least friction."""


@dataclass(frozen=True, slots=True)
class FrictionBounds:
    """A least friction lies within these bounds; both infinite where no friction does it.

    Where nothing was found and nothing proved they are zero and infinity.
    """

    lower: float
    upper: float

    @property
    def value(self) -> float | None:
        """The least friction, from above; None where no friction does it or none was found."""
        return self.upper if self.upper < math.inf else None


def verdict_at(mu: float, hold: FrictionBounds, wedge: FrictionBounds) -> Verdict:
    """What the bolt can do at a friction, by the least one that holds it and the least one that wedges."""
    if mu < hold.lower:
        return Verdict.MOVES
    if mu < hold.upper:
        return Verdict.UNDECIDED
    if mu < wedge.lower:
        return Verdict.CAN_STAY
    return Verdict.CAN_WEDGE if mu >= wedge.upper else Verdict.UNDECIDED
