"""Where a contact is after a small motion: its place of overlap is followed from where it was, over edges and threads.

A contact of the threads that leaves them goes on along the edge at which it leaves; one of an edge from which phi rises
into both threads goes on within them, if there is a maximum near: where phi rises but little, and a fillet may be
between, it is looked for along the ridge. What is found by following contacts is searched for other places at its end.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import TWO_PI, copy_numbers
from threadstate.contact._ridge_kernel import LATER_RIDGE_STEP, nearby_maximum
from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    EDGE_EDGE,
    EDGE_SURFACE,
    EDGE_THREAD,
    THREAD_EDGE,
    THREAD_THREAD,
)
from threadstate.contact._tangency_kernel import TJ_B, TJ_X, TJ_Y, TJ_Z, set_jet
from threadstate.device._chart_kernel import N_OFFSET, N_ROTATION
from threadstate.device._gap_kernel import (
    E_G,
    E_G1,
    E_G2,
    E_PHI,
    E_PHI1,
    E_PHI2,
    EDGE_JET_SIZE,
    G_PAIR,
    G_POINT,
    G_THETA,
    G_Z,
    GAP_WORK,
    moved_point,
    set_edge_jet,
    set_gap,
)
from threadstate.device._places_kernel import SAME_PLACE, W_GAP, W_JET, Threads, bracketed_peak
from threadstate.device._thread_maximum_kernel import (
    MAXIMUM,
    OUTSIDE,
    SLIGHT_SLOPE,
    maximum_within,
    polished_maximum,
    ridge_maximum,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

PEAK_STEPS = 8
"""The most steps of Newton's method to a place along an edge."""

PEAK, PEAK_NOISE = 1e-14, 1e-11
"""The step (rad) at which it ends, and that below which it does where steps get no shorter for round-off."""

WINDOWS = (0.003, 0.02, 0.1)
"""Within these azimuths (rad) of where a contact was its place along an edge is looked for, one after the other."""

BESIDE_CROSSING = 5e-3
"""How deep below the other part's face (nominal radii) a place along an edge is at most whose contact may go on along
the other part's edge: a crossing of both edges divides into a place of each."""

NOWHERE = -1
"""Instead of a pair of features: no place is near."""

ON_PLANE, ON_PHI, ON_BOTH, ANY = range(4)
"""What is greatest at a place along an edge: g, phi, or the lesser where they cross; or it is not known."""


@kernel()
def set_placement(place: Array, threads: Threads) -> None:
    """Sets the placement of the threads to that of a pose."""
    copy_numbers(place[N_ROTATION : N_ROTATION + 9], threads.placement[0:9])
    copy_numbers(place[N_OFFSET : N_OFFSET + 3], threads.placement[9:12])


@kernel()
def place_near(
    gap: Array, place: Array, bolt: Array, nut: Array, threads: Threads, edge_jet: Array
) -> tuple[int, float, float]:
    """The pair of features, azimuth and height at which a place of overlap is now, from where it was."""
    set_placement(place, threads)
    pair = int(gap[G_PAIR])
    if pair == THREAD_THREAD:
        return from_thread(gap[G_THETA], gap[G_Z], place, bolt, nut, threads, edge_jet)
    of_bolt = not (pair == BASE_EDGE or pair == THREAD_EDGE)
    pair, theta = edge_place(of_bolt, gap[G_THETA], kind_of(pair), place, bolt, nut, edge_jet)
    if (pair == EDGE_THREAD or pair == THREAD_EDGE) and edge_jet[E_G] < BESIDE_CROSSING * bolt[pk.R_MAJOR]:
        pair, theta = deeper_edge(pair, theta, min(edge_jet[E_G], edge_jet[E_PHI]), place, bolt, nut, edge_jet)
    if pair == EDGE_THREAD or pair == EDGE_EDGE or pair == THREAD_EDGE:
        return from_edge(pair, theta, place, bolt, nut, threads)
    return pair, theta, 0.0


