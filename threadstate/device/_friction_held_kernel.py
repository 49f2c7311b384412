"""A step of a bolt that a strip of flank or the nut's surface holds, with friction: on, onto it, and off it."""

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
    D_SCALE,
    N_OFFSET,
    PLACE_SIZE,
    elastic_energy,
    set_place,
)
from threadstate.device._flush_kernel import tip_over
from threadstate.device._friction_step_kernel import GOES_ON, ON_PATCH
from threadstate.device._gap_kernel import G_VALUE
from threadstate.device._leg_kernel import M_PUSH, ON_CONTACTS, ON_STRIP, ON_SURFACE, set_phase
from threadstate.device._modes_kernel import CONTACT_SIZE as K_SIZE
from threadstate.device._modes_kernel import (
    K_FORCE,
    K_MODE,
    K_NORMAL,
    K_PAIR,
    K_POINT,
    K_SLIP,
    MOST_CONTACTS,
    SLIPS,
    STICKS,
    set_contact,
)
from threadstate.device._places_kernel import find_places
from threadstate.device._settle_kernel import distance
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
from threadstate.device._step_modes_kernel import Setting
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
from threadstate.device._turn_kernel import TIP
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

LAID = 3e-3
"""How near (nominal radii) to the level pose on a strip a bolt is laid there: along the strip a step takes it half as
far."""

LYING_PARTS = 4
"""A step on the surface is divided into so many parts, and at the end of each the bolt has to lie there."""

BESIDE_TIP = 0.3
"""How much less deep than the deepest one, in what a bolt has been tipped by times the nominal radius, a place is on
which it tips as well."""

ENERGY_STEP = 2e-5
"""Potential, over push times nominal radius, that a step may leave unexplained: more is a fall."""


@kernel()
def strip_contacts(
    q: Array, push: float, mu: float, sense: float, setting: Setting, trial: Array, contacts: Array
) -> int:
    """Lays a bolt beside a strip on it, in ``trial``, and sets contacts whose forces balance the push; 0 if none do.

    Their slips are set to zero: those of the path are the helices' lengths.
    """
    _, device, strip, bolt, nut, _, _, _ = setting
    place = scratch(PLACE_SIZE)
    rows = scratch(STRIP_CONTACTS, STRIP_CONTACT_SIZE)
    leave = scratch(COORDINATES)
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
def slide_on_strip(
    q: Array, push: float, mu: float, turn: float, setting: Setting, contacts: Array, losses: Array
) -> int:
    """Moves a bolt that lies, or is beside lying, on a strip along it by ``turn`` (rad), in place; its contacts, or 0.

    The loss is that of forces along the helices of their radii.
    """
    bolt = setting[3]
    level = scratch(COORDINATES)
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
    level, lying, by_q = scratch(COORDINATES), zeros(LYING_SIZE), scratch(COORDINATES)
    was_level = is_level(q, device) and not falls
    stays, direction = lie_flush(push, mu, turns, before, device, bolt, nut, level, lying)
    if not stays:
        if was_level:
            place = scratch(PLACE_SIZE)
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
def lies_throughout(phase: float, turn: float, push: float, mu: float, before: Array, setting: Setting) -> bool:
    """Whether a bolt on the surface lies there in between as well, as it is turned by ``turn`` from ``phase`` (rad).

    The phase is set to that of the end.
    """
    command, device, _, bolt, nut, _, _, _ = setting
    level, lying = scratch(COORDINATES), zeros(LYING_SIZE)
    lies = True
    for part in range(1, LYING_PARTS):
        set_phase(phase + turn * part / LYING_PARTS, command, device)
        lies = lies and lie_flush(push, mu, True, before, device, bolt, nut, level, lying)[0]
    set_phase(phase + turn, command, device)
    return lies


@kernel()
def contacts_of_tip(q: Array, push: float, setting: Setting, contacts: Array) -> int:
    """Sets the contacts of a bolt that has been tipped off the surface, each with its share of the push; their number.

    They are the places that are lowest, to part of what the bolt has been tipped by; it is moved along z, in place, to
    where they touch.
    """
    _, device, _, bolt, nut, threads, _, modes_work = setting
    places, search = modes_work.places, modes_work.search
    place = scratch(PLACE_SIZE)
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
