"""A step of a held bolt on contacts with friction: which contacts it may have, and every solution of their modes.

The path goes on with the solution whose contacts do what they did before, or else with the one nearest to where the
hand carries the bolt. Where there is none the step has to be shorter, or the bolt falls (``_friction_fall_kernel``).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import TWO_PI, copy_numbers
from threadstate.contact._stage_kernel import THREAD_THREAD
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_SCALE,
    PLACE_SIZE,
    set_place,
)
from threadstate.device._friction_rest_kernel import rests
from threadstate.device._gap_kernel import G_NORM, G_NORMAL, G_PAIR, G_POINT, G_THETA, G_VALUE, G_Z, GAP_SIZE
from threadstate.device._modes_kernel import (
    AS_LISTED,
    K_FORCE,
    K_HELD,
    K_MODE,
    K_NORMAL,
    K_PAIR,
    K_POINT,
    K_SLIP,
    K_THETA,
    K_Z,
    MOST_CANDIDATES,
    MOST_CONTACTS,
    OPENS,
    OVERLAP,
    REACH,
    SAME_POINT,
    SLIPS,
    SOLVED,
    STICKS,
    UNSOLVED,
    ModesWork,
    cones_hold,
    follow_contacts,
    overlap_beside,
    set_contact,
    solve_mode,
)
from threadstate.device._modes_kernel import CONTACT_SIZE as K_SIZE
from threadstate.device._places_kernel import Threads, find_places
from threadstate.device._rest_kernel import (
    AT_REST,
    Work,
    descend,
)
from threadstate.device._settle_kernel import PATH_OVERLAP, PATH_TOLERANCE, distance
from threadstate.device._turn_kernel import (
    LOADED,
    M_PUSH,
)

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MAX_SOLUTIONS = 8
"""The most solutions of a step that are told apart."""

DISTINCT = 1e-6
"""How far apart (nominal radii) the bolt is in two solutions."""

SAME_CONTACT = 0.03
"""Points of two contacts (nominal radii) that are nearer to each other are one contact's."""

MOST_MOVES, MOST_RIDGE_MOVES = 3, 8
"""How often contacts of a mode move to places close by, and how often where they are frozen."""

BESIDE_ON_RIDGE = 1e-3
"""Points (nominal radii) that are nearer to each other are one contact's where contacts are frozen."""

MOST_RIDGE_CANDIDATES = 6
"""The most contacts of which the modes are enumerated where contacts are frozen."""

STEP_REACH = 2e-2
"""How far (nominal radii) the bolt may go in a step beside where the hand carries it."""

# How a path ends.
REACHED, SNAP_REACHED, TORQUE_OVER, SLIPPED_OFF, TOO_DEEP, TOO_MANY, ON_PATCH, PATH_FULL, NO_MINIMUM = range(9)
GOES_ON, SHORTER = -1, -2
"""Of a step: the path goes on, or the step has to have another length, as a rule a shorter one."""

FRICTION_PARTS = 8
"""In how many parts friction grows where a step is begun without it."""

FREE_STEPS = 60
"""Steps of the descent without friction that says which contacts a step may gain."""

Solutions = tuple[Array, Array, Indices]
"""Of a step: coordinates, contacts, and number of contacts of each solution."""

Setting = tuple[Array, Array, Array, Array, Array, Threads, Work, ModesWork]
"""Command, device, strip, bolt, nut, and the work of searches, descents and modes."""


@kernel(allocates=False)
def add_candidate(count: int, gap: Array, device: Array, apart: float, contacts: Array) -> int:
    """Adds a place of overlap to a step's contacts, unless one is nearer than ``apart`` (nominal radii) to it already.

    Returns their number then, one more than there is room for.
    """
    for i in range(count):
        if is_same(contacts[i], gap, apart * device[D_SCALE]):
            return count
    if count < MOST_CANDIDATES:
        for h in range(K_SIZE):
            contacts[count, h] = 0.0
        set_contact(gap, contacts[count])
    return count + 1


@kernel(allocates=False)
def friction_of(contact: Array) -> float:
    """The size of a contact's force across its normal."""
    normal, square = 0.0, 0.0
    for h in range(3):
        normal += contact[K_FORCE + h] * contact[K_NORMAL + h]
        square += contact[K_FORCE + h] ** 2
    return math.sqrt(max(square - normal * normal, 0.0))


@kernel(allocates=False)
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


