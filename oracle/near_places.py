"""Places at which bolt and nut are near each other: peaks of the depth over sampled edges and the bolt's thread.

The depth of a boundary point in the other part is the least of two numbers: how far it is inside the other's thread, in
radius, and how far beyond its flat face. Samples that are no less deep than their neighbours are zoomed on; of those in
one cell of the boundary only the deepest counts. The gap of such a place is the depth over the size of its slope, to
first order, and its normal is that slope. Where both numbers are equal at a peak along an edge the slope is the mean
of theirs that vanishes along the edge. Both parts are as long as needed. All lengths are in one unit, any.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from oracle.compiled import compiled
from oracle.profile import LEAD, P, radius

Floats = NDArray[np.float64]

PART, U, V, BODY, POINT, NORMAL, GAP, ON_THREAD = 0, 1, 2, 3, 6, 9, 12, 13
COLUMNS = 14
"""A place: whose boundary it is of (0 the bolt's edge, 1 the nut's edge, 2 the bolt's thread), its azimuth and height
there, the point in the bolt's and in the nut's frame, the normal from the nut into the bolt in the nut's frame, the
gap, and whether threads alone meet there."""

EDGE = 720
CELL = 10
"""Samples of an edge, and how many of them are a cell."""
AROUND, ALONG = 180, 40
THREAD_CELL = 5
"""Samples round the thread, samples a pitch along it, and columns that are a cell; a cell is half a pitch high."""
SECTIONS = 22
"""Golden sections of a stretch of an edge."""
FINEST = 2e-5
"""Stretch of the thread (rad) that is not narrowed any more."""
KINK = 1e-5
"""Difference of both depths over the radius below which a peak may be where both are equal."""
SLOPE_STEP = 1e-6
"""Of the profile, over the thread pitch."""
_TWO_PI = 2.0 * math.pi


@compiled
def depths_at(part: int, u: float, v: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> tuple[float, float]:
    """How deep a boundary point is inside the other part's thread, and beyond its flat face."""
    if part == 1:
        r = radius(-nut[LEAD] * u / _TWO_PI, nut)
        x, y, z = r * math.cos(u) - t[0], r * math.sin(u) - t[1], -t[2]
        bx = rot[0, 0] * x + rot[1, 0] * y + rot[2, 0] * z
        by = rot[0, 1] * x + rot[1, 1] * y + rot[2, 1] * z
        bz = rot[0, 2] * x + rot[1, 2] * y + rot[2, 2] * z
        return radius(bz - bolt[LEAD] * math.atan2(by, bx) / _TWO_PI, bolt) - math.sqrt(bx * bx + by * by), bz
    r = radius(v - bolt[LEAD] * u / _TWO_PI, bolt)
    bx, by = r * math.cos(u), r * math.sin(u)
    x = rot[0, 0] * bx + rot[0, 1] * by + rot[0, 2] * v + t[0]
    y = rot[1, 0] * bx + rot[1, 1] * by + rot[1, 2] * v + t[1]
    z = rot[2, 0] * bx + rot[2, 1] * by + rot[2, 2] * v + t[2]
    return math.sqrt(x * x + y * y) - radius(z - nut[LEAD] * math.atan2(y, x) / _TWO_PI, nut), -z


@compiled
def depth_at(part: int, u: float, v: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> float:
    """How deep a boundary point is in the other part; negative outside."""
    inside, beyond = depths_at(part, u, v, rot, t, bolt, nut)
    return min(inside, beyond)


@compiled
def _zoomed_on_edge(part: int, u: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> float:
    half = 2.0 * _TWO_PI / EDGE
    for _ in range(6):
        low, high = u - half, u + half
        for _ in range(SECTIONS):
            a, b = low + 0.381966 * (high - low), low + 0.618034 * (high - low)
            if depth_at(part, a, 0.0, rot, t, bolt, nut) > depth_at(part, b, 0.0, rot, t, bolt, nut):
                high = b
            else:
                low = a
        found = 0.5 * (low + high)
        # At an end of the stretch the peak is farther on.
        is_inside = abs(found - u) < 0.9 * half
        u = found
        if is_inside:
            break
    return u


@compiled
def _zoomed_on_thread(u: float, v: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> tuple[float, float]:
    half, half_v = _TWO_PI / AROUND, bolt[P] / ALONG
    best = depth_at(2, u, v, rot, t, bolt, nut)
    for _ in range(60):
        if half < FINEST:
            break
        at_u, at_v = u, v
        for i in range(-1, 2):
            for j in range(-1, 2):
                # Along the helix and along the axis: overlaps of threads are long along the one, thin along the other.
                w = max(at_v + bolt[LEAD] * half * i / _TWO_PI + half_v * j, 0.0)
                value = depth_at(2, at_u + half * i, w, rot, t, bolt, nut)
                if value > best:
                    best, u, v = value, at_u + half * i, w
        if u == at_u and v == at_v:
            half *= 0.5
            half_v *= 0.5
    return u, v


@compiled
def _thread_slope(x: float, y: float, z: float, profile: Floats) -> Floats:
    """The gradient of the radius less the profile's at a point of a thread's frame, shape (3,)."""
    r = math.sqrt(x * x + y * y)
    turn = profile[LEAD] / _TWO_PI
    s = z - turn * math.atan2(y, x)
    h = SLOPE_STEP * profile[P]
    slope = (radius(s + h, profile) - radius(s - h, profile)) / (2.0 * h)
    return np.array([x / r - slope * turn * y / (r * r), y / r + slope * turn * x / (r * r), -slope])


@compiled
def _mean_slope(
    part: int, u: float, v: float, inside: Floats, face: Floats, rot: Floats, t: Floats, bolt: Floats, nut: Floats
) -> tuple[Floats, bool]:
    """The slope of the depth at a peak, from those of both its numbers; whether that of the thread alone counts."""
    a, b = depths_at(part, u, v, rot, t, bolt, nut)
    scale = radius(0.0, bolt)
    if part == 2 or abs(a - b) > KINK * scale:
        return (inside, True) if a < b else (face, False)
    h = 1e-5
    before, after = depths_at(part, u - h, v, rot, t, bolt, nut), depths_at(part, u + h, v, rot, t, bolt, nut)
    along_a, along_b = after[0] - before[0], after[1] - before[1]
    if along_a * along_b >= 0.0:
        return (inside, True) if a < b else (face, False)
    share = along_b / (along_b - along_a)
    return share * inside + (1.0 - share) * face, False


@compiled
def place_at(part: int, u: float, v: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> Floats:
    """The place nearest to a sample, shape (COLUMNS,)."""
    if part == 2:
        u, v = _zoomed_on_thread(u, v, rot, t, bolt, nut)
    else:
        u = _zoomed_on_edge(part, u, rot, t, bolt, nut)
    place = np.empty(COLUMNS)
    place[PART], place[U], place[V] = part, u, v
    if part == 1:
        r = radius(-nut[LEAD] * u / _TWO_PI, nut)
        point = np.array([r * math.cos(u), r * math.sin(u), 0.0])
        body = rot.T @ (point - t)
        inside, face = -_thread_slope(body[0], body[1], body[2], bolt), np.array([0.0, 0.0, 1.0])
        slope, on_thread = _mean_slope(part, u, v, inside, face, rot, t, bolt, nut)
        normal = rot @ slope
    else:
        r = radius(v - bolt[LEAD] * u / _TWO_PI, bolt)
        body = np.array([r * math.cos(u), r * math.sin(u), v])
        point = rot @ body + t
        inside, face = _thread_slope(point[0], point[1], point[2], nut), np.array([0.0, 0.0, -1.0])
        slope, on_thread = _mean_slope(part, u, v, inside, face, rot, t, bolt, nut)
        normal = -slope
    size = math.sqrt(normal @ normal)
    place[BODY : BODY + 3], place[POINT : POINT + 3], place[NORMAL : NORMAL + 3] = body, point, normal / size
    place[GAP] = -depth_at(part, u, v, rot, t, bolt, nut) / size
    place[ON_THREAD] = 1.0 if on_thread and part != 1 else 0.0
    return place


@compiled
def _edge_peaks(part: int, window: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> Floats:
    """Azimuths of the deepest peaks of each cell of an edge that are less than ``window`` outside."""
    depth = np.empty(EDGE)
    for i in range(EDGE):
        depth[i] = depth_at(part, _TWO_PI * i / EDGE, 0.0, rot, t, bolt, nut)
    found = np.empty(EDGE // CELL)
    count = 0
    for cell in range(EDGE // CELL):
        best = -1
        for i in range(cell * CELL, (cell + 1) * CELL):
            is_peak = depth[i] >= depth[i - 1] and depth[i] >= depth[(i + 1) % EDGE]
            if is_peak and depth[i] > -window and (best < 0 or depth[i] > depth[best]):
                best = i
        if best >= 0:
            found[count] = _TWO_PI * best / EDGE
            count += 1
    return found[:count].copy()


@compiled
def _thread_depths(rows: int, window: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> Floats:
    depth = np.full((AROUND, rows), -1e9)
    for i in range(AROUND):
        u = _TWO_PI * i / AROUND
        c, s = math.cos(u), math.sin(u)
        for j in range(rows):
            v = bolt[P] * j / ALONG
            z = rot[2, 2] * v + t[2] + radius(0.25 * bolt[P], bolt) * (rot[2, 0] * c + rot[2, 1] * s)
            if z < window:
                depth[i, j] = depth_at(2, u, v, rot, t, bolt, nut)
    return depth


@compiled
def _thread_peaks(window: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> Floats:
    """Azimuths and heights of the deepest peaks of each cell of the bolt's thread, shape (n, 2)."""
    tilt = math.sqrt(rot[2, 0] ** 2 + rot[2, 1] ** 2)
    rows = max(int(ALONG * (-t[2] + 1.2 * tilt * bolt[1]) / bolt[P]) + 3, 3)
    depth = _thread_depths(rows, window, rot, t, bolt, nut)
    half = ALONG // 2
    bands = rows // half + 1
    best = np.full((AROUND // THREAD_CELL, bands, 2), -1)
    found = np.empty((AROUND // THREAD_CELL * bands, 2))
    count = 0
    for i in range(AROUND):
        for j in range(1, rows - 1):
            here = depth[i, j]
            if here <= -window or here < depth[i, j - 1] or here < depth[i, j + 1]:
                continue
            if here < depth[i - 1, j] or here < depth[(i + 1) % AROUND, j]:
                continue
            cell, band = i // THREAD_CELL, j // half
            k, m = best[cell, band]
            if k < 0 or here > depth[k, m]:
                best[cell, band, 0], best[cell, band, 1] = i, j
    for cell in range(AROUND // THREAD_CELL):
        for band in range(bands):
            i, j = best[cell, band]
            if i >= 0:
                found[count, 0], found[count, 1] = _TWO_PI * i / AROUND, bolt[P] * j / ALONG
                count += 1
    return found[:count].copy()


@compiled
def near_places(window: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> Floats:
    """All places whose gap is below ``window``, shape (n, COLUMNS)."""
    # A flank is twice as far along the radius as across it.
    raw = 2.5 * window
    first, second = _edge_peaks(0, raw, rot, t, bolt, nut), _edge_peaks(1, raw, rot, t, bolt, nut)
    third = _thread_peaks(raw, rot, t, bolt, nut)
    places = np.empty((len(first) + len(second) + len(third), COLUMNS))
    count = 0
    for k in range(len(places)):
        if k < len(first):
            place = place_at(0, first[k], 0.0, rot, t, bolt, nut)
        elif k < len(first) + len(second):
            place = place_at(1, second[k - len(first)], 0.0, rot, t, bolt, nut)
        else:
            u, v = third[k - len(first) - len(second)]
            place = place_at(2, u, v, rot, t, bolt, nut)
            # Its edge, and where it meets the nut's, are places of their own.
            if place[V] < 1e-3 * bolt[P] or place[POINT + 2] > -1e-4 * bolt[P]:
                continue
        if place[GAP] < window:
            places[count] = place
            count += 1
    return places[:count].copy()
