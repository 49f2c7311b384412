"""What becomes of contacts between two points of a path without friction.

Between two points at which the same contacts carry the bolt its path is smooth as long as these contacts stay and no
other one is met. A place is followed from each point to the other: its span. The cubic through a force's or a gap's
values and derivatives at both ends (Hermite's) says whether it would pass through zero within the step.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch, zeros
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.contact._stage_kernel import EDGE_THREAD, THREAD_EDGE
from threadstate.device._chart_kernel import COORDINATES
from threadstate.device._gap_kernel import (
    E_PHI2,
    EDGE_JET_SIZE,
    G_GRADIENT,
    G_HESSIAN,
    G_NORM,
    G_PAIR,
    G_POINT,
    G_THETA,
    G_VALUE,
    GAP_SIZE,
    set_edge_jet,
)
from threadstate.device._knot_kernel import K_PLACES, K_RATED, LOADED, Knot
from threadstate.device._place_near_kernel import follow_place
from threadstate.device._places_kernel import MAX_PLACES, SAME_MAXIMUM, W_JET
from threadstate.device._rest_kernel import Scene
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

LEAST_DIP = 1e-8
"""How far (nominal radii) below zero the cubic of a gap has to go for its place to count as met within a step."""

JUMP = 2e-3
"""The most that a contact's normal changes in a step beside what its derivatives explain."""

NEAR = 0.01
"""How near (nominal radii) a place is taken for the same one whose search leads elsewhere."""

MOVE_REACH = 2e-3
"""How near (nominal radii) a contact begins to where another one has ended if it is that one, at another place."""

# A span: the place of one knot and of the next that are the same one (-1: there is none in the list), whether each
# carries a force (1 or 0), the multiplier of each and how far it is open, with derivatives by the phase, and whether it
# is found at both.
SPAN_FROM, SPAN_TO, SPAN_WAS, SPAN_IS, SPAN_MULTIPLIER, SPAN_OPENING, SPAN_WHOLE = 0, 1, 2, 3, 4, 8, 12
SPAN_SIZE = 13
MAX_SPANS = 2 * MAX_PLACES


@kernel()
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


@kernel()
def set_no_end(end: int, span: Array) -> None:
    """Sets one end of a span to nothing: its place is not there."""
    span[SPAN_FROM + end] = -1.0
    span[SPAN_WAS + end], span[SPAN_WHOLE] = 0.0, 0.0
    for first in (SPAN_MULTIPLIER, SPAN_OPENING):
        span[first + 2 * end], span[first + 2 * end + 1] = 0.0, 0.0


@kernel()
def index_of(gap: Array, knot: Knot, bolt: Array) -> int:
    """Which place of a knot has the point of another one; -1: none."""
    for i in range(knot.numbers[K_PLACES]):
        apart = 0.0
        for h in range(3):
            apart = max(apart, abs(gap[G_POINT + h] - knot.places[i, G_POINT + h]))
        if apart < SAME_MAXIMUM * bolt[pk.R_MAJOR]:
            return i
    return -1


@kernel()
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
    gap = scratch(GAP_SIZE)
    begun = zeros(MAX_PLACES)
    taken = zeros(MAX_PLACES)
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
    total = add_new_spans(total, taken, gap, one, other, push, scene, spans)
    join_spans(total, MOVE_REACH * bolt[pk.R_MAJOR], one, other, spans)
    return total


@kernel()
def add_new_spans(
    total: int, taken: Array, gap: Array, one: Knot, other: Knot, push: float, scene: Scene, spans: Array
) -> int:
    """Adds a span for each place of the second knot that is none of the first one's; their number then."""
    device, bolt, nut, threads, work = scene
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
    return total


@kernel()
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


@kernel()
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


@kernel()
def changes(total: int, one: Knot, other: Knot, spans: Array) -> bool:
    """Whether a place carries a force at one end of its span alone, or at both with other features."""
    for k in range(total):
        if spans[k, SPAN_WAS] != spans[k, SPAN_IS]:
            return True
        if spans[k, SPAN_WAS] > 0.0 and has_moved(spans[k], one, other):
            return True
    return False


@kernel()
def has_moved(span: Array, one: Knot, other: Knot) -> bool:
    """Whether a place has other features at the end of its span."""
    return one.places[int(span[SPAN_FROM]), G_PAIR] != other.places[int(span[SPAN_TO]), G_PAIR]


@kernel()
def first_missed(total: int, spans: Array, bolt: Array) -> int:
    """The first span of a place that is known at its end alone, and overlaps at its beginning; -1 where none does."""
    for k in range(total):
        is_new = spans[k, SPAN_WHOLE] > 0.0 and spans[k, SPAN_FROM] < 0.0
        if is_new and spans[k, SPAN_OPENING] < -LEAST_DIP * bolt[pk.R_MAJOR]:
            return k
    return -1


@kernel()
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


@kernel()
def jumps(was: int, knot: Knot, now: int, far: Knot, step: float) -> bool:
    """Whether a contact's normal changes in a step as its derivatives at both ends do not explain.

    By more than a part of it, or by what it may lack at an end for phi to rise from an edge into the threads.
    """
    gap, far_gap = knot.places[was], far.places[now]
    square, jump = 0.0, 0.0
    for i in range(3):
        row = G_HESSIAN + 6 * (3 + i)
        rate = 0.0
        for j in range(COORDINATES):
            rate += gap[row + j] * knot.motion[j] + far_gap[row + j] * far.motion[j]
        change = far_gap[G_GRADIENT + 3 + i] - gap[G_GRADIENT + 3 + i]
        jump = max(jump, abs(change - 0.5 * step * rate))
        square += gap[G_GRADIENT + 3 + i] ** 2
    return jump > min(JUMP * math.sqrt(square), min(abs(knot.slopes[was]), abs(far.slopes[now])))


@kernel()
def leaves_its_maximum(gap: Array, place: Array, scene: Scene) -> bool:
    """Whether phi along its edge curves upwards, at a pose, where a contact of an edge is at another pose.

    Where a fillet comes to the edge a second maximum may have begun, and the first one ended.
    """
    pair, bolt, nut = int(gap[G_PAIR]), scene.bolt, scene.nut
    jet = scene.work.search[W_JET : W_JET + EDGE_JET_SIZE]
    if pair == EDGE_THREAD:
        set_edge_jet(True, gap[G_THETA], place, bolt, nut, jet)
    elif pair == THREAD_EDGE:
        set_edge_jet(False, gap[G_THETA], place, nut, bolt, jet)
    else:
        return False
    return jet[E_PHI2] > 0.0


@kernel()
def hides_change(total: int, step: float, one: Knot, other: Knot, spans: Array, scene: Scene) -> bool:
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
        zero = 0.0 if is_contact else LEAST_DIP * scene.bolt[pk.R_MAJOR]
        least = least_between(span[first], span[first + 1], span[first + 2], span[first + 3], step)
        if least < -zero:
            return True
        was, now = int(span[SPAN_FROM]), int(span[SPAN_TO])
        if is_contact and (
            jumps(was, one, now, other, step)
            or leaves_its_maximum(one.places[was], other.place, scene)
            or leaves_its_maximum(other.places[now], one.place, scene)
        ):
            return True
    return False
