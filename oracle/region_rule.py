"""The region of a point on a thread, by walking the profile's half period from radius to radius."""

from __future__ import annotations

import math
from dataclasses import dataclass

from threadstate.thread.pair import Pair
from threadstate.thread.regions import Region

_BY_SIZE = ("small", "small_fillet", "flank", "large_fillet", "large")


@dataclass(frozen=True)
class RegionAt:
    """The region, its margin, and the axial distance to its nearest boundary."""

    region: Region
    margin: float
    axial_distance: float


def region_at(pair: Pair, s: float, *, of_nut: bool) -> RegionAt:
    """The thread region at axial position ``s`` (method, section 3); lengths in the pair's unit."""
    fit, form, p = pair.fit, pair.form, pair.thread_pitch
    if of_nut:
        small, middle, large = fit.nut_minor_diameter / 2, fit.nut_pitch_diameter / 2, fit.nut_major_diameter / 2
        small_fillet, large_fillet = form.nut_crest_fillet * p, form.nut_root_fillet * p
    else:
        small, middle, large = fit.bolt_minor_diameter / 2, fit.bolt_pitch_diameter / 2, fit.bolt_major_diameter / 2
        small_fillet, large_fillet = form.bolt_root_fillet * p, form.bolt_crest_fillet * p
    negative = form.flank_half_angle_neg_deg
    angles = form.flank_half_angle_deg, form.flank_half_angle_deg if negative is None else negative
    # Axial positions of the four boundaries on each half, s or p / 2 - s, by the radii at which the flank ends.
    halves = []
    for half_angle in map(math.radians, angles):
        turn = math.pi / 2 - half_angle
        flank_from = (small + small_fillet * (1 - math.cos(turn)) - middle) * math.tan(half_angle)
        flank_to = (large - large_fillet * (1 - math.cos(turn)) - middle) * math.tan(half_angle)
        ends = flank_from - small_fillet * math.sin(turn), flank_to + large_fillet * math.sin(turn)
        halves.append([ends[0], flank_from, flank_to, ends[1]])
    # From the middle of the groove's flat; up to that of the ridge's the profile rises.
    groove, ridge = (halves[0][0] - halves[1][0] - p / 2) / 2, (halves[0][3] - halves[1][3] + p / 2) / 2
    u = (s - groove) % p + groove
    rising = u <= ridge
    u, marks = (u, halves[0]) if rising else (p / 2 - u, halves[1])
    half_angle = math.radians(angles[0 if rising else 1])
    turn = math.pi / 2 - half_angle
    part = sum(u > mark for mark in marks)
    distance = min(abs(u - mark) for mark in marks[max(part - 1, 0) : part + 1])
    margin = distance
    if part == 2:
        margin = distance / math.sin(half_angle)
    elif part in (1, 3):
        rho = small_fillet if part == 1 else large_fillet
        from_flat = u - marks[0] if part == 1 else marks[3] - u
        angle = math.asin(min(1.0, from_flat / rho))
        margin = rho * min(angle, turn - angle)
    return RegionAt(_region(_BY_SIZE[part], rising=rising, of_nut=of_nut), margin, distance)


def _region(by_size: str, *, rising: bool, of_nut: bool) -> Region:
    # The bolt's crest is its largest radius, the nut's its smallest.
    small, large = ("crest", "root") if of_nut else ("root", "crest")
    name = by_size.replace("small", small).replace("large", large)
    return Region(name if by_size in ("small", "large") else f"{name}_{'pos' if rising else 'neg'}")
