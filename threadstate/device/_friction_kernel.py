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
from threadstate.contact._stage_kernel import new_work as new_stage
from threadstate.device._certificate_kernel import overlap
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
from threadstate.device._flush_kernel import tip_over
from threadstate.device._gap_kernel import G_NORM, G_NORMAL, G_PAIR, G_POINT, G_VALUE, GAP_SIZE
from threadstate.device._modes_kernel import CONTACT_SIZE as K_SIZE
from threadstate.device._modes_kernel import (
    K_AXIS,
    K_FORCE,
    K_MODE,
    K_NORMAL,
    K_PAIR,
    K_POINT,
    K_SLIP,
    MOST_CANDIDATES,
    MOST_CONTACTS,
    OPENS,
    OVERLAP,
    REACH,
    SLIPS,
    SOLVED,
    STICKS,
    ModesWork,
    cones_hold,
    new_modes_work,
    overlap_beside,
    set_contact,
    set_velocities,
    solve_mode,
    tangent,
)
from threadstate.device._places_kernel import MAX_PLACES, PLACES_WORK, Threads, find_places, new_threads
from threadstate.device._quadratic_kernel import SOLVED as PROGRAM_SOLVED
from threadstate.device._quadratic_kernel import cholesky, solve_program
from threadstate.device._rest_kernel import (
    AT_REST,
    DEEPEST,
    FLUSH,
    SLIPPED,
    Work,
    descend,
    free_coordinates,
    length_of,
    new_work,
    set_gradient,
    set_metric,
)
from threadstate.device._settle_kernel import LEAST_GAP, OVERLAP_LIMIT, PATH_OVERLAP, PATH_TOLERANCE, distance
from threadstate.device._slide_kernel import (
    L_FORCE,
    L_FRICTION,
    L_LOSS,
    L_MOMENT,
    L_SLIDES,
    L_X,
    L_Y,
    LYING_SIZE,
    is_level,
    lie_flush,
    lies_beside,
)
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
    ABOVE,
    BELOW_TOP,
    DEGREE,
    EVENT_WIDTH,
    LOADED,
    M_ABOUT_BOLT,
    M_LONGEST,
    M_PUSH,
    M_TILT,
    ON_CONTACTS,
    ON_STRIP,
    ON_SURFACE,
    SNAP_FALL,
    SNAP_SPAN,
    TIP,
    TORQUE_LIMIT,
    fall_down,
    set_phase,
)
from threadstate.thread import _profile_kernel as pk

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
FIRST_PART, LEAST_PART = 0.25, 1.0 / 256.0
"""The longest steps of phase (rad) and of push (parts of its whole) where no others are asked for; the first and the
shortest over the longest."""

EDGES, MORE_EDGES = 12, 60
"""Edges of the pyramid inside a friction cone with which the test of a bolt at rest begins, and how many are added, one
at a time, where it takes more."""

BEYOND = 1e-8
"""By how much a velocity may be outside the cones' polar, over its size, where no edge is added."""

LAID = 3e-3
"""How near (nominal radii) to the level pose on a strip a bolt is laid there: along the strip a step takes it half as
far."""

BRIDGING = 4.0
"""How much longer the steps become that are tried where no step is short enough."""

BESIDE_TIP = 0.3
"""How much less deep than the deepest one, in what a bolt has been tipped by times the nominal radius, a place is on
which it tips as well."""

MAX_POINTS = 2500

ENERGY_STEP = 2e-5
"""Potential, over push times nominal radius, that a step may leave unexplained: more is a fall."""

# How a path ends.
REACHED, SNAP_REACHED, TORQUE_OVER, SLIPPED_OFF, TOO_DEEP, TOO_MANY, ON_PATCH, PATH_FULL, NO_MINIMUM = range(9)
GOES_ON, SHORTER = -1, -2
"""Of a step: the path goes on, or the step has to have another length, as a rule a shorter one."""

FREE_STEPS = 60
"""Steps of the descent without friction that says which contacts a step may gain."""