@kernel(allocates=False)
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

    ``met`` is set to where the last such one does, or the one that overlaps least where contacts are frozen. ``q`` is
    the bolt before the step, ``carried`` where the hand carries it, ``free`` where it would be without friction,
    ``before`` the pose before. A bolt that is turned has at most two contacts that stick, and pivots about the line
    between them; one that falls may have more.
    """
    _, device, _, bolt, nut, threads, _, modes_work = setting
    places, search = modes_work.places, modes_work.search
    r = device[D_SCALE]
    modes = np.empty(MOST_CANDIDATES, dtype=np.int64)
    matches = np.empty(MOST_CANDIDATES, dtype=np.int64)
    contacts = np.empty((MOST_CANDIDATES, K_SIZE))
    trial, start = np.empty(COORDINATES), np.empty(COORDINATES)
    place = np.empty(PLACE_SIZE)
    for j in range(COORDINATES):
        start[j] = carried[j] if turns else 0.5 * (carried[j] + free[j])
    total, has_met, least = 0, False, math.inf
    is_frozen = modes_work.frozen[0] == 1
    apart = (BESIDE_ON_RIDGE if is_frozen else SAME_CONTACT) * r
    most_sticking = MOST_CONTACTS if modes_work.drag[0, 0] > 0.0 else 2
    if not turns:
        set_place(q, device, place)
        touching = touching_contacts(
            find_places(OVERLAP * r, place, device, bolt, nut, threads, search, places), places, contacts
        )
        if rests(q, push, mu, touching, contacts, device):
            total = add_solution(total, q, touching, contacts, device, solutions)
    modes[:] = SLIPS
    found = places_of_contacts(modes, count, candidates, start, setting)
    at_start = places[: max(found, count)].copy()
    guessed_code = match_guess(count, candidates, r, modes_work, matches)
    for code in range(3**count):
        rest, sticking, touching = code, 0, 0
        for c in range(count):
            modes[c] = rest % 3
            rest //= 3
            sticking += 1 if modes[c] == STICKS else 0
            touching += 0 if modes[c] == OPENS else 1
        if sticking > most_sticking or touching > MOST_CONTACTS:
            continue
        status, beside = UNSOLVED, -1
        for begins_at_guess in (True, False):
            if status == SOLVED or (begins_at_guess and code != guessed_code):
                continue
            for c in range(count):
                copy_numbers(candidates[c], contacts[c])
                contacts[c, K_MODE] = modes[c]
                copy_numbers(candidates[c, K_FORCE : K_FORCE + 3], contacts[c, K_HELD : K_HELD + 3])
            if begins_at_guess:
                copy_numbers(modes_work.guess, trial)
                for c in range(count):
                    if matches[c] >= 0:
                        copy_guess(is_frozen, modes_work.guessed_contacts[matches[c]], contacts[c])
                near = places_of_contacts(modes, count, contacts, trial, setting)
            else:
                copy_numbers(start, trial)
                near = found
                for j in range(len(at_start)):
                    copy_numbers(at_start[j], places[j])
            status, beside = solve_moved(modes, count, mu, near, carried, trial, push, unit, before, setting, contacts)
        if status != SOLVED:
            continue
        if beside >= 0:
            is_known = False
            for c in range(count):
                is_known = is_known or is_same(candidates[c], places[beside], apart)
            if not (is_known or (is_frozen and places[beside, G_VALUE] > least)):
                copy_numbers(places[beside], met)
                has_met, least = True, places[beside, G_VALUE]
        else:
            total = add_solution(total, trial, count, contacts, device, solutions)
    return total, has_met


@kernel(allocates=False)
def copy_guess(is_frozen: bool, guessed: Array, contact: Array) -> None:
    """Sets point, normal and force of a contact to those of a guess, and where on its edge or thread it is, unless it
    is frozen.
    """
    copy_numbers(guessed[0:K_SLIP], contact[0:K_SLIP])
    if not is_frozen:
        contact[K_PAIR], contact[K_THETA], contact[K_Z] = guessed[K_PAIR], guessed[K_THETA], guessed[K_Z]


@kernel()
def places_of_contacts(modes: Indices, count: int, contacts: Array, q: Array, setting: Setting) -> int:
    """Sets the places with which a mode begins at ``q``: AS_LISTED, or the number of those that a search has found
    where a contact cannot be followed; none where contacts are frozen, which have their own.
    """
    _, device, _, bolt, nut, threads, _, work = setting
    if work.frozen[0] == 1:
        return 0
    place = np.empty(PLACE_SIZE)
    set_place(q, device, place)
    if follow_contacts(modes, count, contacts, place, device, bolt, nut, threads, work):
        return AS_LISTED
    return find_places(REACH * device[D_SCALE], place, device, bolt, nut, threads, work.search, work.places)


@kernel()
def solve_moved(
    modes: Indices,
    count: int,
    mu: float,
    found: int,
    carried: Array,
    q: Array,
    push: float,
    unit: float,
    before: Array,
    setting: Setting,
    contacts: Array,
) -> tuple[int, int]:
    """Solves a mode, and again where a contact has moved to a place close by, as from an edge to the thread beside it.

    Returns SOLVED where it has a solution whose forces are what the mode says, and which place overlaps beside its
    contacts there, -1 if none does.
    """
    _, device, _, bolt, nut, threads, _, modes_work = setting
    places, search = modes_work.places, modes_work.search
    r, falls = device[D_SCALE], modes_work.drag[0, 0] > 0.0
    place, move = np.empty(PLACE_SIZE), np.zeros(4)
    last_moved, moves = -1, 0
    is_frozen = modes_work.frozen[0] == 1
    while True:
        status = solve_mode(
            modes, count, mu, found, q, push, unit, before, device, bolt, nut, threads, contacts, modes_work
        )
        is_far = distance(carried, q, device) > STEP_REACH * r
        if status != SOLVED or is_far or not cones_hold(modes, count, mu, unit, r, contacts, falls):
            return UNSOLVED, -1
        set_place(q, device, place)
        found = find_places(REACH * r, place, device, bolt, nut, threads, search, places)
        beside = overlap_beside(modes, count, r, found, contacts, places)
        moved = moved_contact(modes, count, is_frozen, places[beside], r, contacts) if beside >= 0 else -1
        if moved < 0 or moves == (MOST_RIDGE_MOVES if is_frozen else MOST_MOVES):
            return SOLVED, beside
        if is_frozen:
            move_on_ridge(places[beside], moved == last_moved, move, contacts[moved])
        for h in range(3):
            contacts[moved, K_POINT + h] = places[beside, G_POINT + h]
        last_moved = moved
        moves += 1


@kernel(allocates=False)
def moved_contact(modes: Indices, count: int, is_frozen: bool, gap: Array, r: float, contacts: Array) -> int:
    """Which contact has moved to a place of overlap, -1 if none is near; of frozen ones only along the threads."""
    moved, nearest = -1, SAME_CONTACT * r
    for c in range(count):
        if modes[c] == OPENS or (is_frozen and not (contacts[c, K_PAIR] == gap[G_PAIR] == THREAD_THREAD)):
            continue
        apart = 0.0
        for h in range(3):
            apart += (contacts[c, K_POINT + h] - gap[G_POINT + h]) ** 2
        if math.sqrt(apart) < nearest:
            moved, nearest = c, math.sqrt(apart)
    return moved


@kernel(allocates=False)
def move_on_ridge(gap: Array, has_moved: bool, move: Array, contact: Array) -> None:
    """Moves a frozen contact to a place of overlap, or to where the line through its last two moves has none.

    The bolt rolls along a ridge that is nearly level: with the contact at one end it is deepest at the other.
    ``move`` has where the contact was before its last move, and that move: azimuth and height each.
    """
    theta, z = contact[K_THETA], contact[K_Z]
    by_theta = (gap[G_THETA] - theta + math.pi) % TWO_PI - math.pi
    by_z = gap[G_Z] - z
    to_theta, to_z = theta + by_theta, gap[G_Z]
    if has_moved and by_theta * move[2] < 0.0:
        part = move[2] / (move[2] - by_theta)
        to_theta, to_z = move[0] + part * (theta - move[0]), move[1] + part * (z - move[1])
    move[0], move[1], move[2], move[3] = theta, z, by_theta, by_z
    contact[K_THETA], contact[K_Z] = to_theta, to_z


@kernel(allocates=False)
def is_same(contact: Array, gap: Array, most: float) -> bool:
    """Whether a place is nearer to a contact than so far, and so that contact's."""
    apart = 0.0
    for h in range(3):
        apart += (contact[K_POINT + h] - gap[G_POINT + h]) ** 2
    return math.sqrt(apart) < most


