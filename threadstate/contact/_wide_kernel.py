"""Points of both parts and of motions, and their clearance, in sums of two doubles.

Arrays of such sums have two columns, high and low: a pose of twelve rows (rotation by rows, origin), a point or an axis
of three.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._double_double_kernel import (
    WIDE_TWO_PI,
    Pair,
    add,
    azimuth,
    divide,
    exact_product,
    multiply,
    scale,
    sine_cosine,
    sine_versine,
    square_root,
    subtract,
)
from threadstate.contact._geometry_kernel import M_POINT
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Vector = tuple[Pair, Pair, Pair]

POSE_SIZE = 12

W_POINT, W_AXIS = 12, 15
WIDE_MOTION_SIZE = 18
"""Rows of a motion: a pose, a point of the axis, the axis (``wide_motion``)."""

ZERO: Pair = (0.0, 0.0)
ONE: Pair = (1.0, 0.0)
MINUS_ONE: Pair = (-1.0, 0.0)


@kernel(forceinline=True)
def entry(numbers: Array, i: int) -> Pair:
    """A row."""
    return numbers[i, 0], numbers[i, 1]


@kernel(forceinline=True)
def set_entry(numbers: Array, i: int, x: Pair) -> None:
    """Sets a row."""
    numbers[i, 0], numbers[i, 1] = x


@kernel(forceinline=True)
def vector_at(numbers: Array, i: int) -> Vector:
    """Three rows from ``i`` on."""
    return entry(numbers, i), entry(numbers, i + 1), entry(numbers, i + 2)


@kernel(forceinline=True)
def set_vector(numbers: Array, i: int, v: Vector) -> None:
    """Sets three rows from ``i`` on."""
    set_entry(numbers, i, v[0])
    set_entry(numbers, i + 1, v[1])
    set_entry(numbers, i + 2, v[2])


@kernel()
def round_numbers(numbers: Array, out: Array) -> None:
    """Sets doubles to the nearest of such sums."""
    for i in range(out.shape[0]):
        out[i] = numbers[i, 0]


@kernel()
def widen_numbers(numbers: Array, out: Array) -> None:
    """Sets such sums to doubles."""
    for i in range(numbers.shape[0]):
        out[i, 0], out[i, 1] = numbers[i], 0.0


@kernel()
def product_sum(a: Pair, x: Pair, b: Pair, y: Pair) -> Pair:
    """``a x + b y``."""
    return add(multiply(a, x), multiply(b, y))


@kernel()
def dot(a: Vector, b: Vector) -> Pair:
    """The scalar product."""
    return add(product_sum(a[0], b[0], a[1], b[1]), multiply(a[2], b[2]))


@kernel()
def cross(a: Vector, b: Vector) -> Vector:
    """The cross product."""
    return (
        subtract(multiply(a[1], b[2]), multiply(a[2], b[1])),
        subtract(multiply(a[2], b[0]), multiply(a[0], b[2])),
        subtract(multiply(a[0], b[1]), multiply(a[1], b[0])),
    )


@kernel()
def plus(a: Vector, b: Vector) -> Vector:
    """The sum of two vectors."""
    return add(a[0], b[0]), add(a[1], b[1]), add(a[2], b[2])


@kernel()
def times(a: Vector, factor: Pair) -> Vector:
    """A vector times a number."""
    return multiply(a[0], factor), multiply(a[1], factor), multiply(a[2], factor)


@kernel()
def rotated(pose: Array, v: Vector) -> Vector:
    """A vector of the bolt's frame in the nut's."""
    return dot(vector_at(pose, 0), v), dot(vector_at(pose, 3), v), dot(vector_at(pose, 6), v)


@kernel()
def rotated_back(pose: Array, v: Vector) -> Vector:
    """A vector of the nut's frame in the bolt's."""
    return plus(plus(times(vector_at(pose, 0), v[0]), times(vector_at(pose, 3), v[1])), times(vector_at(pose, 6), v[2]))


@kernel()
def arm_turned(axis: Vector, arm: Vector, sine: Pair, versine: Pair) -> Vector:
    """An arm turned about a unit axis by the angle of that sine and 1 less cosine."""
    normal = cross(axis, arm)
    return plus(arm, plus(times(normal, sine), times(cross(axis, normal), versine)))


@kernel()
def set_moved(pose: Array, is_turn: bool, point: Array, axis: Array, time: Pair, out: Array) -> None:
    """Sets the pose after ``time`` of a motion, a turn of up to pi / 4 or a translation along the axis."""
    a = vector_at(axis, 0)
    if not is_turn:
        for i in range(9):
            set_entry(out, i, entry(pose, i))
        set_vector(out, 9, plus(vector_at(pose, 9), times(a, time)))
        return
    sine, versine = sine_versine(time)
    for j in range(3):
        v = arm_turned(a, (entry(pose, j), entry(pose, 3 + j), entry(pose, 6 + j)), sine, versine)
        set_entry(out, j, v[0])
        set_entry(out, 3 + j, v[1])
        set_entry(out, 6 + j, v[2])
    centre = vector_at(point, 0)
    arm = plus(vector_at(pose, 9), times(centre, MINUS_ONE))
    set_vector(out, 9, plus(centre, arm_turned(a, arm, sine, versine)))


@kernel()
def advance(profile: Array) -> Pair:
    """The lead per radian."""
    return divide((profile[pk.LEAD], 0.0), WIDE_TWO_PI)


@kernel()
def fillet_rise(distance: Pair, radius: float) -> tuple[Pair, Pair]:
    """How far a fillet has left its flat at a distance beside it, and its slope."""
    root = square_root(multiply(subtract((radius, 0.0), distance), add((radius, 0.0), distance)))
    rise = divide(multiply(distance, distance), add((radius, 0.0), root))
    return rise, divide(distance, root)


@kernel()
def fillet_end(height: float, cot: float, radius: float) -> Pair:
    """How far from the pitch radius along the axis the flat of a fillet ends, at ``height`` from the pitch radius.

    That of method, section 1, with the fillet exactly tangent to the flank of slope ``cot``: where a fillet touches a
    flank the gap beside it is less than what stored boundaries are rounded by.
    """
    squared = add(ONE, exact_product(cot, cot))
    tangents = multiply(subtract(square_root(squared), ONE), (radius, 0.0))
    return divide(add((height, 0.0), tangents), (cot, 0.0))


@kernel()
def radius_and_slope(s: Pair, profile: Array) -> tuple[Pair, Pair]:
    """``f`` and ``f'`` at ``s``."""
    p, pitch_radius = profile[pk.P], profile[pk.R_PITCH]
    u = subtract(s, exact_product(p, float(math.floor(s[0] / p - profile[pk.S_ROOT] / p))))
    half = 0
    if u[0] > profile[pk.S_CREST]:
        half = pk.FALLING
        u = subtract((0.5 * p, 0.0), u)
    sign, cot = 1.0 if half == 0 else -1.0, profile[pk.COT + half]
    if u[0] <= profile[pk.U_FLAT + half]:
        return (profile[pk.R_MINOR], 0.0), ZERO
    if u[0] < profile[pk.U_FLANK + half]:
        end = fillet_end(pitch_radius - profile[pk.R_MINOR], cot, profile[pk.RHO_MINOR])
        rise, slope = fillet_rise(add(u, end), profile[pk.RHO_MINOR])
        return add((profile[pk.R_MINOR], 0.0), rise), (sign * slope[0], sign * slope[1])
    if u[0] <= profile[pk.U_CREST + half]:
        return add((pitch_radius, 0.0), multiply(u, (cot, 0.0))), (sign * cot, 0.0)
    if u[0] < profile[pk.U_TOP + half]:
        end = fillet_end(profile[pk.R_MAJOR] - pitch_radius, cot, profile[pk.RHO_MAJOR])
        rise, slope = fillet_rise(subtract(end, u), profile[pk.RHO_MAJOR])
        return subtract((profile[pk.R_MAJOR], 0.0), rise), (sign * slope[0], sign * slope[1])
    return (profile[pk.R_MAJOR], 0.0), ZERO


