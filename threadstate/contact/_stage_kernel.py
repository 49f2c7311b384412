"""The search of one stage: the earliest contacts of a motion (method, section 4)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact import _rectangle_kernel as rect
from threadstate.contact import _ridge_kernel as ridge
from threadstate.contact import _tangency_kernel as tk
from threadstate.contact._birth_kernel import (
    C_KIND,
    C_OTHER,
    C_THETA,
    C_TIME,
    C_X,
    C_Y,
    C_Z,
    CANDIDATE_SIZE,
    MAX_CANDIDATES,
)
from threadstate.contact._box_kernel import BOXES_SIZE, ONE_EDGE, ONE_PLANE
from threadstate.contact._geometry_kernel import MOTION_SIZE, TWO_PI, copy_numbers, edge_point, stride
from threadstate.contact._sweep_kernel import ENTRY_SIZE, EPS_PUNCTURE, MAX_ENTRIES, OUTSIDE, OVERFLOW, inside_at, sweep
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Work = tuple[Array, Array, Array, Array, Array, Array, Array, Array, Array]

# Pairs of features, in the order of ``FeaturePair``.
EDGE_EDGE, EDGE_SURFACE, BASE_EDGE, EDGE_THREAD, THREAD_EDGE, THREAD_THREAD, FLUSH = range(7)

# A contact of a stage: time, pair, azimuth on the bolt, azimuth on the nut, point in the nut's frame.
K_TIME, K_PAIR, K_BOLT, K_NUT, K_X, K_Y, K_Z = range(7)
CONTACT_SIZE = 7
MAX_CONTACTS = 16

RESOLVED, UNRESOLVED = range(2)

RIDGES, PROVED, RIDGES_ONLY = range(3)

RIDGE_AZIMUTHS = 32

FIRST_SPAN_TURN = math.radians(2.0)
FIRST_SPAN_HEIGHT = 0.05
LONGER = 1.25
"""A motion is searched span by span: the first one (rad, thread pitches), and how much longer each next one is."""

SHALLOW = 1e-10
"""Depth (thread pitches) up to which an edge counts as touching."""

NARROW = 1e-7
"""Half-width (rad) of an overlap that is not told apart from a contact."""

SHORTER = 0.25
SHORTEST_SPAN = 1e-9
"""How much shorter a span is made that has too many boxes, and where that ends (of the motion's ``stride``)."""


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
    pose: Array, is_turn: bool, coplanar: bool, point: Array, axis: Array, bolt_walks: Array, nut_walks: Array
) -> None:
    """The same motion seen from the nut (the bolt's edge walks) and from the bolt (the nut's edge walks)."""
    for i in range(12):
        bolt_walks[i] = pose[i]
    bolt_walks[12] = 1.0 if is_turn else 0.0
    for i in range(3):
        bolt_walks[13 + i] = point[i]
        bolt_walks[16 + i] = axis[i]
    bolt_walks[19] = 1.0
    bolt_walks[20] = 1.0 if coplanar else 0.0
    nut_walks[12] = bolt_walks[12]
    nut_walks[19] = -1.0
    nut_walks[20] = bolt_walks[20]
    for i in range(3):
        for j in range(3):
            nut_walks[3 * i + j] = pose[3 * j + i]
        nut_walks[9 + i] = -(pose[i] * pose[9] + pose[3 + i] * pose[10] + pose[6 + i] * pose[11])
        nut_walks[13 + i] = (
            pose[i] * (point[0] - pose[9]) + pose[3 + i] * (point[1] - pose[10]) + pose[6 + i] * (point[2] - pose[11])
        )
        nut_walks[16 + i] = -(pose[i] * axis[0] + pose[3 + i] * axis[1] + pose[6 + i] * axis[2])


@kernel()
def keep(time: float, pair: int, bolt: float, nut: float, x: float, y: float, z: float, count: int, out: Array) -> int:
    """Inserts a contact by time unless the same is there already (found from the other edge).

    A full list keeps the earliest ones.
    """
    for i in range(count):
        if abs(out[i, K_X] - x) + abs(out[i, K_Y] - y) + abs(out[i, K_Z] - z) < EPS_PUNCTURE * (abs(x) + abs(y)):
            return count
    if count == MAX_CONTACTS:
        if time >= out[count - 1, K_TIME]:
            return count
        count -= 1
    i = count
    while i > 0 and out[i - 1, K_TIME] > time:
        copy_numbers(out[i - 1], out[i])
        i -= 1
    out[i, K_TIME] = time
    out[i, K_PAIR] = pair
    out[i, K_BOLT] = bolt
    out[i, K_NUT] = nut
    out[i, K_X] = x
    out[i, K_Y] = y
    out[i, K_Z] = z
    return count + 1


@kernel()
def is_full(listed: Array, count: int, until: float) -> bool:
    """Whether a list by time, in its first column, has no room for all that there may be up to ``until``."""
    return count == listed.shape[0] and listed[count - 1, 0] <= until


