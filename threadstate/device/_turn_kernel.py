"""A bolt that is turned: the command's phase moves, the bolt follows its minimum, and falls where that ends.

Each step begins where the last two lead, or from the last pose, and descends to a minimum near by. A step that ends
farther away than allowed, or with other contacts, is halved: down to ``EVENT_WIDTH`` for contacts, and down to
``LEAST_STEP`` where no minimum is near. From there the bolt falls.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch, zeros
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.contact._stage_kernel import FLUSH as FLUSH_PAIR
from threadstate.contact._stage_kernel import THREAD_THREAD
from threadstate.contact._stage_kernel import Work as StageWork
from threadstate.contact._stage_kernel import new_work as new_stage
from threadstate.device._certificate_kernel import FREE, overlap
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_FINE,
    D_SCALE,
    N_OFFSET,
    PLACE_SIZE,
    set_place,
)
from threadstate.device._descent_kernel import AT_REST, FLUSH, TOO_FAR, UNSETTLED, Descent, descend, descend_followed
from threadstate.device._flush_kernel import centre_of_pressure, flush_until, set_flush, tip_over
from threadstate.device._gap_kernel import G_PAIR, G_THETA, G_VALUE, G_Z
from threadstate.device._knot_kernel import K_CONTACTS, K_PLACES, Knot, copy_knot, new_knot, set_bend, set_knot
from threadstate.device._leg_kernel import (
    BRIDGED,
    DEGREE,
    E_PHASE,
    FAILED,
    FULL,
    L_DESCENTS,
    L_EVENTS,
    L_FAILURES,
    L_OVERLAP,
    L_POINTS,
    L_STATUS,
    L_UNCERTAIN,
    LEG_SIZE,
    M_LONGEST,
    M_PUSH,
    ON_CONTACTS,
    ON_STRIP,
    ON_SURFACE,
    SNAPPED,
    T_COORDINATES,
    T_KIND,
    T_PHASE,
    T_POTENTIAL,
    T_TORQUE,
    TORQUE_PASSED,
    TURNED,
    Leg,
    add_changes,
    add_event,
    add_fall,
    add_kind_events,
    add_point,
    has_snapped,
    potential_of,
    set_command_rates,
    set_phase,
    torque_of,
)
from threadstate.device._place_near_kernel import follow_place
from threadstate.device._places_kernel import FINE, FINEST, MAX_KNOWN, Threads, new_threads, set_known
from threadstate.device._rest_kernel import Scene, Work, new_work
from threadstate.device._settle_kernel import (
    END_OVERLAP,
    END_TOLERANCE,
    FALL_STEP,
    LAST_STEPS,
    LEAST_GAP,
    OVERLAP_LIMIT,
    PATH_OVERLAP,
    PATH_TOLERANCE,
    STEP_LENGTH,
    distance,
)
from threadstate.device._span_kernel import (
    LEAST_DIP,
    MAX_SPANS,
    SPAN_SIZE,
    SPAN_TO,
    changes,
    first_change,
    first_missed,
    hides_change,
    set_spans,
)
from threadstate.device._strip_kernel import (
    C_FORCE,
    C_NORMAL,
    C_PAIR,
    C_POINT,
    is_near_strip,
    set_strip,
    strip_holds,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

ABOVE = 1.0 + 1e-6
"""By how much a step has to be longer than the shortest one to be shortened: less is round-off of the phase."""

FIRST_STEP, LARGEST_STEP, LEAST_STEP = 0.25 * DEGREE, 2.0 * DEGREE, 1e-3 * DEGREE
"""Steps of the phase (rad): the first, the longest where no other is asked for, and the shortest."""

EVENT_WIDTH, CHANGE_WIDTH = 0.05 * DEGREE, 5e-3 * DEGREE
"""Steps (rad) in which the bolt leaves a level pose, or what has friction gains or loses contacts; and those in which a
bolt without friction does."""

DESCENT_STEP = 3e-3
"""The longest step of a descent in a step of the phase, in nominal radii."""

PREDICTED = 0.03
"""The longest way (nominal radii) from a point to where the descent of the next one begins."""

TIP = 1e-4
"""How far (rad) a bolt is tipped that a level pose no longer holds."""

LEVEL_REACH = 1e-3
"""How near (nominal radii) to a level pose on the surface or on a strip a bolt is laid there, if it is held there."""

BRIDGE = 2.0 * DEGREE
"""The longest step (rad) tried past a phase at which no step is short enough: beside a level pose and where contacts
take turns minima are there whose descent goes round in circles."""

PAST_A_FALL = 2.0
"""Of a step that bridges: it is tried, once, as a fall from there has not come to an end."""

ENERGY_STEP = 1e-6
"""Potential, over push times nominal radius, that a step may leave unexplained by the torque: more is a fall."""

MAX_DESCENTS, MAX_FAILURES = 2000, 150
"""Descents, and descents that did not end, after which a leg is given up."""

LONGER = 2.5
"""How much longer the steps of a fall become each time that it does not end."""

FALL_ALIKE = 1e-4
"""How near to each other (nominal radii) a fall ends in longer and in shorter steps."""

MOST_REWOUND = 8.0
"""How often a leg is taken back at most to before a contact that was missed."""

NEAR_STEPS, SLOW_STEPS, TURN_FALL_STEPS = 12, 48, 300
"""Steps of a descent to a minimum near by, of one after a step of at most ``EVENT_WIDTH``, as beside the end of a
minimum it takes many, and of that of a fall."""

TORQUE_LIMIT = 20.0
"""Torque, over push times nominal radius, from which on the bolt counts as jammed."""

# Where a leg is: phase and next step (rad), what holds the bolt, how the next step was chosen and the phase up to which
# contacts are known to change (NaN: none is), whether edges are sampled most finely until contacts change, whether
# longer steps are tried, whether the bolt falls next; how many places the last descent has found, from which the
# next one follows them; and how often the path has been taken back.
S_PHASE, S_STEP, S_KIND, S_AIMED, S_CHANGE, S_FINE, S_BRIDGING, S_FALLING, S_KNOWN, S_REWOUND = range(10)
STATE_SIZE = 10

ALWAYS = 2.0
"""Edges are sampled most finely to the end of the leg, not until contacts change (1)."""

# How a step was chosen: not by a change, to end before one by its first or second estimate, or by halving.
AIMED_TWICE, HALVED = 2.0, 3.0

# What becomes of a step: it is taken, tried again with another length, or the leg ends here.
TAKEN, AGAIN, ENDED = range(3)

Setting = tuple[Array, Array, Array, Array, Array, Threads, Work]
"""What a leg is followed with: command, device, strip, bolt, nut, and the work of searches and descents."""


@kernel()
def set_flush_contact(q: Array, push: float, device: Array, contacts: Array) -> int:
    """Sets the resultant of the pressure on the nut's surface as one contact; 1."""
    place = scratch(PLACE_SIZE)
    set_place(q, device, place)
    x, y, force, _ = centre_of_pressure(q, push, place, device, zeros(3))
    contacts[0, C_PAIR] = FLUSH_PAIR
    contacts[0, C_POINT], contacts[0, C_POINT + 1], contacts[0, C_POINT + 2] = x, y, 0.0
    contacts[0, C_NORMAL], contacts[0, C_NORMAL + 1], contacts[0, C_NORMAL + 2] = 0.0, 0.0, 1.0
    contacts[0, C_FORCE] = force
    return 1


