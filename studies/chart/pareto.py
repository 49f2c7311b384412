"""Which of many points nothing beats in both of two costs."""

from __future__ import annotations

from collections.abc import Sequence


def front(points: Sequence[tuple[float, float]]) -> list[int]:
    """The indices of points that no other is at most equal to in both costs and less in one; by the first cost."""
    found: list[int] = []
    lowest = float("inf")
    for i in sorted(range(len(points)), key=lambda k: points[k]):
        if points[i][1] < lowest or (found and points[i] == points[found[-1]]):
            found.append(i)
            lowest = points[i][1]
    return found
