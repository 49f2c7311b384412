"""Motions in regressing steps: how far a part goes until something is found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

Found = TypeVar("Found")
Find = Callable[[float], Found | None]
"""What is found at a place of the motion; None where nothing is."""


@dataclass(frozen=True)
class Reached(Generic[Found]):
    """The first place at which something was found, and what."""

    place: float
    found: Found


def decades(first: float, final: float) -> list[float]:
    """Steps from ``first`` down to ``final``, each a tenth of the one before; the last is ``final`` itself."""
    steps = [first]
    while steps[-1] > 10.5 * final:
        steps.append(steps[-1] / 10.0)
    if steps[-1] > 1.05 * final:
        steps.append(final)
    return steps


def regress(find: Find[Found], steps: list[float], limit: float) -> Reached[Found] | None:
    """Go by the first step until something is found, back by one step, on by the next one, and so on.

    It ends at the last thing found, or with None where ``limit`` is reached by the first step.
    """
    reached: Reached[Found] | None = None
    place = 0.0
    for step in steps:
        while place < limit:
            after = min(place + step, limit)
            found = find(after)
            if found is not None:
                reached = Reached(after, found)
                break
            place = after
    return reached


def march_and_halve(find: Find[Found], step: float, final: float, limit: float) -> Reached[Found] | None:
    """Go by ``step`` until something is found, then halve that step down to ``final``; None where ``limit`` is reached.

    ``find`` is asked in such an order that of two places at which nothing was found the farther comes later.
    """
    reached = regress(find, [step], limit)
    if reached is None:
        return None
    free = max(0.0, reached.place - step)
    while reached.place - free > final:
        middle = 0.5 * (free + reached.place)
        found = find(middle)
        if found is None:
            free = middle
        else:
            reached = Reached(middle, found)
    return reached


def approach(
    find: Find[Found], distance: Callable[[float], float], final: float, limit: float, most: int
) -> Reached[Found] | None:
    """Go on by no more than the parts are apart, and by ``final`` where that is more; None where ``limit`` is reached.

    Nothing thicker than ``final`` is passed: no point moves farther than the place changes. Raises ``TimeoutError``
    after ``most`` steps.
    """
    place = 0.0
    for _ in range(most):
        apart = distance(place)
        if apart > final:
            place += apart
        else:
            place += final
            found = find(place)
            if found is not None:
                return Reached(place, found)
        if place >= limit:
            return None
    raise TimeoutError(most)
