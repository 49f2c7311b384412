"""From a pose to the minimum of the potential that steepest descent over the feasible motions reaches.

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
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_CENTRE,
    D_FINE,
    D_RIGID,
    D_SCALE,
    D_STIFFNESS,
    N_JACOBIAN,
    N_OFFSET,
    N_ROTATION,
    PLACE_SIZE,
    elastic_energy,
    set_place,
)
from threadstate.device._flush_kernel import flush_is_reached
from threadstate.device._gap_kernel import G_GRADIENT, G_HESSIAN, G_VALUE, GAP_SIZE
from threadstate.device._place_near_kernel import follow_all
from threadstate.device._places_kernel import (
    FINEST,
    MAX_PITCHES,
    MAX_PLACES,
    PLACES_WORK,
    Threads,
    find_places,
    lowest_height,
)
from threadstate.device._quadratic_kernel import SOLVED, cholesky, solve_program
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

AT_REST, TOO_FAR, UNSETTLED, FLUSH, SLIPPED, DEEP, TILTED = range(7)
"""How a descent ends: at a minimum; farther from its start than allowed; not within its steps; at the level pose on the
nut's surface; beside the nut; deeper in the nut than the parts are modelled; tilted by more than the flanks, where the
bolt's thread can meet the nut's surface."""

NEAR = 1e-3
"""How far (nominal radii) the push alone would take the bolt in the step from which multipliers are estimated."""

DEEPEST = 0.9 * MAX_PITCHES
"""How deep the bolt may be, in thread pitches: above its last searched pitch nothing is then below the surface."""

LOADED = 1e-6
"""Part of the push from which on a contact carries so much that the bolt is brought back to it."""

MAX_CORRECTIONS = 6
"""So many corrections on the way back; more of them only where each leaves less than ``SLOWEST``."""

SLOWEST = 0.3
"""Part of overlaps and gaps that a correction leaves where it converges: a fourth at a double root."""

MAX_SHORTENINGS = 25
STIFFENING = (1e2, 1e4, 1e6)
"""How much stiffer than the device the model is made across contacts that stay, where that changes no step: the first
that makes it convex. With the last it is about as convex as along the contacts.
"""

ENERGY_NOISE = 1e-13
"""Round-off of the potential, in push times nominal radius; beside it the overlap that a step may leave counts."""

REACH = 1.5
"""Gap, in longest steps, up to which places are constraints of a step; what comes nearer is met on the way out."""

STALL_STEPS, STALLED = 12, 1e-8
"""A descent that has gone less far than this (nominal radii) in so many steps, up at times, goes round in circles."""


class Work(NamedTuple):
    """The scratch arrays of a descent.

    Attributes:
        places: contacts and places near by, at the pose of the last search.
        normals: linearised constraints of the places.
        limits: their right-hand sides.
        forces: multipliers of a program.
        program: scratch of programs.
        active: constraints that hold in a program.
        model: Hessian of the quadratic model.
        factor: its Cholesky factor.
        metric: metric at the bolt's origin.
        metric_factor: its Cholesky factor.
        gradient: of the potential, in the free coordinates as lengths.
        step: a step in them.
        trial: coordinates after a step.
        moved: coordinates after the way back from there.
        by_q: gradient of a potential in the coordinates.
        place: pose in numbers.
        search: scratch of searches.
        multipliers: what the places carry.
        saved: places before a trial.
        saved_multipliers: multipliers before a trial.
    """

    places: Array
    normals: Array
    limits: Array
    forces: Array
    program: Array
    active: Indices
    model: Array
    factor: Array
    metric: Array
    metric_factor: Array
    gradient: Array
    step: Array
    trial: Array
    moved: Array
    by_q: Array
    place: Array
    search: Array
    multipliers: Array
    saved: Array
    saved_multipliers: Array


class Scene(NamedTuple):
    """Among what a bolt descends: the device's numbers, both packed profiles, what is known of both threads, and the
    scratch arrays.
    """

    device: Array
    bolt: Array
    nut: Array
    threads: Threads
    work: Work


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
def new_work() -> Work:
    """New scratch arrays."""
    return Work(
        np.empty((MAX_PLACES + 1, GAP_SIZE)),
        np.empty((2 * MAX_PLACES, COORDINATES)),
        np.empty(2 * MAX_PLACES),
        np.empty(2 * MAX_PLACES),
        np.empty(12 * MAX_PLACES + 90),
        np.empty(COORDINATES + 2, dtype=np.int64),
        np.empty((COORDINATES, COORDINATES)),
        np.empty((COORDINATES, COORDINATES)),
        np.empty((COORDINATES, COORDINATES)),
        np.empty((COORDINATES, COORDINATES)),
        np.empty(COORDINATES),
        np.empty(COORDINATES),
        np.empty(COORDINATES),
        np.empty(COORDINATES),
        np.empty(COORDINATES),
        np.empty(PLACE_SIZE),
        np.empty(PLACES_WORK),
        np.empty(MAX_PLACES),
        np.empty((MAX_PLACES, GAP_SIZE)),
        np.empty(MAX_PLACES),
    )


@kernel(allocates=False)
def coordinate(i: int, device: Array) -> int:
    """Which coordinate the i-th free one is: a rigid twist leaves out the third."""
    return i + 1 if device[D_RIGID] > 0.0 and i >= 2 else i


@kernel(allocates=False)
def scale(j: int, device: Array) -> float:
    """What a coordinate is multiplied by to be a length."""
    return device[D_SCALE] if j < 3 else 1.0


@kernel()
def set_metric(n: int, place: Array, device: Array, metric: Array) -> None:
    """Sets the metric diag(r^2, r^2, r^2, 1, 1, 1) at the bolt's origin in the free coordinates as lengths."""
    r, c = device[D_SCALE], device[D_CENTRE]
    m = place[N_ROTATION : N_ROTATION + 9]
    jacobian = place[N_JACOBIAN : N_JACOBIAN + 9]
    turn = np.zeros((6, 3))
    shift = np.zeros((6, 3))
    for i in range(n):
        j = coordinate(i, device)
        if j < 3:
            for h in range(3):
                turn[i, h] = jacobian[3 * h + j]
            # The origin is C - c R z: it moves by -c R (w x z), w x z = (w_y, -w_x, 0).
            for h in range(3):
                shift[i, h] = -c / r * (m[3 * h] * turn[i, 1] - m[3 * h + 1] * turn[i, 0])
        else:
            shift[i, j - 3] = 1.0
    for i in range(n):
        for j in range(n):
            total = 0.0
            for h in range(3):
                total += turn[i, h] * turn[j, h] + shift[i, h] * shift[j, h]
            metric[i, j] = total


