"""All three stages of tilted poses, one row of numbers a pose."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact import _flush_kernel as fk
from threadstate.contact import _record_kernel as rk
from threadstate.contact._geometry_kernel import TWO_PI, copy_numbers, edge_point
from threadstate.contact._lift_kernel import least_lift
from threadstate.contact._rest_kernel import rests_on_surface, start_height
from threadstate.contact._search_kernel import Search, search_address, search_at
from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    CONTACT_SIZE,
    EDGE_EDGE,
    EDGE_SURFACE,
    K_BOLT,
    K_NUT,
    K_PAIR,
    K_TIME,
    K_X,
    K_Y,
    MAX_CONTACTS,
    PROVED,
    RESOLVED,
    RIDGES,
    THREAD_EDGE,
    THREAD_THREAD,
    UNRESOLVED,
    Work,
    edges_overlap,
    new_work,
    rotation,
    turned,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# Options of a solve: limit of a turn (rad), tolerance of a tie (length), whether both outlines are convex (1 or 0),
# whether thread on thread is searched by closing rectangles (1) or along ridges (0).
S_TURN_LIMIT, S_TIE, S_CONVEX, S_PROVE = range(4)
OPTIONS_SIZE = 4

BEFORE_FLUSH = 1e-9
"""Where a turn ends flush, contacts are looked for up to this much (rad) before: there all edges meet at once."""


@kernel()
def in_plane(pair: int) -> bool:
    """Whether a contact of these features lies both in the bolt's base plane and in the nut's surface plane."""
    return pair == EDGE_EDGE or pair == EDGE_SURFACE or pair == BASE_EDGE


@kernel()
def second_axis(contact: Array, pose: Array, bolt: Array, nut: Array, out: Array) -> None:
    """The axis about which the bolt turns by a positive angle: the reverse of the method's t0."""
    pair = int(contact[K_PAIR])
    if pair == EDGE_EDGE or pair == BASE_EDGE or pair == THREAD_EDGE:
        _, _, x, y = edge_point(contact[K_NUT], nut)
        z = 0.0
    elif pair == THREAD_THREAD:
        x, y, z = -contact[K_Y], contact[K_X], bolt[pk.P] / TWO_PI
    else:
        _, _, dx, dy = edge_point(contact[K_BOLT], bolt)
        x = pose[0] * dx + pose[1] * dy
        y = pose[3] * dx + pose[4] * dy
        z = 0.0 if pair == EDGE_SURFACE else pose[6] * dx + pose[7] * dy
    n = math.sqrt(x * x + y * y + z * z)
    if contact[K_X] * y - contact[K_Y] * x > 0.0:
        n = -n
    out[0] = x / n
    out[1] = y / n
    out[2] = z / n


@kernel()
def turn_to_flush(pose: Array, axis: Array) -> float:
    """The turn about a horizontal ``axis`` in the base plane after which the base is level; negative: turning away."""
    nx, ny, nz = pose[2], pose[5], pose[8]
    return math.atan2(axis[0] * ny - axis[1] * nx, nz)


@kernel()
def lay_flush(
    stage: int, pose: Array, point: Array, axis: Array, tau: float, bolt: Array, nut: Array, extremes: Array, row: Array
) -> bool:
    """Appends the flush pose and the extreme points of its patch; False if the outlines do not overlap."""
    level = np.empty(12)
    turned(pose, point, axis, tau, level)
    # The base is level now: what differs from that is round-off.
    for i in (2, 5, 6, 7):
        level[i] = 0.0
    level[8] = 1.0
    level[11] = 0.0
    count = fk.extreme_points(level, bolt, nut, axis[0], axis[1], extremes)
    if count == 0:
        return False
    rk.put_pose(level, row)
    known = int(row[rk.O_CONTACTS])
    for i in range(count):
        x, y = extremes[i, fk.F_X], extremes[i, fk.F_Y]
        again = False
        for j in range(known):
            c = rk.O_CONTACT + rk.POINT_SIZE * j + rk.P_POINT
            if abs(row[c] - x) + abs(row[c + 1] - y) + abs(row[c + 2]) < 1e-6 * bolt[pk.R_MAJOR]:
                again = True
        if not again:
            rk.put_flush(stage, extremes[i, fk.F_THETA], extremes[i, fk.F_CORNER] > 0.0, x, y, bolt, nut, row)
    row[rk.O_FLAGS] = int(row[rk.O_FLAGS]) | rk.FLAG_FLUSH
    return True


