"""The least lift that frees the solids of an overlapping pose (method, section 5).

The last touch on the way up is found from above. It is the least lift if every lift below it overlaps, which a
*witness* proves: a point of one part that is inside the other, followed along the lift until it leaves by steps over
which bounds keep it inside. Nearly always the point of the last touch is a witness of all lifts below. Else witness
follows witness up the lift, until there is none: there the bolt is free, though it might meet the nut again higher up.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact import _ridge_kernel as ridge
from threadstate.contact._beside_kernel import KEPT_ROWS, KEPT_SIZE, clear
from threadstate.contact._bound_kernel import B_LIPSCHITZ, B_SECOND_DERIVATIVE, BOUNDS_SIZE, set_bounds
from threadstate.contact._branchless_kernel import larger, larger_or_nan, smaller_or_nan
from threadstate.contact._corner_kernel import deepest_corner_point
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._edge_search_kernel import INSIDE, OUTSIDE, UNDECIDED, find_inside
from threadstate.contact._geometry_kernel import (
    M_SIGMA,
    PATH_SIZE,
    TWO_PI,
    copy_numbers,
    phi_and_gradient,
    position,
    set_path,
    set_path_from,
    velocity,
)
from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    K_BOLT_AZIMUTH,
    K_NUT_AZIMUTH,
    K_PAIR,
    K_TIME,
    K_X,
    K_Y,
    K_Z,
    RESOLVED,
    RIDGE_AZIMUTHS,
    RIDGES_ONLY,
    THREAD_EDGE,
    THREAD_SURFACE,
    THREAD_THREAD,
    UNRESOLVED,
    Wanted,
    Work,
    earliest_below,
    set_vertical_motions,
)
from threadstate.contact._surface_kernel import start_height
from threadstate.contact._tangency_kernel import PLACEMENT_SIZE, set_placement
from threadstate.contact._thread_surface_kernel import deepest_lowest_point
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

LEAST_GAP = 1e-10
"""A stretch of lift without overlap is found if it is longer than this, in thread pitches."""

RETRY_OFFSET = 1e-7
"""How far above the end of the last witness the search down for a contact starts, in thread pitches."""

WITNESS_DEPTH = 1e-12
"""Least depth of a witness, in thread pitches."""

WITNESS_HALF_WIDTH = 1e-11
"""Half-width (rad) of the narrowest overlap that has a witness: where two edges cross they are deep and narrow."""

MAX_WITNESSES = 40
MAX_WITNESS_STEPS = 4000


@kernel()
def inside_until(
    path: Array, since: float, until: float, sign: float, profile: Array, sigma: float, bounds: Array
) -> float:
    """How far a point that is inside a solid at ``since`` (or enters there) is proved to stay inside, up to ``until``.

    A solid is one thread pitch long. The point moves along a straight ``path``, forwards (``sign`` 1) or backwards
    (-1); ``since``, ``until`` and the result are distances from its start. A step ends where the bounds on the
    derivatives of phi let the point leave; the search ends where one is shorter than a quarter of ``LEAST_GAP``, or
    after ``MAX_WITNESS_STEPS``.
    """
    second_derivative = bounds[B_SECOND_DERIVATIVE]
    least_step = 0.25 * LEAST_GAP * profile[pk.P]
    reached = since
    for _ in range(MAX_WITNESS_STEPS):
        left = sign * (until - reached)
        if left <= 0.0:
            return until
        x, y, z = position(path, reached, False)
        vx, vy, vz = velocity(path, reached, False)
        phi, gx, gy, gz = phi_and_gradient(x, y, z, profile, sigma)
        rate = sign * (gx * vx + gy * vy + gz * vz)
        g, g_rate = -sigma * z, -sigma * sign * vz
        known_depth = larger(0.0, phi)
        step = known_depth / bounds[B_LIPSCHITZ]
        if second_derivative < math.inf:
            root = math.sqrt(rate * rate + 2.0 * second_derivative * known_depth)
            step = larger_or_nan(
                step, (rate + root) / second_derivative if rate >= 0.0 else 2.0 * known_depth / (root - rate)
            )
        if g_rate < 0.0:
            step = smaller_or_nan(step, larger(0.0, g) / -g_rate)
        elif g_rate > 0.0:
            step = smaller_or_nan(step, larger(0.0, profile[pk.P] - g) / g_rate)
        if not step >= least_step:
            return reached
        reached += sign * min(step, left)
    return reached


@kernel()
def contact_overlaps_from(contact: Array, lift: float, bolt_edge: Edge, nut_edge: Edge, bounds: Array) -> float:
    """The least lift from which the point that touches at ``lift`` is proved to overlap up to there."""
    pair = int(contact[K_PAIR])
    if pair == THREAD_THREAD or pair == THREAD_SURFACE:
        x, y, z = contact[K_X], contact[K_Y], contact[K_Z]
        bolt_motion, path = bolt_edge.motion, bolt_edge.path
        dx, dy, dz = x - bolt_motion[9], y - bolt_motion[10], z - bolt_motion[11] - lift
        set_path_from(
            bolt_motion[0] * dx + bolt_motion[3] * dy + bolt_motion[6] * dz,
            bolt_motion[1] * dx + bolt_motion[4] * dy + bolt_motion[7] * dz,
            bolt_motion[2] * dx + bolt_motion[5] * dy + bolt_motion[8] * dz,
            bolt_motion,
            path,
        )
        set_bounds(bolt_motion, bolt_edge.curve, bolt_edge.solid, bounds)
        return inside_until(path, lift, 0.0, -1.0, bolt_edge.solid, 1.0, bounds)
    if pair == BASE_EDGE or pair == THREAD_EDGE:
        return edge_point_overlaps_from(contact[K_NUT_AZIMUTH], lift, nut_edge, bounds)
    return edge_point_overlaps_from(contact[K_BOLT_AZIMUTH], lift, bolt_edge, bounds)


@kernel()
def set_edge_point_path(theta: float, edge: Edge, bounds: Array) -> None:
    """Sets the path of the edge point at azimuth ``theta``, and the bounds of its motion."""
    r = pk.radius(-edge.curve[pk.LEAD] / TWO_PI * theta, edge.curve)
    set_path(r * math.cos(theta), r * math.sin(theta), edge.motion, edge.path)
    set_bounds(edge.motion, edge.curve, edge.solid, bounds)


@kernel()
def edge_point_overlaps_from(theta: float, lift: float, edge: Edge, bounds: Array) -> float:
    """The least lift from which the edge point that touches at ``lift`` is proved to overlap up to there."""
    set_edge_point_path(theta, edge, bounds)
    return inside_until(edge.path, lift, 0.0, -1.0, edge.solid, edge.motion[M_SIGMA], bounds)


@kernel()
def edge_point_inside_until(theta: float, high: float, edge: Edge, bounds: Array) -> float:
    """The lift up to which an edge point that is inside is proved to stay inside."""
    set_edge_point_path(theta, edge, bounds)
    return inside_until(edge.path, 0.0, high, 1.0, edge.solid, edge.motion[M_SIGMA], bounds)


@kernel()
def find_witness(pose: Array, lift: float, high: float, bolt: Array, nut: Array, work: Work) -> tuple[int, float]:
    """Whether a point overlaps at ``lift`` (INSIDE, OUTSIDE or UNDECIDED), and the lift up to which it does."""
    bounds = scratch(BOUNDS_SIZE)
    kept, bolt_path, nut_path = scratch(KEPT_ROWS, KEPT_SIZE), scratch(PATH_SIZE), scratch(PATH_SIZE)
    clear(kept)
    bolt_edge = Edge(work.bolt_motion, bolt, nut, kept, bolt_path, scratch(0, 2))
    nut_edge = Edge(work.nut_motion, nut, bolt, kept, nut_path, scratch(0, 2))
    raised = scratch(12)
    set_raised(pose, lift, raised)
    left = high - lift
    set_vertical_motions(raised, 1.0, work.bolt_motion, work.nut_motion)
    outcome, theta = find_inside(bolt_edge, WITNESS_DEPTH, WITNESS_HALF_WIDTH, work.boxes, work.queue)
    if outcome == INSIDE:
        return INSIDE, lift + edge_point_inside_until(theta, left, bolt_edge, bounds)
    nut_outcome, theta = find_inside(nut_edge, WITNESS_DEPTH, WITNESS_HALF_WIDTH, work.boxes, work.queue)
    if nut_outcome == INSIDE:
        return INSIDE, lift + edge_point_inside_until(theta, left, nut_edge, bounds)
    if outcome == UNDECIDED or nut_outcome == UNDECIDED:
        return UNDECIDED, lift
    motion, path = bolt_edge.motion, bolt_edge.path
    inside, x, y, z = ridge.deepest_thread_point(motion, WITNESS_DEPTH * bolt[pk.P], RIDGE_AZIMUTHS, bolt, nut)
    if not inside:
        return OUTSIDE, lift
    set_path_from(x, y, z, motion, path)
    set_bounds(motion, bolt, nut, bounds)
    return INSIDE, lift + inside_until(path, 0.0, left, 1.0, nut, 1.0, bounds)


@kernel()
def set_raised(pose: Array, lift: float, raised: Array) -> None:
    """Sets a pose to another one that is higher."""
    copy_numbers(pose, raised)
    raised[11] += lift


@kernel()
def crests_overlap(pose: Array, lift: float, bolt: Array, nut: Array, work: Work) -> bool:
    """Whether a crest is found inside the other part at ``lift``: its corner, or the bolt's lowest in the nut."""
    bolt_motion = work.bolt_motion
    placement = scratch(PLACEMENT_SIZE)
    set_vertical_motions(pose, 1.0, bolt_motion, work.nut_motion)
    set_placement(bolt_motion, lift, placement)
    depth, _, _ = deepest_corner_point(placement, bolt, nut)
    lowest_depth, _, _ = deepest_lowest_point(placement, bolt, nut)
    return max(depth, lowest_depth) > WITNESS_DEPTH * bolt[pk.P]


