"""The profile ``f`` once more, from the construction in the method (section 1) alone.

Each side of a ridge is written by ``q``, the distance of ``s`` from s = p/4: before it on the rising side, behind it on
the falling one. ``f`` is the smaller of what both sides say.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from oracle.compiled import compiled
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

P, R_LARGE, R_SMALL, R_PITCH, RHO_LARGE, RHO_SMALL, LEAD, GROOVE = range(8)
COT, Q_LARGE, Q_SMALL, Q_FLANK_LARGE, Q_FLANK_SMALL = range(8, 13)
RISING, FALLING = 0, 5
"""What is added to the numbers of a side, which the five before this are."""


def _packed(pair: Pair, small: float, pitch: float, large: float, rho_small: float, rho_large: float) -> Floats:
    """The numbers that :func:`radius` needs; diameters and fillet radii in the pair's unit."""
    p = pair.thread_pitch
    negative = pair.form.flank_half_angle_neg_deg
    angles = pair.form.flank_half_angle_deg, pair.form.flank_half_angle_deg if negative is None else negative
    r_small, r_pitch, r_large = small / 2, pitch / 2, large / 2
    sides = []
    for alpha in map(math.radians, angles):
        sin, cos = math.sin(alpha), math.cos(alpha)
        # The flank is (r - r_pitch) sin + (q - p/4) cos = 0; a fillet's centre lies its radius off flank and flat.
        q_large = p / 4 - (rho_large + (r_large - rho_large - r_pitch) * sin) / cos
        q_small = p / 4 + (rho_small - (r_small + rho_small - r_pitch) * sin) / cos
        sides.append((cos / sin, q_large, q_small, q_large + rho_large * cos, q_small - rho_small * cos))
    rising, falling = sides
    # The groove's middle, which lies between the falling side of one ridge and the rising side of the next.
    groove = p / 4 - (rising[2] + p - falling[2]) / 2
    lead = p * pair.starts * (1 if pair.hand == "right" else -1)
    return np.array([p, r_large, r_small, r_pitch, rho_large, rho_small, lead, groove, *rising, *falling])


def bolt_profile(pair: Pair) -> Floats:
    """The bolt's packed profile, shape (18,)."""
    fit, form, p = pair.fit, pair.form, pair.thread_pitch
    return _packed(
        pair,
        fit.bolt_minor_diameter,
        fit.bolt_pitch_diameter,
        fit.bolt_major_diameter,
        form.bolt_root_fillet * p,
        form.bolt_crest_fillet * p,
    )


def nut_profile(pair: Pair) -> Floats:
    """The nut's packed profile, shape (18,)."""
    fit, form, p = pair.fit, pair.form, pair.thread_pitch
    return _packed(
        pair,
        fit.nut_minor_diameter,
        fit.nut_pitch_diameter,
        fit.nut_major_diameter,
        form.nut_crest_fillet * p,
        form.nut_root_fillet * p,
    )


@compiled
def beyond_quarter(s: float, profile: Floats) -> float:
    """How far ``s`` lies behind the s = p/4 of its ridge, from the middle of one groove to that of the next."""
    return s - profile[P] * math.floor((s - profile[GROOVE]) / profile[P]) - 0.25 * profile[P]


@compiled
def radius_of_side(q: float, side: int, profile: Floats) -> float:
    """The radius at distance ``q`` on a side of the ridge; beyond p/4 on the other side it is the largest."""
    if q <= profile[Q_LARGE + side]:
        return profile[R_LARGE]
    if q < profile[Q_FLANK_LARGE + side]:
        rho = profile[RHO_LARGE]
        d = q - profile[Q_LARGE + side]
        return profile[R_LARGE] - rho + math.sqrt(rho * rho - d * d)
    if q <= profile[Q_FLANK_SMALL + side]:
        return profile[R_PITCH] + (0.25 * profile[P] - q) * profile[COT + side]
    if q < profile[Q_SMALL + side]:
        rho = profile[RHO_SMALL]
        d = profile[Q_SMALL + side] - q
        return profile[R_SMALL] + rho - math.sqrt(rho * rho - d * d)
    return profile[R_SMALL]


@compiled
def radius(s: float, profile: Floats) -> float:
    """``f(s)``."""
    x = beyond_quarter(s, profile)
    return min(radius_of_side(-x, RISING, profile), radius_of_side(x, FALLING, profile))


@compiled
def ridge_width(r: float, side: int, profile: Floats) -> float:
    """The least ``q`` on a side with ``f <= r``, for a radius between the smallest and the largest."""
    q = 0.25 * profile[P] - (r - profile[R_PITCH]) / profile[COT + side]
    if q < profile[Q_FLANK_LARGE + side]:
        rho = profile[RHO_LARGE]
        d = r - (profile[R_LARGE] - rho)
        return profile[Q_LARGE + side] + math.sqrt(max(rho * rho - d * d, 0.0))
    if q > profile[Q_FLANK_SMALL + side]:
        rho = profile[RHO_SMALL]
        d = profile[R_SMALL] + rho - r
        return profile[Q_SMALL + side] - math.sqrt(max(rho * rho - d * d, 0.0))
    return q


@compiled
def ridge_at(r: float, s: float, profile: Floats) -> tuple[float, float]:
    """The ``s`` from and up to which the ridge of a period is higher than ``r``; empty where the first is larger."""
    quarter = s - beyond_quarter(s, profile)
    if r >= profile[R_LARGE]:
        return quarter, quarter
    return quarter - ridge_width(r, RISING, profile), quarter + ridge_width(r, FALLING, profile)


@compiled
def thread_gap(x: float, y: float, z: float, profile: Floats) -> float:
    """``f(s) - r`` at a point of the thread's frame: positive inside a bolt's thread, negative inside a nut's."""
    s = z - profile[LEAD] * math.atan2(y, x) / (2.0 * math.pi)
    return radius(s, profile) - math.sqrt(x * x + y * y)