@kernel()
def thread_point(theta: Pair, z: Pair, profile: Array) -> tuple[Vector, Vector, Vector]:
    """The point of a thread in its own frame, its derivative along the helix by azimuth, and along the axis by z."""
    k = advance(profile)
    r, slope = radius_and_slope(subtract(z, multiply(k, theta)), profile)
    s, c = sine_cosine(theta)
    x, y = multiply(r, c), multiply(r, s)
    return (x, y, z), ((-y[0], -y[1]), x, k), (multiply(slope, c), multiply(slope, s), ONE)


@kernel()
def edge_slope(along: Vector, up: Vector, k: Pair) -> Vector:
    """The derivative of an edge by azimuth: along the helix, and back down to the edge's plane."""
    return plus(along, times(up, (-k[0], -k[1])))


@kernel()
def clearance(x: Vector, profile: Array) -> tuple[Pair, Pair, Pair]:
    """``r - f(s)`` at a point of the profile's own frame, the radius, and f'."""
    r = square_root(product_sum(x[0], x[0], x[1], x[1]))
    f, slope = radius_and_slope(subtract(x[2], multiply(advance(profile), azimuth(x[0], x[1]))), profile)
    return subtract(r, f), r, slope


@kernel()
def clearance_slope(x: Vector, way: Vector, r: Pair, slope: Pair, k: Pair) -> Pair:
    """The derivative of the clearance along a way."""
    radial = divide(product_sum(x[0], way[0], x[1], way[1]), r)
    turn = divide(subtract(multiply(x[0], way[1]), multiply(x[1], way[0])), multiply(r, r))
    return subtract(radial, multiply(slope, subtract(way[2], multiply(k, turn))))


