"""Contacts and poses to the last digit: Newton's method on residuals in sums of two doubles.

Of nearly coaxial parts the place of a contact is where terms balance that vanish with the tilt: round-off of g and phi,
and of a rotation in doubles, hides it. A second contact beside the first takes over what the axis lost, and the pivot
axis through both magnifies it by one over their distance (docs/certificate.md, section 10). So each contact that a
search has found is refined, and the next stage starts from the pose, the point and the axis that follow.

Arrays of such sums have two columns, high and low: a pose of twelve rows (rotation by rows, origin), a point or an axis
of three, and what is known of a contact.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact import _onset_kernel as onset
from threadstate.contact import _tangency_kernel as tk
from threadstate.contact._beside_kernel import KEPT_ROWS, KEPT_SIZE, clear
from threadstate.contact._box_kernel import ONE_EDGE, ONE_PLANE, ONE_THREAD
from threadstate.contact._double_double_kernel import (
    Pair,
    add,
    azimuth,
    divide,
    multiply,
    sine_cosine,
    square_root,
    subtract,
)
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._geometry_kernel import M_SIGMA, MOTION_SIZE, PATH_SIZE, TWO_PI, motion_scale
from threadstate.contact._onset_kernel import JET_SIZE
from threadstate.contact._refined_edge_kernel import set_refined_motions
from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    EDGE_EDGE,
    EDGE_SURFACE,
    EDGE_THREAD,
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
    set_motions,
)
from threadstate.contact._tangency_kernel import PLACEMENT_SIZE, TANGENCY_JET_SIZE
from threadstate.contact._wide_kernel import (
    POSE_SIZE,
    WIDE_MOTION_SIZE,
    ZERO,
    Vector,
    advance,
    clearance,
    clearance_slope,
    dot,
    edge_slope,
    entry,
    plus,
    product_sum,
    rotated,
    rotated_back,
    round_numbers,
    set_entry,
    set_motion,
    set_moved,
    set_vector,
    thread_point,
    times,
    vector_at,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# What is known of a contact: time, azimuth and axial position on the part that touches with an edge, or with its side
# (the bolt), and the point in the nut's frame.
F_TIME, F_THETA, F_AXIAL, F_POINT = range(4)
REFINED_SIZE = 6

MOST_STEPS = 12

REACH = 1e-3
"""How far (rad, and times ``motion_scale``) from where it was found a contact is refined: beyond is another root."""

SETTLED = 1e-14
"""A step of Newton's method (rad, and times ``motion_scale``) after which the contact is refined: its derivatives, in
doubles, are right to 1e-6 at tilts of 1e-6 deg, so that 1e-20 is left."""
STEPS_AFTER = 2
"""So many such steps are made where thread does not touch thread, so that less is left of where they began."""

AZIMUTH_GRID = 1.5 * 2.0**16
DROPPED_DIGITS = 2.0**20 + 1.0
"""They begin at a multiple of 2**-36 rad, and at a time of 33 binary digits: the last digits of the search hardly ever
decide where that is, and so a refined contact has the same bits however it was found."""


@kernel(forceinline=True)
def on_azimuth_grid(theta: float) -> float:
    """The nearest azimuth of the grid."""
    return (theta + AZIMUTH_GRID) - AZIMUTH_GRID


@kernel(forceinline=True)
def with_fewer_digits(x: float) -> float:
    """A number rounded to its first binary digits."""
    scaled = DROPPED_DIGITS * x
    return scaled - (scaled - x)


@kernel()
def set_first_pose(roll: float, pitch: float, phase: float, high: float, out: Array) -> None:
    """``Rz(phase) Ry(pitch) Rx(roll)``, angles in rad, and the origin at a height."""
    sa, ca = sine_cosine((roll, 0.0))
    sb, cb = sine_cosine((pitch, 0.0))
    sc, cc = sine_cosine((phase, 0.0))
    sb_sa, sb_ca = multiply(sb, sa), multiply(sb, ca)
    set_vector(
        out,
        0,
        (
            multiply(cc, cb),
            subtract(multiply(cc, sb_sa), multiply(sc, ca)),
            product_sum(cc, sb_ca, sc, sa),
        ),
    )
    set_vector(
        out,
        3,
        (
            multiply(sc, cb),
            product_sum(sc, sb_sa, cc, ca),
            subtract(multiply(sc, sb_ca), multiply(cc, sa)),
        ),
    )
    set_vector(out, 6, ((-sb[0], -sb[1]), multiply(cb, sa), multiply(cb, ca)))
    set_vector(out, 9, (ZERO, ZERO, (high, 0.0)))


@kernel()
def set_edge_residuals(
    on_bolt: bool, theta: Pair, pose: Array, bolt: Array, nut: Array, jet: Array, refined: Array
) -> None:
    """Sets g, phi and their derivatives by azimuth in a jet of ``_onset_kernel``, and the point in the nut's frame."""
    curve, solid = (bolt, nut) if on_bolt else (nut, bolt)
    sigma = 1.0 if on_bolt else -1.0
    k = advance(curve)
    at, along, up = thread_point(theta, ZERO, curve)
    way = edge_slope(along, up, k)
    if on_bolt:
        x, way = plus(rotated(pose, at), vector_at(pose, 9)), rotated(pose, way)
        set_vector(refined, F_POINT, x)
    else:
        set_vector(refined, F_POINT, at)
        x = rotated_back(pose, plus(at, times(vector_at(pose, 9), (-1.0, 0.0))))
        way = rotated_back(pose, way)
    gap, r, slope = clearance(x, solid)
    jet[onset.J_G], jet[onset.J_G_THETA] = -sigma * x[2][0], -sigma * way[2][0]
    jet[onset.J_PHI] = sigma * gap[0]
    jet[onset.J_PHI_THETA] = sigma * clearance_slope(x, way, r, slope, k)[0]


