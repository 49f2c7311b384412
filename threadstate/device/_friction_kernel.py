"""A held bolt with friction: push and phase of the command move in steps, and each step's contact modes are enumerated.

Every solution of a step is counted. The path goes on with the one whose contacts do what they did before, or else with
the one nearest to where the hand carries the bolt. Where there is none the bolt falls, without friction.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.contact._stage_kernel import FLUSH as FLUSH_PAIR
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_CENTRE,
    D_ROTATION,
    D_SCALE,
    N_OFFSET,
    PLACE_SIZE,
    elastic_energy,
    set_place,
)
from threadstate.device._gap_kernel import G_NORM, G_NORMAL, G_PAIR, G_POINT
from threadstate.device._modes_kernel import CONTACT_SIZE as K_SIZE
from threadstate.device._modes_kernel import (
    K_FORCE,
    K_MODE,
    K_NORMAL,
    K_PAIR,
    K_POINT,
    K_SLIP,
    MOST_CONTACTS,
    OPENS,
    REACH,
    SLIPS,
    SOLVED,
    STICKS,
    ModesWork,
    is_consistent,
    new_modes_work,
    set_velocities,
    solve_mode,
)
from threadstate.device._places_kernel import Threads, find_places, new_threads
from threadstate.device._quadratic_kernel import SOLVED as PROGRAM_SOLVED
from threadstate.device._quadratic_kernel import cholesky, solve_program
from threadstate.device._rest_kernel import (
    AT_REST,
    FLUSH,
    Work,
    descend,
    free_coordinates,
    length_of,
    new_work,
    set_gradient,
    set_metric,
)
from threadstate.device._settle_kernel import PATH_OVERLAP, PATH_TOLERANCE, distance
from threadstate.device._strip_kernel import (
    C_FORCE,
    C_NORMAL,
    C_POINT,
    is_near_strip,
    set_strip,
    strip_holds,
)
from threadstate.device._strip_kernel import CONTACT_SIZE as STRIP_CONTACT_SIZE
from threadstate.device._strip_kernel import MAX_CONTACTS as STRIP_CONTACTS
from threadstate.device._turn_kernel import (
    DEGREE,
    LOADED,
    M_ABOUT_BOLT,
    M_TILT,
    fall_down,
    potential_of,
    set_phase,
)

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MAX_SOLUTIONS = 8
"""The most solutions of a step that are told apart."""

DISTINCT = 1e-6
"""How far apart (nominal radii) the bolt is in two solutions."""

SAME_CONTACT = 0.03
"""Points of two contacts (nominal radii) that are nearer to each other are one contact's."""

STEP_REACH = 2e-2
"""How far (nominal radii) the bolt may go in a step beside where the hand carries it."""

LONGEST_TURN, LONGEST_PUSH = 1.0 * DEGREE, 1.0 / 16.0
LEAST_PART = 1.0 / 256.0
"""The longest steps of phase (rad) and of push (parts of its whole), and the shortest over the longest."""

EDGES = 48
"""Edges of the pyramid inside a friction cone by which a bolt at rest is tested."""

LAID = 1e-3
"""How near (nominal radii) to the level pose on a strip a bolt is laid there."""

MAX_POINTS = 1500

# How a path ends; failures of a descent come after these.
REACHED, TOO_MANY, ON_PATCH, PATH_FULL, NO_MINIMUM = range(5)

# A point: phase (rad), push, whether on a strip, potential, elastic energy, torque, contacts, coordinates, rotation and
# translation, friction loss of the step, loss of a fall, number of solutions of the step.
P_PHASE, P_PUSH, P_ON_STRIP, P_POTENTIAL, P_ENERGY, P_TORQUE, P_COUNT, P_COORDINATES, P_POSE = (
    0,
    1,
    2,
    3,
    4,
    5,
    6,
    7,
    13,
)
P_FRICTION, P_FALL, P_SOLUTIONS = 25, 26, 27
POINT_SIZE = 28

Solutions = tuple[Array, Array, Indices]
"""Of a step: coordinates, contacts, and number of contacts of each solution."""

Setting = tuple[Array, Array, Array, Array, Array, Threads, Work, ModesWork]
"""Command, device, strip, bolt, nut, and the work of searches, descents and modes."""

Path = tuple[Array, Array]
"""Points, and their contacts."""


