"""The least vertical lift after which bolt and nut do not overlap, by brute force.

While the bolt rises, a point of its surface is inside the nut during intervals of height that are known in closed form,
and a point of the nut's outline is inside the bolt during intervals found by a march. The lift grows to the greatest
end of an interval that holds it, over samples of the bolt's base outline, the nut's top outline, the bolt's thread
surface and, as overlaps at sharp corners are narrow, the helices of both crests' corners, each polished, on the edges
down the bolt's thread, too; once no interval holds it the solids are apart. The first such lift counts, even if a
greater one would make them meet again.

What is at most ``TOUCH`` thread pitches deep in radius touches and does not overlap: a crest that slides up a root
does not hold the bolt.

Resolution: overlaps that end within ``NEAR`` thread pitches below the lift at some sample are polished; a sample that
lies in a hole narrower than that counts as inside.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from oracle.compiled import compiled
from oracle.profile import (
    FALLING,
    LEAD,
    Q_FLANK_LARGE,
    Q_FLANK_SMALL,
    Q_LARGE,
    Q_SMALL,
    R_SMALL,
    RISING,
    P,
    bolt_profile,
    nut_profile,
    radius,
    ridge_at,
)
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

NEAR = 0.01
TOUCH = 1e-12
BOLT_EDGE, NUT_EDGE, BOLT_THREAD, BOLT_CORNER, OTHER_BOLT_CORNER, NUT_CORNER, OTHER_NUT_CORNER = range(7)
EDGE_SAMPLES, AROUND, ALONG = 2880, 480, 48
_STEPS = 100
_NONE = -1e9
_TWO_PI = 2.0 * math.pi


@compiled
def _nut_top_near(x: float, y: float, z: float, near: float, nut: Floats) -> float:
    """Top of the interval of the nut's column that holds ``z``, else of one that ends less than ``near`` below it."""
    r = math.sqrt(x * x + y * y)
    p = nut[P]
    if r < nut[R_SMALL] or z < -p:
        return _NONE
    start = -nut[LEAD] * math.atan2(y, x) / _TWO_PI
    s = start + z
    ridge, end = ridge_at(r, s, nut)
    if not ridge < s < end:
        # In the nut's material, which goes up to the next ridge of the hole or to the nut's surface.
        ahead = ridge if s <= ridge else ridge + p
        top = min(0.0, ahead - start)
        return top if z - top < near else _NONE
    top = min(0.0, ridge - start)
    return top if z - top < near and top >= -p else _NONE


@compiled
def _height_gap(x: float, y: float, z: float, rot: Floats, bolt: Floats) -> tuple[float, float]:
    bx = rot[0, 0] * x + rot[1, 0] * y + rot[2, 0] * z
    by = rot[0, 1] * x + rot[1, 1] * y + rot[2, 1] * z
    bz = rot[0, 2] * x + rot[1, 2] * y + rot[2, 2] * z
    return radius(bz - bolt[LEAD] * math.atan2(by, bx) / _TWO_PI, bolt) - math.sqrt(bx * bx + by * by), bz


@compiled
def _leaves_bolt(x: float, y: float, z: float, lift: float, near: float, rot: Floats, bolt: Floats) -> float:
    """The lift at which a nut point (relative to the bolt's origin) leaves the bolt that holds it near ``lift``."""
    p = bolt[P]
    step = p / rot[2, 2] / _STEPS
    inside = lift
    gap, bz = _height_gap(x, y, z - inside, rot, bolt)
    k = 0
    while gap < 0.0 or bz < 0.0 or bz > p:
        k += 1
        if k > 4:
            return _NONE
        inside = lift - near * k / 4.0
        gap, bz = _height_gap(x, y, z - inside, rot, bolt)
    end = inside + bz / rot[2, 2]
    low = inside
    while low < end:
        high = min(low + step, end)
        if _height_gap(x, y, z - high, rot, bolt)[0] < 0.0:
            while high - low > 1e-15:
                middle = 0.5 * (low + high)
                if middle <= low or middle >= high:
                    break
                if _height_gap(x, y, z - middle, rot, bolt)[0] >= 0.0:
                    low = middle
                else:
                    high = middle
            return low
        low = high
    return end


@compiled
def _corner(inner: int, outer: int, side: int, profile: Floats) -> float:
    """The axial position midway between two boundaries of a side, those at a corner."""
    q = 0.5 * (profile[inner + side] + profile[outer + side])
    return 0.25 * profile[P] + (-q if side == RISING else q)


