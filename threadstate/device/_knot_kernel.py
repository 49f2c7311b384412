"""Points of a path without friction, with their derivatives by the phase while the contacts there are held.

They are those of the linearised conditions of equilibrium, with the Hessian that a descent ends with.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch, zeros
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.contact._stage_kernel import EDGE_THREAD, THREAD_EDGE
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_STIFFNESS,
    N_FUNCTIONS,
    N_JACOBIAN,
    N_ROTATION,
    N_VECTOR,
    PLACE_SIZE,
    second_order,
    set_turn,
)
from threadstate.device._gap_kernel import G_GRADIENT, G_HESSIAN, G_NORM, G_NORMAL, G_PAIR, G_POINT, G_THETA, GAP_SIZE
from threadstate.device._place_near_kernel import set_inward, set_placement
from threadstate.device._places_kernel import MAX_PLACES
from threadstate.device._quadratic_kernel import cholesky, solve_lower, solve_upper
from threadstate.device._rest_kernel import (
    Scene,
    Work,
    coordinate,
    free_coordinates,
    scale,
    set_constraints,
    set_convex_model,
)
from threadstate.device._strip_kernel import C_FORCE, C_NORMAL, C_PAIR, C_POINT, CONTACT_SIZE, MAX_CONTACTS

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

LOADED = 1e-6
"""Part of the push from which on a place counts as a contact."""

# Numbers of contacts that carry a force and of places; 1 where derivatives are known.
K_CONTACTS, K_PLACES, K_RATED = range(3)


class Knot(NamedTuple):
    """A point of a path.

    Attributes:
        numbers: of contacts and places, and whether derivatives are known.
        contacts: those that carry a force, by rows.
        place: the pose in numbers.
        places: contacts and places near by.
        multipliers: what these carry.
        drift: coordinates a radian of phase.
        bend: drift a radian of phase, by its change since the point before; 0 where that has other contacts.
        motion: the same of a chart that stays where it is, so that gaps change by their gradients along it.
        rates: multipliers a radian of phase.
        slopes: of phi from a contact of an edge into both threads; -inf of other places.
    """

    numbers: Indices
    contacts: Array
    place: Array
    places: Array
    multipliers: Array
    drift: Array
    bend: Array
    motion: Array
    rates: Array
    slopes: Array


@kernel(allocates=True)
def new_knot() -> Knot:
    """An empty one."""
    return Knot(
        np.zeros(3, dtype=np.int64),
        np.empty((MAX_CONTACTS, CONTACT_SIZE)),
        np.empty(PLACE_SIZE),
        np.empty((MAX_PLACES + 1, GAP_SIZE)),
        np.empty(MAX_PLACES),
        np.zeros(COORDINATES),
        np.zeros(COORDINATES),
        np.zeros(COORDINATES),
        np.zeros(MAX_PLACES),
        np.empty(MAX_PLACES),
    )


@kernel()
def copy_knot(knot: Knot, other: Knot) -> None:
    """Sets another one to a knot."""
    for i in range(3):
        other.numbers[i] = knot.numbers[i]
    for i in range(knot.numbers[K_CONTACTS]):
        copy_numbers(knot.contacts[i], other.contacts[i])
    for i in range(knot.numbers[K_PLACES]):
        copy_numbers(knot.places[i], other.places[i])
    copy_numbers(knot.place, other.place)
    copy_numbers(knot.multipliers, other.multipliers)
    copy_numbers(knot.drift, other.drift)
    copy_numbers(knot.bend, other.bend)
    copy_numbers(knot.motion, other.motion)
    copy_numbers(knot.rates, other.rates)
    copy_numbers(knot.slopes, other.slopes)


@kernel()
def set_loaded(push: float, knot: Knot) -> None:
    """Sets the contacts that carry a force from a knot's places."""
    used = 0
    for i in range(knot.numbers[K_PLACES]):
        force = knot.multipliers[i] * knot.places[i, G_NORM]
        if force > LOADED * push and used < MAX_CONTACTS:
            contact = knot.contacts[used]
            contact[C_PAIR] = knot.places[i, G_PAIR]
            for j in range(3):
                contact[C_POINT + j] = knot.places[i, G_POINT + j]
                contact[C_NORMAL + j] = knot.places[i, G_NORMAL + j]
            contact[C_FORCE] = force
            used += 1
    knot.numbers[K_CONTACTS] = used


