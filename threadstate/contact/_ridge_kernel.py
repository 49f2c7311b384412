"""Thread on thread along the ridges of phi over the bolt's thread: a search, not a proof.

At instants of a motion phi has ridges over the part of the bolt's thread below the nut's surface, where its slope B
along the axis falls through zero; where the slope A along the helix falls through zero along a ridge, phi has a
maximum (``_tangency_kernel`` defines A and B). It is followed through time to where phi vanishes there.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import TWO_PI, stride
from threadstate.contact._ridge_grid_kernel import (
    CROSSINGS_SIZE,
    GRID_SIZE,
    LANES,
    MOST_AZIMUTHS,
    MOST_CROSSINGS,
    MOST_PIECES,
    list_crossings,
    list_maxima,
    set_columns,
    set_crossings,
    set_slopes,
    set_tops,
)
from threadstate.contact._sweep_kernel import E_THETA, E_TIME, E_Z
from threadstate.contact._tangency_kernel import (
    J_A,
    J_B,
    J_PHI,
    J_RATE,
    J_UT,
    J_UU,
    J_UZ,
    J_Z,
    J_ZT,
    J_ZZ,
    JET_SIZE,
    S_OFF,
    S_ROT,
    STANDING_SIZE,
    polish,
    set_jet,
    set_standing,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

SLICE = math.radians(1.5)
LATE = math.radians(38.0)
LATE_SLICE = math.radians(0.2)
"""Beyond ``LATE`` maxima of phi are narrow, and come and go within tenths of a degree; all azimuths are used there.

Angles (rad) of a turn; of a translation, parts of its ``stride``.
"""
FOLLOW = math.radians(0.5)
APART = 0.06
"""Crossings of neighbouring columns that are farther apart than this part of a pitch belong to two ridges."""
ALOFT = 0.1
"""The same where phi differs by more than this part of a pitch, beyond what its slopes explain."""
STEP_UP = 0.02
STEP_UP_PITCHES = 0.004
MOST_STEPS_UP = 8
"""Steps along a ridge (rad) and towards it (thread pitches) where Newton's method does not lead up; and how many."""
ALONG = 24
"""Points of an azimuth, beside its ends, at which the bolt's thread is looked at for overlaps that go on beyond it."""
WORTH = 3.0 * SLICE
"""A maximum of phi that by its rate is farther than this from zero is left to the slices nearer to it."""


@kernel()
def settle(
    theta: float, z: float, worth: float, standing: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, float, bool]:
    """The highest point of phi on the thread near (theta, z) where the bolt stands (A = B = 0), by Newton's method.

    Where phi bends upwards the way is up by short steps, at most ``MOST_STEPS_UP``: along the axis to the ridge (where
    curvatures jump, a place between two crossings may be beside it), and then along the ridge. That is done only where
    phi rises, and by its rate vanishes within ``worth`` of the motion.
    """
    k = bolt[pk.P] / TWO_PI
    p = bolt[pk.P]
    up = 0
    set_jet(theta, z, standing, bolt, nut, jet)
    for _ in range(20):
        a, b = jet[J_A], jet[J_B]
        uu, uz, zz = jet[J_UU], jet[J_UZ], jet[J_ZZ]
        det = uu * zz - uz * uz
        if zz < 0.0 and det > 0.0:
            du = min(max((uz * b - zz * a) / det, -0.1), 0.1)
            dz = (uz * a - uu * b) / det
        else:
            up += 1
            if up > MOST_STEPS_UP or abs(jet[J_PHI]) >= worth * jet[J_RATE]:
                return theta, z, False
            if zz < 0.0:
                du = STEP_UP if a * zz < uz * b else -STEP_UP
                dz = -(b + uz * du) / zz
            else:
                du = 0.0
                dz = math.copysign(STEP_UP_PITCHES * p, b)
        dz = min(max(dz, -0.02 * p), 0.02 * p)
        theta += du
        z += k * du + dz
        set_jet(theta, z, standing, bolt, nut, jet)
        if abs(du) < 1e-4 and abs(dz) < 1e-4 * p:
            return theta, z, True
    return theta, z, False


