"""How a hand turns a bolt: a name that the command line needs before it computes."""

from __future__ import annotations

from enum import StrEnum

CLOCKWISE_DEG = 270.0
"""How far the hand turns clockwise at the end."""


class Strategy(StrEnum):
    """How the hand turns the bolt (forces, section 5)."""

    CCW_THEN_CW = "ccw_then_cw"
    """Counter-clockwise until the snap, by default through no more than 360 deg, then clockwise through 270 deg."""
    CW = "cw"
    """Clockwise through 270 deg at once."""
