"""A step of a bolt whose contacts stick, slip or open: Coulomb friction by the incremental rule of forces, section 5.

A mode says of each contact what it does in the step. Its equations are the balance of device, push and contacts after
the step, no gap at contacts that stay, and no slip at those that stick; a contact that slips has the friction mu N
against its slip. They are solved on the exact contact functions by Newton's method, with Broyden's update for what the
tangential forces add, and what is found is checked: forces, cones and gaps. Lengths are over the nominal radius, forces
over the push.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_SCALE,
    D_STIFFNESS,
    N_CENTRE,
    N_JACOBIAN,
    N_ROTATION,
    PLACE_SIZE,
    elastic_energy,
    set_place,
)
from threadstate.device._gap_kernel import G_HESSIAN, G_NORM, G_NORMAL, G_PAIR, G_POINT, G_VALUE, GAP_SIZE
from threadstate.device._places_kernel import MAX_PLACES, PLACES_WORK, Threads, find_places
from threadstate.device._rest_kernel import coordinate, free_coordinates, scale

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

OPENS, SLIPS, STICKS = range(3)
"""What a contact does in a step."""

MOST_CONTACTS = 5
"""Contacts whose modes are enumerated; of more a step is not decided."""

MOST_UNKNOWNS = COORDINATES + 3 * MOST_CONTACTS
ITERATIONS, FROZEN, THAW = 40, 10, 1e-6
"""Iterations; in the first ones, until the residual is small, friction has the directions of the slip in the first."""
RESIDUAL = 1e-11
"""Largest residual of a mode's equations: forces over the push, gaps and slips over the nominal radius."""

LONGEST = 0.02
"""The longest change of the coordinates in an iteration, in nominal radii."""

SAME_POINT = 0.1
"""How far (nominal radii) a contact's point may move in a step, and a place be from it to be the same contact."""

TOUCHES = 1e-9
"""Gap (nominal radii) up to which a place touches."""

OVERLAP = 1e-8
"""Overlap (nominal radii) of a place that is no contact, from which on a mode is not consistent."""

SLACK = 1e-9
"""By how much, over the push, a force may be outside its cone."""

REACH = 5e-3
"""Gap, in nominal radii, up to which places are looked for."""

# A contact of a step: point in the nut's frame, unit normal into the bolt, force on the bolt (N), slip of the bolt's
# point over the nut in the step, what it does, pair of features, direction of the slip that friction opposes.
K_POINT, K_NORMAL, K_FORCE, K_SLIP, K_MODE, K_PAIR, K_DIRECTION = 0, 3, 6, 9, 12, 13, 14
CONTACT_SIZE = 17

ModesWork = tuple[Array, Array, Array, Array, Array, Array, Array, Array]
"""Places, search, matrix, spare matrix, residual, unknowns, velocities of points, indices of places."""

SOLVED, UNSOLVED = range(2)


@kernel()
def new_modes_work() -> ModesWork:
    """The arrays of a step."""
    return (
        np.empty((MAX_PLACES + 1, GAP_SIZE)),
        np.empty(PLACES_WORK),
        np.empty((MOST_UNKNOWNS, MOST_UNKNOWNS + 1)),
        np.empty((MOST_UNKNOWNS, MOST_UNKNOWNS + 1)),
        np.empty(MOST_UNKNOWNS),
        np.empty(MOST_UNKNOWNS),
        np.empty((MOST_CONTACTS, 3, COORDINATES)),
        np.empty(MOST_CONTACTS),
    )


@kernel()
def solve_linear(n: int, matrix: Array) -> bool:
    """Solves n equations in place, the right side in column n; False where they are singular."""
    for i in range(n):
        pivot = i
        for j in range(i + 1, n):
            if abs(matrix[j, i]) > abs(matrix[pivot, i]):
                pivot = j
        if not abs(matrix[pivot, i]) > 1e-12:
            return False
        for m in range(n + 1):
            matrix[i, m], matrix[pivot, m] = matrix[pivot, m], matrix[i, m]
        for j in range(i + 1, n):
            factor = matrix[j, i] / matrix[i, i]
            if factor != 0.0:
                for m in range(i, n + 1):
                    matrix[j, m] -= factor * matrix[i, m]
    for i in range(n - 1, -1, -1):
        for m in range(i + 1, n):
            matrix[i, n] -= matrix[i, m] * matrix[m, n]
        matrix[i, n] /= matrix[i, i]
    return True