@kernel()
def predict(step: float, q: Array, here: Knot, device: Array, trial: Array) -> None:
    """Sets where a step of the phase begins: as the last point's derivatives say, and by how they have changed.

    Where a minimum is about to end they grow beyond bounds, and the step begins as the hand carries the bolt.
    """
    for j in range(COORDINATES):
        trial[j] = q[j] + step * (here.drift[j] + 0.5 * step * here.bend[j])
    if not distance(q, trial, device) <= PREDICTED * device[D_SCALE]:
        copy_numbers(q, trial)


@kernel()
def laid_level(
    q: Array, push: float, device: Array, strip: Array, bolt: Array, nut: Array, contacts: Array
) -> tuple[int, int]:
    """What holds a bolt that is beside a level pose in which it lies on the surface or on a strip; its contacts.

    It is moved there, in place. A level pose that is held is a minimum of the potential: the only one near by.
    """
    place = scratch(PLACE_SIZE)
    level = scratch(COORDINATES)
    leave = scratch(COORDINATES)
    near = LEVEL_REACH * bolt[pk.R_MAJOR]
    set_place(q, device, place)
    is_level = is_near_strip(place, bolt) and set_strip(place[N_OFFSET + 2], device, strip, bolt, level)
    if is_level and distance(q, level, device) < near:
        holds, count = strip_holds(level, push, 0.0, 0.0, device, strip, bolt, nut, contacts, leave)
        if holds:
            copy_numbers(level, q)
            return ON_STRIP, count
    if abs(place[N_OFFSET + 2]) < near and set_flush(device, level) and distance(q, level, device) < near:
        until, _ = flush_until(push, device, bolt, nut, level)
        if until > push:
            copy_numbers(level, q)
            return ON_SURFACE, set_flush_contact(q, push, device, contacts)
    return ON_CONTACTS, 0


