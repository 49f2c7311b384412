"""The level pose in which the bolt's base lies flush on the nut's surface, and whether a push holds it there.

The base is level and at height 0, so that nothing overlaps. Pressure on the patch balances any moment about a
horizontal axis whose centre lies within the patch's convex hull: there is one level pose that a device leaves in
equilibrium, and it is stable where the centre of pressure is inside.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch, zeros
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_CENTRE,
    D_PLACE,
    D_RIGID,
    D_ROTATION,
    D_STIFFNESS,
    N_CENTRE,
    N_JACOBIAN,
    N_OFFSET,
    N_ROTATION,
    PLACE_SIZE,
    elastic_energy,
    set_place,
)
from threadstate.device._patch_kernel import (
    H_X,
    H_Y,
    HULL_ROWS,
    POINT_SIZE,
    POINTS,
    refine_side,
    set_patch_hull,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

NEARLY_LEVEL = 5e-3
"""Tilt (rad) below which a bolt on the nut's surface may be laid flush."""

NEAR_SURFACE = 2e-2
"""How far from the nut's surface its origin may be then, in nominal radii."""


@kernel()
def set_flush(device: Array, q: Array) -> bool:
    """Sets the coordinates of the level pose of a device on the nut's surface; False where its twist is not at rest.

    The rotation vector is the shortest that levels the bolt; lateral forces of the device are zero.
    """
    # The nut's axis in the commanded bolt's frame is where the bolt's axis has to go.
    ux, uy, uz = device[D_ROTATION + 6], device[D_ROTATION + 7], device[D_ROTATION + 8]
    across = math.hypot(ux, uy)
    angle = math.atan2(across, uz)
    q[0] = -uy / across * angle if across > 0.0 else 0.0
    q[1] = ux / across * angle if across > 0.0 else 0.0
    q[2] = 0.0
    k = device[D_STIFFNESS:]
    # Lateral equilibrium: K_ll s = -K_lr e - K_lz s_z, where the base is at height 0.
    sz = device[D_CENTRE] - device[D_PLACE + 2]
    bx = -(k[18] * q[0] + k[19] * q[1] + k[23] * sz)
    by = -(k[24] * q[0] + k[25] * q[1] + k[29] * sz)
    determinant = k[21] * k[28] - k[22] * k[27]
    if not determinant > 0.0:
        return False
    q[3] = device[D_PLACE] + (bx * k[28] - by * k[22]) / determinant
    q[4] = device[D_PLACE + 1] + (by * k[21] - bx * k[27]) / determinant
    q[5] = device[D_CENTRE]
    return True


@kernel()
def centre_of_pressure(
    q: Array, push: float, place: Array, device: Array, friction: Array
) -> tuple[float, float, float, float]:
    """Where the surface's force along z acts in the level pose (x, y), its size, and the moment about z that nothing
    balances. ``friction`` is the surface's force along x and y, and its moment about z at the compliance centre.
    """
    by_q = scratch(COORDINATES)
    elastic_energy(q, device, by_q)
    jacobian = place[N_JACOBIAN : N_JACOBIAN + 9]
    m = place[N_ROTATION : N_ROTATION + 9]
    # J^-T of the gradient by e is the gradient by a turn in the bolt's axes; the third may have a reaction.
    a = scratch(3, 3)
    for i in range(3):
        for j in range(3):
            a[i, j] = jacobian[3 * j + i]
    moments = scratch(2, 3)
    determinant = (
        a[0, 0] * (a[1, 1] * a[2, 2] - a[1, 2] * a[2, 1])
        - a[0, 1] * (a[1, 0] * a[2, 2] - a[1, 2] * a[2, 0])
        + a[0, 2] * (a[1, 0] * a[2, 1] - a[1, 1] * a[2, 0])
    )
    for case in range(2):
        b = zeros(3)
        if case == 0:
            for i in range(3):
                b[i] = -by_q[i]
        else:
            b[2] = 1.0
        w = scratch(3)
        w[0] = (
            b[0] * (a[1, 1] * a[2, 2] - a[1, 2] * a[2, 1])
            - a[0, 1] * (b[1] * a[2, 2] - a[1, 2] * b[2])
            + a[0, 2] * (b[1] * a[2, 1] - a[1, 1] * b[2])
        ) / determinant
        w[1] = (
            a[0, 0] * (b[1] * a[2, 2] - a[1, 2] * b[2])
            - b[0] * (a[1, 0] * a[2, 2] - a[1, 2] * a[2, 0])
            + a[0, 2] * (a[1, 0] * b[2] - b[1] * a[2, 0])
        ) / determinant
        w[2] = (
            a[0, 0] * (a[1, 1] * b[2] - b[1] * a[2, 1])
            - a[0, 1] * (a[1, 0] * b[2] - b[1] * a[2, 0])
            + b[0] * (a[1, 0] * a[2, 1] - a[1, 1] * a[2, 0])
        ) / determinant
        for i in range(3):
            moments[case, i] = m[3 * i] * w[0] + m[3 * i + 1] * w[1] + m[3 * i + 2] * w[2]
    rest = moments[0, 2] + friction[2]
    mx, my = moments[0, 0] + place[N_CENTRE + 2] * friction[1], moments[0, 1] - place[N_CENTRE + 2] * friction[0]
    if device[D_RIGID] > 0.0:
        reaction = -rest / moments[1, 2]
        mx += reaction * moments[1, 0]
        my += reaction * moments[1, 1]
        rest = 0.0
    force = push + by_q[5]
    return place[N_CENTRE] + my / force, place[N_CENTRE + 1] - mx / force, force, rest