@kernel()
def set_velocities(point: Array, place: Array, device: Array, out: Array) -> None:
    """Sets the velocity of the bolt's point by each free coordinate, as lengths: 3 rows."""
    n = free_coordinates(device)
    m = place[N_ROTATION : N_ROTATION + 9]
    jacobian = place[N_JACOBIAN : N_JACOBIAN + 9]
    ax, ay, az = point[0] - place[N_CENTRE], point[1] - place[N_CENTRE + 1], point[2] - place[N_CENTRE + 2]
    for i in range(n):
        j = coordinate(i, device)
        if j >= 3:
            for h in range(3):
                out[h, i] = 1.0 if h == j - 3 else 0.0
            continue
        bx, by, bz = jacobian[j], jacobian[3 + j], jacobian[6 + j]
        s = scale(j, device)
        wx = (m[0] * bx + m[1] * by + m[2] * bz) / s
        wy = (m[3] * bx + m[4] * by + m[5] * bz) / s
        wz = (m[6] * bx + m[7] * by + m[8] * bz) / s
        out[0, i], out[1, i], out[2, i] = wy * az - wz * ay, wz * ax - wx * az, wx * ay - wy * ax


@kernel()
def set_slip(before: Array, place: Array, contact: Array) -> None:
    """Sets the slip of a contact: how far the bolt's point there has come along the nut's tangent plane."""
    x = np.empty(3)
    for i in range(3):
        x[i] = contact[K_POINT + i] - place[N_CENTRE + i]
    # In the bolt's axes, then where it was before.
    b = np.empty(3)
    for i in range(3):
        b[i] = place[N_ROTATION + i] * x[0] + place[N_ROTATION + 3 + i] * x[1] + place[N_ROTATION + 6 + i] * x[2]
    along = 0.0
    for i in range(3):
        row = N_ROTATION + 3 * i
        was = before[N_CENTRE + i] + before[row] * b[0] + before[row + 1] * b[1] + before[row + 2] * b[2]
        contact[K_SLIP + i] = contact[K_POINT + i] - was
        along += contact[K_SLIP + i] * contact[K_NORMAL + i]
    for i in range(3):
        contact[K_SLIP + i] -= along * contact[K_NORMAL + i]


@kernel()
def tangent(which: int, contact: Array) -> tuple[float, float, float]:
    """One of two unit vectors across a contact's normal."""
    nx, ny, nz = contact[K_NORMAL], contact[K_NORMAL + 1], contact[K_NORMAL + 2]
    # The nut's x axis, or y where the normal is along x, without its part along the normal.
    ax, ay = (1.0, 0.0) if abs(nx) < 0.8 else (0.0, 1.0)
    along = ax * nx + ay * ny
    ux, uy, uz = ax - along * nx, ay - along * ny, -along * nz
    size = math.sqrt(ux * ux + uy * uy + uz * uz)
    ux, uy, uz = ux / size, uy / size, uz / size
    if which == 0:
        return ux, uy, uz
    return ny * uz - nz * uy, nz * ux - nx * uz, nx * uy - ny * ux


@kernel()
def match_places(count: int, contacts: Array, found: int, places: Array, r: float, indices: Array) -> bool:
    """Sets which place each contact is now, the nearest one; False where one has none."""
    for i in range(count):
        best, nearest = -1, SAME_POINT * r
        for j in range(found):
            taken = False
            for h in range(i):
                taken = taken or int(indices[h]) == j
            apart = 0.0
            for h in range(3):
                apart += (places[j, G_POINT + h] - contacts[i, K_POINT + h]) ** 2
            if not taken and math.sqrt(apart) < nearest:
                best, nearest = j, math.sqrt(apart)
        if best < 0:
            return False
        indices[i] = best
    return True