@kernel()
def contact_below(
    pose: Array,
    lift: float,
    reach: float,
    tie_tolerance: float,
    bolt: Array,
    nut: Array,
    work: Work,
    found: Array,
) -> tuple[int, float, int]:
    """The greatest lift below ``lift``, by no more than ``reach``, at which an overlap begins as the bolt comes down.

    Returns how many contacts are ``found``, that lift (``lift - reach``: none) and a status.
    """
    raised = scratch(12)
    set_raised(pose, lift, raised)
    wanted = Wanted(reach, tie_tolerance, RIDGES_ONLY)
    count, status, best = earliest_below(raised, wanted, bolt, nut, work, found)
    first = min(best, found[0, K_TIME]) if count > 0 else best
    return count, lift - min(first, reach), status


@kernel()
def least_lift(
    pose: Array, tie_tolerance: float, bolt: Array, nut: Array, work: Work, found: Array
) -> tuple[float, int]:
    """The least lift after which the solids of an overlapping pose do not overlap, and a status.

    Every lift below it is proved to overlap, but for stretches shorter than ``RETRY_OFFSET`` thread pitches. Threads
    whose touch on the way down was missed still overlap just above it; from there witness follows witness.
    """
    height = start_height(pose, bolt) - pose[11]
    if height <= 0.0:
        return 0.0, RESOLVED
    lift, status = lift_to_last_touch(pose, height, tie_tolerance, bolt, nut, work, found)
    above = lift + RETRY_OFFSET * bolt[pk.P]
    if status != RESOLVED or not crests_overlap(pose, above, bolt, nut, work):
        return lift, status
    return climb_witnesses(pose, above, height, height, height, tie_tolerance, bolt, nut, work, found)


