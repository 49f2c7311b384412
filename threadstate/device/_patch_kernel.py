"""The patch on which a bolt's base lies flush on the nut's surface, and its convex hull.

Outlines are sampled and their crossings solved; a side of the hull that decides something is moved out to where it
bounds the patch itself (``refine_side``).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._flush_kernel import distance_outside, outline_root
from threadstate.contact._geometry_kernel import TWO_PI, copy_numbers, edge_point
from threadstate.contact._hull_kernel import convex_hull
from threadstate.device._chart_kernel import N_OFFSET, N_ROTATION
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

OUTLINE_SAMPLES = 360
"""Samples of each outline."""

POINTS = 2 * OUTLINE_SAMPLES + 128
HULL_ROWS = POINTS + 2
"""Room for the samples, the crossings of both outlines, and what refining adds; and for their hull."""

# A point of the patch: where, whether it is one of the nut's outline (1.0 or 0.0), and the azimuth on its part.
H_X, H_Y, H_NUT, H_THETA = range(4)
POINT_SIZE = 4

SAME_POINT = 1e-15
"""Distance (nominal radii) that is round-off."""

SHALLOW = 1e-3
"""How far (nominal radii) outside the patch a sample is, at most, between which and the next the outline may enter it:
an outline bends away from a chord by less."""

MAX_ROOT_STEPS, PEAK_STEPS = 100, 40


@kernel()
def outline_point(
    on_nut: bool, theta: float, place: Array, bolt: Array, nut: Array
) -> tuple[float, float, float, float]:
    """The point of an outline at an azimuth of its own part, on the nut's surface, and its derivative."""
    x, y, dx, dy = edge_point(theta, nut if on_nut else bolt)
    if on_nut:
        return x, y, dx, dy
    m = place[N_ROTATION : N_ROTATION + 9]
    return (
        m[0] * x + m[1] * y + place[N_OFFSET],
        m[3] * x + m[4] * y + place[N_OFFSET + 1],
        m[0] * dx + m[1] * dy,
        m[3] * dx + m[4] * dy,
    )


@kernel()
def azimuth_on(on_nut: bool, x: float, y: float, place: Array) -> float:
    """The azimuth, on the nut or on the bolt, of a point of the nut's surface."""
    if on_nut:
        return math.atan2(y, x)
    m = place[N_ROTATION : N_ROTATION + 9]
    dx, dy = x - place[N_OFFSET], y - place[N_OFFSET + 1]
    return math.atan2(m[1] * dx + m[4] * dy, m[0] * dx + m[3] * dy)


@kernel()
def in_patch(on_nut: bool, x: float, y: float, place: Array, bolt: Array, nut: Array) -> bool:
    """Whether a point of an outline lies in the patch: of the nut's outline in the bolt, of the bolt's off the hole."""
    theta = azimuth_on(not on_nut, x, y, place)
    if on_nut:
        away = math.hypot(x - place[N_OFFSET], y - place[N_OFFSET + 1])
        return away <= pk.radius(-bolt[pk.LEAD] / TWO_PI * theta, bolt)
    return math.hypot(x, y) >= pk.radius(-nut[pk.LEAD] / TWO_PI * theta, nut)


@kernel()
def add_point(on_nut: bool, theta: float, place: Array, bolt: Array, nut: Array, count: int, points: Array) -> int:
    """Adds a point of an outline to a list, unless it is full; their number then."""
    if count == points.shape[0]:
        return count
    points[count, H_X], points[count, H_Y], _, _ = outline_point(on_nut, theta, place, bolt, nut)
    points[count, H_NUT] = 1.0 if on_nut else 0.0
    points[count, H_THETA] = theta
    return count + 1


@kernel()
def add_crossing(low: float, high: float, place: Array, bolt: Array, nut: Array, count: int, points: Array) -> int:
    """Adds the corner of the patch at which the bolt's outline crosses the nut's between two azimuths."""
    theta = outline_root(low, high, True, 0.0, 0.0, place, bolt, nut)
    return add_point(False, theta, place, bolt, nut, count, points)


@kernel()
def entry_between(low: float, high: float, place: Array, bolt: Array, nut: Array) -> float:
    """The azimuth between two at which the bolt's outline is farthest outside the nut's (golden sections)."""
    for _ in range(PEAK_STEPS):
        a, b = low + 0.381966 * (high - low), low + 0.618034 * (high - low)
        if distance_outside(a, place, bolt, nut) > distance_outside(b, place, bolt, nut):
            high = b
        else:
            low = a
    return 0.5 * (low + high)


@kernel()
def patch_points(place: Array, bolt: Array, nut: Array, points: Array) -> int:
    """Sets the samples of both outlines that lie in the patch, and its corners; returns their number."""
    count = 0
    step = TWO_PI / OUTLINE_SAMPLES
    for i in range(OUTLINE_SAMPLES):
        x, y, _, _ = outline_point(True, step * i, place, bolt, nut)
        if in_patch(True, x, y, place, bolt, nut):
            count = add_point(True, step * i, place, bolt, nut, count, points)
    before = distance_outside(-step, place, bolt, nut)
    here = distance_outside(0.0, place, bolt, nut)
    for i in range(OUTLINE_SAMPLES):
        theta = step * i
        after = distance_outside(theta + step, place, bolt, nut)
        if here >= 0.0:
            count = add_point(False, theta, place, bolt, nut, count, points)
        if (here > 0.0) != (after > 0.0):
            count = add_crossing(theta, theta + step, place, bolt, nut, count, points)
        if here < 0.0 and here >= before and here >= after and here > -SHALLOW * bolt[pk.R_MAJOR]:
            peak = entry_between(theta - step, theta + step, place, bolt, nut)
            if distance_outside(peak, place, bolt, nut) > 0.0:
                count = add_point(False, peak, place, bolt, nut, count, points)
                count = add_crossing(theta - step, peak, place, bolt, nut, count, points)
                count = add_crossing(peak, theta + step, place, bolt, nut, count, points)
        before, here = here, after
    return count