@kernel()
def set_equations(
    frozen: bool,
    modes: Indices,
    count: int,
    mu: float,
    q: Array,
    push: float,
    unit: float,
    place: Array,
    before: Array,
    device: Array,
    contacts: Array,
    work: ModesWork,
) -> int:
    """Sets residual and matrix of a mode at ``q``, and the contacts' forces from the unknowns; the number of unknowns.

    Of the matrix the change of tangential forces with the pose is left out but for the direction of the slip.
    """
    places, _, matrix, _, residual, unknowns, velocities, indices = work
    n = free_coordinates(device)
    r = device[D_SCALE]
    by_q = np.empty(COORDINATES)
    elastic_energy(q, device, by_q)
    by_q[5] += push
    size = n
    for i in range(count):
        size += 0 if modes[i] == OPENS else (1 if modes[i] == SLIPS else 3)
    for i in range(size):
        residual[i] = 0.0
        for j in range(size):
            matrix[i, j] = 0.0
    for i in range(n):
        a = coordinate(i, device)
        residual[i] = by_q[a] / scale(a, device) / unit
        for j in range(n):
            b = coordinate(j, device)
            matrix[i, j] = device[D_STIFFNESS + 6 * a + b] / (scale(a, device) * scale(b, device)) * r / unit
    row = n
    for c in range(count):
        if modes[c] == OPENS:
            for h in range(3):
                contacts[c, K_FORCE + h] = 0.0
                contacts[c, K_SLIP + h] = 0.0
            continue
        gap = places[int(indices[c])]
        velocity = velocities[c]
        for h in range(3):
            contacts[c, K_POINT + h] = gap[G_POINT + h]
            contacts[c, K_NORMAL + h] = gap[G_NORMAL + h]
        contacts[c, K_PAIR] = gap[G_PAIR]
        set_velocities(gap[G_POINT : G_POINT + 3], place, device, velocity)
        set_slip(before, place, contacts[c])
        normal_force = unknowns[row]
        force = np.empty(3)
        by_normal = np.empty(3)
        slip = math.sqrt(contacts[c, K_SLIP] ** 2 + contacts[c, K_SLIP + 1] ** 2 + contacts[c, K_SLIP + 2] ** 2)
        for h in range(3):
            if not frozen:
                contacts[c, K_DIRECTION + h] = contacts[c, K_SLIP + h] / slip if slip > 0.0 else 0.0
            by_normal[h] = contacts[c, K_NORMAL + h]
            if modes[c] == SLIPS:
                by_normal[h] -= mu * contacts[c, K_DIRECTION + h]
            force[h] = normal_force * by_normal[h]
        for i in range(n):
            for j in range(n):
                a, b = coordinate(i, device), coordinate(j, device)
                bend = gap[G_HESSIAN + 6 * a + b] / (scale(a, device) * scale(b, device))
                matrix[i, j] += normal_force * r / gap[G_NORM] * bend
        residual[row] = gap[G_VALUE] / gap[G_NORM] / r
        for i in range(n):
            along = 0.0
            pushed = 0.0
            for h in range(3):
                along += velocity[h, i] * contacts[c, K_NORMAL + h]
                pushed += velocity[h, i] * by_normal[h]
            matrix[row, i] = -along
            matrix[i, row] = -pushed
        if modes[c] == STICKS:
            for t in range(2):
                ux, uy, uz = tangent(t, contacts[c])
                tangential = unknowns[row + 1 + t]
                force[0] += tangential * ux
                force[1] += tangential * uy
                force[2] += tangential * uz
                residual[row + 1 + t] = (
                    ux * contacts[c, K_SLIP] + uy * contacts[c, K_SLIP + 1] + uz * contacts[c, K_SLIP + 2]
                ) / r
                for i in range(n):
                    along = ux * velocity[0, i] + uy * velocity[1, i] + uz * velocity[2, i]
                    matrix[row + 1 + t, i] = along
                    matrix[i, row + 1 + t] = -along
        elif slip > 0.0 and not frozen:
            # The friction turns with the slip.
            for i in range(n):
                for j in range(n):
                    total = 0.0
                    vs_i, vs_j, vn_i, vn_j = 0.0, 0.0, 0.0, 0.0
                    for h in range(3):
                        total += velocity[h, i] * velocity[h, j]
                        vs_i += velocity[h, i] * contacts[c, K_SLIP + h] / slip
                        vs_j += velocity[h, j] * contacts[c, K_SLIP + h] / slip
                        vn_i += velocity[h, i] * contacts[c, K_NORMAL + h]
                        vn_j += velocity[h, j] * contacts[c, K_NORMAL + h]
                    matrix[i, j] += mu * normal_force * (total - vs_i * vs_j - vn_i * vn_j) * r / slip
        for i in range(n):
            for h in range(3):
                residual[i] -= velocity[h, i] * force[h]
        for h in range(3):
            contacts[c, K_FORCE + h] = force[h] * unit
        row += 1 if modes[c] == SLIPS else 3
    return size


@kernel()
def largest(size: int, values: Array) -> float:
    """The largest size of the first values."""
    worst = 0.0
    for i in range(size):
        worst = max(worst, abs(values[i]))
    return worst


