"""The first contact of a bolt with a chamfered base, by dense sampling in vertical columns and polishing.

As :mod:`oracle.first_height`, of a bolt whose side is the lesser of thread and cone. The edge between them is known by
the thread's axial position alone: where the thread's radius is ``f(s)`` the cone has it at one height. Samples run over

- the outline of the base against the nut's column,
- the edge between cone and thread, called the rim, against the nut's column,
- the nut's top edge against the bolt's column,
- the bolt's side against the nut's column,
- the nut's thread against the bolt's base disc.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from oracle.compiled import compiled
from oracle.first_height import nut_top
from oracle.pose import pose_rotation
from oracle.profile import LEAD, R_LARGE, P, bolt_profile, nut_profile, radius
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

OUTLINE, RIM, NUT_EDGE, SIDE, NUT_THREAD = range(5)
"""The sampled features."""
END, SLOPE, TOP = range(3)
"""The cone: its radius at the base, how fast that grows with height, the height at which it leaves the thread."""

_NONE = -1e9
_TWO_PI = 2.0 * math.pi


class Samples(NamedTuple):
    """How densely: along each edge, around and along surfaces (along: per thread pitch), up a column of the bolt."""

    edge: int = 2880
    around: int = 720
    along: int = 60
    steps: int = 200


@dataclass(frozen=True)
class ChamferedHeight:
    """Height of the bolt's origin at the first contact, the point in the nut's frame, and what touches there.

    Of the bolt ``outline``, ``base``, ``rim``, ``cone`` or ``thread``, of the nut ``edge``, ``surface`` or ``thread``.
    """

    height: float
    point: tuple[float, float, float]
    bolt: str
    nut: str


@compiled
def _side(u: float, v: float, bolt: Floats, cone: Floats) -> float:
    return min(radius(v - bolt[LEAD] * u / _TWO_PI, bolt), cone[END] + cone[SLOPE] * v)


@compiled
def _gap(x: float, y: float, z: float, rot: Floats, bolt: Floats, cone: Floats) -> float:
    """How far inside the side a point is that is given about the bolt's origin in the nut's directions."""
    bx = rot[0, 0] * x + rot[1, 0] * y + rot[2, 0] * z
    by = rot[0, 1] * x + rot[1, 1] * y + rot[2, 1] * z
    bz = rot[0, 2] * x + rot[1, 2] * y + rot[2, 2] * z
    return _side(math.atan2(by, bx), bz, bolt, cone) - math.sqrt(bx * bx + by * by)


@compiled
def _drop(x: float, y: float, z: float, rot: Floats, bolt: Floats, cone: Floats, steps: int) -> float:
    """The greatest height of the bolt's origin at which the bolt holds the point; very low if there is none."""
    up = rot[2, 2]
    at_base = z + (rot[0, 2] * x + rot[1, 2] * y) / up
    if _gap(x, y, z - at_base, rot, bolt, cone) >= 0.0:
        return at_base
    step = (bolt[P] + cone[TOP]) / up / steps
    for k in range(1, steps + 1):
        h = at_base - k * step
        if _gap(x, y, z - h, rot, bolt, cone) >= 0.0:
            low, high = h, h + step
            while high - low > 1e-14:
                middle = 0.5 * (low + high)
                if middle <= low or middle >= high:
                    break
                if _gap(x, y, z - middle, rot, bolt, cone) >= 0.0:
                    low = middle
                else:
                    high = middle
            return low
    return _NONE


@compiled
def _place(
    feature: int, u: float, v: float, bolt: Floats, nut: Floats, cone: Floats
) -> tuple[float, float, float, float]:
    """Radius, azimuth and height of a sample in its part's frame, and 0 where it is not there, else 1."""
    if feature == RIM:
        r = radius(u, bolt)
        z = (r - cone[END]) / cone[SLOPE]
        return r, (z - u) * _TWO_PI / bolt[LEAD], z, 1.0 if z >= 0.0 else 0.0
    if feature == OUTLINE:
        return _side(u, 0.0, bolt, cone), u, 0.0, 1.0
    if feature == SIDE:
        z = min(max(v, 0.0), bolt[P] + cone[TOP])
        return _side(u, z, bolt, cone), u, z, 1.0
    z = max(min(v, 0.0), -nut[P] - cone[TOP])
    return radius(z - nut[LEAD] * u / _TWO_PI, nut), u, z, 1.0


