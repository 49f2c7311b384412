"""Which way a thread winds."""

from __future__ import annotations

from enum import StrEnum


class Hand(StrEnum):
    """A right-hand bolt goes into its nut as it is turned clockwise, seen from its head; a left-hand one does not."""

    RIGHT = "right"
    LEFT = "left"


MOST_STARTS = 4
"""Largest number of ridges side by side that is taken."""
