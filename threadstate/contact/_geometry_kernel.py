"""Edge curves, solids and motions as pure functions of numbers.

Each part is one edge curve (``z = 0`` in its own frame, ``r = f(-k theta)``, ``k = p / 2 pi``) and one solid
``sigma (r - f(s)) >= 0, -sigma z >= 0`` with ``s = z - k theta``; ``sigma`` is +1 for the nut, -1 for the bolt.
An *edge point* is a point of one part's edge curve; it moves relative to the other part's solid.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

TWO_PI = 2.0 * math.pi

# A motion, in the frame of the solid that the edge curve meets: start placement (3x3 by rows, then the offset),
# kind (0 translation, 1 turn), a point of the axis, the unit axis (or the direction of translation), sigma, and 1 where
# the axis of a turn lies both in the curve's plane and in the solid's (then the two planes meet along it, and an edge
# point stays on its side of the solid's plane until the turn has brought the planes together); then 1 where these
# numbers are the motion meant but for what they are rounded by, 0 where they are the motion meant.
M_ROT = 0
M_OFF = 9
M_KIND = 12
M_POINT = 13
M_AXIS = 16
M_SIGMA = 19
M_COPLANAR = 20
M_ROUNDED = 21
MOTION_SIZE = 22

# A path: x(tau) = base + d cos(tau) + e sin(tau) for a turn, base + e tau for a translation; then |dx/dtau|.
PATH_SIZE = 10

SCALE_PITCHES = 20.0
"""Thread pitches of a translation that correspond to a radian of a turn."""


@kernel()
def copy_numbers(source: Array, target: Array) -> None:
    """Copies an array into one of its length; assigned as a slice it would be compiled with messages on shapes."""
    for i in range(target.shape[0]):
        target[i] = source[i]


@kernel()
def place_by_time(time: float, count: int, rows: Array) -> tuple[int, int]:
    """Makes room for what has a time in rows that are sorted by time, their first column: later ones move down.

    Of a full list the latest is dropped. Returns the row, -1 where that would be the latest, and how many are listed.
    """
    if count == rows.shape[0]:
        if time >= rows[count - 1, 0]:
            return -1, count
        count -= 1
    i = count
    while i > 0 and rows[i - 1, 0] > time:
        copy_numbers(rows[i - 1], rows[i])
        i -= 1
    return i, count + 1


@kernel()
def motion_scale(motion: Array, profile: Array) -> float:
    """The unit of a motion's steps and tolerances: a radian, or ``SCALE_PITCHES`` thread pitches of a translation."""
    return SCALE_PITCHES * profile[pk.P] if motion[M_KIND] == 0.0 else 1.0


@kernel()
def edge_point(theta: float, profile: Array) -> tuple[float, float, float, float]:
    """The edge point (x, y) at azimuth ``theta`` (rad) and its derivative by ``theta``."""
    k = profile[pk.LEAD] / TWO_PI
    r, d1, _ = pk.jet(-k * theta, profile)
    c = math.cos(theta)
    s = math.sin(theta)
    dr = -k * d1
    return r * c, r * s, dr * c - r * s, dr * s + r * c


@kernel()
def phi_and_gradient(x: float, y: float, z: float, profile: Array, sigma: float) -> tuple[float, float, float, float]:
    """``phi = sigma (r - f(s))``, positive inside the thread, and its gradient; undefined on the axis."""
    k = profile[pk.LEAD] / TWO_PI
    r = math.sqrt(x * x + y * y)
    f, d1, _ = pk.jet(z - k * math.atan2(y, x), profile)
    turn = d1 * k / (r * r)
    return (
        sigma * (r - f),
        sigma * (x / r - turn * y),
        sigma * (y / r + turn * x),
        -sigma * d1,
    )


@kernel()
def set_path(x: float, y: float, motion: Array, path: Array) -> None:
    """The path of the edge point that starts at (x, y, 0) of its part's frame."""
    set_path_from(x, y, 0.0, motion, path)


@kernel()
def set_path_from(x: float, y: float, z: float, motion: Array, path: Array) -> None:
    """The path of the point that starts at (x, y, z) of the moving part's frame."""
    qx = motion[0] * x + motion[1] * y + motion[2] * z + motion[9]
    qy = motion[3] * x + motion[4] * y + motion[5] * z + motion[10]
    qz = motion[6] * x + motion[7] * y + motion[8] * z + motion[11]
    ax = motion[16]
    ay = motion[17]
    az = motion[18]
    if motion[M_KIND] == 0.0:
        path[0] = qx
        path[1] = qy
        path[2] = qz
        path[3] = 0.0
        path[4] = 0.0
        path[5] = 0.0
        path[6] = ax
        path[7] = ay
        path[8] = az
        path[9] = 1.0
        return
    dx = qx - motion[13]
    dy = qy - motion[14]
    dz = qz - motion[15]
    h = ax * dx + ay * dy + az * dz
    path[0] = motion[13] + h * ax
    path[1] = motion[14] + h * ay
    path[2] = motion[15] + h * az
    dx -= h * ax
    dy -= h * ay
    dz -= h * az
    path[3] = dx
    path[4] = dy
    path[5] = dz
    path[6] = ay * dz - az * dy
    path[7] = az * dx - ax * dz
    path[8] = ax * dy - ay * dx
    path[9] = math.sqrt(dx * dx + dy * dy + dz * dz)


@kernel()
def turn_vector(x: float, y: float, z: float, motion: Array, tau: float) -> tuple[float, float, float]:
    """A vector of the moving part's frame, in the solid's frame after ``tau``."""
    vx = motion[0] * x + motion[1] * y + motion[2] * z
    vy = motion[3] * x + motion[4] * y + motion[5] * z
    vz = motion[6] * x + motion[7] * y + motion[8] * z
    if motion[M_KIND] == 0.0:
        return vx, vy, vz
    ax = motion[16]
    ay = motion[17]
    az = motion[18]
    h = ax * vx + ay * vy + az * vz
    c = math.cos(tau)
    s = math.sin(tau)
    px = vx - h * ax
    py = vy - h * ay
    pz = vz - h * az
    return (
        h * ax + c * px + s * (ay * pz - az * py),
        h * ay + c * py + s * (az * px - ax * pz),
        h * az + c * pz + s * (ax * py - ay * px),
    )


@kernel()
def position(path: Array, tau: float, is_turn: bool) -> tuple[float, float, float]:
    """The position on a path after ``tau``."""
    if is_turn:
        c = math.cos(tau)
        s = math.sin(tau)
        return (
            path[0] + c * path[3] + s * path[6],
            path[1] + c * path[4] + s * path[7],
            path[2] + c * path[5] + s * path[8],
        )
    return path[0] + tau * path[6], path[1] + tau * path[7], path[2] + tau * path[8]


@kernel()
def velocity(path: Array, tau: float, is_turn: bool) -> tuple[float, float, float]:
    """The derivative of a path by ``tau``."""
    if is_turn:
        c = math.cos(tau)
        s = math.sin(tau)
        return c * path[6] - s * path[3], c * path[7] - s * path[4], c * path[8] - s * path[5]
    return path[6], path[7], path[8]
