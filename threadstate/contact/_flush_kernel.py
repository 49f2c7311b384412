"""The patch on which a bolt's base lies flush on the nut's surface, and its extreme points."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._branchless_kernel import azimuth, profile_numbers, radius_and_slope, sine_cosine
from threadstate.contact._geometry_kernel import TWO_PI, edge_point
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

OUTLINE_SAMPLES = 64
OUTLINE_POINTS = OUTLINE_SAMPLES + 1

ON_OUTLINE = 1e-9
"""How far from the nut's outline, in major radii, a sample is of which an exact distance tells on which side it is: the
root between two samples is bracketed by the same numbers."""

# An extreme point: azimuth on the bolt, whether it lies on the nut's outline too (1.0 or 0.0), x, y.
XP_THETA, XP_CORNER, XP_X, XP_Y = range(4)
EXTREME_SIZE = 4


@kernel()
def base_outline(theta: float, pose: Array, bolt: Array) -> tuple[float, float, float, float]:
    """The edge point of the bolt at ``theta`` in the nut's plane, and its derivative; the bolt is flush."""
    x, y, dx, dy = edge_point(theta, bolt)
    return (
        pose[0] * x + pose[1] * y + pose[9],
        pose[3] * x + pose[4] * y + pose[10],
        pose[0] * dx + pose[1] * dy,
        pose[3] * dx + pose[4] * dy,
    )


@kernel()
def distance_of_point(x: float, y: float, nut: Array) -> float:
    """How far a point of the nut's plane lies outside the nut's outline, radially."""
    return math.hypot(x, y) - pk.radius(-nut[pk.LEAD] / TWO_PI * math.atan2(y, x), nut)


@kernel()
def distance_outside(theta: float, pose: Array, bolt: Array, nut: Array) -> float:
    """How far the bolt's edge at ``theta`` lies outside the nut's outline, radially."""
    x, y, _, _ = base_outline(theta, pose, bolt)
    return distance_of_point(x, y, nut)


@kernel()
def outline_root(a: float, b: float, corner: bool, nx: float, ny: float, pose: Array, bolt: Array, nut: Array) -> float:
    """Azimuth in [a, b] where the outlines cross (``corner``) or the edge runs across (nx, ny) (Illinois)."""
    fa = outline_value(a, corner, nx, ny, pose, bolt, nut)
    fb = outline_value(b, corner, nx, ny, pose, bolt, nut)
    wa, wb = fa, fb
    side = 0
    for _ in range(100):
        c = (a * wb - b * wa) / (wb - wa)
        if not a < c < b:
            c = 0.5 * (a + b)
        fc = outline_value(c, corner, nx, ny, pose, bolt, nut)
        if (fc > 0.0) == (fa > 0.0):
            a, fa, wa = c, fc, fc
            if side == -1:
                wb *= 0.5
            side = -1
        else:
            b, fb, wb = c, fc, fc
            if side == 1:
                wa *= 0.5
            side = 1
        if fc == 0.0 or b - a <= 4e-16 * (1.0 + abs(a)):
            break
    return a if abs(fa) < abs(fb) else b


@kernel()
def outline_value(theta: float, corner: bool, nx: float, ny: float, pose: Array, bolt: Array, nut: Array) -> float:
    """The function whose root :func:`outline_root` finds."""
    if corner:
        return distance_outside(theta, pose, bolt, nut)
    _, _, dx, dy = base_outline(theta, pose, bolt)
    return nx * dx + ny * dy


