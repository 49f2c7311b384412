"""The search of one stage: the earliest contacts of a motion (method, section 4)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact import _rectangle_kernel as rect
from threadstate.contact import _ridge_kernel as ridge
from threadstate.contact import _tangency_kernel as tk
from threadstate.contact import _thread_surface_kernel as ts
from threadstate.contact._beside_kernel import K_TANGENT, KEPT_ROWS, KEPT_SIZE, MOST_KEPT, keep, place_kept
from threadstate.contact._box_kernel import BOXES_SIZE, ONE_EDGE, ONE_PLANE
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._edge_search_kernel import (
    AZIMUTH_TOLERANCE,
    E_DOUBTFUL,
    E_NONE_BEFORE,
    E_TIME,
    ENTRY_SIZE,
    MAX_ENTRIES,
    MAX_REGIONS,
    OUTSIDE,
    OVERFLOW,
    EdgeSearch,
    find_inside,
    search_edge,
)
from threadstate.contact._geometry_kernel import (
    MOTION_SIZE,
    PATH_SIZE,
    TWO_PI,
    copy_numbers,
    edge_point,
    motion_scale,
    place_by_time,
)
from threadstate.contact._onset_kernel import (
    C_KIND,
    C_OTHER_THETA,
    C_THETA,
    C_TIME,
    C_X,
    C_Y,
    C_Z,
    CANDIDATE_SIZE,
    JET_SIZE,
    MAX_CANDIDATES,
)
from threadstate.contact._queue_kernel import Queue, new_queue
from threadstate.contact._refined_edge_kernel import is_refined, set_refined_motions
from threadstate.contact._wedge_kernel import WEDGE_SIZE
from threadstate.contact._wide_kernel import WIDE_MOTION_SIZE, widen_motion
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]


class Work(NamedTuple):
    """The scratch arrays of one thread of work.

    Attributes:
        boxes: a list of boxes.
        scratch: another one.
        queue: undecided boxes.
        regions: boxes about onsets that are found, and how many boxes were evaluated (``EdgeSearch``).
        bolt_found: candidates on the bolt's edge.
        nut_found: candidates on the nut's edge.
        bolt_motion: motion of the bolt in the nut's frame.
        nut_motion: motion of the nut in the bolt's frame.
        rectangles: rectangles of the bolt's thread.
        tangencies: contacts of thread with thread.
        on_surface: contacts of the bolt's thread with the surface.
        entries: where edges enter open overlaps.
        jet: an onset's jet.
        wedge: the wedge of a crossing.
    """

    boxes: Array
    scratch: Array
    queue: Queue
    regions: Array
    bolt_found: Array
    nut_found: Array
    bolt_motion: Array
    nut_motion: Array
    rectangles: Array
    tangencies: Array
    on_surface: Array
    entries: Array
    jet: Array
    wedge: Array


class Stage(NamedTuple):
    """A motion of the bolt: a turn, or a translation.

    Attributes:
        pose: where it begins: a rotation by rows, and a translation.
        is_turn: whether it is a turn.
        point: on the axis of a turn.
        axis: of a turn, or the direction of a translation.
        exact: the motion in sums of two doubles (``_wide_kernel.set_motion``), of which pose, point and axis are the
            nearest doubles; no rows: these are meant.
        known: in its first rows the contacts through which the axis of a turn runs: they are not found again.
        known_count: how many they are.
    """

    pose: Array
    is_turn: bool
    point: Array
    axis: Array
    exact: Array
    known: Array
    known_count: int


class Wanted(NamedTuple):
    """What is to be found of a motion.

    Attributes:
        limit: how long it is at most.
        tie_tolerance: how long after the earliest contact others are listed, too.
        thread_search: how thread on thread is searched: RIDGES (PROVED where no edge explains the earliest entry),
            PROVED or RIDGES_ONLY.
    """

    limit: float
    tie_tolerance: float
    thread_search: int


# Pairs of features, in the order of ``FeaturePair``.
EDGE_EDGE, EDGE_SURFACE, BASE_EDGE, EDGE_THREAD, THREAD_EDGE, THREAD_THREAD, THREAD_SURFACE, FLUSH = range(8)

# A contact of a stage: time, pair, azimuth on the bolt, azimuth on the nut, point in the nut's frame.
K_TIME, K_PAIR, K_BOLT_AZIMUTH, K_NUT_AZIMUTH, K_X, K_Y, K_Z = range(7)
CONTACT_SIZE = 7
MAX_CONTACTS = MOST_KEPT - 2
"""Most contacts of a stage: with two from before they are those of the third pose, which all are kept."""

RESOLVED, UNRESOLVED = range(2)

RIDGES, PROVED, RIDGES_ONLY = range(3)

RIDGE_AZIMUTHS = 32

FIRST_SPAN_TURN = math.radians(2.0)
FIRST_SPAN_HEIGHT = 0.1
SPAN_GROWTH = 1.25
"""A motion is searched in spans of time: the first (rad, thread pitches), and the factor to each next one."""

TIE_SHARES = (1e-3, 1e-6)
"""Of a turn whose contacts within the tolerance of a tie are too many to be listed, or to be searched for: contacts
within this share of it are a tie where refined edges tell them apart, else within the next one. Of bolts that are all
but level all turns are as short as the tolerance."""

SPAN_REDUCTION = 0.25
SHORTEST_SPAN = 1e-14
"""Factor by which a span with too many boxes is shortened, and the shortest one (in units of ``motion_scale``)."""

TOUCH_DEPTH = 1e-10
"""Depth (thread pitches) up to which an edge counts as touching."""

LEAST_HALF_WIDTH = 1e-7
"""Half-width (rad) of an overlap that is not distinguished from a contact."""

SAME_TANGENCY = 1e-4
"""How near (thread pitches) a contact of thread with thread is to an earlier one that is the same."""


@kernel()
def rotation(roll: float, pitch: float, phase: float, out: Array) -> None:
    """``Rz(phase) Ry(pitch) Rx(roll)``, angles in rad, by rows."""
    ca, sa = math.cos(roll), math.sin(roll)
    cb, sb = math.cos(pitch), math.sin(pitch)
    cc, sc = math.cos(phase), math.sin(phase)
    out[0] = cc * cb
    out[1] = cc * sb * sa - sc * ca
    out[2] = cc * sb * ca + sc * sa
    out[3] = sc * cb
    out[4] = sc * sb * sa + cc * ca
    out[5] = sc * sb * ca - cc * sa
    out[6] = -sb
    out[7] = cb * sa
    out[8] = cb * ca


@kernel()
def turned(pose: Array, point: Array, axis: Array, tau: float, out: Array) -> None:
    """``pose`` (rotation by rows, translation) turned by ``tau`` about the axis through ``point``."""
    c = math.cos(tau)
    s = math.sin(tau)
    v = 1.0 - c
    if tau < 0.5:
        h = math.sin(0.5 * tau)
        v = 2.0 * h * h
    x, y, z = axis[0], axis[1], axis[2]
    m00, m01, m02 = c + x * x * v, x * y * v - z * s, x * z * v + y * s
    m10, m11, m12 = y * x * v + z * s, c + y * y * v, y * z * v - x * s
    m20, m21, m22 = z * x * v - y * s, z * y * v + x * s, c + z * z * v
    for j in range(3):
        a, b, d = pose[j], pose[3 + j], pose[6 + j]
        out[j] = m00 * a + m01 * b + m02 * d
        out[3 + j] = m10 * a + m11 * b + m12 * d
        out[6 + j] = m20 * a + m21 * b + m22 * d
    a, b, d = pose[9] - point[0], pose[10] - point[1], pose[11] - point[2]
    out[9] = point[0] + m00 * a + m01 * b + m02 * d
    out[10] = point[1] + m10 * a + m11 * b + m12 * d
    out[11] = point[2] + m20 * a + m21 * b + m22 * d


@kernel()
def set_motions(
    pose: Array, is_turn: bool, coplanar: bool, point: Array, axis: Array, bolt_motion: Array, nut_motion: Array
) -> None:
    """Sets the motion of the bolt's edge in the nut's frame, and that of the nut's edge in the bolt's frame."""
    for i in range(12):
        bolt_motion[i] = pose[i]
    bolt_motion[12] = 1.0 if is_turn else 0.0
    for i in range(3):
        bolt_motion[13 + i] = point[i]
        bolt_motion[16 + i] = axis[i]
    bolt_motion[19] = 1.0
    bolt_motion[20] = 1.0 if coplanar else 0.0
    bolt_motion[21] = nut_motion[21] = 0.0
    nut_motion[12] = bolt_motion[12]
    nut_motion[19] = -1.0
    nut_motion[20] = bolt_motion[20]
    for i in range(3):
        for j in range(3):
            nut_motion[3 * i + j] = pose[3 * j + i]
        nut_motion[9 + i] = -(pose[i] * pose[9] + pose[3 + i] * pose[10] + pose[6 + i] * pose[11])
        nut_motion[13 + i] = (
            pose[i] * (point[0] - pose[9]) + pose[3 + i] * (point[1] - pose[10]) + pose[6 + i] * (point[2] - pose[11])
        )
        nut_motion[16 + i] = -(pose[i] * axis[0] + pose[3 + i] * axis[1] + pose[6 + i] * axis[2])


class Contact(NamedTuple):
    """A contact of a stage: time, pair of features, azimuths on the bolt and on the nut, point in the nut's frame."""

    time: float
    pair: int
    bolt_azimuth: float
    nut_azimuth: float
    x: float
    y: float
    z: float