# A point: phase (rad), push, what holds the bolt, potential, elastic energy, torque, contacts, coordinates, rotation
# and translation, friction loss of the step, loss of a fall, number of solutions of the step.
P_PHASE, P_PUSH, P_KIND, P_POTENTIAL, P_ENERGY, P_TORQUE, P_COUNT, P_COORDINATES, P_POSE = (
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
    if count < MOST_CANDIDATES:
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
def friction_of(contact: Array) -> float:
    """The size of a contact's force across its normal."""
    normal, square = 0.0, 0.0
    for h in range(3):
        normal += contact[K_FORCE + h] * contact[K_NORMAL + h]
        square += contact[K_FORCE + h] ** 2
    return math.sqrt(max(square - normal * normal, 0.0))


@kernel()
def friction_loss(earlier_count: int, earlier: Array, count: int, contacts: Array) -> float:
    """The work that friction takes in a step: the mean of its sizes before and after, over the slip.

    The first contacts of a step are those before it, in their order.
    """
    loss = 0.0
    for i in range(count):
        if contacts[i, K_MODE] != SLIPS:
            continue
        slip = math.sqrt(contacts[i, K_SLIP] ** 2 + contacts[i, K_SLIP + 1] ** 2 + contacts[i, K_SLIP + 2] ** 2)
        now = friction_of(contacts[i])
        was = friction_of(earlier[i]) if i < earlier_count and earlier[i, K_MODE] == SLIPS else now
        loss += 0.5 * (now + was) * slip
    return loss


@kernel()
def rests(q: Array, push: float, mu: float, count: int, contacts: Array, device: Array) -> bool:
    """Whether forces within the contacts' cones balance device and push where the bolt is; sets them.

    The cones are approached from inside, by pyramids that gain the edges on which the bolt would begin to move.
    """
    n = free_coordinates(device)
    r = device[D_SCALE]
    place = np.empty(PLACE_SIZE)
    metric = np.empty((COORDINATES, COORDINATES))
    factor = np.empty((COORDINATES, COORDINATES))
    gradient = np.empty(COORDINATES)
    by_q = np.empty(COORDINATES)
    velocities = np.empty((MOST_CONTACTS, 3, COORDINATES))
    most = (EDGES + MORE_EDGES) * count
    rows = np.zeros((most, COORDINATES))
    edges = np.empty((most, 3))
    owners = np.empty(most, dtype=np.int64)
    set_place(q, device, place)
    set_metric(n, place, device, metric)
    cholesky(metric, n, factor)
    set_gradient(n, q, push, device, by_q, gradient)
    total = 0
    for c in range(count):
        set_velocities(contacts[c, K_POINT : K_POINT + 3], place, device, velocities[c])
        contacts[c, K_AXIS] = 0.0 if abs(contacts[c, K_NORMAL]) < 0.8 else 1.0
        ux, uy, uz = tangent(0, contacts[c])
        vx, vy, vz = tangent(1, contacts[c])
        for e in range(EDGES):
            a, b = math.cos(2.0 * math.pi * e / EDGES), math.sin(2.0 * math.pi * e / EDGES)
            total = add_edge(
                total,
                c,
                mu,
                a * ux + b * vx,
                a * uy + b * vy,
                a * uz + b * vz,
                contacts,
                velocities,
                n,
                rows,
                edges,
                owners,
            )
    stiffness = push / (1e-3 * r)
    for j in range(n):
        gradient[j] /= stiffness
    step = np.empty(COORDINATES)
    forces = np.empty(most)
    work, active = np.empty(6 * most + 90), np.empty(COORDINATES + 2, dtype=np.int64)
    limits = np.zeros(most)
    moved = np.empty(3)
    while True:
        status = solve_program(n, factor, gradient, total, rows, limits, 1e-14 * r, work, active, step, forces)
        if status != PROGRAM_SOLVED:
            return False
        length = length_of(n, step, metric)
        if stiffness * length <= 1e-9 * push:
            break
        earlier = total
        for c in range(count):
            normal, square = 0.0, 0.0
            for h in range(3):
                moved[h] = 0.0
                for j in range(n):
                    moved[h] += velocities[c, h, j] * step[j]
                normal += moved[h] * contacts[c, K_NORMAL + h]
            for h in range(3):
                moved[h] -= normal * contacts[c, K_NORMAL + h]
                square += moved[h] * moved[h]
            across = math.sqrt(square)
            if normal - mu * across < -BEYOND * length and total < most:
                total = add_edge(
                    total,
                    c,
                    mu,
                    -moved[0] / across,
                    -moved[1] / across,
                    -moved[2] / across,
                    contacts,
                    velocities,
                    n,
                    rows,
                    edges,
                    owners,
                )
        if total == earlier:
            return False
    for c in range(count):
        for h in range(3):
            contacts[c, K_SLIP + h] = 0.0
            contacts[c, K_FORCE + h] = 0.0
        contacts[c, K_MODE] = STICKS
    for e in range(total):
        for h in range(3):
            contacts[owners[e], K_FORCE + h] += stiffness * forces[e] * edges[e, h]
    return True


@kernel()
def add_edge(
    i: int,
    owner: int,
    mu: float,
    x: float,
    y: float,
    z: float,
    contacts: Array,
    velocities: Array,
    n: int,
    rows: Array,
    edges: Array,
    owners: Indices,
) -> int:
    """Adds the edge of a contact's cone on the side of a unit tangent, and its row; the number of edges then."""
    edges[i, 0] = contacts[owner, K_NORMAL] + mu * x
    edges[i, 1] = contacts[owner, K_NORMAL + 1] + mu * y
    edges[i, 2] = contacts[owner, K_NORMAL + 2] + mu * z
    owners[i] = owner
    for j in range(n):
        rows[i, j] = 0.0
        for h in range(3):
            rows[i, j] -= velocities[owner, h, j] * edges[i, h]
    return i + 1


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
    met: Array,
) -> tuple[int, bool]:
    """Sets every solution of a step: their number, and whether one that would be overlaps beside its contacts.

    ``met`` is set to where the last such one does. ``q`` is the bolt before the step, ``carried`` where the hand
    carries it, ``free`` where it would be without friction, ``before`` the pose before. A bolt that turns about a rigid
    axis has no two contacts that stick.
    """
    _, device, _, bolt, nut, threads, _, modes_work = setting
    places, search = modes_work[0], modes_work[1]
    r = device[D_SCALE]
    modes = np.empty(MOST_CANDIDATES, dtype=np.int64)
    contacts = np.empty((MOST_CANDIDATES, K_SIZE))
    trial, start = np.empty(COORDINATES), np.empty(COORDINATES)
    place = np.empty(PLACE_SIZE)
    for j in range(COORDINATES):
        start[j] = carried[j] if turns else 0.5 * (carried[j] + free[j])
    total, has_met = 0, False
    if not turns:
        set_place(q, device, place)
        touching = touching_contacts(
            find_places(OVERLAP * r, place, device, bolt, nut, threads, search, places), places, contacts
        )
        if rests(q, push, mu, touching, contacts, device):
            total = add_solution(total, q, touching, contacts, device, solutions)
    set_place(start, device, place)
    found = find_places(REACH * r, place, device, bolt, nut, threads, search, places)
    at_start = places[:found].copy()
    for code in range(3**count):
        rest, sticking, touching = code, 0, 0
        for c in range(count):
            modes[c] = rest % 3
            rest //= 3
            sticking += 1 if modes[c] == STICKS else 0
            touching += 0 if modes[c] == OPENS else 1
        if sticking > 1 or touching > MOST_CONTACTS:
            continue
        for c in range(count):
            copy_numbers(candidates[c], contacts[c])
            contacts[c, K_MODE] = modes[c]
        copy_numbers(start, trial)
        for j in range(found):
            copy_numbers(at_start[j], places[j])
        status = solve_mode(
            modes, count, mu, found, trial, push, unit, before, device, bolt, nut, threads, contacts, modes_work
        )
        if (
            status != SOLVED
            or distance(carried, trial, device) > STEP_REACH * r
            or not cones_hold(modes, count, mu, unit, r, contacts)
        ):
            continue
        set_place(trial, device, place)
        after = find_places(REACH * r, place, device, bolt, nut, threads, search, places)
        beside = overlap_beside(modes, count, r, after, contacts, places)
        if beside >= 0:
            copy_numbers(places[beside], met)
            has_met = True
        else:
            total = add_solution(total, trial, count, contacts, device, solutions)
    return total, has_met