@kernel(allocates=False)
def length_of(n: int, step: Array, metric: Array) -> float:
    """The length of a step in the metric."""
    total = 0.0
    for i in range(n):
        for j in range(n):
            total += step[i] * metric[i, j] * step[j]
    return math.sqrt(max(total, 0.0))


@kernel(allocates=False)
def set_constraints(n: int, count: int, places: Array, device: Array, normals: Array, limits: Array) -> None:
    """Sets the linearised contacts ``normals . step <= limits`` in the free coordinates as lengths."""
    for i in range(count):
        for m in range(n):
            j = coordinate(m, device)
            normals[i, m] = places[i, G_GRADIENT + j] / scale(j, device)
        limits[i] = -places[i, G_VALUE]


@kernel(allocates=False)
def move(n: int, step: Array, q: Array, device: Array, trial: Array) -> None:
    """Sets the coordinates after a step."""
    copy_numbers(q, trial)
    for i in range(n):
        j = coordinate(i, device)
        trial[j] += step[i] / scale(j, device)


@kernel(allocates=False)
def free_coordinates(device: Array) -> int:
    """How many coordinates are free."""
    return COORDINATES - 1 if device[D_RIGID] > 0.0 else COORDINATES


@kernel(allocates=False)
def set_gradient(n: int, q: Array, push: float, device: Array, by_q: Array, gradient: Array) -> float:
    """The potential; sets its gradient in the free coordinates as lengths."""
    energy = elastic_energy(q, device, by_q)
    by_q[5] += push
    for i in range(n):
        j = coordinate(i, device)
        gradient[i] = by_q[j] / scale(j, device)
    return energy + push * q[5]


