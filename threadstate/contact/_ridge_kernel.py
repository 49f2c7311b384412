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
from threadstate._scratch import scratch
from threadstate.contact._branchless_kernel import VECTOR_WIDTH
from threadstate.contact._corner_kernel import deepest_corner_point
from threadstate.contact._crest_crossing_kernel import CRESTS_ARRAY_SIZE, MAX_SEEDS, crest_crossings, set_crests
from threadstate.contact._edge_search_kernel import E_THETA, E_TIME, E_Z
from threadstate.contact._geometry_kernel import M_KIND, TWO_PI, motion_scale
from threadstate.contact._ridge_grid_kernel import (
    CROSSINGS_SIZE,
    GRID_SIZE,
    MAX_CROSSINGS,
    MAX_PIECES,
    list_crossings,
    list_maxima,
    locate_crossings,
    set_columns,
    set_slopes,
    set_tops,
)
from threadstate.contact._tangency_kernel import (
    PLACEMENT_OFF,
    PLACEMENT_ROT,
    PLACEMENT_SIZE,
    T_TIME,
    TANGENCY_JET_SIZE,
    TJ_A,
    TJ_B,
    TJ_PHI,
    TJ_RATE,
    TJ_UT,
    TJ_UU,
    TJ_UZ,
    TJ_Z,
    TJ_ZT,
    TJ_ZZ,
    newton_tangency,
    set_jet,
    set_placement,
)
from threadstate.contact._thread_surface_kernel import deepest_lowest_point
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

INSTANT_STEP = math.radians(1.5)
LATE_TURN = math.radians(30.0)
LATE_INSTANT_STEP = math.radians(0.2)
"""Steps between the instants at which ridges are searched for, and those of crests that cross beyond ``LATE_TURN``:
there maxima of phi are narrow, and come and go within tenths of a degree. Angles (rad) of a turn; of a translation,
multiples of its ``motion_scale``.
"""
FLANK_PART, FLANK_PART_TURN = 0.25, 0.5
"""Of the axial width of the steepest flank with its fillets, the part that a translation and a turn move a point by
between instants, at most: of steep flanks maxima of phi soon pass into another groove."""
LONG_TURN = math.radians(20.0)
BEGINNING = 2.0 * INSTANT_STEP
BEGINNING_INSTANTS, BEGINNING_AZIMUTHS = 12, 64
"""Where nothing is found in the first ``LONG_TURN`` (rad) of a turn its beginning is searched at more instants: a
maximum that rises fast there is followed back from few of the later ones, and all of these can miss it."""
MAX_FOLLOW_STEP = math.radians(0.5)
"""Largest step in time of following a maximum of phi; in the same unit."""
CROSSING_NEAR, CROSSING_RANGE = 0.05, math.radians(2.0)
"""A crossing of crests is looked at where phi, by its rate, vanishes within that much of the time, or is less than that
many thread pitches."""
MAX_Z_GAP = 0.06
"""Crossings of neighbouring columns that are farther apart than this part of a pitch belong to two ridges."""
MAX_PHI_GAP = 0.1
"""The same where phi differs by more than this part of a pitch, beyond what its slopes explain."""
ASCENT_STEP = 0.02
ASCENT_STEP_PITCHES = 0.004
MAX_ASCENT_STEPS = 8
"""Steps along a ridge (rad) and towards it (thread pitches) where Newton's method does not ascend; the most of them."""
FIRST_RIDGE_STEP, FIRST_WINDOW = 0.1, 0.06
LATER_RIDGE_STEP, LATER_WINDOW = 0.02, 0.01
MAX_RIDGE_STEPS = 5
"""Steps (rad) along a ridge, and how far across it (thread pitches), in which a maximum is bracketed where Newton's
method finds none: from where it is first looked for, and from where it is expected later; the most of them."""
FIRST_PART_OF_WINDOW = 4.0**-9
"""The part of the window about a point of a ridge in which the ridge is looked for first."""
NARROW_AZIMUTHS = 1e-11
"""A maximum is bracketed to this width (rad)."""
SETTLED_STEP, SETTLED_FILLET, LEAST_SETTLED = 1e-4, 0.05, 1e-7
"""The size of Newton's last step towards a maximum: in radians and in thread pitches, and the part of the least fillet
if that is less, down to a number of radians that round-off on a sharp corner allows."""
AXIAL_SAMPLES = 24
"""Intervals of an azimuth at whose ends the bolt's thread is sampled for overlaps that extend beyond it."""
OVERSHOOT, MAX_OVERSHOOTS = 0.25, 16
"""A step that ends before the motion begins by less than this part of the time goes half-way there instead, so often at
most: the contact may be so early that the step has passed it."""
FOLLOW_RANGE = 3.0 * INSTANT_STEP
"""A maximum of phi that by its rate reaches zero farther away in time than this is left to nearer instants."""
FAR = 1.5
"""That is known before the maximum is located where by second derivatives it is so many times as far."""