@kernel()
def touching_contacts(found: int, places: Array, contacts: Array) -> int:
    """Sets contacts without forces at the ``found`` places, as many as there is room for; their number."""
    count = min(found, MOST_CONTACTS)
    for c in range(count):
        for h in range(K_SIZE):
            contacts[c, h] = 0.0
        set_contact(places[c], contacts[c])
    return count


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
def add_free_contacts(total: int, found: int, push: float, device: Array, work: Work, candidates: Array) -> int:
    """Adds the contacts of a bolt without friction, as many as there is room for; the number of candidates then."""
    places, multipliers = work[0], work[15]
    for j in range(found):
        if multipliers[j] * places[j, G_NORM] > LOADED * push:
            total = min(add_candidate_at(total, places[j], device, candidates), MOST_CANDIDATES)
    return total


@kernel()
def add_candidate_at(total: int, gap: Array, device: Array, candidates: Array) -> int:
    """Adds a place of overlap to a step's contacts, as :func:`add_candidate`."""
    return add_candidate(
        total,
        gap[G_POINT : G_POINT + 3],
        gap[G_NORMAL : G_NORMAL + 3],
        gap[G_PAIR],
        device[D_SCALE],
        candidates,
    )


@kernel()
def add_path_point(
    i: int,
    phase: float,
    push: float,
    kind: int,
    q: Array,
    count: int,
    contacts: Array,
    losses: Array,
    command: Array,
    device: Array,
    path: Path,
) -> None:
    """Sets a point of the path.

    ``losses`` are friction, fall, the number of solutions, and the moment about z on the bolt beside that of contacts.
    """
    points, all_contacts = path
    by_q = np.empty(COORDINATES)
    place = np.empty(PLACE_SIZE)
    set_place(q, device, place)
    energy = elastic_energy(q, device, by_q)
    points[i, P_PHASE], points[i, P_PUSH], points[i, P_KIND] = phase, push, kind
    points[i, P_POTENTIAL], points[i, P_ENERGY] = energy + push * q[5], energy
    along = command[M_TILT + 8] if command[M_ABOUT_BOLT] > 0.0 else 1.0
    points[i, P_TORQUE] = torque_with(q, count, contacts, command, device) - along * losses[3]
    points[i, P_COUNT] = count
    copy_numbers(q, points[i, P_COORDINATES : P_COORDINATES + COORDINATES])
    copy_numbers(place[0:12], points[i, P_POSE : P_POSE + 12])
    copy_numbers(losses[0:3], points[i, P_FRICTION : P_FRICTION + 3])
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