@kernel(allocates=False)
def length_between(n: int, q: Array, other: Array, device: Array, work: Work) -> float:
    """How far apart two places of the bolt are, in the metric that is set."""
    for i in range(n):
        j = coordinate(i, device)
        work.step[i] = (q[j] - other[j]) * scale(j, device)
    return length_of(n, work.step, work.metric)


@kernel(allocates=False)
def short_descent(n: int, count: int, push: float, r: float, work: Work) -> float:
    """The size of a short step of the steepest descent over the feasible motions; sets the contacts' multipliers.

    The size is a force: it is that of the gradient where nothing is near, and zero at an equilibrium alone. Metric, its
    factor, gradient, normals and limits are set.
    """
    gradient, step, multipliers = work.gradient, work.step, work.multipliers
    stiffness = push / (NEAR * r)
    for i in range(n):
        gradient[i] /= stiffness
    solve_program(
        n,
        work.metric_factor,
        gradient,
        count,
        work.normals,
        work.limits,
        0.0,
        work.program,
        work.active,
        step,
        multipliers,
    )
    for i in range(n):
        gradient[i] *= stiffness
    for i in range(count):
        multipliers[i] *= stiffness
    return stiffness * length_of(n, step, work.metric)


@kernel(allocates=False)
def add_pressing(n: int, count: int, push: float, work: Work) -> tuple[int, float]:
    """Adds the constraints that keep the bolt on the contacts on which it presses to those of the places.

    Returns how many there are then, and the larger of the overlaps and of the gaps of those contacts times the parts of
    the push that they carry.
    """
    worst = 0.0
    rows = count
    for j in range(count):
        value = work.places[j, G_VALUE]
        worst = max(worst, value)
        if work.multipliers[j] > LOADED * push:
            worst = max(worst, -value * work.multipliers[j] / push)
            for m in range(n):
                work.normals[rows, m] = -work.normals[j, m]
            work.limits[rows] = value
            rows += 1
    return rows, worst


@kernel()
def back_to_contact(
    q: Array, known: int, is_last: bool, push: float, reach: float, left: float, scene: Scene
) -> tuple[int, bool, bool]:
    """Moves the bolt, in place, the shortest way out of overlaps and back to the contacts on which it presses.

    Returns the number of places found then, whether overlaps, and gaps of those contacts times the parts of the push
    that they carry, are at most ``left`` (nominal radii), and whether all places have been searched for there. The
    places, and the pose in numbers, are those of the result. Without the way back a step along curved contacts would
    end beside them, at a higher potential than its model has. On the way the first ``known`` of the places are followed
    from where they are; where they are met all are searched for if ``is_last``.
    """
    device, bolt, nut, threads, work = scene
    n = free_coordinates(device)
    r = bolt[pk.R_MAJOR]
    count, corrections, searches = known, 0, known == 0
    earlier = math.inf
    while True:
        set_place(q, device, work.place)
        if not searches:
            searches = not follow_all(count, work.place, device, bolt, nut, threads, work.search, work.places)
        if searches:
            count = find_places(reach, work.place, device, bolt, nut, threads, work.search, work.places)
        set_metric(n, work.place, device, work.metric)
        if not cholesky(work.metric, n, work.metric_factor):
            return count, False, searches
        set_constraints(n, count, work.places, device, work.normals, work.limits)
        set_gradient(n, q, push, device, work.by_q, work.gradient)
        short_descent(n, count, push, r, work)
        rows, worst = add_pressing(n, count, push, work)
        if worst <= left * r:
            if searches or not is_last:
                return count, True, searches
            searches = True
            continue
        corrections += 1
        if corrections >= MAX_CORRECTIONS and worst > SLOWEST * earlier:
            return count, False, searches
        earlier = worst
        searches = count == 0
        if not correct(n, rows, 1e-3 * left * r, q, device, work) < r:
            return count, False, False