@kernel()
def nearby_maximum(
    theta: float, z: float, time_range: float, placement: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, float, bool]:
    """As :func:`maximum_from`; sets the jet there."""
    set_jet(theta, z, placement, bolt, nut, jet)
    return maximum_from(theta, z, time_range, placement, bolt, nut, jet)


@kernel()
def maximum_from(
    theta: float, z: float, time_range: float, placement: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, float, bool]:
    """The highest point of phi on the thread near (theta, z) for a placement (A = B = 0), by Newton's method.

    ``jet`` is that at (theta, z), and then that at the point that is returned. Where the Hessian of phi is not negative
    definite it ascends by short steps, at most ``MAX_ASCENT_STEPS``: along the axis to the ridge (where curvatures
    jump, a point between two crossings may be beside it), and then along the ridge. That is done only where phi rises,
    and by its rate vanishes within ``time_range``. Also returns whether it converged.
    """
    k = bolt[pk.LEAD] / TWO_PI
    p = bolt[pk.P]
    fillet = SETTLED_FILLET * min(bolt[pk.RHO_MINOR], bolt[pk.RHO_MAJOR], nut[pk.RHO_MINOR], nut[pk.RHO_MAJOR])
    settled_z = min(SETTLED_STEP * p, fillet)
    settled_theta = max(min(SETTLED_STEP, fillet / p), LEAST_SETTLED)
    ascent_steps = 0
    for _ in range(20):
        a, b = jet[TJ_A], jet[TJ_B]
        uu, uz, zz = jet[TJ_UU], jet[TJ_UZ], jet[TJ_ZZ]
        det = uu * zz - uz * uz
        if zz < 0.0 and det > 0.0:
            du = min(max((uz * b - zz * a) / det, -0.1), 0.1)
            dz = (uz * a - uu * b) / det
        else:
            ascent_steps += 1
            if ascent_steps > MAX_ASCENT_STEPS or abs(jet[TJ_PHI]) >= time_range * jet[TJ_RATE]:
                return theta, z, False
            if zz < 0.0:
                du = ASCENT_STEP if a * zz < uz * b else -ASCENT_STEP
                dz = -(b + uz * du) / zz
            else:
                du = 0.0
                dz = math.copysign(ASCENT_STEP_PITCHES * p, b)
        dz = min(max(dz, -0.02 * p), 0.02 * p)
        theta += du
        z += k * du + dz
        set_jet(theta, z, placement, bolt, nut, jet)
        if abs(du) < settled_theta and abs(dz) < settled_z:
            return theta, z, True
    return theta, z, False


@kernel()
def ridge_bracket(
    theta: float, z: float, window: float, placement: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, float, float]:
    """How far from z, up and down on an azimuth, B falls through zero between, and B at both; the distance 0: nowhere.

    The distance grows up to ``window``, so that the nearest ridge is found, however narrow it is.
    """
    w = window * FIRST_PART_OF_WINDOW
    while True:
        set_jet(theta, z - w, placement, bolt, nut, jet)
        below = jet[TJ_B]
        if below > 0.0:
            set_jet(theta, z + w, placement, bolt, nut, jet)
            if jet[TJ_B] < 0.0:
                return w, below, jet[TJ_B]
        if w >= window:
            return 0.0, 0.0, 0.0
        w *= 4.0