@kernel()
def has_ended(i: int, stop_at_snap: bool, count: int, contacts: Array, setting: Setting, path: Path) -> int:
    """Whether the path ends at its last point: by a snap, by the torque, or as the bolt slipped or went too deep."""
    command, bolt = setting[0], setting[3]
    points, _ = path
    r = bolt[pk.R_MAJOR]
    if abs(points[i, P_TORQUE]) > TORQUE_LIMIT * command[M_PUSH] * r:
        return TORQUE_OVER
    if math.hypot(points[i, P_POSE + 9], points[i, P_POSE + 10]) > r:
        return SLIPPED_OFF
    if points[i, P_POSE + 11] < -DEEPEST * bolt[pk.P]:
        return TOO_DEEP
    is_below = False
    for c in range(count):
        is_below = is_below or contacts[c, K_POINT + 2] < -BELOW_TOP * r
    j = i - 1
    while stop_at_snap and is_below and j >= 0:
        if abs(points[j, P_PHASE] - points[i, P_PHASE]) > SNAP_SPAN * (1.0 + 1e-9):
            break
        if points[j, P_POSE + 11] - points[i, P_POSE + 11] > SNAP_FALL * bolt[pk.P]:
            return SNAP_REACHED
        j -= 1
    return GOES_ON


@kernel()
def slide_on_strip(
    q: Array, push: float, mu: float, turn: float, setting: Setting, contacts: Array, losses: Array
) -> int:
    """Moves a bolt that lies, or is beside lying, on a strip along it by ``turn`` (rad), in place; its contacts, or 0.

    The loss is that of forces along the helices of their radii.
    """
    bolt = setting[3]
    level = np.empty(COORDINATES)
    sense = math.copysign(1.0, turn)
    count = strip_contacts(q, push, mu, sense, setting, level, contacts)
    if count == 0:
        return 0
    for c in range(count):
        x, y, k = contacts[c, K_POINT], contacts[c, K_POINT + 1], bolt[pk.LEAD] / (2.0 * math.pi)
        losses[0] -= turn * (-y * contacts[c, K_FORCE] + x * contacts[c, K_FORCE + 1] + k * contacts[c, K_FORCE + 2])
    copy_numbers(level, q)
    return count


