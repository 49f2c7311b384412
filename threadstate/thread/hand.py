"""Which way a thread winds."""

from __future__ import annotations

from enum import StrEnum


class Hand(StrEnum):
    """A right-hand bolt goes into its nut as it is turned clockwise, seen from its head; a left-hand one does not."""

    RIGHT = "right"
    LEFT = "left"