@kernel(allocates=False)
def match_guess(count: int, candidates: Array, r: float, work: ModesWork, matches: Indices) -> int:
    """Sets which contact of the guess each candidate is, -1 where none; the number of the guess's modes, -1 if it does
    not fit.
    """
    code, matched, power = 0, 0, 1
    for c in range(count):
        matches[c] = -1
        nearest = SAME_POINT * r
        for g in range(int(work.guessed[0])):
            taken = False
            for h in range(c):
                taken = taken or matches[h] == g
            apart = 0.0
            for h in range(3):
                apart += (work.guessed_contacts[g, K_POINT + h] - candidates[c, K_POINT + h]) ** 2
            if not taken and math.sqrt(apart) < nearest:
                matches[c], nearest = g, math.sqrt(apart)
        if matches[c] >= 0:
            code += power * int(work.guessed_contacts[matches[c], K_MODE])
            matched += 1
        power *= 3
    return code if matched > 0 and matched == int(work.guessed[0]) else -1


@kernel(allocates=False)
def set_guess(
    part: float, q: Array, begun: Array, reached: Array, count: int, contacts: Array, work: ModesWork
) -> None:
    """Sets the guess of the next step: from ``q`` on as another one went, from begun to reached, a part as far.

    ``contacts`` are the ``count`` ones of that step's end.
    """
    for j in range(COORDINATES):
        work.guess[j] = q[j] + part * (reached[j] - begun[j])
    work.guessed[0] = count
    for c in range(count):
        copy_numbers(contacts[c], work.guessed_contacts[c])