@kernel()
def insert_contact(one: Contact, count: int, out: Array) -> int:
    """Inserts a contact by time unless it is listed already (found from the other edge); returns the number listed.

    A full list drops the latest.
    """
    near = AZIMUTH_TOLERANCE * (abs(one.x) + abs(one.y))
    for i in range(count):
        if abs(out[i, K_X] - one.x) + abs(out[i, K_Y] - one.y) + abs(out[i, K_Z] - one.z) < near:
            return count
    i, listed = place_by_time(one.time, count, out)
    if i < 0:
        return listed
    out[i, K_TIME], out[i, K_PAIR] = one.time, one.pair
    out[i, K_BOLT_AZIMUTH], out[i, K_NUT_AZIMUTH] = one.bolt_azimuth, one.nut_azimuth
    out[i, K_X], out[i, K_Y], out[i, K_Z] = one.x, one.y, one.z
    return listed


@kernel()
def may_be_truncated(listed: Array, count: int, until: float) -> bool:
    """Whether a list sorted by time, its first column, is full up to ``until``, so that some may have been dropped."""
    return count == listed.shape[0] and listed[count - 1, 0] <= until


@kernel(allocates=True)
def new_work() -> Work:
    """The scratch arrays of one thread of work."""
    return Work(
        np.empty(BOXES_SIZE),
        np.empty(BOXES_SIZE),
        new_queue(),
        np.zeros((1 + MAX_REGIONS, 4)),
        np.empty((MAX_CANDIDATES, CANDIDATE_SIZE)),
        np.empty((MAX_CANDIDATES, CANDIDATE_SIZE)),
        np.empty(MOTION_SIZE),
        np.empty(MOTION_SIZE),
        np.empty((rect.MAX_RECTANGLES, rect.RECTANGLE_SIZE)),
        np.empty((tk.MAX_TANGENCIES, tk.TANGENCY_SIZE)),
        np.empty((ts.MAX_FOUND, tk.TANGENCY_SIZE)),
        np.zeros((1 + MAX_ENTRIES, ENTRY_SIZE)),
        np.empty(JET_SIZE),
        np.empty(WEDGE_SIZE),
    )


