"""All three stages of tilted poses, one record a pose."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact import _flush_kernel as fk
from threadstate.contact import _record_kernel as rk
from threadstate.contact import _refine_kernel as refine
from threadstate.contact._geometry_kernel import TWO_PI, copy_numbers, edge_point
from threadstate.contact._lift_kernel import RETRY_OFFSET, crests_overlap, least_lift
from threadstate.contact._search_kernel import Search, search_address, search_at
from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    CONTACT_SIZE,
    EDGE_EDGE,
    EDGE_SURFACE,
    K_BOLT_AZIMUTH,
    K_NUT_AZIMUTH,
    K_PAIR,
    K_TIME,
    K_X,
    K_Y,
    K_Z,
    MAX_CONTACTS,
    PROVED,
    RESOLVED,
    RIDGES,
    THREAD_EDGE,
    THREAD_SURFACE,
    THREAD_THREAD,
    UNRESOLVED,
    Work,
    edges_overlap,
    new_work,
    rotation,
    turned,
)
from threadstate.contact._surface_kernel import meets_surface_first, start_height
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# Options of a solve: limit of a turn (rad), tolerance of a tie (length), whether both outlines are convex (1 or 0),
# whether thread on thread is searched by branch and bound over rectangles (1) or along ridges (0).
S_TURN_LIMIT, S_TIE, S_CONVEX, S_PROVE = range(4)
OPTIONS_SIZE = 4

FLUSH_MARGIN = 1e-9
"""Where a turn ends flush, contacts are searched for up to this much (rad) before: there all edges meet at once."""


@kernel()
def lies_in_both_planes(pair: int) -> bool:
    """Whether a contact of these features lies both in the bolt's base plane and in the nut's surface plane."""
    return pair == EDGE_EDGE or pair == EDGE_SURFACE or pair == BASE_EDGE


@kernel()
def second_axis(contact: Array, pose: Array, bolt: Array, nut: Array, out: Array) -> None:
    """Sets the unit axis about which the bolt turns by a positive angle: the reverse of the method's t0."""
    pair = int(contact[K_PAIR])
    if pair == EDGE_EDGE or pair == BASE_EDGE or pair == THREAD_EDGE:
        _, _, x, y = edge_point(contact[K_NUT_AZIMUTH], nut)
        z = 0.0
    elif pair == THREAD_THREAD:
        x, y, z = -contact[K_Y], contact[K_X], bolt[pk.LEAD] / TWO_PI
    elif pair == THREAD_SURFACE:
        bx, by, _ = rk.in_bolt_frame(pose, contact[K_X], contact[K_Y], contact[K_Z])
        k = bolt[pk.LEAD] / TWO_PI
        x = -pose[0] * by + pose[1] * bx + pose[2] * k
        y = -pose[3] * by + pose[4] * bx + pose[5] * k
        z = 0.0
    else:
        _, _, dx, dy = edge_point(contact[K_BOLT_AZIMUTH], bolt)
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
    """The turn about a horizontal ``axis`` in the base plane after which the base is level; negative: the other way."""
    nx, ny, nz = pose[2], pose[5], pose[8]
    return math.atan2(axis[0] * ny - axis[1] * nx, nz)