@kernel()
def fall_down(
    q: Array, push: float, device: Array, bolt: Array, nut: Array, threads: Threads, work: Work
) -> tuple[int, int]:
    """Falls from ``q``, in place, to a minimum: how the descent ended, and the number of places there.

    Where it does not end it begins again with places of contact searched more finely, and then with longer steps.
    """
    r = bolt[pk.R_MAJOR]
    start = scratch(COORDINATES)
    copy_numbers(q, start)
    status, found = UNSETTLED, 0
    for attempt in range(5):
        copy_numbers(start, q)
        device[D_FINE] = FINEST if attempt == 1 else FINE
        longest = FALL_STEP if attempt < 2 else STEP_LENGTH * LONGER ** (attempt - 2)
        wanted = Descent(push, longest * r, math.inf, TURN_FALL_STEPS, PATH_TOLERANCE, PATH_OVERLAP)
        status, found = descend(q, wanted, Scene(device, bolt, nut, threads, work))
        if status != UNSETTLED:
            break
    device[D_FINE] = FINE
    return status, found


@kernel(allocates=True)
def fall_for_certain(q: Array, setting: Setting) -> tuple[int, int, bool]:
    """Falls from ``q``, in place: how the descent ended, the number of places there, and whether it certainly ends so.

    A descent that passes near to where descents part ends on one side or the other as its steps are long. So it is
    followed in steps of a quarter as well, and where that ends elsewhere of a sixteenth, whose end it is then.
    """
    command, device, _, bolt, nut, threads, work = setting
    r, push = bolt[pk.R_MAJOR], command[M_PUSH]
    start, end = q.copy(), scratch(COORDINATES)
    status, found = fall_down(q, push, device, bolt, nut, threads, work)
    for parts in (4, 16):
        if status == UNSETTLED:
            break
        copy_numbers(q, end)
        copy_numbers(start, q)
        wanted = Descent(push, FALL_STEP / parts * r, math.inf, parts * TURN_FALL_STEPS, PATH_TOLERANCE, PATH_OVERLAP)
        finer, found = descend(q, wanted, Scene(device, bolt, nut, threads, work))
        if finer == status and (status != AT_REST or distance(q, end, device) < FALL_ALIKE * r):
            return status, found, parts == 4
        status = finer
    return status, found, False


