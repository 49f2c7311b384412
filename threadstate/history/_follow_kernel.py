"""A pose solved from candidates in place of a search: contacts that another pose near it has.

Each candidate is solved for on its own equations by Newton's method, place and time together, in the motion of its
stage. Of those of a stage the earliest counts, and the next stage follows from it, as in a whole solve. A contact of
which there is no candidate is not known here.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact import _record_kernel as rk
from threadstate.contact import _tangency_kernel as tk
from threadstate.contact._beside_kernel import KEPT_ROWS, KEPT_SIZE
from threadstate.contact._box_kernel import ONE_EDGE, ONE_PLANE, ONE_THREAD
from threadstate.contact._edge_kernel import Box, Edge
from threadstate.contact._edge_search_kernel import AZIMUTH_TOLERANCE, contact_distance
from threadstate.contact._flush_kernel import EXTREME_SIZE
from threadstate.contact._geometry_kernel import M_KIND, MOTION_SIZE, PATH_SIZE, copy_numbers, motion_scale
from threadstate.contact._onset_kernel import (
    J_G,
    J_G_THETA,
    J_G_THETA_THETA,
    J_PHI,
    J_PHI_THETA,
    J_PHI_THETA_THETA,
    J_X,
    J_Y,
    J_Z,
    JET_SIZE,
    NO_ROOT,
    ROOT_INSIDE,
    newton_onset,
    onset_step,
    rises,
    set_jet_beside,
)
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
    BASE_EDGE,
    CONTACT_SIZE,
    EDGE_EDGE,
    EDGE_SURFACE,
    FLUSH,
    K_BOLT_AZIMUTH,
    K_NUT_AZIMUTH,
    K_PAIR,
    K_TIME,
    K_X,
    K_Y,
    K_Z,
    THREAD_EDGE,
    THREAD_SURFACE,
    THREAD_THREAD,
    axis_in_both_planes,
    keep_contacts,
    rotation,
    set_motions,
    turned,
)
from threadstate.contact._surface_kernel import start_height
from threadstate.contact._wedge_kernel import WEDGE_SIZE, crossing_of, is_contact
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]


class Work(NamedTuple):
    """The scratch arrays of one thread of work.

    Attributes:
        bolt_motion: motion of the bolt in the nut's frame.
        nut_motion: motion of the nut in the bolt's frame.
        bolt_kept: earlier contacts on the bolt's edge.
        nut_kept: those on the nut's.
        path: path of a point.
        wide: no rows: edges are not refined.
        jet: of an edge point.
        wedge: unit vectors at an edge point.
        placement: of the bolt.
        tangency_jet: of a point of the thread.
        tangencies: contacts of thread with thread.
    """

    bolt_motion: Array
    nut_motion: Array
    bolt_kept: Array
    nut_kept: Array
    path: Array
    wide: Array
    jet: Array
    wedge: Array
    placement: Array
    tangency_jet: Array
    tangencies: Array


# A candidate: its stage (0: none), height of the bolt or turn, pair, azimuths, axial position on the bolt's thread.
F_STAGE, F_TIME, F_PAIR, F_BOLT_AZIMUTH, F_NUT_AZIMUTH, F_BOLT_Z = range(6)
CANDIDATE_SIZE = 6
CANDIDATES = 2 * rk.MAX_RECORD_CONTACTS
"""Room for the contacts of two records."""

REACH_AZIMUTH = 0.2
REACH_TURN = 0.2
REACH_HEIGHT = 0.5
"""How far from where Newton's method starts a contact may lie: azimuth and turn (rad), height (thread pitches)."""

SETTLED = 1e-8
"""A step of Newton's method (rad, in units of ``motion_scale``) smaller than this does not matter to an estimate."""

SAME_PLACE = 1e-6
"""A contact nearer to an earlier one, as a multiple of its distance from the axis (its x and y added), is that one."""


@kernel(allocates=True)
def new_work() -> Work:
    """The scratch arrays of one thread of work."""
    return Work(
        np.empty(MOTION_SIZE),
        np.empty(MOTION_SIZE),
        np.empty((KEPT_ROWS, KEPT_SIZE)),
        np.empty((KEPT_ROWS, KEPT_SIZE)),
        np.empty(PATH_SIZE),
        np.empty((0, 2)),
        np.empty(JET_SIZE),
        np.empty(WEDGE_SIZE),
        np.empty(tk.PLACEMENT_SIZE),
        np.empty(tk.TANGENCY_JET_SIZE),
        np.empty((tk.MAX_TANGENCIES, tk.TANGENCY_SIZE)),
    )


