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
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._geometry_kernel import M_COPLANAR, M_SIGMA, TWO_PI, position, set_path, turn_vector
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# A list of the earlier contacts on an edge curve: in the first row their number, and whether the axis of the turn is a
# tangent at the one there is (1 or 0); then azimuth on the curve, and whether g and whether phi is exactly zero there
# at all times. Of those at which one is: cosine and sine of the azimuth and the curve's radius; in the solid's frame
# x, y, the distance from the axis and the axial position on the profile.
K_TANGENT = 1
K_THETA, K_G, K_PHI, K_COSINE, K_SINE, K_RADIUS, K_PLACE_X, K_PLACE_Y, K_DISTANCE, K_POSITION = range(10)
KEPT_SIZE = 10
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
def place_kept(edge: Edge) -> None:
    """Sets where the contacts of an edge's list are, at the start of its motion: what :func:`values_beside` takes."""
    kept, path, profile = edge.kept, edge.path, edge.curve
    k = profile[pk.LEAD] / TWO_PI
    for i in range(1, 1 + int(kept[0, 0])):
        if kept[i, K_G] == 0.0 and kept[i, K_PHI] == 0.0:
            continue
        theta = kept[i, K_THETA]
        cosine, sine, radius = math.cos(theta), math.sin(theta), pk.radius(-k * theta, profile)
        set_path(radius * cosine, radius * sine, edge.motion, path)
        x, y, z = position(path, 0.0, is_turn=True)
        kept[i, K_COSINE], kept[i, K_SINE], kept[i, K_RADIUS] = cosine, sine, radius
        kept[i, K_PLACE_X], kept[i, K_PLACE_Y], kept[i, K_DISTANCE] = x, y, math.hypot(x, y)
        kept[i, K_POSITION] = z - k * math.atan2(y, x)


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
        azimuth += TWO_PI * np.floor((theta - azimuth) / TWO_PI + 0.5)
        if abs(theta - azimuth) < abs(nearest):
            nearest, contact, row = theta - azimuth, azimuth, i
    return nearest, contact, row


@kernel(forceinline=True)
def half_angle(d: float) -> tuple[float, float]:
    """Sine and cosine of ``d / 2``, ``d`` up to ``BESIDE``: five terms of each series leave less than 1e-19."""
    h = 0.5 * d
    w = h * h
    sine = h * (1.0 - w * (1.0 / 6.0 - w * (1.0 / 120.0 - w * (1.0 / 5040.0 - w / 362880.0))))
    return sine, 1.0 - w * (0.5 - w * (1.0 / 24.0 - w * (1.0 / 720.0 - w / 40320.0)))


@kernel()
def values_beside(theta: float, tau: float, edge: Edge) -> tuple[float, float, float]:
    """g, phi and the distance (rad) from the nearest kept contact: NaN where they are no differences from it.

    The contact, as :func:`place_kept` leaves it, is taken to touch exactly, and the axis of the turn to run through it.
    """
    kept, motion = edge.kept, edge.motion
    nearest, _, row = nearest_contact(theta, kept)
    if not abs(nearest) < BESIDE:
        return math.nan, math.nan, math.nan
    g, phi = math.nan, math.nan
    if kept[row, K_G] == 0.0 and kept[row, K_PHI] == 0.0:
        return g, phi, abs(nearest)
    k = edge.curve[pk.LEAD] / TWO_PI
    sigma = motion[M_SIGMA]
    # The way along the curve from the contact, in the curve's frame: r P - r_c P_c = (r - r_c) P + r_c (P - P_c).
    longer = radius_difference(-k * kept[row, K_THETA], -k * nearest, edge.curve)
    half_sine, half_cosine = half_angle(nearest)
    chord = 2.0 * half_sine * kept[row, K_RADIUS]
    middle_x = kept[row, K_COSINE] * half_cosine - kept[row, K_SINE] * half_sine
    middle_y = kept[row, K_SINE] * half_cosine + kept[row, K_COSINE] * half_sine
    dx = longer * (middle_x * half_cosine - middle_y * half_sine) - chord * middle_y
    dy = longer * (middle_y * half_cosine + middle_x * half_sine) + chord * middle_x
    if kept[row, K_G] != 0.0 and motion[M_COPLANAR] != 0.0:
        g = -sigma * (motion[6] * dx + motion[7] * dy)
    dx, dy, dz = turn_vector(dx, dy, 0.0, motion, tau)
    if kept[row, K_G] != 0.0 and motion[M_COPLANAR] == 0.0:
        g = -sigma * dz
    if kept[row, K_PHI] != 0.0:
        x, y, distance = kept[row, K_PLACE_X], kept[row, K_PLACE_Y], kept[row, K_DISTANCE]
        there = math.sqrt((x + dx) * (x + dx) + (y + dy) * (y + dy))
        outward = (2.0 * (x * dx + y * dy) + dx * dx + dy * dy) / (distance + there)
        around = math.atan2(x * dy - y * dx, distance * distance + x * dx + y * dy)
        phi = sigma * (outward - radius_difference(kept[row, K_POSITION], dz - k * around, edge.solid))
    return g, phi, abs(nearest)