@kernel()
def closed_step(kind: int, q: Array, setting: Setting, there: Knot, trial: Array) -> bool:
    """The pose on the surface or the strip at a new command: whether it is held there; sets its contacts.

    Where it is not held ``trial`` is set to the pose tipped a little in the direction in which the bolt leaves.
    """
    command, device, strip, bolt, nut, _, _ = setting
    push = command[M_PUSH]
    leave = scratch(COORDINATES)
    place = scratch(PLACE_SIZE)
    there.numbers[K_PLACES] = 0
    if kind == ON_SURFACE:
        until, direction = flush_until(push, device, bolt, nut, trial)
        if until > push:
            there.numbers[K_CONTACTS] = set_flush_contact(trial, push, device, there.contacts)
            return True
        # The centre of pressure has left the patch: the bolt tips towards it.
        set_place(trial, device, place)
        x, y, _, _ = centre_of_pressure(trial, push, place, device, zeros(3))
        direction = math.atan2(y - place[N_OFFSET + 1], x - place[N_OFFSET])
        tip_over(direction, TIP, place, trial)
        return False
    set_place(q, device, place)
    if not set_strip(place[N_OFFSET + 2], device, strip, bolt, trial):
        copy_numbers(q, trial)
        return False
    holds, count = strip_holds(trial, push, 0.0, 0.0, device, strip, bolt, nut, there.contacts, leave)
    there.numbers[K_CONTACTS] = count
    if not holds:
        for j in range(COORDINATES):
            trial[j] += TIP * leave[j]
    return holds


@kernel()
def descent_near(q: Array, known: int, steps: int, setting: Setting) -> tuple[int, int]:
    """Descends from ``q``, in place, to a minimum near by: how it ended, and the number of places there.

    Of the places ``known`` ones are followed from where the last descent has ended.
    """
    command, device, _, bolt, nut, threads, work = setting
    r = bolt[pk.R_MAJOR]
    wanted = Descent(command[M_PUSH], DESCENT_STEP * r, STEP_LENGTH * r, steps, PATH_TOLERANCE, PATH_OVERLAP)
    return descend_followed(q, known, wanted, Scene(device, bolt, nut, threads, work))


@kernel()
def set_found(found: int, setting: Setting, there: Knot) -> None:
    """Sets the knot of where a descent has ended at contacts, with so many places."""
    command, device, _, bolt, nut, threads, work = setting
    rates = scratch(COORDINATES)
    set_command_rates(command, device, rates)
    set_knot(found, command[M_PUSH], rates, Scene(device, bolt, nut, threads, work), there)


@kernel()
def at_minimum(status: int, found: int, trial: Array, setting: Setting, there: Knot) -> tuple[int, int, int]:
    """What becomes of a step whose descent has ended so, and returns as :func:`minimum_near`."""
    command, device, _, _, _, _, _ = setting
    if status == FLUSH:
        set_flush(device, trial)
        there.numbers[K_PLACES] = 0
        there.numbers[K_CONTACTS] = set_flush_contact(trial, command[M_PUSH], device, there.contacts)
        return TAKEN, AT_REST, ON_SURFACE
    if status != AT_REST:
        return ENDED, status, ON_CONTACTS
    set_found(found, setting, there)
    return TAKEN, AT_REST, ON_CONTACTS