@kernel()
def set_candidates(record: Array, candidates: Array) -> None:
    """Sets the candidates that a record's contacts are; corners of a patch are none."""
    for i in range(rk.MAX_RECORD_CONTACTS):
        candidates[i, F_STAGE] = 0.0
    for i in range(int(record[rk.O_CONTACTS])):
        c = record[rk.O_CONTACT + rk.POINT_SIZE * i : rk.O_CONTACT + rk.POINT_SIZE * (i + 1)]
        pair = int(c[rk.P_PAIR])
        if pair == FLUSH or pair == THREAD_SURFACE:
            continue
        stage = int(c[rk.P_STAGE])
        candidates[i, F_STAGE] = stage
        candidates[i, F_PAIR] = pair
        candidates[i, F_TIME] = record[rk.O_POSE + 11] if stage == 1 else record[rk.O_LAMBDA if stage == 2 else rk.O_MU]
        candidates[i, F_BOLT_AZIMUTH] = math.atan2(c[rk.P_BOLT_POINT + 1], c[rk.P_BOLT_POINT])
        candidates[i, F_NUT_AZIMUTH] = math.atan2(c[rk.P_POINT + 1], c[rk.P_POINT])
        candidates[i, F_BOLT_Z] = c[rk.P_BOLT_POINT + 2]


@kernel()
def follow_edge_point(kind: int, theta: float, tau: float, edge: Edge, work: Work) -> tuple[bool, float, float]:
    """The contact of one kind near an azimuth and a time of an edge: whether there is one, its azimuth and time.

    The point is left in the jet.
    """
    jet = work.jet
    span = REACH_TURN if edge.motion[M_KIND] > 0.0 else REACH_HEIGHT * edge.solid[pk.P]
    place, t, time = newton_onset(kind, Box(theta, REACH_AZIMUTH, tau - span, tau + span), edge, jet)
    set_jet_beside(t, time, edge, jet)
    if place == NO_ROOT:
        # Beside an earlier contact steps do not become as small as elsewhere.
        _, dt, dtau, _, _ = onset_step(kind, jet, 0.0, 0.0)
        is_settled = abs(dt) < SETTLED and abs(dtau) < SETTLED * motion_scale(edge.motion, edge.curve)
        if not (is_settled and abs(t - theta) < REACH_AZIMUTH and abs(time - tau) < span):
            return False, t, time
    elif place != ROOT_INSIDE:
        return False, t, time
    # A peak of the lesser of g and phi, at which the other one is not negative.
    if kind == ONE_EDGE:
        is_peak = jet[J_G_THETA] * jet[J_PHI_THETA] < 0.0
    elif kind == ONE_THREAD:
        is_peak = jet[J_PHI_THETA_THETA] < 0.0 and jet[J_G] >= 0.0
    else:
        is_peak = jet[J_G_THETA_THETA] < 0.0 and jet[J_PHI] >= 0.0
    if not is_peak or not rises(kind, jet) or contact_distance(t, edge.kept) < AZIMUTH_TOLERANCE:
        return False, t, time
    crossing = crossing_of(kind, t, time, edge, jet, work.wedge)
    return is_contact(kind, t, time, crossing, edge, jet, work.wedge), t, time


