"""Points of a path without friction with what is certain of the way between two of them.

Between two points at which the same contacts carry the bolt its path is smooth as long as these contacts stay and no
other one is met. Forces, and gaps of the places near by, are differentiated by the phase at both ends: by the
linearised conditions of equilibrium with the contacts held. The cubics through values and derivatives (Hermite's) say
whether a force or a gap would pass through zero within the step.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import copy_numbers
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
from threadstate.device._gap_kernel import G_GRADIENT, G_HESSIAN, G_NORM, G_NORMAL, G_PAIR, G_POINT, G_VALUE, GAP_SIZE
from threadstate.device._place_near_kernel import follow_place
from threadstate.device._places_kernel import MAX_PLACES, SAME_MAXIMUM
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
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

LOADED = 1e-6
"""Part of the push from which on a place counts as a contact."""

LEAST_DIP = 1e-8
"""How far (nominal radii) below zero the cubic of a gap has to go for its place to count as met within a step."""

JUMP = 2e-3
"""The most that a contact's normal changes in a step beside what its derivatives explain."""

NEAR = 0.01
"""How near (nominal radii) a place is taken for the same one whose search leads elsewhere."""

MOVE_REACH = 2e-3
"""How near (nominal radii) a contact begins to where another one has ended if it is that one, at another place."""

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


@kernel()
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
    )


@kernel(allocates=False)
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


@kernel(allocates=False)
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
    for i in range(count):
        knot.rates[i] = 0.0
    knot.numbers[K_RATED] = 1 if set_rates(count, command_rates, scene, knot) else 0


class Carried(NamedTuple):
    """How a radian of phase turns a bolt whose coordinates stay: in its own axes, the same in the chart; and the
    inverse of the chart's J.
    """

    turn: Array
    by_chart: Array
    inverse: Array


@kernel(allocates=False)
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
    hessian, moment, second = np.zeros((COORDINATES, 3)), np.zeros(3), np.empty(3)
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


@kernel()
def set_rates(count: int, command_rates: Array, scene: Scene, knot: Knot) -> bool:
    """Sets a knot's derivatives by the phase, which are 0: with contacts held, H q' + A^T m' = pull, A q' = -change.

    Pull and change are those of forces and overlaps while the coordinates stay.
    False where contacts are not independent, or the potential not convex along them. Places and multipliers are those
    of the last descent.
    """
    device, work = scene.device, scene.work
    n = free_coordinates(device)
    carried, pull = Carried(np.empty(3), np.empty(3), np.empty(9)), np.empty(COORDINATES)
    columns, closing = np.empty((COORDINATES, COORDINATES)), np.empty(COORDINATES)
    gram, factor = np.empty((COORDINATES, COORDINATES)), np.empty((COORDINATES, COORDINATES))
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
    # In the coordinates in which the model is the unit matrix.
    solve_lower(work.factor, n, rate)
    for i in range(size):
        solve_lower(work.factor, n, columns[i])
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
        knot.rates[held[i]] = closing[i]
        for j in range(n):
            rate[j] -= closing[i] * columns[i, j]
    solve_upper(work.factor, n, rate)
    for i in range(n):
        j = coordinate(i, device)
        knot.drift[j] = rate[i] / scale(j, device)
    for j in range(COORDINATES):
        knot.motion[j] = knot.drift[j] + (carried.by_chart[j] if j < 3 else 0.0)
    return True


# A span: the place of one knot and of the next that are the same one (-1: there is none in the list), whether each
# carries a force (1 or 0), the multiplier of each and how far it is open, with derivatives by the phase, and whether it
# is found at both.
SPAN_FROM, SPAN_TO, SPAN_WAS, SPAN_IS, SPAN_MULTIPLIER, SPAN_OPENING, SPAN_WHOLE = 0, 1, 2, 3, 4, 8, 12
SPAN_SIZE = 13
MAX_SPANS = 2 * MAX_PLACES


@kernel(allocates=False)
def set_end(end: int, i: int, gap: Array, push: float, knot: Knot, span: Array) -> None:
    """Sets one end of a span, 0 or 1: place i of a knot, or with -1 a place that is not in its list."""
    span[SPAN_FROM + end] = i
    multiplier, rate = (knot.multipliers[i], knot.rates[i]) if i >= 0 else (0.0, 0.0)
    opening = 0.0
    for j in range(COORDINATES):
        opening -= gap[G_GRADIENT + j] * knot.motion[j]
    span[SPAN_WAS + end] = 1.0 if multiplier * gap[G_NORM] > LOADED * push else 0.0
    span[SPAN_MULTIPLIER + 2 * end], span[SPAN_MULTIPLIER + 2 * end + 1] = multiplier, rate
    span[SPAN_OPENING + 2 * end], span[SPAN_OPENING + 2 * end + 1] = -gap[G_VALUE], opening


