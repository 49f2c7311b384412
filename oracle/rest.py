"""Where a held bolt rests, by brute force: the potential over densely sampled boundaries, minimised with differences.

The device and its potential are written once more from docs/device.md, and the overlap of a pose is the greatest depth
of sampled points of both edges and of the bolt's thread in the other part, zoomed on where it is near zero. The height
is the one at which that vanishes. A minimum is found by programs on the depths at the peaks among the samples, whose
slopes are differences. Beside a pose the samples that are far from contact there are left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from oracle.compiled import compiled
from oracle.profile import LEAD, R_LARGE, P, bolt_profile, nut_profile, radius
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

EDGE_SAMPLES = 1440
AROUND, ALONG = 360, 80
THREAD_FROM = 2 * EDGE_SAMPLES
"""Samples are numbered: the bolt's edge, the nut's, then the bolt's thread, azimuth by azimuth."""
ALL_SAMPLES = THREAD_FROM + AROUND * (ALONG + 1)
ZOOMS = 40
"""Each narrows a stretch of an edge to 0.6 of its length."""
FINEST = 1e-6
"""Stretch of the thread (rad) that is not narrowed any more: a depth is off by some 1e-12 radii then."""
NEAR = 2e-3
"""Samples whose depth is within this part of the bolt's diameter of the greatest are zoomed on."""
FAR = 0.05
"""Of a point that is by so many radii or more outside the other part's flat face that distance is the answer."""
THREAD_NEAR = 5e-3
"""The same of samples of the thread, which are farther apart."""
TOUCHING = 1e-13
"""Overlap, in diameters, that is a touch: the depth where both edges cross is no better."""
DIFFERENCE = 1e-6
"""Of coordinates over the radius, for slopes of depths."""
LEAST_BOX = 1e-6
"""The smallest box of a program, in diameters."""
BETWEEN = 8
"""Into so many parts the straight way to a place beside is divided, to see whether the potential is higher between."""
REACH = 0.2
"""How far from where it is looked for a height may be, in thread pitches."""
COORDINATES = 5
"""A place: the rotation vector in the commanded bolt's axes, and the shift of the compliance centre across."""
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
        if bz < -FAR * bolt[R_LARGE]:
            return bz
        inside = radius(bz - bolt[LEAD] * math.atan2(by, bx) / _TWO_PI, bolt) - math.sqrt(bx * bx + by * by)
        return min(inside, bz)
    r = radius(v - bolt[LEAD] * u / _TWO_PI, bolt)
    bx, by = r * math.cos(u), r * math.sin(u)
    x = rot[0, 0] * bx + rot[0, 1] * by + rot[0, 2] * v + t[0]
    y = rot[1, 0] * bx + rot[1, 1] * by + rot[1, 2] * v + t[1]
    z = rot[2, 0] * bx + rot[2, 1] * by + rot[2, 2] * v + t[2]
    if z > FAR * bolt[R_LARGE]:
        return -z
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
    while half > FINEST:
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
def sample_depth(i: int, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> float:
    """The depth of the i-th sample."""
    if i < THREAD_FROM:
        return _depth(i // EDGE_SAMPLES, _TWO_PI * (i % EDGE_SAMPLES) / EDGE_SAMPLES, 0.0, rot, t, bolt, nut)
    around, along = divmod(i - THREAD_FROM, ALONG + 1)
    return _depth(2, _TWO_PI * around / AROUND, bolt[P] * along / ALONG, rot, t, bolt, nut)


@compiled
def near_samples(window: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> Indices:
    """The samples whose depth is above ``-window`` (a length)."""
    chosen = np.empty(ALL_SAMPLES, dtype=np.int64)
    count = 0
    for i in range(ALL_SAMPLES):
        if sample_depth(i, rot, t, bolt, nut) > -window:
            chosen[count] = i
            count += 1
    return chosen[:count].copy()


@compiled
def overlap_depth(rot: Floats, t: Floats, chosen: Indices, enough: float, bolt: Floats, nut: Floats) -> float:
    """The greatest depth of a boundary point in the other part; negative where the parts are apart, a length.

    ``chosen`` are the samples that are looked at, in their order. Once a depth is above ``enough`` it is the answer.
    """
    count = len(chosen)
    depth = np.empty(count)
    greatest = -1e9
    for m in range(count):
        depth[m] = sample_depth(chosen[m], rot, t, bolt, nut)
        greatest = max(greatest, depth[m])
        if greatest > enough:
            return greatest
    near = NEAR * 2.0 * bolt[R_LARGE]
    step, length = _TWO_PI / EDGE_SAMPLES, bolt[P]
    edges = 0
    while edges < count and chosen[edges] < THREAD_FROM:
        i = chosen[edges]
        here = depth[edges]
        # At the end of a stretch the neighbour is one that was left out, or the other end of the edge.
        before = depth[edges - 1] if edges > 0 and chosen[edges - 1] == i - 1 else -1e9
        after = depth[edges + 1] if edges + 1 < count and chosen[edges + 1] == i + 1 else -1e9
        if here > greatest - near and here >= before and here >= after:
            part = i // EDGE_SAMPLES
            greatest = max(greatest, _zoom(part, (i % EDGE_SAMPLES) * step, step, 0.0, 0.0, rot, t, bolt, nut))
            if greatest > enough:
                return greatest
        edges += 1
    for m in range(edges, count):
        i, j = divmod(chosen[m] - THREAD_FROM, ALONG + 1)
        here = depth[m]
        if not (j < ALONG and here > greatest - THREAD_NEAR * 2.0 * bolt[R_LARGE]):
            continue
        if (m > edges and chosen[m - 1] == chosen[m] - 1 and depth[m - 1] > here) or (
            m + 1 < count and chosen[m + 1] == chosen[m] + 1 and depth[m + 1] > here
        ):
            continue
        # Its neighbours round the thread are a whole column of samples away.
        is_highest = True
        for column in (-1, 1):
            wanted = THREAD_FROM + (i + column) % AROUND * (ALONG + 1) + j
            k = np.searchsorted(chosen, wanted)
            if k < count and chosen[k] == wanted and depth[k] > here:
                is_highest = False
        if is_highest:
            u, v = _TWO_PI * i / AROUND, length * j / ALONG
            greatest = max(greatest, _zoom(2, u, _TWO_PI / AROUND, v, length / ALONG, rot, t, bolt, nut))
            if greatest > enough:
                return greatest
    return greatest


@compiled
def peak_near(i: int, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> float:
    """The greatest depth near the i-th sample."""
    if i < THREAD_FROM:
        step = _TWO_PI / EDGE_SAMPLES
        return _zoom(i // EDGE_SAMPLES, (i % EDGE_SAMPLES) * step, 2.0 * step, 0.0, 0.0, rot, t, bolt, nut)
    around, along = divmod(i - THREAD_FROM, ALONG + 1)
    u, v = _TWO_PI * around / AROUND, bolt[P] * along / ALONG
    return _zoom(2, u, _TWO_PI / AROUND, v, bolt[P] / ALONG, rot, t, bolt, nut)


@compiled
def peak_samples(window: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> Indices:
    """The samples that are no less deep than those beside them, and deeper than ``-window`` (a length)."""
    depth = np.empty(ALL_SAMPLES)
    for i in range(ALL_SAMPLES):
        depth[i] = sample_depth(i, rot, t, bolt, nut)
    found = np.empty(ALL_SAMPLES, dtype=np.int64)
    count = 0
    for i in range(ALL_SAMPLES):
        if depth[i] <= -window:
            continue
        if i < THREAD_FROM:
            first = i - i % EDGE_SAMPLES
            before, after = first + (i - 1) % EDGE_SAMPLES, first + (i + 1) % EDGE_SAMPLES
            if depth[i] < depth[before] or depth[i] < depth[after]:
                continue
        else:
            around, along = divmod(i - THREAD_FROM, ALONG + 1)
            if along == ALONG or depth[i] < depth[i + 1] or (along > 0 and depth[i] < depth[i - 1]):
                continue
            before = THREAD_FROM + (around - 1) % AROUND * (ALONG + 1) + along
            after = THREAD_FROM + (around + 1) % AROUND * (ALONG + 1) + along
            if depth[i] < depth[before] or depth[i] < depth[after]:
                continue
        found[count] = i
        count += 1
    return found[:count].copy()


@compiled
def touching_height(
    rot: Floats, x: float, y: float, start: float, reach: float, chosen: Indices, bolt: Floats, nut: Floats
) -> float:
    """The height near ``start``, by at most ``reach``, at which the overlap vanishes on the way up; nan: there is
    none.
    """
    t = np.array([x, y, start])
    here = overlap_depth(rot, t, chosen, math.inf, bolt, nut)
    touch = TOUCHING * 2.0 * bolt[R_LARGE]
    if abs(here) < touch:
        return start
    low, high = start, start
    at_low, at_high = here, here
    step = 1e-9 * reach
    while at_high > 0.0:
        low, at_low = high, at_high
        high += max(step, 2.0 * at_high)
        step *= 2.0
        if high > start + reach:
            return math.nan
        t[2] = high
        at_high = overlap_depth(rot, t, chosen, math.inf, bolt, nut)
    while at_low <= 0.0:
        high, at_high = low, at_low
        low -= max(step, -at_low)
        step *= 2.0
        if low < start - reach:
            return math.nan
        t[2] = low
        at_low = overlap_depth(rot, t, chosen, math.inf, bolt, nut)
    side = 0
    for _ in range(60):
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        if high - low < touch:
            return high
        if not low < middle < high:
            middle = 0.5 * (low + high)
        t[2] = middle
        value = overlap_depth(rot, t, chosen, math.inf, bolt, nut)
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
        if abs(value) < touch:
            return middle
    return high


@compiled
def turned(command: Floats, x: float, y: float, z: float) -> Floats:
    """The commanded rotation, turned by a rotation vector in the bolt's axes (Rodrigues)."""
    angle = math.sqrt(x * x + y * y + z * z)
    if angle == 0.0:
        return command.copy()
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return command @ (
        np.eye(3) + math.sin(angle) / angle * cross + (1.0 - math.cos(angle)) / (angle * angle) * cross @ cross
    )


@compiled
def _deviation(place: Floats, up: float, command: Floats, numbers: tuple[float, float, float]) -> Floats:
    """All six coordinates of a place, of which the compliance centre is at the height ``up``."""
    centre, _, first = numbers
    return np.array([place[0], place[1], place[2], place[3], place[4], up - first - centre * command[2, 2]])


@compiled
def _potential(
    place: Floats,
    start: float,
    command: Floats,
    stiffness: Floats,
    numbers: tuple[float, float, float],
    chosen: Indices,
    bolt: Floats,
    nut: Floats,
) -> tuple[float, float]:
    """The potential at a place and the height of the bolt's origin there; infinite where there is no height near."""
    centre, push, _ = numbers
    rot = turned(command, place[0], place[1], place[2])
    x = centre * (command[0, 2] - rot[0, 2]) + place[3]
    y = centre * (command[1, 2] - rot[1, 2]) + place[4]
    height = touching_height(rot, x, y, start, REACH * bolt[P], chosen, bolt, nut)
    if math.isnan(height):
        return math.inf, start
    up = height + centre * rot[2, 2]
    deviation = _deviation(place, up, command, numbers)
    return 0.5 * deviation @ stiffness @ deviation + push * up, height


@compiled
def _is_free(
    place: Floats,
    value: float,
    start: float,
    command: Floats,
    stiffness: Floats,
    numbers: tuple[float, float, float],
    chosen: Indices,
    bolt: Floats,
    nut: Floats,
) -> bool:
    """Whether the parts do not overlap at a place, as high up as the potential is ``value``; ``start`` is any height.

    Nowhere on the axis is the potential that low where the device is stiff along it: then they are not.
    """
    centre, push, _ = numbers
    rot = turned(command, place[0], place[1], place[2])
    t = np.array(
        [centre * (command[0, 2] - rot[0, 2]) + place[3], centre * (command[1, 2] - rot[1, 2]) + place[4], start]
    )
    up = start + centre * rot[2, 2]
    deviation = _deviation(place, up, command, numbers)
    force = stiffness @ deviation
    missing = value - (0.5 * deviation @ force + push * up)
    # The upper root of missing = slope z + stiffness z^2 / 2.
    slope = force[5] + push
    root = slope * slope + 2.0 * stiffness[5, 5] * missing
    if root < 0.0:
        return False
    root = math.sqrt(root)
    t[2] += 2.0 * missing / (slope + root) if slope > 0.0 else (root - slope) / stiffness[5, 5]
    return overlap_depth(rot, t, chosen, 0.0, bolt, nut) <= 0.0


@compiled
def _free_beside(
    place: Floats,
    steps: Floats,
    value: float,
    lower: float,
    start: float,
    command: Floats,
    stiffness: Floats,
    numbers: tuple[float, float, float],
    chosen: Indices,
    bolt: Floats,
    nut: Floats,
) -> tuple[int, int]:
    """At how many places that are so many steps beside one the parts are apart where the potential is lower; of how
    many of them it is higher on the straight way.
    """
    free, beyond = 0, 0
    held = command, stiffness, numbers, chosen, bolt, nut
    for i in range(len(steps)):
        if not _is_free(place + steps[i], value - lower, start, *held):
            continue
        free += 1
        for j in range(1, BETWEEN):
            if not _is_free(place + j / BETWEEN * steps[i], value + lower, start, *held):
                beyond += 1
                break
    return free, beyond


@compiled
def _peaks_and_slopes(
    x: Floats, axes: Indices, command: Floats, centre: float, peaks: Indices, bolt: Floats, nut: Floats
) -> tuple[Floats, Floats]:
    """The depths at peaks, and their central differences by the coordinates on the axes.

    Coordinates are a rotation vector and the compliance centre over the largest radius; so are the depths.
    """
    r = bolt[R_LARGE]
    values = np.empty(len(peaks))
    slopes = np.empty((len(peaks), len(axes)))
    for k in range(2 * len(axes) + 1):
        y = x.copy()
        if k > 0:
            y[axes[(k - 1) // 2]] += DIFFERENCE if k % 2 == 1 else -DIFFERENCE
        rot = turned(command, y[0], y[1], y[2])
        t = r * y[3:6] - centre * rot[:, 2]
        for m in range(len(peaks)):
            depth = peak_near(peaks[m], rot, t, bolt, nut) / r
            if k == 0:
                values[m] = depth
            elif k % 2 == 1:
                slopes[m, (k - 1) // 2] = depth / (2.0 * DIFFERENCE)
            else:
                slopes[m, (k - 1) // 2] -= depth / (2.0 * DIFFERENCE)
    return values, slopes


@dataclass(frozen=True)
class HeldBolt:
    """A device that holds a bolt at a command, its numbers in the pair's unit.

    ``command`` is the commanded rotation, ``first`` the height of the bolt's origin at its first contact, ``stiffness``
    6 x 6, rotation first, and ``centre`` the height of the compliance centre over the base. A place of the bolt is five
    numbers: the rotation vector in the commanded bolt's axes (rad), the third zero of a rigid twist, and the shift of
    the centre across the nut's axis.
    """

    pair: Pair
    command: Floats
    stiffness: Floats
    centre: float
    push: float
    first: float
    twist_is_rigid: bool = True

    @property
    def scale(self) -> Floats:
        """By what a length is multiplied to be a step of each coordinate; zero where it is not free."""
        by_radius = 2.0 / self.pair.nominal_diameter
        return np.array([by_radius, by_radius, 0.0 if self.twist_is_rigid else by_radius, 1.0, 1.0])

    def rotation(self, place: Floats) -> Floats:
        """The rotation at a place."""
        return np.asarray(turned(self.command, *place[:3]))

    def origin(self, place: Floats, height: float) -> Floats:
        """The bolt's origin at a place and a height of it."""
        across = self.centre * (self.command[:2, 2] - self.rotation(place)[:2, 2]) + place[3:]
        return np.array([*across, height])

    def near(self, place: Floats, height: float, size: float) -> Indices:
        """The samples that can touch within steps of a size (a length) from a place."""
        window = 4.0 * size + NEAR * self.pair.nominal_diameter
        rot, bolt, nut = self.rotation(place), bolt_profile(self.pair), nut_profile(self.pair)
        return np.asarray(near_samples(window, rot, self.origin(place, height), bolt, nut))

    def overlap(self, place: Floats, height: float) -> float:
        """How deep the parts overlap at a place; negative where they are apart."""
        rot, bolt, nut = self.rotation(place), bolt_profile(self.pair), nut_profile(self.pair)
        return float(overlap_depth(rot, self.origin(place, height), np.arange(ALL_SAMPLES), math.inf, bolt, nut))

    def potential(
        self, place: Floats, start: float, chosen: Indices | None = None, push: float | None = None
    ) -> tuple[float, float]:
        """The potential at a place, and the height of the bolt's origin there, near ``start``; infinite: it has none.

        ``chosen`` are the samples that are looked at, all unless they are given; so is the push.
        """
        samples = np.arange(ALL_SAMPLES) if chosen is None else chosen
        value, height = _potential(place, start, *self._numbers(push), samples, *self._profiles())
        return float(value), float(height)

    def free_beside(self, place: Floats, height: float, steps: Floats, lower: float) -> tuple[int, int]:
        """At how many places that are so many steps, shape (n, 5), beside one the parts do not overlap where the
        potential is by ``lower`` lower than there; and how many of them lie beyond a barrier.

        That is one by which the potential is higher, by more than ``lower``, on the straight way to the place: they
        are of another minimum.
        """
        free = self.scale > 0.0
        chosen = self.near(place, height, float(np.abs(steps[:, free] / self.scale[free]).max()))
        value, _ = self.potential(place, height, chosen)
        found = _free_beside(place, steps, value, lower, height, *self._numbers(None), chosen, *self._profiles())
        return int(found[0]), int(found[1])

    def is_beyond_barrier(self, place: Floats, height: float, step: Floats, lower: float) -> bool:
        """Whether the potential is higher, by more than ``lower``, on the straight way of a step from a place."""
        samples = np.arange(ALL_SAMPLES)
        value, _ = self.potential(place, height)
        held = (*self._numbers(None), samples, *self._profiles())
        return any(not _is_free(place + j / BETWEEN * step, value + lower, height, *held) for j in range(1, BETWEEN))

    def lowest_by_programs(
        self, place: Floats, height: float, size: float, push: float | None = None
    ) -> tuple[Floats, float, float]:
        """The minimum of the potential near a place, by programs on the depths at peaks: place, height and potential.

        A program has the peaks of where it begins, differences for slopes, and a box of a size (a length), and is
        solved by SLSQP; after it the bolt is raised or lowered until it touches. A box that gains nothing is halved.
        """
        value, height = self.potential(place, height, push=push)
        best = place
        while size > LEAST_BOX * self.pair.nominal_diameter:
            found = self._program(best, height, size, push)
            lowest, there = self.potential(found, height, push=push)
            if lowest < value - 1e-13 * self.push * self.pair.nominal_diameter:
                best, value, height = found, lowest, there
            else:
                size *= 0.25
        return best, height, value

    def _program(self, place: Floats, height: float, size: float, push: float | None) -> Floats:
        bolt, nut = self._profiles()
        r = float(bolt[R_LARGE])
        rot, origin = self.rotation(place), self.origin(place, height)
        peaks = peak_samples(2.0 * size + NEAR * self.pair.nominal_diameter, rot, origin, bolt, nut)
        start = np.concatenate([place[:3], (origin + self.centre * rot[:, 2]) / r])
        axes = np.array([0, 1, 3, 4, 5] if self.twist_is_rigid else [0, 1, 2, 3, 4, 5])
        at_rest = np.array([0.0, 0.0, 0.0, *(self.centre * self.command[:, 2] + np.array([0.0, 0.0, self.first]))])
        lengths = np.array([1.0, 1.0, 1.0, r, r, r])
        weight = (self.push if push is None else push) * r

        def whole(x: Floats) -> Floats:
            y = start.copy()
            y[axes] = x
            return y

        def potential(x: Floats) -> tuple[float, Floats]:
            y = whole(x)
            deviation = lengths * y - at_rest
            force = self.stiffness @ deviation
            slope = lengths * force
            slope[5] += weight
            return (0.5 * deviation @ force + weight * y[5]) / weight, slope[axes] / weight

        last: list[tuple[Floats, Floats, Floats]] = []

        def depths(x: Floats) -> tuple[Floats, Floats]:
            if not last or not np.array_equal(last[0][0], x):
                values, slopes = _peaks_and_slopes(whole(x), axes, self.command, self.centre, peaks, bolt, nut)
                last[:] = [(x.copy(), -values, -slopes)]
            return last[0][1:]

        end = minimize(
            potential,
            start[axes],
            jac=True,
            method="SLSQP",
            bounds=[(x - size / r, x + size / r) for x in start[axes]],
            constraints={
                "type": "ineq",
                "fun": lambda x: depths(x)[0],
                "jac": lambda x: depths(x)[1],
            },
            options={"maxiter": 15, "ftol": 1e-15},
        )
        found = whole(np.asarray(end.x))
        shift = r * found[3:5] - self.centre * self.command[:2, 2]
        return np.concatenate([found[:3], shift])

    def _numbers(self, push: float | None) -> tuple[Floats, Floats, tuple[float, float, float]]:
        return self.command, self.stiffness, (self.centre, self.push if push is None else push, self.first)

    def _profiles(self) -> tuple[Floats, Floats]:
        return bolt_profile(self.pair), nut_profile(self.pair)