@kernel()
def append_flush_pose(
    stage: int,
    pose: Array,
    point: Array,
    axis: Array,
    tau: float,
    bolt: Array,
    nut: Array,
    extremes: Array,
    record: Array,
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
    rk.append_pose(level, record)
    known = int(record[rk.O_CONTACTS])
    for i in range(count):
        x, y = extremes[i, fk.F_X], extremes[i, fk.F_Y]
        is_listed = False
        for j in range(known):
            c = rk.O_CONTACT + rk.POINT_SIZE * j + rk.P_POINT
            if abs(record[c] - x) + abs(record[c + 1] - y) + abs(record[c + 2]) < 1e-6 * bolt[pk.R_MAJOR]:
                is_listed = True
        if not is_listed:
            rk.append_flush_point(
                stage, extremes[i, fk.F_THETA], extremes[i, fk.F_CORNER] > 0.0, x, y, bolt, nut, record
            )
    record[rk.O_FLAGS] = int(record[rk.O_FLAGS]) | rk.FLAG_FLUSH
    return True


@kernel()
def add_flag(record: Array, flag: int) -> None:
    """Sets a flag."""
    record[rk.O_FLAGS] = int(record[rk.O_FLAGS]) | flag


@kernel()
def sort_simultaneous(found: Array, count: int, tie_tolerance: float) -> tuple[int, float]:
    """Sorts the contacts within a tolerance of the earliest by azimuth on the nut; their number, the earliest time.

    The earliest contact need not be the first after that.
    """
    n = 1
    first = found[0, K_TIME]
    while n < count and found[n, K_TIME] <= first + tie_tolerance:
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
    record: Array,
) -> None:
    """Solves one tilted pose (angles in rad) into ``record``; see ``_record_kernel`` for its layout."""
    record[:] = 0.0
    for i in (rk.O_LAMBDA, rk.O_MU, rk.O_DROP, rk.O_EMBEDMENT, rk.O_PIVOT):
        record[i] = math.nan
    found = np.empty((MAX_CONTACTS, CONTACT_SIZE))
    known = np.empty((2, CONTACT_SIZE))
    extremes = np.empty((4, fk.EXTREME_SIZE))
    pose = np.empty(12)
    axis = np.zeros(3)
    point = np.zeros(3)
    tie_tolerance = options[S_TIE]
    turn_tolerance = tie_tolerance / bolt[pk.R_MAJOR]
    thread_search = PROVED if options[S_PROVE] > 0.0 else RIDGES
    # Poses, axis and contacts in sums of two doubles, from one stage to the next.
    fine_start, fine_pose, fine_second = np.empty((12, 2)), np.empty((12, 2)), np.empty((12, 2))
    fine_point, fine_axis = np.zeros((3, 2)), np.zeros((3, 2))
    first, latest = np.empty((refine.REFINED_SIZE, 2)), np.empty((refine.REFINED_SIZE, 2))

    # First stage: straight down.
    rotation(roll, pitch, phase, pose)
    pose[9] = 0.0
    pose[10] = 0.0
    high = start_height(pose, bolt)
    pose[11] = high
    axis[2] = -1.0
    simultaneous = 1
    if options[S_CONVEX] > 0.0 and meets_surface_first(pose, bolt, nut, found[0]):
        pose[11] = found[0, K_TIME]
        refine.widen_numbers(pose, fine_pose)
        refine.set_unrefined(found[0], fine_pose, first)
    else:
        count, status, _ = search(
            pose,
            False,
            point,
            axis,
            known,
            0,
            high + bolt[pk.P],
            tie_tolerance,
            bolt,
            nut,
            thread_search,
            work,
            found,
        )
        if status != RESOLVED or count == 0:
            record[rk.O_STATUS] = UNRESOLVED
            return
        simultaneous, time = sort_simultaneous(found, count, tie_tolerance)
        refine.set_first_pose(roll, pitch, phase, high, fine_start)
        fine_axis[2, 0] = -1.0
        _, settles = refine.refine_contact(
            False,
            fine_start,
            fine_point,
            fine_axis,
            bolt,
            nut,
            found[0],
            time,
            simultaneous == 1,
            fine_pose,
            first,
        )
        if not settles:
            record[rk.O_STATUS] = UNRESOLVED
            return
        refine.round_numbers(fine_pose, pose)
    copy_numbers(found[0], known[0])
    rk.append_pose(pose, record)
    rk.append_contact(1, known[0], pose, bolt, nut, record)
    if rk.grazes(known[0], pose, bolt, nut):
        add_flag(record, rk.FLAG_GRAZING)
    if simultaneous > 1:
        add_flag(record, rk.FLAG_TIE)

    # Second stage: the turn about the tangent at the first contact.
    for i in range(3):
        refine.set_entry(fine_point, i, refine.entry(first, refine.F_POINT + i))
    refine.round_numbers(fine_point, point)
    second = np.empty(12)
    third_is_simultaneous = False
    if simultaneous > 1:
        record[rk.O_LAMBDA] = 0.0
        copy_numbers(found[1], known[1])
        copy_numbers(pose, second)
        fine_second = fine_pose.copy()
        refine.set_unrefined(known[1], fine_second, latest)
        for i in range(2, simultaneous):
            copy_numbers(found[i], found[i - 2])
        simultaneous -= 2
        third_is_simultaneous = simultaneous > 0
    else:
        refine.set_second_axis(int(known[0, K_PAIR]), first, fine_pose, bolt, nut, fine_axis)
        refine.round_numbers(fine_axis, axis)
        limit = options[S_TURN_LIMIT]
        flush = -1.0
        if int(known[0, K_PAIR]) == EDGE_SURFACE:
            flush = turn_to_flush(pose, axis)
            if flush <= limit:
                limit = flush - FLUSH_MARGIN
        count = 0
        # With convex outlines the bolt lies wholly on the other side of the axis and above the nut until it is flush.
        if flush < 0.0 or options[S_CONVEX] == 0.0:
            count, status, _ = search(
                pose, True, point, axis, known, 1, limit, turn_tolerance, bolt, nut, thread_search, work, found
            )
            if status != RESOLVED:
                record[rk.O_STATUS] = UNRESOLVED
                return
        if count == 0:
            if flush >= 0.0 and append_flush_pose(2, pose, point, axis, flush, bolt, nut, extremes, record):
                record[rk.O_LAMBDA] = flush
            else:
                add_flag(record, rk.FLAG_NO_SECOND | rk.FLAG_NO_THIRD)
            return
        simultaneous, time = sort_simultaneous(found, count, turn_tolerance)
        if simultaneous > 1:
            add_flag(record, rk.FLAG_TIE)
        record[rk.O_LAMBDA], settles = refine.refine_contact(
            True,
            fine_pose,
            fine_point,
            fine_axis,
            bolt,
            nut,
            found[0],
            time,
            simultaneous == 1,
            fine_second,
            latest,
        )
        if not settles:
            record[rk.O_STATUS] = UNRESOLVED
            return
        refine.round_numbers(fine_second, second)
        copy_numbers(found[0], known[1])
        for i in range(1, simultaneous):
            copy_numbers(found[i], found[i - 1])
        simultaneous -= 1
        third_is_simultaneous = simultaneous > 0
    rk.append_pose(second, record)
    rk.append_contact(2, known[1], second, bolt, nut, record)
    if rk.grazes(known[1], second, bolt, nut):
        add_flag(record, rk.FLAG_GRAZING)

    # Third stage: the turn about the pivot axis, in the sense that lowers the bolt's origin.
    refine.set_pivot_axis(first, latest, fine_axis)
    refine.round_numbers(fine_axis, axis)
    ox, oy, oz = second[9] - point[0], second[10] - point[1], second[11] - point[2]
    cx = axis[1] * oz - axis[2] * oy
    cy = axis[2] * ox - axis[0] * oz
    cz = axis[0] * oy - axis[1] * ox
    record[rk.O_PIVOT] = math.sqrt(cx * cx + cy * cy + cz * cz)
    if third_is_simultaneous:
        record[rk.O_MU] = 0.0
        append_third_pose(second, 0.0, known, simultaneous, tie_tolerance, bolt, nut, search, work, found, record)
        return
    if cz > 0.0:
        refine.reverse(fine_axis)
    if abs(cz) > tie_tolerance:
        third_stage(
            fine_second, fine_point, fine_axis, known, options, bolt, nut, search, work, found, extremes, record
        )
        return
    # Balanced: the origin lies on the axis (or over it), both senses are followed and the shorter turn is chosen.
    add_flag(record, rk.FLAG_BALANCED)
    other_record = record.copy()
    third_stage(fine_second, fine_point, fine_axis, known, options, bolt, nut, search, work, found, extremes, record)
    refine.reverse(fine_axis)
    third_stage(
        fine_second, fine_point, fine_axis, known, options, bolt, nut, search, work, found, extremes, other_record
    )
    choose_shorter_turn(record, other_record)