@kernel(contract=True)
def set_outline_samples(pose: Array, bolt: Array, nut: Array, theta: Array, place: Array, over: Array) -> None:
    """Samples of the bolt's outline all around: azimuths, points with tangents, and how far they are over the nut.

    ``place`` has a row for each of x, y, dx and dy. Samples tell where the outline is looked at exactly.
    """
    k = bolt[pk.LEAD] / TWO_PI
    bolt_numbers, nut_numbers = profile_numbers(bolt), profile_numbers(nut)
    xx, xy, yx, yy, ox, oy = pose[0], pose[1], pose[3], pose[4], pose[9], pose[10]
    for i in range(OUTLINE_POINTS):
        angle = TWO_PI * i / OUTLINE_SAMPLES
        sine, cosine = sine_cosine(angle)
        r, slope, _, _ = radius_and_slope(-k * angle, bolt_numbers)
        bx, by, dr = r * cosine, r * sine, -k * slope
        dx, dy = dr * cosine - by, dr * sine + bx
        x, y = xx * bx + xy * by + ox, yx * bx + yy * by + oy
        away = math.sqrt(x * x + y * y)
        of_nut, _, _, _ = radius_and_slope(-k * azimuth(x, y, away), nut_numbers)
        theta[i], over[i] = angle, away - of_nut
        place[0, i], place[1, i], place[2, i], place[3, i] = x, y, xx * dx + xy * dy, yx * dx + yy * dy
    for i in range(OUTLINE_POINTS):
        if abs(over[i]) < ON_OUTLINE * bolt[pk.R_MAJOR]:
            over[i] = distance_outside(theta[i], pose, bolt, nut)


@kernel()
def set_corners(pose: Array, bolt: Array, nut: Array, theta: Array, over: Array, corners: Array) -> int:
    """Where the bolt's outline crosses the nut's: azimuth and place of each; returns how many."""
    count = 0
    for i in range(OUTLINE_SAMPLES):
        if (over[i] > 0.0) != (over[i + 1] > 0.0):
            t = outline_root(theta[i], theta[i + 1], True, 0.0, 0.0, pose, bolt, nut)
            corners[count, 0] = t
            corners[count, 1], corners[count, 2], _, _ = base_outline(t, pose, bolt)
            count += 1
    return count


@kernel()
def extreme_points(pose: Array, bolt: Array, nut: Array, ax: float, ay: float, out: Array) -> int:
    """The patch's farthest points across the axis (ax, ay) (left, then right) and along it (forth, then back).

    They are points of the bolt's outline: where it runs across the direction, or at a corner of the patch (where it
    crosses the nut's outline). Returns how many differ; 0 where the outlines do not overlap.
    """
    theta, over = scratch(OUTLINE_POINTS), scratch(OUTLINE_POINTS)
    place, corners = scratch(4, OUTLINE_POINTS), scratch(OUTLINE_SAMPLES, 3)
    set_outline_samples(pose, bolt, nut, theta, place, over)
    corner_count = set_corners(pose, bolt, nut, theta, over, corners)
    count = 0
    for turn in range(4):
        nx = (-ay, ay, ax, -ax)[turn]
        ny = (ax, -ax, ay, -ay)[turn]
        best = -math.inf
        best_theta = 0.0
        is_corner = False
        for i in range(OUTLINE_SAMPLES):
            reach = nx * place[0, i] + ny * place[1, i]
            if over[i] > 0.0 and reach > best:
                best = reach
                best_theta = theta[i]
            if nx * place[2, i] + ny * place[3, i] > 0.0 and nx * place[2, i + 1] + ny * place[3, i + 1] <= 0.0:
                t = outline_root(theta[i], theta[i + 1], False, nx, ny, pose, bolt, nut)
                x, y, _, _ = base_outline(t, pose, bolt)
                if nx * x + ny * y >= best and distance_outside(t, pose, bolt, nut) >= 0.0:
                    best = nx * x + ny * y
                    best_theta = t
        for i in range(corner_count):
            reach = nx * corners[i, 1] + ny * corners[i, 2]
            if reach > best:
                best = reach
                best_theta = corners[i, 0]
                is_corner = True
        if best == -math.inf:
            return 0
        x, y, _, _ = base_outline(best_theta, pose, bolt)
        new = True
        for i in range(count):
            if abs(out[i, XP_X] - x) + abs(out[i, XP_Y] - y) < 1e-6 * bolt[pk.R_MAJOR]:
                new = False
        if new:
            out[count, XP_THETA] = best_theta
            out[count, XP_CORNER] = 1.0 if is_corner else 0.0
            out[count, XP_X] = x
            out[count, XP_Y] = y
            count += 1
    return count
