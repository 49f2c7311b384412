"""The first contact by dense sampling in vertical columns, and polishing.

The bolt comes straight down, so it touches the nut at height ``h`` of its origin exactly when some vertical line
holds a nut point at ``z`` and a bolt point at ``z - h`` over the bolt's origin. The greatest such ``h`` is the
greatest of (top of the nut's column) - (bottom of the bolt's column) over all vertical lines; overhangs below do not
matter. Samples run over every feature:

- the bolt's base edge against the nut's column (edge-surface, edge-thread),
- the nut's top edge against the bolt's column (base-edge, thread-edge),
- the bolt's thread surface against the nut's column (thread-thread),
- the nut's thread surface against the bolt's base disc (base-thread, which no check has ever found first).

Crossings of the two outlines (edge-edge) are jumps of the first two and polished as such: a zoom keeps the best sample
in the middle of its window, so it converges on the upper side of a jump as on a smooth maximum.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracle.compiled import compiled
from oracle.pose import pose_rotation
from oracle.profile import LEAD, R_SMALL, P, bolt_profile, nut_profile, radius, ridge_at
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

EDGE_SAMPLES = 2880
"""Samples of an edge curve: an eighth of a degree, 3e-4 in on 1/4-20."""
AROUND, ALONG = 720, 60
"""Samples of a thread surface, around and along the axis."""
COLUMN_STEPS = 100
"""Steps of the march up a bolt column."""

BOLT_EDGE, NUT_EDGE, BOLT_THREAD, NUT_THREAD = range(4)
"""The four sampled features."""

_NONE = -1e9
_TWO_PI = 2.0 * math.pi


@dataclass(frozen=True)
class FirstHeight:
    """Height of the bolt's origin at the first contact, the point in the nut's frame, and the features' names.

    The height is good to 1e-13 in on 1/4-20 (samples 2.7 times as dense change it by 4e-15); the point of a smooth
    maximum, which is polished by its height alone, only to about 3e-7. ``by_feature`` is the best height that samples
    of each feature gave, in the order of ``BOLT_EDGE, ...``.
    """

    height: float
    point: tuple[float, float, float]
    features: str
    by_feature: tuple[float, float, float, float]


@compiled
def nut_top(x: float, y: float, nut: Floats) -> float:
    """Top of the nut's column over (x, y), at most 0; very low where there is none."""
    r = math.sqrt(x * x + y * y)
    if r < nut[R_SMALL]:
        return _NONE
    s = -nut[LEAD] * math.atan2(y, x) / _TWO_PI
    start, end = ridge_at(r, s, nut)
    return start - s if start < s < end else 0.0


@compiled
def bolt_drop(x: float, y: float, z: float, rot: Floats, bolt: Floats) -> float:
    """The greatest height of the bolt's origin (over x = y = 0) at which the bolt holds the point; very low if none."""
    p = bolt[P]
    # The point in the bolt's frame is R^T (x, y, z - h); z_B grows as h sinks.
    across = rot[0, 2] * x + rot[1, 2] * y
    up = rot[2, 2]
    h_base = z + across / up
    before = _height_gap(x, y, z - h_base, rot, bolt)
    if before >= 0.0:
        return h_base
    step = p / up / COLUMN_STEPS
    for k in range(1, COLUMN_STEPS + 1):
        h = h_base - k * step
        if _height_gap(x, y, z - h, rot, bolt) >= 0.0:
            low, high = h, h + step
            while high - low > 1e-14:
                middle = 0.5 * (low + high)
                if middle <= low or middle >= high:
                    break
                if _height_gap(x, y, z - middle, rot, bolt) >= 0.0:
                    low = middle
                else:
                    high = middle
            return low
    return _NONE


@compiled
def _height_gap(x: float, y: float, z: float, rot: Floats, bolt: Floats) -> float:
    bx = rot[0, 0] * x + rot[1, 0] * y + rot[2, 0] * z
    by = rot[0, 1] * x + rot[1, 1] * y + rot[2, 1] * z
    bz = rot[0, 2] * x + rot[1, 2] * y + rot[2, 2] * z
    return radius(bz - bolt[LEAD] * math.atan2(by, bx) / _TWO_PI, bolt) - math.sqrt(bx * bx + by * by)


