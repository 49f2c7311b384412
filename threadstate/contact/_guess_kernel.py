"""Contacts of a motion found from guesses: the contacts of other poses near it.

Each guess is solved for on its own equations by Newton's method, place and time together, in the motion of its stage.
Of those of a stage the earliest counts. A contact of which there is no guess is not known here.
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
    set_motions,
)
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


# A guess: its stage (0: none), height of the bolt or turn, pair, azimuths, axial position on the bolt's thread.
G_STAGE, G_TIME, G_PAIR, G_BOLT_AZIMUTH, G_NUT_AZIMUTH, G_BOLT_Z = range(6)
GUESS_SIZE = 6
GUESSES = 2 * rk.MAX_RECORD_CONTACTS
"""Room for the contacts of two records."""

REACH_AZIMUTH = 0.2
REACH_TURN = 0.2
REACH_HEIGHT = 0.5
"""How far from where Newton's method starts a contact may lie: azimuth and turn (rad), height (thread pitches)."""

SETTLED_GUESS = 1e-8
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
def clear_guesses(guesses: Array) -> None:
    """Makes all guesses none."""
    guesses[:, G_STAGE] = 0.0


@kernel()
def set_guesses(record: Array, guesses: Array) -> None:
    """Sets the guesses that a record's contacts are; corners of a patch are none."""
    for i in range(rk.MAX_RECORD_CONTACTS):
        guesses[i, G_STAGE] = 0.0
    for i in range(int(record[rk.O_CONTACTS])):
        c = record[rk.O_CONTACT + rk.POINT_SIZE * i : rk.O_CONTACT + rk.POINT_SIZE * (i + 1)]
        pair = int(c[rk.P_PAIR])
        if pair == FLUSH or pair == THREAD_SURFACE:
            continue
        stage = int(c[rk.P_STAGE])
        guesses[i, G_STAGE] = stage
        guesses[i, G_PAIR] = pair
        guesses[i, G_TIME] = record[rk.O_POSE + 11] if stage == 1 else record[rk.O_LAMBDA if stage == 2 else rk.O_MU]
        guesses[i, G_BOLT_AZIMUTH] = math.atan2(c[rk.P_BOLT_POINT + 1], c[rk.P_BOLT_POINT])
        guesses[i, G_NUT_AZIMUTH] = math.atan2(c[rk.P_POINT + 1], c[rk.P_POINT])
        guesses[i, G_BOLT_Z] = c[rk.P_BOLT_POINT + 2]


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
        is_settled = abs(dt) < SETTLED_GUESS and abs(dtau) < SETTLED_GUESS * motion_scale(edge.motion, edge.curve)
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
def follow_guess(
    guess: Array,
    tau: float,
    limit: float,
    bolt: Array,
    nut: Array,
    work: Work,
    contact: Array,
) -> bool:
    """Sets the contact of a motion that is near a guess; False where there is none.

    The motion and the earlier contacts on each edge are in ``work``.
    """
    jet, tangencies = work.jet, work.tangencies
    pair = int(guess[G_PAIR])
    contact[K_PAIR] = pair
    if pair == THREAD_THREAD:
        theta, z = guess[G_BOLT_AZIMUTH], guess[G_BOLT_Z]
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
        found, theta, time = follow_edge_point(kind, guess[G_NUT_AZIMUTH], tau, edge, work)
        r = pk.radius(-nut[pk.LEAD] / (2.0 * math.pi) * theta, nut)
        contact[K_BOLT_AZIMUTH] = math.atan2(jet[J_Y], jet[J_X])
        contact[K_NUT_AZIMUTH] = theta
        contact[K_X], contact[K_Y], contact[K_Z] = r * math.cos(theta), r * math.sin(theta), 0.0
    else:
        kind = int(ONE_EDGE) if pair == EDGE_EDGE else int(ONE_PLANE) if pair == EDGE_SURFACE else int(ONE_THREAD)
        edge = Edge(work.bolt_motion, bolt, nut, work.bolt_kept, work.path, work.wide)
        found, theta, time = follow_edge_point(kind, guess[G_BOLT_AZIMUTH], tau, edge, work)
        contact[K_BOLT_AZIMUTH] = theta
        contact[K_NUT_AZIMUTH] = math.atan2(jet[J_Y], jet[J_X])
        contact[K_X], contact[K_Y], contact[K_Z] = jet[J_X], jet[J_Y], jet[J_Z]
    contact[K_TIME] = time
    return found and 0.0 < time <= limit


@kernel()
def earliest_guess(
    stage: int,
    pose: Array,
    point: Array,
    axis: Array,
    known: Array,
    limit: float,
    guesses: Array,
    bolt: Array,
    nut: Array,
    work: Work,
    contact: Array,
) -> bool:
    """Sets the earliest contact of a stage among those near its guesses; False where there is none.

    ``known`` are the contacts of the stages before.
    """
    is_turn = stage > 1
    set_motions(pose, is_turn, axis_in_both_planes(known, stage - 1), point, axis, work.bolt_motion, work.nut_motion)
    bolt_edge = Edge(work.bolt_motion, bolt, nut, work.bolt_kept, work.path, work.wide)
    nut_edge = Edge(work.nut_motion, nut, bolt, work.nut_kept, work.path, work.wide)
    keep_contacts(known, stage - 1, pose, bolt_edge, nut_edge)
    one = scratch(CONTACT_SIZE)
    contact[K_TIME] = math.inf
    for i in range(GUESSES):
        if guesses[i, G_STAGE] != stage:
            continue
        tau = guesses[i, G_TIME] if is_turn else pose[11] - guesses[i, G_TIME]
        if not follow_guess(guesses[i], tau, limit, bolt, nut, work, one):
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
