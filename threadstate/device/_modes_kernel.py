"""A step of a bolt whose contacts stick, slip or open: Coulomb friction by the incremental rule of forces, section 5.

A mode says of each contact what it does in the step. Its equations are the balance of device, push and contacts after
the step, no gap at contacts that stay, and no slip s at those that stick. At a contact that slips the force T across
the normal is mu N times the direction of T - rho s, with a number rho > 0: that is mu N against the slip, and where the
slip is next to nothing its direction is that of the force before. They are solved on the exact contact functions by
Newton's method, with Broyden's update for what the tangential forces add, and what is found is checked: forces, cones
and gaps. Lengths are over the nominal radius, forces over the push.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch, zeros
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.contact._stage_kernel import THREAD_THREAD
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
from threadstate.device._gap_kernel import (
    G_HESSIAN,
    G_NORM,
    G_NORMAL,
    G_PAIR,
    G_POINT,
    G_THETA,
    G_VALUE,
    G_Z,
    GAP_SIZE,
    GAP_WORK,
    set_gap,
)
from threadstate.device._place_near_kernel import follow_place, is_one_place
from threadstate.device._places_kernel import (
    MAX_PLACES,
    PLACES_WORK,
    W_GAP,
    Threads,
)
from threadstate.device._rest_kernel import coordinate, free_coordinates, scale

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

OPENS, SLIPS, STICKS = range(3)
"""What a contact does in a step."""

MOST_CONTACTS, MOST_CANDIDATES = 5, 8
"""The most contacts that touch at once, and of which the modes are enumerated; of more a step is not decided."""

MOST_UNKNOWNS = COORDINATES + 3 * MOST_CONTACTS
ITERATIONS = 40
RESIDUAL = 1e-11
"""Largest residual of a mode's equations: forces over the push, gaps and slips over the nominal radius."""

STRONGEST = 1e3
"""The largest force of a contact, over the push, that an iteration goes on from. Where two contacts brace each other
most modes have no solution, and Newton's method goes to and fro among such forces until its iterations are over."""

LONGEST = 0.02
"""The longest change of the coordinates in an iteration, in nominal radii."""

FARTHEST = 0.05
"""How far the coordinates may go in all iterations, in nominal radii: more than twice what a step may."""

SOFTNESS = 1e-8
"""By how much (nominal radii) the bolt's point of a contact that sticks gives way, a change of the force across its
normal by the unit. Two contacts that did not at all would fix their points on the line between them twice, and the
forces along it would be anything; so they are what has come up while the contacts stick."""

CONVERGES_AFTER, CONVERGING, FAR_OUT = 2, 0.25, 2.0
"""After so many iterations, one whose step is less than a quarter of that before is converging: if the steps go on so,
it ends within a third of the last one. Where forces are out of their cones by twice that step, they will be."""

LEAST_SLIP = 1e-7
"""The least slip (nominal radii) that the numbers rho of a step are made for."""

SOFT_SLIP = 1e-5
"""The slip (nominal radii) that rho is made for instead, where residuals do not vanish for round-off."""

SOFT_AFTER, SOFT_RESIDUAL = 8, 1e-6
"""After so many iterations with a residual below that one rho is that of SOFT_SLIP."""

SAME_POINT = 0.1
"""How far (nominal radii) a contact's point may move in a step, and a place be from it to be the same contact."""

SAME_PLACE = 1e-6
"""How far apart (nominal radii) a contact of a solution and the place that a search finds of it are at most."""

TOUCHES = 1e-9
"""Gap (nominal radii) up to which a place touches."""

SLIDES = 1e-12
"""Slip (nominal radii) up to which a contact does not slide."""

OVERLAP, COARSE_OVERLAP = 1e-11, 4e-9
"""Overlap (nominal radii) of a place that is no contact, from which on a mode is not consistent: as without friction;
and where the bolt falls or contacts stay at points of a ridge, half of what the certificate of an end allows."""

SLACK = 1e-9
"""By how much, over the push, a force may be outside its cone."""

REACH = 5e-3
"""Gap, in nominal radii, up to which places are looked for."""