@kernel()
def follow_place(
    gap: Array, place: Array, device: Array, bolt: Array, nut: Array, threads: Threads, work: Array
) -> bool:
    """Sets a place of overlap to where it is now; False where it is nowhere near."""
    pair, theta, z = place_near(gap, place, bolt, nut, threads, work[W_JET : W_JET + EDGE_JET_SIZE])
    if pair == NOWHERE:
        return False
    set_gap(pair, theta, z, False, place, device, bolt, nut, work[W_GAP : W_GAP + GAP_WORK], gap)
    return True


@kernel()
def is_one_place(gap: Array, other: Array, bolt: Array) -> bool:
    """Whether two places of overlap have the same point."""
    apart = 0.0
    for h in range(3):
        apart += abs(gap[G_POINT + h] - other[G_POINT + h])
    return apart < SAME_PLACE * bolt[pk.R_MAJOR]


@kernel()
def follow_all(
    count: int, place: Array, device: Array, bolt: Array, nut: Array, threads: Threads, work: Array, places: Array
) -> bool:
    """Sets places of overlap to where they are now; False where one is nowhere near, or two have become one."""
    for i in range(count):
        if not follow_place(places[i], place, device, bolt, nut, threads, work):
            return False
        for j in range(i):
            if is_one_place(places[j], places[i], bolt):
                return False
    return True