@kernel()
def set_knot(count: int, push: float, command_rates: Array, scene: Scene, knot: Knot) -> None:
    """Sets a knot to where a descent has ended, with ``count`` places.

    ``command_rates`` are the axis about which the command turns the bolt, and what a radian of phase moves the
    commanded place of the centre by, both in the nut's frame.
    """
    work = scene.work
    copy_numbers(work.place, knot.place)
    knot.numbers[K_PLACES] = count
    for i in range(count):
        copy_numbers(work.places[i], knot.places[i])
        knot.multipliers[i] = work.multipliers[i]
    set_loaded(push, knot)
    for j in range(COORDINATES):
        knot.drift[j], knot.bend[j], knot.motion[j] = 0.0, 0.0, 0.0
    set_placement(work.place, scene.threads)
    for i in range(count):
        knot.rates[i], knot.slopes[i] = 0.0, -math.inf
        pair = int(work.places[i, G_PAIR])
        if work.multipliers[i] > 0.0 and (pair == EDGE_THREAD or pair == THREAD_EDGE):
            theta = work.places[i, G_THETA]
            _, _, knot.slopes[i] = set_inward(pair, theta, work.place, scene.bolt, scene.nut, scene.threads)
    knot.numbers[K_RATED] = 1 if set_rates(count, command_rates, scene, knot) else 0


class Carried(NamedTuple):
    """How a radian of phase turns a bolt whose coordinates stay: in its own axes, the same in the chart; and the
    inverse of the chart's J.
    """

    turn: Array
    by_chart: Array
    inverse: Array


@kernel()
def set_carried(command_rates: Array, place: Array, carried: Carried) -> None:
    """Sets it at a pose."""
    turn, by_chart, inverse = carried
    m = place[N_ROTATION : N_ROTATION + 9]
    x, y, z = place[N_VECTOR], place[N_VECTOR + 1], place[N_VECTOR + 2]
    angle2 = x * x + y * y + z * z
    # J is I - a [e] + b [e]^2, its inverse I + [e] / 2 + (1 - sin t / (2 a t)) / t^2 [e]^2.
    sine = 1.0 - place[N_FUNCTIONS + 1] * angle2
    factor = (1.0 - 0.5 * sine / place[N_FUNCTIONS]) / angle2 if angle2 > 0.0 else 1.0 / 12.0
    set_turn(x, y, z, 0.5, factor, inverse)
    for i in range(3):
        turn[i] = m[i] * command_rates[0] + m[3 + i] * command_rates[1] + m[6 + i] * command_rates[2]
    for i in range(3):
        by_chart[i] = inverse[3 * i] * turn[0] + inverse[3 * i + 1] * turn[1] + inverse[3 * i + 2] * turn[2]


@kernel()
def set_pull(count: int, command_rates: Array, carried: Carried, device: Array, work: Work, pull: Array) -> None:
    """Sets what a radian of phase adds to the forces on the coordinates while they stay: of the springs, as the
    commanded place moves, and of the contacts, as the bolt is carried round.
    """
    turn, by_chart, inverse = carried
    jacobian = work.place[N_JACOBIAN : N_JACOBIAN + 9]
    hessian, moment, second = zeros(COORDINATES, 3), zeros(3), scratch(3)
    for i in range(count):
        force = work.multipliers[i]
        if force > 0.0:
            gap = work.places[i]
            for j in range(3):
                for h in range(COORDINATES):
                    hessian[h, j] += force * gap[G_HESSIAN + 6 * h + j]
                for h in range(3):
                    moment[j] += force * inverse[3 * h + j] * gap[G_GRADIENT + h]
    for h in range(COORDINATES):
        pull[h] = 0.0
        for j in range(3):
            pull[h] += device[D_STIFFNESS + 6 * h + 3 + j] * command_rates[3 + j] - hessian[h, j] * by_chart[j]
    # The Hessian in the chart has a part of the chart itself; and turns one after the other do not commute.
    mx = moment[1] * turn[2] - moment[2] * turn[1]
    my = moment[2] * turn[0] - moment[0] * turn[2]
    mz = moment[0] * turn[1] - moment[1] * turn[0]
    for h in range(3):
        pull[h] -= 0.5 * (jacobian[h] * mx + jacobian[3 + h] * my + jacobian[6 + h] * mz)
        for j in range(3):
            second_order(work.place, h, j, second)
            pull[h] += by_chart[j] * (moment[0] * second[0] + moment[1] * second[1] + moment[2] * second[2])


