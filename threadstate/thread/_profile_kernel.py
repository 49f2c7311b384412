"""The profile as pure functions of a number and the packed parameters.

The parameters are ``Profile.packed``: [p, r_minor, u_flat, u_flank, r_pitch, cot(flank), u_crest, u_top, r_major,
rho_minor, rho_major, lead], where the ``u`` are the boundaries of the rising half period, -p/4 <= u <= p/4:
flat | fillet | flank | fillet | flat, and the ``lead`` is negative of a left-hand thread. The
public interface is ``threadstate.thread.profile``.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel

Array = NDArray[np.float64]

P, R_MINOR, U_FLAT, U_FLANK, R_PITCH, COT, U_CREST, U_TOP, R_MAJOR, RHO_MINOR, RHO_MAJOR, LEAD = range(12)
PROFILE_SIZE = 12


@kernel(inline="always")
def fold(s: float, p: float) -> tuple[float, float]:
    """The rising-half coordinate ``u`` in [-p/4, p/4] of ``s``, and the sign of the half (+1 rising, -1 falling)."""
    u = s - p * math.floor(s / p + 0.25)
    if u > 0.25 * p:
        return 0.5 * p - u, -1.0
    return u, 1.0


@kernel()
def rising(u: float, profile: Array) -> tuple[float, float, float]:
    """Radius, slope and second derivative at ``u`` of the rising half."""
    if u <= profile[U_FLAT]:
        return profile[R_MINOR], 0.0, 0.0
    if u < profile[U_FLANK]:
        du = u - profile[U_FLAT]
        rho = profile[RHO_MINOR]
        c = math.sqrt((rho - du) * (rho + du))
        return profile[R_MINOR] + du * du / (rho + c), du / c, rho * rho / (c * c * c)
    if u <= profile[U_CREST]:
        return profile[R_PITCH] + u * profile[COT], profile[COT], 0.0
    if u < profile[U_TOP]:
        du = profile[U_TOP] - u
        rho = profile[RHO_MAJOR]
        c = math.sqrt((rho - du) * (rho + du))
        return profile[R_MAJOR] - du * du / (rho + c), du / c, -rho * rho / (c * c * c)
    return profile[R_MAJOR], 0.0, 0.0


@kernel()
def radius(s: float, profile: Array) -> float:
    """``f(s)``."""
    u, _ = fold(s, profile[P])
    return rising(u, profile)[0]


@kernel()
def jet(s: float, profile: Array) -> tuple[float, float, float]:
    """``f, f', f''`` at ``s``."""
    u, sign = fold(s, profile[P])
    r, d1, d2 = rising(u, profile)
    return r, sign * d1, d2


@kernel()
def inverse_rising(r: float, profile: Array) -> float:
    """The ``u`` of the rising half with radius ``r``, for r_minor <= r <= r_major.

    At ``r_minor`` it is the flat's end, at ``r_major`` the flat's start.
    """
    low = r - profile[R_MINOR]
    if low <= 0.0:
        return profile[U_FLAT]
    high = profile[R_MAJOR] - r
    if high <= 0.0:
        return profile[U_TOP]
    u = (r - profile[R_PITCH]) / profile[COT]
    if u < profile[U_FLANK]:
        return profile[U_FLAT] + math.sqrt(low * (2.0 * profile[RHO_MINOR] - low))
    if u > profile[U_CREST]:
        return profile[U_TOP] - math.sqrt(high * (2.0 * profile[RHO_MAJOR] - high))
    return u


@kernel()
def second_derivative_range(s: float, half: float, profile: Array) -> tuple[float, float]:
    """Smallest and largest ``f''`` on [s - half, s + half]; on a fillet it grows in size towards the flank.

    Where either argument is NaN the range is unbounded.
    """
    u, _ = fold(s, profile[P])
    if not u - half <= u + half:
        return -math.inf, math.inf
    low = 0.0
    high = 0.0
    top = min(u + half, profile[U_FLANK])
    if top > profile[U_FLAT] and u - half < profile[U_FLANK]:
        rho = profile[RHO_MINOR]
        du = top - profile[U_FLAT]
        c = math.sqrt(max((rho - du) * (rho + du), 0.0))
        high = rho * rho / (c * c * c) if c > 0.0 else math.inf
    bottom = max(u - half, profile[U_CREST])
    if bottom < profile[U_TOP] and u + half > profile[U_CREST]:
        rho = profile[RHO_MAJOR]
        du = profile[U_TOP] - bottom
        c = math.sqrt(max((rho - du) * (rho + du), 0.0))
        low = -rho * rho / (c * c * c) if c > 0.0 else -math.inf
    return low, high


@kernel()
def region_index(s: float, profile: Array) -> tuple[int, float]:
    """Index 0..7 of the region by growing ``s`` from the small flat, and the arc length to its nearest boundary."""
    u, sign = fold(s, profile[P])
    p = profile[P]
    if u <= profile[U_FLAT]:
        return 0, profile[U_FLAT] - u
    if u < profile[U_FLANK]:
        a = math.asin((u - profile[U_FLAT]) / profile[RHO_MINOR])
        full = math.asin((profile[U_FLANK] - profile[U_FLAT]) / profile[RHO_MINOR])
        return (1 if sign > 0 else 7), profile[RHO_MINOR] * min(a, full - a)
    if u <= profile[U_CREST]:
        secant = math.sqrt(1.0 + profile[COT] * profile[COT])
        return (2 if sign > 0 else 6), secant * min(u - profile[U_FLANK], profile[U_CREST] - u)
    if u < profile[U_TOP]:
        a = math.asin((profile[U_TOP] - u) / profile[RHO_MAJOR])
        full = math.asin((profile[U_TOP] - profile[U_CREST]) / profile[RHO_MAJOR])
        return (3 if sign > 0 else 5), profile[RHO_MAJOR] * min(a, full - a)
    return 4, min(u - profile[U_TOP], 0.25 * p)