@kernel()
def add_candidate(count: int, point: Array, normal: Array, pair: float, r: float, contacts: Array) -> int:
    """Adds a contact to a step's, unless one is there already; their number then, one more than there is room for."""
    for i in range(count):
        apart = 0.0
        for h in range(3):
            apart += (contacts[i, K_POINT + h] - point[h]) ** 2
        if math.sqrt(apart) < SAME_CONTACT * r:
            return count
    if count < MOST_CONTACTS:
        for h in range(K_SIZE):
            contacts[count, h] = 0.0
        for h in range(3):
            contacts[count, K_POINT + h] = point[h]
            contacts[count, K_NORMAL + h] = normal[h]
        contacts[count, K_PAIR] = pair
    return count + 1


@kernel()
def torque_with(q: Array, count: int, contacts: Array, command: Array, device: Array) -> float:
    """The hand's work a radian of phase, of contacts with their whole forces."""
    by_q = np.empty(COORDINATES)
    elastic_energy(q, device, by_q)
    ax, ay, az = 0.0, 0.0, 1.0
    torque = 0.0
    if command[M_ABOUT_BOLT] > 0.0:
        ax, ay, az = command[M_TILT + 2], command[M_TILT + 5], command[M_TILT + 8]
    else:
        x, y = device[D_CENTRE] * device[D_ROTATION + 2], device[D_CENTRE] * device[D_ROTATION + 5]
        torque = by_q[3] * y - by_q[4] * x
    for i in range(count):
        fx, fy, fz = contacts[i, K_FORCE], contacts[i, K_FORCE + 1], contacts[i, K_FORCE + 2]
        px, py, pz = contacts[i, K_POINT] - q[3], contacts[i, K_POINT + 1] - q[4], contacts[i, K_POINT + 2] - q[5]
        torque -= ax * (py * fz - pz * fy) + ay * (pz * fx - px * fz) + az * (px * fy - py * fx)
    return torque


@kernel()
def friction_loss(earlier_count: int, earlier: Array, count: int, contacts: Array) -> float:
    """The work that friction takes in a step: the mean of its forces before and after, over the slip.

    The first contacts of a step are those before it, in their order.
    """
    loss = 0.0
    for i in range(count):
        now, was = 0.0, 0.0
        for h in range(3):
            now -= contacts[i, K_FORCE + h] * contacts[i, K_SLIP + h]
            if i < earlier_count:
                was -= earlier[i, K_FORCE + h] * contacts[i, K_SLIP + h]
        loss += 0.5 * (now + was) if i < earlier_count else 0.5 * now
    return loss


@kernel()
def rests(q: Array, push: float, mu: float, count: int, contacts: Array, device: Array) -> bool:
    """Whether forces within the contacts' cones balance device and push where the bolt is; sets them.

    The cones are taken from inside, as pyramids.
    """
    n = free_coordinates(device)
    place = np.empty(PLACE_SIZE)
    metric = np.empty((COORDINATES, COORDINATES))
    factor = np.empty((COORDINATES, COORDINATES))
    gradient = np.empty(COORDINATES)
    by_q = np.empty(COORDINATES)
    velocity = np.empty((3, COORDINATES))
    total = EDGES * count
    rows = np.zeros((total, COORDINATES))
    edges = np.empty((total, 3))
    set_place(q, device, place)
    set_metric(n, place, device, metric)
    cholesky(metric, n, factor)
    set_gradient(n, q, push, device, by_q, gradient)
    for c in range(count):
        nx, ny, nz = contacts[c, K_NORMAL], contacts[c, K_NORMAL + 1], contacts[c, K_NORMAL + 2]
        ax, ay = (1.0, 0.0) if abs(nx) < 0.8 else (0.0, 1.0)
        along = ax * nx + ay * ny
        ux, uy, uz = ax - along * nx, ay - along * ny, -along * nz
        size = math.sqrt(ux * ux + uy * uy + uz * uz)
        ux, uy, uz = ux / size, uy / size, uz / size
        vx, vy, vz = ny * uz - nz * uy, nz * ux - nx * uz, nx * uy - ny * ux
        set_velocities(contacts[c, K_POINT : K_POINT + 3], place, device, velocity)
        for e in range(EDGES):
            a, b = mu * math.cos(2.0 * math.pi * e / EDGES), mu * math.sin(2.0 * math.pi * e / EDGES)
            i = EDGES * c + e
            edges[i, 0], edges[i, 1], edges[i, 2] = nx + a * ux + b * vx, ny + a * uy + b * vy, nz + a * uz + b * vz
            for j in range(n):
                for h in range(3):
                    rows[i, j] -= velocity[h, j] * edges[i, h]
    stiffness = push / (1e-3 * device[D_SCALE])
    for j in range(n):
        gradient[j] /= stiffness
    step = np.empty(COORDINATES)
    forces = np.empty(total)
    status = solve_program(
        n,
        factor,
        gradient,
        total,
        rows,
        np.zeros(total),
        1e-14 * device[D_SCALE],
        np.empty(6 * total + 90),
        np.empty(COORDINATES + 2, dtype=np.int64),
        step,
        forces,
    )
    if status != PROGRAM_SOLVED or stiffness * length_of(n, step, metric) > 1e-9 * push:
        return False
    for c in range(count):
        for h in range(3):
            contacts[c, K_SLIP + h] = 0.0
            contacts[c, K_FORCE + h] = 0.0
            for e in range(EDGES):
                contacts[c, K_FORCE + h] += stiffness * forces[EDGES * c + e] * edges[EDGES * c + e, h]
        contacts[c, K_MODE] = STICKS
    return True


