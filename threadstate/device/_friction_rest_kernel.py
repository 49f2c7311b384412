"""Whether friction holds a bolt where it is: forces within round cones that balance device and push."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_SCALE,
    PLACE_SIZE,
    set_place,
)
from threadstate.device._modes_kernel import (
    K_AXIS,
    K_FORCE,
    K_MODE,
    K_NORMAL,
    K_POINT,
    K_SLIP,
    MOST_CONTACTS,
    STICKS,
    set_velocities,
    tangent,
)
from threadstate.device._quadratic_kernel import SOLVED as PROGRAM_SOLVED
from threadstate.device._quadratic_kernel import cholesky, solve_program
from threadstate.device._rest_kernel import (
    free_coordinates,
    length_of,
    set_gradient,
    set_metric,
)

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

EDGES, MORE_EDGES = 12, 60
"""Edges of the pyramid inside a friction cone with which the test of a bolt at rest begins, and how many are added, one
at a time, where it takes more."""

BEYOND = 1e-8
"""By how much a velocity may be outside the cones' polar, over its size, where no edge is added."""


@kernel(allocates=True)
def rests(q: Array, push: float, mu: float, count: int, contacts: Array, device: Array) -> bool:
    """Whether forces within the contacts' cones balance device and push where the bolt is; sets them.

    The cones are approached from inside, by pyramids that gain the edges on which the bolt would begin to move.
    """
    n = free_coordinates(device)
    r = device[D_SCALE]
    place = scratch(PLACE_SIZE)
    metric = scratch(COORDINATES, COORDINATES)
    factor = scratch(COORDINATES, COORDINATES)
    gradient = scratch(COORDINATES)
    by_q = scratch(COORDINATES)
    velocities = np.empty((MOST_CONTACTS, 3, COORDINATES))
    most = (EDGES + MORE_EDGES) * count
    rows = np.zeros((most, COORDINATES))
    edges = np.empty((most, 3))
    owners = np.empty(most, dtype=np.int64)
    set_place(q, device, place)
    set_metric(n, place, device, metric)
    cholesky(metric, n, factor)
    set_gradient(n, q, push, device, by_q, gradient)
    total = 0
    for c in range(count):
        set_velocities(contacts[c, K_POINT : K_POINT + 3], place, device, velocities[c])
        contacts[c, K_AXIS] = 0.0 if abs(contacts[c, K_NORMAL]) < 0.8 else 1.0
        ux, uy, uz = tangent(0, contacts[c])
        vx, vy, vz = tangent(1, contacts[c])
        for e in range(EDGES):
            a, b = math.cos(2.0 * math.pi * e / EDGES), math.sin(2.0 * math.pi * e / EDGES)
            total = add_edge(
                total,
                c,
                mu,
                a * ux + b * vx,
                a * uy + b * vy,
                a * uz + b * vz,
                contacts,
                velocities,
                n,
                rows,
                edges,
                owners,
            )
    stiffness = push / (1e-3 * r)
    for j in range(n):
        gradient[j] /= stiffness
    step = scratch(COORDINATES)
    forces = np.empty(most)
    work, active = np.empty(6 * most + 90), np.empty(COORDINATES + 2, dtype=np.int64)
    limits = np.zeros(most)
    moved = scratch(3)
    while True:
        status = solve_program(n, factor, gradient, total, rows, limits, 1e-14 * r, work, active, step, forces)
        if status != PROGRAM_SOLVED:
            return False
        length = length_of(n, step, metric)
        if stiffness * length <= 1e-9 * push:
            break
        earlier = total
        for c in range(count):
            normal, square = 0.0, 0.0
            for h in range(3):
                moved[h] = 0.0
                for j in range(n):
                    moved[h] += velocities[c, h, j] * step[j]
                normal += moved[h] * contacts[c, K_NORMAL + h]
            for h in range(3):
                moved[h] -= normal * contacts[c, K_NORMAL + h]
                square += moved[h] * moved[h]
            across = math.sqrt(square)
            if normal - mu * across < -BEYOND * length and total < most:
                total = add_edge(
                    total,
                    c,
                    mu,
                    -moved[0] / across,
                    -moved[1] / across,
                    -moved[2] / across,
                    contacts,
                    velocities,
                    n,
                    rows,
                    edges,
                    owners,
                )
        if total == earlier:
            return False
    for c in range(count):
        for h in range(3):
            contacts[c, K_SLIP + h] = 0.0
            contacts[c, K_FORCE + h] = 0.0
        contacts[c, K_MODE] = STICKS
    for e in range(total):
        for h in range(3):
            contacts[owners[e], K_FORCE + h] += stiffness * forces[e] * edges[e, h]
    return True


@kernel()
def add_edge(
    i: int,
    owner: int,
    mu: float,
    x: float,
    y: float,
    z: float,
    contacts: Array,
    velocities: Array,
    n: int,
    rows: Array,
    edges: Array,
    owners: Indices,
) -> int:
    """Adds the edge of a contact's cone on the side of a unit tangent, and its row; the number of edges then."""
    edges[i, 0] = contacts[owner, K_NORMAL] + mu * x
    edges[i, 1] = contacts[owner, K_NORMAL + 1] + mu * y
    edges[i, 2] = contacts[owner, K_NORMAL + 2] + mu * z
    owners[i] = owner
    for j in range(n):
        rows[i, j] = 0.0
        for h in range(3):
            rows[i, j] -= velocities[owner, h, j] * edges[i, h]
    return i + 1
