"""The boxes with which the search of a span of time begins: all azimuths, but those that stay above the plane."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._box_kernel import X_END, X_HALF, X_START, X_THETA
from threadstate.contact._branchless_kernel import sine_cosine
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._geometry_kernel import M_AXIS, M_KIND, M_OFF, M_POINT, M_SIGMA
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Heights = tuple[float, float, float, float, float, float]

INITIAL_BOXES = 25
"""Number of boxes over all azimuths with which the search of a span of time begins."""

ABOVE = 1e-11
"""How far above the plane, in major radii, a point certainly is: round-off is less by a factor of a thousand."""

LONGEST = 3.0
"""Length of a span of a turn (rad) up to which a height has at most one extreme in it."""


@kernel()
def set_initial_boxes(since: float, until: float, boxes: Array) -> int:
    """Sets boxes over all azimuths; returns their number.

    Their half-widths are powers of two, and their middles multiples of them: halves are exact, and leave no gap.
    """
    half = 1.0
    while half * INITIAL_BOXES > math.pi:
        half *= 0.5
    count = math.ceil(math.pi / half)
    for i in range(count):
        boxes[X_THETA + i] = (2 * i + 1 - count) * half
        boxes[X_HALF + i] = half
        boxes[X_START + i] = since
        boxes[X_END + i] = until
    return count


@kernel()
def heights_at(tau: float, motion: Array) -> Heights:
    """How high the curve's origin is along the solid's axis after a time, and how high its x and y directions point;
    then the derivatives of these by tau.
    """
    ax, ay, az = motion[M_AXIS], motion[M_AXIS + 1], motion[M_AXIS + 2]
    if motion[M_KIND] == 0.0:
        return motion[M_OFF + 2] + tau * az, motion[6], motion[7], az, 0.0, 0.0
    # The solid's axis, turned back: what a vector is along it is how high the turned one points.
    sine, cosine = sine_cosine(tau)
    x, y, z = -az * ax * cosine - ay * sine, -az * ay * cosine + ax * sine, (1.0 - az * az) * cosine
    dx, dy, dz = az * ax * sine - ay * cosine, az * ay * sine + ax * cosine, -(1.0 - az * az) * sine
    x, y, z = x + az * ax, y + az * ay, z + az * az
    ox, oy, oz = motion[M_OFF] - motion[M_POINT], motion[M_OFF + 1] - motion[M_POINT + 1], motion[M_OFF + 2]
    oz -= motion[M_POINT + 2]
    return (
        motion[M_POINT + 2] + x * ox + y * oy + z * oz,
        x * motion[0] + y * motion[3] + z * motion[6],
        x * motion[1] + y * motion[4] + z * motion[7],
        dx * ox + dy * oy + dz * oz,
        dx * motion[0] + dy * motion[3] + dz * motion[6],
        dx * motion[1] + dy * motion[4] + dz * motion[7],
    )


@kernel(forceinline=True)
def stays_above(x: float, y: float, first: Heights, last: Heights, sigma: float, least: float) -> bool:
    """Whether the point (x, y) of the curve's plane is above the solid's by more than ``least`` during a span of time,
    at whose ends the :func:`heights_at` are these.

    A height is a sinusoid: it has a least value inside of the span only if it falls at the first and rises at the last.
    """
    rise_first = sigma * (first[3] + x * first[4] + y * first[5])
    rise_last = sigma * (last[3] + x * last[4] + y * last[5])
    height = min(sigma * (first[0] + x * first[1] + y * first[2]), sigma * (last[0] + x * last[1] + y * last[2]))
    return height > least and not (rise_first < 0.0 and rise_last > 0.0)


@kernel()
def drop_above(count: int, edge: Edge, boxes: Array) -> int:
    """Drops of the initial boxes those whose arcs stay above the solid's plane; returns how many are left.

    An arc is in the convex hull of the ends of its azimuths at the least radius of the thread and at the largest one
    over the cosine of its half-width, and so it is after any motion (docs/certificate.md, section 7).
    """
    half, since, until = boxes[X_HALF], boxes[X_START], boxes[X_END]
    if until - since > LONGEST and edge.motion[M_KIND] != 0.0:
        return count
    first, last = heights_at(since, edge.motion), heights_at(until, edge.motion)
    sigma, r_minor, r_major = edge.motion[M_SIGMA], edge.curve[pk.R_MINOR], edge.curve[pk.R_MAJOR]
    half_sine, half_cosine = sine_cosine(half)
    by_sine, by_cosine = 2.0 * half_sine * half_cosine, 1.0 - 2.0 * half_sine * half_sine
    sine, cosine = sine_cosine(boxes[X_THETA] - half)
    least, r_hull = ABOVE * r_major, r_major / half_cosine
    before = False
    left = 0
    for i in range(count + 1):
        is_above = stays_above(r_minor * cosine, r_minor * sine, first, last, sigma, least) and stays_above(
            r_hull * cosine, r_hull * sine, first, last, sigma, least
        )
        if i > 0 and not (before and is_above):
            boxes[X_THETA + left] = boxes[X_THETA + i - 1]
            left += 1
        before = is_above
        cosine, sine = cosine * by_cosine - sine * by_sine, sine * by_cosine + cosine * by_sine
    return left