@kernel()
def set_thread_residuals(
    theta: Pair, z: Pair, pose: Array, bolt: Array, nut: Array, jet: Array, refined: Array
) -> None:
    """Sets phi, A and B in a jet of ``_tangency_kernel``, and the point in the nut's frame."""
    k = advance(bolt)
    at, along, up = thread_point(theta, z, bolt)
    x = plus(rotated(pose, at), vector_at(pose, 9))
    set_vector(refined, F_POINT, x)
    gap, r, slope = clearance(x, nut)
    jet[tk.TJ_PHI] = gap[0]
    jet[tk.TJ_A] = clearance_slope(x, rotated(pose, along), r, slope, k)[0]
    jet[tk.TJ_B] = clearance_slope(x, rotated(pose, up), r, slope, k)[0]


@kernel()
def set_unrefined(contact: Array, pose: Array, refined: Array) -> None:
    """Sets what is known of a contact in doubles.

    Boxes of azimuth reach beyond half a turn either way: an azimuth there is that of the other end, whichever box the
    contact was found in.
    """
    pair = int(contact[K_PAIR])
    on_nut = pair == BASE_EDGE or pair == THREAD_EDGE
    theta = contact[K_NUT_AZIMUTH] if on_nut else contact[K_BOLT_AZIMUTH]
    if abs(theta) > math.pi:
        theta -= math.copysign(TWO_PI, theta)
    set_entry(refined, F_TIME, (contact[K_TIME], 0.0))
    set_entry(refined, F_THETA, (theta, 0.0))
    set_entry(refined, F_AXIAL, ZERO)
    for i in range(3):
        set_entry(refined, F_POINT + i, (contact[K_X + i], 0.0))
    if pair == THREAD_THREAD:
        x = plus(vector_at(refined, F_POINT), times(vector_at(pose, 9), (-1.0, 0.0)))
        set_entry(refined, F_AXIAL, rotated_back(pose, x)[2])


@kernel()
def refine_edge(
    pair: int,
    is_turn: bool,
    pose: Array,
    point: Array,
    axis: Array,
    edge: Edge,
    on_grid: bool,
    moved: Array,
    refined: Array,
) -> bool:
    """Newton's method from ``refined``, in place, for a contact on an edge; False where it does not settle nearby.

    Its derivatives are those of the ``edge``. With ``on_grid`` it begins where fewer digits say.
    """
    sigma = edge.motion[M_SIGMA]
    bolt, nut = (edge.curve, edge.solid) if sigma > 0.0 else (edge.solid, edge.curve)
    kind = ONE_EDGE if pair == EDGE_EDGE else (ONE_THREAD if pair == EDGE_THREAD or pair == THREAD_EDGE else ONE_PLANE)
    jet = scratch(JET_SIZE)
    unit = motion_scale(edge.motion, bolt)
    start, since = refined[F_THETA, 0], refined[F_TIME, 0]
    if on_grid:
        start, since = on_azimuth_grid(start), with_fewer_digits(since)
    theta, time = (start, 0.0), (since, 0.0)
    small_steps = 0
    for _ in range(MOST_STEPS):
        set_moved(pose, is_turn, point, axis, time, moved)
        onset.set_jet_beside(theta[0], time[0], edge, jet)
        set_edge_residuals(sigma > 0.0, theta, moved, bolt, nut, jet, refined)
        if small_steps == STEPS_AFTER:
            set_entry(refined, F_THETA, theta)
            set_entry(refined, F_TIME, time)
            return True
        _, d_theta, d_time, _, _ = onset.onset_step(int(kind), jet, 0.0, 0.0)
        theta, time = add(theta, (d_theta, 0.0)), add(time, (d_time, 0.0))
        if not (abs(theta[0] - start) <= REACH and abs(time[0] - since) <= REACH * unit):
            return False
        is_small = abs(d_theta) <= SETTLED and abs(d_time) <= SETTLED * unit
        small_steps = small_steps + 1 if is_small else 0
    return False


