"""The torque at which a held bolt begins to turn about the nut's axis (forces, section 3), in closed form.

A rigid device takes every force across the axis and every moment across it; the bolt turns about the axis and moves
along it as its contacts command. The push keeps the one on the nut that would be left last, and friction there
opposes the slip.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel

Array = NDArray[np.float64]

TIE = 1e-12
"""Climbs a radian, over the radius, that differ by less are the same."""


@kernel()
def climb_limits(points: Array, normals: Array, sense: float) -> tuple[float, float]:
    """The least and the largest climb a radian of a turn by which no contact presses into the nut.

    ``sense`` is 1 counter-clockwise, -1 clockwise. The least exceeds the largest where the bolt cannot turn.
    """
    low, high = -math.inf, math.inf
    for i in range(points.shape[0]):
        turning = sense * (points[i, 0] * normals[i, 1] - points[i, 1] * normals[i, 0])
        if normals[i, 2] > 0.0:
            low = max(low, -turning / normals[i, 2])
        elif normals[i, 2] < 0.0:
            high = min(high, -turning / normals[i, 2])
        elif turning < 0.0:
            high = -math.inf
    return low, high


@kernel()
def turn_effort(push: float, torque: float, points: Array, normals: Array, mu: float, sense: float) -> float:
    """The torque in the sense of the turn at which a held bolt begins to turn.

    ``push`` is the load's force along -z, positive, ``torque`` its moment about the nut's axis; points and normals have
    shape (k, 3); ``sense`` is 1 counter-clockwise, -1 clockwise.

    Returns:
        Negative where it turns by itself; infinite where geometry or friction locks it; NaN where no contact faces the
        push. Of contacts that climb alike the one that resists most decides.
    """
    low, high = climb_limits(points, normals, sense)
    if low == -math.inf:
        return math.nan
    if low > high:
        return math.inf
    effort = -math.inf
    for i in range(points.shape[0]):
        x, y = points[i, 0], points[i, 1]
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        if not nz > 0.0 or -sense * (x * ny - y * nx) / nz < low - TIE * math.hypot(x, y):
            continue
        # The velocity at the contact is tangential: the turn's with the climb.
        vx, vy, vz = -sense * y, sense * x, low
        speed = math.sqrt(vx * vx + vy * vy + vz * vz)
        fx, fy, fz = nx - mu * vx / speed, ny - mu * vy / speed, nz - mu * vz / speed
        if fz <= 0.0:
            return math.inf
        effort = max(effort, -sense * (push * (x * fy - y * fx) / fz + torque))
    return effort
