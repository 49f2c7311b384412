"""The modes of a step of a held bolt with friction: of each set of contacts, which ones open, slide and stick.

Every mode is solved (``_modes_kernel``), again where a contact has moved to a place close by, and kept where nothing
overlaps beside its contacts.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch, zeros
from threadstate.contact._geometry_kernel import TWO_PI, copy_numbers
from threadstate.contact._stage_kernel import THREAD_THREAD
from threadstate.device._chart_kernel import COORDINATES, D_SCALE, PLACE_SIZE, set_place
from threadstate.device._friction_rest_kernel import rests
from threadstate.device._gap_kernel import G_POINT, G_THETA, G_VALUE, G_Z
from threadstate.device._modes_kernel import (
    AS_LISTED,
    COARSE_OVERLAP,
    K_FORCE,
    K_HELD,
    K_MODE,
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
from threadstate.device._places_kernel import Threads, add_thread, find_places
from threadstate.device._rest_kernel import Work
from threadstate.device._settle_kernel import distance

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MAX_SOLUTIONS = 8
"""The most solutions of a step that are told apart."""

DISTINCT = 1e-6
"""How far apart (nominal radii) the bolt is in two solutions."""

SAME_CONTACT = 0.03
"""Points of two contacts (nominal radii) that are nearer to each other are one contact's."""

MOST_MOVES, MOST_RIDGE_MOVES = 3, 12
"""How often contacts of a mode move to places close by, and how often where they are frozen."""

BESIDE_ON_RIDGE = 1e-3
"""Points (nominal radii) that are nearer to each other are one contact's where contacts are frozen."""

STEP_REACH = 2e-2
"""How far (nominal radii) the bolt may go in a step beside where the hand carries it."""

Solutions = tuple[Array, Array, Indices]
"""Of a step: coordinates, contacts, and number of contacts of each solution."""

Setting = tuple[Array, Array, Array, Array, Array, Threads, Work, ModesWork]
"""Command, device, strip, bolt, nut, and the work of searches, descents and modes."""


@kernel(allocates=True)
def new_solutions() -> Solutions:
    """Room for the solutions of a step."""
    return (
        np.empty((MAX_SOLUTIONS, COORDINATES)),
        np.empty((MAX_SOLUTIONS, MOST_CANDIDATES, K_SIZE)),
        np.empty(MAX_SOLUTIONS, dtype=np.int64),
    )