@kernel()
def exit_side(hull: Array, size: int, x: float, y: float, force: float, place: Array) -> tuple[float, int]:
    """The force at which the centre of pressure, at (x, y) under ``force``, leaves a convex polygon, and by which side.

    Infinite where it never does. As the force grows it goes straight to where the force alone would have it, the
    compliance centre: it leaves at most once.
    """
    least, side = math.inf, 0
    for i in range(size):
        j = i + 1 if i + 1 < size else 0
        nx, ny = hull[j, H_Y] - hull[i, H_Y], hull[i, H_X] - hull[j, H_X]
        # Inside while room > moment / force, across this side.
        room = nx * (hull[i, H_X] - place[N_CENTRE]) + ny * (hull[i, H_Y] - place[N_CENTRE + 1])
        moment = (nx * (x - place[N_CENTRE]) + ny * (y - place[N_CENTRE + 1])) * force
        if room < 0.0 and moment / room < least:
            least, side = moment / room, i
    return least, side


@kernel(allocates=True)
def flush_until(push: float, device: Array, bolt: Array, nut: Array, level: Array) -> tuple[float, float]:
    """The push up to which the level pose is stable, from ``push`` on, and the direction (rad) in which the bolt tips.

    Infinite where it stays stable, 0 where it is not at ``push``. Sets the level coordinates.
    """
    if not set_flush(device, level):
        return 0.0, 0.0
    place = scratch(PLACE_SIZE)
    points = scratch(POINTS, POINT_SIZE)
    hull = scratch(HULL_ROWS, POINT_SIZE)
    set_place(level, device, place)
    x, y, force, rest = centre_of_pressure(level, push, place, device, zeros(3))
    if not force > 0.0 or abs(rest) > 1e-9 * push * bolt[pk.R_MAJOR]:
        return 0.0, 0.0
    _, margin, _, size = set_patch_hull(x, y, place, bolt, nut, points, hull)
    if not margin > 0.0:
        return 0.0, 0.0
    while True:
        until, i = exit_side(hull, size, x, y, force, place)
        j = i + 1 if i + 1 < size else 0
        direction = math.atan2(hull[i, H_X] - hull[j, H_X], hull[j, H_Y] - hull[i, H_Y])
        if until == math.inf:
            return until, 0.0
        refined = refine_side(hull, size, i, place, bolt, nut, points)
        if refined <= size:
            return until - force + push, direction
        size = refined


@kernel()
def tip_over(direction: float, angle: float, place: Array, q: Array) -> None:
    """Tips a level bolt by a small angle such that it sinks in a direction."""
    m = place[N_ROTATION : N_ROTATION + 9]
    x, y = -math.sin(direction) * angle, math.cos(direction) * angle
    for i in range(2):
        q[i] += m[i] * x + m[3 + i] * y


@kernel()
def flush_is_reached(q: Array, push: float, place: Array, device: Array, bolt: Array, nut: Array) -> bool:
    """Whether the bolt, nearly level on the nut's surface, goes on to lie flush: stable, and at a lower potential."""
    if math.hypot(place[N_ROTATION + 6], place[N_ROTATION + 7]) > NEARLY_LEVEL:
        return False
    if abs(place[N_OFFSET + 2]) > NEAR_SURFACE * bolt[pk.R_MAJOR]:
        return False
    level = scratch(COORDINATES)
    if not set_flush(device, level):
        return False
    by_q = scratch(COORDINATES)
    before = elastic_energy(q, device, by_q) + push * q[5]
    after = elastic_energy(level, device, by_q) + push * level[5]
    if after > before:
        return False
    until, _ = flush_until(push, device, bolt, nut, level)
    return until > push