@kernel()
def add_flag(row: Array, flag: int) -> None:
    """Sets a flag."""
    row[rk.O_FLAGS] = int(row[rk.O_FLAGS]) | flag


@kernel()
def ties(found: Array, count: int, slack: float) -> tuple[int, float]:
    """How many contacts appear together with the first, and when that one appears.

    They are put in order of azimuth on the nut, so that the earliest may not be the first any more.
    """
    n = 1
    first = found[0, K_TIME]
    while n < count and found[n, K_TIME] <= first + slack:
        n += 1
    for i in range(1, n):
        j = i
        while j > 0 and azimuth(found[j]) < azimuth(found[j - 1]):
            for m in range(CONTACT_SIZE):
                found[j, m], found[j - 1, m] = found[j - 1, m], found[j, m]
            j -= 1
    return n, first


@kernel()
def azimuth(contact: Array) -> float:
    """Azimuth on the nut in [0, 2 pi)."""
    a = math.atan2(contact[K_Y], contact[K_X])
    return a + TWO_PI if a < 0.0 else a


@kernel()
def solve_pose(
    roll: float,
    pitch: float,
    phase: float,
    options: Array,
    bolt: Array,
    nut: Array,
    search: Search,
    work: Work,
    row: Array,
) -> None:
    """Solves one tilted pose (angles in rad) into ``row``; see ``_record_kernel`` for its layout."""
    row[:] = 0.0
    for i in (rk.O_LAMBDA, rk.O_MU, rk.O_DROP, rk.O_EMBEDMENT, rk.O_PIVOT):
        row[i] = math.nan
    found = np.empty((MAX_CONTACTS, CONTACT_SIZE))
    known = np.empty((2, CONTACT_SIZE))
    extremes = np.empty((4, fk.EXTREME_SIZE))
    pose = np.empty(12)
    axis = np.zeros(3)
    point = np.zeros(3)
    slack = options[S_TIE]
    turn_slack = slack / bolt[pk.R_MAJOR]
    threads = PROVED if options[S_PROVE] > 0.0 else RIDGES

    # First stage: straight down.
    rotation(roll, pitch, phase, pose)
    pose[9] = 0.0
    pose[10] = 0.0
    high = start_height(pose, bolt)
    pose[11] = high
    axis[2] = -1.0
    together = 1
    if options[S_CONVEX] > 0.0 and rests_on_surface(pose, bolt, nut, found[0]):
        time = high - found[0, K_TIME]
    else:
        count, status, _ = search(
            pose,
            False,
            point,
            axis,
            known,
            0,
            high + bolt[pk.P],
            slack,
            bolt,
            nut,
            threads,
            work,
            found,
        )
        if status != RESOLVED or count == 0:
            row[rk.O_STATUS] = UNRESOLVED
            return
        together, time = ties(found, count, slack)
    pose[11] = high - time
    copy_numbers(found[0], known[0])
    rk.put_pose(pose, row)
    rk.put_contact(1, known[0], pose, bolt, nut, row)
    if rk.grazes(known[0], pose, bolt, nut):
        add_flag(row, rk.FLAG_GRAZING)
    if together > 1:
        add_flag(row, rk.FLAG_TIE)

    # Second stage: the turn about the tangent at the first contact.
    for i in range(3):
        point[i] = known[0, K_X + i]
    second = np.empty(12)
    tied_third = False
    if together > 1:
        row[rk.O_LAMBDA] = 0.0
        copy_numbers(found[1], known[1])
        copy_numbers(pose, second)
        for i in range(2, together):
            copy_numbers(found[i], found[i - 2])
        together -= 2
        tied_third = together > 0
    else:
        second_axis(known[0], pose, bolt, nut, axis)
        limit = options[S_TURN_LIMIT]
        flush = -1.0
        if int(known[0, K_PAIR]) == EDGE_SURFACE:
            flush = turn_to_flush(pose, axis)
            if flush <= limit:
                limit = flush - BEFORE_FLUSH
        count = 0
        # With convex outlines the bolt lies wholly on the other side of the axis and above the nut until it is flush.
        if flush < 0.0 or options[S_CONVEX] == 0.0:
            count, status, _ = search(
                pose, True, point, axis, known, 1, limit, turn_slack, bolt, nut, threads, work, found
            )
            if status != RESOLVED:
                row[rk.O_STATUS] = UNRESOLVED
                return
        if count == 0:
            if flush >= 0.0 and lay_flush(2, pose, point, axis, flush, bolt, nut, extremes, row):
                row[rk.O_LAMBDA] = flush
            else:
                add_flag(row, rk.FLAG_NO_SECOND | rk.FLAG_NO_THIRD)
            return
        together, time = ties(found, count, turn_slack)
        if together > 1:
            add_flag(row, rk.FLAG_TIE)
        row[rk.O_LAMBDA] = time
        turned(pose, point, axis, time, second)
        copy_numbers(found[0], known[1])
        for i in range(1, together):
            copy_numbers(found[i], found[i - 1])
        together -= 1
        tied_third = together > 0
    rk.put_pose(second, row)
    rk.put_contact(2, known[1], second, bolt, nut, row)
    if rk.grazes(known[1], second, bolt, nut):
        add_flag(row, rk.FLAG_GRAZING)

    # Third stage: the turn about the pivot axis, in the sense that lowers the bolt's origin.
    n = 0.0
    for i in range(3):
        axis[i] = known[1, K_X + i] - known[0, K_X + i]
        n += axis[i] * axis[i]
    n = math.sqrt(n)
    for i in range(3):
        axis[i] /= n
    ox, oy, oz = second[9] - point[0], second[10] - point[1], second[11] - point[2]
    cx = axis[1] * oz - axis[2] * oy
    cy = axis[2] * ox - axis[0] * oz
    cz = axis[0] * oy - axis[1] * ox
    row[rk.O_PIVOT] = math.sqrt(cx * cx + cy * cy + cz * cz)
    if tied_third:
        row[rk.O_MU] = 0.0
        put_third(second, 0.0, known, together, slack, bolt, nut, search, work, found, row)
        return
    if cz > 0.0:
        for i in range(3):
            axis[i] = -axis[i]
    if abs(cz) > slack:
        third_stage(second, point, axis, known, options, bolt, nut, search, work, found, extremes, row)
        return
    # Balanced: the origin lies on the axis (or over it), both senses are followed and the shorter turn is kept.
    add_flag(row, rk.FLAG_BALANCED)
    other = row.copy()
    third_stage(second, point, axis, known, options, bolt, nut, search, work, found, extremes, row)
    for i in range(3):
        axis[i] = -axis[i]
    third_stage(second, point, axis, known, options, bolt, nut, search, work, found, extremes, other)
    keep_shorter_turn(row, other)