@kernel(allocates=True)
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
    contacts = scratch(MOST_CANDIDATES, K_SIZE)
    trial, start = scratch(COORDINATES), scratch(COORDINATES)
    place = scratch(PLACE_SIZE)
    for j in range(COORDINATES):
        start[j] = carried[j] if turns else 0.5 * (carried[j] + free[j])
    total, has_met, least = 0, False, math.inf
    is_frozen = modes_work.frozen[0] == 1
    apart = (BESIDE_ON_RIDGE if is_frozen else SAME_CONTACT) * r
    most_sticking = MOST_CONTACTS if modes_work.drag[0, 0] > 0.0 else 2
    if not turns:
        set_place(q, device, place)
        touching = touching_contacts(
            find_places(COARSE_OVERLAP * r, place, device, bolt, nut, threads, search, places), places, contacts
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
def places_of_contacts(modes: Indices, count: int, contacts: Array, q: Array, setting: Setting) -> int:
    """Sets the places with which a mode begins at ``q``: AS_LISTED, or the number of those that a search has found
    where a contact cannot be followed; none where contacts are frozen, which have their own.
    """
    _, device, _, bolt, nut, threads, _, work = setting
    if work.frozen[0] == 1:
        return 0
    place = scratch(PLACE_SIZE)
    set_place(q, device, place)
    if follow_contacts(modes, count, contacts, place, device, bolt, nut, threads, work):
        return AS_LISTED
    return find_places(REACH * device[D_SCALE], place, device, bolt, nut, threads, work.search, work.places)


@kernel()
def touching_contacts(found: int, places: Array, contacts: Array) -> int:
    """Sets contacts without forces at the ``found`` places, as many as there is room for; their number."""
    count = min(found, MOST_CONTACTS)
    for c in range(count):
        for h in range(K_SIZE):
            contacts[c, h] = 0.0
        set_contact(places[c], contacts[c])
    return count


@kernel(allocates=True)
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
    allowed = COARSE_OVERLAP if falls or modes_work.frozen[0] == 1 else OVERLAP
    place, bracket = scratch(PLACE_SIZE), zeros(6)
    tops = np.empty(MOST_CANDIDATES, dtype=np.int64)
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
        if is_frozen:
            found = add_on_ridges(modes, count, place, contacts, found, setting, tops)
            if has_twins(count, tops):
                return UNSOLVED, -1
        beside, moved = overlap_beside(modes, count, r, allowed, found, contacts, places), -1
        if beside >= 0:
            gap = places[beside]
            moved = contact_below(beside, count, tops) if is_frozen else moved_contact(modes, count, gap, r, contacts)
        if moved < 0 or moves == (MOST_RIDGE_MOVES if is_frozen else MOST_MOVES):
            return SOLVED, beside
        if is_frozen:
            move_on_ridge(places[beside], moved == last_moved, moves, bracket, contacts[moved])
        for h in range(3):
            contacts[moved, K_POINT + h] = places[beside, G_POINT + h]
        last_moved = moved
        moves += 1


@kernel()
def add_on_ridges(
    modes: Indices, count: int, place: Array, contacts: Array, found: int, setting: Setting, tops: Indices
) -> int:
    """Adds the maximum on the ridge of each frozen contact, which may lie between two azimuths of the search, to the
    ``found`` places; their number then. Sets which place that is, -1 where there is none.
    """
    _, device, _, bolt, nut, threads, _, modes_work = setting
    places, search = modes_work.places, modes_work.search
    for c in range(count):
        tops[c] = -1
        if modes[c] != OPENS and contacts[c, K_PAIR] == THREAD_THREAD:
            theta, z, reach = contacts[c, K_THETA], contacts[c, K_Z], REACH * device[D_SCALE]
            found, tops[c] = add_thread(theta, z, 0.0, reach, place, device, bolt, nut, threads, search, found, places)
    return found


@kernel()
def moved_contact(modes: Indices, count: int, gap: Array, r: float, contacts: Array) -> int:
    """Which contact has moved to a place of overlap close by, -1 for none."""
    moved, nearest = -1, SAME_CONTACT * r
    for c in range(count):
        if modes[c] == OPENS:
            continue
        apart = 0.0
        for h in range(3):
            apart += (contacts[c, K_POINT + h] - gap[G_POINT + h]) ** 2
        if math.sqrt(apart) < nearest:
            moved, nearest = c, math.sqrt(apart)
    return moved


@kernel()
def has_twins(count: int, tops: Indices) -> bool:
    """Whether two frozen contacts are on one ridge, where a single one between them holds as well."""
    for c in range(count):
        if tops[c] >= 0 and contact_below(tops[c], c, tops) >= 0:
            return True
    return False


@kernel()
def contact_below(top: int, count: int, tops: Indices) -> int:
    """Which frozen contact is on the ridge whose maximum is a place, -1 for none."""
    for c in range(count):
        if tops[c] == top:
            return c
    return -1


@kernel()
def move_on_ridge(gap: Array, has_moved: bool, moves: int, bracket: Array, contact: Array) -> None:
    """Moves a frozen contact towards a place of overlap: to it, or to between the last two points beyond which it was
    on either side.

    The bolt rolls along a ridge that is nearly level: with the contact at one end it is deepest at the other.
    ``bracket`` has azimuth, height and way to the deepest place of the last contact from which that is up the azimuth,
    then of the last from which it is down; a way of zero where there was none. It begins anew where the last of the
    ``moves`` before was another contact's, and not this one ``has_moved``.
    """
    theta, z = contact[K_THETA], contact[K_Z]
    by_theta = (gap[G_THETA] - theta + math.pi) % TWO_PI - math.pi
    if not has_moved:
        bracket[:] = 0.0
    here = 0 if by_theta > 0.0 else 3
    bracket[here], bracket[here + 1], bracket[here + 2] = theta, z, by_theta
    other = bracket[3 - here : 6 - here]
    if other[2] == 0.0:
        contact[K_THETA], contact[K_Z] = theta + by_theta, gap[G_Z]
        return
    part = 0.5 if moves % 3 == 2 else by_theta / (by_theta - other[2])
    contact[K_THETA], contact[K_Z] = theta + part * (other[0] - theta), z + part * (other[1] - z)


@kernel()
def is_same(contact: Array, gap: Array, most: float) -> bool:
    """Whether a place is nearer to a contact than so far, and so that contact's."""
    apart = 0.0
    for h in range(3):
        apart += (contact[K_POINT + h] - gap[G_POINT + h]) ** 2
    return math.sqrt(apart) < most


@kernel()
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


@kernel()
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


@kernel()
def copy_guess(is_frozen: bool, guessed: Array, contact: Array) -> None:
    """Sets point, normal and force of a contact to those of a guess, and where on its edge or thread it is, unless it
    is frozen.
    """
    copy_numbers(guessed[0:K_SLIP], contact[0:K_SLIP])
    if not is_frozen:
        contact[K_PAIR], contact[K_THETA], contact[K_Z] = guessed[K_PAIR], guessed[K_THETA], guessed[K_Z]
