"""The least lift that frees the solids of an overlapping pose (method, section 5).

The last touch on the way up is found from above. It is the least lift if every lift below it overlaps, which a
*witness* proves: a point of one part that is inside the other, followed along the lift until it leaves by steps over
which bounds keep it inside. Nearly always the point of the last touch is one all the way. Else the lift is climbed from
witness to witness, until there is none: there the bolt is free, though it might meet the nut again higher up.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact import _ridge_kernel as ridge
from threadstate.contact._bound_kernel import B_BEND, B_LIPSCHITZ, BOUNDS_SIZE, set_bounds
from threadstate.contact._geometry_kernel import (
    M_SIGMA,
    PATH_SIZE,
    TWO_PI,
    field,
    position,
    set_path,
    set_path_from,
    velocity,
)
from threadstate.contact._lane_kernel import larger, smaller
from threadstate.contact._rest_kernel import start_height
from threadstate.contact._search_kernel import Search
from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    K_BOLT,
    K_NUT,
    K_PAIR,
    K_TIME,
    K_X,
    K_Y,
    K_Z,
    RESOLVED,
    RIDGE_AZIMUTHS,
    RIDGES_ONLY,
    THREAD_EDGE,
    THREAD_THREAD,
    UNRESOLVED,
    Work,
    set_motions,
)
from threadstate.contact._sweep_kernel import INSIDE, NOT_DECIDED, OUTSIDE, inside_at
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

NEAR = 1e-10
"""A lift over which nothing overlaps is met if it is longer than this, in thread pitches."""

FURTHER = 1e-7
"""How far above the end of the last witness the last touch is looked for from, in thread pitches."""

SHALLOW = 1e-12
"""Depth of a witness, in thread pitches."""

NARROW = 1e-11
"""Half-width (rad) of the narrowest overlap that has a witness: where two edges cross they are deep and narrow."""

MOST_WITNESSES = 40
MOST_STEPS = 4000


@kernel()
def inside_until(
    path: Array, since: float, until: float, sign: float, row: Array, sigma: float, bounds: Array
) -> float:
    """How far a point that is inside a solid at ``since`` (or enters there) stays inside, up to ``until``.

    A solid is one thread pitch long. The point moves along a straight ``path``, forwards (``sign`` 1) or backwards
    (-1); ``since``, ``until`` and the result are distances from its start. A step ends where the bounds on the
    derivatives of phi let the point leave; the search ends where one is shorter than a quarter of ``NEAR``.
    """
    bend = bounds[B_BEND]
    least = 0.25 * NEAR * row[pk.P]
    reached = since
    for _ in range(MOST_STEPS):
        left = sign * (until - reached)
        if left <= 0.0:
            return until
        x, y, z = position(path, reached, False)
        vx, vy, vz = velocity(path, reached, False)
        phi, gx, gy, gz = field(x, y, z, row, sigma)
        rate = sign * (gx * vx + gy * vy + gz * vz)
        g, g_rate = -sigma * z, -sigma * sign * vz
        floor = larger(phi, 0.0)
        step = floor / bounds[B_LIPSCHITZ]
        if bend < math.inf:
            root = math.sqrt(rate * rate + 2.0 * bend * floor)
            step = larger(step, (rate + root) / bend if rate >= 0.0 else 2.0 * floor / (root - rate))
        if g_rate < 0.0:
            step = smaller(step, larger(g, 0.0) / -g_rate)
        elif g_rate > 0.0:
            step = smaller(step, larger(row[pk.P] - g, 0.0) / g_rate)
        if not step >= least:
            return reached
        reached += sign * min(step, left)
    return reached


@kernel()
def overlaps_from(
    contact: Array,
    lift: float,
    bolt_walks: Array,
    nut_walks: Array,
    bolt: Array,
    nut: Array,
    bounds: Array,
    path: Array,
) -> float:
    """The least lift from which the point that touches at ``lift`` overlaps all the way up to there."""
    pair = int(contact[K_PAIR])
    if pair == THREAD_THREAD:
        x, y, z = contact[K_X], contact[K_Y], contact[K_Z]
        dx, dy, dz = x - bolt_walks[9], y - bolt_walks[10], z - bolt_walks[11] - lift
        set_path_from(
            bolt_walks[0] * dx + bolt_walks[3] * dy + bolt_walks[6] * dz,
            bolt_walks[1] * dx + bolt_walks[4] * dy + bolt_walks[7] * dz,
            bolt_walks[2] * dx + bolt_walks[5] * dy + bolt_walks[8] * dz,
            bolt_walks,
            path,
        )
        set_bounds(bolt_walks, bolt, nut, bounds)
        return inside_until(path, lift, 0.0, -1.0, nut, 1.0, bounds)
    if pair == BASE_EDGE or pair == THREAD_EDGE:
        return walker_from(contact[K_NUT], lift, nut_walks, nut, bolt, bounds, path)
    return walker_from(contact[K_BOLT], lift, bolt_walks, bolt, nut, bounds, path)


@kernel()
def walker_from(
    theta: float, lift: float, motion: Array, row_c: Array, row_s: Array, bounds: Array, path: Array
) -> float:
    """The least lift from which a point of an edge curve that touches at ``lift`` overlaps all the way up to there."""
    place_walker(theta, motion, row_c, path)
    set_bounds(motion, row_c, row_s, bounds)
    return inside_until(path, lift, 0.0, -1.0, row_s, motion[M_SIGMA], bounds)


@kernel()
def place_walker(theta: float, motion: Array, row_c: Array, path: Array) -> None:
    """The path of the point of an edge curve at azimuth ``theta``."""
    r = pk.radius(-row_c[pk.P] / TWO_PI * theta, row_c)
    set_path(r * math.cos(theta), r * math.sin(theta), motion, path)


@kernel()
def walker_until(
    theta: float, high: float, motion: Array, row_c: Array, row_s: Array, bounds: Array, path: Array
) -> float:
    """The lift up to which a point of an edge curve that is inside stays inside."""
    place_walker(theta, motion, row_c, path)
    set_bounds(motion, row_c, row_s, bounds)
    return inside_until(path, 0.0, high, 1.0, row_s, motion[M_SIGMA], bounds)


@kernel()
def witness(pose: Array, lift: float, high: float, bolt: Array, nut: Array, work: Work) -> tuple[int, float]:
    """Whether a point overlaps at ``lift`` (INSIDE, OUTSIDE or NOT_DECIDED), and the lift up to which it does."""
    boxes, others, _, _, bolt_walks, nut_walks, _, _, _ = work
    bounds = np.empty(BOUNDS_SIZE)
    path = np.empty(PATH_SIZE)
    none = np.empty(0)
    raised = pose.copy()
    raised[11] += lift
    left = high - lift
    up = np.array([0.0, 0.0, 1.0])
    set_motions(raised, False, False, up, up, bolt_walks, nut_walks)
    said, theta = inside_at(bolt_walks, bolt, nut, none, 0, SHALLOW, NARROW, boxes, others)
    if said == INSIDE:
        return INSIDE, lift + walker_until(theta, left, bolt_walks, bolt, nut, bounds, path)
    of_nut, theta = inside_at(nut_walks, nut, bolt, none, 0, SHALLOW, NARROW, boxes, others)
    if of_nut == INSIDE:
        return INSIDE, lift + walker_until(theta, left, nut_walks, nut, bolt, bounds, path)
    if said == NOT_DECIDED or of_nut == NOT_DECIDED:
        return NOT_DECIDED, lift
    inside, x, y, z = ridge.thread_inside(bolt_walks, SHALLOW * bolt[pk.P], RIDGE_AZIMUTHS, bolt, nut)
    if not inside:
        return OUTSIDE, lift
    set_path_from(x, y, z, bolt_walks, path)
    set_bounds(bolt_walks, bolt, nut, bounds)
    return INSIDE, lift + inside_until(path, 0.0, left, 1.0, nut, 1.0, bounds)


@kernel()
def touch_below(
    pose: Array,
    lift: float,
    reach: float,
    slack: float,
    bolt: Array,
    nut: Array,
    search: Search,
    work: Work,
    found: Array,
) -> tuple[int, float, int]:
    """The greatest lift below ``lift``, by no more than ``reach``, at which an overlap begins as the bolt comes down.

    Returns how many contacts are ``found``, that lift (``lift - reach``: none) and a status.
    """
    down = np.array([0.0, 0.0, -1.0])
    raised = pose.copy()
    raised[11] += lift
    count, status, best = search(raised, False, down, down, found, 0, reach, slack, bolt, nut, RIDGES_ONLY, work, found)
    first = min(best, found[0, K_TIME]) if count > 0 else best
    return count, lift - min(first, reach), status


@kernel()
def least_lift(
    pose: Array, slack: float, bolt: Array, nut: Array, search: Search, work: Work, found: Array
) -> tuple[float, int]:
    """The least lift after which the solids of an overlapping pose do not overlap, and a status.

    Every lift below it is proved to overlap, but for stretches shorter than ``FURTHER`` thread pitches.
    """
    height = start_height(pose, bolt) - pose[11]
    if height <= 0.0:
        return 0.0, RESOLVED
    count, last, status = touch_below(pose, height, height, slack, bolt, nut, search, work, found)
    if last <= 1e-8 * bolt[pk.P]:
        return 0.0, status
    enough = last
    if count > 0 and height - found[0, K_TIME] >= last:
        _, _, _, _, bolt_walks, nut_walks, _, _, _ = work
        up = np.array([0.0, 0.0, 1.0])
        set_motions(pose, False, False, up, up, bolt_walks, nut_walks)
        enough = overlaps_from(
            found[0], last, bolt_walks, nut_walks, bolt, nut, np.empty(BOUNDS_SIZE), np.empty(PATH_SIZE)
        )
    if enough <= 0.0 or status != RESOLVED:
        return last, status
    return climbed(pose, enough, last, height, slack, bolt, nut, search, work, found)


@kernel()
def climbed(
    pose: Array,
    enough: float,
    last: float,
    height: float,
    slack: float,
    bolt: Array,
    nut: Array,
    search: Search,
    work: Work,
    found: Array,
) -> tuple[float, int]:
    """The least lift, climbed to from witness to witness; from ``enough`` up to the ``last`` touch all overlaps."""
    near = NEAR * bolt[pk.P]
    lift = 0.0
    for _ in range(MOST_WITNESSES):
        if lift >= enough:
            return last, RESOLVED
        said, reached = witness(pose, lift, height, bolt, nut, work)
        if said == NOT_DECIDED:
            return last, UNRESOLVED
        if said == OUTSIDE:
            if lift == 0.0:
                return 0.0, RESOLVED
            # Free, but for an overlap too thin for a witness: its end is found from a little above.
            said, _ = witness(pose, lift + FURTHER * bolt[pk.P], height, bolt, nut, work)
            beyond = FURTHER * bolt[pk.P] if said == OUTSIDE else 4.0 * near
            _, end, status = touch_below(
                pose, lift + beyond, beyond + 4.0 * near, slack, bolt, nut, search, work, found
            )
            return end, status
        lift = reached + near
    return lowest_free_touch(pose, lift, last, height, slack, bolt, nut, search, work, found)


@kernel()
def lowest_free_touch(
    pose: Array,
    lift: float,
    last: float,
    height: float,
    slack: float,
    bolt: Array,
    nut: Array,
    search: Search,
    work: Work,
    found: Array,
) -> tuple[float, int]:
    """The lowest touch above ``lift`` over which the bolt is free, where overlaps are too thin to be climbed.

    The least lift is one at which an overlap begins on the way down: all of those are looked at.
    """
    near = NEAR * bolt[pk.P]
    least = last
    touch = last
    for _ in range(MOST_WITNESSES):
        start = touch - near
        if start <= lift:
            return least, RESOLVED
        _, touch, status = touch_below(pose, start, start - lift, slack, bolt, nut, search, work, found)
        if status != RESOLVED:
            break
        if touch <= lift:
            return least, RESOLVED
        said, _ = witness(pose, touch + near, height, bolt, nut, work)
        if said == NOT_DECIDED:
            break
        if said == OUTSIDE:
            least = touch
    return least, UNRESOLVED