@kernel()
def add_solution(total: int, q: Array, count: int, contacts: Array, device: Array, solutions: Solutions) -> int:
    """Adds a solution of a step unless the bolt is there in one already; their number then."""
    places, all_contacts, counts = solutions
    for i in range(total):
        if distance(places[i], q, device) < DISTINCT * device[D_SCALE]:
            return total
    if total == MAX_SOLUTIONS:
        return total
    copy_numbers(q, places[total])
    for c in range(count):
        copy_numbers(contacts[c], all_contacts[total, c])
    counts[total] = count
    return total + 1


@kernel()
def enumerate_modes(
    q: Array,
    carried: Array,
    free: Array,
    before: Array,
    push: float,
    unit: float,
    mu: float,
    turns: bool,
    count: int,
    candidates: Array,
    setting: Setting,
    solutions: Solutions,
) -> int:
    """Sets every solution of a step; returns their number.

    ``q`` is the bolt before the step, ``carried`` where the hand carries it, ``free`` where it would be without
    friction, ``before`` the pose before. A bolt that turns about a rigid axis has no two contacts that stick.
    """
    _, device, _, bolt, nut, threads, _, modes_work = setting
    places, search = modes_work[0], modes_work[1]
    r = device[D_SCALE]
    modes = np.empty(MOST_CONTACTS, dtype=np.int64)
    contacts = np.empty((MOST_CONTACTS, K_SIZE))
    trial = np.empty(COORDINATES)
    place = np.empty(PLACE_SIZE)
    total = 0
    if not turns:
        for c in range(count):
            copy_numbers(candidates[c], contacts[c])
        if rests(q, push, mu, count, contacts, device):
            total = add_solution(total, q, count, contacts, device, solutions)
    for code in range(1, 3**count):
        rest, sticking = code, 0
        for c in range(count):
            modes[c] = rest % 3
            rest //= 3
            sticking += 1 if modes[c] == STICKS else 0
            copy_numbers(candidates[c], contacts[c])
            contacts[c, K_MODE] = modes[c]
        if sticking > 1:
            continue
        for j in range(COORDINATES):
            trial[j] = 0.5 * (carried[j] + free[j])
        if (
            solve_mode(modes, count, mu, trial, push, unit, before, device, bolt, nut, threads, contacts, modes_work)
            != SOLVED
            or distance(carried, trial, device) > STEP_REACH * r
        ):
            continue
        set_place(trial, device, place)
        found = find_places(REACH * r, place, device, bolt, nut, threads, search, places)
        if is_consistent(modes, count, mu, unit, r, found, contacts, modes_work):
            total = add_solution(total, trial, count, contacts, device, solutions)
    return total


@kernel()
def chosen(total: int, carried: Array, count: int, contacts: Array, device: Array, solutions: Solutions) -> int:
    """Which solution the path goes on with: that of the modes before, else the one nearest to ``carried``."""
    places, all_contacts, counts = solutions
    best, nearest = 0, math.inf
    for i in range(total):
        same = True
        for c in range(int(counts[i])):
            mode = contacts[c, K_MODE] if c < count else float(OPENS)
            same = same and all_contacts[i, c, K_MODE] == mode
        away = distance(carried, places[i], device)
        if same:
            return i
        if away < nearest:
            best, nearest = i, away
    return best


@kernel()
def candidates_of(count: int, contacts: Array, found: int, setting: Setting, push: float, candidates: Array) -> int:
    """Sets the contacts of a step: those before it, then those that a bolt without friction would have after it."""
    device, work = setting[1], setting[6]
    places, multipliers = work[0], work[15]
    r = device[D_SCALE]
    total = 0
    for c in range(count):
        copy_numbers(contacts[c], candidates[c])
        total += 1
    for j in range(found):
        if multipliers[j] * places[j, G_NORM] > LOADED * push:
            total = add_candidate(
                total,
                places[j, G_POINT : G_POINT + 3],
                places[j, G_NORMAL : G_NORMAL + 3],
                places[j, G_PAIR],
                r,
                candidates,
            )
            if total > MOST_CONTACTS:
                return total
    return total