@kernel()
def fall_without_friction(q: Array, push: float, setting: Setting, contacts: Array) -> tuple[int, int]:
    """Lets the bolt fall from ``q``, in place: how the path ends there, if it does, and its number of contacts."""
    _, device, _, bolt, nut, threads, work, _ = setting
    status, found = fall_down(q, push, device, bolt, nut, threads, work)
    if status == SLIPPED:
        return SLIPPED_OFF, 0
    if status != AT_REST:
        return (ON_PATCH if status == FLUSH else NO_MINIMUM), 0
    count = frictionless_contacts(found, push, work, contacts)
    return (TOO_MANY if count > MOST_CONTACTS else GOES_ON), count


@kernel()
def solve_step(
    q: Array,
    free: Array,
    before: Array,
    push: float,
    mu: float,
    turns: bool,
    total: int,
    candidates: Array,
    setting: Setting,
    solutions: Solutions,
) -> tuple[int, int]:
    """Sets every solution of a step, with what the bolt meets in it added to the candidates.

    Returns how many there are, and the number of candidates: one more than there is room for where it meets too many.
    """
    command, device = setting[0], setting[1]
    met = np.empty(GAP_SIZE)
    while True:
        number, has_met = enumerate_modes(
            q, q, free, before, push, command[M_PUSH], mu, turns, total, candidates, setting, solutions, met
        )
        known = total
        if has_met:
            total = add_candidate_at(total, met, device, candidates)
        if total == known or total > MOST_CANDIDATES:
            return number, total


@kernel()
def step_with_friction(
    q: Array,
    push: float,
    mu: float,
    turns: bool,
    falls: bool,
    before: Array,
    count: int,
    contacts: Array,
    setting: Setting,
    solutions: Solutions,
    losses: Array,
) -> tuple[int, int]:
    """A step from ``q`` to a new command, in place: how the path ends there, if it does, and its number of contacts.

    Where there is no solution, or there are too many contacts, SHORTER, or if it ``falls`` where it falls to;
    ``before`` is the pose before the step. The contacts are those before the step and what the bolt meets in it; where
    they have no solution, and where the push grows, those that a bolt without friction would have are added.
    """
    command, device, _, bolt, nut, threads, work, _ = setting
    free = q.copy()
    candidates = np.empty((MOST_CANDIDATES, K_SIZE))
    for c in range(count):
        copy_numbers(contacts[c], candidates[c])
    number, total = 0, count
    if turns:
        number, total = solve_step(q, free, before, push, mu, turns, total, candidates, setting, solutions)
    if number == 0 and total <= MOST_CANDIDATES:
        status, found = descend(
            free,
            push,
            STEP_REACH * device[D_SCALE],
            math.inf,
            FREE_STEPS,
            PATH_TOLERANCE,
            PATH_OVERLAP,
            device,
            bolt,
            nut,
            threads,
            work,
        )
        if status == FLUSH:
            return ON_PATCH, 0
        if status != AT_REST:
            copy_numbers(q, free)
            found = 0
        known = total
        total = add_free_contacts(total, found, push, device, work, candidates)
        if total > known or not turns:
            number, total = solve_step(q, free, before, push, mu, turns, total, candidates, setting, solutions)
    if total > MOST_CANDIDATES:
        return (TOO_MANY if falls else SHORTER), 0
    losses[2] = number
    if number == 0:
        return fall_without_friction(q, push, setting, contacts) if falls else (SHORTER, 0)
    best = chosen(number, q, count, contacts, device, solutions)
    copy_numbers(solutions[0][best], q)
    losses[0] = friction_loss(count, contacts, int(solutions[2][best]), solutions[1][best])
    count = int(solutions[2][best])
    used = kept(count, solutions[1][best], command[M_PUSH])
    for c in range(used):
        copy_numbers(solutions[1][best, c], contacts[c])
    return GOES_ON, used