@kernel()
def on_bolt_edge(contact: Array, pose: Array, bolt: Array) -> bool:
    """Whether a contact of the bolt's thread or base is on the bolt's edge, too, within ``AZIMUTH_TOLERANCE``."""
    near = AZIMUTH_TOLERANCE * bolt[pk.R_MAJOR]
    x, y, z = contact[K_X] - pose[9], contact[K_Y] - pose[10], contact[K_Z] - pose[11]
    if int(contact[K_PAIR]) != BASE_EDGE:
        return abs(pose[2] * x + pose[5] * y + pose[8] * z) < near
    r = math.hypot(pose[0] * x + pose[3] * y + pose[6] * z, pose[1] * x + pose[4] * y + pose[7] * z)
    return abs(r - pk.radius(-bolt[pk.LEAD] / TWO_PI * contact[K_BOLT_AZIMUTH], bolt)) < near


@kernel()
def on_nut_edge(contact: Array, nut: Array) -> bool:
    """Whether a contact of the nut's thread or surface is on the nut's edge, too, within ``AZIMUTH_TOLERANCE``."""
    near = AZIMUTH_TOLERANCE * nut[pk.R_MAJOR]
    pair = int(contact[K_PAIR])
    if pair != EDGE_SURFACE and pair != THREAD_SURFACE:
        return abs(contact[K_Z]) < near
    r = math.hypot(contact[K_X], contact[K_Y])
    return abs(r - pk.radius(-nut[pk.LEAD] / TWO_PI * contact[K_NUT_AZIMUTH], nut)) < near