@kernel()
def minimum_near(
    size: float, left: float, held: bool, state: Array, setting: Setting, trial: Array, there: Knot, leg: Leg
) -> tuple[int, int, int]:
    """The minimum near ``trial``, in place, for a step of a size (rad): what becomes of the step; sets its contacts.

    Then how the descent ended, and what holds the bolt there. ``held`` is False where the bolt is leaving a level pose.
    Where no minimum is near the next step is shorter, then longer, then a fall.
    """
    command, device, strip, bolt, nut, _, _ = setting
    push = command[M_PUSH]
    begun = scratch(COORDINATES)
    copy_numbers(trial, begun)
    leg[0][L_DESCENTS] += 1
    known = int(state[S_KNOWN])
    status, found = descent_near(trial, known, NEAR_STEPS if size > ABOVE * EVENT_WIDTH else SLOW_STEPS, setting)
    if status == UNSETTLED and state[S_FINE] == 0.0 and size <= ABOVE * EVENT_WIDTH:
        # Of two places beside each other that take turns one has been missed at a time.
        device[D_FINE] = FINEST
        copy_numbers(begun, trial)
        status, found = descent_near(trial, 0, SLOW_STEPS, setting)
        state[S_FINE] = 1.0 if status == AT_REST else 0.0
    state[S_KNOWN] = found if status == AT_REST else 0.0
    if held and (status == AT_REST or status == UNSETTLED):
        if status == UNSETTLED:
            copy_numbers(begun, trial)
        laid, count = laid_level(trial, push, device, strip, bolt, nut, there.contacts)
        if laid != ON_CONTACTS:
            state[S_KNOWN] = 0.0
            there.numbers[K_PLACES], there.numbers[K_CONTACTS] = 0, count
            return TAKEN, AT_REST, laid
    if status == TOO_FAR or status == UNSETTLED:
        leg[0][L_FAILURES] += 1 if status == UNSETTLED else 0
        if size > ABOVE * LEAST_STEP and state[S_BRIDGING] == 0.0 and held:
            state[S_STEP] = max(0.25 * size, LEAST_STEP)
        elif status == UNSETTLED and size < min(BRIDGE, left):
            state[S_BRIDGING] = max(state[S_BRIDGING], 1.0)
            state[S_STEP] = min(4.0 * size, BRIDGE)
        else:
            state[S_FALLING] = 1.0
            state[S_STEP] = LEAST_STEP if held else EVENT_WIDTH
        return AGAIN, status, ON_CONTACTS
    return at_minimum(status, found, trial, setting, there)


@kernel()
def try_step(
    target: float,
    left: float,
    q: Array,
    state: Array,
    setting: Setting,
    here: Knot,
    trial: Array,
    there: Knot,
    leg: Leg,
) -> tuple[int, int, int]:
    """The equilibrium after a step to a phase, in ``trial``; returns as :func:`minimum_near`."""
    command, device, _, _, _, _, _ = setting
    size = abs(target - state[S_PHASE])
    kind = int(state[S_KIND])
    held = True
    set_phase(target, command, device)
    device[D_FINE] = FINEST if state[S_FINE] > 0.0 else FINE
    if kind != ON_CONTACTS:
        held = closed_step(kind, q, setting, there, trial)
        if held:
            return TAKEN, AT_REST, kind
        if size > ABOVE * EVENT_WIDTH and state[S_BRIDGING] == 0.0:
            state[S_STEP] = 0.5 * size
            return AGAIN, AT_REST, kind
    elif state[S_FALLING] > 0.0:
        copy_numbers(q, trial)
    else:
        predict(target - state[S_PHASE], q, here, device, trial)
    if state[S_FALLING] > 0.0:
        state[S_KNOWN] = 0.0
        status, found, is_certain = fall_for_certain(trial, setting)
        if status == UNSETTLED and state[S_BRIDGING] < PAST_A_FALL and left > EVENT_WIDTH:
            state[S_FALLING], state[S_BRIDGING], state[S_STEP] = 0.0, PAST_A_FALL, EVENT_WIDTH
            return AGAIN, status, ON_CONTACTS
        leg[0][L_UNCERTAIN] += 0 if is_certain else 1
        return at_minimum(status, found, trial, setting, there)
    return minimum_near(size, left, held, state, setting, trial, there, leg)


@kernel()
def refused(target: float, changed: bool, width: float, at: float, lost: float, state: Array) -> bool:
    """Whether a step has to be shorter: something changes in it, or the potential does as the torque does not explain.

    What changes is told of steps of a ``width`` at most, inf where nothing does, or ``changed`` is False where it may
    have done so within the step; ``at`` says about where in it that is, if it is known. Sets the next step where it has
    to be shorter.
    """
    size = abs(target - state[S_PHASE])
    if state[S_FALLING] > 0.0 or state[S_BRIDGING] > 0.0:
        return False
    if size > ABOVE * width:
        # Up to just before the change; where that has failed twice, or nothing says where it is, half as far.
        aimed = at - 0.5 * width
        if state[S_AIMED] < AIMED_TWICE and aimed < 0.9 * size:
            state[S_AIMED] += 1.0
            state[S_STEP] = max(aimed, width)
        else:
            state[S_AIMED] = HALVED
            state[S_STEP] = max(0.5 * size, width)
        if changed:
            state[S_CHANGE] = target
        return True
    if abs(lost) > ENERGY_STEP and size > ABOVE * LEAST_STEP:
        state[S_STEP] = max(0.5 * size, LEAST_STEP)
        return True
    return False