@kernel(allocates=False)
def correct(n: int, rows: int, tolerance: float, q: Array, device: Array, work: Work) -> float:
    """Moves the bolt, in place, the shortest way to where the linearised constraints hold; how far, NaN: there is none.

    A way of a nominal radius and more is not gone.
    """
    gradient, step = work.gradient, work.step
    for j in range(n):
        gradient[j] = 0.0
    status = solve_program(
        n,
        work.metric_factor,
        gradient,
        rows,
        work.normals,
        work.limits,
        tolerance,
        work.program,
        work.active,
        step,
        work.forces,
    )
    if status != SOLVED:
        return math.nan
    length = length_of(n, step, work.metric)
    if length < device[D_SCALE]:
        for m in range(n):
            j = coordinate(m, device)
            q[j] += step[m] / scale(j, device)
    return length


@kernel(allocates=False)
def set_model(n: int, count: int, device: Array, stiffening: float, work: Work) -> None:
    """Sets the Hessian of the potential with the contacts' curvature, by the multipliers; stiffer across contacts."""
    places, normals, multipliers = work.places, work.normals, work.multipliers
    for i in range(n):
        a = coordinate(i, device)
        for j in range(n):
            b = coordinate(j, device)
            total = device[D_STIFFNESS + 6 * a + b]
            for m in range(count):
                if multipliers[m] > 0.0:
                    total += multipliers[m] * places[m, G_HESSIAN + 6 * a + b]
            total /= scale(a, device) * scale(b, device)
            for m in range(count):
                if multipliers[m] > 0.0:
                    total += stiffening * normals[m, i] * normals[m, j]
            work.model[i, j] = total


@kernel(allocates=False)
def set_convex_model(n: int, count: int, device: Array, work: Work) -> None:
    """Sets the model, as stiff across contacts as it takes to be convex; as stiff as ever where it never is."""
    stiffness = 0.0
    for i in range(n):
        j = coordinate(i, device)
        stiffness = max(stiffness, device[D_STIFFNESS + 7 * j] / scale(j, device) ** 2)
    for stiffening in STIFFENING:
        set_model(n, count, device, stiffening * stiffness, work)
        if cholesky(work.model, n, work.factor):
            return


@kernel(allocates=False)
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
    status = solve_program(
        n,
        work.factor,
        work.gradient,
        count,
        work.normals,
        work.limits,
        0.0,
        work.program,
        work.active,
        work.step,
        work.forces,
    )
    return length_of(n, work.step, work.metric) if status == SOLVED else math.inf


@kernel()
def descend_followed(q: Array, known: int, descent: Descent, scene: Scene) -> tuple[int, int]:
    """As :func:`descend`, with few searches: the first ``known`` of the places are followed from where they are.

    Where it does not settle so it begins anew, and all places are searched for after each step.
    """
    start = q.copy()
    status, count, _ = descend_with(q, known, False, descent, scene)
    if status != UNSETTLED:
        return status, count
    copy_numbers(start, q)
    return descend(q, descent, scene)


@kernel(allocates=False)
def descend(q: Array, descent: Descent, scene: Scene) -> tuple[int, int]:
    """As :func:`descend_with`, first with the samples of the device's numbers, and from where no step leads on with the
    finest: two places beside each other may be missed between samples, in turns.
    """
    device = scene.device
    parts = device[D_FINE]
    status, count, is_stuck = descend_with(q, 0, True, descent, scene)
    if is_stuck and parts < FINEST:
        device[D_FINE] = FINEST
        status, count, _ = descend_with(q, 0, True, descent, scene)
        device[D_FINE] = parts
    return status, count


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