@kernel(allocates=True)
def set_rates(count: int, command_rates: Array, scene: Scene, knot: Knot) -> bool:
    """Sets a knot's derivatives by the phase, which are 0: with contacts held, H q' + A^T m' = pull, A q' = -change.

    Pull and change are those of forces and overlaps while the coordinates stay. False where contacts are not
    independent, or the potential not convex along them. Places and multipliers are those of the last descent.
    """
    device, work = scene.device, scene.work
    n = free_coordinates(device)
    carried, pull = Carried(scratch(3), scratch(3), scratch(9)), scratch(COORDINATES)
    columns, closing = scratch(COORDINATES, COORDINATES), scratch(COORDINATES)
    held = np.empty(COORDINATES, dtype=np.int64)
    set_constraints(n, count, work.places, device, work.normals, work.limits)
    stiffness = set_convex_model(n, count, device, work)
    if math.isnan(stiffness):
        return False
    set_carried(command_rates, work.place, carried)
    set_pull(count, command_rates, carried, device, work, pull)
    rate, size = work.step, 0
    for i in range(n):
        rate[i] = pull[coordinate(i, device)] / scale(coordinate(i, device), device)
    for i in range(count):
        if work.multipliers[i] > 0.0:
            if size == n:
                return False
            own = 0.0
            for j in range(3):
                own += work.places[i, G_GRADIENT + j] * carried.by_chart[j]
            held[size], closing[size] = i, -own
            for j in range(n):
                columns[size, j] = work.normals[i, j]
                rate[j] += stiffness * closing[size] * work.normals[i, j]
            size += 1
    if not solve_held(n, size, work.factor, columns, closing, rate):
        return False
    for i in range(size):
        knot.rates[held[i]] = closing[i]
    for i in range(n):
        j = coordinate(i, device)
        knot.drift[j] = rate[i] / scale(j, device)
    for j in range(COORDINATES):
        knot.motion[j] = knot.drift[j] + (carried.by_chart[j] if j < 3 else 0.0)
    return True


@kernel()
def solve_held(n: int, size: int, lower: Array, columns: Array, closing: Array, rate: Array) -> bool:
    """Solves H x + A^T m = b, A x = c in place: ``rate`` is b and then x, ``closing`` c and then m.

    ``lower`` is the factor of H, ``columns`` are the rows of A, which are changed. False where they are not
    independent.
    """
    gram, factor = scratch(COORDINATES, COORDINATES), scratch(COORDINATES, COORDINATES)
    # In the coordinates in which H is the unit matrix.
    solve_lower(lower, n, rate)
    for i in range(size):
        solve_lower(lower, n, columns[i])
        for j in range(i + 1):
            gram[i, j] = 0.0
            for h in range(n):
                gram[i, j] += columns[i, h] * columns[j, h]
        closing[i] = -closing[i]
        for h in range(n):
            closing[i] += columns[i, h] * rate[h]
    if not cholesky(gram, size, factor):
        return False
    solve_lower(factor, size, closing)
    solve_upper(factor, size, closing)
    for i in range(size):
        for j in range(n):
            rate[j] -= closing[i] * columns[i, j]
    solve_upper(lower, n, rate)
    return True


@kernel()
def set_bend(step: float, here: Knot, there: Knot) -> None:
    """Sets how the derivatives of the coordinates have changed in a step, where both are known."""
    if here.numbers[K_RATED] > 0 and there.numbers[K_RATED] > 0:
        for j in range(COORDINATES):
            there.bend[j] = (there.drift[j] - here.drift[j]) / step
