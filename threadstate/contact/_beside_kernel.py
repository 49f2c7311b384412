"""g and phi beside a contact through which the axis of a turn runs: as differences from it.

At such a contact the edge curve touches at all times, so that beside it g and phi are small, and round-off would hide
them. Written as differences, with no two nearly equal numbers subtracted, their error falls with the distance
(docs/certificate.md, section 6).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import (
    M_COPLANAR,
    M_SIGMA,
    TWO_PI,
    edge_point,
    position,
    set_path,
    turn_vector,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# A list of the earlier contacts on an edge curve: in the first row their number, and whether the axis of the turn is a
# tangent at the one there is (1 or 0); then azimuth on the curve, and whether g and whether phi is exactly zero there
# at all times.
K_TANGENT = 1
K_THETA, K_G, K_PHI = range(3)
KEPT_SIZE = 3
MOST_KEPT = 18
KEPT_ROWS = 1 + MOST_KEPT
"""Most contacts that are kept, and rows of a list with room for them."""

BESIDE = 0.1
"""Distance (rad) from a contact up to which g and phi are taken as differences: farther they are no more exact."""


@kernel()
def clear(kept: Array) -> None:
    """Makes a list an empty one."""
    kept[0, 0], kept[0, K_TANGENT] = 0.0, 0.0


@kernel()
def keep(theta: float, on_plane: bool, on_thread: bool, kept: Array) -> None:
    """Adds a contact on the curve to a list, exactly on the solid's plane, on its thread, on both or on neither."""
    count = int(kept[0, 0]) + 1
    kept[0, 0] = count
    kept[count, K_THETA] = theta
    kept[count, K_G] = 1.0 if on_plane else 0.0
    kept[count, K_PHI] = 1.0 if on_thread else 0.0


@kernel()
def arc_rise(d: float, e: float, length: float, rho: float) -> float:
    """How much the height of a fillet changes over ``length``, from ``d`` to ``e`` beside its flat."""
    roots = math.sqrt(max((rho - d) * (rho + d), 0.0)) + math.sqrt(max((rho - e) * (rho + e), 0.0))
    return length * (d + e) / roots


@kernel()
def half_difference(u: float, du: float, half: int, profile: Array) -> float:
    """The radius at ``u + du`` of a half period less that at ``u``: a sum over the pieces of the profile between.

    Where both are in one piece its length is ``du`` itself, and not a difference.
    """
    flat, top = profile[pk.U_FLAT + half], profile[pk.U_TOP + half]
    ends = (-math.inf, flat, profile[pk.U_FLANK + half], profile[pk.U_CREST + half], top, math.inf)
    up = du >= 0.0
    sign = 1.0 if up else -1.0
    rest = abs(du)
    total = 0.0
    for i in range(5):
        piece = i if up else 4 - i
        low, high = ends[piece], ends[piece + 1]
        length = min(rest, high - u if up else u - low)
        if length <= 0.0:
            continue
        if piece == 1:
            total += arc_rise(u - flat, u - flat + sign * length, length, profile[pk.RHO_MINOR])
        elif piece == 2:
            total += profile[pk.COT + half] * length
        elif piece == 3:
            total += arc_rise(top - u, top - u - sign * length, length, profile[pk.RHO_MAJOR])
        rest -= length
        u = high if up else low
    return sign * total


@kernel()
def radius_difference(s: float, ds: float, profile: Array) -> float:
    """``f(s + ds) - f(s)`` for less than a half period, with an error of a few units of 1e-16 of ``ds`` times f'."""
    u, half = pk.fold(s, profile)
    du = ds if half == 0 else -ds
    half_pitch = 0.5 * profile[pk.P]
    # The ends of a half period are the middles of the flats: there the coordinate of the other one takes over.
    first = profile[pk.S_ROOT] if half == 0 else -half_pitch - profile[pk.S_ROOT]
    last = profile[pk.S_CREST] if half == 0 else half_pitch - profile[pk.S_CREST]
    over = du - (last - u)
    if over > 0.0:
        return half_difference(u, last - u, half, profile) + half_difference(
            half_pitch - last, -over, pk.FALLING - half, profile
        )
    under = (first - u) - du
    if under > 0.0:
        return half_difference(u, first - u, half, profile) + half_difference(
            -half_pitch - first, under, pk.FALLING - half, profile
        )
    return half_difference(u, du, half, profile)


@kernel(forceinline=True)
def nearest_contact(theta: float, kept: Array) -> tuple[float, float, int]:
    """How far ``theta`` is from the nearest contact (rad; infinite: there is none), its azimuth within pi, its row."""
    nearest, contact, row = math.inf, 0.0, 0
    for i in range(1, 1 + int(kept[0, 0])):
        azimuth = kept[i, K_THETA]
        azimuth += TWO_PI * math.floor((theta - azimuth) / TWO_PI + 0.5)
        if abs(theta - azimuth) < abs(nearest):
            nearest, contact, row = theta - azimuth, azimuth, i
    return nearest, contact, row


@kernel()
def values_beside(
    theta: float, tau: float, motion: Array, curve_profile: Array, solid_profile: Array, kept: Array, path: Array
) -> tuple[float, float, float]:
    """g, phi and the distance (rad) from the nearest kept contact: NaN where they are no differences from it.

    The contact is taken to touch exactly, and the axis of the turn to run through it.
    """
    nearest, contact, row = nearest_contact(theta, kept)
    if not abs(nearest) < BESIDE:
        return math.nan, math.nan, math.nan
    k = curve_profile[pk.LEAD] / TWO_PI
    sigma = motion[M_SIGMA]
    x, y, _, _ = edge_point(contact, curve_profile)
    set_path(x, y, motion, path)
    cx, cy, cz = position(path, 0.0, is_turn=True)
    # The way along the curve from the contact, in the curve's frame: r P - r_c P_c = (r - r_c) P + r_c (P - P_c).
    longer = radius_difference(-k * contact, -k * nearest, curve_profile)
    chord = 2.0 * math.sin(0.5 * nearest) * math.hypot(x, y)
    middle = contact + 0.5 * nearest
    dx = longer * math.cos(theta) - chord * math.sin(middle)
    dy = longer * math.sin(theta) + chord * math.cos(middle)
    g, phi = math.nan, math.nan
    if kept[row, K_G] != 0.0:
        if motion[M_COPLANAR] != 0.0:
            g = -sigma * (motion[6] * dx + motion[7] * dy)
        else:
            g = -sigma * turn_vector(dx, dy, 0.0, motion, tau)[2]
    if kept[row, K_PHI] != 0.0:
        dx, dy, dz = turn_vector(dx, dy, 0.0, motion, tau)
        radius = math.hypot(cx, cy)
        outward = (2.0 * (cx * dx + cy * dy) + dx * dx + dy * dy) / (radius + math.hypot(cx + dx, cy + dy))
        around = math.atan2(cx * dy - cy * dx, radius * radius + cx * dx + cy * dy)
        phi = sigma * (outward - radius_difference(cz - k * math.atan2(cy, cx), dz - k * around, solid_profile))
    return g, phi, abs(nearest)