@kernel()
def new_work() -> Work:
    """The scratch arrays of one thread of work."""
    return (
        np.empty(BOXES_SIZE),
        np.empty(BOXES_SIZE),
        np.empty((MAX_CANDIDATES, CANDIDATE_SIZE)),
        np.empty((MAX_CANDIDATES, CANDIDATE_SIZE)),
        np.empty(MOTION_SIZE),
        np.empty(MOTION_SIZE),
        np.empty((rect.MAX_RECTANGLES, rect.RECTANGLE_SIZE)),
        np.empty((tk.MAX_TANGENCIES, tk.TANGENCY_SIZE)),
        np.zeros((1 + MAX_ENTRIES, ENTRY_SIZE)),
    )


@kernel()
def on_bolt_edge(contact: Array, pose: Array, bolt: Array) -> bool:
    """Whether a contact of the bolt's thread or base is at the bolt's edge, too, as far as azimuths are told apart."""
    near = EPS_PUNCTURE * bolt[pk.R_MAJOR]
    x, y, z = contact[K_X] - pose[9], contact[K_Y] - pose[10], contact[K_Z] - pose[11]
    if int(contact[K_PAIR]) != BASE_EDGE:
        return abs(pose[2] * x + pose[5] * y + pose[8] * z) < near
    r = math.hypot(pose[0] * x + pose[3] * y + pose[6] * z, pose[1] * x + pose[4] * y + pose[7] * z)
    return abs(r - pk.radius(-bolt[pk.P] / TWO_PI * contact[K_BOLT], bolt)) < near


@kernel()
def on_nut_edge(contact: Array, nut: Array) -> bool:
    """Whether a contact of the nut's thread or surface is at the nut's edge, too, as far as azimuths are told apart."""
    near = EPS_PUNCTURE * nut[pk.R_MAJOR]
    if int(contact[K_PAIR]) != EDGE_SURFACE:
        return abs(contact[K_Z]) < near
    r = math.hypot(contact[K_X], contact[K_Y])
    return abs(r - pk.radius(-nut[pk.P] / TWO_PI * contact[K_NUT], nut)) < near


@kernel()
def set_marks(
    known: Array, known_count: int, pose: Array, bolt: Array, nut: Array, bolt_marks: Array, nut_marks: Array
) -> tuple[int, int]:
    """Azimuths in [0, 2 pi) of a pose's contacts on the bolt's and on the nut's edge curve, and their numbers.

    Where a contact changes from a part's edge to its thread or its flat face it is on both, as far as azimuths are
    told apart: then its edge must not be taken for another contact.
    """
    on_bolt = 0
    on_nut = 0
    for i in range(known_count):
        pair = int(known[i, K_PAIR])
        if pair == EDGE_EDGE or pair == EDGE_SURFACE or pair == EDGE_THREAD or on_bolt_edge(known[i], pose, bolt):
            bolt_marks[on_bolt] = known[i, K_BOLT] - TWO_PI * math.floor(known[i, K_BOLT] / TWO_PI)
            on_bolt += 1
        if pair == EDGE_EDGE or pair == BASE_EDGE or pair == THREAD_EDGE or on_nut_edge(known[i], nut):
            nut_marks[on_nut] = known[i, K_NUT] - TWO_PI * math.floor(known[i, K_NUT] / TWO_PI)
            on_nut += 1
    return on_bolt, on_nut


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