@kernel()
def farthest_azimuth(
    on_nut: bool, theta: float, nx: float, ny: float, place: Array, bolt: Array, nut: Array
) -> tuple[bool, float]:
    """Where an outline is farthest in a direction, within a sample of an azimuth; whether it is anywhere there.

    The root of the outline's slope by regula falsi (Illinois).
    """
    _, _, dx, dy = outline_point(on_nut, theta, place, bolt, nut)
    at_low = nx * dx + ny * dy
    low, high = theta, theta + (TWO_PI if at_low > 0.0 else -TWO_PI) / OUTLINE_SAMPLES
    _, _, dx, dy = outline_point(on_nut, high, place, bolt, nut)
    at_high = nx * dx + ny * dy
    if at_low == 0.0 or (at_low > 0.0) == (at_high > 0.0):
        return False, theta
    side = 0
    for _ in range(MAX_ROOT_STEPS):
        if abs(high - low) <= 4e-16 * (1.0 + abs(low)):
            break
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        if not min(low, high) < middle < max(low, high):
            middle = 0.5 * (low + high)
        _, _, dx, dy = outline_point(on_nut, middle, place, bolt, nut)
        slope = nx * dx + ny * dy
        if slope == 0.0:
            return True, middle
        if (slope > 0.0) == (at_low > 0.0):
            low, at_low = middle, slope
            at_high *= 0.5 if side == -1 else 1.0
            side = -1
        else:
            high, at_high = middle, slope
            at_low *= 0.5 if side == 1 else 1.0
            side = 1
    return True, low


@kernel()
def refine_side(hull: Array, size: int, i: int, place: Array, bolt: Array, nut: Array, points: Array) -> int:
    """Adds to a hull, in place, the points of the patch farthest beyond its i-th side; its size then.

    The patch goes beyond a side near its ends alone, which are points of an outline, or of both at a corner. A hull
    that stays as it is has a side that bounds the patch itself. ``points`` is scratch.
    """
    j = i + 1 if i + 1 < size else 0
    nx, ny = hull[j, H_Y] - hull[i, H_Y], hull[i, H_X] - hull[j, H_X]
    length = math.hypot(nx, ny)
    nx, ny = nx / length, ny / length
    least = SAME_POINT * bolt[pk.R_MAJOR]
    reach = max(nx * hull[i, H_X] + ny * hull[i, H_Y], nx * hull[j, H_X] + ny * hull[j, H_Y])
    for m in range(size):
        copy_numbers(hull[m], points[m])
    count = size
    for end in (i, j):
        for on_nut in (False, True):
            theta = hull[end, H_THETA]
            if on_nut != (hull[end, H_NUT] > 0.0):
                theta = azimuth_on(on_nut, hull[end, H_X], hull[end, H_Y], place)
                x, y, _, _ = outline_point(on_nut, theta, place, bolt, nut)
                if abs(x - hull[end, H_X]) + abs(y - hull[end, H_Y]) > least:
                    continue
            found, theta = farthest_azimuth(on_nut, theta, nx, ny, place, bolt, nut)
            x, y, _, _ = outline_point(on_nut, theta, place, bolt, nut)
            if found and nx * x + ny * y > reach + least and in_patch(on_nut, x, y, place, bolt, nut):
                count = add_point(on_nut, theta, place, bolt, nut, count, points)
    return convex_hull(points, count, hull) if count > size else size


@kernel()
def nearest_side(hull: Array, size: int, x: float, y: float) -> tuple[float, int]:
    """How far a point is inside a convex polygon, negative: outside; and the side of which that is said."""
    least, nearest = math.inf, 0
    for i in range(size):
        j = i + 1 if i + 1 < size else 0
        ax, ay = hull[j, H_X] - hull[i, H_X], hull[j, H_Y] - hull[i, H_Y]
        margin = (ax * (y - hull[i, H_Y]) - ay * (x - hull[i, H_X])) / math.hypot(ax, ay)
        if margin < least:
            least, nearest = margin, i
    return (least, nearest) if size > 2 else (-math.inf, 0)


@kernel()
def hull_margin(
    hull: Array, size: int, x: float, y: float, place: Array, bolt: Array, nut: Array, points: Array
) -> tuple[float, int, int]:
    """How far a point is inside the patch's hull, negative: outside; the side of which that is said; the hull's size.

    The hull is refined at that side until it bounds the patch.
    """
    while True:
        margin, side = nearest_side(hull, size, x, y)
        if size < 3:
            return margin, side, size
        refined = refine_side(hull, size, side, place, bolt, nut, points)
        if refined <= size:
            return margin, side, size
        size = refined


@kernel()
def set_patch_hull(
    x: float, y: float, place: Array, bolt: Array, nut: Array, points: Array, hull: Array
) -> tuple[int, float, int, int]:
    """Sets the points of the patch and the corners of its hull; how many points there are, how far inside the hull
    (x, y) is, negative: outside, the side of which that is said, and how many corners there are.
    """
    count = patch_points(place, bolt, nut, points)
    size = convex_hull(points, count, hull)
    margin, side, size = hull_margin(hull, size, x, y, place, bolt, nut, scratch(POINTS, POINT_SIZE))
    return count, margin, side, size
