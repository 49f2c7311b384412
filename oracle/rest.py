"""Where a held bolt rests, by brute force: the potential over densely sampled boundaries, minimised without
derivatives.

The device and its potential are written once more from docs/device.md, and the overlap of a pose is the greatest depth
of sampled points of both edges and of the bolt's thread in the other part, zoomed on where it is near zero. The height
is the one at which that vanishes; the other coordinates are found by a simplex search (Nelder and Mead), restarted
until it gains nothing.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracle.compiled import compiled
from oracle.pose import turn_about
from oracle.profile import LEAD, R_LARGE, P, bolt_profile, nut_profile, radius
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

EDGE_SAMPLES = 1440
AROUND, ALONG = 360, 40
ZOOMS = 40
"""Each narrows a stretch of an edge to 0.6 of its length."""
NEAR = 2e-3
"""Samples whose depth is within this part of the bolt's diameter of the greatest are zoomed on."""
_TWO_PI = 2.0 * math.pi


@compiled
def _depth(part: int, u: float, v: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> float:
    """How deep a point is in the other part: of the bolt's edge (0), the nut's edge (1) or the bolt's thread (2)."""
    if part == 1:
        r = radius(-nut[LEAD] * u / _TWO_PI, nut)
        x, y, z = r * math.cos(u) - t[0], r * math.sin(u) - t[1], -t[2]
        bx = rot[0, 0] * x + rot[1, 0] * y + rot[2, 0] * z
        by = rot[0, 1] * x + rot[1, 1] * y + rot[2, 1] * z
        bz = rot[0, 2] * x + rot[1, 2] * y + rot[2, 2] * z
        inside = radius(bz - bolt[LEAD] * math.atan2(by, bx) / _TWO_PI, bolt) - math.sqrt(bx * bx + by * by)
        return min(inside, bz)
    r = radius(v - bolt[LEAD] * u / _TWO_PI, bolt)
    bx, by = r * math.cos(u), r * math.sin(u)
    x = rot[0, 0] * bx + rot[0, 1] * by + rot[0, 2] * v + t[0]
    y = rot[1, 0] * bx + rot[1, 1] * by + rot[1, 2] * v + t[1]
    z = rot[2, 0] * bx + rot[2, 1] * by + rot[2, 2] * v + t[2]
    inside = math.sqrt(x * x + y * y) - radius(z - nut[LEAD] * math.atan2(y, x) / _TWO_PI, nut)
    return min(inside, -z)


@compiled
def _zoom(
    part: int, u: float, half: float, v: float, half_v: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats
) -> float:
    """The greatest depth near a sample: golden sections along an edge, a shrinking grid on the thread."""
    if part < 2:
        low, high = u - half, u + half
        for _ in range(ZOOMS):
            a, b = low + 0.382 * (high - low), low + 0.618 * (high - low)
            if _depth(part, a, 0.0, rot, t, bolt, nut) > _depth(part, b, 0.0, rot, t, bolt, nut):
                high = b
            else:
                low = a
        return _depth(part, 0.5 * (low + high), 0.0, rot, t, bolt, nut)
    best = _depth(part, u, v, rot, t, bolt, nut)
    while half > 1e-7:
        at_u, at_v = u, v
        for i in range(-2, 3):
            for j in range(-2, 3):
                # Along the helix and along the axis: overlaps of threads are long along the one, thin along the other.
                du, dv = half * i / 2.0, half_v * j / 2.0
                w = max(at_v + bolt[LEAD] * du / _TWO_PI + dv, 0.0)
                value = _depth(part, at_u + du, w, rot, t, bolt, nut)
                if value > best:
                    best, u, v = value, at_u + du, w
        if abs(u - at_u) < 0.9 * half and abs(v - at_v) < 0.9 * half_v:
            half *= 0.6
            half_v *= 0.6
    return best


@compiled
def overlap_depth(rot: Floats, t: Floats, bolt: Floats, nut: Floats, with_thread: bool) -> float:
    """The greatest depth of a boundary point in the other part; negative where the parts are apart, a length."""
    depth = np.empty(EDGE_SAMPLES)
    greatest = -1e9
    near = NEAR * 2.0 * bolt[R_LARGE]
    step = _TWO_PI / EDGE_SAMPLES
    for part in range(2):
        for i in range(EDGE_SAMPLES):
            depth[i] = _depth(part, i * step, 0.0, rot, t, bolt, nut)
        top = max(depth.max(), greatest)
        for i in range(EDGE_SAMPLES):
            if depth[i] > top - near and depth[i] >= depth[i - 1] and depth[i] >= depth[(i + 1) % EDGE_SAMPLES]:
                greatest = max(greatest, _zoom(part, i * step, step, 0.0, 0.0, rot, t, bolt, nut))
    if with_thread:
        length = 0.5 * bolt[P]
        grid = np.empty((AROUND, ALONG + 1))
        for i in range(AROUND):
            for j in range(ALONG + 1):
                grid[i, j] = _depth(2, _TWO_PI * i / AROUND, length * j / ALONG, rot, t, bolt, nut)
        for i in range(AROUND):
            for j in range(1, ALONG):
                here = grid[i, j]
                if (
                    here > greatest - near
                    and here >= grid[i - 1, j]
                    and here >= grid[(i + 1) % AROUND, j]
                    and here >= grid[i, j - 1]
                    and here >= grid[i, j + 1]
                ):
                    value = _zoom(
                        2, _TWO_PI * i / AROUND, _TWO_PI / AROUND, length * j / ALONG, length / ALONG, rot, t, bolt, nut
                    )
                    greatest = max(greatest, value)
    return greatest


@compiled
def touching_height(
    rot: Floats, x: float, y: float, start: float, reach: float, bolt: Floats, nut: Floats, with_thread: bool
) -> float:
    """The height near ``start``, by at most ``reach``, at which the overlap vanishes on the way up; nan: there is
    none.
    """
    t = np.array([x, y, start])
    here = overlap_depth(rot, t, bolt, nut, with_thread)
    low, high = start, start
    at_low, at_high = here, here
    step = 1e-3 * reach
    while at_high > 0.0:
        low, at_low = high, at_high
        high += max(step, at_high)
        step *= 2.0
        if high > start + reach:
            return math.nan
        t[2] = high
        at_high = overlap_depth(rot, t, bolt, nut, with_thread)
    while at_low <= 0.0:
        high, at_high = low, at_low
        low -= max(step, -at_low)
        step *= 2.0
        if low < start - reach:
            return math.nan
        t[2] = low
        at_low = overlap_depth(rot, t, bolt, nut, with_thread)
    side = 0
    for _ in range(60):
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        if not low < middle < high or high - low < 1e-14:
            return high
        t[2] = middle
        value = overlap_depth(rot, t, bolt, nut, with_thread)
        if value > 0.0:
            low, at_low = middle, value
            if side == 1:
                at_high *= 0.5
            side = 1
        else:
            high, at_high = middle, value
            if side == -1:
                at_low *= 0.5
            side = -1
        if abs(value) < 1e-15:
            return middle
    return high


@dataclass(frozen=True)
class HeldBolt:
    """A device that holds a bolt at a command, its numbers in the pair's unit; the twist is rigid.

    ``command`` is the commanded rotation; ``centre`` the height of the compliance centre over the base.
    """

    pair: Pair
    command: Floats
    k_lateral: float
    k_tilt: float
    centre: float
    push: float

    def rotation(self, tilt: Floats) -> Floats:
        """The rotation of a rotation vector about the commanded bolt's x and y."""
        angle = float(np.hypot(*tilt))
        if angle == 0.0:
            return self.command
        return self.command @ turn_about(np.array([*tilt, 0.0]), math.degrees(angle))

    def height(self, place: Floats, start: float, *, with_thread: bool) -> float:
        """The height of the bolt's origin at (two angles, shift of the centre across), near ``start``."""
        rot = self.rotation(place[:2])
        at_rest = self.centre * self.command[:, 2]
        x, y = at_rest[:2] + place[2:] - self.centre * rot[:2, 2]
        bolt, nut = bolt_profile(self.pair), nut_profile(self.pair)
        reach = 0.2 * self.pair.thread_pitch
        return float(touching_height(rot, x, y, start, reach, bolt, nut, with_thread))

    def potential(self, place: Floats, start: float, push: float, *, with_thread: bool) -> tuple[float, float]:
        """The potential at a place, and the height of the bolt's origin there; infinite where it finds no height."""
        height = self.height(place, start, with_thread=with_thread)
        if math.isnan(height):
            return math.inf, start
        energy = 0.5 * self.k_tilt * float(place[:2] @ place[:2]) + 0.5 * self.k_lateral * float(place[2:] @ place[2:])
        return energy + push * (height + self.centre * float(self.rotation(place[:2])[2, 2])), height


def lowest_near(
    held: HeldBolt, place: Floats, start: float, push: float, size: float, least: float, *, with_thread: bool
) -> tuple[Floats, float, float]:
    """The minimum of the potential that a simplex of a size (lengths; angles over the radius) leads to from a place.

    Returns the place, the height of the bolt's origin and the potential. The search is restarted from where it ended,
    with ever smaller simplices, down to the size ``least``.
    """
    scale = np.array([2.0 / held.pair.nominal_diameter] * 2 + [1.0, 1.0])
    best, (value, height) = place, held.potential(place, start, push, with_thread=with_thread)
    while True:
        near = height

        def at(point: Floats, near: float = near) -> float:
            return held.potential(point, near, push, with_thread=with_thread)[0]

        found, lowest = _simplex(at, best, size * scale)
        if lowest < value:
            best = found
            value, height = held.potential(best, near, push, with_thread=with_thread)
        if size <= least:
            return best, height, value
        size *= 0.3


def _simplex(function: Callable[[Floats], float], start: Floats, sizes: Floats) -> tuple[Floats, float]:
    """The downhill simplex from ``start`` until it has shrunk to a thousandth."""
    count = len(start)
    points = np.array([start, *(start + np.eye(count)[i] * sizes[i] for i in range(count))])
    values = np.array([function(point) for point in points])
    for _ in range(200 * count):
        order = np.argsort(values)
        points, values = points[order], values[order]
        if np.max(np.abs(points[1:] - points[0]) / sizes) < 1e-3:
            break
        middle = points[:-1].mean(axis=0)
        for factor in (1.0, 2.0, 0.5, -0.5):
            trial = middle + factor * (middle - points[-1])
            value = function(trial)
            if factor == 1.0:
                reflected, at_reflected = trial, value
                if values[0] <= value < values[-2]:
                    points[-1], values[-1] = trial, value
                    break
                if value >= values[-2]:
                    continue
            elif factor == 2.0:
                if at_reflected >= values[0]:
                    continue
                points[-1], values[-1] = (trial, value) if value < at_reflected else (reflected, at_reflected)
                break
            elif factor == 0.5:
                if at_reflected < values[-1] and value <= at_reflected:
                    points[-1], values[-1] = trial, value
                    break
            elif value < values[-1]:
                points[-1], values[-1] = trial, value
                break
        else:
            points[1:] = points[0] + 0.5 * (points[1:] - points[0])
            values[1:] = [function(point) for point in points[1:]]
    best = int(np.argmin(values))
    return points[best], float(values[best])