@kernel()
def follow(
    theta: float,
    z: float,
    tau: float,
    limit: float,
    motion: Array,
    bolt: Array,
    nut: Array,
    standing: Array,
    moved: Array,
    jet: Array,
    found: Array,
    count: int,
) -> int:
    """Follows a highest point of phi through time to where phi vanishes there, in steps of at most ``FOLLOW``.

    ``standing`` is where the bolt stands at ``tau``; ``moved`` and ``jet`` are scratch. Returns the number of contacts
    found.
    """
    k = bolt[pk.P] / TWO_PI
    p = bolt[pk.P]
    step = stride(motion, bolt)
    farthest = FOLLOW * step
    start = tau
    for i in range(60):
        if i > 0:
            set_standing(motion, tau, moved)
        theta, z, settled = settle(theta, z, 2.0 * WORTH * step, standing if i == 0 else moved, bolt, nut, jet)
        if not settled or z < -0.05 * p or jet[J_Z] > 0.05 * p or jet[J_RATE] <= 0.0:
            return count
        move = -jet[J_PHI] / jet[J_RATE]
        if abs(tau + move - start) > WORTH * step:
            return count
        if abs(move) < 1e-6 * step:
            return polish(theta, z, tau + move, limit, motion, bolt, nut, moved, jet, found, count)
        move = min(max(move, -farthest), farthest)
        tau += move
        if tau <= 0.0 or tau > limit + farthest:
            return count
        # The maximum moves along with time such that A and B stay zero.
        det = jet[J_UU] * jet[J_ZZ] - jet[J_UZ] * jet[J_UZ]
        du = move * (jet[J_UZ] * jet[J_ZT] - jet[J_ZZ] * jet[J_UT]) / det
        dz = move * (jet[J_UZ] * jet[J_UT] - jet[J_UU] * jet[J_ZT]) / det
        theta += du
        z += k * du + dz
    return count


@kernel()
def columns_below(standing: Array, azimuths: int, bolt: Array) -> tuple[int, int]:
    """The first column, and how many, of all those that may have a point of the bolt below the nut's surface."""
    x, y, up = standing[S_ROT + 6], standing[S_ROT + 7], standing[S_ROT + 8]
    lowest = standing[S_OFF + 2] + min(0.0, up * bolt[pk.P])
    tilt = math.sqrt(x * x + y * y)
    reach = tilt * bolt[pk.R_MAJOR if lowest > 0.0 else pk.R_MINOR]
    if lowest >= reach:
        return 0, 0
    if lowest <= -reach:
        return 0, azimuths + 1
    per_step = azimuths / TWO_PI
    half = math.acos(lowest / reach) * per_step
    middle = math.atan2(-y, -x) * per_step + azimuths
    first = math.ceil(middle - half)
    return first % azimuths, min(math.floor(middle + half) - first, azimuths) + 1


@kernel()
def highest_places(
    azimuths: int, standing: Array, bolt: Array, nut: Array, grid: Array, crossings: Array, maxima: Array
) -> int:
    """Where phi is highest along its ridges, as (theta, z), where the bolt stands; returns the number of ``maxima``."""
    first, columns = columns_below(standing, azimuths, bolt)
    if columns == 0:
        return 0
    lanes = (columns + LANES - 1) // LANES * LANES
    highest = set_tops(first, lanes, standing, bolt, grid)
    pieces = min(1 + int(highest / bolt[pk.P] * MOST_PIECES), MOST_PIECES)
    set_slopes(pieces, first, lanes, azimuths, standing, bolt, nut, grid)
    listed = list_crossings(first, columns, pieces, azimuths, grid, crossings)
    if listed == 0:
        return 0
    set_crossings(listed, standing, bolt, nut, crossings)
    places = list_maxima(
        listed,
        bolt[pk.P] / azimuths,
        TWO_PI / azimuths,
        APART * bolt[pk.P],
        ALOFT * bolt[pk.P],
        crossings,
        maxima,
    )
    for j in range(places):
        if maxima[j, 0] >= TWO_PI:
            maxima[j, 0] -= TWO_PI
    return places