@kernel()
def ridge_point(
    theta: float, z: float, window: float, placement: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, bool]:
    """Where phi has a ridge near z on an azimuth: B falls through zero. Also returns whether there is one.

    It is bracketed, and then found by bisection, as at a corner B falls within the width of its fillet.
    """
    w, _, _ = ridge_bracket(theta, z, window, placement, bolt, nut, jet)
    if w == 0.0:
        return z, False
    low, high = z - w, z + w
    while True:
        middle = 0.5 * (low + high)
        set_jet(theta, middle, placement, bolt, nut, jet)
        if not low < middle < high or jet[TJ_B] == 0.0:
            return middle, True
        if jet[TJ_B] > 0.0:
            low = middle
        else:
            high = middle


@kernel()
def bracketed_maximum(
    theta: float, z: float, step: float, window: float, placement: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, float, bool]:
    """The highest point of phi along the ridge near (theta, z), by steps in azimuth uphill and then by bisection.

    Along the ridge A falls through zero there. At each azimuth the ridge is looked for within ``window`` of where the
    helix through the point before leads, or of the middle between two ridge points. Also returns whether there is a
    maximum within ``MAX_RIDGE_STEPS`` of the steps (rad).
    """
    k = bolt[pk.LEAD] / TWO_PI
    z, found = ridge_point(theta, z, window, placement, bolt, nut, jet)
    if not found:
        return theta, z, False
    uphill = math.copysign(step, jet[TJ_A])
    after, z_after = theta, z
    for _ in range(MAX_RIDGE_STEPS):
        after, z_after = theta + uphill, z + k * uphill
        z_after, found = ridge_point(after, z_after, window, placement, bolt, nut, jet)
        if not found:
            return theta, z, False
        if not jet[TJ_A] * uphill > 0.0:
            break
        theta, z = after, z_after
    if jet[TJ_A] * uphill > 0.0:
        return theta, z, False
    while True:
        middle = 0.5 * (theta + after)
        z_middle, found = ridge_point(middle, 0.5 * (z + z_after), window, placement, bolt, nut, jet)
        if not found:
            return middle, z_middle, False
        if abs(after - theta) < NARROW_AZIMUTHS:
            return middle, z_middle, True
        if jet[TJ_A] * uphill > 0.0:
            theta, z = middle, z_middle
        else:
            after, z_after = middle, z_middle


@kernel()
def is_far(jet: Array, time_range: float) -> bool:
    """Whether by its second derivatives phi has a maximum near the point of a jet from which, by its rate, it does not
    reach zero within ``time_range``.
    """
    a, b, uu, uz, zz = jet[TJ_A], jet[TJ_B], jet[TJ_UU], jet[TJ_UZ], jet[TJ_ZZ]
    det = uu * zz - uz * uz
    if not (zz < 0.0 and det > 0.0):
        return False
    rise = 0.5 * (a * (uz * b - zz * a) + b * (uz * a - uu * b)) / det
    return abs(jet[TJ_PHI] + rise) > time_range * jet[TJ_RATE]