@kernel(allocates=False)
def take_step(
    q: Array,
    count: int,
    searches: bool,
    way: float,
    damping: float,
    size: float,
    potential: float,
    descent: Descent,
    scene: Scene,
) -> Step:
    """A step of the descent from ``q``, in place; damped until it lowers the potential.

    The bolt has gone a ``way`` since the last search; ``size`` and ``potential`` are those at ``q``. What belongs to
    the pose is set: metric, gradient, constraints and multipliers.
    """
    device, bolt, _, _, work = scene
    n, r, push = free_coordinates(device), bolt[pk.R_MAJOR], descent.push
    reach = REACH * descent.longest_step
    # What it costs to leave the overlaps that are left: opposed contacts carry more than the push.
    owed = max(ENERGY_NOISE, 4.0 * descent.overlap_left) * push * r
    for i in range(count):
        owed += max(work.multipliers[i] * work.places[i, G_VALUE], 0.0)
    set_convex_model(n, count, device, work)
    for i in range(count):
        copy_numbers(work.places[i], work.saved[i])
    copy_numbers(work.multipliers, work.saved_multipliers)
    least = size / descent.longest_step
    for attempt in range(MAX_SHORTENINGS):
        length = minimise_model(n, count, damping, work)
        if not length <= descent.longest_step:
            damping = max(4.0 * damping, 0.1 * least)
            continue
        move(n, work.step, q, device, work.trial)
        copy_numbers(work.trial, work.moved)
        is_last = searches or way + length > descent.longest_step
        trial_count, is_out, is_searched = back_to_contact(
            work.moved, count, is_last, push, reach, descent.overlap_left, scene
        )
        energy = elastic_energy(work.moved, device, work.by_q) + push * work.moved[5]
        if is_out and energy <= potential + owed:
            copy_numbers(work.moved, q)
            damping = 0.0 if attempt == 0 else 0.25 * damping
            return Step(True, trial_count, is_searched, length, damping, energy > potential)
        # The places are those of the trial: set what belongs to the pose again.
        damping = max(4.0 * damping, 0.1 * least)
        for i in range(count):
            copy_numbers(work.saved[i], work.places[i])
        copy_numbers(work.saved_multipliers, work.multipliers)
        set_place(q, device, work.place)
        set_metric(n, work.place, device, work.metric)
        cholesky(work.metric, n, work.metric_factor)
        set_gradient(n, q, push, device, work.by_q, work.gradient)
        set_constraints(n, count, work.places, device, work.normals, work.limits)
    return Step(False, count, False, 0.0, damping, False)


@kernel()
def end_beside_contacts(q: Array, push: float, scene: Scene) -> int:
    """SLIPPED, DEEP, TILTED or FLUSH where the descent ends so; UNSETTLED where it goes on."""
    device, bolt, nut, _, work = scene
    place, r = work.place, bolt[pk.R_MAJOR]
    if math.hypot(place[N_OFFSET], place[N_OFFSET + 1]) > r:
        return SLIPPED
    if lowest_height(place, bolt) < -DEEPEST * bolt[pk.P]:
        return DEEP
    if bolt[pk.STEEPEST] * math.hypot(place[N_ROTATION + 2], place[N_ROTATION + 5]) > place[N_ROTATION + 8]:
        return TILTED
    return FLUSH if flush_is_reached(q, push, place, device, bolt, nut) else UNSETTLED


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
    start = q.copy()
    count, is_out, is_searched = back_to_contact(q, known, searches, push, reach, left, scene)
    if not is_out:
        return UNSETTLED, count, True
    earlier = q.copy()
    way, damping, has_risen = 0.0, 0.0, False
    for taken in range(descent.most_steps):
        if taken > 0 and taken % STALL_STEPS == 0:
            if has_risen and length_between(n, q, earlier, device, work) < STALLED * r:
                return UNSETTLED, count, True
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
        step = take_step(q, count, searches, way, damping, size, potential, descent, scene)
        if not step.is_taken:
            return UNSETTLED, count, True
        count, is_searched, damping = step.found, step.is_searched, step.damping
        has_risen = has_risen or step.has_risen
        way = 0.0 if is_searched else way + step.length
        end = end_beside_contacts(q, push, scene)
        if end != UNSETTLED:
            return end, count, False
        if length_between(n, q, start, device, work) > descent.farthest:
            return TOO_FAR, count, False
    return UNSETTLED, count, False