# A contact of a step: point in the nut's frame, unit normal into the bolt, force on the bolt (N), slip of the bolt's
# point over the nut in the step, what it does, pair of features, the nut's axis (0: x, 1: y) that its tangents are made
# of, the force before the step, and where on its edge or thread the point is: azimuth and height.
K_POINT, K_NORMAL, K_FORCE, K_SLIP, K_MODE, K_PAIR, K_AXIS, K_HELD, K_THETA, K_Z = 0, 3, 6, 9, 12, 13, 14, 15, 18, 19
CONTACT_SIZE = 20

AS_LISTED = -1
"""Instead of a number of places: they are those of the contacts, one after the other."""

FROZEN_PLACES = MAX_PLACES + 1
"""Where in the list of places those of frozen contacts begin."""


class ModesWork(NamedTuple):
    """The arrays of a step. ``drag`` (6, 6) and ``begun`` (6) are zero but for a bolt that falls.

    ``drag`` is the force over the unit that resists the way from ``begun``, by free coordinates as lengths over the
    nominal radius. ``guess`` (6) is where a step may end whose contacts do what the ``guessed[0]`` first of
    ``guessed_contacts`` do; their forces are those to begin with. Where ``frozen[0]`` is 1 contacts of the threads stay
    at their points of the bolt within an iteration: on a ridge that is nearly level the deepest point runs away.
    """

    places: Array
    search: Array
    matrix: Array
    spare: Array
    residual: Array
    unknowns: Array
    velocities: Array
    indices: Array
    drag: Array
    begun: Array
    guess: Array
    guessed_contacts: Array
    guessed: Indices
    frozen: Indices


SOLVED, UNSOLVED = range(2)