@kernel()
def follow_candidate(
    candidate: Array,
    tau: float,
    limit: float,
    bolt: Array,
    nut: Array,
    work: Work,
    contact: Array,
) -> bool:
    """Sets the contact of a motion that is near a candidate; False where there is none.

    The motion and the earlier contacts on each edge are in ``work``.
    """
    jet, tangencies = work.jet, work.tangencies
    pair = int(candidate[F_PAIR])
    contact[K_PAIR] = pair
    if pair == THREAD_THREAD:
        theta, z = candidate[F_BOLT_AZIMUTH], candidate[F_BOLT_Z]
        count = tk.newton_tangency(
            theta, z, tau, limit, work.bolt_motion, bolt, nut, work.placement, work.tangency_jet, tangencies, 0
        )
        if count == 0:
            return False
        contact[K_TIME] = tangencies[0, tk.T_TIME]
        contact[K_BOLT_AZIMUTH] = tangencies[0, tk.T_THETA]
        contact[K_X], contact[K_Y], contact[K_Z] = (
            tangencies[0, tk.T_X],
            tangencies[0, tk.T_Y],
            tangencies[0, tk.T_POINT_Z],
        )
        contact[K_NUT_AZIMUTH] = math.atan2(contact[K_Y], contact[K_X])
        return True
    if pair == BASE_EDGE or pair == THREAD_EDGE:
        kind = int(ONE_PLANE) if pair == BASE_EDGE else int(ONE_THREAD)
        edge = Edge(work.nut_motion, nut, bolt, work.nut_kept, work.path, work.wide)
        found, theta, time = follow_edge_point(kind, candidate[F_NUT_AZIMUTH], tau, edge, work)
        r = pk.radius(-nut[pk.LEAD] / (2.0 * math.pi) * theta, nut)
        contact[K_BOLT_AZIMUTH] = math.atan2(jet[J_Y], jet[J_X])
        contact[K_NUT_AZIMUTH] = theta
        contact[K_X], contact[K_Y], contact[K_Z] = r * math.cos(theta), r * math.sin(theta), 0.0
    else:
        kind = int(ONE_EDGE) if pair == EDGE_EDGE else int(ONE_PLANE) if pair == EDGE_SURFACE else int(ONE_THREAD)
        edge = Edge(work.bolt_motion, bolt, nut, work.bolt_kept, work.path, work.wide)
        found, theta, time = follow_edge_point(kind, candidate[F_BOLT_AZIMUTH], tau, edge, work)
        contact[K_BOLT_AZIMUTH] = theta
        contact[K_NUT_AZIMUTH] = math.atan2(jet[J_Y], jet[J_X])
        contact[K_X], contact[K_Y], contact[K_Z] = jet[J_X], jet[J_Y], jet[J_Z]
    contact[K_TIME] = time
    return found and 0.0 < time <= limit


@kernel()
def earliest_candidate(
    stage: int,
    pose: Array,
    point: Array,
    axis: Array,
    known: Array,
    limit: float,
    candidates: Array,
    bolt: Array,
    nut: Array,
    work: Work,
    contact: Array,
) -> bool:
    """Sets the earliest contact of a stage among those near its candidates; False where there is none.

    ``known`` are the contacts of the stages before.
    """
    is_turn = stage > 1
    set_motions(pose, is_turn, axis_in_both_planes(known, stage - 1), point, axis, work.bolt_motion, work.nut_motion)
    bolt_edge = Edge(work.bolt_motion, bolt, nut, work.bolt_kept, work.path, work.wide)
    nut_edge = Edge(work.nut_motion, nut, bolt, work.nut_kept, work.path, work.wide)
    keep_contacts(known, stage - 1, pose, bolt_edge, nut_edge)
    one = scratch(CONTACT_SIZE)
    contact[K_TIME] = math.inf
    for i in range(CANDIDATES):
        if candidates[i, F_STAGE] != stage:
            continue
        tau = candidates[i, F_TIME] if is_turn else pose[11] - candidates[i, F_TIME]
        if not follow_candidate(candidates[i], tau, limit, bolt, nut, work, one):
            continue
        if one[K_TIME] >= contact[K_TIME]:
            continue
        is_known = False
        for j in range(stage - 1):
            apart = abs(one[K_X] - known[j, K_X]) + abs(one[K_Y] - known[j, K_Y]) + abs(one[K_Z] - known[j, K_Z])
            is_known = is_known or apart < SAME_PLACE * (abs(one[K_X]) + abs(one[K_Y]))
        if not is_known:
            copy_numbers(one, contact)
    return contact[K_TIME] < math.inf


@kernel()
def follow_pose(
    roll: float,
    pitch: float,
    phase: float,
    turn_limit: float,
    candidates: Array,
    bolt: Array,
    nut: Array,
    work: Work,
    record: Array,
) -> bool:
    """The record of a pose (angles in rad) whose contacts are near candidates; False where the first one is not.

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
    if not earliest_candidate(
        1, pose, point, axis, known, pose[11] + bolt[pk.P], candidates, bolt, nut, work, known[0]
    ):
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
    if not earliest_candidate(2, pose, point, axis, known, limit, candidates, bolt, nut, work, known[1]):
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
    if not earliest_candidate(3, second, point, axis, known, limit, candidates, bolt, nut, work, known[2]):
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
