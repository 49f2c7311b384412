"""Descents: from a pose to the minimum of the potential that steepest descent over the feasible motions reaches.

The potential is the elastic energy plus the push times the height of the compliance centre. A step minimises a
quadratic model of it under the linearised contacts, as near to the pose as the metric of forces, section 5 over a time
asks (an implicit step of the descent); where the model is convex along the contacts and the step short the time is
unlimited, and the step is Newton's. After a step the bolt is moved out of overlaps the shortest way.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_FINE,
    N_OFFSET,
    N_ROTATION,
    elastic_energy,
    set_place,
)
from threadstate.device._flush_kernel import flush_is_reached
from threadstate.device._gap_kernel import G_VALUE
from threadstate.device._places_kernel import (
    FINEST,
    MAX_PITCHES,
    lowest_height,
)
from threadstate.device._quadratic_kernel import SOLVED, cholesky
from threadstate.device._rest_kernel import (
    Scene,
    Work,
    back_to_contact,
    coordinate,
    free_coordinates,
    length_of,
    scale,
    set_constraints,
    set_convex_model,
    set_gradient,
    set_metric,
    short_descent,
    solve,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

AT_REST, TOO_FAR, UNSETTLED, FLUSH, SLIPPED, DEEP, TILTED = range(7)
"""How a descent ends: at a minimum; farther from its start than allowed; not within its steps; at the level pose on the
nut's surface; beside the nut; deeper in the nut than the parts are modelled; tilted by more than the flanks, where the
bolt's thread can meet the nut's surface."""

DEEPEST = 0.9 * MAX_PITCHES
"""How deep the bolt may be, in thread pitches: above its last searched pitch nothing is then below the surface."""

MAX_SHORTENINGS = 25

ENERGY_NOISE = 1e-13
"""Round-off of the potential, in push times nominal radius; beside it the overlap that a step may leave counts."""

REACH = 1.5
"""Gap, in longest steps, up to which places are constraints of a step; what comes nearer is met on the way out."""

STALL_STEPS, STALLED = 12, 1e-8
"""A descent that has gone less far than this (nominal radii) in so many steps, up at times, goes round in circles: it
ends where it does so again once its steps have to make it smaller."""

CONVERGING = 0.5
"""A descent whose size becomes less than this part of it in a step goes to a minimum at contacts: beside the level pose
on the nut's surface there may be one.
"""


class Descent(NamedTuple):
    """What a descent is asked for.

    The push; the longest step, and how far from its start the bolt may go (lengths in the metric); the most steps; the
    descent's size over the push below which the bolt rests; the overlap (nominal radii) that a step leaves at most.
    """

    push: float
    longest_step: float
    farthest: float
    most_steps: int
    tolerance: float
    overlap_left: float


@kernel()
def move(n: int, step: Array, q: Array, device: Array, trial: Array) -> None:
    """Sets the coordinates after a step."""
    copy_numbers(q, trial)
    for i in range(n):
        j = coordinate(i, device)
        trial[j] += step[i] / scale(j, device)


@kernel()
def length_between(n: int, q: Array, other: Array, device: Array, work: Work) -> float:
    """How far apart two places of the bolt are, in the metric that is set."""
    for i in range(n):
        j = coordinate(i, device)
        work.step[i] = (q[j] - other[j]) * scale(j, device)
    return length_of(n, work.step, work.metric)


@kernel()
def minimise_model(n: int, count: int, damping: float, work: Work) -> float:
    """Sets the step to the minimum of the damped model under the linearised contacts; its length, inf where none is."""
    for i in range(n):
        for j in range(n):
            work.model[i, j] += damping * work.metric[i, j]
    convex = cholesky(work.model, n, work.factor)
    for i in range(n):
        for j in range(n):
            work.model[i, j] -= damping * work.metric[i, j]
    if not convex:
        return math.inf
    status = solve(n, work.factor, count, 0.0, work.forces, work)
    return length_of(n, work.step, work.metric) if status == SOLVED else math.inf


@kernel()
def descend_followed(q: Array, known: int, descent: Descent, scene: Scene) -> tuple[int, int]:
    """As :func:`descend`, with few searches: the first ``known`` of the places are followed from where they are.

    Where it does not settle so it begins anew, and all places are searched for after each step.
    """
    start = scratch(COORDINATES)
    copy_numbers(q, start)
    status, count, _ = descend_with(q, known, False, descent, scene)
    if status != UNSETTLED:
        return status, count
    copy_numbers(start, q)
    return descend(q, descent, scene)


@kernel()
def descend(q: Array, descent: Descent, scene: Scene) -> tuple[int, int]:
    """As :func:`descend_with`, first with the samples of the device's numbers, and from where no step leads on with the
    finest: two places beside each other may be missed between samples, in turns.
    """
    status, count, is_stuck = descend_with(q, 0, True, descent, scene)
    if is_stuck and scene.device[D_FINE] < FINEST:
        return descend_finely(q, descent, scene)
    return status, count


@kernel()
def descend_finely(q: Array, descent: Descent, scene: Scene) -> tuple[int, int]:
    """As :func:`descend_with`, with the finest samples."""
    parts = scene.device[D_FINE]
    scene.device[D_FINE] = FINEST
    status, count, _ = descend_with(q, 0, True, descent, scene)
    scene.device[D_FINE] = parts
    return status, count


class Stand(NamedTuple):
    """Where a descent is.

    The number of places; how far the bolt has gone since all were searched for; the damping that the next step begins
    with; the descent's size and the potential; and whether the steps go to and fro without getting smaller.
    """

    found: int
    way: float
    damping: float
    size: float
    potential: float
    is_circling: bool


class Step(NamedTuple):
    """What a step of a descent leaves behind.

    Whether one was found; the number of places where it ends, and whether all were searched for there; its length; the
    damping that the next one begins with; whether the potential is higher than before.
    """

    is_taken: bool
    found: int
    is_searched: bool
    length: float
    damping: float
    has_risen: bool


@kernel()
def save_contacts(count: int, work: Work) -> None:
    """Saves places and multipliers before a trial."""
    for i in range(count):
        copy_numbers(work.places[i], work.saved[i])
    copy_numbers(work.multipliers, work.saved_multipliers)


@kernel()
def set_pose_again(n: int, q: Array, count: int, push: float, device: Array, work: Work) -> None:
    """Sets what belongs to a pose again, after a trial: places and multipliers that were saved, and what follows."""
    for i in range(count):
        copy_numbers(work.saved[i], work.places[i])
    copy_numbers(work.saved_multipliers, work.multipliers)
    set_place(q, device, work.place)
    set_metric(n, work.place, device, work.metric)
    cholesky(work.metric, n, work.metric_factor)
    set_gradient(n, q, push, device, work.by_q, work.gradient)
    set_constraints(n, count, work.places, device, work.normals, work.limits)


@kernel()
def take_step(q: Array, searches: bool, stand: Stand, descent: Descent, scene: Scene) -> Step:
    """A step of the descent from ``q``, in place; damped until it lowers the potential.

    Where steps go to and fro it is damped until the descent's size is less as well: between two poses that are nearer
    than round-off of the potential tells, on either side of a crease across which a contact goes, neither has the other
    side's model. What belongs to the pose is set: metric, gradient, constraints and multipliers.
    """
    device, bolt, _, _, work = scene
    n, r, push, count, damping = free_coordinates(device), bolt[pk.R_MAJOR], descent.push, stand.found, stand.damping
    reach = REACH * descent.longest_step
    # What it costs to leave the overlaps that are left: opposed contacts carry more than the push.
    owed = max(ENERGY_NOISE, 4.0 * descent.overlap_left) * push * r
    for i in range(count):
        owed += max(work.multipliers[i] * work.places[i, G_VALUE], 0.0)
    set_convex_model(n, count, device, work)
    save_contacts(count, work)
    least = stand.size / descent.longest_step
    for attempt in range(MAX_SHORTENINGS):
        length = minimise_model(n, count, damping, work)
        if not length <= descent.longest_step:
            damping = max(4.0 * damping, 0.1 * least)
            continue
        move(n, work.step, q, device, work.trial)
        copy_numbers(work.trial, work.moved)
        is_last = searches or stand.way + length > descent.longest_step
        trial_count, is_out, is_searched = back_to_contact(
            work.moved, count, is_last, push, reach, descent.overlap_left, scene
        )
        energy = elastic_energy(work.moved, device, work.by_q) + push * work.moved[5]
        is_lower = is_out and energy <= stand.potential + owed
        if is_lower and stand.is_circling:
            set_gradient(n, work.moved, push, device, work.by_q, work.gradient)
            is_lower = short_descent(n, trial_count, push, r, work) < stand.size
        if is_lower:
            copy_numbers(work.moved, q)
            damping = 0.0 if attempt == 0 else 0.25 * damping
            return Step(True, trial_count, is_searched, length, damping, energy > stand.potential)
        damping = max(4.0 * damping, 0.1 * least)
        set_pose_again(n, q, count, push, device, work)
    return Step(False, count, False, 0.0, damping, False)


@kernel()
def end_beside_contacts(scene: Scene) -> int:
    """SLIPPED, DEEP or TILTED where the descent ends so; UNSETTLED where it goes on."""
    place, bolt = scene.work.place, scene.bolt
    r = bolt[pk.R_MAJOR]
    if math.hypot(place[N_OFFSET], place[N_OFFSET + 1]) > r:
        return SLIPPED
    if lowest_height(place, bolt) < -DEEPEST * bolt[pk.P]:
        return DEEP
    if bolt[pk.STEEPEST] * math.hypot(place[N_ROTATION + 2], place[N_ROTATION + 5]) > place[N_ROTATION + 8]:
        return TILTED
    return UNSETTLED


@kernel()
def descend_with(q: Array, known: int, searches: bool, descent: Descent, scene: Scene) -> tuple[int, int, bool]:
    """Descends from ``q``, in place, to a minimum of the potential; how it ended, the number of places there, and
    whether it ended because no step led on.

    The first ``known`` of the places are followed from where they are. All are searched for where none are known, where
    the bolt has gone as far as the longest step since the last search, beyond which it may meet others, and where it
    rests; or after each step, if it ``searches``.
    """
    device, work = scene.device, scene.work
    push, left = descent.push, descent.overlap_left
    n, r = free_coordinates(device), scene.bolt[pk.R_MAJOR]
    reach = REACH * descent.longest_step
    start = scratch(COORDINATES)
    copy_numbers(q, start)
    count, is_out, is_searched = back_to_contact(q, known, searches, push, reach, left, scene)
    if not is_out:
        return UNSETTLED, count, True
    earlier = scratch(COORDINATES)
    copy_numbers(q, earlier)
    way, damping, has_risen, is_circling, size_before = 0.0, 0.0, False, False, math.inf
    for taken in range(descent.most_steps):
        if taken > 0 and taken % STALL_STEPS == 0:
            if has_risen and length_between(n, q, earlier, device, work) < STALLED * r:
                if is_circling:
                    return UNSETTLED, count, True
                is_circling = True
            copy_numbers(q, earlier)
            has_risen = False
        set_metric(n, work.place, device, work.metric)
        if not cholesky(work.metric, n, work.metric_factor):
            return UNSETTLED, count, True
        potential = set_gradient(n, q, push, device, work.by_q, work.gradient)
        set_constraints(n, count, work.places, device, work.normals, work.limits)
        size = short_descent(n, count, push, r, work)
        if size <= descent.tolerance * push:
            if is_searched:
                return AT_REST, count, False
            count, is_out, is_searched = back_to_contact(q, 0, True, push, reach, left, scene)
            if not is_out:
                return UNSETTLED, count, True
            way = 0.0
            continue
        if size > CONVERGING * size_before and flush_is_reached(q, push, work.place, device, scene.bolt, scene.nut):
            return FLUSH, count, False
        size_before = size
        step = take_step(q, searches, Stand(count, way, damping, size, potential, is_circling), descent, scene)
        if not step.is_taken:
            return UNSETTLED, count, True
        count, is_searched, damping = step.found, step.is_searched, step.damping
        has_risen = has_risen or step.has_risen
        way = 0.0 if is_searched else way + step.length
        end = end_beside_contacts(scene)
        if end != UNSETTLED:
            return end, count, False
        if length_between(n, q, start, device, work) > descent.farthest:
            return TOO_FAR, count, False
    return UNSETTLED, count, False