@kernel(allocates=False)
def touching_contacts(found: int, places: Array, contacts: Array) -> int:
    """Sets contacts without forces at the ``found`` places, as many as there is room for; their number."""
    count = min(found, MOST_CONTACTS)
    for c in range(count):
        for h in range(K_SIZE):
            contacts[c, h] = 0.0
        set_contact(places[c], contacts[c])
    return count


@kernel(allocates=False)
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


@kernel(allocates=False)
def add_free_contacts(total: int, found: int, push: float, device: Array, work: Work, candidates: Array) -> int:
    """Adds the contacts of a bolt without friction, as many as there is room for; the number of candidates then."""
    places, multipliers = work[0], work[15]
    for j in range(found):
        if multipliers[j] * places[j, G_NORM] > LOADED * push:
            total = min(add_candidate(total, places[j], device, SAME_CONTACT, candidates), MOST_CANDIDATES)
    return total


@kernel(allocates=False)
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
    is_frozen = setting[7].frozen[0] == 1
    while True:
        number, has_met = enumerate_modes(
            q, q, free, before, push, command[M_PUSH], mu, turns, total, candidates, setting, solutions, met
        )
        known = total
        if has_met:
            total = add_candidate(total, met, device, BESIDE_ON_RIDGE if is_frozen else SAME_CONTACT, candidates)
        if total == known or total > (MOST_RIDGE_CANDIDATES if is_frozen else MOST_CANDIDATES):
            return number, total
        if is_frozen and number > 0:
            return number, known


@kernel(allocates=False)
def solve_on_ridges(
    q: Array,
    before: Array,
    push: float,
    mu: float,
    count: int,
    contacts: Array,
    candidates: Array,
    setting: Setting,
    solutions: Solutions,
) -> tuple[int, int]:
    """Sets solutions of a step of which contacts of the threads stay at points of the bolt, as :func:`solve_step`.

    On a ridge that is nearly level they roll to and fro, and the places that Newton's method follows run away or
    vanish; at points that stay it has room, and those are moved from one solution to the next.
    """
    work = setting[7]
    for c in range(count):
        copy_numbers(contacts[c], candidates[c])
    work.frozen[0] = 1
    number, total = solve_step(q, q, before, push, mu, True, count, candidates, setting, solutions)
    work.frozen[0] = 0
    return number, total