@kernel()
def lift_to_last_touch(
    pose: Array,
    height: float,
    tie_tolerance: float,
    bolt: Array,
    nut: Array,
    work: Work,
    found: Array,
) -> tuple[float, int]:
    """The least lift as the touches found on the way down from ``height`` have it, and a status."""
    count, last, status = contact_below(pose, height, height, tie_tolerance, bolt, nut, work, found)
    if last <= 1e-8 * bolt[pk.P]:
        return 0.0, status
    proved_from = last
    if count > 0 and height - found[0, K_TIME] >= last:
        set_vertical_motions(pose, 1.0, work.bolt_motion, work.nut_motion)
        kept, path, bounds = scratch(KEPT_ROWS, KEPT_SIZE), scratch(PATH_SIZE), scratch(BOUNDS_SIZE)
        clear(kept)
        bolt_edge = Edge(work.bolt_motion, bolt, nut, kept, path, scratch(0, 2))
        nut_edge = Edge(work.nut_motion, nut, bolt, kept, path, scratch(0, 2))
        proved_from = contact_overlaps_from(found[0], last, bolt_edge, nut_edge, bounds)
    if proved_from <= 0.0 or status != RESOLVED:
        return last, status
    return climb_witnesses(pose, 0.0, proved_from, last, height, tie_tolerance, bolt, nut, work, found)


