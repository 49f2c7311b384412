"""What is certain of a pose: that bolt and nut do not overlap, by bounds along both edges and a search of the
threads.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._beside_kernel import KEPT_SIZE, clear, keep
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._edge_search_kernel import OUTSIDE, find_inside
from threadstate.contact._geometry_kernel import PATH_SIZE, copy_numbers
from threadstate.contact._ridge_grid_kernel import (
    CROSSINGS_SIZE,
    GRID_SIZE,
    MAX_AZIMUTHS,
    MAX_CROSSINGS,
    set_columns,
)
from threadstate.contact._ridge_kernel import deepest_thread_point, ridge_maxima
from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    EDGE_EDGE,
    RIDGE_AZIMUTHS,
    THREAD_EDGE,
    THREAD_THREAD,
    Work,
    set_vertical_motions,
)
from threadstate.contact._tangency_kernel import PLACEMENT_SIZE, TANGENCY_JET_SIZE, TJ_PHI, TJ_Z
from threadstate.contact._wide_kernel import POSE_SIZE
from threadstate.device._gap_kernel import G_PAIR, G_POINT, G_THETA
from threadstate.device._places_kernel import MAX_PITCHES, MAX_PLACES
from threadstate.device._thread_maximum_kernel import thread_maximum
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

NARROW = 2e-8
"""Half-width (rad) of an overlap along an edge that is not distinguished from a contact: at most as deep as this times
the nominal radius times the lesser slope of g and phi, some 1e-10 in on 1/4-20."""

FINE_AZIMUTHS = MAX_AZIMUTHS
"""Azimuths of the bolt's thread on which its ridges are searched."""

PLACES_ROWS = 1 + MAX_PLACES
"""Rows of a list of earlier contacts with room for every place."""

FREE, EDGE_INSIDE, THREAD_INSIDE = range(3)


@kernel()
def overlap(pose: Array, limit: float, count: int, places: Array, bolt: Array, nut: Array, stage: Work) -> int:
    """Whether the parts overlap at a pose by more than ``limit`` (a length), beside the places at which they touch."""
    by_bolt, by_nut, path = scratch(PLACES_ROWS, KEPT_SIZE), scratch(PLACES_ROWS, KEPT_SIZE), scratch(PATH_SIZE)
    clear(by_bolt)
    clear(by_nut)
    on_bolt = Edge(stage.bolt_motion, bolt, nut, by_bolt, path, scratch(0, 2))
    on_nut = Edge(stage.nut_motion, nut, bolt, by_nut, path, scratch(0, 2))
    for i in range(count):
        pair = int(places[i, G_PAIR])
        if pair != BASE_EDGE and pair != THREAD_EDGE and pair != THREAD_THREAD:
            keep(places[i, G_THETA], False, False, by_bolt)
        if pair == BASE_EDGE or pair == THREAD_EDGE:
            keep(places[i, G_THETA], False, False, by_nut)
        elif pair == EDGE_EDGE:
            keep(math.atan2(places[i, G_POINT + 1], places[i, G_POINT]), False, False, by_nut)
    set_vertical_motions(pose, -1.0, stage.bolt_motion, stage.nut_motion)
    shallow = limit / bolt[pk.P]
    outcome, _ = find_inside(on_bolt, shallow, NARROW, stage.boxes, stage.queue)
    if outcome != OUTSIDE:
        return EDGE_INSIDE
    outcome, _ = find_inside(on_nut, shallow, NARROW, stage.boxes, stage.queue)
    if outcome != OUTSIDE:
        return EDGE_INSIDE
    return THREAD_INSIDE if threads_overlap(pose, limit, stage.bolt_motion, stage.nut_motion, bolt, nut) else FREE


@kernel()
def threads_overlap(pose: Array, limit: float, bolt_motion: Array, nut_motion: Array, bolt: Array, nut: Array) -> bool:
    """Whether a search finds the threads to overlap by more than ``limit``; the motions are scratch.

    The search covers a thread pitch of each part: of deeper ones each pitch of the bolt is searched with each of the
    nut beside it, as the same threads moved along their axes.
    """
    p = bolt[pk.P]
    reach = bolt[pk.R_MAJOR] * math.hypot(pose[6], pose[7])
    moved = scratch(12)
    copy_numbers(pose, moved)
    turn = 0
    while pose[11] + turn * p * pose[8] < reach and turn < MAX_PITCHES:
        low = pose[11] + turn * p * pose[8] - reach
        high = pose[11] + (turn + 1) * p * pose[8] + reach
        for nut_turn in range(MAX_PITCHES + 1):
            if low > -nut_turn * p or high < -(nut_turn + 1) * p:
                continue
            for i in range(3):
                moved[9 + i] = pose[9 + i] + turn * p * pose[3 * i + 2] + (nut_turn * p if i == 2 else 0.0)
            set_vertical_motions(moved, -1.0, bolt_motion, nut_motion)
            inside, _, _, _ = deepest_thread_point(bolt_motion, limit, RIDGE_AZIMUTHS, bolt, nut)
            if inside or ridge_is_inside(moved, limit, bolt, nut):
                return True
        turn += 1
    return False


@kernel()
def ridge_is_inside(pose: Array, limit: float, bolt: Array, nut: Array) -> bool:
    """Whether a maximum of phi along its ridges, sampled more finely than on the way, is above ``limit``."""
    grid, crossings, maxima = scratch(GRID_SIZE), scratch(CROSSINGS_SIZE), scratch(MAX_CROSSINGS, 2)
    placement, jet = scratch(PLACEMENT_SIZE), scratch(TANGENCY_JET_SIZE)
    for i in range(PLACEMENT_SIZE):
        placement[i] = pose[i] if i < POSE_SIZE else 0.0
    set_columns(FINE_AZIMUTHS, bolt, grid)
    for j in range(ridge_maxima(FINE_AZIMUTHS, placement, bolt, nut, grid, crossings, maxima)):
        _, z, _ = thread_maximum(maxima[j, 0], maxima[j, 1], 0.0, -math.inf, placement, bolt, nut, jet)
        if min(jet[TJ_PHI], -jet[TJ_Z], z) > limit:
            return True
    return False
