"""Whether the contacts after a step with friction are those before it: by where they are, and followed back."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._stage_kernel import THREAD_THREAD
from threadstate.device._chart_kernel import D_SCALE
from threadstate.device._gap_kernel import G_PAIR, G_THETA, G_Z
from threadstate.device._modes_kernel import K_PAIR, K_POINT, K_THETA, K_Z
from threadstate.device._place_near_kernel import follow_place, is_one_place
from threadstate.device._step_modes_kernel import Setting

Array = NDArray[np.float64]

MOVED = 0.025
"""How far (nominal radii) a contact is at most from where it was before a step: farther away it is another one."""


@kernel(allocates=True)
def same_contacts(
    before: Array, count_before: int, contacts_before: Array, count: int, contacts: Array, setting: Setting
) -> bool:
    """Whether contacts are those before a step: as many, each with the features of one of these that is near, and of
    another one, and at the pose ``before`` at its place.

    One that another of the same features takes over from is not.
    """
    if count != count_before:
        return False
    is_taken = np.zeros(count)
    for c in range(count):
        best, nearest = -1, MOVED * setting[1][D_SCALE]
        for h in range(count):
            apart = 0.0
            for j in range(3):
                apart += (contacts[c, K_POINT + j] - contacts_before[h, K_POINT + j]) ** 2
            is_like = contacts[c, K_PAIR] == contacts_before[h, K_PAIR] and is_taken[h] == 0.0
            if is_like and math.sqrt(apart) < nearest:
                best, nearest = h, math.sqrt(apart)
        if best < 0 or not is_same_place(before, contacts_before[best], contacts[c], setting):
            return False
        is_taken[best] = 1.0
    return True


@kernel()
def is_same_place(before: Array, contact: Array, after: Array, setting: Setting) -> bool:
    """Whether a contact after a step, followed back to the pose before, is at the place of one before; also where
    either is nowhere near there.
    """
    _, device, _, bolt, nut, threads, _, work = setting
    was, now = work.places[0], work.places[1]
    if contact[K_PAIR] > THREAD_THREAD:
        return True
    was[G_PAIR], was[G_THETA], was[G_Z] = contact[K_PAIR], contact[K_THETA], contact[K_Z]
    now[G_PAIR], now[G_THETA], now[G_Z] = after[K_PAIR], after[K_THETA], after[K_Z]
    for gap in (was, now):
        if not follow_place(gap, before, device, bolt, nut, threads, work.search):
            return True
    return is_one_place(was, now, bolt)
