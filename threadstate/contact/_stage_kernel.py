"""The three stages of one pose, and the lift that frees the third (method, sections 4 and 5)."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from threadstate.contact import _rectangle_kernel as rect
from threadstate.contact import _ridge_kernel as ridge
from threadstate.contact import _search_kernel as sk
from threadstate.contact import _tangency_kernel as tk
from threadstate.contact._geometry_kernel import MOTION_SIZE, TWO_PI, edge_point
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Work = tuple[Array, Array, NDArray[np.int64], Array, Array, Array, Array, Array, Array]

# Pairs of features, in the order of ``FeaturePair``.
EDGE_EDGE, EDGE_SURFACE, BASE_EDGE, EDGE_THREAD, THREAD_EDGE, THREAD_THREAD, FLUSH = range(7)

# A contact of a stage: time, pair, azimuth on the bolt, azimuth on the nut, point in the nut's frame.
K_TIME, K_PAIR, K_BOLT, K_NUT, K_X, K_Y, K_Z = range(7)
CONTACT_SIZE = 7
MAX_CONTACTS = 16

RESOLVED, UNRESOLVED = range(2)

RIDGES, PROVED, RIDGES_ONLY = range(3)

RIDGE_AZIMUTHS = 32

NEAR_TURN = math.radians(7.0)


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
def keep(time: float, pair: int, bolt: float, nut: float, x: float, y: float, z: float, count: int, out: Array) -> int:
    """Inserts a contact by time unless the same is there already (found from the other edge)."""
    for i in range(count):
        if abs(out[i, K_X] - x) + abs(out[i, K_Y] - y) + abs(out[i, K_Z] - z) < 1e-7 * (abs(x) + abs(y)):
            return count
    if count == MAX_CONTACTS:
        return count
    i = count
    while i > 0 and out[i - 1, K_TIME] > time:
        out[i] = out[i - 1]
        i -= 1
    out[i, K_TIME] = time
    out[i, K_PAIR] = pair
    out[i, K_BOLT] = bolt
    out[i, K_NUT] = nut
    out[i, K_X] = x
    out[i, K_Y] = y
    out[i, K_Z] = z
    return count + 1


@njit(cache=True, error_model="numpy")
def new_work() -> Work:
    """The scratch arrays of one thread of work."""
    return (
        np.empty((sk.MAX_NODES, sk.NODE_SIZE)),
        np.empty((sk.MAX_NODES, sk.NODE_SIZE)),
        np.empty((sk.MAX_CELLS, 2), np.int64),
        np.empty((sk.MAX_CANDIDATES, sk.CANDIDATE_SIZE)),
        np.empty((sk.MAX_CANDIDATES, sk.CANDIDATE_SIZE)),
        np.empty(MOTION_SIZE),
        np.empty(MOTION_SIZE),
        np.empty((rect.MAX_RECTANGLES, rect.RECTANGLE_SIZE)),
        np.empty((tk.MAX_TANGENCIES, tk.TANGENCY_SIZE)),
    )


@njit(cache=True, error_model="numpy")
def anchored(best: float, slack: float, count_b: int, found_b: Array, count_n: int, found_n: Array) -> bool:
    """Whether the earliest time is that of a contact on one of the curves."""
    return (count_b > 0 and found_b[0, sk.C_TIME] <= best + slack) or (
        count_n > 0 and found_n[0, sk.C_TIME] <= best + slack
    )


@njit(cache=True, error_model="numpy")
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
) -> tuple[int, bool, int, float]:
    """The earliest contacts of a motion by all pairs of features, sorted by time.

    ``known`` holds the contacts through which the axis of a turn runs; they are not found again. Returns the number
    of contacts (those within ``slack`` of the earliest are certain to be listed), whether an earlier contact has grown
    into an overlap by then, a status, and the earliest time at which an edge enters. ``threads`` says how thread on
    thread is searched: RIDGES (proved where no edge explains the earliest entry), PROVED or RIDGES_ONLY.
    """
    nodes_b, nodes_n, cells, found_b, found_n, bolt_walks, nut_walks, rects, tangent = work
    bolt_marks = np.empty(2)
    nut_marks = np.empty(2)
    bolt_mark_count = 0
    nut_mark_count = 0
    for i in range(known_count):
        pair = int(known[i, K_PAIR])
        if pair == EDGE_EDGE or pair == EDGE_SURFACE or pair == EDGE_THREAD:
            bolt_marks[bolt_mark_count] = known[i, K_BOLT] - TWO_PI * math.floor(known[i, K_BOLT] / TWO_PI)
            bolt_mark_count += 1
        if pair == EDGE_EDGE or pair == BASE_EDGE or pair == THREAD_EDGE:
            nut_marks[nut_mark_count] = known[i, K_NUT] - TWO_PI * math.floor(known[i, K_NUT] / TWO_PI)
            nut_mark_count += 1
    # Through contacts that lie in both planes the axis does so, too.
    coplanar = known_count > 0
    for i in range(known_count):
        pair = int(known[i, K_PAIR])
        if known_count == 1:
            coplanar = pair == EDGE_SURFACE
        else:
            coplanar = coplanar and (pair == EDGE_EDGE or pair == EDGE_SURFACE or pair == BASE_EDGE)
    set_motions(pose, is_turn, coplanar, point, axis, bolt_walks, nut_walks)
    any_entry = not is_turn
    # Most contacts come early: a near horizon first, the whole turn only where nothing is found before.
    near = min(limit, NEAR_TURN if is_turn else limit)
    for horizon in (near, limit):
        count_b, total_b, best = sk.survey(
            bolt_walks, bolt, nut, bolt_marks, bolt_mark_count, horizon, any_entry, slack, nodes_b, found_b
        )
        count_n, total_n, best = sk.survey(
            nut_walks, nut, bolt, nut_marks, nut_mark_count, best, any_entry, slack, nodes_n, found_n
        )
        count_b, grown_b, used_b, best = sk.close_cells(
            bolt_walks,
            bolt,
            nut,
            bolt_marks,
            bolt_mark_count,
            horizon,
            best,
            anchored(best, slack, count_b, found_b, count_n, found_n),
            any_entry,
            slack,
            nodes_b,
            total_b,
            cells,
            count_b,
            found_b,
        )
        count_n, grown_n, used_n, best = sk.close_cells(
            nut_walks,
            nut,
            bolt,
            nut_marks,
            nut_mark_count,
            horizon,
            best,
            anchored(best, slack, count_b, found_b, count_n, found_n),
            any_entry,
            slack,
            nodes_n,
            total_n,
            cells,
            count_n,
            found_n,
        )
        if count_b + count_n > 0 or horizon == limit:
            break
    used_t = 0
    reach = min(limit, best + slack)
    # Where no edge contact explains the earliest entry, the threads must have met before it.
    orphan = (
        threads == RIDGES
        and any_entry
        and best < limit - 1e-8 * bolt[pk.P]
        and not anchored(best, slack, count_b, found_b, count_n, found_n)
    )
    if threads == PROVED or orphan:
        count_t, used_t = rect.tangencies(bolt_walks, bolt, nut, reach, rects, tangent)
    else:
        count_t = ridge.ridges(bolt_walks, bolt, nut, reach, RIDGE_AZIMUTHS, tangent)
    count = 0
    for i in range(count_b):
        kind = int(found_b[i, sk.C_KIND])
        pair = EDGE_EDGE if kind == sk.EDGE_EDGE else (EDGE_SURFACE if kind == sk.ON_PLANE else EDGE_THREAD)
        count = keep(
            found_b[i, sk.C_TIME],
            pair,
            found_b[i, sk.C_THETA],
            found_b[i, sk.C_OTHER],
            found_b[i, sk.C_X],
            found_b[i, sk.C_Y],
            found_b[i, sk.C_Z],
            count,
            out,
        )
    for i in range(count_n):
        kind = int(found_n[i, sk.C_KIND])
        pair = EDGE_EDGE if kind == sk.EDGE_EDGE else (BASE_EDGE if kind == sk.ON_PLANE else THREAD_EDGE)
        theta_n = found_n[i, sk.C_THETA]
        x, y, _, _ = edge_point(theta_n, nut)
        count = keep(found_n[i, sk.C_TIME], pair, found_n[i, sk.C_OTHER], theta_n, x, y, 0.0, count, out)
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
    status = RESOLVED
    if used_b == sk.OVERFLOW or used_n == sk.OVERFLOW or used_t == sk.OVERFLOW:
        status = UNRESOLVED
    unexplained = any_entry and best < limit - 1e-8 * bolt[pk.P]
    if threads != RIDGES_ONLY and unexplained and (count == 0 or out[0, K_TIME] > best + 1e-8 * bolt[pk.P]):
        status = UNRESOLVED
    return count, grown_b or grown_n, status, best
