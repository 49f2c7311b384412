"""The settled state of a command: the push grows from 0, the bolt follows its minimum, and falls where that ends."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.contact._stage_kernel import new_work as new_stage_work
from threadstate.device._certificate_kernel import FREE, overlap
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_CENTRE,
    D_FINE,
    D_PLACE,
    D_ROTATION,
    D_SCALE,
    PLACE_SIZE,
    elastic_energy,
    set_place,
)
from threadstate.device._descent_kernel import (
    AT_REST,
    FLUSH,
    TOO_FAR,
    UNSETTLED,
    Descent,
    descend,
    descend_finely,
    descend_followed,
)
from threadstate.device._flush_kernel import flush_until, set_flush, tip_over
from threadstate.device._gap_kernel import G_VALUE
from threadstate.device._places_kernel import FINE, FINEST, forget_maxima, new_threads
from threadstate.device._rest_kernel import Scene, coordinate, free_coordinates, length_of, new_work, scale, set_metric
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

NO_FIRST_CONTACT = 7
"""Beside the ends of a descent: the search for the first contact was not closed."""

FIRST_PART, LARGEST_PART, LEAST_PART = 1.0 / 8.0, 1.0 / 4.0, 1e-6
"""Steps of the push: the first, the longest, and the shortest, in parts of the whole push."""

STEP_LENGTH = 1e-2
"""How far (nominal radii) the bolt goes in a step of the push, and the least way of a fall."""

FALL_STEP = 5e-3
"""The longest step of a fall, in nominal radii."""

STEPS, FALL_STEPS, LAST_STEPS = 30, 1000, 60
PATH_TOLERANCE, END_TOLERANCE = 1e-7, 1e-10
PATH_OVERLAP, END_OVERLAP = 1e-11, 1e-14
"""Size of the projected descent over the push at which the bolt counts as at rest on the way, and at the end; overlap
(nominal radii) that is left there."""

TIP = 1e-6
"""How far (rad) a flush bolt is tipped where its patch no longer carries the push."""

MAX_FALLS = 16
MAX_PATH = 256

# A fall: the push, coordinates before and after, potential before and after.
F_PUSH, F_BEFORE, F_AFTER, F_POTENTIAL = 0, 1, 7, 13
FALL_SIZE = 15

# A point of the path: push, potential, elastic energy, coordinates.
P_PUSH, P_POTENTIAL, P_ENERGY, P_COORDINATES = 0, 1, 2, 3
PATH_SIZE = 9

# The result: how it ended, the push reached, numbers of falls, of points of the path and of places, what the
# certificate of the end says, and the height of the first contact.
R_STATUS, R_PUSH, R_FALLS, R_PATH, R_PLACES, R_OVERLAP, R_HEIGHT = range(7)
RESULT_SIZE = 7

Rows = tuple[Array, Array, Array, Array, Array, Array, Array]
"""Of each command: result, coordinates, pose, places, multipliers, falls, path."""

OVERLAP_LIMIT = 8e-9
"""The overlap that is excluded at the end, in nominal radii: 1e-9 in on 1/4-20."""

LEAST_GAP = 1e-9
"""Gap (nominal radii) up to which a place of the end counts as touching for the certificate."""


@kernel()
def set_command(rotation: Array, height: float, device: Array, q: Array) -> None:
    """Sets the commanded rotation and place of the centre in a device's numbers, and the coordinates there."""
    for i in range(9):
        device[D_ROTATION + i] = rotation[i]
    for i in range(3):
        device[D_PLACE + i] = device[D_CENTRE] * rotation[3 * i + 2] + (height if i == 2 else 0.0)
        q[i] = 0.0
        q[3 + i] = device[D_PLACE + i]


@kernel()
def add_point(q: Array, push: float, device: Array, path: Array, result: Array) -> None:
    """Adds a point to the path; a full path leaves it out."""
    i = int(result[R_PATH])
    if i == MAX_PATH:
        return
    gradient = scratch(COORDINATES)
    energy = elastic_energy(q, device, gradient)
    path[i, P_PUSH] = push
    path[i, P_POTENTIAL] = energy + push * q[5]
    path[i, P_ENERGY] = energy
    for j in range(COORDINATES):
        path[i, P_COORDINATES + j] = q[j]
    result[R_PATH] = i + 1


@kernel()
def distance(q: Array, other: Array, device: Array) -> float:
    """How far apart two places of the bolt are, in the metric at the first."""
    n = free_coordinates(device)
    place = scratch(PLACE_SIZE)
    metric = scratch(COORDINATES, COORDINATES)
    step = scratch(COORDINATES)
    set_place(q, device, place)
    set_metric(n, place, device, metric)
    for i in range(n):
        j = coordinate(i, device)
        step[i] = (other[j] - q[j]) * scale(j, device)
    return length_of(n, step, metric)


@kernel()
def add_fall(before: Array, after: Array, push: float, device: Array, result: Array, falls: Array) -> bool:
    """Adds a fall at a push, if the bolt has gone far enough for one; False: there are too many."""
    if distance(before, after, device) <= STEP_LENGTH * device[D_SCALE]:
        return True
    count = int(result[R_FALLS])
    if count == MAX_FALLS:
        return False
    gradient = scratch(COORDINATES)
    falls[count, F_PUSH] = push
    falls[count, F_POTENTIAL] = elastic_energy(before, device, gradient) + push * before[5]
    falls[count, F_POTENTIAL + 1] = elastic_energy(after, device, gradient) + push * after[5]
    for j in range(COORDINATES):
        falls[count, F_BEFORE + j] = before[j]
        falls[count, F_AFTER + j] = after[j]
    result[R_FALLS] = count + 1
    return True