@kernel()
def unexplained(trial: Array, there: Knot, target: float, setting: Setting, leg: Leg) -> float:
    """The potential lost in a step to a phase that the torque, by the trapezoid, does not explain."""
    command, device, _, _, _, _, _ = setting
    result, points, _, _ = leg
    last = int(result[L_POINTS]) - 1
    lost = points[last, T_POTENTIAL] - potential_of(trial, command[M_PUSH], device)
    torque = torque_of(trial, there.numbers[K_CONTACTS], there.contacts, command, device)
    return lost + 0.5 * (points[last, T_TORQUE] + torque) * (target - points[last, T_PHASE])


@kernel()
def go_on(target: float, kind: int, is_smooth: bool, after_change: bool, longest: float, state: Array) -> None:
    """Sets the state of a leg after a step to a phase, and how long the next one is at most.

    ``after_change`` is True where contacts have changed without a fall: the path is smooth again from there.
    """
    next_step = FIRST_STEP if after_change else 2.0 * abs(target - state[S_PHASE])
    # The change that this step was to end before comes now, or half-way at most.
    beyond = abs(state[S_CHANGE] - target)
    if not is_smooth or not beyond > LEAST_STEP:
        state[S_CHANGE] = math.nan
    elif 0.0 < state[S_AIMED] < HALVED:
        next_step = CHANGE_WIDTH
    else:
        next_step = max(0.5 * beyond, min(beyond, CHANGE_WIDTH))
    state[S_PHASE], state[S_KIND], state[S_STEP] = target, kind, min(next_step, longest)
    state[S_AIMED], state[S_BRIDGING], state[S_FALLING] = 0.0, 0.0, 0.0
    state[S_FINE] = state[S_FINE] if is_smooth or state[S_FINE] == ALWAYS else 0.0


@kernel()
def begin(q: Array, kind: int, start: float, parts: int, state: Array, setting: Setting, here: Knot) -> int:
    """Sets the state of a leg and its contacts at its beginning; how the descent there ended.

    Intervals of edges are divided into so many parts.
    """
    command, device, _, _, _, _, _ = setting
    trial = scratch(COORDINATES)
    for j in range(STATE_SIZE):
        state[j] = 0.0
    state[S_PHASE], state[S_STEP], state[S_KIND] = start, min(FIRST_STEP, command[M_LONGEST]), kind
    state[S_CHANGE] = math.nan
    set_phase(start, command, device)
    device[D_FINE] = parts
    if kind != ON_CONTACTS:
        closed_step(kind, q, setting, here, trial)
        return AT_REST
    status, found = descent_near(q, 0, LAST_STEPS, setting)
    state[S_KNOWN] = found if status == AT_REST else 0.0
    set_found(found, setting, here)
    return status


@kernel()
def overlaps_at(i: int, gap: Array, setting: Setting, leg: Leg) -> bool:
    """Whether a place of overlap, followed in place to a point of the path, overlaps there, or is not clearly open."""
    command, device, _, bolt, nut, threads, work = setting
    _, points, _, _ = leg
    place = scratch(PLACE_SIZE)
    set_phase(points[i, T_PHASE], command, device)
    set_place(points[i, T_COORDINATES : T_COORDINATES + COORDINATES], device, place)
    if not follow_place(gap, place, device, bolt, nut, threads, work.search):
        return False
    return gap[G_VALUE] > -LEAST_DIP * bolt[pk.R_MAJOR]