@kernel()
def lay_flush(
    falls: bool,
    q: Array,
    push: float,
    mu: float,
    turns: bool,
    before: Array,
    contacts: Array,
    setting: Setting,
    losses: Array,
) -> bool:
    """Lays a bolt flush on the surface, in place, if it stays there; the contact is the resultant of the pressure.

    One that does not fall there is laid where that lowers its potential. One that lies there already and does not stay
    is tipped a little in the direction in which it leaves.
    """
    command, device, _, bolt, nut, _, _, _ = setting
    level, lying, by_q = np.empty(COORDINATES), np.zeros(LYING_SIZE), np.empty(COORDINATES)
    was_level = is_level(q, device) and not falls
    stays, direction = lie_flush(push, mu, turns, before, device, bolt, nut, level, lying)
    if not stays:
        if was_level:
            place = np.empty(PLACE_SIZE)
            set_place(level, device, place)
            tip_over(direction, TIP, place, level)
            copy_numbers(level, q)
        return False
    rises = elastic_energy(level, device, by_q) + push * level[5] - elastic_energy(q, device, by_q) - push * q[5]
    if rises > ENERGY_STEP * command[M_PUSH] * bolt[pk.R_MAJOR] and not (falls or was_level):
        return False
    copy_numbers(level, q)
    for h in range(K_SIZE):
        contacts[0, h] = 0.0
    contacts[0, K_POINT], contacts[0, K_POINT + 1], contacts[0, K_NORMAL + 2] = lying[L_X], lying[L_Y], 1.0
    contacts[0, K_FORCE], contacts[0, K_FORCE + 1] = lying[L_FRICTION], lying[L_FRICTION + 1]
    contacts[0, K_FORCE + 2] = lying[L_FORCE]
    contacts[0, K_MODE], contacts[0, K_PAIR] = SLIPS if lying[L_SLIDES] > 0.0 else STICKS, FLUSH_PAIR
    losses[0], losses[2], losses[3] = lying[L_LOSS], 1.0, lying[L_MOMENT]
    return True


@kernel()
def contacts_of_tip(q: Array, push: float, setting: Setting, contacts: Array) -> int:
    """Sets the contacts of a bolt that has been tipped off the surface, each with its share of the push; their number.

    They are the places that are lowest, to part of what the bolt has been tipped by; it is moved along z, in place, to
    where they touch.
    """
    _, device, _, bolt, nut, threads, _, modes_work = setting
    places, search = modes_work[0], modes_work[1]
    place = np.empty(PLACE_SIZE)
    tipped = TIP * device[D_SCALE]
    set_place(q, device, place)
    found = find_places(2.0 * tipped, place, device, bolt, nut, threads, search, places)
    deepest = -math.inf
    for j in range(found):
        deepest = max(deepest, places[j, G_VALUE])
    count = 0
    for j in range(found):
        if places[j, G_VALUE] > deepest - BESIDE_TIP * tipped and count < MOST_CONTACTS:
            for h in range(K_SIZE):
                contacts[count, h] = 0.0
            set_contact(places[j], contacts[count])
            contacts[count, K_MODE] = SLIPS
            count += 1
    for c in range(count):
        for h in range(3):
            contacts[c, K_FORCE + h] = push / count * contacts[c, K_NORMAL + h]
    if count > 0:
        q[5] += deepest
    return count