@kernel()
def edge_place(
    of_bolt: bool, was: float, kind: int, place: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[int, float]:
    """The pair of features of an edge's place near an azimuth, and where it is: of both edges, on the bolt's.

    It is looked for first as what it was, ``kind`` of :func:`kind_of`, or ``ANY``.
    """
    pair, theta = edge_peak(of_bolt, was, kind, place, bolt, nut, jet)
    if pair != EDGE_EDGE or of_bolt:
        return pair, theta
    x, y = point_of_edge(of_bolt, theta, place, nut)
    return edge_peak(True, math.atan2(y, x), kind, place, bolt, nut, jet)


@kernel()
def point_of_edge(of_bolt: bool, theta: float, place: Array, curve: Array) -> tuple[float, float]:
    """Where a point of an edge is across the other part's axis."""
    r = pk.radius(-curve[pk.LEAD] / TWO_PI * theta, curve)
    x, y, _ = moved_point(of_bolt, place, r * math.cos(theta), r * math.sin(theta), 0.0)
    return x, y


@kernel()
def kind_of(pair: int) -> int:
    """What is greatest at an edge's place with this pair of features."""
    if pair == EDGE_SURFACE or pair == BASE_EDGE:
        return ON_PLANE
    return ON_BOTH if pair == EDGE_EDGE else ON_PHI


@kernel()
def newton_peak(
    of_bolt: bool, was: float, kind: int, place: Array, curve: Array, solid: Array, jet: Array
) -> tuple[bool, float]:
    """A place of its kind by Newton's method from an azimuth: whether it leads to one that is near, and where."""
    at, before = was, math.inf
    for _ in range(PEAK_STEPS):
        set_edge_jet(of_bolt, at, place, curve, solid, jet)
        over = jet[E_G] - jet[E_PHI]
        if kind == ON_PLANE:
            is_peak, step = jet[E_G2] < 0.0 and over < 0.0, -jet[E_G1] / jet[E_G2]
        elif kind == ON_PHI:
            is_peak, step = jet[E_PHI2] < 0.0 and over > 0.0, -jet[E_PHI1] / jet[E_PHI2]
        else:
            is_peak, step = jet[E_G1] * jet[E_PHI1] < 0.0, -over / (jet[E_G1] - jet[E_PHI1])
        if not is_peak:
            return False, at
        if abs(step) < PEAK or 0.5 * abs(before) < abs(step) < PEAK_NOISE:
            return True, at
        at += step
        before = step
        if not abs(at - was) < WINDOWS[0]:
            return False, at
    return False, at


@kernel()
def edge_peak(
    of_bolt: bool, was: float, kind: int, place: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[int, float]:
    """As :func:`edge_place`, on this edge."""
    curve, solid = (bolt, nut) if of_bolt else (nut, bolt)
    is_found, theta = False, was
    if kind != ANY:
        is_found, theta = newton_peak(of_bolt, was, kind, place, curve, solid, jet)
    if not is_found:
        for window in WINDOWS:
            kind, theta = bracketed_peak(of_bolt, was - window, was + window, place, curve, solid, jet)
            if kind >= 0:
                break
    if kind == ON_PLANE:
        return (EDGE_SURFACE if of_bolt else BASE_EDGE), theta
    if kind == ON_PHI:
        return (EDGE_THREAD if of_bolt else THREAD_EDGE), theta
    if kind == ON_BOTH:
        return EDGE_EDGE, theta
    return NOWHERE, was


@kernel()
def deeper_edge(
    pair: int, theta: float, depth: float, place: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[int, float]:
    """Of a place of one part's edge near the other's, and the place of that one beside it, the deeper one."""
    of_bolt = pair == EDGE_THREAD
    x, y = point_of_edge(of_bolt, theta, place, bolt if of_bolt else nut)
    other, at = edge_place(not of_bolt, math.atan2(y, x), ON_PHI, place, bolt, nut, jet)
    if (other == EDGE_THREAD or other == THREAD_EDGE) and min(jet[E_G], jet[E_PHI]) > depth:
        return other, at
    return pair, theta


@kernel()
def set_inward(
    pair: int, theta: float, place: Array, bolt: Array, nut: Array, threads: Threads
) -> tuple[float, float, float]:
    """Sets the threads' jet where an edge's place is on the bolt's thread: azimuth, height, and the slope of phi from
    there into both threads.
    """
    at, up, inward = theta, 0.0, 1.0
    if pair == THREAD_EDGE:
        r = pk.radius(-nut[pk.LEAD] / TWO_PI * theta, nut)
        x, y, up = moved_point(False, place, r * math.cos(theta), r * math.sin(theta), 0.0)
        at, inward = math.atan2(y, x), -1.0
    set_jet(at, up, threads.placement, bolt, nut, threads.jet)
    return at, up, inward * threads.jet[TJ_B]


@kernel()
def from_edge(
    pair: int, theta: float, place: Array, bolt: Array, nut: Array, threads: Threads
) -> tuple[int, float, float]:
    """A place of an edge, or that of the threads to which phi rises from it."""
    jet = threads.jet
    at, up, slope = set_inward(pair, theta, place, bolt, nut, threads)
    if slope > 0.0:
        if slope < SLIGHT_SLOPE:
            inward = -1.0 if pair == THREAD_EDGE else 1.0
            at, up, kind = maximum_within(at, up, inward, slope, -math.inf, threads.placement, bolt, nut, jet)
        else:
            at, up, converged = nearby_maximum(at, up, 0.0, threads.placement, bolt, nut, jet)
            kind = MAXIMUM if converged else OUTSIDE
        if kind == MAXIMUM and up > 0.0 and jet[TJ_Z] < 0.0:
            at, up, converged = polished_maximum(at, up, threads.placement, bolt, nut, jet)
            if converged and up > 0.0 and jet[TJ_Z] < 0.0:
                return THREAD_THREAD, at, up
    return pair, theta, 0.0


@kernel()
def from_thread(
    theta: float, z: float, place: Array, bolt: Array, nut: Array, threads: Threads, edge_jet: Array
) -> tuple[int, float, float]:
    """A place of the threads, or that of the edge at which it has left them."""
    jet = threads.jet
    set_jet(theta, z, threads.placement, bolt, nut, jet)
    at, up, converged = polished_maximum(theta, z, threads.placement, bolt, nut, jet)
    if not converged:
        at, up, kind = ridge_maximum(theta, z, 0.0, LATER_RIDGE_STEP, -math.inf, threads.placement, bolt, nut, jet)
        if kind != MAXIMUM and kind != OUTSIDE:
            return NOWHERE, at, up
    if up <= 0.0:
        pair, at = edge_place(True, at, ANY, place, bolt, nut, edge_jet)
        return pair, at, 0.0
    if jet[TJ_Z] >= 0.0:
        pair, at = edge_place(False, math.atan2(jet[TJ_Y], jet[TJ_X]), ANY, place, bolt, nut, edge_jet)
        return pair, at, 0.0
    return THREAD_THREAD, at, up
