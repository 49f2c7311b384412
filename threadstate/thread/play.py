"""The play of a bolt in phase: how far it can shift along the axis, how far its crest and root are from the nut."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

from threadstate.thread.pair import Pair
from threadstate.thread.profile import Profile

STEPS = 200
"""Bisections and halvings: more than a double has bits."""


@dataclass(frozen=True, slots=True)
class Play:
    """The play of a bolt in phase whose axis is the nut's; lengths in the pair's unit.

    Attributes:
        crest, root: radially, between the bolt's crest or root and the nut.
        axial: along the axis, either way; below 0 where the solids overlap. None where no radius is in both profiles,
            so that the bolt goes through the nut.
        radius: at which the flanks are that near to each other.
    """

    crest: float
    root: float
    axial: float | None
    radius: float | None


def play_of(pair: Pair) -> Play:
    """The play of a pair."""
    bolt, nut = pair.bolt, pair.nut
    crest = (nut.major_diameter - bolt.major_diameter) / 2.0
    root = (nut.minor_diameter - bolt.minor_diameter) / 2.0
    if bolt.major_diameter < nut.minor_diameter:
        return Play(crest, root, None, None)
    return Play(crest, root, *narrowest_gap(pair))


def axial_play(pair: Pair) -> float:
    """The largest shift of the bolt's profile along the axis, either way from in phase, that leaves it in the nut's.

    In the pair's unit.
    """
    return narrowest_gap(pair)[0]


@lru_cache(maxsize=256)
def narrowest_gap(pair: Pair) -> tuple[float, float]:
    """The axial play, and the radius at which the flanks of a bolt in phase are that near to the nut's.

    It is the least axial distance u_bolt(r) - u_nut(r) of the rising halves over the radii that both have: at an end of
    that range, at a boundary of regions, or where the slopes agree. Between boundaries each profile is straight or an
    arc, so that the difference has at most one place of equal slopes there, found by bisection. Both in the pair's
    unit; of several radii, the least.
    """
    bolt, nut = pair.bolt, pair.nut
    low, high = max(bolt.minor_diameter, nut.minor_diameter) / 2.0, min(bolt.major_diameter, nut.major_diameter) / 2.0
    inner = [profile.radius(s) for profile in (bolt, nut) for s in profile.boundaries]
    marks = sorted({low, high, *(r for r in inner if low < r < high)})
    candidates = [*marks, *(_equal_slopes(bolt, nut, left, right) for left, right in pairwise(marks))]
    return min((bolt.inverse(r) - nut.inverse(r), r) for r in candidates)


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