@compiled
def _height(
    feature: int, u: float, v: float, rot: Floats, bolt: Floats, nut: Floats, cone: Floats, steps: int
) -> float:
    """The height at which a sample touches."""
    r, azimuth, z, there = _place(feature, u, v, bolt, nut, cone)
    if there == 0.0:
        return _NONE
    x, y = r * math.cos(azimuth), r * math.sin(azimuth)
    if feature == NUT_EDGE:
        return _drop(x, y, 0.0, rot, bolt, cone, steps)
    if feature == NUT_THREAD:
        h = z + (rot[0, 2] * x + rot[1, 2] * y) / rot[2, 2]
        return h if _gap(x, y, z - h, rot, bolt, cone) >= 0.0 else _NONE
    nx = rot[0, 0] * x + rot[0, 1] * y + rot[0, 2] * z
    ny = rot[1, 0] * x + rot[1, 1] * y + rot[1, 2] * z
    nz = rot[2, 0] * x + rot[2, 1] * y + rot[2, 2] * z
    top = nut_top(nx, ny, nut)
    return top - nz if top > _NONE else _NONE


@compiled
def _best_on_curve(
    feature: int, n: int, floor: float, rot: Floats, bolt: Floats, nut: Floats, cone: Floats, steps: int
) -> tuple[float, float]:
    whole = abs(bolt[LEAD]) if feature == RIM else _TWO_PI
    h = np.empty(n)
    for i in range(n):
        h[i] = _height(feature, whole * i / n, 0.0, rot, bolt, nut, cone, steps)
    floor = max(floor, h.max()) - 0.08 * bolt[P]
    best, best_u = _NONE, 0.0
    for i in range(n):
        if h[i] < floor or h[i] <= _NONE or h[i] < h[i - 1] or h[i] < h[(i + 1) % n]:
            continue
        top, u, width = h[i], whole * i / n, whole / n
        while width > 1e-14 * whole:
            middle = u
            for k in range(-16, 17):
                at = middle + width * k / 16.0
                here = _height(feature, at, 0.0, rot, bolt, nut, cone, steps)
                if here > top:
                    top, u = here, at
            width *= 0.125
        if top > best:
            best, best_u = top, u
    return best, best_u


@compiled
def _best_on_surface(
    feature: int,
    around: int,
    along: int,
    floor: float,
    rot: Floats,
    bolt: Floats,
    nut: Floats,
    cone: Floats,
    steps: int,
) -> tuple[float, float, float]:
    length = bolt[P] + cone[TOP]
    rows = math.ceil(along * length / bolt[P])
    sign = 1.0 if feature == SIDE else -1.0
    h = np.empty((around, rows + 1))
    for i in range(around):
        for j in range(rows + 1):
            h[i, j] = _height(feature, _TWO_PI * i / around, sign * length * j / rows, rot, bolt, nut, cone, steps)
    best, best_u, best_v = _NONE, 0.0, 0.0
    for i in range(around):
        for j in range(1, rows):
            here = h[i, j]
            if here < floor or here <= _NONE:
                continue
            highest = True
            for di in range(-1, 2):
                for dj in range(-1, 2):
                    if h[(i + di) % around, j + dj] > here:
                        highest = False
            if not highest:
                continue
            top, u, v = here, _TWO_PI * i / around, sign * length * j / rows
            du, dv = _TWO_PI / around, length / rows
            while du > 1e-9:
                mu, mv = u, v
                for a in range(-4, 5):
                    for b in range(-4, 5):
                        at_u, at_v = mu + du * a / 4.0, mv + dv * b / 4.0
                        found = _height(feature, at_u, at_v, rot, bolt, nut, cone, steps)
                        if found > top:
                            top, u, v = found, at_u, at_v
                if abs(u - mu) < 0.9 * du and abs(v - mv) < 0.9 * dv:
                    du *= 0.5
                    dv *= 0.5
            if top > best:
                best, best_u, best_v = top, u, v
    return best, best_u, best_v