@kernel()
def keep_contacts(known: Array, known_count: int, pose: Array, bolt_edge: Edge, nut_edge: Edge) -> None:
    """Sets the lists of contacts of the bolt's and of the nut's edge (``_beside_kernel``) at the start of their motion.

    Where a contact changes from a part's edge to its thread or its flat face it is on both within the tolerance: the
    edge there must not count as another contact.
    """
    bolt, nut, bolt_kept, nut_kept = bolt_edge.curve, nut_edge.curve, bolt_edge.kept, nut_edge.kept
    bolt_kept[0, 0], nut_kept[0, 0] = 0.0, 0.0
    bolt_kept[0, K_TANGENT] = nut_kept[0, K_TANGENT] = 1.0 if known_count == 1 else 0.0
    for i in range(known_count):
        pair = int(known[i, K_PAIR])
        if pair == EDGE_EDGE or pair == EDGE_SURFACE or pair == EDGE_THREAD:
            keep(known[i, K_BOLT_AZIMUTH], pair != EDGE_THREAD, pair != EDGE_SURFACE, bolt_kept)
        elif on_bolt_edge(known[i], pose, bolt):
            keep(known[i, K_BOLT_AZIMUTH], False, False, bolt_kept)
        if pair == EDGE_EDGE or pair == BASE_EDGE or pair == THREAD_EDGE:
            keep(known[i, K_NUT_AZIMUTH], pair != THREAD_EDGE, pair != BASE_EDGE, nut_kept)
        elif on_nut_edge(known[i], nut):
            keep(known[i, K_NUT_AZIMUTH], False, False, nut_kept)
    place_kept(bolt_edge)
    place_kept(nut_edge)


@kernel()
def axis_in_both_planes(known: Array, known_count: int) -> bool:
    """Whether the axis of a turn through contacts lies in the bolt's base plane and the nut's surface plane."""
    if known_count == 1:
        return int(known[0, K_PAIR]) == EDGE_SURFACE
    for i in range(known_count):
        pair = int(known[i, K_PAIR])
        if not (pair == EDGE_EDGE or pair == EDGE_SURFACE or pair == BASE_EDGE):
            return False
    return known_count > 0


