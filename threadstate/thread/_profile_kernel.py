"""The profile as pure functions of a number and a packed parameter row.

A row is ``profile_row(...)``: [p, r_minor, u_flat, u_flank, r_pitch, cot(flank), u_crest, u_top, r_major,
rho_minor, rho_major], where the ``u`` are the boundaries of the rising half period, -p/4 <= u <= p/4:
flat | fillet | flank | fillet | flat. The public face is ``threadstate.thread.profile``.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel

Row = NDArray[np.float64]

P, R_MINOR, U_FLAT, U_FLANK, R_PITCH, COT, U_CREST, U_TOP, R_MAJOR, RHO_MINOR, RHO_MAJOR = range(11)
ROW_SIZE = 11


@kernel(inline="always")
def fold(s: float, p: float) -> tuple[float, float]:
    """The rising-half coordinate ``u`` in [-p/4, p/4] of ``s``, and the sign of the half (+1 rising, -1 falling)."""
    u = s - p * math.floor(s / p + 0.25)
    if u > 0.25 * p:
        return 0.5 * p - u, -1.0
    return u, 1.0


@kernel()
def rising(u: float, row: Row) -> tuple[float, float, float]:
    """Radius, slope and second derivative at ``u`` of the rising half."""
    if u <= row[U_FLAT]:
        return row[R_MINOR], 0.0, 0.0
    if u < row[U_FLANK]:
        du = u - row[U_FLAT]
        rho = row[RHO_MINOR]
        c = math.sqrt((rho - du) * (rho + du))
        return row[R_MINOR] + du * du / (rho + c), du / c, rho * rho / (c * c * c)
    if u <= row[U_CREST]:
        return row[R_PITCH] + u * row[COT], row[COT], 0.0
    if u < row[U_TOP]:
        du = row[U_TOP] - u
        rho = row[RHO_MAJOR]
        c = math.sqrt((rho - du) * (rho + du))
        return row[R_MAJOR] - du * du / (rho + c), du / c, -rho * rho / (c * c * c)
    return row[R_MAJOR], 0.0, 0.0


@kernel()
def radius(s: float, row: Row) -> float:
    """``f(s)``."""
    u, _ = fold(s, row[P])
    return rising(u, row)[0]


@kernel()
def jet(s: float, row: Row) -> tuple[float, float, float]:
    """``f, f', f''`` at ``s``."""
    u, sign = fold(s, row[P])
    r, d1, d2 = rising(u, row)
    return r, sign * d1, d2


@kernel()
def inverse_rising(r: float, row: Row) -> float:
    """The ``u`` of the rising half with radius ``r``, for r_minor <= r <= r_major.

    At ``r_minor`` it is the flat's end, at ``r_major`` the flat's start.
    """
    low = r - row[R_MINOR]
    if low <= 0.0:
        return row[U_FLAT]
    high = row[R_MAJOR] - r
    if high <= 0.0:
        return row[U_TOP]
    u = (r - row[R_PITCH]) / row[COT]
    if u < row[U_FLANK]:
        return row[U_FLAT] + math.sqrt(low * (2.0 * row[RHO_MINOR] - low))
    if u > row[U_CREST]:
        return row[U_TOP] - math.sqrt(high * (2.0 * row[RHO_MAJOR] - high))
    return u


@kernel()
def bend_range(s: float, half: float, row: Row) -> tuple[float, float]:
    """Smallest and largest ``f''`` on [s - half, s + half]; on a fillet it grows in size towards the flank.

    Where either argument is not a number it can be anything.
    """
    u, _ = fold(s, row[P])
    if not u - half <= u + half:
        return -math.inf, math.inf
    low = 0.0
    high = 0.0
    top = min(u + half, row[U_FLANK])
    if top > row[U_FLAT] and u - half < row[U_FLANK]:
        rho = row[RHO_MINOR]
        du = top - row[U_FLAT]
        c = math.sqrt(max((rho - du) * (rho + du), 0.0))
        high = rho * rho / (c * c * c) if c > 0.0 else math.inf
    bottom = max(u - half, row[U_CREST])
    if bottom < row[U_TOP] and u + half > row[U_CREST]:
        rho = row[RHO_MAJOR]
        du = row[U_TOP] - bottom
        c = math.sqrt(max((rho - du) * (rho + du), 0.0))
        low = -rho * rho / (c * c * c) if c > 0.0 else -math.inf
    return low, high


@kernel()
def region_index(s: float, row: Row) -> tuple[int, float]:
    """Index 0..7 of the region by growing ``s`` from the small flat, and the arc length to its nearest boundary."""
    u, sign = fold(s, row[P])
    p = row[P]
    if u <= row[U_FLAT]:
        return 0, row[U_FLAT] - u
    if u < row[U_FLANK]:
        a = math.asin((u - row[U_FLAT]) / row[RHO_MINOR])
        full = math.asin((row[U_FLANK] - row[U_FLAT]) / row[RHO_MINOR])
        return (1 if sign > 0 else 7), row[RHO_MINOR] * min(a, full - a)
    if u <= row[U_CREST]:
        secant = math.sqrt(1.0 + row[COT] * row[COT])
        return (2 if sign > 0 else 6), secant * min(u - row[U_FLANK], row[U_CREST] - u)
    if u < row[U_TOP]:
        a = math.asin((row[U_TOP] - u) / row[RHO_MAJOR])
        full = math.asin((row[U_TOP] - row[U_CREST]) / row[RHO_MAJOR])
        return (3 if sign > 0 else 5), row[RHO_MAJOR] * min(a, full - a)
    return 4, min(u - row[U_TOP], 0.25 * p)