@compiled
def _search(
    rot: Floats, bolt: Floats, nut: Floats, cone: Floats, edge: int, around: int, along: int, steps: int
) -> tuple[Floats, Floats, Floats]:
    """Best height and place of each of the features."""
    h, u, v = np.full(5, _NONE), np.zeros(5), np.zeros(5)
    best = _NONE
    for feature in (OUTLINE, RIM, NUT_EDGE):
        h[feature], u[feature] = _best_on_curve(feature, edge, best, rot, bolt, nut, cone, steps)
        best = max(best, h[feature])
    floor = best - 0.04 * bolt[P]
    for feature in (SIDE, NUT_THREAD):
        h[feature], u[feature], v[feature] = _best_on_surface(
            feature, around, along, floor, rot, bolt, nut, cone, steps
        )
    return h, u, v


def chamfered_height(
    pair: Pair, roll: float, pitch: float, phase: float, samples: Samples | None = None
) -> ChamferedHeight:
    """The first contact of a pose (degrees) of a pair whose bolt has a chamfer, by brute force."""
    assert pair.chamfer is not None
    bolt, nut = bolt_profile(pair), nut_profile(pair)
    end, slope = pair.chamfer.end_diameter / 2.0, 1.0 / math.tan(math.radians(pair.chamfer.angle_deg))
    cone = np.array([end, slope, max(0.0, (bolt[R_LARGE] - end) / slope)])
    rot = pose_rotation(roll, pitch, phase)
    chosen = samples or Samples()
    heights, u, v = _search(rot, bolt, nut, cone, chosen.edge, chosen.around, chosen.along, chosen.steps)
    # An edge is the border of a surface: only a clearly higher sample of the surface makes it a contact of surfaces.
    feature = int(np.argmax(heights - 1e-9 * pair.thread_pitch * np.array([0, 0, 0, 1, 1])))
    h = float(heights[feature])
    r, azimuth, z, _ = _place(feature, float(u[feature]), float(v[feature]), bolt, nut, cone)
    point = np.array([r * math.cos(azimuth), r * math.sin(azimuth), z])
    if feature not in (NUT_EDGE, NUT_THREAD):
        point = rot @ point + np.array([0.0, 0.0, h])
    x, y, z = point.tolist()
    near = 1e-6 * pair.thread_pitch
    return ChamferedHeight(h, (x, y, z), _of_bolt(rot, h, point, bolt, cone, near), _of_nut(x, y, z, nut, near))


def _of_bolt(rot: Floats, h: float, point: Floats, bolt: Floats, cone: Floats, near: float) -> str:
    """What of the bolt is at a point of its boundary."""
    x, y, z = (rot.T @ (point - np.array([0.0, 0.0, h]))).tolist()
    beyond = radius(z - bolt[LEAD] * math.atan2(y, x) / _TWO_PI, bolt) - cone[END] - cone[SLOPE] * z
    if abs(z) < near:
        return "outline" if math.hypot(x, y) > _side(math.atan2(y, x), 0.0, bolt, cone) - near else "base"
    if abs(beyond) < near:
        return "rim"
    return "cone" if beyond > 0.0 else "thread"


def _of_nut(x: float, y: float, z: float, nut: Floats, near: float) -> str:
    """What of the nut is at a point of its boundary."""
    on_thread = abs(radius(z - nut[LEAD] * math.atan2(y, x) / _TWO_PI, nut) - math.hypot(x, y)) < near
    if abs(z) >= near:
        return "thread"
    return "edge" if on_thread else "surface"