@kernel(allocates=True)
def new_modes_work() -> ModesWork:
    """The arrays of a step of a bolt that does not fall."""
    return ModesWork(
        np.empty((FROZEN_PLACES + MOST_CANDIDATES, GAP_SIZE)),
        np.empty(PLACES_WORK),
        np.empty((MOST_UNKNOWNS, MOST_UNKNOWNS + 1)),
        np.empty((MOST_UNKNOWNS, MOST_UNKNOWNS + 1)),
        np.empty(MOST_UNKNOWNS),
        np.empty(MOST_UNKNOWNS),
        np.empty((MOST_CANDIDATES, 3, COORDINATES)),
        np.empty(MOST_CANDIDATES),
        np.zeros((COORDINATES, COORDINATES)),
        np.zeros(COORDINATES),
        np.zeros(COORDINATES),
        np.zeros((MOST_CANDIDATES, CONTACT_SIZE)),
        np.zeros(1, dtype=np.int64),
        np.zeros(1, dtype=np.int64),
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
        if pivot != i:
            for m in range(i, n + 1):
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
    x = contact[K_POINT] - place[N_CENTRE]
    y = contact[K_POINT + 1] - place[N_CENTRE + 1]
    z = contact[K_POINT + 2] - place[N_CENTRE + 2]
    along = 0.0
    for i in range(3):
        was = before[N_CENTRE + i]
        for j in range(3):
            column = N_ROTATION + j
            # In the bolt's axes, then where it was before.
            was += before[column + 3 * i] * (place[column] * x + place[column + 3] * y + place[column + 6] * z)
        contact[K_SLIP + i] = contact[K_POINT + i] - was
        along += contact[K_SLIP + i] * contact[K_NORMAL + i]
    for i in range(3):
        contact[K_SLIP + i] -= along * contact[K_NORMAL + i]


@kernel()
def tangent(which: int, contact: Array) -> tuple[float, float, float]:
    """One of two unit vectors across a contact's normal; its axis without its part along the normal is the first."""
    nx, ny, nz = contact[K_NORMAL], contact[K_NORMAL + 1], contact[K_NORMAL + 2]
    ax, ay = 1.0 - contact[K_AXIS], contact[K_AXIS]
    along = ax * nx + ay * ny
    ux, uy, uz = ax - along * nx, ay - along * ny, -along * nz
    size = math.sqrt(ux * ux + uy * uy + uz * uz)
    ux, uy, uz = ux / size, uy / size, uz / size
    if which == 0:
        return ux, uy, uz
    return ny * uz - nz * uy, nz * ux - nx * uz, nx * uy - ny * ux


@kernel()
def match_places(modes: Indices, count: int, contacts: Array, found: int, r: float, work: ModesWork) -> bool:
    """Sets which place each contact is now, the nearest one, -1 of one that opens and has none; False where another has
    none. Where contacts are frozen each begins at its own.
    """
    places, indices = work.places, work.indices
    for i in range(count):
        if work.frozen[0] == 1 and modes[i] != OPENS:
            indices[i] = FROZEN_PLACES + i
            gap = places[FROZEN_PLACES + i]
            gap[G_PAIR], gap[G_THETA], gap[G_Z] = contacts[i, K_PAIR], contacts[i, K_THETA], contacts[i, K_Z]
            continue
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
        if best < 0 and modes[i] != OPENS:
            return False
        indices[i] = best
    return True


@kernel()
def follow_contacts(
    modes: Indices,
    count: int,
    contacts: Array,
    place: Array,
    device: Array,
    bolt: Array,
    nut: Array,
    threads: Threads,
    work: ModesWork,
) -> bool:
    """Sets the first places to those of contacts that stay, each followed from its features; False where one is
    nowhere near, or two are one.
    """
    places, search = work.places, work.search
    for c in range(count):
        if modes[c] == OPENS:
            continue
        gap = places[c]
        gap[G_PAIR], gap[G_THETA], gap[G_Z] = contacts[c, K_PAIR], contacts[c, K_THETA], contacts[c, K_Z]
        if gap[G_PAIR] > THREAD_THREAD or not follow_place(gap, place, device, bolt, nut, threads, search):
            return False
        for i in range(c):
            if modes[i] != OPENS and is_one_place(places[i], gap, bolt):
                return False
    return True


@kernel()
def follow_places(
    modes: Indices,
    count: int,
    begin: bool,
    place: Array,
    device: Array,
    bolt: Array,
    nut: Array,
    threads: Threads,
    work: ModesWork,
) -> bool:
    """Sets the places of the contacts that stay anew, from where they were; False where one is not found near by.

    They ``begin`` at places that have been found at this pose, or at their own where contacts are frozen.
    """
    places, search, indices = work.places, work.search, work.indices
    is_frozen = work.frozen[0] == 1
    for c in range(count):
        if modes[c] == OPENS or (begin and not is_frozen):
            continue
        gap = places[int(indices[c])]
        pair = int(gap[G_PAIR])
        stays = is_frozen and pair == THREAD_THREAD
        if begin or stays:
            gap_work = search[W_GAP : W_GAP + GAP_WORK]
            set_gap(pair, gap[G_THETA], gap[G_Z], stays, place, device, bolt, nut, gap_work, gap)
        elif not follow_place(gap, place, device, bolt, nut, threads, search):
            return False
    return True


@kernel()
def set_equations(
    modes: Indices,
    count: int,
    mu: float,
    rho: float,
    keeps_direction: bool,
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

    The unknowns are the coordinates, then of each contact that stays the force along its normal and both tangents. Of
    the matrix the change of tangential forces with the pose is left out, and where friction ``keeps_direction`` that of
    its direction.
    """
    places, indices, velocities, drag, begun = work.places, work.indices, work.velocities, work.drag, work.begun
    matrix, residual, unknowns = work.matrix, work.residual, work.unknowns
    n = free_coordinates(device)
    r = device[D_SCALE]
    by_q = scratch(COORDINATES)
    force, along, ahead = scratch(3), scratch(2), scratch(2)
    basis = scratch(3, 3)
    elastic_energy(q, device, by_q)
    by_q[5] += push
    size = n
    for i in range(count):
        size += 0 if modes[i] == OPENS else 3
    for i in range(size):
        residual[i] = 0.0
        for j in range(size):
            matrix[i, j] = 0.0
    for i in range(n):
        a = coordinate(i, device)
        residual[i] = by_q[a] / scale(a, device) / unit
        for j in range(n):
            b = coordinate(j, device)
            matrix[i, j] = (
                device[D_STIFFNESS + 6 * a + b] / (scale(a, device) * scale(b, device)) * r / unit + drag[i, j]
            )
            residual[i] += drag[i, j] * (q[b] - begun[b]) * scale(b, device) / r
    row = n
    for c in range(count):
        if modes[c] == OPENS:
            for h in range(3):
                contacts[c, K_FORCE + h] = 0.0
                contacts[c, K_SLIP + h] = 0.0
            continue
        gap = places[int(indices[c])]
        velocity = velocities[c]
        set_contact(gap, contacts[c])
        set_velocities(gap[G_POINT : G_POINT + 3], place, device, velocity)
        set_slip(before, place, contacts[c])
        basis[0, 0], basis[0, 1], basis[0, 2] = gap[G_NORMAL], gap[G_NORMAL + 1], gap[G_NORMAL + 2]
        basis[1, 0], basis[1, 1], basis[1, 2] = tangent(0, contacts[c])
        basis[2, 0], basis[2, 1], basis[2, 2] = tangent(1, contacts[c])
        normal_force = unknowns[row]
        for h in range(3):
            force[h] = 0.0
            for t in range(3):
                force[h] += unknowns[row + t] * basis[t, h]
        for i in range(n):
            for j in range(n):
                a, b = coordinate(i, device), coordinate(j, device)
                bend = gap[G_HESSIAN + 6 * a + b] / (scale(a, device) * scale(b, device))
                matrix[i, j] += normal_force * r / gap[G_NORM] * bend
        for t in range(3):
            for i in range(n):
                part = 0.0
                for h in range(3):
                    part += velocity[h, i] * basis[t, h]
                matrix[row + t, i] = -part if t == 0 else part
                matrix[i, row + t] = -part
        residual[row] = gap[G_VALUE] / gap[G_NORM] / r
        for t in range(2):
            along[t] = 0.0
            for h in range(3):
                along[t] += basis[1 + t, h] * contacts[c, K_SLIP + h] / r
            held = 0.0
            for h in range(3):
                held += basis[1 + t, h] * contacts[c, K_HELD + h] / unit
            residual[row + 1 + t] = along[t] + SOFTNESS * (unknowns[row + 1 + t] - held)
            matrix[row + 1 + t, row + 1 + t] = SOFTNESS
        if modes[c] == SLIPS:
            for t in range(2):
                ahead[t] = unknowns[row + 1 + t] - rho * along[t]
            length = math.hypot(ahead[0], ahead[1])
            for t in range(2):
                ahead[t] /= length if length > 0.0 else 1.0
            turned = mu * normal_force / length if length > 0.0 and not keeps_direction else 0.0
            for i in range(n):
                first, second = matrix[row + 1, i], matrix[row + 2, i]
                across = ahead[0] * second - ahead[1] * first
                matrix[row + 1, i] = -turned * rho * ahead[1] * across
                matrix[row + 2, i] = turned * rho * ahead[0] * across
            for t in range(2):
                residual[row + 1 + t] = unknowns[row + 1 + t] - mu * normal_force * ahead[t]
                matrix[row + 1 + t, row] = -mu * ahead[t]
                for m in range(2):
                    same = 1.0 if t == m else 0.0
                    matrix[row + 1 + t, row + 1 + m] = same - turned * (same - ahead[t] * ahead[m])
        for i in range(n):
            for h in range(3):
                residual[i] -= velocity[h, i] * force[h]
        for h in range(3):
            contacts[c, K_FORCE + h] = force[h] * unit
        row += 3
    return size


@kernel()
def set_contact(gap: Array, contact: Array) -> None:
    """Sets point, normal and features of a contact to those of its place."""
    for h in range(3):
        contact[K_POINT + h] = gap[G_POINT + h]
        contact[K_NORMAL + h] = gap[G_NORMAL + h]
    contact[K_PAIR], contact[K_THETA], contact[K_Z] = gap[G_PAIR], gap[G_THETA], gap[G_Z]


@kernel()
def set_first_unknowns(
    modes: Indices,
    count: int,
    mu: float,
    unit: float,
    r: float,
    n: int,
    before: Array,
    place: Array,
    contacts: Array,
    work: ModesWork,
) -> float:
    """Sets the unknown forces to those of the contacts, of one that slips and has none across its normal against the
    slip with which the step begins; rho.
    """
    places, unknowns, indices = work.places, work.unknowns, work.indices
    row = n
    longest = LEAST_SLIP * r
    for c in range(count):
        if modes[c] == OPENS:
            continue
        contact = contacts[c]
        normal = 0.0
        for h in range(3):
            normal += contact[K_FORCE + h] * contact[K_NORMAL + h]
        set_contact(places[int(indices[c])], contact)
        set_slip(before, place, contact)
        contact[K_AXIS] = 0.0 if abs(contact[K_NORMAL]) < 0.8 else 1.0
        slip = math.sqrt(contact[K_SLIP] ** 2 + contact[K_SLIP + 1] ** 2 + contact[K_SLIP + 2] ** 2)
        longest = max(longest, slip)
        unknowns[row] = normal / unit
        for t in range(2):
            ux, uy, uz = tangent(t, contact)
            unknowns[row + 1 + t] = (
                ux * contact[K_FORCE] + uy * contact[K_FORCE + 1] + uz * contact[K_FORCE + 2]
            ) / unit
        if modes[c] == SLIPS and not math.hypot(unknowns[row + 1], unknowns[row + 2]) > 1e-3 * mu * unknowns[row]:
            for t in range(2):
                ux, uy, uz = tangent(t, contact)
                along = ux * contact[K_SLIP] + uy * contact[K_SLIP + 1] + uz * contact[K_SLIP + 2]
                unknowns[row + 1 + t] = -mu * unknowns[row] * along / slip if slip > 0.0 else 0.0
        row += 3
    return mu * r / longest


@kernel()
def largest(size: int, values: Array) -> float:
    """The largest size of the first values."""
    worst = 0.0
    for i in range(size):
        worst = max(worst, abs(values[i]))
    return worst


@kernel()
def leaves_cones(modes: Indices, count: int, mu: float, off: float, forces: Array) -> bool:
    """Whether a contact pulls, or one that sticks has more friction than it can, by more than ``off``.

    ``forces`` are, of each contact that stays, those along its normal and both tangents.
    """
    row = 0
    for c in range(count):
        if modes[c] == OPENS:
            continue
        normal = forces[row]
        if normal < -off:
            return True
        if modes[c] == STICKS and math.hypot(forces[row + 1], forces[row + 2]) > mu * normal + off:
            return True
        row += 3
    return False


@kernel()
def solve_mode(
    modes: Indices,
    count: int,
    mu: float,
    found: int,
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

    It is given up where it converges to forces out of their cones.

    ``before`` is the pose before the step; ``unit`` the force that forces are counted in; ``found`` places are those
    at ``q``, or AS_LISTED: those of the contacts, one after the other. The contacts have the forces to begin with, and
    those before the step.
    """
    matrix, spare, residual, unknowns = work.matrix, work.spare, work.residual, work.unknowns
    n = free_coordinates(device)
    r = device[D_SCALE]
    if found == AS_LISTED:
        for c in range(count):
            work.indices[c] = c
    elif not match_places(modes, count, contacts, found, r, work):
        return UNSOLVED
    place = scratch(PLACE_SIZE)
    step = scratch(MOST_UNKNOWNS)
    update = zeros(MOST_UNKNOWNS, MOST_UNKNOWNS)
    expected = zeros(MOST_UNKNOWNS)
    start = scratch(COORDINATES)
    copy_numbers(q, start)
    set_place(q, device, place)
    follow_places(modes, count, True, place, device, bolt, nut, threads, work)
    rho = set_first_unknowns(modes, count, mu, unit, r, n, before, place, contacts, work)
    taken_before = math.inf
    for iteration in range(ITERATIONS):
        set_place(q, device, place)
        if iteration > 0 and not follow_places(modes, count, False, place, device, bolt, nut, threads, work):
            return UNSOLVED
        size = set_equations(modes, count, mu, rho, False, q, push, unit, place, before, device, contacts, work)
        worst = largest(size, residual)
        if worst < RESIDUAL:
            return SOLVED
        if not worst < 1e6:
            return UNSOLVED
        if iteration >= SOFT_AFTER and worst < SOFT_RESIDUAL and rho > 1.01 * mu / SOFT_SLIP:
            rho = mu / SOFT_SLIP
            for i in range(size):
                for j in range(size):
                    update[i, j] = 0.0
            size = set_equations(modes, count, mu, rho, False, q, push, unit, place, before, device, contacts, work)
            worst = largest(size, residual)
            if worst < RESIDUAL:
                return SOLVED
        if iteration > 0:
            # Broyden: what the last step changed beyond what the matrix had expected of it.
            length = 0.0
            for i in range(size):
                length += step[i] * step[i]
            for i in range(size):
                if i >= n and (i - n) % 3 == 0:
                    continue
                off = (residual[i] - expected[i]) / length if length > 0.0 else 0.0
                for j in range(size):
                    update[i, j] += off * step[j]
        for i in range(size):
            for j in range(size):
                spare[i, j] = matrix[i, j] + update[i, j]
            spare[i, size] = -residual[i]
            expected[i] = residual[i]
        if not solve_linear(size, spare):
            if iteration > 0:
                return UNSOLVED
            # No contact has slid yet: friction keeps its direction in this iteration, which three of them at once
            # would have no motion along.
            set_equations(modes, count, mu, rho, True, q, push, unit, place, before, device, contacts, work)
            for i in range(size):
                copy_numbers(matrix[i, 0:size], spare[i, 0:size])
                spare[i, size] = -residual[i]
            if not solve_linear(size, spare):
                return UNSOLVED
        longest = 0.0
        for i in range(n):
            longest = max(longest, abs(spare[i, size]))
        part = min(1.0, LONGEST / longest) if longest > 0.0 else 1.0
        for i in range(size):
            step[i] = part * spare[i, size]
        away = 0.0
        for i in range(size):
            for j in range(size):
                expected[i] += (matrix[i, j] + update[i, j]) * step[j]
        for i in range(n):
            j = coordinate(i, device)
            q[j] += step[i] * r / scale(j, device)
            away = max(away, abs(q[j] - start[j]) * scale(j, device) / r)
        if away > FARTHEST:
            return UNSOLVED
        for i in range(n, size):
            unknowns[i] += step[i]
        taken = largest(size, step)
        is_converging = iteration >= CONVERGES_AFTER and taken < CONVERGING * taken_before
        if is_converging and leaves_cones(modes, count, mu, FAR_OUT * taken, unknowns[n:]):
            return UNSOLVED
        taken_before = taken
        if not largest(size - n, unknowns[n:]) < STRONGEST:
            return UNSOLVED
    return UNSOLVED


@kernel()
def cones_hold(modes: Indices, count: int, mu: float, unit: float, r: float, contacts: Array, falls: bool) -> bool:
    """Whether the forces of a mode's solution are what the mode says: in their cones, and against the slip.

    A contact of a bolt that ``falls`` may come to rest as it slips, with the friction of one that does.
    """
    for c in range(count):
        if modes[c] == OPENS:
            continue
        normal, square = 0.0, 0.0
        for h in range(3):
            normal += contacts[c, K_FORCE + h] * contacts[c, K_NORMAL + h]
            square += contacts[c, K_FORCE + h] ** 2
        if normal < -SLACK * unit:
            return False
        slip, against = 0.0, 0.0
        for h in range(3):
            slip += contacts[c, K_SLIP + h] ** 2
            against += contacts[c, K_SLIP + h] * contacts[c, K_FORCE + h]
        if modes[c] == STICKS:
            across = math.sqrt(max(square - normal * normal, 0.0))
            if across > mu * normal + SLACK * unit:
                return False
        elif math.sqrt(slip) > SLIDES * r:
            if against > 0.0:
                return False
        elif not falls:
            return False
    return True


@kernel()
def overlap_beside(
    modes: Indices, count: int, r: float, allowed: float, found: int, contacts: Array, places: Array
) -> int:
    """Which of the ``found`` places of a mode's solution overlaps most and is none of its contacts, -1 if none does.

    By more than is ``allowed`` (nominal radii).
    """
    deepest, beside = allowed * r, -1
    for j in range(found):
        is_contact = False
        for c in range(count):
            apart = 0.0
            for h in range(3):
                apart += abs(places[j, G_POINT + h] - contacts[c, K_POINT + h])
            is_contact = is_contact or (modes[c] != OPENS and apart < SAME_PLACE * r)
        if not is_contact and places[j, G_VALUE] > deepest:
            deepest, beside = places[j, G_VALUE], j
    return beside
