"""The level pose in which the bolt lies on the nut's flank along a strip, and whether a push holds it there.

Flank lies on flank where both axes coincide and the bolt is as high as its turn asks. Pressure anywhere on the strip
balances the wrenches of the convex cone of its points; that cone is taken from inside, over points of the
strip's outline.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._stage_kernel import FLUSH as FLUSH_PAIR
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_CENTRE,
    D_RIGID,
    D_ROTATION,
    N_CENTRE,
    N_JACOBIAN,
    N_OFFSET,
    N_ROTATION,
    PLACE_SIZE,
    set_place,
)
from threadstate.device._quadratic_kernel import SOLVED, cholesky, solve_program
from threadstate.device._rest_kernel import (
    coordinate,
    free_coordinates,
    length_of,
    scale,
    set_gradient,
    set_metric,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

SAMPLES, END_SAMPLES = 64, 24
OUTLINE = 2 * (SAMPLES + END_SAMPLES)
"""Points along each helix and each end of a strip's outline; their cone lies within the strip's."""

BALANCED = 1e-9
"""Wrench (over the push) that the strip may leave unbalanced where it counts as holding the bolt."""

NEARLY_LEVEL, NEARLY_CENTRED = 5e-3, 1e-2
"""Tilt (rad) and distance (nominal radii) from the level pose below which a bolt may be laid on the strip."""

NEAR = 1e-3
"""How far (nominal radii) the push alone would take the bolt in the step from which forces are computed."""

# What is known of the flanks of a pair: how far a bolt in phase goes down, the radii between which both flanks are
# straight, the number of starts.
S_DOWN, S_LOW, S_HIGH, S_STARTS = range(4)
STRIP_SIZE = 4

# A contact that carries a force: pair of features, point in the nut's frame, direction of the force on the bolt (the
# unit normal; on a strip with friction less mu times the direction of slip), normal force (N).
C_PAIR, C_POINT, C_NORMAL, C_FORCE = 0, 1, 4, 7
CONTACT_SIZE = 8
MAX_CONTACTS = 8


@kernel()
def set_strip(near: float, device: Array, strip: Array, bolt: Array, q: Array) -> bool:
    """Sets the coordinates of the level pose on the strip whose height is nearest to ``near``; False without one.

    It is defined for a rigid twist: the rotation vector is the shortest that levels the bolt.
    """
    if not device[D_RIGID] > 0.0 or not strip[S_HIGH] > strip[S_LOW]:
        return False
    ux, uy, uz = device[D_ROTATION + 6], device[D_ROTATION + 7], device[D_ROTATION + 8]
    across = math.hypot(ux, uy)
    angle = math.atan2(across, uz)
    q[0] = -uy / across * angle if across > 0.0 else 0.0
    q[1] = ux / across * angle if across > 0.0 else 0.0
    for i in range(2, COORDINATES):
        q[i] = 0.0
    place = scratch(PLACE_SIZE)
    set_place(q, device, place)
    turn = math.atan2(place[N_ROTATION + 3], place[N_ROTATION])
    p = bolt[pk.P]
    height = bolt[pk.LEAD] * turn / TWO_PI - strip[S_DOWN]
    height += p * math.floor((near - height) / p + 0.5)
    q[5] = height + device[D_CENTRE]
    return height < 0.0


@kernel()
def strip_parameters(i: int, height: float, strip: Array) -> tuple[float, float]:
    """A point of a strip's outline: its radius, and its height in the nut's frame.

    The outline is two helices, at the least and the largest radius, then both ends, at the nut's top and at the base.
    """
    if i < 2 * SAMPLES:
        return strip[S_LOW + i // SAMPLES], height * (i % SAMPLES) / (SAMPLES - 1)
    i -= 2 * SAMPLES
    part = (i % END_SAMPLES + 1) / (END_SAMPLES + 1)
    return strip[S_LOW] + part * (strip[S_HIGH] - strip[S_LOW]), height * (i // END_SAMPLES)


@kernel()
def set_strip_rows(
    mu: float, sense: float, place: Array, device: Array, strip: Array, nut: Array, rows: Array, points: Array
) -> int:
    """Sets the points of all strips' outlines, the directions of forces there, and their rows; returns how many.

    A direction is the normal less mu times that of the slip, of a screw motion of counter-clockwise (1) or clockwise
    (-1) ``sense``; a row has minus what a unit force does along each free coordinate, as lengths.
    """
    n = free_coordinates(device)
    k = nut[pk.LEAD] / TWO_PI
    count = 0
    starts = int(strip[S_STARTS])
    m = place[N_ROTATION : N_ROTATION + 9]
    jacobian = place[N_JACOBIAN : N_JACOBIAN + 9]
    by_q = scratch(COORDINATES)
    cot = nut[pk.COT]
    for start in range(starts):
        for i in range(OUTLINE):
            radius, z = strip_parameters(i, place[N_OFFSET + 2], strip)
            theta = (z - pk.inverse(radius, 0, nut)) / k + start * TWO_PI / starts
            x, y = radius * math.cos(theta), radius * math.sin(theta)
            kr = cot * k / radius
            nx, ny, nz = -x / radius + kr * y / radius, -y / radius - kr * x / radius, cot
            norm = math.sqrt(nx * nx + ny * ny + nz * nz)
            speed = sense * mu / math.sqrt(radius * radius + k * k)
            nx, ny, nz = nx / norm + speed * y, ny / norm - speed * x, nz / norm - speed * k
            ax, ay, az = x - place[N_CENTRE], y - place[N_CENTRE + 1], z - place[N_CENTRE + 2]
            mx, my, mz = ay * nz - az * ny, az * nx - ax * nz, ax * ny - ay * nx
            wx = -(m[0] * mx + m[3] * my + m[6] * mz)
            wy = -(m[1] * mx + m[4] * my + m[7] * mz)
            wz = -(m[2] * mx + m[5] * my + m[8] * mz)
            for j in range(3):
                by_q[j] = jacobian[j] * wx + jacobian[3 + j] * wy + jacobian[6 + j] * wz
            by_q[3], by_q[4], by_q[5] = -nx, -ny, -nz
            for j in range(n):
                h = coordinate(j, device)
                rows[count, j] = by_q[h] / scale(h, device)
            points[count, 0], points[count, 1], points[count, 2] = x, y, z
            points[count, 3], points[count, 4], points[count, 5] = nx, ny, nz
            count += 1
    return count


@kernel(allocates=True)
def strip_holds(
    q: Array,
    push: float,
    mu: float,
    sense: float,
    device: Array,
    strip: Array,
    bolt: Array,
    nut: Array,
    contacts: Array,
    leave: Array,
) -> tuple[bool, int]:
    """Whether pressure on the strip balances device and push at its level pose ``q``; the number of ``contacts`` set.

    With friction ``mu`` of a bolt that is screwed counter-clockwise (``sense`` 1) or clockwise (-1) along the strip.

    The contacts are points whose forces do, at most as many as there are free coordinates. Where it does not hold
    ``leave`` is set to the direction, of unit length in the coordinates, in which the bolt leaves the strip.
    """
    n = free_coordinates(device)
    r = bolt[pk.R_MAJOR]
    place = scratch(PLACE_SIZE)
    metric = scratch(COORDINATES, COORDINATES)
    factor = scratch(COORDINATES, COORDINATES)
    gradient = scratch(COORDINATES)
    by_q = scratch(COORDINATES)
    most = OUTLINE * int(strip[S_STARTS])
    rows = np.empty((most, COORDINATES))
    points = np.empty((most, 6))
    set_place(q, device, place)
    set_metric(n, place, device, metric)
    cholesky(metric, n, factor)
    set_gradient(n, q, push, device, by_q, gradient)
    count = set_strip_rows(mu, sense, place, device, strip, nut, rows, points)
    limits = np.zeros(count)
    forces = np.empty(count)
    step = scratch(COORDINATES)
    stiffness = push / (NEAR * r)
    for i in range(n):
        gradient[i] /= stiffness
    status = solve_program(
        n,
        factor,
        gradient,
        count,
        rows,
        limits,
        1e-14 * r,
        np.empty(6 * count + 90),
        np.empty(COORDINATES + 2, dtype=np.int64),
        step,
        forces,
    )
    size = stiffness * length_of(n, step, metric)
    if status == SOLVED and size <= BALANCED * push:
        used = 0
        for i in range(count):
            if forces[i] > 0.0 and used < MAX_CONTACTS:
                contacts[used, C_PAIR] = FLUSH_PAIR
                for j in range(6):
                    contacts[used, C_POINT + j] = points[i, j]
                contacts[used, C_FORCE] = stiffness * forces[i]
                used += 1
        return True, used
    length = 0.0
    for j in range(COORDINATES):
        leave[j] = 0.0
    for i in range(n):
        j = coordinate(i, device)
        leave[j] = step[i] / scale(j, device)
        length += step[i] * step[i]
    for j in range(COORDINATES):
        leave[j] *= r / math.sqrt(length) if length > 0.0 else 0.0
    return False, 0


@kernel()
def is_near_strip(place: Array, bolt: Array) -> bool:
    """Whether a bolt in the nut is so nearly level and centred that it may be laid on the strip."""
    return (
        place[N_OFFSET + 2] < 0.0
        and math.hypot(place[N_ROTATION + 6], place[N_ROTATION + 7]) < NEARLY_LEVEL
        and math.hypot(place[N_OFFSET], place[N_OFFSET + 1]) < NEARLY_CENTRED * bolt[pk.R_MAJOR]
    )