@kernel()
def thread_inside(
    motion: Array, shallow: float, azimuths: int, bolt: Array, nut: Array
) -> tuple[bool, float, float, float]:
    """A point of the bolt's thread, in its frame, that is inside the nut by more than ``shallow`` before a motion.

    The highest points of phi are looked at and, as an overlap may go on beyond the bolt's top or the nut's bottom,
    points all over the thread.
    """
    grid = np.empty(GRID_SIZE)
    standing = np.empty(STANDING_SIZE)
    jet = np.empty(JET_SIZE)
    crossings = np.empty(CROSSINGS_SIZE)
    maxima = np.empty((MOST_CROSSINGS, 2))
    set_columns(azimuths, bolt, grid)
    set_standing(motion, 0.0, standing)
    p = bolt[pk.P]
    deepest, at_theta, at_z = shallow, 0.0, 0.0
    for i in range(2 * azimuths):
        for j in range(ALONG + 1):
            theta, z = math.pi * i / azimuths, p * j / ALONG
            set_jet(theta, z, standing, bolt, nut, jet)
            depth = min(jet[J_PHI], -jet[J_Z], p + jet[J_Z])
            if depth > deepest:
                deepest, at_theta, at_z = depth, theta, z
    if deepest == shallow:
        for j in range(highest_places(azimuths, standing, bolt, nut, grid, crossings, maxima)):
            theta, z, settled = settle(maxima[j, 0], maxima[j, 1], 0.0, standing, bolt, nut, jet)
            depth = min(jet[J_PHI], -jet[J_Z], p + jet[J_Z])
            if settled and depth > deepest and 0.0 <= z <= p:
                deepest, at_theta, at_z = depth, theta, z
    if deepest == shallow:
        return False, 0.0, 0.0, 0.0
    r = pk.radius(at_z - p / TWO_PI * at_theta, bolt)
    return True, r * math.cos(at_theta), r * math.sin(at_theta), at_z


@kernel()
def ridges(motion: Array, bolt: Array, nut: Array, limit: float, azimuths: int, found: Array) -> int:
    """Contacts of thread with thread along a motion before ``limit``, earliest first; returns their number.

    ``motion`` is the bolt's, seen from the nut; ``azimuths``, ``MOST_AZIMUTHS`` at the most, is a resolution and not a
    bound: docs/decisions/0001-contacts.md says how it was checked.
    """
    step = stride(motion, bolt)
    late = LATE * step
    early = min(limit, late)
    count = between(0.0, early, 1 + int(early / (SLICE * step)), azimuths, motion, bolt, nut, limit, found, 0)
    if limit > late:
        slices = 1 + int((limit - late) / (LATE_SLICE * step))
        count = between(late, limit, slices, MOST_AZIMUTHS, motion, bolt, nut, limit, found, count)
    return count


@kernel()
def between(
    start: float,
    end: float,
    slices: int,
    azimuths: int,
    motion: Array,
    bolt: Array,
    nut: Array,
    limit: float,
    found: Array,
    count: int,
) -> int:
    """Adds the contacts that the highest places lead to at so many instants after ``start``, the last at ``end``."""
    grid = np.empty(GRID_SIZE)
    standing = np.empty(STANDING_SIZE)
    jet = np.empty(JET_SIZE)
    moved = np.empty(STANDING_SIZE)
    crossings = np.empty(CROSSINGS_SIZE)
    maxima = np.empty((MOST_CROSSINGS, 2))
    set_columns(azimuths, bolt, grid)
    for i in range(slices):
        tau = start + (end - start) * (i + 1) / slices
        set_standing(motion, tau, standing)
        for j in range(highest_places(azimuths, standing, bolt, nut, grid, crossings, maxima)):
            theta, z = maxima[j, 0], maxima[j, 1]
            count = follow(theta, z, tau, limit, motion, bolt, nut, standing, moved, jet, found, count)
    return count


@kernel()
def followed_back(
    entries: Array, limit: float, motion: Array, bolt: Array, nut: Array, found: Array, count: int
) -> int:
    """Adds the contacts from which overlaps have grown that edges come into; returns the number of contacts then.

    Where an edge is born inside, and is no contact, an overlap of the threads is open beside it: its deepest point is
    followed to the time at which it began. One that has grown from an earlier contact leads to none.
    """
    standing = np.empty(STANDING_SIZE)
    moved = np.empty(STANDING_SIZE)
    jet = np.empty(JET_SIZE)
    for i in range(1, int(entries[0, 0]) + 1):
        tau = entries[i, E_TIME]
        if tau > limit:
            continue
        set_standing(motion, tau, standing)
        count = follow(
            entries[i, E_THETA], entries[i, E_Z], tau, limit, motion, bolt, nut, standing, moved, jet, found, count
        )
    return count