@kernel()
def climb_witnesses(
    pose: Array,
    lift: float,
    proved_from: float,
    last: float,
    height: float,
    tie_tolerance: float,
    bolt: Array,
    nut: Array,
    work: Work,
    found: Array,
) -> tuple[float, int]:
    """The least lift from ``lift`` on, witness by witness; from ``proved_from`` to the ``last`` touch all overlap."""
    near = LEAST_GAP * bolt[pk.P]
    for _ in range(MAX_WITNESSES):
        if lift >= proved_from:
            return last, RESOLVED
        outcome, reached = find_witness(pose, lift, height, bolt, nut, work)
        if outcome == UNDECIDED:
            return last, UNRESOLVED
        if outcome == OUTSIDE:
            if lift == 0.0:
                return 0.0, RESOLVED
            # Free, but for an overlap too thin for a witness: its end is found by a search down from a little above.
            outcome, _ = find_witness(pose, lift + RETRY_OFFSET * bolt[pk.P], height, bolt, nut, work)
            beyond = RETRY_OFFSET * bolt[pk.P] if outcome == OUTSIDE else 4.0 * near
            _, end, status = contact_below(
                pose, lift + beyond, beyond + 4.0 * near, tie_tolerance, bolt, nut, work, found
            )
            return end, status
        lift = reached + near
    return lowest_free_contact(pose, lift, last, height, tie_tolerance, bolt, nut, work, found)


@kernel()
def lowest_free_contact(
    pose: Array,
    lift: float,
    last: float,
    height: float,
    tie_tolerance: float,
    bolt: Array,
    nut: Array,
    work: Work,
    found: Array,
) -> tuple[float, int]:
    """The lowest touch above ``lift`` over which the bolt is free, where overlaps are too thin for witnesses.

    The least lift is one at which an overlap begins on the way down: each of those is examined. Where one of them is
    undecided the result is UNRESOLVED: no pose is known at which that happens.
    """
    near = LEAST_GAP * bolt[pk.P]
    least_step = last
    contact_lift = last
    for _ in range(MAX_WITNESSES):
        start = contact_lift - near
        if start <= lift:
            return least_step, RESOLVED
        _, contact_lift, status = contact_below(pose, start, start - lift, tie_tolerance, bolt, nut, work, found)
        if status != RESOLVED:
            break
        if contact_lift <= lift:
            return least_step, RESOLVED
        outcome, _ = find_witness(pose, contact_lift + near, height, bolt, nut, work)
        if outcome == UNDECIDED:
            break
        if outcome == OUTSIDE:
            least_step = contact_lift
    return least_step, UNRESOLVED
