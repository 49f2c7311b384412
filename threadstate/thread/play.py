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
        axial: along the axis, either way from the middle; below 0 where the solids overlap. None where no radius is in
            both profiles, so that the bolt goes through the nut.
        radius: at which the negative flanks are that near to each other.
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
    return Play(crest, root, axial_play(pair), narrowest_gap(pair, falling=True)[1])


def axial_play(pair: Pair) -> float:
    """How far a bolt in phase can shift along the axis, either way from the middle, within the nut's profile.

    In the pair's unit.
    """
    return sum(axial_limits(pair)) / 2.0


def axial_limits(pair: Pair) -> tuple[float, float]:
    """How far a bolt in phase can go down and up before its positive or its negative flank meets the nut's.

    Both in the pair's unit, and equal where both flanks have one angle.
    """
    return narrowest_gap(pair, falling=False)[0], narrowest_gap(pair, falling=True)[0]


@lru_cache(maxsize=256)
def narrowest_gap(pair: Pair, *, falling: bool) -> tuple[float, float]:
    """The axial play between positive flanks or, on the ``falling`` half, negative ones, and the radius at which they
    are that near.

    It is the least axial distance u_bolt(r) - u_nut(r) of the halves over the radii that both have: at an end of
    that range, at a boundary of regions, or where the slopes agree. Between boundaries each profile is straight or an
    arc, so that the difference has at most one place of equal slopes there, found by bisection. Both in the pair's
    unit; of several radii, the least.
    """
    bolt, nut = _Half(pair.bolt, falling), _Half(pair.nut, falling)
    low = max(pair.bolt.minor_diameter, pair.nut.minor_diameter) / 2.0
    high = min(pair.bolt.major_diameter, pair.nut.major_diameter) / 2.0
    inner = [half.radius(u) for half in (bolt, nut) for u in half.boundaries]
    marks = sorted({low, high, *(r for r in inner if low < r < high)})
    candidates = [*marks, *(_equal_slopes(bolt, nut, left, right) for left, right in pairwise(marks))]
    return min((bolt.inverse(r) - nut.inverse(r), r) for r in candidates)


@dataclass(frozen=True, slots=True)
class _Half:
    """A half period of a profile by its coordinate ``u``, s or p/2 - s, in which the radius grows."""

    profile: Profile
    falling: bool

    @property
    def boundaries(self) -> tuple[float, ...]:
        return self.profile.falling_boundaries if self.falling else self.profile.boundaries

    def radius(self, u: float) -> float:
        return self.profile.radius(self._s(u))

    def slope(self, u: float) -> float:
        slope = self.profile.derivatives(self._s(u))[1]
        return -slope if self.falling else slope

    def inverse(self, r: float) -> float:
        return self.profile.falling_inverse(r) if self.falling else self.profile.inverse(r)

    def _s(self, u: float) -> float:
        return self.profile.thread_pitch / 2.0 - u if self.falling else u


def _equal_slopes(bolt: _Half, nut: _Half, left: float, right: float) -> float:
    """A radius in [left, right] at which the halves' slopes agree, or an end if they nowhere do."""

    def difference(radius: float) -> float:
        return bolt.slope(bolt.inverse(radius)) - nut.slope(nut.inverse(radius))

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