@kernel()
def set_motion(pose: Array, point: Array, axis: Array, motion: Array) -> None:
    """Sets a motion, a translation along an axis or a turn about it: a pose, a point of the axis, the axis."""
    for i in range(POSE_SIZE):
        set_entry(motion, i, entry(pose, i))
    for i in range(3):
        set_entry(motion, W_POINT + i, entry(point, i))
        set_entry(motion, W_AXIS + i, entry(axis, i))


@kernel()
def widen_motion(motion: Array, wide: Array) -> None:
    """Sets a motion of ``_geometry_kernel`` in sums of two doubles."""
    for i in range(POSE_SIZE):
        set_entry(wide, i, (motion[i], 0.0))
    for i in range(6):
        set_entry(wide, W_POINT + i, (motion[M_POINT + i], 0.0))


@kernel()
def set_nearest_motion(motion: Array, nearest: Array) -> None:
    """Sets the motion whose rotation is the nearest one and whose axis is a unit vector.

    One step of Newton's method makes rows that are orthogonal to 1e-16 so to 1e-32.
    """
    for i in range(WIDE_MOTION_SIZE):
        set_entry(nearest, i, entry(motion, i))
    rows = vector_at(motion, 0), vector_at(motion, 3), vector_at(motion, 6)
    for i in range(3):
        row = times(rows[i], (1.5, 0.0))
        for j in range(3):
            row = plus(row, times(rows[j], scale(dot(rows[i], rows[j]), -0.5)))
        set_vector(nearest, 3 * i, row)
    axis = vector_at(motion, W_AXIS)
    set_vector(nearest, W_AXIS, times(axis, divide(ONE, square_root(dot(axis, axis)))))


@kernel()
def set_inverse_motion(motion: Array, inverse: Array) -> None:
    """Sets the motion of the nut in the bolt's frame, of that of the bolt in the nut's."""
    for i in range(3):
        for j in range(3):
            set_entry(inverse, 3 * i + j, entry(motion, 3 * j + i))
    origin = vector_at(motion, 9)
    set_vector(inverse, 9, rotated_back(motion, times(origin, MINUS_ONE)))
    set_vector(inverse, W_POINT, rotated_back(motion, plus(vector_at(motion, W_POINT), times(origin, MINUS_ONE))))
    set_vector(inverse, W_AXIS, rotated_back(motion, times(vector_at(motion, W_AXIS), MINUS_ONE)))