@kernel()
def choose_shorter_turn(record: Array, other_record: Array) -> None:
    """Copies into ``record`` the sense of the third turn that ends first; unresolved where that is not certain.

    A sense whose turn is known is compared by it, even where its embedment is unresolved: if the other one is shorter
    that does not matter.
    """
    for sense in (record, other_record):
        if sense[rk.O_STATUS] != RESOLVED and math.isnan(sense[rk.O_MU]):
            record[rk.O_STATUS] = UNRESOLVED
            return
    if not math.isnan(other_record[rk.O_MU]) and not record[rk.O_MU] <= other_record[rk.O_MU]:
        copy_numbers(other_record, record)


@kernel()
def third_stage(
    fine_second: Array,
    fine_point: Array,
    fine_axis: Array,
    known: Array,
    options: Array,
    bolt: Array,
    nut: Array,
    search: Search,
    work: Work,
    found: Array,
    extremes: Array,
    record: Array,
) -> None:
    """The turn about the pivot axis up to the third contact, the drop and the embedment.

    Pose, point and axis are sums of two doubles (``_refine_kernel``).
    """
    second, point, axis = np.empty(12), np.empty(3), np.empty(3)
    refine.round_numbers(fine_second, second)
    refine.round_numbers(fine_point, point)
    refine.round_numbers(fine_axis, axis)
    tie_tolerance = options[S_TIE]
    turn_tolerance = tie_tolerance / bolt[pk.R_MAJOR]
    thread_search = PROVED if options[S_PROVE] > 0.0 else RIDGES
    limit = options[S_TURN_LIMIT]
    flush = -1.0
    if lies_in_both_planes(int(known[0, K_PAIR])) and lies_in_both_planes(int(known[1, K_PAIR])):
        flush = turn_to_flush(second, axis)
        if 0.0 < flush <= limit:
            limit = flush - FLUSH_MARGIN
    count, status, _ = search(
        second, True, point, axis, known, 2, limit, turn_tolerance, bolt, nut, thread_search, work, found
    )
    if status != RESOLVED:
        record[rk.O_STATUS] = UNRESOLVED
        return
    if count == 0:
        if flush > 0.0 and append_flush_pose(3, second, point, axis, flush, bolt, nut, extremes, record):
            record[rk.O_MU] = flush
            record[rk.O_DROP] = second[11] - record[rk.O_POSE + 35]
            record[rk.O_EMBEDMENT] = 0.0
        else:
            add_flag(record, rk.FLAG_NO_THIRD)
        return
    third = np.empty(12)
    simultaneous, time = sort_simultaneous(found, count, turn_tolerance)
    if simultaneous > 1:
        add_flag(record, rk.FLAG_TIE)
    fine_third, latest = np.empty((12, 2)), np.empty((refine.REFINED_SIZE, 2))
    record[rk.O_MU], settles = refine.refine_contact(
        True,
        fine_second,
        fine_point,
        fine_axis,
        bolt,
        nut,
        found[0],
        time,
        simultaneous == 1,
        fine_third,
        latest,
    )
    if not settles:
        record[rk.O_STATUS] = UNRESOLVED
        return
    refine.round_numbers(fine_third, third)
    append_third_pose(
        third, second[11] - third[11], known, simultaneous, tie_tolerance, bolt, nut, search, work, found, record
    )