@kernel()
def follow_maximum(
    theta: float,
    z: float,
    tau: float,
    limit: float,
    motion: Array,
    bolt: Array,
    nut: Array,
    placement: Array,
    later_placement: Array,
    jet: Array,
    found: Array,
    count: int,
) -> int:
    """Follows a highest point of phi through time to where phi vanishes there, in steps of at most ``MAX_FOLLOW_STEP``.

    ``placement`` is that of the bolt at ``tau``, ``jet`` that of the point then; ``later_placement`` is scratch, and so
    is ``jet`` afterwards. Returns the number of contacts found. A point that still moves after 60 steps is not followed
    further; known ones take far fewer.
    """
    k = bolt[pk.LEAD] / TWO_PI
    p = bolt[pk.P]
    step = motion_scale(motion, bolt)
    farthest = MAX_FOLLOW_STEP * step
    if is_far(jet, FAR * FOLLOW_RANGE * step):
        return count
    start, overshoots = tau, 0
    for i in range(60):
        if i > 0:
            set_placement(motion, tau, later_placement)
            set_jet(theta, z, later_placement, bolt, nut, jet)
        start_theta, start_z = theta, z
        theta, z, converged = maximum_from(
            theta, z, 2.0 * FOLLOW_RANGE * step, placement if i == 0 else later_placement, bolt, nut, jet
        )
        if not converged and abs(jet[TJ_PHI]) < 2.0 * FOLLOW_RANGE * step * jet[TJ_RATE]:
            ridge_step = FIRST_RIDGE_STEP if i == 0 else LATER_RIDGE_STEP
            window = (FIRST_WINDOW if i == 0 else LATER_WINDOW) * p
            theta, z, converged = bracketed_maximum(
                start_theta, start_z, ridge_step, window, placement if i == 0 else later_placement, bolt, nut, jet
            )
        if not converged or z < -0.05 * p or jet[TJ_Z] > 0.05 * p or jet[TJ_RATE] <= 0.0:
            return count
        move = -jet[TJ_PHI] / jet[TJ_RATE]
        if abs(tau + move - start) > FOLLOW_RANGE * step:
            return count
        if abs(move) < 1e-6 * step:
            return newton_tangency(theta, z, tau + move, limit, motion, bolt, nut, later_placement, jet, found, count)
        move = min(max(move, -farthest), farthest)
        if tau + move <= 0.0 and tau + move > -OVERSHOOT * tau and overshoots < MAX_OVERSHOOTS:
            overshoots += 1
            move = -0.5 * tau
        tau += move
        if tau <= 0.0 or tau > limit + farthest:
            return count
        # The maximum moves along with time such that A and B stay zero.
        det = jet[TJ_UU] * jet[TJ_ZZ] - jet[TJ_UZ] * jet[TJ_UZ]
        du = move * (jet[TJ_UZ] * jet[TJ_ZT] - jet[TJ_ZZ] * jet[TJ_UT]) / det
        dz = move * (jet[TJ_UZ] * jet[TJ_UT] - jet[TJ_UU] * jet[TJ_ZT]) / det
        theta += du
        z += k * du + dz
    return count


@kernel()
def columns_below(placement: Array, azimuths: int, bolt: Array) -> tuple[int, int]:
    """The first column, and how many, of all those that may have a point of the bolt below the nut's surface."""
    x, y, up = placement[PLACEMENT_ROT + 6], placement[PLACEMENT_ROT + 7], placement[PLACEMENT_ROT + 8]
    lowest = placement[PLACEMENT_OFF + 2] + min(0.0, up * bolt[pk.P])
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
def ridge_maxima(
    azimuths: int, placement: Array, bolt: Array, nut: Array, grid: Array, crossings: Array, maxima: Array
) -> int:
    """Sets the ``maxima`` of phi along its ridges, as (theta, z), for a placement of the bolt; returns their number."""
    first, columns = columns_below(placement, azimuths, bolt)
    if columns == 0:
        return 0
    padded_columns = (columns + VECTOR_WIDTH - 1) // VECTOR_WIDTH * VECTOR_WIDTH
    highest = set_tops(first, padded_columns, placement, bolt, grid)
    pieces = min(1 + int(highest / bolt[pk.P] * MAX_PIECES), MAX_PIECES)
    set_slopes(pieces, first, padded_columns, azimuths, placement, bolt, nut, grid)
    listed = list_crossings(first, columns, padded_columns, pieces, azimuths, grid, crossings)
    if listed == 0:
        return 0
    locate_crossings(listed, placement, bolt, nut, crossings)
    places = list_maxima(
        listed,
        bolt[pk.LEAD] / azimuths,
        TWO_PI / azimuths,
        MAX_Z_GAP * bolt[pk.P],
        MAX_PHI_GAP * bolt[pk.P],
        crossings,
        maxima,
    )
    for j in range(places):
        if maxima[j, 0] >= TWO_PI:
            maxima[j, 0] -= TWO_PI
    return places


