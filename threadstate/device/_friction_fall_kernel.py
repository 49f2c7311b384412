"""A held bolt that falls with friction: the flow that a drag slows down, until the bolt is in equilibrium again.

Where a step has no solution no quasi-static law says how the bolt moves on. It is declared: as in a steepest descent
the velocity is the force that nothing balances, in the descent's metric, and contacts slide, stick and open as in any
step. Of this flow implicit steps are taken: steps of the path at the same command, with a drag on the way since each
began, which is lowered as the bolt slows down, until next to nothing of it is left. Without friction this is the
steepest descent.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch, zeros
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.contact._stage_kernel import FLUSH as FLUSH_PAIR
from threadstate.device._chart_kernel import COORDINATES, D_RIGID, D_SCALE, N_OFFSET, N_ROTATION, PLACE_SIZE, set_place
from threadstate.device._descent_kernel import AT_REST, DEEPEST, FLUSH, SLIPPED
from threadstate.device._flush_kernel import centre_of_pressure, set_flush
from threadstate.device._friction_held_kernel import lay_flush
from threadstate.device._friction_rest_kernel import rests
from threadstate.device._friction_step_kernel import (
    GOES_ON,
    NO_MINIMUM,
    ON_PATCH,
    SLIPPED_OFF,
    TOO_DEEP,
    TOO_MANY,
    chosen,
    friction_loss,
    kept,
    solve_on_ridges,
    solve_step,
)
from threadstate.device._gap_kernel import G_NORM, G_NORMAL
from threadstate.device._knot_kernel import LOADED
from threadstate.device._leg_kernel import M_PUSH, ON_CONTACTS, ON_SURFACE
from threadstate.device._modes_kernel import (
    COARSE_OVERLAP,
    K_FORCE,
    K_MODE,
    K_NORMAL,
    K_PAIR,
    K_POINT,
    K_SLIP,
    MOST_CANDIDATES,
    MOST_CONTACTS,
    STICKS,
    ModesWork,
    set_contact,
)
from threadstate.device._modes_kernel import CONTACT_SIZE as K_SIZE
from threadstate.device._places_kernel import find_places, lowest_height
from threadstate.device._rest_kernel import Work, free_coordinates, set_metric
from threadstate.device._settle_kernel import distance
from threadstate.device._slide_kernel import lies_beside
from threadstate.device._step_modes_kernel import Setting, Solutions, touching_contacts
from threadstate.device._turn_kernel import fall_down
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

LONGEST_WAY, BRIDGED_WAY = 5e-4, 1e-2
"""How far (nominal radii) the bolt goes in a step of a fall at most, and in one where no shorter step goes on."""

FIRST_DRAG, LEAST_DRAG, LARGEST_DRAG = 100.0, 0.1, 1e8
"""Drags, as forces over the push a way over the nominal radius: that of the first step, that below which the next step
has none, and that above which a fall is given up."""

LOWERED, LOWERED_AGAIN = 3.0, 2.0
"""By how much the drag changes from step to step; and where the fall is followed again, as it came to no end."""

FRICTIONLESS = -1.0
"""In place of the number of solutions of a step: the bolt has fallen in it as one without friction."""

LEFT = 1e-9
"""The force of the drag, over the push, at which the bolt is in equilibrium."""

MOST_STEPS, LOOKED_AFTER, LEAST_WAY = 1000, 100, 1e-5
"""The most steps of a fall that are tried; after so many each it is looked at whether the bolt has gone so far (nominal
radii) in them. If it has not, no step goes on."""


@kernel()
def set_drag(drag: float, q: Array, before: Array, device: Array, work: ModesWork) -> None:
    """Sets the drag on a step from ``q``, where the bolt has the pose ``before``."""
    n = free_coordinates(device)
    set_metric(n, before, device, work.drag)
    for i in range(n):
        for j in range(n):
            work.drag[i, j] *= drag
    copy_numbers(q, work.begun)


@kernel()
def end_drag(work: ModesWork) -> None:
    """Sets the drag to zero."""
    work.drag[:, :] = 0.0


@kernel()
def has_left(place: Array, bolt: Array) -> int:
    """How a path ends at a pose in which the bolt has left the nut or what is modelled of it, GOES_ON if it has not."""
    if math.hypot(place[N_OFFSET], place[N_OFFSET + 1]) > bolt[pk.R_MAJOR]:
        return SLIPPED_OFF
    if lowest_height(place, bolt) < -DEEPEST * bolt[pk.P]:
        return TOO_DEEP
    if bolt[pk.STEEPEST] * math.hypot(place[N_ROTATION + 2], place[N_ROTATION + 5]) > place[N_ROTATION + 8]:
        return NO_MINIMUM
    return GOES_ON


@kernel()
def flow_step(
    drag: float,
    on_ridges: bool,
    q: Array,
    push: float,
    mu: float,
    before: Array,
    count: int,
    contacts: Array,
    setting: Setting,
    solutions: Solutions,
) -> tuple[int, float]:
    """The solution that an implicit step with a drag goes to, and how far (nominal radii); infinitely where none is."""
    device, modes_work = setting[1], setting[7]
    candidates = scratch(MOST_CANDIDATES, K_SIZE)
    for c in range(count):
        copy_numbers(contacts[c], candidates[c])
    set_drag(drag, q, before, device, modes_work)
    number, total = solve_step(q, q, before, push, mu, True, count, candidates, setting, solutions)
    if number == 0 and on_ridges:
        number, total = solve_on_ridges(q, before, push, mu, count, contacts, candidates, setting, solutions)
    if number == 0 or total > MOST_CANDIDATES:
        return 0, math.inf
    best = chosen(number, q, count, contacts, device, solutions)
    return best, distance(q, solutions[0][best], device) / device[D_SCALE]


@kernel()
def longer_step(
    drag: float,
    q: Array,
    push: float,
    mu: float,
    before: Array,
    count: int,
    contacts: Array,
    setting: Setting,
    solutions: Solutions,
) -> tuple[int, float, float]:
    """As :func:`flow_step`, with the largest drag below one with which a step goes on; and that drag.

    Where a contact passes a corner no short step may go on, and one that ends beyond it does.
    """
    while drag > 0.0:
        drag = drag / LOWERED_AGAIN if drag > LEAST_DRAG else 0.0
        best, way = flow_step(drag, True, q, push, mu, before, count, contacts, setting, solutions)
        if way <= BRIDGED_WAY:
            return best, way, drag
    return 0, math.inf, drag


@kernel()
def flow(
    q: Array,
    push: float,
    mu: float,
    lowered: float,
    on_ridges: bool,
    before: Array,
    count: int,
    contacts: Array,
    setting: Setting,
    solutions: Solutions,
    losses: Array,
) -> tuple[int, int, int]:
    """Lets the bolt flow with friction from ``q``, in place, to an equilibrium.

    The drag is ``lowered`` by that factor from step to step; ``on_ridges`` steps without a solution are solved with
    contacts of the threads at points of the bolt. Where no step goes on the bolt stays where friction can hold it, or,
    ``on_ridges``, a longer one is tried. Returns what holds it there, its number of contacts and how the path ends
    there, if it does: NO_MINIMUM where nothing holds it. ``before`` is the pose before the step in which it falls, and
    is set to the last one.
    """
    command, device, bolt, modes_work = setting[0], setting[1], setting[3], setting[7]
    r = device[D_SCALE]
    for h in range(4):
        losses[h] = 0.0
    drag, solved_drag, friction = FIRST_DRAG, FIRST_DRAG, 0.0
    earlier = scratch(COORDINATES)
    copy_numbers(q, earlier)
    modes_work.guessed[0] = 0
    for tried in range(1, MOST_STEPS + 1):
        best, way = flow_step(drag, on_ridges, q, push, mu, before, count, contacts, setting, solutions)
        is_stuck = False
        if way > LONGEST_WAY:
            drag = max(lowered * drag, LEAST_DRAG)
            is_stuck = drag > LARGEST_DRAG
        if tried % LOOKED_AFTER == 0:
            is_stuck = is_stuck or distance(earlier, q, device) < LEAST_WAY * r
            copy_numbers(q, earlier)
        if is_stuck:
            touching = contacts_at_rest(q, push, mu, setting, contacts)
            if touching > 0 or not on_ridges:
                return ON_CONTACTS, touching, GOES_ON if touching > 0 else NO_MINIMUM
            best, way, drag = longer_step(solved_drag, q, push, mu, before, count, contacts, setting, solutions)
            if math.isinf(way):
                break
        elif way > LONGEST_WAY:
            continue
        solved_drag = drag
        copy_numbers(solutions[0][best], q)
        solved = int(solutions[2][best])
        friction += friction_loss(count, contacts, solved, solutions[1][best])
        count = kept(solved, solutions[1][best], command[M_PUSH])
        for c in range(count):
            copy_numbers(solutions[1][best, c], contacts[c])
        losses[0] = friction
        if drag * way <= LEFT:
            return ON_CONTACTS, count, GOES_ON
        if lies_beside(q, device, bolt[pk.R_MAJOR]) and lay_flush(
            False, q, push, mu, True, before, contacts, setting, losses
        ):
            losses[0] += friction
            losses[2] = 0.0
            return ON_SURFACE, 1, GOES_ON
        set_place(q, device, before)
        ended = has_left(before, bolt)
        if ended != GOES_ON:
            return ON_CONTACTS, 0, ended
        if 2.0 * way < LONGEST_WAY:
            drag = drag / lowered if drag > LEAST_DRAG else 0.0
    touching = contacts_at_rest(q, push, mu, setting, contacts)
    return ON_CONTACTS, touching, GOES_ON if touching > 0 else NO_MINIMUM


@kernel()
def contacts_at_rest(q: Array, push: float, mu: float, setting: Setting, contacts: Array) -> int:
    """The number of contacts that hold the bolt where it is, which are set; 0 where they do not."""
    _, device, _, bolt, nut, threads, _, modes_work = setting
    place = scratch(PLACE_SIZE)
    held = scratch(MOST_CANDIDATES, K_SIZE)
    set_place(q, device, place)
    found = find_places(
        COARSE_OVERLAP * device[D_SCALE], place, device, bolt, nut, threads, modes_work.search, modes_work.places
    )
    count = touching_contacts(found, modes_work.places, held)
    if not rests(q, push, mu, count, held, device):
        return 0
    for c in range(count):
        copy_numbers(held[c], contacts[c])
    return kept(count, contacts, push)


@kernel(allocates=True)
def fall_with_friction(
    q: Array,
    push: float,
    mu: float,
    before: Array,
    count: int,
    contacts: Array,
    setting: Setting,
    solutions: Solutions,
    losses: Array,
) -> tuple[int, int, int]:
    """Lets the bolt fall from ``q``, in place; returns as :func:`flow`.

    A flow that does not come to an end is followed again, in shorter steps and on ridges. Where that does not either
    the bolt falls as one without friction, of which no force is known then: ``losses`` say so by ``FRICTIONLESS``.
    """
    modes_work = setting[7]
    start, begun = q.copy(), contacts[:count].copy()
    for again in (False, True):
        copy_numbers(start, q)
        for c in range(count):
            copy_numbers(begun[c], contacts[c])
        lowered = LOWERED_AGAIN if again else LOWERED
        kind, found, ended = flow(
            q, push, mu, lowered, again, before.copy(), count, contacts, setting, solutions, losses
        )
        end_drag(modes_work)
        if ended != NO_MINIMUM:
            return kind, found, ended
    copy_numbers(start, q)
    for h in range(4):
        losses[h] = 0.0
    losses[2] = FRICTIONLESS
    kind, found, ended = fall_without_friction(q, push, setting, contacts)
    return kind, found, ended


@kernel()
def fall_without_friction(q: Array, push: float, setting: Setting, contacts: Array) -> tuple[int, int, int]:
    """Lets the bolt fall by steepest descent from ``q``, in place; returns as :func:`flow`."""
    _, device, _, bolt, nut, threads, work, _ = setting
    status, found = fall_down(q, push, device, bolt, nut, threads, work)
    if status == SLIPPED:
        return ON_CONTACTS, 0, SLIPPED_OFF
    if status == FLUSH:
        return lay_without_friction(q, push, device, contacts)
    if status != AT_REST:
        return ON_CONTACTS, 0, NO_MINIMUM
    count = frictionless_contacts(found, push, work, contacts)
    return ON_CONTACTS, count, TOO_MANY if count > MOST_CONTACTS else GOES_ON


@kernel()
def lay_without_friction(q: Array, push: float, device: Array, contacts: Array) -> tuple[int, int, int]:
    """Lays a bolt flush on the surface, in place, in equilibrium without friction; returns as :func:`flow`."""
    if not device[D_RIGID] > 0.0:
        return ON_CONTACTS, 0, ON_PATCH
    place = scratch(PLACE_SIZE)
    set_flush(device, q)
    set_place(q, device, place)
    x, y, force, _ = centre_of_pressure(q, push, place, device, zeros(3))
    for h in range(K_SIZE):
        contacts[0, h] = 0.0
    contacts[0, K_POINT], contacts[0, K_POINT + 1], contacts[0, K_NORMAL + 2] = x, y, 1.0
    contacts[0, K_FORCE + 2], contacts[0, K_MODE], contacts[0, K_PAIR] = force, STICKS, FLUSH_PAIR
    return ON_SURFACE, 1, GOES_ON


@kernel()
def frictionless_contacts(found: int, push: float, work: Work, contacts: Array) -> int:
    """Sets the contacts of a bolt that rests without friction; their number, one more than there is room for."""
    places, multipliers = work.places, work.multipliers
    count = 0
    for j in range(found):
        force = multipliers[j] * places[j, G_NORM]
        if force > LOADED * push:
            if count == MOST_CONTACTS:
                return count + 1
            set_contact(places[j], contacts[count])
            for h in range(3):
                contacts[count, K_FORCE + h] = force * places[j, G_NORMAL + h]
                contacts[count, K_SLIP + h] = 0.0
            contacts[count, K_MODE] = STICKS
            count += 1
    return count