@kernel()
def append_third_pose(
    third: Array,
    drop: float,
    known: Array,
    simultaneous: int,
    tie_tolerance: float,
    bolt: Array,
    nut: Array,
    search: Search,
    work: Work,
    found: Array,
    record: Array,
) -> None:
    """Appends the third pose and its contacts, the first ``simultaneous`` found; sets the drop and the embedment."""
    rk.append_pose(third, record)
    contacts = np.empty((2 + simultaneous, CONTACT_SIZE))
    for i in range(2):
        copy_numbers(known[i], contacts[i])
    for i in range(simultaneous):
        copy_numbers(found[i], contacts[2 + i])
        rk.append_contact(3, found[i], third, bolt, nut, record)
        if rk.grazes(found[i], third, bolt, nut):
            add_flag(record, rk.FLAG_GRAZING)
    record[rk.O_DROP] = drop
    record[rk.O_EMBEDMENT] = 0.0
    if (
        threads_touch(contacts)
        or edges_overlap(third, contacts, 2 + simultaneous, bolt, nut, work)
        or crests_overlap(third, RETRY_OFFSET * bolt[pk.P], bolt, nut, work)
    ):
        lift, status = least_lift(third, tie_tolerance, bolt, nut, search, work, found)
        record[rk.O_EMBEDMENT] = lift
        if status != RESOLVED:
            record[rk.O_STATUS] = UNRESOLVED


@kernel()
def threads_touch(contacts: Array) -> bool:
    """Whether thread meets thread at one of the contacts: beside it they may overlap with no edge inside."""
    for i in range(contacts.shape[0]):
        if int(contacts[i, K_PAIR]) == THREAD_THREAD:
            return True
    return False


def solve_rows(poses: Array, options: Array, bolt: Array, nut: Array, rows: Array) -> None:
    """Solves poses of shape (n, 3), roll, pitch, phase in rad, none level, into rows of shape (n, RECORD_SIZE).

    The global interpreter lock is released meanwhile.
    """
    solve_with(poses, options, bolt, nut, search_address(), rows)


@kernel(nogil=True)
def solve_with(poses: Array, options: Array, bolt: Array, nut: Array, address: int, rows: Array) -> None:
    """As :func:`solve_rows`, with the address of the compiled search."""
    search = search_at(address)
    work = new_work()
    for i in range(poses.shape[0]):
        solve_pose(poses[i, 0], poses[i, 1], poses[i, 2], options, bolt, nut, search, work, rows[i])
