"""Lengths in the unit of an answer."""

from __future__ import annotations


def scaled(length: float | None, factor: float) -> float | None:
    """A length in another unit; -0.0 becomes 0.0."""
    return None if length is None else length * factor + 0.0


def sides(before: float | None, after: float | None, factor: float) -> tuple[float | None, float | None]:
    """A length before and after a change, in another unit."""
    return scaled(before, factor), scaled(after, factor)
