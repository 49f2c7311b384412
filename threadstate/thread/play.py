"""Axial play: how far a bolt in phase can shift along the nut's axis."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

from threadstate.thread.pair import Pair
from threadstate.thread.profile import Profile

STEPS = 200
"""Bisections and halvings: more than a double has bits."""


@lru_cache(maxsize=256)
def axial_play(pair: Pair) -> float:
    """The largest shift of the bolt's profile along the axis, either way from in phase, that leaves it in the nut's.

    It is the least axial distance u_bolt(r) - u_nut(r) of the rising halves over the radii that both have: at an end of
    that range, at a boundary of regions, or where the slopes agree. Between boundaries each profile is straight or an
    arc, so that the difference has at most one place of equal slopes there, found by bisection. In the pair's unit.
    """
    bolt, nut = pair.bolt, pair.nut
    low, high = max(bolt.minor_diameter, nut.minor_diameter) / 2.0, min(bolt.major_diameter, nut.major_diameter) / 2.0
    inner = [profile.radius(s) for profile in (bolt, nut) for s in profile.boundaries]
    marks = sorted({low, high, *(r for r in inner if low < r < high)})
    candidates = [*marks, *(_equal_slopes(bolt, nut, left, right) for left, right in pairwise(marks))]
    return min(bolt.inverse(r) - nut.inverse(r) for r in candidates)


def _equal_slopes(bolt: Profile, nut: Profile, left: float, right: float) -> float:
    """A radius in [left, right] at which the profiles' slopes agree, or an end if they nowhere do."""

    def difference(radius: float) -> float:
        return bolt.derivatives(bolt.inverse(radius))[1] - nut.derivatives(nut.inverse(radius))[1]

    inside = 1e-9 * (right - left)
    a, b = left + inside, right - inside
    if (difference(a) > 0.0) == (difference(b) > 0.0):
        return left
    rising = difference(b) > 0.0
    for _ in range(STEPS):
        middle = 0.5 * (a + b)
        if (difference(middle) > 0.0) == rising:
            b = middle
        else:
            a = middle
    return 0.5 * (a + b)
