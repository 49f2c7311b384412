"""The profile as pure functions of a number and the packed parameters.

The parameters are ``Profile.packed``. Those of a half period, in its coordinate ``u``, are the boundaries
flat | fillet | flank | fillet | flat and the cot of its flank: of the rising half from ``U_FLAT`` on, where ``u`` is
``s``, and of the falling half ``FALLING`` numbers later, where ``u`` is ``p / 2 - s``. Between ``U_FAR_FLAT`` and
``U_FAR_TOP`` nothing but the half's own f'' is met, between ``U_REACH_FLAT`` and ``U_REACH_TOP`` f' has no other sign.
The halves part in the middle of the flats, at ``S_ROOT`` and ``S_CREST``. The ``LEAD`` is negative of a left-hand
thread. The public interface is ``threadstate.thread.profile``.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel

Array = NDArray[np.float64]

P, R_MINOR, R_PITCH, R_MAJOR, RHO_MINOR, RHO_MAJOR, LEAD, STEEPEST, S_ROOT, S_CREST = range(10)
"""``STEEPEST`` is the larger cot of the two flanks, the largest |f'|."""
U_FLAT, U_FLANK, COT, U_CREST, U_TOP, U_FAR_FLAT, U_FAR_TOP, U_REACH_FLAT, U_REACH_TOP = range(10, 19)
FALLING = 9
F2_LEAST, F2_GREATEST = 28, 29
"""The range of f'' over the whole profile: its ends are where the fillets meet the steeper flank."""
PROFILE_SIZE = 30


@kernel(inline="always")
def fold(s: float, profile: Array) -> tuple[float, int]:
    """The coordinate ``u`` of the half period in which ``s`` is, and which: 0 the rising one, else ``FALLING``."""
    p = profile[P]
    u = s - p * np.floor(s / p - profile[S_ROOT] / p)
    if u > profile[S_CREST]:
        return 0.5 * p - u, FALLING
    return u, 0


@kernel()
def half_jet(u: float, half: int, profile: Array) -> tuple[float, float, float]:
    """Radius, slope by ``u`` and second derivative at ``u`` of a half period."""
    if u <= profile[U_FLAT + half]:
        return profile[R_MINOR], 0.0, 0.0
    if u < profile[U_FLANK + half]:
        du = u - profile[U_FLAT + half]
        rho = profile[RHO_MINOR]
        c = math.sqrt((rho - du) * (rho + du))
        return profile[R_MINOR] + du * du / (rho + c), du / c, rho * rho / (c * c * c)
    if u <= profile[U_CREST + half]:
        return profile[R_PITCH] + u * profile[COT + half], profile[COT + half], 0.0
    if u < profile[U_TOP + half]:
        du = profile[U_TOP + half] - u
        rho = profile[RHO_MAJOR]
        c = math.sqrt((rho - du) * (rho + du))
        return profile[R_MAJOR] - du * du / (rho + c), du / c, -rho * rho / (c * c * c)
    return profile[R_MAJOR], 0.0, 0.0


@kernel()
def radius(s: float, profile: Array) -> float:
    """``f(s)``."""
    u, half = fold(s, profile)
    return half_jet(u, half, profile)[0]


@kernel()
def jet(s: float, profile: Array) -> tuple[float, float, float]:
    """``f, f', f''`` at ``s``."""
    u, half = fold(s, profile)
    r, d1, d2 = half_jet(u, half, profile)
    return r, (d1 if half == 0 else -d1), d2


@kernel()
def inverse(r: float, half: int, profile: Array) -> float:
    """The ``u`` of a half period with radius ``r``, for r_minor <= r <= r_major.

    At ``r_minor`` it is the flat's end, at ``r_major`` the flat's start.
    """
    low = r - profile[R_MINOR]
    if low <= 0.0:
        return profile[U_FLAT + half]
    high = profile[R_MAJOR] - r
    if high <= 0.0:
        return profile[U_TOP + half]
    u = (r - profile[R_PITCH]) / profile[COT + half]
    if u < profile[U_FLANK + half]:
        return profile[U_FLAT + half] + math.sqrt(low * (2.0 * profile[RHO_MINOR] - low))
    if u > profile[U_CREST + half]:
        return profile[U_TOP + half] - math.sqrt(high * (2.0 * profile[RHO_MAJOR] - high))
    return u


@kernel()
def second_derivative_range(s: float, reach: float, profile: Array) -> tuple[float, float]:
    """Smallest and largest ``f''`` on [s - reach, s + reach]; on a fillet it grows in size towards the flank.

    Where either argument is NaN the range is unbounded.
    """
    u, half = fold(s, profile)
    if not u - reach <= u + reach:
        return -math.inf, math.inf
    if u - reach < profile[U_FAR_FLAT + half] or u + reach > profile[U_FAR_TOP + half]:
        return profile[F2_LEAST], profile[F2_GREATEST]
    low = 0.0
    high = 0.0
    top = min(u + reach, profile[U_FLANK + half])
    if top > profile[U_FLAT + half] and u - reach < profile[U_FLANK + half]:
        rho = profile[RHO_MINOR]
        du = top - profile[U_FLAT + half]
        c = math.sqrt(max((rho - du) * (rho + du), 0.0))
        high = rho * rho / (c * c * c) if c > 0.0 else math.inf
    bottom = max(u - reach, profile[U_CREST + half])
    if bottom < profile[U_TOP + half] and u + reach > profile[U_CREST + half]:
        rho = profile[RHO_MAJOR]
        du = profile[U_TOP + half] - bottom
        c = math.sqrt(max((rho - du) * (rho + du), 0.0))
        low = -rho * rho / (c * c * c) if c > 0.0 else -math.inf
    return low, high


@kernel()
def region_index(s: float, profile: Array) -> tuple[int, float]:
    """Index 0..7 of the region by growing ``s`` from the small flat, and the arc length to its nearest boundary."""
    u, half = fold(s, profile)
    rises = half == 0
    flat, flank, crest, top = (
        profile[U_FLAT + half],
        profile[U_FLANK + half],
        profile[U_CREST + half],
        profile[U_TOP + half],
    )
    if u <= flat:
        return 0, flat - u
    if u < flank:
        a = math.asin((u - flat) / profile[RHO_MINOR])
        full = math.asin((flank - flat) / profile[RHO_MINOR])
        return (1 if rises else 7), profile[RHO_MINOR] * min(a, full - a)
    if u <= crest:
        secant = math.sqrt(1.0 + profile[COT + half] * profile[COT + half])
        return (2 if rises else 6), secant * min(u - flank, crest - u)
    if u < top:
        a = math.asin((top - u) / profile[RHO_MAJOR])
        full = math.asin((top - crest) / profile[RHO_MAJOR])
        return (3 if rises else 5), profile[RHO_MAJOR] * min(a, full - a)
    return 4, u - top