@kernel()
def may_share(best: float, tie_tolerance: float) -> bool:
    """Whether a turn up to its earliest contact is so short that contacts within a smaller share of it can tie."""
    return 2.0 * TIE_SHARES[-1] * best < tie_tolerance


@kernel()
def search_both_edges(
    since: float,
    limit: float,
    span: float,
    is_turn: bool,
    bolt_edge: Edge,
    nut_edge: Edge,
    search: EdgeSearch,
    work: Work,
) -> tuple[int, int, float, float, int]:
    """The onsets of both edges from ``since`` on, in spans of time that grow, the first one of that length.

    Returns the number of candidates of the bolt's and of the nut's edge, the earliest time, the time before which
    nothing is undecided, and a status. A search in doubles ends where boxes become too many: round-off hides what is
    there.
    """
    bolt_count, nut_count, best = 0, 0, limit
    while since < best:
        until = min(since + span, limit)
        bolt_count, bolt_evaluated, best, bolt_closed = search_edge(
            since, until, best, bolt_edge, search, bolt_count, work.bolt_found
        )
        nut_count, nut_evaluated, best, nut_closed = search_edge(
            since, until, best, nut_edge, search, nut_count, work.nut_found
        )
        closed = min(bolt_closed, nut_closed)
        if bolt_evaluated == OVERFLOW or nut_evaluated == OVERFLOW:
            # What is undecided from the earliest contact on may still begin with it.
            if closed >= best and is_turn and is_refined(bolt_edge) and may_share(best, search.tie_tolerance):
                return bolt_count, nut_count, best, since, UNRESOLVED
            since = closed if closed < best else since
            span *= SPAN_REDUCTION
            shortest = SHORTEST_SPAN * motion_scale(bolt_edge.motion, bolt_edge.curve)
            if not is_refined(bolt_edge) or span < shortest:
                return bolt_count, nut_count, best, since, UNRESOLVED
            continue
        since = closed
        span *= SPAN_GROWTH
    return bolt_count, nut_count, best, since, RESOLVED


@kernel()
def list_edge_contacts(bolt_count: int, nut_count: int, nut: Array, work: Work, out: Array) -> int:
    """Lists the contacts of both edges in ``out``; returns their number."""
    count = 0
    for i in range(bolt_count):
        one = work.bolt_found[i]
        kind = int(one[C_KIND])
        pair = EDGE_EDGE if kind == ONE_EDGE else (EDGE_SURFACE if kind == ONE_PLANE else EDGE_THREAD)
        contact = Contact(one[C_TIME], pair, one[C_THETA], one[C_OTHER_THETA], one[C_X], one[C_Y], one[C_Z])
        count = insert_contact(contact, count, out)
    for i in range(nut_count):
        one = work.nut_found[i]
        kind = int(one[C_KIND])
        pair = EDGE_EDGE if kind == ONE_EDGE else (BASE_EDGE if kind == ONE_PLANE else THREAD_EDGE)
        x, y, _, _ = edge_point(one[C_THETA], nut)
        contact = Contact(one[C_TIME], pair, one[C_OTHER_THETA], one[C_THETA], x, y, 0.0)
        count = insert_contact(contact, count, out)
    return count


@kernel()
def is_known(tangency: Array, stage: Stage, motion: Array, bolt: Array, nut: Array) -> bool:
    """Whether a contact of thread with thread is one of those through which the axis runs."""
    for i in range(stage.known_count):
        x, y, z = stage.known[i, K_X], stage.known[i, K_Y], stage.known[i, K_Z]
        off = abs(tangency[tk.T_X] - x) + abs(tangency[tk.T_Y] - y) + abs(tangency[tk.T_POINT_Z] - z)
        if off < SAME_TANGENCY * bolt[pk.P] or tk.is_one_with(tangency, x, y, z, motion, bolt, nut):
            return True
    return False