@kernel()
def lie_until(q: Array, at: float, push: float, scene: Scene, result: Array, path: Array) -> tuple[bool, float]:
    """Whether a bolt that lies flush at a push ``at`` does so up to the whole one, and the push up to which it does.

    Where the centre of pressure leaves the patch before it is tipped, in place, over the side where that leaves.
    """
    device, bolt, nut, _, _ = scene
    until, direction = flush_until(at, device, bolt, nut, q)
    add_point(q, at, device, path, result)
    if until >= push:
        add_point(q, push, device, path, result)
        return True, push
    reached = max(until, at)
    add_point(q, reached, device, path, result)
    place = scratch(PLACE_SIZE)
    set_place(q, device, place)
    tip_over(direction, TIP, place, q)
    return False, reached


@kernel()
def follow_push(q: Array, tip: Array, push: float, scene: Scene, result: Array, falls: Array, path: Array) -> None:
    """Follows the bolt from ``q``, in place, while the push grows from 0 to ``push``; sets result, falls and path.

    ``tip`` is added to its rotation vector first: a level bolt, which touches along a patch, leaves it that way.
    """
    device, r = scene.device, scene.bolt[pk.R_MAJOR]
    result[R_FALLS], result[R_PATH], result[R_PLACES], result[R_PUSH] = 0, 0, 0, 0.0
    trial = scratch(COORDINATES)
    known = 0
    reached = 0.0
    part = FIRST_PART
    add_point(q, 0.0, device, path, result)
    for i in range(3):
        q[i] += tip[i]
    while reached < push:
        target = min(push, reached + part * push)
        copy_numbers(q, trial)
        wanted = Descent(target, STEP_LENGTH * r, STEP_LENGTH * r, STEPS, PATH_TOLERANCE, PATH_OVERLAP)
        status, found = descend_followed(trial, known, wanted, scene)
        if status == TOO_FAR or status == UNSETTLED:
            known = 0
            if part > LEAST_PART:
                part *= 0.5
                continue
            copy_numbers(q, trial)
            wanted = Descent(target, FALL_STEP * r, math.inf, FALL_STEPS, PATH_TOLERANCE, PATH_OVERLAP)
            status, found = descend(trial, wanted, scene)
            if status == UNSETTLED:
                copy_numbers(q, trial)
                status, found = descend_finely(trial, wanted, scene)
            if status == FLUSH:
                set_flush(device, trial)
            if not add_fall(q, trial, target, device, result, falls):
                result[R_STATUS] = UNSETTLED
                return
            part = FIRST_PART
        known = found if status == AT_REST else 0
        result[R_PUSH] = target
        copy_numbers(trial, q)
        if status == FLUSH:
            stays, reached = lie_until(q, target, push, scene, result, path)
            if stays:
                result[R_STATUS], result[R_PUSH] = FLUSH, push
                return
            part = FIRST_PART
            continue
        add_point(q, target, device, path, result)
        if status != AT_REST:
            result[R_STATUS] = status
            return
        reached = target
        part = min(2.0 * part, LARGEST_PART)
    wanted = Descent(push, STEP_LENGTH * r, STEP_LENGTH * r, LAST_STEPS, END_TOLERANCE, END_OVERLAP)
    status, count = descend_followed(q, known, wanted, scene)
    result[R_STATUS] = status
    result[R_PLACES] = count
    add_point(q, push, device, path, result)


@kernel(nogil=True, allocates=True)
def settle_rows(
    rotations: Array,
    heights: Array,
    tips: Array,
    push: float,
    device: Array,
    bolt: Array,
    nut: Array,
    rows: Rows,
) -> None:
    """Settles commands into rows: rotations of shape (n, 9), heights of shape (n,), tips of shape (n, 3).

    A height is that of the first contact, NaN where it is not certain. A tip is a rotation vector in the commanded
    bolt's axes, zero but of a level bolt (``follow_push``).
    """
    results, ends, placements, places, multipliers, falls, paths = rows
    stage = new_stage_work()
    work = new_work()
    threads = new_threads(bolt)
    scene = Scene(device, bolt, nut, threads, work)
    q = scratch(COORDINATES)
    place = scratch(PLACE_SIZE)
    for i in range(rotations.shape[0]):
        results[i, :] = 0.0
        height = heights[i]
        if math.isnan(height):
            results[i, R_STATUS] = NO_FIRST_CONTACT
            continue
        results[i, R_HEIGHT] = height
        for attempt in range(2):
            device[D_FINE] = FINE if attempt == 0 else FINEST
            set_command(rotations[i], height, device, q)
            forget_maxima(threads)
            follow_push(q, tips[i], push, scene, results[i], falls[i], paths[i])
            copy_numbers(q, ends[i])
            set_place(q, device, place)
            copy_numbers(place[0:12], placements[i])
            if results[i, R_STATUS] != AT_REST:
                break
            count = int(results[i, R_PLACES])
            for j in range(count):
                copy_numbers(work.places[j], places[i, j])
                multipliers[i, j] = work.multipliers[j]
            touching = 0
            for j in range(count):
                if places[i, j, G_VALUE] > -LEAST_GAP * bolt[pk.R_MAJOR]:
                    copy_numbers(places[i, j], work.places[touching])
                    touching += 1
            results[i, R_OVERLAP] = overlap(
                placements[i], OVERLAP_LIMIT * bolt[pk.R_MAJOR], touching, work.places, bolt, nut, stage
            )
            if results[i, R_OVERLAP] == FREE:
                break