def earliest(
    pose: Array,
    is_turn: bool,
    point: Array,
    axis: Array,
    known: Array,
    known_count: int,
    limit: float,
    slack: float,
    bolt: Array,
    nut: Array,
    threads: int,
    work: Work,
    out: Array,
) -> tuple[int, int, float]:
    """The earliest contacts of a motion by all pairs of features, sorted by time.

    Kernels call it as a ``Search`` of ``_search_kernel``, which compiles it.

    ``known`` holds the contacts through which the axis of a turn runs; they are not found again. Returns the number
    of contacts (those within ``slack`` of the earliest are listed, or the status is UNRESOLVED), a status, and the
    earliest time at which an edge enters (of a translation) or touches (of a turn). ``threads`` says how thread on
    thread is searched: RIDGES (proved where no edge explains the earliest entry), PROVED or RIDGES_ONLY.
    """
    boxes, others, found_b, found_n, bolt_walks, nut_walks, rects, tangent, entries = work
    bolt_marks = np.empty(2)
    nut_marks = np.empty(2)
    bolt_mark_count, nut_mark_count = set_marks(known, known_count, pose, bolt, nut, bolt_marks, nut_marks)
    coplanar = axis_in_both_planes(known, known_count)
    set_motions(pose, is_turn, coplanar, point, axis, bolt_walks, nut_walks)
    any_birth = not is_turn
    entries[0, 0] = 0.0
    count_b = 0
    count_n = 0
    used = 0
    best = limit
    since = 0.0
    span = FIRST_SPAN_TURN if is_turn else FIRST_SPAN_HEIGHT * bolt[pk.P]
    while since < best:
        until = min(since + span, limit)
        count_b, used_b, best = sweep(
            since,
            until,
            bolt_walks,
            bolt,
            nut,
            bolt_marks,
            bolt_mark_count,
            best,
            any_birth,
            slack,
            boxes,
            others,
            count_b,
            found_b,
            entries,
        )
        count_n, used_n, best = sweep(
            since,
            until,
            nut_walks,
            nut,
            bolt,
            nut_marks,
            nut_mark_count,
            best,
            any_birth,
            slack,
            boxes,
            others,
            count_n,
            found_n,
            entries,
        )
        if used_b == OVERFLOW or used_n == OVERFLOW:
            span *= SHORTER
            if span < SHORTEST_SPAN * stride(bolt_walks, bolt):
                return 0, UNRESOLVED, best
            continue
        since = until
        span *= LONGER
    reach = min(limit, best + slack)
    unexplained = any_birth and best < limit
    if (count_b > 0 and found_b[0, C_TIME] <= best + slack) or (count_n > 0 and found_n[0, C_TIME] <= best + slack):
        unexplained = False
    count_t = 0
    if threads != PROVED:
        count_t = ridge.ridges(bolt_walks, bolt, nut, reach, RIDGE_AZIMUTHS, tangent)
        if is_turn:
            count_t = ridge.followed_back(entries, reach, bolt_walks, bolt, nut, tangent, count_t)
    if threads == PROVED or (threads == RIDGES and unexplained and count_t == 0):
        # Where no edge contact explains the earliest entry, the threads must have met before it.
        count_t, used = rect.tangencies(bolt_walks, bolt, nut, reach, rects, tangent)
        if used == rect.OVERFLOW:
            return 0, UNRESOLVED, best
    count = 0
    for i in range(count_b):
        kind = int(found_b[i, C_KIND])
        pair = EDGE_EDGE if kind == ONE_EDGE else (EDGE_SURFACE if kind == ONE_PLANE else EDGE_THREAD)
        count = keep(
            found_b[i, C_TIME],
            pair,
            found_b[i, C_THETA],
            found_b[i, C_OTHER],
            found_b[i, C_X],
            found_b[i, C_Y],
            found_b[i, C_Z],
            count,
            out,
        )
    for i in range(count_n):
        kind = int(found_n[i, C_KIND])
        pair = EDGE_EDGE if kind == ONE_EDGE else (BASE_EDGE if kind == ONE_PLANE else THREAD_EDGE)
        theta_n = found_n[i, C_THETA]
        x, y, _, _ = edge_point(theta_n, nut)
        count = keep(found_n[i, C_TIME], pair, found_n[i, C_OTHER], theta_n, x, y, 0.0, count, out)
    for i in range(count_t):
        x, y, z = tangent[i, tk.T_X], tangent[i, tk.T_Y], tangent[i, tk.T_POINT_Z]
        again = False
        for j in range(known_count):
            if abs(x - known[j, K_X]) + abs(y - known[j, K_Y]) + abs(z - known[j, K_Z]) < 1e-4 * bolt[pk.P]:
                again = True
        if not again:
            count = keep(
                tangent[i, tk.T_TIME], THREAD_THREAD, tangent[i, tk.T_THETA], math.atan2(y, x), x, y, z, count, out
            )
    if threads != RIDGES_ONLY and unexplained and (count == 0 or out[0, K_TIME] > best + 1e-8 * bolt[pk.P]):
        return count, UNRESOLVED, best
    if count > 0:
        tied = out[0, K_TIME] + slack
        if is_full(out, count, tied) or is_full(found_b, count_b, tied) or is_full(found_n, count_n, tied):
            return count, UNRESOLVED, best
    return count, RESOLVED, best


@kernel()
def edges_overlap(pose: Array, contacts: Array, count: int, bolt: Array, nut: Array, work: Work) -> bool:
    """Whether an edge curve of one part may be inside the other at a pose, beyond the ``contacts`` on it."""
    boxes, others, _, _, bolt_walks, nut_walks, _, _, _ = work
    bolt_marks = np.empty(count)
    nut_marks = np.empty(count)
    bolt_mark_count, nut_mark_count = set_marks(contacts, count, pose, bolt, nut, bolt_marks, nut_marks)
    down = np.array([0.0, 0.0, -1.0])
    set_motions(pose, False, False, down, down, bolt_walks, nut_walks)
    said, _ = inside_at(bolt_walks, bolt, nut, bolt_marks, bolt_mark_count, SHALLOW, NARROW, boxes, others)
    if said == OUTSIDE:
        said, _ = inside_at(nut_walks, nut, bolt, nut_marks, nut_mark_count, SHALLOW, NARROW, boxes, others)
    return said != OUTSIDE