@kernel()
def list_thread_contacts(
    tangency_count: int,
    on_surface_count: int,
    stage: Stage,
    bolt: Array,
    nut: Array,
    work: Work,
    count: int,
    out: Array,
) -> int:
    """Adds the contacts of threads to those found, without the known ones; returns how many there are then."""
    tangencies, on_surface = work.tangencies, work.on_surface
    for i in range(tangency_count):
        if not is_known(tangencies[i], stage, work.bolt_motion, bolt, nut):
            x, y, z = tangencies[i, tk.T_X], tangencies[i, tk.T_Y], tangencies[i, tk.T_POINT_Z]
            time, azimuth = tangencies[i, tk.T_TIME], tangencies[i, tk.T_THETA]
            count = insert_contact(Contact(time, THREAD_THREAD, azimuth, math.atan2(y, x), x, y, z), count, out)
    for i in range(on_surface_count):
        x, y = on_surface[i, tk.T_X], on_surface[i, tk.T_Y]
        time, azimuth = on_surface[i, tk.T_TIME], on_surface[i, tk.T_THETA]
        count = insert_contact(Contact(time, THREAD_SURFACE, azimuth, math.atan2(y, x), x, y, 0.0), count, out)
    return count


@kernel()
def may_lack_ties(count: int, bolt_count: int, nut_count: int, tie_tolerance: float, work: Work, out: Array) -> bool:
    """Whether a list of contacts is full before those that tie with the earliest one are all in it."""
    if count == 0:
        return False
    tie_end = out[0, K_TIME] + tie_tolerance
    return (
        may_be_truncated(out, count, tie_end)
        or may_be_truncated(work.bolt_found, bolt_count, tie_end)
        or may_be_truncated(work.nut_found, nut_count, tie_end)
    )


@kernel()
def search_threads(
    is_turn: bool, reach: float, unexplained: bool, thread_search: int, bolt: Array, nut: Array, work: Work
) -> tuple[int, int]:
    """The contacts of threads up to ``reach``, into ``work``: how many of thread with thread, or OVERFLOW; and how many
    of the bolt's thread on the surface.

    ``unexplained``: an edge enters, and no contact of an edge says why.
    """
    tangencies = work.tangencies
    tangency_count = 0
    if thread_search != PROVED:
        tangency_count = ridge.ridge_contacts(work.bolt_motion, bolt, nut, reach, RIDGE_AZIMUTHS, tangencies)
        if is_turn:
            tangency_count = ridge.contacts_behind_entries(
                work.entries, reach, work.bolt_motion, bolt, nut, tangencies, tangency_count
            )
    on_surface_count = ts.thread_surface_contacts(work.bolt_motion, bolt, nut, reach, work.on_surface, 0)
    if thread_search == PROVED or (
        thread_search == RIDGES and unexplained and tangency_count == 0 and on_surface_count == 0
    ):
        # Where no edge contact explains the earliest entry, the threads must have met before it.
        tangency_count, evaluated = rect.tangencies(work.bolt_motion, bolt, nut, reach, work.rectangles, tangencies)
        if thread_search == RIDGES and (tangency_count == 0 or evaluated == OVERFLOW):
            # Of a strip between two azimuths only the overlap tells that an edge enters: it has begun in the threads.
            tangency_count = ridge.contacts_behind_entries(
                work.entries, reach, work.bolt_motion, bolt, nut, tangencies, 0
            )
            evaluated = OVERFLOW if tangency_count == 0 else 0
        if evaluated == OVERFLOW:
            return OVERFLOW, 0
    return tangency_count, on_surface_count


@kernel()
def keep_entries(since: float, entries: Array) -> None:
    """Keeps the entries before ``since`` alone, and forgets that an onset was found or doubtful."""
    count = 0
    for i in range(1, 1 + int(entries[0, 0])):
        if 0.0 <= entries[i, E_TIME] < since:
            count += 1
            copy_numbers(entries[i], entries[count])
    entries[0, 0], entries[0, E_DOUBTFUL], entries[0, E_NONE_BEFORE] = count, math.inf, math.inf