@kernel(allocates=False)
def set_no_end(end: int, span: Array) -> None:
    """Sets one end of a span to nothing: its place is not there."""
    span[SPAN_FROM + end] = -1.0
    span[SPAN_WAS + end], span[SPAN_WHOLE] = 0.0, 0.0
    for first in (SPAN_MULTIPLIER, SPAN_OPENING):
        span[first + 2 * end], span[first + 2 * end + 1] = 0.0, 0.0


@kernel(allocates=False)
def index_of(gap: Array, knot: Knot, bolt: Array) -> int:
    """Which place of a knot has the point of another one; -1: none."""
    for i in range(knot.numbers[K_PLACES]):
        apart = 0.0
        for h in range(3):
            apart = max(apart, abs(gap[G_POINT + h] - knot.places[i, G_POINT + h]))
        if apart < SAME_MAXIMUM * bolt[pk.R_MAJOR]:
            return i
    return -1


@kernel(allocates=False)
def nearest_like(gap: Array, near: float, knot: Knot, taken: Array) -> int:
    """Which place of a knot that is not taken has the features of another one and is nearest to it; -1: none is near.

    Nearer than a length, and nearer by at least half than the next.
    """
    best, nearest, next_one = -1, near, math.inf
    for j in range(knot.numbers[K_PLACES]):
        if taken[j] > 0.0 or knot.places[j, G_PAIR] != gap[G_PAIR]:
            continue
        apart = 0.0
        for h in range(3):
            apart = max(apart, abs(gap[G_POINT + h] - knot.places[j, G_POINT + h]))
        if apart < nearest:
            best, nearest, next_one = j, apart, nearest
        elif apart < next_one:
            next_one = apart
    return best if 2.0 * nearest < next_one else -1


@kernel()
def set_spans(one: Knot, other: Knot, push: float, scene: Scene, spans: Array) -> int:
    """Sets a span for each place of two knots; their number.

    A place is followed from each knot to the other. One whose search leads nowhere, or to a place that is another
    one's already, ends.
    """
    device, bolt, nut, threads, work = scene
    gap = np.empty(GAP_SIZE)
    begun = np.zeros(MAX_PLACES)
    taken = np.zeros(MAX_PLACES)
    near = NEAR * bolt[pk.R_MAJOR]
    total = one.numbers[K_PLACES]
    for attempt in range(4):
        # Places that keep their features come first: of an edge's and that of the threads beside it each leads to the
        # other one where they are near enough. Of both contacts come before what carries no force.
        keeps = attempt < 2
        for i in range(total):
            if begun[i] > 0.0 or (attempt % 2 == 0 and one.multipliers[i] == 0.0):
                continue
            copy_numbers(one.places[i], gap)
            is_there = follow_place(gap, other.place, device, bolt, nut, threads, work.search)
            j = index_of(gap, other, bolt) if is_there else -1
            if keeps and not (j >= 0 and taken[j] == 0.0 and gap[G_PAIR] == one.places[i, G_PAIR]):
                j = nearest_like(one.places[i], near, other, taken)
                if j < 0:
                    continue
                copy_numbers(other.places[j], gap)
                is_there = True
            begun[i] = 1.0
            set_end(0, i, one.places[i], push, one, spans[i])
            spans[i, SPAN_WHOLE] = 1.0
            if is_there and (j < 0 or taken[j] == 0.0):
                set_end(1, j, gap, push, other, spans[i])
                if j >= 0:
                    taken[j] = 1.0
            else:
                set_no_end(1, spans[i])
    for j in range(other.numbers[K_PLACES]):
        if taken[j] > 0.0:
            continue
        span = spans[total]
        total += 1
        copy_numbers(other.places[j], gap)
        set_end(1, j, gap, push, other, span)
        span[SPAN_WHOLE] = 1.0
        is_there = follow_place(gap, one.place, device, bolt, nut, threads, work.search)
        if is_there and index_of(gap, one, bolt) < 0:
            set_end(0, -1, gap, push, one, span)
        else:
            set_no_end(0, span)
    join_spans(total, MOVE_REACH * bolt[pk.R_MAJOR], one, other, spans)
    return total


@kernel(allocates=False)
def join_spans(total: int, near: float, one: Knot, other: Knot, spans: Array) -> None:
    """Makes one span of that of a contact that ends and that of one that begins nearer to it than a length.

    Of other features, or of places that are each nowhere at the other knot: where an edge's place and that of the
    threads beside it take turns, or where a place cannot be followed.
    """
    for m in range(total):
        if spans[m, SPAN_WAS] == 0.0 or spans[m, SPAN_IS] > 0.0:
            continue
        was = one.places[int(spans[m, SPAN_FROM])]
        best, nearest = -1, near
        for k in range(total):
            if spans[k, SPAN_WAS] > 0.0 or spans[k, SPAN_IS] == 0.0:
                continue
            now = other.places[int(spans[k, SPAN_TO])]
            apart = 0.0
            for h in range(3):
                apart = max(apart, abs(was[G_POINT + h] - now[G_POINT + h]))
            are_lost = spans[k, SPAN_WHOLE] == 0.0 and spans[m, SPAN_WHOLE] == 0.0
            if apart < nearest and (are_lost or was[G_PAIR] != now[G_PAIR]):
                best, nearest = k, apart
        if best >= 0:
            spans[m, SPAN_TO], spans[m, SPAN_IS], spans[m, SPAN_WHOLE] = spans[best, SPAN_TO], 1.0, 1.0
            for first in (SPAN_MULTIPLIER + 2, SPAN_OPENING + 2):
                spans[m, first], spans[m, first + 1] = spans[best, first], spans[best, first + 1]
            spans[best, SPAN_IS], spans[best, SPAN_WHOLE] = 0.0, 0.0