@kernel()
def step_held(
    kind: int,
    q: Array,
    push: float,
    mu: float,
    turn: float,
    before: Array,
    contacts: Array,
    setting: Setting,
    losses: Array,
) -> tuple[int, int, int]:
    """A step of a bolt that a strip or the surface holds after it, in place.

    Returns what holds it, the number of contacts, and how the path ends there, if it does. On contacts, where neither
    does: a bolt that leaves the surface is tipped. One that a strip no longer holds is not followed.
    """
    _, device, _, bolt, _, _, _, _ = setting
    losses[0], losses[1], losses[2], losses[3] = 0.0, 0.0, 1.0, 0.0
    turns = turn != 0.0
    slid = slide_on_strip(q, push, mu, turn, setting, contacts, losses) if turns else 0
    if slid > 0:
        return ON_STRIP, slid, GOES_ON
    if kind == ON_STRIP:
        return ON_STRIP, 0, ON_PATCH
    is_beside = kind == ON_SURFACE or lies_beside(q, device, bolt[pk.R_MAJOR])
    if is_beside and lay_flush(False, q, push, mu, turns, before, contacts, setting, losses):
        return ON_SURFACE, 1, GOES_ON
    return ON_CONTACTS, 0, GOES_ON


@kernel()
def unexplained(i: int, path: Path) -> float:
    """The potential lost in the step to a point that neither torque, push nor friction explains."""
    points, _ = path
    lost = points[i - 1, P_POTENTIAL] - points[i, P_POTENTIAL] - points[i, P_FRICTION]
    lost += 0.5 * (points[i - 1, P_TORQUE] + points[i, P_TORQUE]) * (points[i, P_PHASE] - points[i - 1, P_PHASE])
    height = 0.5 * (points[i - 1, P_COORDINATES + 5] + points[i, P_COORDINATES + 5])
    return lost + height * (points[i, P_PUSH] - points[i - 1, P_PUSH])


@kernel()
def same_features(i: int, count: int, contacts: Array, path: Path) -> bool:
    """Whether contacts have the features of a point's."""
    points, all_contacts = path
    if points[i, P_COUNT] != count:
        return False
    for c in range(count):
        more = 0
        for h in range(count):
            more += 1 if contacts[h, K_PAIR] == contacts[c, K_PAIR] else 0
            more -= 1 if all_contacts[i, h, K_PAIR] == contacts[c, K_PAIR] else 0
        if more != 0:
            return False
    return True


@kernel()
def go_back(i: int, q: Array, contacts: Array, path: Path) -> int:
    """Sets coordinates and contacts to those of a point; the number of contacts."""
    points, all_contacts = path
    copy_numbers(points[i, P_COORDINATES : P_COORDINATES + COORDINATES], q)
    count = int(points[i, P_COUNT])
    for c in range(count):
        copy_numbers(all_contacts[i, c], contacts[c])
    return count