@compiled
def _height(feature: int, u: float, v: float, rot: Floats, bolt: Floats, nut: Floats) -> float:
    """Height at which the sample (azimuth ``u``, axial position ``v``) of a feature touches."""
    p = bolt[P]
    if feature in (BOLT_EDGE, BOLT_THREAD):
        v = min(max(v, 0.0), p)
        r = radius(v - bolt[LEAD] * u / _TWO_PI, bolt)
        bx, by = r * math.cos(u), r * math.sin(u)
        x = rot[0, 0] * bx + rot[0, 1] * by + rot[0, 2] * v
        y = rot[1, 0] * bx + rot[1, 1] * by + rot[1, 2] * v
        z = rot[2, 0] * bx + rot[2, 1] * by + rot[2, 2] * v
        top = nut_top(x, y, nut)
        return top - z if top > _NONE else _NONE
    v = max(min(v, 0.0), -p)
    r = radius(v - nut[LEAD] * u / _TWO_PI, nut)
    x, y = r * math.cos(u), r * math.sin(u)
    if feature == NUT_EDGE:
        return bolt_drop(x, y, 0.0, rot, bolt)
    h = v + (rot[0, 2] * x + rot[1, 2] * y) / rot[2, 2]
    return h if _height_gap(x, y, v - h, rot, bolt) >= 0.0 else _NONE


@compiled
def _zoom_curve(feature: int, u: float, width: float, rot: Floats, bolt: Floats, nut: Floats) -> tuple[float, float]:
    best = _height(feature, u, 0.0, rot, bolt, nut)
    while width > 1e-14:
        middle = u
        for k in range(-16, 17):
            at = middle + width * k / 16.0
            h = _height(feature, at, 0.0, rot, bolt, nut)
            if h > best:
                best, u = h, at
        width *= 0.125
    return best, u


@compiled
def _zoom_surface(
    feature: int, u: float, v: float, du: float, dv: float, rot: Floats, bolt: Floats, nut: Floats
) -> tuple[float, float, float]:
    best = _height(feature, u, v, rot, bolt, nut)
    while du > 1e-9:
        mu, mv = u, v
        for i in range(-4, 5):
            for j in range(-4, 5):
                at_u, at_v = mu + du * i / 4.0, mv + dv * j / 4.0
                h = _height(feature, at_u, at_v, rot, bolt, nut)
                if h > best:
                    best, u, v = h, at_u, at_v
        if abs(u - mu) < 0.9 * du and abs(v - mv) < 0.9 * dv:
            du *= 0.5
            dv *= 0.5
    return best, u, v


@compiled
def _best_on_curve(feature: int, rot: Floats, bolt: Floats, nut: Floats, slack: float) -> tuple[float, float]:
    n = EDGE_SAMPLES
    h = np.empty(n)
    for i in range(n):
        h[i] = _height(feature, _TWO_PI * i / n, 0.0, rot, bolt, nut)
    floor = h.max() - slack
    best, best_u = _NONE, 0.0
    for i in range(n):
        if h[i] >= floor and h[i] > _NONE and h[i] >= h[i - 1] and h[i] >= h[(i + 1) % n]:
            top, u = _zoom_curve(feature, _TWO_PI * i / n, _TWO_PI / n, rot, bolt, nut)
            if top > best:
                best, best_u = top, u
    return best, best_u


@compiled
def _best_on_surface(feature: int, floor: float, rot: Floats, bolt: Floats, nut: Floats) -> tuple[float, float, float]:
    p = bolt[P]
    sign = 1.0 if feature == BOLT_THREAD else -1.0
    h = np.empty((AROUND, ALONG + 1))
    for i in range(AROUND):
        for j in range(ALONG + 1):
            h[i, j] = _height(feature, _TWO_PI * i / AROUND, sign * p * j / ALONG, rot, bolt, nut)
    best, best_u, best_v = _NONE, 0.0, 0.0
    for i in range(AROUND):
        for j in range(1, ALONG):
            here = h[i, j]
            if here < floor or here <= _NONE:
                continue
            highest = True
            for di in range(-1, 2):
                for dj in range(-1, 2):
                    if h[(i + di) % AROUND, j + dj] > here:
                        highest = False
            if highest:
                top, u, v = _zoom_surface(
                    feature, _TWO_PI * i / AROUND, sign * p * j / ALONG, _TWO_PI / AROUND, p / ALONG, rot, bolt, nut
                )
                if top > best:
                    best, best_u, best_v = top, u, v
    return best, best_u, best_v