@kernel(allocates=False)
def least_between(a: float, a1: float, b: float, b1: float, h: float) -> float:
    """The least value on [0, h] of the cubic with these values and derivatives at both ends."""
    c1, c2, c3 = h * a1, 3.0 * (b - a) - h * (2.0 * a1 + b1), 2.0 * (a - b) + h * (a1 + b1)
    least = min(a, b)
    square = c2 * c2 - 3.0 * c1 * c3
    if not square >= 0.0:
        return least
    # Both roots of c1 + 2 c2 s + 3 c3 s^2 without cancellation.
    q = -(c2 + math.copysign(math.sqrt(square), c2))
    for root in (q / (3.0 * c3), c1 / q):
        if 0.0 < root < 1.0:
            least = min(least, a + root * (c1 + root * (c2 + root * c3)))
    return least


@kernel(allocates=False)
def changes(total: int, one: Knot, other: Knot, spans: Array) -> bool:
    """Whether a place carries a force at one end of its span alone, or at both with other features."""
    for k in range(total):
        if spans[k, SPAN_WAS] != spans[k, SPAN_IS]:
            return True
        if spans[k, SPAN_WAS] > 0.0 and has_moved(spans[k], one, other):
            return True
    return False


@kernel(allocates=False)
def has_moved(span: Array, one: Knot, other: Knot) -> bool:
    """Whether a place has other features at the end of its span."""
    return one.places[int(span[SPAN_FROM]), G_PAIR] != other.places[int(span[SPAN_TO]), G_PAIR]


@kernel(allocates=False)
def first_change(total: int, step: float, spans: Array) -> float:
    """About where in a step of the phase the first of its changes comes, from its beginning; NaN where none is sure.

    A force or a gap goes to zero as it does at the beginning, or else as it has come from zero at the end.
    """
    first = math.nan
    for k in range(total):
        span = spans[k]
        if span[SPAN_WAS] == span[SPAN_IS]:
            continue
        before, after = SPAN_MULTIPLIER, SPAN_OPENING + 2
        if span[SPAN_IS] > 0.0:
            before, after = SPAN_OPENING, SPAN_MULTIPLIER + 2
        at = -span[before] / span[before + 1]
        if not 0.0 <= at / step <= 1.0 and span[SPAN_WHOLE] > 0.0:
            at = step - span[after] / span[after + 1]
        if 0.0 <= at / step <= 1.0 and not abs(at) >= abs(first):
            first = at
    return first


@kernel(allocates=False)
def jumps(gap: Array, knot: Knot, far_gap: Array, far: Knot, step: float) -> bool:
    """Whether a contact's normal changes in a step as its derivatives at both ends do not explain."""
    square, jump = 0.0, 0.0
    for i in range(3):
        row = G_HESSIAN + 6 * (3 + i)
        rate = 0.0
        for j in range(COORDINATES):
            rate += gap[row + j] * knot.motion[j] + far_gap[row + j] * far.motion[j]
        change = far_gap[G_GRADIENT + 3 + i] - gap[G_GRADIENT + 3 + i]
        jump = max(jump, abs(change - 0.5 * step * rate))
        square += gap[G_GRADIENT + 3 + i] ** 2
    return jump > JUMP * math.sqrt(square)


@kernel(allocates=False)
def hides_change(total: int, step: float, one: Knot, other: Knot, spans: Array, bolt: Array) -> bool:
    """Whether a contact that is there at both ends of a step is lost in it for a while, or goes to another place, or
    another one is met in it.
    """
    if one.numbers[K_RATED] == 0 or other.numbers[K_RATED] == 0:
        return False
    for k in range(total):
        span = spans[k]
        if span[SPAN_WHOLE] == 0.0:
            continue
        is_contact = span[SPAN_WAS] > 0.0
        first = SPAN_MULTIPLIER if is_contact else SPAN_OPENING
        zero = 0.0 if is_contact else LEAST_DIP * bolt[pk.R_MAJOR]
        least = least_between(span[first], span[first + 1], span[first + 2], span[first + 3], step)
        if least < -zero:
            return True
        if is_contact and jumps(one.places[int(span[SPAN_FROM])], one, other.places[int(span[SPAN_TO])], other, step):
            return True
    return False