@kernel(allocates=True)
def go_back(missed: Array, q: Array, state: Array, setting: Setting, here: Knot, leg: Leg) -> bool:
    """Takes a path back to before a place overlaps that the search has missed until now, and has it known there.

    False where it is not to be found so: the path goes on as it is.
    """
    _, _, _, _, _, threads, _ = setting
    result, points, _, events = leg
    gap, last = missed.copy(), int(result[L_POINTS]) - 1
    i = last
    while i >= 0 and points[i, T_KIND] == ON_CONTACTS and overlaps_at(i, gap, setting, leg):
        copy_numbers(gap, missed)
        i -= 1
    if i == last or i < 0 or points[i, T_KIND] != ON_CONTACTS:
        return False
    ahead = points[last, T_PHASE] - points[i, T_PHASE]
    result[L_POINTS] = i + 1
    while result[L_EVENTS] > 0 and (events[int(result[L_EVENTS]) - 1, E_PHASE] - points[i, T_PHASE]) * ahead > 0.0:
        result[L_EVENTS] -= 1
    if missed[G_PAIR] == THREAD_THREAD and threads.known_count[0] < MAX_KNOWN:
        set_known(missed[G_THETA], missed[G_Z], 0.0, threads.known[threads.known_count[0]])
        threads.known_count[0] += 1
    copy_numbers(points[i, T_COORDINATES : T_COORDINATES + COORDINATES], q)
    rewound = state[S_REWOUND] + 1.0
    begin(q, ON_CONTACTS, points[i, T_PHASE], FINEST, state, setting, here)
    state[S_REWOUND], state[S_FINE] = rewound, ALWAYS
    return True


@kernel(allocates=True)
def step_on(
    end: float, q: Array, state: Array, setting: Setting, here: Knot, there: Knot, spans: Array, leg: Leg
) -> tuple[int, int]:
    """Takes a step towards ``end``, or says that it has to be tried again: what became of it, and how a descent ended.

    ``q``, state and the knot ``here`` are those after the step where it is taken.
    """
    command, device, _, bolt, nut, threads, work = setting
    result, _, _, events = leg
    push = command[M_PUSH]
    trial = scratch(COORDINATES)
    before, kind = state[S_PHASE], int(state[S_KIND])
    left = abs(end - before)
    size = min(state[S_STEP], left)
    target = end if size == left else before + (size if end > before else -size)
    step, unit = target - before, push * bolt[pk.R_MAJOR]
    verdict, status, next_kind = try_step(target, left, q, state, setting, here, trial, there, leg)
    if verdict != TAKEN:
        return verdict, status
    lost = unexplained(trial, there, target, setting, leg)
    on_contacts = kind == ON_CONTACTS and next_kind == ON_CONTACTS
    scene = Scene(device, bolt, nut, threads, work)
    total = set_spans(here, there, push, scene, spans) if on_contacts else 0
    missed = first_missed(total, spans, bolt) if state[S_FALLING] + state[S_BRIDGING] == 0.0 else -1
    if missed >= 0 and state[S_REWOUND] < MOST_REWOUND:
        place = there.places[int(spans[missed, SPAN_TO])].copy()
        if go_back(place, q, state, setting, here, leg):
            return AGAIN, status
        state[S_REWOUND] = MOST_REWOUND
        set_phase(target, command, device)
    changed, at, width = changes(total, here, there, spans), math.nan, math.inf
    if next_kind != kind:
        width = EVENT_WIDTH
    elif changed or hides_change(total, step, here, there, spans, scene):
        width = CHANGE_WIDTH
        at = abs(first_change(total, step, spans))
    if refused(target, changed, width, at, lost / unit, state):
        return AGAIN, status
    bridged = state[S_BRIDGING] > 0.0 and state[S_FALLING] == 0.0
    fell = not bridged and lost > ENERGY_STEP * unit
    if not bridged and lost < -ENERGY_STEP * unit:
        # A contact that was there before has been missed.
        result[L_UNCERTAIN] += 1
    if fell:
        add_fall(target, before, q, trial, lost, device, leg)
    add_kind_events(target, before, kind, next_kind, result, events)
    add_changes(target, before, total, spans, here, there, leg)
    if bridged:
        add_event(BRIDGED, target, before, -1.0, -1.0, result, events)
    is_smooth = on_contacts and not changed and not fell and not bridged
    if is_smooth:
        set_bend(step, here, there)
    go_on(target, next_kind, is_smooth, changed and not fell, command[M_LONGEST], state)
    copy_numbers(trial, q)
    copy_knot(there, here)
    return TAKEN, status