@kernel()
def add_path_point(
    i: int,
    phase: float,
    push: float,
    on_strip: bool,
    q: Array,
    count: int,
    contacts: Array,
    losses: Array,
    command: Array,
    device: Array,
    path: Path,
) -> None:
    """Sets a point of the path; ``losses`` are friction, fall and the number of solutions."""
    points, all_contacts = path
    by_q = np.empty(COORDINATES)
    place = np.empty(PLACE_SIZE)
    set_place(q, device, place)
    energy = elastic_energy(q, device, by_q)
    points[i, P_PHASE], points[i, P_PUSH], points[i, P_ON_STRIP] = phase, push, 1.0 if on_strip else 0.0
    points[i, P_POTENTIAL], points[i, P_ENERGY] = energy + push * q[5], energy
    points[i, P_TORQUE] = torque_with(q, count, contacts, command, device)
    points[i, P_COUNT] = count
    copy_numbers(q, points[i, P_COORDINATES : P_COORDINATES + COORDINATES])
    copy_numbers(place[0:12], points[i, P_POSE : P_POSE + 12])
    copy_numbers(losses, points[i, P_FRICTION : P_FRICTION + 3])
    for c in range(count):
        copy_numbers(contacts[c], all_contacts[i, c])


@kernel()
def strip_contacts(
    q: Array, push: float, mu: float, sense: float, setting: Setting, trial: Array, contacts: Array
) -> int:
    """Lays a bolt beside a strip on it, in ``trial``, and sets contacts whose forces balance the push; 0 if none do.

    Their slips are set to zero: those of the path are the helices' lengths.
    """
    _, device, strip, bolt, nut, _, _, _ = setting
    place = np.empty(PLACE_SIZE)
    rows = np.empty((STRIP_CONTACTS, STRIP_CONTACT_SIZE))
    leave = np.empty(COORDINATES)
    set_place(q, device, place)
    if not is_near_strip(place, bolt) or not set_strip(place[N_OFFSET + 2], device, strip, bolt, trial):
        return 0
    if distance(q, trial, device) > LAID * device[D_SCALE]:
        return 0
    holds, count = strip_holds(trial, push, mu, sense, device, strip, bolt, nut, rows, leave)
    if not holds:
        return 0
    for c in range(count):
        for h in range(3):
            contacts[c, K_POINT + h] = rows[c, C_POINT + h]
            contacts[c, K_NORMAL + h] = rows[c, C_NORMAL + h]
            contacts[c, K_FORCE + h] = rows[c, C_FORCE] * rows[c, C_NORMAL + h]
            contacts[c, K_SLIP + h] = 0.0
        contacts[c, K_PAIR], contacts[c, K_MODE] = FLUSH_PAIR, SLIPS
    return count


@kernel()
def frictionless_contacts(found: int, push: float, work: Work, contacts: Array) -> int:
    """Sets the contacts of a bolt that rests without friction; their number, one more than there is room for."""
    places, multipliers = work[0], work[15]
    count = 0
    for j in range(found):
        force = multipliers[j] * places[j, G_NORM]
        if force > LOADED * push:
            if count == MOST_CONTACTS:
                return count + 1
            for h in range(3):
                contacts[count, K_POINT + h] = places[j, G_POINT + h]
                contacts[count, K_NORMAL + h] = places[j, G_NORMAL + h]
                contacts[count, K_FORCE + h] = force * places[j, G_NORMAL + h]
                contacts[count, K_SLIP + h] = 0.0
            contacts[count, K_MODE], contacts[count, K_PAIR] = STICKS, places[j, G_PAIR]
            count += 1
    return count


@kernel()
def kept(count: int, contacts: Array, push: float) -> int:
    """Moves the contacts that carry a force to the front; their number."""
    used = 0
    for c in range(count):
        normal = 0.0
        for h in range(3):
            normal += contacts[c, K_FORCE + h] * contacts[c, K_NORMAL + h]
        if contacts[c, K_MODE] != OPENS and normal > LOADED * push:
            copy_numbers(contacts[c], contacts[used])
            used += 1
    return used