@kernel()
def refine_thread(
    is_turn: bool,
    pose: Array,
    point: Array,
    axis: Array,
    motion: Array,
    bolt: Array,
    nut: Array,
    moved: Array,
    refined: Array,
) -> bool:
    """The same where thread meets thread."""
    placement, jet = scratch(PLACEMENT_SIZE), scratch(TANGENCY_JET_SIZE)
    unit = motion_scale(motion, bolt)
    theta, z, time = entry(refined, F_THETA), entry(refined, F_AXIAL), entry(refined, F_TIME)
    start, from_z, since = theta[0], z[0], time[0]
    k = advance(bolt)
    settled = False
    for _ in range(MOST_STEPS):
        set_moved(pose, is_turn, point, axis, time, moved)
        tk.set_placement(motion, time[0], placement)
        tk.set_jet(theta[0], z[0], placement, bolt, nut, jet)
        set_thread_residuals(theta, z, moved, bolt, nut, jet, refined)
        if settled:
            set_entry(refined, F_THETA, theta)
            set_entry(refined, F_AXIAL, z)
            set_entry(refined, F_TIME, time)
            return True
        _, du, dz, dt = tk.tangency_step(jet)
        theta, time = add(theta, (du, 0.0)), add(time, (dt, 0.0))
        z = add(z, add(multiply(k, (du, 0.0)), (dz, 0.0)))
        if not (
            abs(theta[0] - start) <= REACH
            and abs(z[0] - from_z) <= REACH * bolt[pk.P]
            and abs(time[0] - since) <= REACH * unit
        ):
            return False
        settled = abs(du) <= SETTLED and abs(dz) <= SETTLED * bolt[pk.P] and abs(dt) <= SETTLED * unit
    return False


@kernel()
def refine_found(
    is_turn: bool,
    pose: Array,
    point: Array,
    axis: Array,
    bolt: Array,
    nut: Array,
    contact: Array,
    as_found: bool,
    moved: Array,
    refined: Array,
) -> bool:
    """Refines a contact that a motion has come to, in ``refined``, and the pose then; False where nothing settles.

    On an edge it is tried again from all the digits, ``as_found``, as a corner may be that near; then with derivatives
    in sums of two doubles: beside a double root those in doubles have no two digits.
    """
    pair = int(contact[K_PAIR])
    start, centre, direction = scratch(POSE_SIZE), scratch(3), scratch(3)
    round_numbers(pose, start)
    round_numbers(point, centre)
    round_numbers(axis, direction)
    bolt_motion, nut_motion = scratch(MOTION_SIZE), scratch(MOTION_SIZE)
    set_motions(start, is_turn, False, centre, direction, bolt_motion, nut_motion)
    if pair == THREAD_THREAD:
        return refine_thread(is_turn, pose, point, axis, bolt_motion, bolt, nut, moved, refined)
    kept, path, exact = scratch(KEPT_ROWS, KEPT_SIZE), scratch(PATH_SIZE), scratch(WIDE_MOTION_SIZE, 2)
    clear(kept)
    on_nut = pair == BASE_EDGE or pair == THREAD_EDGE
    motion, curve, solid = (nut_motion, nut, bolt) if on_nut else (bolt_motion, bolt, nut)
    edge = Edge(motion, curve, solid, kept, path, scratch(0, 2))
    if refine_edge(pair, is_turn, pose, point, axis, edge, True, moved, refined):
        return True
    if not as_found:
        return False
    if refine_edge(pair, is_turn, pose, point, axis, edge, False, moved, refined):
        return True
    bolt_wide, nut_wide = scratch(WIDE_MOTION_SIZE, 2), scratch(WIDE_MOTION_SIZE, 2)
    set_motion(pose, point, axis, exact)
    set_refined_motions(exact, bolt_motion, nut_motion, bolt_wide, nut_wide)
    edge = Edge(motion, curve, solid, kept, path, nut_wide if on_nut else bolt_wide)
    return refine_edge(pair, is_turn, pose, point, axis, edge, False, moved, refined)


@kernel(forceinline=True)
def is_unrefined(contact: Array, alone: bool) -> bool:
    """Whether a contact stays as it is found: one that is not ``alone``, or of the bolt's thread on the surface."""
    return not alone or int(contact[K_PAIR]) == THREAD_SURFACE