@kernel(allocates=True)
def follow_phase(
    q: Array, kind: int, start: float, end: float, stop_at_snap: bool, setting: Setting, leg: Leg
) -> tuple[int, int]:
    """Follows the bolt from ``q``, in place, while the phase goes from ``start`` to ``end`` (rad).

    Returns how it ended and what holds the bolt then. ``leg`` is set.
    """
    command, device, _, bolt, _, _, _ = setting
    result, points, _, _ = leg
    for j in range(LEG_SIZE):
        result[j] = 0.0
    state = scratch(STATE_SIZE)
    here, there = new_knot(), new_knot()
    spans = scratch(MAX_SPANS, SPAN_SIZE)
    status = begin(q, kind, start, FINE, state, setting, here)
    add_point(state[S_PHASE], int(state[S_KIND]), q, here, command, device, leg)
    if status != AT_REST:
        return FAILED + status, kind
    limit = TORQUE_LIMIT * command[M_PUSH] * bolt[pk.R_MAJOR]
    while state[S_PHASE] != end:
        if result[L_DESCENTS] >= MAX_DESCENTS or result[L_FAILURES] >= MAX_FAILURES:
            return FULL, int(state[S_KIND])
        verdict, status = step_on(end, q, state, setting, here, there, spans, leg)
        if verdict == ENDED:
            return FAILED + status, int(state[S_KIND])
        if verdict == AGAIN:
            continue
        if not add_point(state[S_PHASE], int(state[S_KIND]), q, here, command, device, leg):
            return FULL, int(state[S_KIND])
        if abs(points[int(result[L_POINTS]) - 1, T_TORQUE]) > limit:
            return TORQUE_PASSED, int(state[S_KIND])
        if stop_at_snap and has_snapped(leg, bolt):
            return SNAPPED, int(state[S_KIND])
    return TURNED, int(state[S_KIND])


@kernel()
def certified_end(q: Array, kind: int, setting: Setting, stage: StageWork) -> int:
    """What the certificate says of the overlap at a leg's end; moves the bolt, in place, to the last digits."""
    command, device, _, bolt, nut, threads, work = setting
    if kind != ON_CONTACTS:
        # Level on the surface, or in phase on a strip: nothing overlaps.
        return FREE
    r = bolt[pk.R_MAJOR]
    place = scratch(PLACE_SIZE)
    touching = 0
    wanted = Descent(command[M_PUSH], STEP_LENGTH * r, STEP_LENGTH * r, LAST_STEPS, END_TOLERANCE, END_OVERLAP)
    _, found = descend_followed(q, 0, wanted, Scene(device, bolt, nut, threads, work))
    for j in range(found):
        if work.places[j, G_VALUE] > -LEAST_GAP * r:
            copy_numbers(work.places[j], work.places[touching])
            touching += 1
    set_place(q, device, place)
    return overlap(place[0:12], OVERLAP_LIMIT * r, touching, work.places, bolt, nut, stage)


@kernel(nogil=True, allocates=True)
def turn_with(
    q: Array,
    kind: int,
    start: float,
    end: float,
    stop_at_snap: bool,
    command: Array,
    device: Array,
    strip: Array,
    bolt: Array,
    nut: Array,
    leg: Leg,
) -> tuple[int, int]:
    """Turns a bolt from ``q``, in place: how it ended and what holds the bolt then; sets the leg."""
    setting = (command, device, strip, bolt, nut, new_threads(bolt), new_work())
    status, kind = follow_phase(q, kind, start, end, stop_at_snap, setting, leg)
    leg[0][L_STATUS] = status
    leg[0][L_OVERLAP] = certified_end(q, kind, setting, new_stage())
    return status, kind