@kernel()
def keep_shorter_turn(row: Array, other: Array) -> None:
    """Leaves in ``row`` that of two senses of the third turn which ends first; unresolved where that is not certain.

    A sense whose turn is known is compared by it, even where its embedment is unresolved: if the other one is shorter
    that does not matter.
    """
    for sense in (row, other):
        if sense[rk.O_STATUS] != RESOLVED and math.isnan(sense[rk.O_MU]):
            row[rk.O_STATUS] = UNRESOLVED
            return
    if not math.isnan(other[rk.O_MU]) and not row[rk.O_MU] <= other[rk.O_MU]:
        copy_numbers(other, row)


@kernel()
def third_stage(
    second: Array,
    point: Array,
    axis: Array,
    known: Array,
    options: Array,
    bolt: Array,
    nut: Array,
    search: Search,
    work: Work,
    found: Array,
    extremes: Array,
    row: Array,
) -> None:
    """The turn about the pivot axis up to the third contact, the drop and the embedment."""
    slack = options[S_TIE]
    turn_slack = slack / bolt[pk.R_MAJOR]
    threads = PROVED if options[S_PROVE] > 0.0 else RIDGES
    limit = options[S_TURN_LIMIT]
    flush = -1.0
    if in_plane(int(known[0, K_PAIR])) and in_plane(int(known[1, K_PAIR])):
        flush = turn_to_flush(second, axis)
        if 0.0 < flush <= limit:
            limit = flush - BEFORE_FLUSH
    count, status, _ = search(second, True, point, axis, known, 2, limit, turn_slack, bolt, nut, threads, work, found)
    if status != RESOLVED:
        row[rk.O_STATUS] = UNRESOLVED
        return
    if count == 0:
        if flush > 0.0 and lay_flush(3, second, point, axis, flush, bolt, nut, extremes, row):
            row[rk.O_MU] = flush
            row[rk.O_DROP] = second[11] - row[rk.O_POSE + 35]
            row[rk.O_EMBEDMENT] = 0.0
        else:
            add_flag(row, rk.FLAG_NO_THIRD)
        return
    third = np.empty(12)
    together, time = ties(found, count, turn_slack)
    if together > 1:
        add_flag(row, rk.FLAG_TIE)
    row[rk.O_MU] = time
    turned(second, point, axis, time, third)
    put_third(third, second[11] - third[11], known, together, slack, bolt, nut, search, work, found, row)