@kernel()
def contacts_of_edges(
    bolt_edge: Edge, nut_edge: Edge, stage: Stage, wanted: Wanted, since: float, span: float, work: Work, out: Array
) -> tuple[int, int, float, float]:
    """The earliest contacts of two edges that move and of their threads, as :func:`earliest` has them.

    Edges are searched from ``since`` on, before which no contact of theirs is; ``span`` is the length of the first span
    of time that is. Also returns from when on another search is to begin where this one did not end.
    """
    bolt, nut = bolt_edge.curve, nut_edge.curve
    is_turn, (limit, tie_tolerance, thread_search) = stage.is_turn, wanted
    keep_entries(since, work.entries)
    search = EdgeSearch(
        not is_turn,
        tie_tolerance,
        work.boxes,
        work.scratch,
        work.queue,
        work.regions,
        work.entries,
        work.jet,
        work.wedge,
    )
    bolt_count, nut_count, best, since, status = search_both_edges(
        since, limit, span, is_turn, bolt_edge, nut_edge, search, work
    )
    if status != RESOLVED or work.entries[0, E_DOUBTFUL] <= best + tie_tolerance:
        return 0, UNRESOLVED, best, max(min(since, work.entries[0, E_NONE_BEFORE]), 0.0)
    reach = min(limit, best + tie_tolerance)
    unexplained = not is_turn and best < limit
    if (bolt_count > 0 and work.bolt_found[0, C_TIME] <= best + tie_tolerance) or (
        nut_count > 0 and work.nut_found[0, C_TIME] <= best + tie_tolerance
    ):
        unexplained = False
    tangency_count, on_surface_count = search_threads(is_turn, reach, unexplained, thread_search, bolt, nut, work)
    if tangency_count == OVERFLOW:
        return 0, UNRESOLVED, best, 0.0
    count = list_edge_contacts(bolt_count, nut_count, nut, work, out)
    count = list_thread_contacts(tangency_count, on_surface_count, stage, bolt, nut, work, count, out)
    # Neither edges nor threads explain the entry: no pose is known at which that happens.
    if thread_search != RIDGES_ONLY and unexplained and (count == 0 or out[0, K_TIME] > best + 1e-8 * bolt[pk.P]):
        return count, UNRESOLVED, best, 0.0
    if may_lack_ties(count, bolt_count, nut_count, tie_tolerance, work, out):
        return count, UNRESOLVED, best, 0.0
    return count, RESOLVED, best, 0.0


@kernel()
def set_vertical_motions(pose: Array, up: float, bolt_motion: Array, nut_motion: Array) -> None:
    """Sets both edges' motions in a translation of the bolt along the nut's axis: up (1) or down (-1)."""
    axis = scratch(3)
    axis[0], axis[1], axis[2] = 0.0, 0.0, up
    set_motions(pose, False, False, axis, axis, bolt_motion, nut_motion)


@kernel()
def earliest_below(
    pose: Array, wanted: Wanted, bolt: Array, nut: Array, work: Work, out: Array
) -> tuple[int, int, float]:
    """As :func:`earliest`, on the way down the nut's axis from a pose."""
    down = scratch(3)
    down[0], down[1], down[2] = 0.0, 0.0, -1.0
    stage = Stage(pose, False, down, down, scratch(0, 2), scratch(0, CONTACT_SIZE), 0)
    return earliest(stage, wanted, False, bolt, nut, work, out)


