"""A step of a held bolt on contacts with friction: which contacts it may have, and which solution it goes on with.

Solutions are those of the contacts' modes (``_step_modes_kernel``). The path goes on with the one whose contacts do
what they did before, or else with the one nearest to where the hand carries the bolt. Where there is none the step has
to be shorter, or the bolt falls (``_friction_fall_kernel``).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.device._chart_kernel import COORDINATES, D_SCALE, PLACE_SIZE, set_place
from threadstate.device._descent_kernel import AT_REST, Descent, descend
from threadstate.device._gap_kernel import G_NORM, G_NORMAL, G_POINT, GAP_SIZE
from threadstate.device._knot_kernel import LOADED
from threadstate.device._leg_kernel import M_PUSH
from threadstate.device._modes_kernel import CONTACT_SIZE as K_SIZE
from threadstate.device._modes_kernel import (
    K_FORCE,
    K_MODE,
    K_NORMAL,
    K_POINT,
    K_SLIP,
    MOST_CANDIDATES,
    OPENS,
    REACH,
    SLIPS,
    SOLVED,
    set_contact,
    solve_mode,
)
from threadstate.device._places_kernel import find_places
from threadstate.device._rest_kernel import Scene, Work
from threadstate.device._settle_kernel import PATH_OVERLAP, PATH_TOLERANCE, distance
from threadstate.device._step_modes_kernel import (
    BESIDE_ON_RIDGE,
    SAME_CONTACT,
    STEP_REACH,
    Setting,
    Solutions,
    enumerate_modes,
    is_same,
    set_guess,
)

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

MOST_RIDGE_CANDIDATES = 5
"""The most contacts of which the modes are enumerated where contacts are frozen."""

# How a path ends.
REACHED, SNAP_REACHED, TORQUE_OVER, SLIPPED_OFF, TOO_DEEP, TOO_MANY, ON_PATCH, PATH_FULL, NO_MINIMUM = range(9)
GOES_ON, SHORTER = -1, -2
"""Of a step: the path goes on, or the step has to have another length, as a rule a shorter one."""

FRICTION_PARTS = 8
"""In how many parts friction grows where a step is begun without it."""

FREE_STEPS = 60
"""Steps of the descent without friction that says which contacts a step may gain."""


@kernel()
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
    places, multipliers = work.places, work.multipliers
    for j in range(found):
        if multipliers[j] * places[j, G_NORM] > LOADED * push:
            total = min(add_candidate(total, places[j], device, SAME_CONTACT, candidates), MOST_CANDIDATES)
    return total


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
    met = scratch(GAP_SIZE)
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


@kernel()
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


@kernel(allocates=True)
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
    free_places, multipliers = work.places, work.multipliers
    places, search = modes_work.places, modes_work.search
    r = device[D_SCALE]
    modes = np.zeros(MOST_CANDIDATES, dtype=np.int64)
    contacts = scratch(MOST_CANDIDATES, K_SIZE)
    trial, place = free.copy(), scratch(PLACE_SIZE)
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
    free = scratch(COORDINATES)
    copy_numbers(q, free)
    candidates = scratch(MOST_CANDIDATES, K_SIZE)
    for c in range(count):
        copy_numbers(contacts[c], candidates[c])
    number, total = 0, count
    if turns:
        number, total = solve_step(q, free, before, push, mu, turns, total, candidates, setting, solutions)
    if number == 0 and total <= MOST_CANDIDATES and (begins_anew or not turns):
        wanted = Descent(push, STEP_REACH * device[D_SCALE], math.inf, FREE_STEPS, PATH_TOLERANCE, PATH_OVERLAP)
        status, found = descend(free, wanted, Scene(device, bolt, nut, threads, work))
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