@kernel()
def put_third(
    third: Array,
    drop: float,
    known: Array,
    together: int,
    slack: float,
    bolt: Array,
    nut: Array,
    search: Search,
    work: Work,
    found: Array,
    row: Array,
) -> None:
    """Appends the third pose and its contacts, the first ``together`` found; sets the drop and the embedment."""
    rk.put_pose(third, row)
    contacts = np.empty((2 + together, CONTACT_SIZE))
    for i in range(2):
        copy_numbers(known[i], contacts[i])
    for i in range(together):
        copy_numbers(found[i], contacts[2 + i])
        rk.put_contact(3, found[i], third, bolt, nut, row)
        if rk.grazes(found[i], third, bolt, nut):
            add_flag(row, rk.FLAG_GRAZING)
    row[rk.O_DROP] = drop
    row[rk.O_EMBEDMENT] = 0.0
    if threads_touch(contacts) or edges_overlap(third, contacts, 2 + together, bolt, nut, work):
        lift, status = least_lift(third, slack, bolt, nut, search, work, found)
        row[rk.O_EMBEDMENT] = lift
        if status != RESOLVED:
            row[rk.O_STATUS] = UNRESOLVED


@kernel()
def threads_touch(contacts: Array) -> bool:
    """Whether thread meets thread at one of the contacts: beside it they may overlap with no edge inside."""
    for i in range(contacts.shape[0]):
        if int(contacts[i, K_PAIR]) == THREAD_THREAD:
            return True
    return False


def solve_rows(poses: Array, options: Array, bolt: Array, nut: Array, rows: Array) -> None:
    """Solves poses of shape (n, 3), roll, pitch, phase in rad, none level, into rows of shape (n, RECORD_SIZE).

    Other threads of Python go on in the meantime.
    """
    solve_with(poses, options, bolt, nut, search_address(), rows)


@kernel(nogil=True)
def solve_with(poses: Array, options: Array, bolt: Array, nut: Array, address: int, rows: Array) -> None:
    """As :func:`solve_rows`, with the search at an address."""
    search = search_at(address)
    work = new_work()
    for i in range(poses.shape[0]):
        solve_pose(poses[i, 0], poses[i, 1], poses[i, 2], options, bolt, nut, search, work, rows[i])