@compiled
def _search(rot: Floats, bolt: Floats, nut: Floats, slack: float) -> tuple[Floats, Floats, Floats]:
    """Best height, azimuth and axial position for each of the four features."""
    h, u, v = np.empty(4), np.zeros(4), np.zeros(4)
    h[BOLT_EDGE], u[BOLT_EDGE] = _best_on_curve(BOLT_EDGE, rot, bolt, nut, slack)
    h[NUT_EDGE], u[NUT_EDGE] = _best_on_curve(NUT_EDGE, rot, bolt, nut, slack)
    floor = max(h[BOLT_EDGE], h[NUT_EDGE]) - 0.5 * slack
    h[BOLT_THREAD], u[BOLT_THREAD], v[BOLT_THREAD] = _best_on_surface(BOLT_THREAD, floor, rot, bolt, nut)
    h[NUT_THREAD], u[NUT_THREAD], v[NUT_THREAD] = _best_on_surface(NUT_THREAD, floor, rot, bolt, nut)
    return h, u, v


def first_height(pair: Pair, roll: float, pitch: float, phase: float) -> FirstHeight:
    """The first contact of a pose (degrees), by brute force."""
    bolt, nut = bolt_profile(pair), nut_profile(pair)
    rot = pose_rotation(roll, pitch, phase)
    slack = 0.08 * pair.thread_pitch
    heights, u, v = _search(rot, bolt, nut, slack)
    # An edge is the border of a surface: only a clearly higher sample of the surface makes it a contact of surfaces.
    feature = int(np.argmax(heights - 1e-11 * np.array([0, 0, 1, 1])))
    h = float(heights[feature])
    if feature in (BOLT_EDGE, BOLT_THREAD):
        r = radius(v[feature] - bolt[LEAD] * u[feature] / _TWO_PI, bolt)
        point = rot @ np.array([r * math.cos(u[feature]), r * math.sin(u[feature]), v[feature]]) + np.array([0, 0, h])
    else:
        r = radius(v[feature] - nut[LEAD] * u[feature] / _TWO_PI, nut)
        point = np.array([r * math.cos(u[feature]), r * math.sin(u[feature]), v[feature]])
    x, y, z = (float(c) for c in point)
    features = features_at(pair, rot, h, (x, y, z))
    b0, b1, b2, b3 = (float(c) for c in heights)
    return FirstHeight(h, (x, y, z), features, (b0, b1, b2, b3))


def features_at(pair: Pair, rot: Floats, h: float, point: tuple[float, float, float]) -> str:
    """Which features meet at a contact, the bolt's first: each by what the point lies on to 1e-8 in on 1/4-20."""
    near = 1e-8 * pair.nominal_diameter / 0.25
    bolt, nut = bolt_profile(pair), nut_profile(pair)
    x, y, z = point
    bx, by, bz = (float(c) for c in rot.T @ np.array([x, y, z - h]))
    bolt_on_thread = abs(radius(bz - bolt[LEAD] * math.atan2(by, bx) / _TWO_PI, bolt) - math.hypot(bx, by)) < near
    nut_on_thread = abs(radius(z - nut[LEAD] * math.atan2(y, x) / _TWO_PI, nut) - math.hypot(x, y)) < near
    bolt_on_base, nut_on_top = abs(bz) < near, abs(z) < near
    first = "edge" if bolt_on_base and bolt_on_thread else "base" if bolt_on_base else "thread"
    second = "edge" if nut_on_top and nut_on_thread else "surface" if nut_on_top else "thread"
    return f"{first}-{second}"