@kernel(nogil=True)
def follow_friction(
    q: Array,
    phases: Array,
    pushes: Array,
    mu: float,
    count: int,
    contacts: Array,
    command: Array,
    device: Array,
    strip: Array,
    bolt: Array,
    nut: Array,
    path: Path,
) -> tuple[int, int]:
    """Follows a bolt from ``q``, in place, while phase and push go from the first to the second of theirs.

    ``contacts`` are the ``count`` ones at the beginning, and are set to those of the end. Returns how it ended and the
    number of points set.
    """
    setting = (command, device, strip, bolt, nut, new_threads(bolt), new_work(), new_modes_work())
    threads, work = setting[5], setting[6]
    r = device[D_SCALE]
    turn, growth = phases[1] - phases[0], pushes[1] - pushes[0]
    turns = turn != 0.0
    unit = max(abs(pushes[0]), abs(pushes[1]))
    longest = LONGEST_TURN / abs(turn) if turns else LONGEST_PUSH
    least = LEAST_PART * longest
    step, reached, i = 0.25 * longest, 0.0, 0
    on_strip = False
    solutions = (
        np.empty((MAX_SOLUTIONS, COORDINATES)),
        np.empty((MAX_SOLUTIONS, MOST_CONTACTS, K_SIZE)),
        np.empty(MAX_SOLUTIONS, dtype=np.int64),
    )
    candidates = np.empty((MOST_CONTACTS, K_SIZE))
    laid = np.empty((STRIP_CONTACTS, K_SIZE))
    before, free, losses = np.empty(PLACE_SIZE), np.empty(COORDINATES), np.zeros(3)
    set_phase(phases[0], command, device)
    add_path_point(0, phases[0], pushes[0], False, q, count, contacts, losses, command, device, path)
    while reached < 1.0:
        if i + 1 == MAX_POINTS:
            return PATH_FULL, i + 1
        size = min(step, 1.0 - reached)
        target = 1.0 if size == 1.0 - reached else reached + size
        phase, push = phases[0] + target * turn, pushes[0] + target * growth
        set_phase(phases[0] + reached * turn, command, device)
        set_place(q, device, before)
        set_phase(phase, command, device)
        losses[0], losses[1], losses[2] = 0.0, 0.0, 1.0
        copy_numbers(q, free)
        laid_count = strip_contacts(q, push, mu, math.copysign(1.0, turn), setting, free, laid) if turns else 0
        if laid_count > 0:
            i += 1
            travelled = abs(phase - phases[0] - reached * turn)
            for c in range(laid_count):
                # Along the helix of its radius, against the force's part along the motion.
                x, y, k = laid[c, K_POINT], laid[c, K_POINT + 1], bolt[6] / (2.0 * math.pi)
                along = -y * laid[c, K_FORCE] + x * laid[c, K_FORCE + 1] + k * laid[c, K_FORCE + 2]
                losses[0] -= math.copysign(1.0, turn) * along * travelled
            copy_numbers(free, q)
            on_strip, count, reached = True, laid_count, target
            add_path_point(i, phase, push, True, q, count, laid, losses, command, device, path)
            step = min(2.0 * size, longest)
            continue
        if on_strip:
            return ON_PATCH, i + 1
        status, found = descend(
            free, push, STEP_REACH * r, math.inf, 60, PATH_TOLERANCE, PATH_OVERLAP, device, bolt, nut, threads, work
        )
        if status == FLUSH:
            return ON_PATCH, i + 1
        if status != AT_REST:
            copy_numbers(q, free)
            found = 0
        total = candidates_of(count, contacts, found, setting, push, candidates)
        if total > MOST_CONTACTS:
            if size > least:
                step = max(0.5 * size, least)
                continue
            return TOO_MANY, i + 1
        number = enumerate_modes(q, q, free, before, push, unit, mu, turns, total, candidates, setting, solutions)
        if number == 0 and size > least:
            step = max(0.5 * size, least)
            continue
        losses[2] = number
        if number == 0:
            copy_numbers(q, free)
            status, found = fall_down(free, push, device, bolt, nut, threads, work)
            if status != AT_REST:
                return (ON_PATCH if status == FLUSH else NO_MINIMUM), i + 1
            losses[1] = potential_of(q, push, device) - potential_of(free, push, device)
            copy_numbers(free, q)
            count = frictionless_contacts(found, push, work, contacts)
            if count > MOST_CONTACTS:
                return TOO_MANY, i + 1
        else:
            best = chosen(number, q, count, contacts, device, solutions)
            copy_numbers(solutions[0][best], q)
            losses[0] = friction_loss(count, contacts, int(solutions[2][best]), solutions[1][best])
            count = int(solutions[2][best])
            for c in range(count):
                copy_numbers(solutions[1][best, c], contacts[c])
        i += 1
        reached = target
        count = kept(count, contacts, unit)
        add_path_point(i, phase, push, False, q, count, contacts, losses, command, device, path)
        step = min(2.0 * size, longest)
    return REACHED, i + 1
