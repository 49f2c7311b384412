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
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.contact._stage_kernel import FLUSH as FLUSH_PAIR
from threadstate.contact._stage_kernel import Work as StageWork
from threadstate.contact._stage_kernel import new_work as new_stage
from threadstate.device._certificate_kernel import FREE, overlap
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_CENTRE,
    D_FINE,
    D_PLACE,
    D_ROTATION,
    N_CENTRE,
    N_OFFSET,
    PLACE_SIZE,
    elastic_energy,
    set_place,
)
from threadstate.device._flush_kernel import centre_of_pressure, flush_until, set_flush, tip_over
from threadstate.device._gap_kernel import G_NORM, G_NORMAL, G_PAIR, G_POINT, G_VALUE
from threadstate.device._places_kernel import FINE, FINEST, Threads, new_threads
from threadstate.device._rest_kernel import (
    AT_REST,
    FLUSH,
    TOO_FAR,
    UNSETTLED,
    Descent,
    Scene,
    Work,
    descend,
    descend_followed,
    new_work,
)
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
from threadstate.device._strip_kernel import (
    C_FORCE,
    C_NORMAL,
    C_PAIR,
    C_POINT,
    CONTACT_SIZE,
    MAX_CONTACTS,
    is_near_strip,
    set_strip,
    strip_holds,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

DEGREE = math.pi / 180.0

ABOVE = 1.0 + 1e-6
"""By how much a step has to be longer than the shortest one to be shortened: less is round-off of the phase."""

FIRST_STEP, LARGEST_STEP, EVENT_WIDTH, LEAST_STEP = 0.25 * DEGREE, 2.0 * DEGREE, 0.05 * DEGREE, 1e-3 * DEGREE
"""Steps of the phase (rad): the first, the longest where no other is asked for, those in which contacts change, and the
shortest."""

DESCENT_STEP = 3e-3
"""The longest step of a descent in a step of the phase, in nominal radii."""

LOADED = 1e-6
"""Part of the push from which on a place counts as a contact."""

TIP = 1e-4
"""How far (rad) a bolt is tipped that a level pose no longer holds."""

LEVEL_REACH = 1e-3
"""How near (nominal radii) to a level pose on the surface or on a strip a bolt is laid there, if it is held there."""

BRIDGE = 2.0 * DEGREE
"""The longest step (rad) tried past a phase at which no step is short enough: beside a level pose and where contacts
take turns minima are there whose descent goes round in circles."""

ENERGY_STEP = 1e-6
"""Potential, over push times nominal radius, that a step may leave unexplained by the torque: more is a fall."""

MAX_DESCENTS, MAX_FAILURES = 2000, 150
"""Descents, and descents that did not end, after which a leg is given up."""

LONGER = 2.5
"""How much longer the steps of a fall become each time that it does not end."""

NEAR_STEPS, SLOW_STEPS, TURN_FALL_STEPS = 12, 48, 300
"""Steps of a descent to a minimum near by, of one after a step of at most ``EVENT_WIDTH``, as beside the end of a
minimum it takes many, and of that of a fall."""

SNAP_SPAN, SNAP_FALL = 3.0 * DEGREE, 0.05
"""A snap: the origin goes down by more than this part of a thread pitch within this span of phase."""

BELOW_TOP = 1e-9
"""How far below the nut's top, in nominal radii, a contact on a thread lies after a snap."""

TORQUE_LIMIT = 20.0
"""Torque, over push times nominal radius, from which on the bolt counts as jammed."""

ON_CONTACTS, ON_SURFACE, ON_STRIP = range(3)
"""What holds the bolt: contacts at points, the nut's surface, a strip of flank."""

# How a leg ends; the ends of a descent that are failures come after these.
TURNED, SNAPPED, TORQUE_PASSED, FULL = range(4)
FAILED = 10

# A point of the path: phase (rad), what holds the bolt, potential, elastic energy, torque, number of contacts,
# coordinates, rotation by rows and translation.
T_PHASE, T_KIND, T_POTENTIAL, T_ENERGY, T_TORQUE, T_COUNT, T_COORDINATES, T_POSE = 0, 1, 2, 3, 4, 5, 6, 12
POINT_SIZE = 24
MAX_POINTS = 2500

# An event: which, phase (rad), phase before, features before and after (-1: none), a point, drop, way, potential lost.
E_KIND, E_PHASE, E_BEFORE, E_OLD_PAIR, E_PAIR, E_POINT, E_DROP, E_WAY, E_LOSS = 0, 1, 2, 3, 4, 5, 8, 9, 10
EVENT_SIZE = 11
MAX_EVENTS = 400
GAINED, LOST, MOVED, FALL, SNAP, ON_FLUSH, OFF_FLUSH, ON_FLANK, OFF_STRIP, BRIDGED = range(10)

# A command in numbers: the rotation at phase 0 by rows, whether the phase is about the bolt, the commanded height, the
# push, the longest step of the phase (rad).
M_TILT, M_ABOUT_BOLT, M_HEIGHT, M_PUSH, M_LONGEST = 0, 9, 10, 11, 12
COMMAND_SIZE = 13

# The result of a leg: how it ended, numbers of points, of events, of descents and of those that did not end, what the
# certificate says of the end.
L_STATUS, L_POINTS, L_EVENTS, L_DESCENTS, L_FAILURES, L_OVERLAP = range(6)
LEG_SIZE = 6

Leg = tuple[Array, Array, Array, Array]
"""Of a leg: result, points, contacts of each point, events."""

# Where a leg is: phase and next step (rad), what holds the bolt, its number of contacts, whether the last step was
# smooth, whether longer steps are tried, whether the bolt falls next; and how many places the last descent has found,
# from which the next one follows them.
S_PHASE, S_STEP, S_KIND, S_COUNT, S_SMOOTH, S_BRIDGING, S_FALLING, S_KNOWN = range(8)
STATE_SIZE = 8

# What becomes of a step: it is taken, tried again with another length, or the leg ends here.
TAKEN, AGAIN, ENDED = range(3)

Setting = tuple[Array, Array, Array, Array, Array, Threads, Work]
"""What a leg is followed with: command, device, strip, bolt, nut, and the work of searches and descents."""


@kernel()
def set_phase(phase: float, command: Array, device: Array) -> None:
    """Sets the commanded rotation and place of a device at a phase (rad)."""
    c, s = math.cos(phase), math.sin(phase)
    for i in range(3):
        a, b, d = command[M_TILT + i], command[M_TILT + 3 + i], command[M_TILT + 6 + i]
        if command[M_ABOUT_BOLT] > 0.0:
            row = M_TILT + 3 * i
            a, b, d = command[row], command[row + 1], command[row + 2]
            device[D_ROTATION + 3 * i] = a * c + b * s
            device[D_ROTATION + 3 * i + 1] = b * c - a * s
            device[D_ROTATION + 3 * i + 2] = d
        else:
            device[D_ROTATION + i] = c * a - s * b
            device[D_ROTATION + 3 + i] = s * a + c * b
            device[D_ROTATION + 6 + i] = d
    for i in range(3):
        device[D_PLACE + i] = device[D_CENTRE] * device[D_ROTATION + 3 * i + 2]
    device[D_PLACE + 2] += command[M_HEIGHT]


@kernel()
def torque_of(q: Array, count: int, contacts: Array, command: Array, device: Array) -> float:
    """The hand's work a radian of phase: the torque about the axis that the phase turns about."""
    by_q = np.empty(COORDINATES)
    elastic_energy(q, device, by_q)
    ax, ay, az = 0.0, 0.0, 1.0
    torque = 0.0
    if command[M_ABOUT_BOLT] > 0.0:
        ax, ay, az = command[M_TILT + 2], command[M_TILT + 5], command[M_TILT + 8]
    else:
        # The commanded place of the centre goes round.
        x, y = device[D_CENTRE] * device[D_ROTATION + 2], device[D_CENTRE] * device[D_ROTATION + 5]
        torque = by_q[3] * y - by_q[4] * x
    for i in range(count):
        f = contacts[i, C_FORCE]
        fx, fy, fz = f * contacts[i, C_NORMAL], f * contacts[i, C_NORMAL + 1], f * contacts[i, C_NORMAL + 2]
        px, py, pz = contacts[i, C_POINT] - q[3], contacts[i, C_POINT + 1] - q[4], contacts[i, C_POINT + 2] - q[5]
        torque -= ax * (py * fz - pz * fy) + ay * (pz * fx - px * fz) + az * (px * fy - py * fx)
    return torque


@kernel()
def set_contacts(count: int, push: float, work: Work, contacts: Array) -> int:
    """Sets the contacts that carry a force from the places of a descent's end; returns their number."""
    places, multipliers = work.places, work.multipliers
    used = 0
    for i in range(count):
        force = multipliers[i] * places[i, G_NORM]
        if force > LOADED * push and used < MAX_CONTACTS:
            contacts[used, C_PAIR] = places[i, G_PAIR]
            for j in range(3):
                contacts[used, C_POINT + j] = places[i, G_POINT + j]
                contacts[used, C_NORMAL + j] = places[i, G_NORMAL + j]
            contacts[used, C_FORCE] = force
            used += 1
    return used


@kernel()
def set_flush_contact(q: Array, push: float, device: Array, contacts: Array) -> int:
    """Sets the resultant of the pressure on the nut's surface as one contact; 1."""
    place = np.empty(PLACE_SIZE)
    set_place(q, device, place)
    x, y, force, _ = centre_of_pressure(q, push, place, device, np.zeros(3))
    contacts[0, C_PAIR] = FLUSH_PAIR
    contacts[0, C_POINT], contacts[0, C_POINT + 1], contacts[0, C_POINT + 2] = x, y, 0.0
    contacts[0, C_NORMAL], contacts[0, C_NORMAL + 1], contacts[0, C_NORMAL + 2] = 0.0, 0.0, 1.0
    contacts[0, C_FORCE] = force
    return 1


@kernel()
def changes(count: int, contacts: Array, next_count: int, next_contacts: Array, gone: Array, new: Array) -> int:
    """How many contacts have no counterpart of the same features: sets which are gone, and which are new."""
    total = 0
    for i in range(count):
        gone[i] = 1.0
    for i in range(next_count):
        best, nearest = -1, math.inf
        for j in range(count):
            if gone[j] > 0.0 and contacts[j, C_PAIR] == next_contacts[i, C_PAIR]:
                apart = 0.0
                for h in range(3):
                    apart += (contacts[j, C_POINT + h] - next_contacts[i, C_POINT + h]) ** 2
                if apart < nearest:
                    best, nearest = j, apart
        new[i] = 1.0 if best < 0 else 0.0
        total += 1 if best < 0 else 0
        if best >= 0:
            gone[best] = 0.0
    for j in range(count):
        total += 1 if gone[j] > 0.0 else 0
    return total


@kernel()
def add_event(
    kind: int, phase: float, before: float, old_pair: float, pair: float, result: Array, events: Array
) -> int:
    """Adds an event and returns its row; a full list keeps its last row for what comes later."""
    i = min(int(result[L_EVENTS]), MAX_EVENTS - 1)
    for j in range(EVENT_SIZE):
        events[i, j] = 0.0
    events[i, E_KIND], events[i, E_PHASE], events[i, E_BEFORE] = kind, phase, before
    events[i, E_OLD_PAIR], events[i, E_PAIR] = old_pair, pair
    result[L_EVENTS] = i + 1
    return i


@kernel()
def add_changes(
    phase: float,
    before: float,
    count: int,
    contacts: Array,
    next_count: int,
    next_contacts: Array,
    gone: Array,
    new: Array,
    result: Array,
    events: Array,
) -> None:
    """Adds an event for each contact that is gained or lost; one that is both, by features, has moved."""
    for i in range(next_count):
        if new[i] == 0.0:
            continue
        best, nearest = -1, math.inf
        for j in range(count):
            if gone[j] > 0.0:
                apart = 0.0
                for h in range(3):
                    apart += (contacts[j, C_POINT + h] - next_contacts[i, C_POINT + h]) ** 2
                if apart < nearest:
                    best, nearest = j, apart
        old_pair = contacts[best, C_PAIR] if best >= 0 else -1.0
        kind = MOVED if best >= 0 else GAINED
        row = add_event(kind, phase, before, old_pair, next_contacts[i, C_PAIR], result, events)
        for h in range(3):
            events[row, E_POINT + h] = next_contacts[i, C_POINT + h]
        if best >= 0:
            gone[best] = 0.0
    for j in range(count):
        if gone[j] > 0.0:
            row = add_event(LOST, phase, before, contacts[j, C_PAIR], -1.0, result, events)
            for h in range(3):
                events[row, E_POINT + h] = contacts[j, C_POINT + h]


@kernel()
def add_point(state: Array, q: Array, contacts: Array, command: Array, device: Array, leg: Leg) -> bool:
    """Adds a point to the path; False where it is full."""
    result, points, all_contacts, _ = leg
    i = int(result[L_POINTS])
    if i == MAX_POINTS:
        return False
    by_q = np.empty(COORDINATES)
    place = np.empty(PLACE_SIZE)
    energy = elastic_energy(q, device, by_q)
    set_place(q, device, place)
    count = int(state[S_COUNT])
    points[i, T_PHASE], points[i, T_KIND], points[i, T_COUNT] = state[S_PHASE], state[S_KIND], count
    points[i, T_ENERGY], points[i, T_POTENTIAL] = energy, energy + command[M_PUSH] * q[5]
    points[i, T_TORQUE] = torque_of(q, count, contacts, command, device)
    copy_numbers(q, points[i, T_COORDINATES : T_COORDINATES + COORDINATES])
    copy_numbers(place[0:12], points[i, T_POSE : T_POSE + 12])
    for j in range(count):
        copy_numbers(contacts[j], all_contacts[i, j])
    result[L_POINTS] = i + 1
    return True


@kernel()
def has_snapped(leg: Leg, bolt: Array) -> bool:
    """Whether the last points are a snap: down far enough within its span, onto a thread below the nut's top."""
    result, points, all_contacts, _ = leg
    last = int(result[L_POINTS]) - 1
    height = points[last, T_POSE + 11]
    is_below = points[last, T_KIND] == ON_STRIP
    for j in range(int(points[last, T_COUNT])):
        is_below = is_below or all_contacts[last, j, C_POINT + 2] < -BELOW_TOP * bolt[pk.R_MAJOR]
    i = last - 1
    while is_below and i >= 0 and abs(points[i, T_PHASE] - points[last, T_PHASE]) <= SNAP_SPAN * (1.0 + 1e-9):
        if points[i, T_POSE + 11] - height > SNAP_FALL * bolt[pk.P]:
            return True
        i -= 1
    return False


@kernel()
def predict(phase: float, q: Array, leg: Leg, is_smooth: bool, trial: Array) -> None:
    """Sets where a step to a phase begins: on the line through the last two points, or as the hand carries the bolt."""
    result, points, _, _ = leg
    last = int(result[L_POINTS]) - 1
    copy_numbers(q, trial)
    if is_smooth and last > 0:
        span = points[last, T_PHASE] - points[last - 1, T_PHASE]
        part = (phase - points[last, T_PHASE]) / span
        for j in range(COORDINATES):
            trial[j] += part * (points[last, T_COORDINATES + j] - points[last - 1, T_COORDINATES + j])


@kernel()
def add_fall(phase: float, before: float, q: Array, trial: Array, lost: float, device: Array, leg: Leg) -> None:
    """Adds a fall from ``q`` to ``trial``; ``lost`` is the potential lost."""
    result, _, _, events = leg
    place = np.empty(PLACE_SIZE)
    row = add_event(FALL, phase, before, -1.0, -1.0, result, events)
    set_place(q, device, place)
    x, y, z = place[N_OFFSET], place[N_OFFSET + 1], place[N_OFFSET + 2]
    set_place(trial, device, place)
    events[row, E_DROP] = z - place[N_OFFSET + 2]
    events[row, E_WAY] = math.sqrt(
        (x - place[N_OFFSET]) ** 2 + (y - place[N_OFFSET + 1]) ** 2 + (z - place[N_OFFSET + 2]) ** 2
    )
    events[row, E_LOSS] = lost
    for j in range(3):
        events[row, E_POINT + j] = place[N_CENTRE + j]


@kernel()
def potential_of(q: Array, push: float, device: Array) -> float:
    """The potential of the bolt."""
    by_q = np.empty(COORDINATES)
    return elastic_energy(q, device, by_q) + push * q[5]


@kernel()
def laid_level(
    q: Array, push: float, device: Array, strip: Array, bolt: Array, nut: Array, contacts: Array
) -> tuple[int, int]:
    """What holds a bolt that is beside a level pose in which it lies on the surface or on a strip; its contacts.

    It is moved there, in place. A level pose that is held is a minimum of the potential: the only one near by.
    """
    place = np.empty(PLACE_SIZE)
    level = np.empty(COORDINATES)
    leave = np.empty(COORDINATES)
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
    start = q.copy()
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


@kernel()
def closed_step(kind: int, q: Array, setting: Setting, contacts: Array, trial: Array) -> tuple[bool, int]:
    """The pose on the surface or the strip at a new command: whether it is held there, and its number of contacts.

    Where it is not held ``trial`` is set to the pose tipped a little in the direction in which the bolt leaves.
    """
    command, device, strip, bolt, nut, _, _ = setting
    push = command[M_PUSH]
    leave = np.empty(COORDINATES)
    place = np.empty(PLACE_SIZE)
    if kind == ON_SURFACE:
        until, direction = flush_until(push, device, bolt, nut, trial)
        if until > push:
            return True, set_flush_contact(trial, push, device, contacts)
        # The centre of pressure has left the patch: the bolt tips towards it.
        set_place(trial, device, place)
        x, y, _, _ = centre_of_pressure(trial, push, place, device, np.zeros(3))
        direction = math.atan2(y - place[N_OFFSET + 1], x - place[N_OFFSET])
        tip_over(direction, TIP, place, trial)
        return False, 0
    set_place(q, device, place)
    if not set_strip(place[N_OFFSET + 2], device, strip, bolt, trial):
        copy_numbers(q, trial)
        return False, 0
    holds, count = strip_holds(trial, push, 0.0, 0.0, device, strip, bolt, nut, contacts, leave)
    if not holds:
        for j in range(COORDINATES):
            trial[j] += TIP * leave[j]
    return holds, count


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
def minimum_near(
    size: float, left: float, held: bool, state: Array, setting: Setting, trial: Array, contacts: Array, leg: Leg
) -> tuple[int, int, int, int]:
    """The minimum near ``trial``, in place, for a step of a size (rad): what becomes of the step.

    Then how the descent ended, what holds the bolt there, and its number of contacts. ``held`` is False where the bolt
    is leaving a level pose. Where no minimum is near the next step is shorter, then longer, then a fall.
    """
    command, device, strip, bolt, nut, _, work = setting
    push = command[M_PUSH]
    begun = trial.copy()
    leg[0][L_DESCENTS] += 1
    known = int(state[S_KNOWN])
    status, found = descent_near(trial, known, NEAR_STEPS if size > ABOVE * EVENT_WIDTH else SLOW_STEPS, setting)
    state[S_KNOWN] = found if status == AT_REST else 0.0
    if held and (status == AT_REST or status == UNSETTLED):
        if status == UNSETTLED:
            copy_numbers(begun, trial)
        laid, count = laid_level(trial, push, device, strip, bolt, nut, contacts)
        if laid != ON_CONTACTS:
            state[S_KNOWN] = 0.0
            return TAKEN, AT_REST, laid, count
    if status == TOO_FAR or status == UNSETTLED:
        leg[0][L_FAILURES] += 1 if status == UNSETTLED else 0
        if size > ABOVE * LEAST_STEP and state[S_BRIDGING] == 0.0 and held:
            state[S_STEP] = max(0.25 * size, LEAST_STEP)
        elif status == UNSETTLED and size < min(BRIDGE, left):
            state[S_BRIDGING] = 1.0
            state[S_STEP] = min(4.0 * size, BRIDGE)
        else:
            state[S_FALLING] = 1.0
            state[S_STEP] = LEAST_STEP if held else EVENT_WIDTH
        return AGAIN, status, ON_CONTACTS, 0
    if status == FLUSH:
        set_flush(device, trial)
        return TAKEN, AT_REST, ON_SURFACE, set_flush_contact(trial, push, device, contacts)
    if status != AT_REST:
        return ENDED, status, ON_CONTACTS, 0
    return TAKEN, AT_REST, ON_CONTACTS, set_contacts(found, push, work, contacts)


@kernel()
def minimum_below(trial: Array, setting: Setting, contacts: Array) -> tuple[int, int, int, int]:
    """The minimum that the bolt falls to from ``trial``, in place; returns as :func:`minimum_near`."""
    command, device, _, bolt, nut, threads, work = setting
    push = command[M_PUSH]
    status, found = fall_down(trial, push, device, bolt, nut, threads, work)
    if status == FLUSH:
        set_flush(device, trial)
        return TAKEN, AT_REST, ON_SURFACE, set_flush_contact(trial, push, device, contacts)
    if status != AT_REST:
        return ENDED, status, ON_CONTACTS, 0
    return TAKEN, AT_REST, ON_CONTACTS, set_contacts(found, push, work, contacts)


@kernel()
def try_step(
    target: float, left: float, q: Array, state: Array, setting: Setting, trial: Array, contacts: Array, leg: Leg
) -> tuple[int, int, int, int]:
    """The equilibrium after a step to a phase, in ``trial``; returns as :func:`minimum_near`."""
    command, device, _, _, _, _, _ = setting
    size = abs(target - state[S_PHASE])
    kind = int(state[S_KIND])
    held = True
    set_phase(target, command, device)
    if kind != ON_CONTACTS:
        held, count = closed_step(kind, q, setting, contacts, trial)
        if held:
            return TAKEN, AT_REST, kind, count
        if size > ABOVE * EVENT_WIDTH and state[S_BRIDGING] == 0.0:
            state[S_STEP] = 0.5 * size
            return AGAIN, AT_REST, kind, 0
    elif state[S_FALLING] > 0.0:
        copy_numbers(q, trial)
    else:
        predict(target, q, leg, state[S_SMOOTH] > 0.0, trial)
    if state[S_FALLING] > 0.0:
        state[S_KNOWN] = 0.0
        return minimum_below(trial, setting, contacts)
    return minimum_near(size, left, held, state, setting, trial, contacts, leg)


@kernel()
def refused(size: float, changed: bool, lost: float, state: Array) -> bool:
    """Whether a step has to be shorter: contacts change in it, or the potential does as the torque does not explain.

    Sets the next step where it is.
    """
    if state[S_FALLING] > 0.0 or state[S_BRIDGING] > 0.0:
        return False
    if changed and size > ABOVE * EVENT_WIDTH:
        state[S_STEP] = max(0.5 * size, EVENT_WIDTH)
        return True
    if abs(lost) > ENERGY_STEP and size > ABOVE * LEAST_STEP:
        state[S_STEP] = max(0.5 * size, LEAST_STEP)
        return True
    return False


@kernel()
def add_step_events(
    target: float,
    kind: int,
    count: int,
    next_kind: int,
    next_count: int,
    bridged: bool,
    contacts: Array,
    next_contacts: Array,
    gone: Array,
    new: Array,
    before: float,
    leg: Leg,
) -> None:
    """Adds what a step to a phase changes: what holds the bolt, contacts, and whether it was bridged."""
    result, _, _, events = leg
    if kind != ON_CONTACTS and next_kind != kind:
        add_event(OFF_FLUSH if kind == ON_SURFACE else OFF_STRIP, target, before, FLUSH_PAIR, -1.0, result, events)
    if next_kind != ON_CONTACTS and next_kind != kind:
        add_event(ON_FLUSH if next_kind == ON_SURFACE else ON_FLANK, target, before, -1.0, FLUSH_PAIR, result, events)
    if next_kind == ON_CONTACTS and kind == ON_CONTACTS:
        add_changes(target, before, count, contacts, next_count, next_contacts, gone, new, result, events)
    if bridged:
        add_event(BRIDGED, target, before, -1.0, -1.0, result, events)


@kernel()
def step_on(
    end: float, q: Array, state: Array, setting: Setting, contacts: Array, next_contacts: Array, leg: Leg
) -> tuple[int, int]:
    """Takes a step towards ``end``, or says that it has to be tried again: what became of it, and how a descent ended.

    ``q``, state and contacts are those after the step where it is taken.
    """
    command, device, _, bolt, _, _, _ = setting
    result, points, _, _ = leg
    trial = np.empty(COORDINATES)
    gone, new = np.empty(MAX_CONTACTS), np.empty(MAX_CONTACTS)
    before, kind, count = state[S_PHASE], int(state[S_KIND]), int(state[S_COUNT])
    left = abs(end - before)
    size = min(state[S_STEP], left)
    target = end if size == left else before + (size if end > before else -size)
    scale = command[M_PUSH] * bolt[pk.R_MAJOR]
    verdict, status, next_kind, next_count = try_step(target, left, q, state, setting, trial, next_contacts, leg)
    if verdict != TAKEN:
        return verdict, status
    changed = changes(count, contacts, next_count, next_contacts, gone, new)
    last = int(result[L_POINTS]) - 1
    lost = points[last, T_POTENTIAL] - potential_of(trial, command[M_PUSH], device)
    next_torque = torque_of(trial, next_count, next_contacts, command, device)
    lost += 0.5 * (points[last, T_TORQUE] + next_torque) * (target - before)
    if refused(size, changed > 0 or next_kind != kind, lost / scale, state):
        return AGAIN, status
    bridged = state[S_BRIDGING] > 0.0 and state[S_FALLING] == 0.0
    fell = not bridged and lost > ENERGY_STEP * scale
    if fell:
        add_fall(target, before, q, trial, lost, device, leg)
    add_step_events(
        target, kind, count, next_kind, next_count, bridged, contacts, next_contacts, gone, new, before, leg
    )
    state[S_SMOOTH] = 1.0 if changed == 0 and not fell and next_kind == kind and kind == ON_CONTACTS else 0.0
    state[S_PHASE], state[S_KIND], state[S_COUNT] = target, next_kind, next_count
    state[S_BRIDGING], state[S_FALLING] = 0.0, 0.0
    state[S_STEP] = min(2.0 * size, command[M_LONGEST])
    copy_numbers(trial, q)
    for j in range(next_count):
        copy_numbers(next_contacts[j], contacts[j])
    return TAKEN, status


@kernel()
def begin(q: Array, kind: int, start: float, state: Array, setting: Setting, contacts: Array) -> int:
    """Sets the state of a leg and its contacts at its beginning; how the descent there ended."""
    command, device, _, _, _, _, work = setting
    trial = np.empty(COORDINATES)
    for j in range(STATE_SIZE):
        state[j] = 0.0
    state[S_PHASE], state[S_STEP], state[S_KIND] = start, min(FIRST_STEP, command[M_LONGEST]), kind
    set_phase(start, command, device)
    if kind != ON_CONTACTS:
        _, count = closed_step(kind, q, setting, contacts, trial)
        state[S_COUNT] = count
        return AT_REST
    status, found = descent_near(q, 0, LAST_STEPS, setting)
    state[S_KNOWN] = found if status == AT_REST else 0.0
    state[S_COUNT] = set_contacts(found, command[M_PUSH], work, contacts)
    return status


@kernel()
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
    state = np.empty(STATE_SIZE)
    contacts = np.empty((MAX_CONTACTS, CONTACT_SIZE))
    next_contacts = np.empty((MAX_CONTACTS, CONTACT_SIZE))
    status = begin(q, kind, start, state, setting, contacts)
    add_point(state, q, contacts, command, device, leg)
    if status != AT_REST:
        return FAILED + status, kind
    limit = TORQUE_LIMIT * command[M_PUSH] * bolt[pk.R_MAJOR]
    while state[S_PHASE] != end:
        if result[L_DESCENTS] >= MAX_DESCENTS or result[L_FAILURES] >= MAX_FAILURES:
            return FULL, int(state[S_KIND])
        verdict, status = step_on(end, q, state, setting, contacts, next_contacts, leg)
        if verdict == ENDED:
            return FAILED + status, int(state[S_KIND])
        if verdict == AGAIN:
            continue
        if not add_point(state, q, contacts, command, device, leg):
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
    place = np.empty(PLACE_SIZE)
    touching = 0
    wanted = Descent(command[M_PUSH], STEP_LENGTH * r, STEP_LENGTH * r, LAST_STEPS, END_TOLERANCE, END_OVERLAP)
    _, found = descend_followed(q, 0, wanted, Scene(device, bolt, nut, threads, work))
    for j in range(found):
        if work.places[j, G_VALUE] > -LEAST_GAP * r:
            copy_numbers(work.places[j], work.places[touching])
            touching += 1
    set_place(q, device, place)
    return overlap(place[0:12], OVERLAP_LIMIT * r, touching, work.places, bolt, nut, stage)


@kernel(nogil=True)
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