@kernel()
def solve_mode(
    modes: Indices,
    count: int,
    mu: float,
    q: Array,
    push: float,
    unit: float,
    before: Array,
    device: Array,
    bolt: Array,
    nut: Array,
    threads: Threads,
    contacts: Array,
    work: ModesWork,
) -> int:
    """Solves a mode's equations from ``q``, in place; SOLVED where its residuals vanish. Contacts are set.

    ``before`` is the pose before the step; ``unit`` the force that forces are counted in.
    """
    places, search, matrix, spare, residual, unknowns, _, indices = work
    n = free_coordinates(device)
    r = device[D_SCALE]
    place = np.empty(PLACE_SIZE)
    step = np.empty(MOST_UNKNOWNS)
    size = n
    for c in range(count):
        if modes[c] != OPENS:
            normal = 0.0
            for h in range(3):
                normal += contacts[c, K_FORCE + h] * contacts[c, K_NORMAL + h]
            unknowns[size] = normal / unit
            if modes[c] == STICKS:
                unknowns[size + 1] = 0.0
                unknowns[size + 2] = 0.0
            size += 1 if modes[c] == SLIPS else 3
    update = np.zeros((MOST_UNKNOWNS, MOST_UNKNOWNS))
    earlier = np.zeros(MOST_UNKNOWNS)
    expected = np.zeros(MOST_UNKNOWNS)
    frozen, changed = False, True
    for iteration in range(ITERATIONS):
        set_place(q, device, place)
        found = find_places(REACH * r, place, device, bolt, nut, threads, search, places)
        if not match_places(count, contacts, found, places, r, indices):
            return UNSOLVED
        set_equations(frozen, modes, count, mu, q, push, unit, place, before, device, contacts, work)
        worst = largest(size, residual)
        if frozen and (worst < THAW or iteration >= FROZEN):
            frozen, changed = False, True
            set_equations(frozen, modes, count, mu, q, push, unit, place, before, device, contacts, work)
            worst = largest(size, residual)
        if worst < RESIDUAL and not frozen:
            return SOLVED
        if not worst < 1e6:
            return UNSOLVED
        if changed:
            update[:, :] = 0.0
        else:
            # Broyden: what the last step changed beyond what the matrix had expected of it.
            length = 0.0
            for i in range(size):
                length += step[i] * step[i]
            for i in range(n):
                off = (residual[i] - expected[i]) / length
                for j in range(size):
                    update[i, j] += off * step[j]
        changed = False
        if iteration == 0:
            frozen = True
        for i in range(size):
            for j in range(size):
                spare[i, j] = matrix[i, j] + update[i, j]
            spare[i, size] = -residual[i]
        copy_numbers(residual, earlier)
        if not solve_linear(size, spare):
            return UNSOLVED
        longest = 0.0
        for i in range(n):
            longest = max(longest, abs(spare[i, size]))
        part = min(1.0, LONGEST / longest) if longest > 0.0 else 1.0
        for i in range(size):
            step[i] = part * spare[i, size]
        for i in range(n):
            expected[i] = earlier[i]
            for j in range(size):
                expected[i] += (matrix[i, j] + update[i, j]) * step[j]
            j = coordinate(i, device)
            q[j] += step[i] * r / scale(j, device)
        for i in range(n, size):
            unknowns[i] += step[i]
    return UNSOLVED


@kernel()
def is_consistent(
    modes: Indices, count: int, mu: float, unit: float, r: float, found: int, contacts: Array, work: ModesWork
) -> bool:
    """Whether what a mode's equations give is what the mode says: forces in their cones, nothing overlaps.

    ``found`` places are those of the solution.
    """
    places, _, _, _, _, _, _, indices = work
    for c in range(count):
        if modes[c] == OPENS:
            continue
        normal, square = 0.0, 0.0
        for h in range(3):
            normal += contacts[c, K_FORCE + h] * contacts[c, K_NORMAL + h]
            square += contacts[c, K_FORCE + h] ** 2
        if normal < -SLACK * unit:
            return False
        slip = 0.0
        for h in range(3):
            slip += contacts[c, K_SLIP + h] ** 2
        if modes[c] == STICKS:
            across = math.sqrt(max(square - normal * normal, 0.0))
            if across > mu * normal + SLACK * unit:
                return False
        elif not math.sqrt(slip) > TOUCHES * r:
            return False
    for j in range(found):
        is_contact = False
        for c in range(count):
            is_contact = is_contact or (modes[c] != OPENS and int(indices[c]) == j)
        if not is_contact and places[j, G_VALUE] > OVERLAP * r:
            return False
    return True
