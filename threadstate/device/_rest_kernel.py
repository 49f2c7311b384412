"""What a descent is made of: the metric, the linearised contacts and what they carry, the quadratic model, and the way
back to the contacts after a step.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import zeros
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_CENTRE,
    D_RIGID,
    D_SCALE,
    D_STIFFNESS,
    N_JACOBIAN,
    N_ROTATION,
    PLACE_SIZE,
    elastic_energy,
    set_place,
)
from threadstate.device._gap_kernel import G_GRADIENT, G_HESSIAN, G_VALUE, GAP_SIZE
from threadstate.device._place_near_kernel import follow_all
from threadstate.device._places_kernel import (
    MAX_PLACES,
    PLACES_WORK,
    Threads,
    find_places,
)
from threadstate.device._quadratic_kernel import SOLVED, cholesky, solve_program
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

NEAR = 1e-3
"""How far (nominal radii) the push alone would take the bolt in the step from which multipliers are estimated."""

LOADED = 1e-6
"""Part of the push from which on a contact carries so much that the bolt is brought back to it."""

MAX_CORRECTIONS = 6
"""So many corrections on the way back; more of them only where each leaves less than ``SLOWEST``."""

SLOWEST = 0.3
"""Part of overlaps and gaps that a correction leaves where it converges: a fourth at a double root."""

STIFFENING = (1e2, 1e4, 1e6)
"""How much stiffer than the device the model is made across contacts that stay, where that changes no step: the first
that makes it convex. With the last it is about as convex as along the contacts.
"""


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


@kernel(allocates=True)
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


@kernel()
def coordinate(i: int, device: Array) -> int:
    """Which coordinate the i-th free one is: a rigid twist leaves out the third."""
    return i + 1 if device[D_RIGID] > 0.0 and i >= 2 else i


@kernel()
def scale(j: int, device: Array) -> float:
    """What a coordinate is multiplied by to be a length."""
    return device[D_SCALE] if j < 3 else 1.0


@kernel()
def set_metric(n: int, place: Array, device: Array, metric: Array) -> None:
    """Sets the metric diag(r^2, r^2, r^2, 1, 1, 1) at the bolt's origin in the free coordinates as lengths."""
    r, c = device[D_SCALE], device[D_CENTRE]
    m = place[N_ROTATION : N_ROTATION + 9]
    jacobian = place[N_JACOBIAN : N_JACOBIAN + 9]
    turn = zeros(6, 3)
    shift = zeros(6, 3)
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


@kernel()
def length_of(n: int, step: Array, metric: Array) -> float:
    """The length of a step in the metric."""
    total = 0.0
    for i in range(n):
        for j in range(n):
            total += step[i] * metric[i, j] * step[j]
    return math.sqrt(max(total, 0.0))


@kernel()
def set_constraints(n: int, count: int, places: Array, device: Array, normals: Array, limits: Array) -> None:
    """Sets the linearised contacts ``normals . step <= limits`` in the free coordinates as lengths."""
    for i in range(count):
        for m in range(n):
            j = coordinate(m, device)
            normals[i, m] = places[i, G_GRADIENT + j] / scale(j, device)
        limits[i] = -places[i, G_VALUE]


@kernel()
def free_coordinates(device: Array) -> int:
    """How many coordinates are free."""
    return COORDINATES - 1 if device[D_RIGID] > 0.0 else COORDINATES


@kernel()
def set_gradient(n: int, q: Array, push: float, device: Array, by_q: Array, gradient: Array) -> float:
    """The potential; sets its gradient in the free coordinates as lengths."""
    energy = elastic_energy(q, device, by_q)
    by_q[5] += push
    for i in range(n):
        j = coordinate(i, device)
        gradient[i] = by_q[j] / scale(j, device)
    return energy + push * q[5]


@kernel()
def solve(n: int, factor: Array, rows: int, slack: float, forces: Array, work: Work) -> int:
    """Sets the step, and the forces, of the program of a gradient and the linearised constraints that are set."""
    return solve_program(
        n,
        factor,
        work.gradient,
        rows,
        work.normals,
        work.limits,
        slack,
        work.program,
        work.active,
        work.step,
        forces,
    )


@kernel()
def short_descent(n: int, count: int, push: float, r: float, work: Work) -> float:
    """The size of a short step of the steepest descent over the feasible motions; sets the contacts' multipliers.

    The size is a force: it is that of the gradient where nothing is near, and zero at an equilibrium alone. Metric, its
    factor, gradient, normals and limits are set.
    """
    gradient, step, multipliers = work.gradient, work.step, work.multipliers
    stiffness = push / (NEAR * r)
    for i in range(n):
        gradient[i] /= stiffness
    solve(n, work.metric_factor, count, 0.0, multipliers, work)
    for i in range(n):
        gradient[i] *= stiffness
    for i in range(count):
        multipliers[i] *= stiffness
    return stiffness * length_of(n, step, work.metric)


@kernel()
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


@kernel()
def correct(n: int, rows: int, tolerance: float, q: Array, device: Array, work: Work) -> float:
    """Moves the bolt, in place, the shortest way to where the linearised constraints hold; how far, NaN: there is none.

    A way of a nominal radius and more is not gone.
    """
    gradient, step = work.gradient, work.step
    for j in range(n):
        gradient[j] = 0.0
    status = solve(n, work.metric_factor, rows, tolerance, work.forces, work)
    if status != SOLVED:
        return math.nan
    length = length_of(n, step, work.metric)
    if length < device[D_SCALE]:
        for m in range(n):
            j = coordinate(m, device)
            q[j] += step[m] / scale(j, device)
    return length


@kernel()
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


@kernel()
def set_convex_model(n: int, count: int, device: Array, work: Work) -> float:
    """Sets the model, as stiff across contacts as it takes to be convex, with its Cholesky factor; how stiff that is.

    NaN where it never is, and as stiff as ever.
    """
    stiffness = 0.0
    for i in range(n):
        j = coordinate(i, device)
        stiffness = max(stiffness, device[D_STIFFNESS + 7 * j] / scale(j, device) ** 2)
    for stiffening in STIFFENING:
        set_model(n, count, device, stiffening * stiffness, work)
        if cholesky(work.model, n, work.factor):
            return stiffening * stiffness
    return math.nan
