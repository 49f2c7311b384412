"""What a loaded bolt can do."""

from __future__ import annotations

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