@kernel(nogil=True)
def follow_friction(
    q: Array,
    phases: Array,
    pushes: Array,
    mu: float,
    stop_at_snap: bool,
    count: int,
    contacts: Array,
    command: Array,
    device: Array,
    strip: Array,
    bolt: Array,
    nut: Array,
    path: Path,
) -> tuple[int, int, int]:
    """Follows a bolt from ``q``, in place, while phase and push go from the first to the second of theirs.

    ``contacts`` are the ``count`` ones at the beginning, and are set to those of the end. Returns how it ended, the
    number of points set, and that of contacts.
    """
    setting = (command, device, strip, bolt, nut, new_threads(bolt), new_work(), new_modes_work())
    turn, growth = phases[1] - phases[0], pushes[1] - pushes[0]
    turns = turn != 0.0
    longest = command[M_LONGEST] / abs(turn) if turns else LONGEST_PUSH * command[M_LONGEST] / LONGEST_TURN
    least = LEAST_PART * longest
    step, reached, i, kind = FIRST_PART * longest, 0.0, 0, ON_CONTACTS
    bridging, falling = False, False
    solutions = (
        np.empty((MAX_SOLUTIONS, COORDINATES)),
        np.empty((MAX_SOLUTIONS, MOST_CANDIDATES, K_SIZE)),
        np.empty(MAX_SOLUTIONS, dtype=np.int64),
    )
    before, losses = np.empty(PLACE_SIZE), np.zeros(4)
    set_phase(phases[0], command, device)
    if count == 1 and contacts[0, K_PAIR] == FLUSH_PAIR and is_level(q, device):
        kind = ON_SURFACE
    add_path_point(0, phases[0], pushes[0], kind, q, count, contacts, losses, command, device, path)
    while reached < 1.0:
        if i + 1 == MAX_POINTS:
            return PATH_FULL, i + 1, count
        size = min(step, 1.0 - reached)
        target = 1.0 if size == 1.0 - reached else reached + size
        push = pushes[0] + target * growth
        set_phase(phases[0] + reached * turn, command, device)
        set_place(q, device, before)
        set_phase(phases[0] + target * turn, command, device)
        next_kind, next_count, ended = step_held(
            kind, q, push, mu, (target - reached) * turn, before, contacts, setting, losses
        )
        tips = next_kind == ON_CONTACTS and kind == ON_SURFACE
        if tips and size > least and size * abs(turn) > ABOVE * EVENT_WIDTH and not (bridging or falling):
            # Where it tips is narrowed first.
            count = go_back(i, q, contacts, path)
            step = max(0.5 * size, EVENT_WIDTH / abs(turn), least)
            continue
        if next_kind == ON_CONTACTS and ended == GOES_ON:
            if tips:
                count = contacts_of_tip(q, push, setting, contacts)
            ended, next_count = step_with_friction(
                q, push, mu, turns, falling, before, count, contacts, setting, solutions, losses
            )
            if ended == ON_PATCH and lay_flush(True, q, push, mu, turns, before, contacts, setting, losses):
                next_kind, next_count, ended = ON_SURFACE, 1, GOES_ON
        if ended == SHORTER or (ended == ON_PATCH and not falling and next_kind == ON_CONTACTS):
            count = go_back(i, q, contacts, path)
            if size > least and not bridging:
                step = max(0.5 * size, least)
            elif size < min(longest, 1.0 - reached):
                bridging, step = True, min(BRIDGING * size, longest)
            else:
                falling, step = True, least
            continue
        if ended != GOES_ON:
            return ended, i + 1, count
        count = next_count
        add_path_point(
            i + 1, phases[0] + target * turn, push, next_kind, q, count, contacts, losses, command, device, path
        )
        lost = unexplained(i + 1, path)
        if abs(lost) > ENERGY_STEP * command[M_PUSH] * bolt[pk.R_MAJOR] and next_kind != ON_STRIP:
            if size > least and not (bridging or falling):
                count = go_back(i, q, contacts, path)
                step = max(0.5 * size, least)
                continue
            path[0][i + 1, P_FALL] = max(lost, 0.0)
        changed = next_kind != kind or (next_kind == ON_CONTACTS and not same_features(i, count, contacts, path))
        if (
            turns
            and changed
            and not (next_kind == ON_STRIP or bridging or falling)
            and size * abs(turn) > ABOVE * EVENT_WIDTH
        ):
            count = go_back(i, q, contacts, path)
            step = max(0.5 * size, EVENT_WIDTH / abs(turn))
            continue
        i += 1
        reached, kind = target, next_kind
        ended = has_ended(i, stop_at_snap, count, contacts, setting, path)
        if ended != GOES_ON:
            return ended, i + 1, count
        # After a fall no force of friction is known: they come up in the next step, which has to be long enough.
        step = FIRST_PART * longest if losses[2] == 0.0 else min(2.0 * size, longest)
        bridging, falling = False, False
    return REACHED, i + 1, count


@kernel(nogil=True)
def certified_pose(q: Array, device: Array, bolt: Array, nut: Array) -> int:
    """What the certificate says of overlaps at a pose, whose places of contact are searched for."""
    r = bolt[pk.R_MAJOR]
    place = np.empty(PLACE_SIZE)
    places = np.empty((MAX_PLACES + 1, GAP_SIZE))
    set_place(q, device, place)
    found = find_places(REACH * r, place, device, bolt, nut, new_threads(bolt), np.empty(PLACES_WORK), places)
    touching = 0
    for j in range(found):
        if places[j, G_VALUE] > -LEAST_GAP * r:
            copy_numbers(places[j], places[touching])
            touching += 1
    return overlap(place[0:12], OVERLAP_LIMIT * r, touching, places, bolt, nut, new_stage())
