"""The profile of a thread in balls, from its diameters, half-angles and fillet radii (method, section 1)."""

from __future__ import annotations

from dataclasses import dataclass

from flint import arb

from studies.certificate.balls import ZERO, Triple
from threadstate.thread.profile import SHARPEST, Profile

DISPLACED = 1.5e-14
"""How far along the axis, in thread pitches, a profile may be displaced by round-off where its slope is taken."""


@dataclass(frozen=True, slots=True)
class Jet:
    """Balls that hold a radius and its slope, and the two ends of what its second derivative may be.

    A ball of all second derivatives of a corner would reach beyond 0 by a millionth of the largest.
    """

    radius: arb
    slope: arb
    low: arb
    high: arb

    def union(self, other: Jet) -> Jet:
        """Either of two."""
        return Jet(
            self.radius.union(other.radius),
            self.slope.union(other.slope),
            self.low.min(other.low),
            self.high.max(other.high),
        )

    def triples(self) -> list[Triple]:
        """With each end of the second derivative in turn, or with a ball of it where they are near each other."""
        if float(self.high - self.low) <= 1e-3 * abs(float(self.low)):
            return [(self.radius, self.slope, self.low.union(self.high))]
        return [(self.radius, self.slope, self.low), (self.radius, self.slope, self.high)]


@dataclass(frozen=True)
class Half:
    """A half period of a profile: the ends of its five pieces and the numbers they are made of."""

    ends: tuple[arb, arb, arb, arb]
    small: arb
    large: arb
    pitch: arb
    small_fillet: arb
    large_fillet: arb
    cot: arb

    def piece(self, index: int, u: arb) -> Triple:
        """Radius, slope and second derivative of one of the five pieces."""
        if index == 0:
            return self.small, ZERO, ZERO
        if index == 1:
            rise, slope, second = _arc(u - self.ends[0], self.small_fillet)
            return self.small + rise, slope, second
        if index == 2:
            return self.pitch + u * self.cot, self.cot, ZERO
        if index == 3:
            rise, slope, second = _arc(self.ends[3] - u, self.large_fillet)
            return self.large - rise, slope, -second
        return self.large, ZERO, ZERO

    def over(self, u: arb) -> Jet:
        """Radius, slope and second derivative over a ball of u, whichever pieces it meets."""
        jet: Jet | None = None
        for index in range(5):
            part = _within(u, self.ends[index - 1] if index else None, self.ends[index] if index < 4 else None)
            if part is not None:
                r, d1, d2 = self.piece(index, part)
                one = Jet(r, d1, d2.lower(), d2.upper())
                jet = one if jet is None else jet.union(one)
        assert jet is not None
        return jet


def _arc(d: arb, radius: arb) -> Triple:
    """How far an arc has risen at ``d`` from its flat, its slope and its second derivative: each grows with d."""
    found: list[Triple] = []
    for end in (d.lower(), d.upper()):
        root = (radius * radius - end * end).sqrt()
        found.append((radius - root, end / root, radius * radius / (root * root * root)))
    low, high = found
    return low[0].union(high[0]), low[1].union(high[1]), low[2].union(high[2])


def _within(u: arb, low: arb | None, high: arb | None) -> arb | None:
    """The part of a ball between two ends that are balls themselves; None where there is none."""
    least, most = u.lower(), u.upper()
    if low is not None:
        least = least.max(low.lower())
    if high is not None:
        most = most.min(high.upper())
    return None if least > most else least.union(most)


@dataclass(frozen=True)
class BallProfile:
    """A thread's profile: ``f``, ``f'`` and ``f''`` over a ball of the axial coordinate."""

    rising: Half
    falling: Half
    thread_pitch: arb
    advance: arb

    def over(self, s: arb) -> Jet:
        """The three over a ball of s; slope and second derivative over one that is wider by ``DISPLACED``."""
        slopes = self.exactly(s + arb(0, DISPLACED) * self.thread_pitch)
        return Jet(self.exactly(s).radius, slopes.slope, slopes.low, slopes.high)

    def exactly(self, s: arb) -> Jet:
        """The three over a ball of s, of its parts on the rising and on the falling half together."""
        p = self.thread_pitch
        # The halves part in the middles of the flats.
        root = (self.rising.ends[0] - self.falling.ends[0]) / 2 - p / 4
        crest = (self.rising.ends[3] - self.falling.ends[3]) / 2 + p / 4
        # Whole periods are taken off, so that a narrow ball is on one or on two halves.
        s = s - p * ((s.mid() - root) / p).mid().floor()
        jet: Jet | None = None
        for shift in (-1, 0, 1):
            start = shift * p
            found = []
            rising = _within(s, start + root, start + crest)
            if rising is not None:
                found.append(self.rising.over(rising - start))
            falling = _within(s, start + crest, start + root + p)
            if falling is not None:
                one = self.falling.over(start + p / 2 - falling)
                found.append(Jet(one.radius, -one.slope, one.low, one.high))
            for one in found:
                jet = one if jet is None else jet.union(one)
        assert jet is not None
        return jet


def ball_profile(profile: Profile) -> BallProfile:
    """The profile of a thread in balls; a sharp corner has the least fillet, which stands for it in the solver."""
    negative = profile.flank_half_angle_neg_deg
    rising = profile_half(profile, _tangent(profile.flank_half_angle_deg))
    falling = rising if negative is None else profile_half(profile, _tangent(negative))
    return BallProfile(rising, falling, arb(profile.thread_pitch), arb(profile.lead) / (2 * arb.pi()))


def _tangent(half_angle_deg: float) -> arb:
    return (arb(half_angle_deg) * arb.pi() / 180).tan()


def profile_half(profile: Profile, tangent: arb) -> Half:
    """A half period of a profile with a flank of that tangent of its half-angle."""
    angle = tangent.atan()
    minor, pitch, major = (arb(d) for d in (profile.minor_diameter, profile.pitch_diameter, profile.major_diameter))
    least = SHARPEST * profile.thread_pitch
    small = arb(max(profile.minor_fillet_radius, least))
    large = arb(max(profile.major_fillet_radius, least))
    turn = (arb.pi() / 4 - angle / 2).tan()
    low, high = (minor - pitch) / 2 * tangent, (major - pitch) / 2 * tangent
    ends = (
        low - small * turn,
        low + small * turn * angle.sin(),
        high - large * turn * angle.sin(),
        high + large * turn,
    )
    return Half(ends, minor / 2, major / 2, pitch / 2, small, large, 1 / tangent)