@kernel()
def earliest(
    stage: Stage, wanted: Wanted, refined: bool, bolt: Array, nut: Array, work: Work, out: Array
) -> tuple[int, int, float]:
    """The earliest contacts of a motion by all pairs of features, sorted by time.

    Returns the number of contacts (all within the tolerance of a tie from the earliest, or within one of ``TIE_SHARES``
    of a turn, are listed, or the status is UNRESOLVED), a status, and the earliest time at which an edge enters (of a
    translation) or touches (of a turn). ``refined``: with refined edges from the beginning, as what a search in doubles
    finds is no contact.
    """
    pose, is_turn, point, axis, exact, known, known_count = stage
    bolt_kept, nut_kept = scratch(KEPT_ROWS, KEPT_SIZE), scratch(KEPT_ROWS, KEPT_SIZE)
    bolt_path, nut_path = scratch(PATH_SIZE), scratch(PATH_SIZE)
    bolt_edge = Edge(work.bolt_motion, bolt, nut, bolt_kept, bolt_path, scratch(0, 2))
    nut_edge = Edge(work.nut_motion, nut, bolt, nut_kept, nut_path, scratch(0, 2))
    coplanar = axis_in_both_planes(known, known_count)
    set_motions(pose, is_turn, coplanar, point, axis, work.bolt_motion, work.nut_motion)
    keep_contacts(known, known_count, pose, bolt_edge, nut_edge)
    count, status, best, since = 0, UNRESOLVED, wanted.limit, 0.0
    span = FIRST_SPAN_TURN if is_turn else FIRST_SPAN_HEIGHT * bolt[pk.P]
    if not refined:
        count, status, best, since = contacts_of_edges(bolt_edge, nut_edge, stage, wanted, since, span, work, out)
    if status != RESOLVED:
        bolt_wide, nut_wide = scratch(WIDE_MOTION_SIZE, 2), scratch(WIDE_MOTION_SIZE, 2)
        widened = scratch(WIDE_MOTION_SIZE, 2)
        widen_motion(work.bolt_motion, widened)
        meant = exact if exact.shape[0] > 0 else widened
        set_refined_motions(meant, work.bolt_motion, work.nut_motion, bolt_wide, nut_wide)
        bolt_edge = Edge(work.bolt_motion, bolt, nut, bolt_kept, bolt_path, bolt_wide)
        nut_edge = Edge(work.nut_motion, nut, bolt, nut_kept, nut_path, nut_wide)
        # What doubles take for an onset, if for no certain one, says how long the motion may be.
        span = min(span, best - since) if best > since else span
        count, status, best, _ = contacts_of_edges(bolt_edge, nut_edge, stage, wanted, since, span, work, out)
        for share in TIE_SHARES:
            if status != RESOLVED and is_turn and share * best < wanted.tie_tolerance:
                nearer = Wanted(wanted.limit, share * best, wanted.thread_search)
                count, status, best, _ = contacts_of_edges(bolt_edge, nut_edge, stage, nearer, 0.0, span, work, out)
    return count, status, best


@kernel()
def edges_overlap(pose: Array, contacts: Array, count: int, bolt: Array, nut: Array, work: Work) -> bool:
    """Whether an edge curve of one part may be inside the other at a pose, beyond the ``contacts`` on it."""
    bolt_kept, nut_kept, path = scratch(KEPT_ROWS, KEPT_SIZE), scratch(KEPT_ROWS, KEPT_SIZE), scratch(PATH_SIZE)
    bolt_edge = Edge(work.bolt_motion, bolt, nut, bolt_kept, path, scratch(0, 2))
    nut_edge = Edge(work.nut_motion, nut, bolt, nut_kept, path, scratch(0, 2))
    set_vertical_motions(pose, -1.0, work.bolt_motion, work.nut_motion)
    keep_contacts(contacts, count, pose, bolt_edge, nut_edge)
    outcome, _ = find_inside(bolt_edge, TOUCH_DEPTH, LEAST_HALF_WIDTH, work.boxes, work.queue)
    if outcome == OUTSIDE:
        outcome, _ = find_inside(nut_edge, TOUCH_DEPTH, LEAST_HALF_WIDTH, work.boxes, work.queue)
    return outcome != OUTSIDE
