"""The profile ``f`` once more, from the construction in the method (section 1) alone.

Everything is written by ``q``, the distance of ``s`` from the middle of the ridge (the largest radius), 0 <= q <= p/2.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from oracle.compiled import compiled
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

P, R_LARGE, R_SMALL, R_PITCH, COT, RHO_LARGE, RHO_SMALL, Q_LARGE, Q_SMALL, Q_FLANK_LARGE, Q_FLANK_SMALL, LEAD = range(
    12
)


def _packed(pair: Pair, small: float, pitch: float, large: float, rho_small: float, rho_large: float) -> Floats:
    """The numbers that :func:`radius` needs; diameters and fillet radii in the pair's unit."""
    p = pair.thread_pitch
    alpha = math.radians(pair.form.flank_half_angle_deg)
    sin, cos = math.sin(alpha), math.cos(alpha)
    r_small, r_pitch, r_large = small / 2, pitch / 2, large / 2
    # The flank is (r - r_pitch) sin + (q - p/4) cos = 0; a fillet's centre lies its radius away from flank and flat.
    q_large = p / 4 - (rho_large + (r_large - rho_large - r_pitch) * sin) / cos
    q_small = p / 4 + (rho_small - (r_small + rho_small - r_pitch) * sin) / cos
    return np.array(
        [
            p,
            r_large,
            r_small,
            r_pitch,
            cos / sin,
            rho_large,
            rho_small,
            q_large,
            q_small,
            q_large + rho_large * cos,
            q_small - rho_small * cos,
            p * pair.starts * (1 if pair.hand == "right" else -1),
        ]
    )


def bolt_profile(pair: Pair) -> Floats:
    """The bolt's packed profile, shape (12,)."""
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
    """The nut's packed profile, shape (12,)."""
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
def radius(s: float, profile: Floats) -> float:
    """``f(s)``."""
    p = profile[P]
    x = (s - 0.25 * p) / p
    q = p * abs(x - math.floor(x + 0.5))
    if q <= profile[Q_LARGE]:
        return profile[R_LARGE]
    if q < profile[Q_FLANK_LARGE]:
        rho = profile[RHO_LARGE]
        d = q - profile[Q_LARGE]
        return profile[R_LARGE] - rho + math.sqrt(rho * rho - d * d)
    if q <= profile[Q_FLANK_SMALL]:
        return profile[R_PITCH] + (0.25 * p - q) * profile[COT]
    if q < profile[Q_SMALL]:
        rho = profile[RHO_SMALL]
        d = profile[Q_SMALL] - q
        return profile[R_SMALL] + rho - math.sqrt(rho * rho - d * d)
    return profile[R_SMALL]


@compiled
def ridge_half_width(r: float, profile: Floats) -> float:
    """The least ``q`` with ``f <= r``, for a radius that is at least the smallest."""
    if r >= profile[R_LARGE]:
        return 0.0
    q = 0.25 * profile[P] - (r - profile[R_PITCH]) / profile[COT]
    if q < profile[Q_FLANK_LARGE]:
        rho = profile[RHO_LARGE]
        d = r - (profile[R_LARGE] - rho)
        return profile[Q_LARGE] + math.sqrt(max(rho * rho - d * d, 0.0))
    if q > profile[Q_FLANK_SMALL]:
        rho = profile[RHO_SMALL]
        d = profile[R_SMALL] + rho - r
        return profile[Q_SMALL] - math.sqrt(max(rho * rho - d * d, 0.0))
    return q


@compiled
def thread_gap(x: float, y: float, z: float, profile: Floats) -> float:
    """``f(s) - r`` at a point of the thread's frame: positive inside a bolt's thread, negative inside a nut's."""
    s = z - profile[LEAD] * math.atan2(y, x) / (2.0 * math.pi)
    return radius(s, profile) - math.sqrt(x * x + y * y)