@kernel()
def refine_contact(
    is_turn: bool,
    pose: Array,
    point: Array,
    axis: Array,
    bolt: Array,
    nut: Array,
    contact: Array,
    time: float,
    alone: bool,
    as_found: bool,
    moved: Array,
    refined: Array,
) -> tuple[float, bool]:
    """Refines the contact that a motion comes to at ``time``; sets what is known of it and the pose then, ``moved``.

    One that :func:`is_unrefined` is not. Returns the time, and whether the equations of any other have a solution
    nearby: without one there may be no contact. ``as_found``: it is looked for from all the digits, too, where fewer
    lead nowhere; what is refined then may hang on the last ones.
    """
    set_moved(pose, is_turn, point, axis, (time, 0.0), moved)
    set_unrefined(contact, moved, refined)
    if is_unrefined(contact, alone):
        return time, True
    if refine_found(is_turn, pose, point, axis, bolt, nut, contact, as_found, moved, refined):
        pair = int(contact[K_PAIR])
        if pair == EDGE_EDGE or pair == EDGE_SURFACE:
            set_entry(refined, F_POINT + 2, ZERO)
        set_contact(moved, refined, contact)
        return contact[K_TIME], True
    return time, False


@kernel()
def set_contact(pose: Array, refined: Array, contact: Array) -> None:
    """Rounds a refined contact."""
    pair = int(contact[K_PAIR])
    x = vector_at(refined, F_POINT)
    contact[K_TIME] = refined[F_TIME, 0]
    contact[K_X], contact[K_Y], contact[K_Z] = x[0][0], x[1][0], x[2][0]
    if pair == BASE_EDGE or pair == THREAD_EDGE:
        arm = rotated_back(pose, plus(x, times(vector_at(pose, 9), (-1.0, 0.0))))
        contact[K_NUT_AZIMUTH] = refined[F_THETA, 0]
        contact[K_BOLT_AZIMUTH] = math.atan2(arm[1][0], arm[0][0])
    else:
        contact[K_BOLT_AZIMUTH] = refined[F_THETA, 0]
        contact[K_NUT_AZIMUTH] = math.atan2(x[1][0], x[0][0])


@kernel()
def set_unit(x: Vector, reverse: bool, out: Array) -> None:
    """Sets the unit vector along another, or against it."""
    length = square_root(dot(x, x))
    if reverse:
        length = (-length[0], -length[1])
    set_vector(out, 0, (divide(x[0], length), divide(x[1], length), divide(x[2], length)))


@kernel()
def set_second_axis(pair: int, refined: Array, pose: Array, bolt: Array, nut: Array, out: Array) -> None:
    """Sets the axis of the second turn (``second_axis`` of ``_solve_kernel``) from a refined contact."""
    x = vector_at(refined, F_POINT)
    k = advance(bolt)
    if pair == THREAD_THREAD:
        way = ((-x[1][0], -x[1][1]), x[0], k)
    elif pair == THREAD_SURFACE:
        arm = rotated_back(pose, plus(x, times(vector_at(pose, 9), (-1.0, 0.0))))
        way = rotated(pose, ((-arm[1][0], -arm[1][1]), arm[0], k))
    elif pair == EDGE_SURFACE:
        # The line in both planes: at a corner, too, where the edge has no tangent.
        nx, ny = entry(pose, 2), entry(pose, 5)
        way = ((-ny[0], -ny[1]), nx, ZERO)
    elif pair == EDGE_THREAD:
        _, along, up = thread_point(entry(refined, F_THETA), ZERO, bolt)
        way = rotated(pose, edge_slope(along, up, k))
    else:
        theta = azimuth(x[0], x[1]) if pair == EDGE_EDGE else entry(refined, F_THETA)
        _, along, up = thread_point(theta, ZERO, nut)
        way = edge_slope(along, up, k)
    if pair == THREAD_SURFACE:
        way = (way[0], way[1], ZERO)
    set_unit(way, x[0][0] * way[1][0] - x[1][0] * way[0][0] > 0.0, out)


@kernel()
def set_pivot_axis(first: Array, second: Array, out: Array) -> None:
    """Sets the unit axis from one refined contact to another."""
    set_unit(plus(vector_at(second, F_POINT), times(vector_at(first, F_POINT), (-1.0, 0.0))), False, out)


@kernel()
def reverse(numbers: Array) -> None:
    """Changes every sign."""
    for i in range(numbers.shape[0]):
        numbers[i, 0], numbers[i, 1] = -numbers[i, 0], -numbers[i, 1]
