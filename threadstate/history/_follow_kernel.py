"""A pose solved from guesses in place of a search: contacts that another pose near it has.

Each guess is solved for on its own equations (``_guess_kernel``). Of those of a stage the earliest counts, and
the next stage follows from it, as in a whole solve. A contact of which there is no guess is not known here.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact import _record_kernel as rk
from threadstate.contact._flush_kernel import EXTREME_SIZE
from threadstate.contact._guess_kernel import Work, earliest_guess
from threadstate.contact._solve_kernel import (
    FLUSH_MARGIN,
    add_flag,
    append_flush_pose,
    append_stage,
    clear_record,
    lies_in_both_planes,
    second_axis,
    turn_to_flush,
)
from threadstate.contact._stage_kernel import (
    CONTACT_SIZE,
    EDGE_SURFACE,
    K_PAIR,
    K_TIME,
    K_X,
    K_Y,
    K_Z,
    rotation,
    turned,
)
from threadstate.contact._surface_kernel import start_height
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]


@kernel()
def follow_pose(
    roll: float,
    pitch: float,
    phase: float,
    turn_limit: float,
    guesses: Array,
    bolt: Array,
    nut: Array,
    work: Work,
    record: Array,
) -> bool:
    """The record of a pose (angles in rad) whose contacts are near guesses; False where the first one is not.

    The three stages of a whole solve. Ties, balanced poses and embedments are left out.
    """
    clear_record(record)
    pose, second, third = scratch(12), scratch(12), scratch(12)
    known, extremes = scratch(3, CONTACT_SIZE), scratch(4, EXTREME_SIZE)
    point, axis = scratch(3), scratch(3)

    rotation(roll, pitch, phase, pose)
    pose[9] = 0.0
    pose[10] = 0.0
    pose[11] = start_height(pose, bolt)
    for i in range(3):
        point[i], axis[i] = 0.0, 0.0
    axis[2] = -1.0
    if not earliest_guess(1, pose, point, axis, known, pose[11] + bolt[pk.P], guesses, bolt, nut, work, known[0]):
        return False
    pose[11] -= known[0, K_TIME]
    append_stage(1, known[0], pose, bolt, nut, record)

    for i in range(3):
        point[i] = known[0, K_X + i]
    second_axis(known[0], pose, bolt, nut, axis)
    limit, flush = turn_limit, -1.0
    if int(known[0, K_PAIR]) == EDGE_SURFACE:
        flush = turn_to_flush(pose, axis)
        if flush <= limit:
            limit = flush - FLUSH_MARGIN
    if not earliest_guess(2, pose, point, axis, known, limit, guesses, bolt, nut, work, known[1]):
        if flush >= 0.0 and append_flush_pose(2, pose, point, axis, flush, bolt, nut, extremes, record):
            record[rk.O_LAMBDA] = flush
        else:
            add_flag(record, rk.FLAG_NO_SECOND | rk.FLAG_NO_THIRD)
        return True
    record[rk.O_LAMBDA] = known[1, K_TIME]
    turned(pose, point, axis, known[1, K_TIME], second)
    append_stage(2, known[1], second, bolt, nut, record)

    record[rk.O_PIVOT] = set_pivot_axis(known, second, axis)
    limit, flush = turn_limit, -1.0
    if lies_in_both_planes(int(known[0, K_PAIR])) and lies_in_both_planes(int(known[1, K_PAIR])):
        flush = turn_to_flush(second, axis)
        if 0.0 < flush <= limit:
            limit = flush - FLUSH_MARGIN
    if not earliest_guess(3, second, point, axis, known, limit, guesses, bolt, nut, work, known[2]):
        if flush > 0.0 and append_flush_pose(3, second, point, axis, flush, bolt, nut, extremes, record):
            record[rk.O_MU] = flush
        else:
            add_flag(record, rk.FLAG_NO_THIRD)
        return True
    record[rk.O_MU] = known[2, K_TIME]
    turned(second, point, axis, known[2, K_TIME], third)
    append_stage(3, known[2], third, bolt, nut, record)
    record[rk.O_DROP] = second[11] - third[11]
    return True


@kernel()
def set_pivot_axis(known: Array, second: Array, axis: Array) -> float:
    """Sets the unit pivot axis in the sense that lowers the bolt's origin; returns the origin's distance from it."""
    n = 0.0
    for i in range(3):
        axis[i] = known[1, K_X + i] - known[0, K_X + i]
        n += axis[i] * axis[i]
    n = math.sqrt(n)
    for i in range(3):
        axis[i] /= n
    x, y, z = second[9] - known[0, K_X], second[10] - known[0, K_Y], second[11] - known[0, K_Z]
    cx, cy, cz = axis[1] * z - axis[2] * y, axis[2] * x - axis[0] * z, axis[0] * y - axis[1] * x
    if cz > 0.0:
        for i in range(3):
            axis[i] = -axis[i]
    return math.sqrt(cx * cx + cy * cy + cz * cz)