@kernel()
def deepest_thread_point(
    motion: Array, shallow: float, azimuths: int, bolt: Array, nut: Array
) -> tuple[bool, float, float, float]:
    """The deepest point found of the bolt's thread, in its frame: inside the nut by more than ``shallow``, or none.

    The maxima of phi are examined and, as an overlap may extend beyond the bolt's top or the nut's bottom, a grid of
    points of the whole thread; and last the corners of both crests, at which overlaps are narrow, and the lowest points
    of a thread that is tilted by more than its flanks.
    """
    grid = scratch(GRID_SIZE)
    placement = scratch(PLACEMENT_SIZE)
    jet = scratch(TANGENCY_JET_SIZE)
    crossings = scratch(CROSSINGS_SIZE)
    maxima = scratch(MAX_CROSSINGS, 2)
    set_columns(azimuths, bolt, grid)
    set_placement(motion, 0.0, placement)
    p = bolt[pk.P]
    deepest, at_theta, at_z = shallow, 0.0, 0.0
    for i in range(2 * azimuths):
        for j in range(AXIAL_SAMPLES + 1):
            theta, z = math.pi * i / azimuths, p * j / AXIAL_SAMPLES
            set_jet(theta, z, placement, bolt, nut, jet)
            depth = min(jet[TJ_PHI], -jet[TJ_Z], p + jet[TJ_Z])
            if depth > deepest:
                deepest, at_theta, at_z = depth, theta, z
    if deepest == shallow:
        for j in range(ridge_maxima(azimuths, placement, bolt, nut, grid, crossings, maxima)):
            theta, z, converged = nearby_maximum(maxima[j, 0], maxima[j, 1], 0.0, placement, bolt, nut, jet)
            depth = min(jet[TJ_PHI], -jet[TJ_Z], p + jet[TJ_Z])
            if converged and depth > deepest and 0.0 <= z <= p:
                deepest, at_theta, at_z = depth, theta, z
    if deepest == shallow:
        depth, theta, z = deepest_corner_point(placement, bolt, nut)
        if not depth > shallow:
            depth, theta, z = deepest_lowest_point(placement, bolt, nut)
        if not depth > shallow:
            return False, 0.0, 0.0, 0.0
        at_theta, at_z = theta, z
    r = pk.radius(at_z - bolt[pk.LEAD] / TWO_PI * at_theta, bolt)
    return True, r * math.cos(at_theta), r * math.sin(at_theta), at_z


@kernel()
def instant_step(motion: Array, bolt: Array, nut: Array) -> float:
    """Step between instants: less than ``INSTANT_STEP`` where that would carry points past the steepest flank."""
    width = math.inf
    for half in (0, pk.FALLING):
        width = min(width, bolt[pk.U_TOP + half] - bolt[pk.U_FLAT + half], nut[pk.U_TOP + half] - nut[pk.U_FLAT + half])
    if motion[M_KIND] > 0.0:
        return min(INSTANT_STEP, FLANK_PART_TURN * width / (2.0 * bolt[pk.R_MAJOR]))
    return min(INSTANT_STEP * motion_scale(motion, bolt), FLANK_PART * width)


@kernel()
def ridge_contacts(motion: Array, bolt: Array, nut: Array, limit: float, azimuths: int, found: Array) -> int:
    """Contacts of thread with thread along a motion before ``limit``, earliest first; returns their number.

    ``motion`` is the bolt's, seen from the nut; ``azimuths``, ``MAX_AZIMUTHS`` at the most, is a resolution and not a
    bound: docs/decisions/0001-contacts.md says how it was checked.
    """
    step = motion_scale(motion, bolt)
    instants = 1 + int(limit / instant_step(motion, bolt, nut))
    count = 0
    # One call for both, as it is compiled into each place from which it is called.
    for i in range(2):
        end, n, columns = limit, instants, azimuths
        if i == 1:
            late_start = LATE_TURN * step
            if limit > late_start:
                n = 1 + int((limit - late_start) / (LATE_INSTANT_STEP * step))
                count = contacts_at_crossings(late_start, limit, n, motion, bolt, nut, limit, found, count)
            earliest = found[0, T_TIME] if count > 0 else limit
            if not (motion[M_KIND] > 0.0 and earliest > LONG_TURN):
                break
            end, n, columns = BEGINNING, BEGINNING_INSTANTS, BEGINNING_AZIMUTHS
        count = contacts_at_instants(end, n, columns, motion, bolt, nut, limit, found, count)
    return count