@kernel()
def ramp_friction(
    free: Array,
    found: int,
    before: Array,
    push: float,
    unit: float,
    mu: float,
    total: int,
    candidates: Array,
    setting: Setting,
) -> bool:
    """Sets the guess to where the bolt slides on the contacts that it has without friction, as that grows from none.

    ``free`` is its place without friction, whose ``found`` places are those of the last descent. False where a part of
    the friction has no solution.
    """
    _, device, _, bolt, nut, threads, work, modes_work = setting
    free_places, multipliers = work[0], work[15]
    places, search = modes_work.places, modes_work.search
    r = device[D_SCALE]
    modes = np.zeros(MOST_CANDIDATES, dtype=np.int64)
    contacts = np.empty((MOST_CANDIDATES, K_SIZE))
    trial, place = free.copy(), np.empty(PLACE_SIZE)
    for c in range(total):
        copy_numbers(candidates[c], contacts[c])
        modes[c] = OPENS
        for j in range(found):
            force = multipliers[j] * free_places[j, G_NORM]
            apart = 0.0
            for h in range(3):
                apart += (free_places[j, G_POINT + h] - candidates[c, K_POINT + h]) ** 2
            if force > LOADED * push and math.sqrt(apart) < SAME_CONTACT * r:
                modes[c] = SLIPS
                for h in range(3):
                    contacts[c, K_POINT + h] = free_places[j, G_POINT + h]
                    contacts[c, K_NORMAL + h] = free_places[j, G_NORMAL + h]
                    contacts[c, K_FORCE + h] = force * free_places[j, G_NORMAL + h]
        contacts[c, K_MODE] = modes[c]
    for part in range(1, FRICTION_PARTS + 1):
        set_place(trial, device, place)
        near = find_places(REACH * r, place, device, bolt, nut, threads, search, places)
        status = solve_mode(
            modes,
            total,
            mu * part / FRICTION_PARTS,
            near,
            trial,
            push,
            unit,
            before,
            device,
            bolt,
            nut,
            threads,
            contacts,
            modes_work,
        )
        if status != SOLVED:
            return False
    set_guess(0.0, trial, trial, trial, kept(total, contacts, push), contacts, modes_work)
    return True


@kernel()
def step_with_friction(
    q: Array,
    push: float,
    mu: float,
    turns: bool,
    begins_anew: bool,
    before: Array,
    count: int,
    contacts: Array,
    setting: Setting,
    solutions: Solutions,
    losses: Array,
) -> tuple[int, int]:
    """A step from ``q`` to a new command, in place: GOES_ON, and its number of contacts; SHORTER where it is unsolved.

    It is where there is no solution, or where there are too many contacts. ``before`` is the pose before the step.
    The contacts are those before it and what the bolt meets in it; where they have no solution and the step
    ``begins_anew``, and where the push grows, those that a bolt without friction would have are added.
    """
    command, device, _, bolt, nut, threads, work, _ = setting
    free = q.copy()
    candidates = np.empty((MOST_CANDIDATES, K_SIZE))
    for c in range(count):
        copy_numbers(contacts[c], candidates[c])
    number, total = 0, count
    if turns:
        number, total = solve_step(q, free, before, push, mu, turns, total, candidates, setting, solutions)
    if number == 0 and total <= MOST_CANDIDATES and (begins_anew or not turns):
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
        if status != AT_REST:
            copy_numbers(q, free)
            found = 0
        known = total
        total = add_free_contacts(total, found, push, device, work, candidates)
        if total > known or not turns:
            number, total = solve_step(q, free, before, push, mu, turns, total, candidates, setting, solutions)
        if number == 0 and not turns and total <= MOST_CANDIDATES:
            # Half-way to where it would be without friction is too far for a bolt that friction all but holds.
            number, total = solve_step(q, q, before, push, mu, turns, total, candidates, setting, solutions)
        ramps = number == 0 and turns and found > 0 and total <= MOST_CANDIDATES
        if ramps and ramp_friction(free, found, before, push, command[M_PUSH], mu, total, candidates, setting):
            number, total = solve_step(q, free, before, push, mu, turns, total, candidates, setting, solutions)
    if number == 0 and turns and begins_anew:
        number, total = solve_on_ridges(q, before, push, mu, count, contacts, candidates, setting, solutions)
    losses[2] = number
    if number == 0 or total > MOST_CANDIDATES:
        return SHORTER, 0
    best = chosen(number, q, count, contacts, device, solutions)
    copy_numbers(solutions[0][best], q)
    losses[0] = friction_loss(count, contacts, int(solutions[2][best]), solutions[1][best])
    count = int(solutions[2][best])
    used = kept(count, solutions[1][best], command[M_PUSH])
    for c in range(used):
        copy_numbers(solutions[1][best, c], contacts[c])
    return GOES_ON, used
