"""A leg of a path without friction as the kernels keep it: the command, points, contacts and events, and the torque."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch, zeros
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.contact._stage_kernel import FLUSH as FLUSH_PAIR
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_CENTRE,
    D_PLACE,
    D_ROTATION,
    N_CENTRE,
    N_OFFSET,
    PLACE_SIZE,
    elastic_energy,
    set_place,
)
from threadstate.device._gap_kernel import G_PAIR, G_POINT, GAP_SIZE
from threadstate.device._knot_kernel import K_CONTACTS, Knot
from threadstate.device._span_kernel import SPAN_FROM, SPAN_IS, SPAN_TO, SPAN_WAS, has_moved
from threadstate.device._strip_kernel import (
    C_FORCE,
    C_NORMAL,
    C_POINT,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

DEGREE = math.pi / 180.0

SNAP_SPAN, SNAP_FALL = 3.0 * DEGREE, 0.05
"""A snap: the origin goes down by more than this part of a thread pitch within this span of phase."""

BELOW_TOP = 1e-9
"""How far below the nut's top, in nominal radii, a contact on a thread lies after a snap."""

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
UNCHANGED = -1

# A command in numbers: the rotation at phase 0 by rows, whether the phase is about the bolt, the commanded height, the
# push, the longest step of the phase (rad).
M_TILT, M_ABOUT_BOLT, M_HEIGHT, M_PUSH, M_LONGEST = 0, 9, 10, 11, 12
COMMAND_SIZE = 13

# The result of a leg: how it ended, numbers of points, of events, of descents and of those that did not end, what the
# certificate says of the end, and how often a fall's end hangs on the length of its steps, or the potential has risen
# as nothing explains.
L_STATUS, L_POINTS, L_EVENTS, L_DESCENTS, L_FAILURES, L_OVERLAP, L_UNCERTAIN = range(7)
LEG_SIZE = 7

Leg = tuple[Array, Array, Array, Array]
"""Of a leg: result, points, contacts of each point, events."""


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
def set_command_rates(command: Array, device: Array, rates: Array) -> None:
    """Sets the axis about which the command turns the bolt, and what a radian of phase moves its centre's place by."""
    for i in range(COORDINATES):
        rates[i] = 0.0
    if command[M_ABOUT_BOLT] > 0.0:
        for i in range(3):
            rates[i] = command[M_TILT + 3 * i + 2]
    else:
        # The commanded place of the centre goes round.
        rates[2] = 1.0
        rates[3] = -device[D_CENTRE] * device[D_ROTATION + 5]
        rates[4] = device[D_CENTRE] * device[D_ROTATION + 2]


@kernel()
def torque_of(q: Array, count: int, contacts: Array, command: Array, device: Array) -> float:
    """The hand's work a radian of phase: the torque about the axis that the phase turns about."""
    by_q, rates = scratch(COORDINATES), scratch(COORDINATES)
    elastic_energy(q, device, by_q)
    set_command_rates(command, device, rates)
    ax, ay, az = rates[0], rates[1], rates[2]
    torque = -(by_q[3] * rates[3] + by_q[4] * rates[4])
    for i in range(count):
        f = contacts[i, C_FORCE]
        fx, fy, fz = f * contacts[i, C_NORMAL], f * contacts[i, C_NORMAL + 1], f * contacts[i, C_NORMAL + 2]
        px, py, pz = contacts[i, C_POINT] - q[3], contacts[i, C_POINT + 1] - q[4], contacts[i, C_POINT + 2] - q[5]
        torque -= ax * (py * fz - pz * fy) + ay * (pz * fx - px * fz) + az * (px * fy - py * fx)
    return torque


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
def add_change(kind: int, phase: float, before: float, was: Array, now: Array, result: Array, events: Array) -> None:
    """Adds an event of a contact, with its places of overlap before and after: GAINED and LOST have one alone."""
    old_pair = was[G_PAIR] if kind != GAINED else -1.0
    pair = now[G_PAIR] if kind != LOST else -1.0
    row = add_event(kind, phase, before, old_pair, pair, result, events)
    at = was if kind == LOST else now
    for h in range(3):
        events[row, E_POINT + h] = at[G_POINT + h]


@kernel()
def kind_of_change(span: Array, one: Knot, other: Knot) -> int:
    """GAINED, LOST or MOVED, which a place of two points does; UNCHANGED where it carries a force at both or none."""
    if span[SPAN_WAS] != span[SPAN_IS]:
        return GAINED if span[SPAN_IS] > 0.0 else LOST
    return MOVED if span[SPAN_WAS] > 0.0 and has_moved(span, one, other) else UNCHANGED


@kernel()
def add_changes(phase: float, before: float, total: int, spans: Array, one: Knot, other: Knot, leg: Leg) -> None:
    """Adds the events of contacts between two points: of those that go on, of those gained, then of those lost."""
    result, _, _, events = leg
    none = zeros(GAP_SIZE)
    for wanted in (MOVED, GAINED, LOST):
        for k in range(total):
            kind = kind_of_change(spans[k], one, other)
            if kind == wanted:
                was = one.places[int(spans[k, SPAN_FROM])] if kind != GAINED else none
                now = other.places[int(spans[k, SPAN_TO])] if kind != LOST else none
                add_change(kind, phase, before, was, now, result, events)


@kernel()
def add_point(phase: float, kind: int, q: Array, here: Knot, command: Array, device: Array, leg: Leg) -> bool:
    """Adds a point to the path; False where it is full."""
    result, points, all_contacts, _ = leg
    i = int(result[L_POINTS])
    if i == MAX_POINTS:
        return False
    by_q = scratch(COORDINATES)
    place = scratch(PLACE_SIZE)
    energy = elastic_energy(q, device, by_q)
    set_place(q, device, place)
    count = here.numbers[K_CONTACTS]
    points[i, T_PHASE], points[i, T_KIND], points[i, T_COUNT] = phase, kind, count
    points[i, T_ENERGY], points[i, T_POTENTIAL] = energy, energy + command[M_PUSH] * q[5]
    points[i, T_TORQUE] = torque_of(q, count, here.contacts, command, device)
    copy_numbers(q, points[i, T_COORDINATES : T_COORDINATES + COORDINATES])
    copy_numbers(place[0:12], points[i, T_POSE : T_POSE + 12])
    for j in range(count):
        copy_numbers(here.contacts[j], all_contacts[i, j])
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
def add_fall(phase: float, before: float, q: Array, trial: Array, lost: float, device: Array, leg: Leg) -> None:
    """Adds a fall from ``q`` to ``trial``; ``lost`` is the potential lost."""
    result, _, _, events = leg
    place = scratch(PLACE_SIZE)
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
    by_q = scratch(COORDINATES)
    return elastic_energy(q, device, by_q) + push * q[5]


@kernel()
def add_kind_events(target: float, before: float, kind: int, next_kind: int, result: Array, events: Array) -> None:
    """Adds the events of a step in which something else comes to hold the bolt."""
    if kind != ON_CONTACTS and next_kind != kind:
        add_event(
            OFF_FLUSH if kind == ON_SURFACE else OFF_STRIP, target, before, float(FLUSH_PAIR), -1.0, result, events
        )
    if next_kind != ON_CONTACTS and next_kind != kind:
        add_event(
            ON_FLUSH if next_kind == ON_SURFACE else ON_FLANK, target, before, -1.0, float(FLUSH_PAIR), result, events
        )