@compiled
def _end(
    feature: int, u: float, v: float, lift: float, near: float, rot: Floats, t: Floats, b: Floats, n: Floats
) -> float:
    """The lift at which a sample of a feature stops overlapping, if it overlaps at ``lift`` or did so just below it."""
    if feature == NUT_EDGE:
        r = radius(-n[LEAD] * u / _TWO_PI, n) + TOUCH * n[P]
        return _leaves_bolt(r * math.cos(u) - t[0], r * math.sin(u) - t[1], -t[2], lift, near, rot, b)
    if feature >= NUT_CORNER:
        s = _corner(Q_FLANK_SMALL, Q_SMALL, RISING if feature == NUT_CORNER else FALLING, n)
        r, z = radius(s, n) + TOUCH * n[P], s + n[LEAD] * u / _TWO_PI
        z -= n[P] * (math.floor(z / n[P]) + 1.0)
        return _leaves_bolt(r * math.cos(u) - t[0], r * math.sin(u) - t[1], z - t[2], lift, near, rot, b)
    if feature >= BOLT_CORNER:
        side = RISING if feature == BOLT_CORNER else FALLING
        v = _corner(Q_LARGE, Q_FLANK_LARGE, side, b) + b[LEAD] * u / _TWO_PI
        v -= b[P] * math.floor(v / b[P])
    v = min(max(v, 0.0), b[P])
    r = radius(v - b[LEAD] * u / _TWO_PI, b) - TOUCH * b[P]
    bx, by = r * math.cos(u), r * math.sin(u)
    x = rot[0, 0] * bx + rot[0, 1] * by + rot[0, 2] * v + t[0]
    y = rot[1, 0] * bx + rot[1, 1] * by + rot[1, 2] * v + t[1]
    z = rot[2, 0] * bx + rot[2, 1] * by + rot[2, 2] * v + t[2]
    top = _nut_top_near(x, y, z + lift, near, n)
    return top - z if top > _NONE else _NONE


@compiled
def _zoom(
    feature: int, u: float, v: float, lift: float, near: float, rot: Floats, t: Floats, b: Floats, n: Floats
) -> tuple[float, float, float]:
    """The greatest end that grids around a sample, each finer than the one before, find; and where."""
    best = _end(feature, u, v, lift, near, rot, t, b, n)
    du = _TWO_PI / (AROUND if feature == BOLT_THREAD else EDGE_SAMPLES)
    dv = b[P] / ALONG if feature == BOLT_THREAD else 0.0
    half = 4 if feature == BOLT_THREAD else 16
    other = half if feature == BOLT_THREAD else 0
    while du > (1e-9 if feature == BOLT_THREAD else 1e-14):
        mu, mv = u, v
        for i in range(-half, half + 1):
            for j in range(-other, other + 1):
                at_u, at_v = mu + du * i / half, mv + dv * j / half
                e = _end(feature, at_u, at_v, lift, near, rot, t, b, n)
                if e > best:
                    best, u, v = e, at_u, at_v
        if feature != BOLT_THREAD:
            du *= 0.125
        elif abs(u - mu) < 0.9 * du and abs(v - mv) < 0.9 * dv:
            du *= 0.5
            dv *= 0.5
    return best, u, v


@compiled
def _beside_edge(feature: int, u: float, lift: float, rot: Floats, t: Floats, n: Floats) -> tuple[float, float]:
    """The place on the bolt's thread of a point of either edge after a lift: below it threads may overlap longer."""
    if feature == BOLT_EDGE:
        return u, 0.0
    r = radius(-n[LEAD] * u / _TWO_PI, n)
    x, y, z = r * math.cos(u) - t[0], r * math.sin(u) - t[1], -t[2] - lift
    across, along = rot[0, 0] * x + rot[1, 0] * y + rot[2, 0] * z, rot[0, 1] * x + rot[1, 1] * y + rot[2, 1] * z
    return math.atan2(along, across), rot[0, 2] * x + rot[1, 2] * y + rot[2, 2] * z


@compiled
def _greatest_end(lift: float, near: float, rot: Floats, t: Floats, b: Floats, n: Floats) -> float:
    best = _NONE
    for feature in range(7):
        rows = 1 if feature != BOLT_THREAD else ALONG
        count = AROUND if feature == BOLT_THREAD else EDGE_SAMPLES
        e = np.empty((count, rows))
        for i in range(count):
            for j in range(rows):
                v = b[P] * (j + 1) / ALONG if feature == BOLT_THREAD else 0.0
                e[i, j] = _end(feature, _TWO_PI * i / count, v, lift, near, rot, t, b, n)
        floor = max(best, e.max()) - near
        for i in range(count):
            for j in range(rows):
                here = e[i, j]
                if here < floor or here <= _NONE or here < e[i - 1, j] or here < e[(i + 1) % count, j]:
                    continue
                if (j > 0 and here < e[i, j - 1]) or (j < rows - 1 and here < e[i, j + 1]):
                    continue
                v = b[P] * (j + 1) / ALONG if feature == BOLT_THREAD else 0.0
                end, at, _ = _zoom(feature, _TWO_PI * i / count, v, lift, near, rot, t, b, n)
                best = max(best, end)
                if feature <= NUT_EDGE:
                    theta, z = _beside_edge(feature, at, end, rot, t, n)
                    best = max(best, _zoom(BOLT_THREAD, theta, z, lift, near, rot, t, b, n)[0])
    return best


def least_lift(pair: Pair, rotation: Floats, translation: Floats) -> float:
    """The least lift >= 0 along the nut's +z after which the solids do not overlap, to about 1e-10 of the thread pitch.

    The pose is ``x_nut = rotation x_bolt + translation``.
    """
    rot, t = np.ascontiguousarray(rotation, dtype=np.float64), np.asarray(translation, dtype=np.float64)
    b, n = bolt_profile(pair), nut_profile(pair)
    near = NEAR * pair.thread_pitch
    lift = 0.0
    while True:
        end = _greatest_end(lift, near, rot, t, b, n)
        if end <= lift + 1e-12:
            return lift
        lift = float(end)