@kernel()
def contacts_at_crossings(
    start: float,
    end: float,
    instants: int,
    motion: Array,
    bolt: Array,
    nut: Array,
    limit: float,
    found: Array,
    count: int,
) -> int:
    """Adds the contacts that crossings of crests lead to at so many equally spaced instants, the last at ``end``."""
    placement = scratch(PLACEMENT_SIZE)
    jet = scratch(TANGENCY_JET_SIZE)
    later_placement = scratch(PLACEMENT_SIZE)
    seeds = scratch(MAX_SEEDS, 2)
    crests = scratch(CRESTS_ARRAY_SIZE)
    set_crests(bolt, crests)
    near, soon = CROSSING_NEAR * bolt[pk.P], CROSSING_RANGE * motion_scale(motion, bolt)
    for i in range(instants):
        tau = start + (end - start) * (i + 1) / instants
        set_placement(motion, tau, placement)
        for j in range(crest_crossings(placement, near, soon, bolt, nut, crests, seeds)):
            theta, z = seeds[j, 0], seeds[j, 1]
            set_jet(theta, z, placement, bolt, nut, jet)
            if abs(jet[TJ_PHI]) < near + soon * abs(jet[TJ_RATE]):
                count = follow_maximum(
                    theta, z, tau, limit, motion, bolt, nut, placement, later_placement, jet, found, count
                )
    return count


@kernel()
def contacts_at_instants(
    end: float,
    instants: int,
    azimuths: int,
    motion: Array,
    bolt: Array,
    nut: Array,
    limit: float,
    found: Array,
    count: int,
) -> int:
    """Adds the contacts that maxima lead to at so many equally spaced instants, the last at ``end``."""
    grid = scratch(GRID_SIZE)
    placement = scratch(PLACEMENT_SIZE)
    jet = scratch(TANGENCY_JET_SIZE)
    later_placement = scratch(PLACEMENT_SIZE)
    crossings = scratch(CROSSINGS_SIZE)
    maxima = scratch(MAX_CROSSINGS, 2)
    set_columns(azimuths, bolt, grid)
    for i in range(instants):
        tau = end * (i + 1) / instants
        set_placement(motion, tau, placement)
        for j in range(ridge_maxima(azimuths, placement, bolt, nut, grid, crossings, maxima)):
            theta, z = maxima[j, 0], maxima[j, 1]
            set_jet(theta, z, placement, bolt, nut, jet)
            count = follow_maximum(
                theta, z, tau, limit, motion, bolt, nut, placement, later_placement, jet, found, count
            )
    return count


@kernel()
def contacts_behind_entries(
    entries: Array, limit: float, motion: Array, bolt: Array, nut: Array, found: Array, count: int
) -> int:
    """Adds the contacts from which the overlaps have grown that edges enter; returns the number of contacts then.

    Where the onset of an edge is not a contact, an overlap of the threads is open beside it: its deepest point is
    followed to the time at which it began. One that has grown from an earlier contact leads to no new one.
    """
    placement = scratch(PLACEMENT_SIZE)
    later_placement = scratch(PLACEMENT_SIZE)
    jet = scratch(TANGENCY_JET_SIZE)
    for i in range(1, int(entries[0, 0]) + 1):
        tau = entries[i, E_TIME]
        if tau > limit:
            continue
        theta, z = entries[i, E_THETA], entries[i, E_Z]
        set_placement(motion, tau, placement)
        set_jet(theta, z, placement, bolt, nut, jet)
        count = follow_maximum(theta, z, tau, limit, motion, bolt, nut, placement, later_placement, jet, found, count)
    return count
