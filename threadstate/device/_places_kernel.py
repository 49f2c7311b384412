"""The places at which bolt and nut overlap or nearly touch: local maxima of the overlap along both edges and the
threads.

Edges are sampled, and each maximum between samples is bracketed by its slopes. It is a search: what it finds leads the
solver, and the certificate of ``_certificate_kernel`` says whether anything was missed.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._ridge_grid_kernel import (
    CROSSINGS_SIZE,
    GRID_SIZE,
    MAX_AZIMUTHS,
    MAX_CROSSINGS,
    set_columns,
)
from threadstate.contact._ridge_kernel import (
    FIRST_RIDGE_STEP,
    FIRST_WINDOW,
    LATER_RIDGE_STEP,
    bracketed_maximum,
    nearby_maximum,
    ridge_maxima,
)
from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    EDGE_EDGE,
    EDGE_SURFACE,
    EDGE_THREAD,
    RIDGE_AZIMUTHS,
    THREAD_EDGE,
    THREAD_THREAD,
)
from threadstate.contact._tangency_kernel import (
    PLACEMENT_SIZE,
    TANGENCY_JET_SIZE,
    TJ_A,
    TJ_B,
    TJ_PHI,
    TJ_UU,
    TJ_UZ,
    TJ_Z,
    TJ_ZZ,
)
from threadstate.contact._tangency_kernel import set_jet as set_thread_jet
from threadstate.device._chart_kernel import D_FINE, N_OFFSET, N_ROTATION
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
    GAP_WORK,
    moved_point,
    set_edge_jet,
    set_gap,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

SAMPLES = 96
FINE, FINEST = 8, 64
"""Samples of an edge, all round, and the parts into which an interval near contact is divided: two maxima beside each
other, where the edge passes from one region to the next, have to be told apart. The most parts are for poses of
which the certificate finds an overlap that fewer have missed."""

MAX_PLACES = 24
"""The most places that are listed; a full list leaves the later ones out."""

SCAN_REACH = 0.01
"""An interval is divided where one of its ends is above the reach less this part of the nominal radius."""

MAX_PITCHES = 4
"""How many thread pitches of the bolt are searched from its base up: a bolt that is deeper is refused."""

MAX_STEPS = 60
NEWTON_STEPS = 12

# Scratch of the search: depths at samples, at fine ones too, an edge's jet, the work of a gap.
W_DEPTH = 0
W_FINE = SAMPLES
W_JET = W_FINE + SAMPLES * FINEST
W_GAP = W_JET + EDGE_JET_SIZE
PLACES_WORK = W_GAP + GAP_WORK

Threads = tuple[Array, Array, Array, Array, Array, Array]
"""What the search knows of a pair, and its work: of thread on thread grid, crossings, maxima, placement and jet; then
samples of both edges, which the first search sets.
"""

# Azimuths of the grid; of the edges' samples into how many parts an interval is divided, then x and y of the bolt's,
# then of the nut's.
S_AZIMUTHS, S_PARTS, S_POINTS = 0, 1, 2
SAMPLES_SIZE = S_POINTS + 4 * SAMPLES * FINEST


@kernel()
def new_threads(bolt: Array) -> Threads:
    """The work of the search of places for a pair, of which this is the bolt."""
    grid = np.empty(GRID_SIZE)
    samples = np.empty(SAMPLES_SIZE)
    set_columns(RIDGE_AZIMUTHS, bolt, grid)
    samples[S_AZIMUTHS] = RIDGE_AZIMUTHS
    samples[S_PARTS] = 0.0
    return (
        grid,
        np.empty(CROSSINGS_SIZE),
        np.empty((MAX_CROSSINGS, 2)),
        np.zeros(PLACEMENT_SIZE),
        np.empty(TANGENCY_JET_SIZE),
        samples,
    )


@kernel()
def thread_azimuths(device: Array) -> int:
    """On how many azimuths of the bolt's thread ridges are searched: twice as many where edges are sampled finest."""
    return RIDGE_AZIMUTHS if device[D_FINE] == FINE else MAX_AZIMUTHS


@kernel()
def set_samples(parts: int, bolt: Array, nut: Array, samples: Array) -> None:
    """Sets the samples of both edges, each interval divided into parts."""
    samples[S_PARTS] = parts
    count = SAMPLES * parts
    step = TWO_PI / count
    for i in range(2 * count):
        curve = bolt if i < count else nut
        theta = (i % count) * step
        r = pk.radius(-curve[pk.LEAD] / TWO_PI * theta, curve)
        samples[S_POINTS + 2 * i] = r * math.cos(theta)
        samples[S_POINTS + 2 * i + 1] = r * math.sin(theta)


@kernel()
def sample_depth(of_bolt: bool, i: int, floor: float, place: Array, samples: Array, solid: Array) -> float:
    """The lesser of g and phi of an edge's i-th sample; where g is below ``floor``, g."""
    sigma = 1.0 if of_bolt else -1.0
    x, y, z = moved_point(of_bolt, place, samples[2 * i], samples[2 * i + 1], 0.0)
    g = -sigma * z
    if g < floor:
        return g
    k = solid[pk.LEAD] / TWO_PI
    return min(g, sigma * (math.sqrt(x * x + y * y) - pk.radius(z - k * math.atan2(y, x), solid)))


@kernel()
def bracketed_peak(
    of_bolt: bool, low: float, high: float, place: Array, curve: Array, solid: Array, jet: Array
) -> tuple[int, float]:
    """A local maximum of the lesser of g and phi between two azimuths: which it is (0 g, 1 phi, 2 both), and where.

    -1 where the slopes at the ends bracket none. Newton's method within the bracket, and bisection where it leaves it.
    """
    set_edge_jet(of_bolt, low, place, curve, solid, jet)
    low_on_plane = jet[E_G] < jet[E_PHI]
    if (jet[E_G1] if low_on_plane else jet[E_PHI1]) <= 0.0:
        return -1, low
    set_edge_jet(of_bolt, high, place, curve, solid, jet)
    high_on_plane = jet[E_G] < jet[E_PHI]
    if (jet[E_G1] if high_on_plane else jet[E_PHI1]) >= 0.0:
        return -1, high
    at = 0.5 * (low + high)
    kind = 2
    for i in range(MAX_STEPS):
        set_edge_jet(of_bolt, at, place, curve, solid, jet)
        on_plane = jet[E_G] < jet[E_PHI]
        if (jet[E_G1] if on_plane else jet[E_PHI1]) > 0.0:
            low, low_on_plane = at, on_plane
        else:
            high, high_on_plane = at, on_plane
        if low_on_plane != high_on_plane:
            kind = 2
            step = -(jet[E_G] - jet[E_PHI]) / (jet[E_G1] - jet[E_PHI1])
        elif low_on_plane:
            kind = 0
            step = -jet[E_G1] / jet[E_G2] if jet[E_G2] < 0.0 else math.inf
        else:
            kind = 1
            step = -jet[E_PHI1] / jet[E_PHI2] if jet[E_PHI2] < 0.0 else math.inf
        if not low < 0.5 * (low + high) < high:
            break
        if abs(step) < 1e-14:
            if kind != 2:
                break
            rises = (jet[E_G1] if low_on_plane else jet[E_PHI1]) > 0.0
            falls = (jet[E_G1] if high_on_plane else jet[E_PHI1]) < 0.0
            if rises and falls:
                break
            # The lesser of both goes on rising beyond the crossing, or falling before it: the maximum is there.
            if rises:
                low, low_on_plane = at, high_on_plane
            else:
                high, high_on_plane = at, low_on_plane
            step = math.inf
        if i < NEWTON_STEPS and low < at + step < high:
            at += step
        else:
            at = 0.5 * (low + high)
    return kind, at


@kernel()
def add_place(
    pair: int,
    theta: float,
    z: float,
    place: Array,
    device: Array,
    bolt: Array,
    nut: Array,
    work: Array,
    count: int,
    places: Array,
) -> int:
    """Adds a place of overlap to the list, unless one of the same features is there already; their number then."""
    if count == MAX_PLACES:
        return count
    set_gap(pair, theta, z, place, device, bolt, nut, work[W_GAP : W_GAP + GAP_WORK], places[count])
    near = 1e-7 * bolt[pk.R_MAJOR]
    for i in range(count):
        apart = 0.0
        for j in range(3):
            apart += abs(places[i, G_POINT + j] - places[count, G_POINT + j])
        if apart < near and places[i, G_PAIR] == pair:
            return count
    return count + 1


@kernel()
def find_places(
    reach: float,
    place: Array,
    device: Array,
    bolt: Array,
    nut: Array,
    threads: Threads,
    work: Array,
    places: Array,
) -> int:
    """Sets the places whose overlap is more than ``-reach`` (a length); returns their number."""
    count = 0
    jet = work[W_JET : W_JET + EDGE_JET_SIZE]
    depth = work[W_DEPTH : W_DEPTH + SAMPLES]
    parts = int(device[D_FINE])
    if threads[5][S_PARTS] != parts:
        set_samples(parts, bolt, nut, threads[5])
    all_fine = SAMPLES * parts
    fine = work[W_FINE : W_FINE + all_fine]
    step = TWO_PI / all_fine
    floor = -reach - SCAN_REACH * bolt[pk.R_MAJOR]
    lowest = -reach - step * bolt[pk.R_MAJOR]
    for part in range(2):
        of_bolt = part == 0
        curve = bolt if of_bolt else nut
        solid = nut if of_bolt else bolt
        samples = threads[5][S_POINTS + 2 * part * all_fine :]
        for i in range(SAMPLES):
            depth[i] = sample_depth(of_bolt, i * parts, min(floor, lowest), place, samples, solid)
        for i in range(SAMPLES):
            divided = max(depth[i], depth[i + 1 if i < SAMPLES - 1 else 0]) > floor
            fine[i * parts] = depth[i]
            for j in range(i * parts + 1, (i + 1) * parts):
                fine[j] = sample_depth(of_bolt, j, lowest, place, samples, solid) if divided else -math.inf
        for i in range(all_fine):
            if fine[i] < lowest:
                continue
            if fine[i] < fine[i - 1 if i > 0 else all_fine - 1] or fine[i] < fine[i + 1 if i < all_fine - 1 else 0]:
                continue
            kind, theta = bracketed_peak(of_bolt, (i - 1) * step, (i + 1) * step, place, curve, solid, jet)
            if kind < 0 or (kind == 2 and not of_bolt):
                # The crossing of both edges is found from the bolt's.
                continue
            if min(jet[E_G], jet[E_PHI]) < -reach:
                continue
            if kind == 2:
                pair = EDGE_EDGE
            elif kind == 0:
                pair = EDGE_SURFACE if of_bolt else BASE_EDGE
            else:
                pair = EDGE_THREAD if of_bolt else THREAD_EDGE
            count = add_place(pair, theta, 0.0, place, device, bolt, nut, work, count, places)
    return add_threads(reach, place, device, bolt, nut, threads, work, count, places)


@kernel()
def add_threads(
    reach: float,
    place: Array,
    device: Array,
    bolt: Array,
    nut: Array,
    threads: Threads,
    work: Array,
    count: int,
    places: Array,
) -> int:
    """Adds the places at which thread overlaps thread away from both edges; returns the number of places then.

    The search covers one thread pitch of the bolt: of a deeper one each pitch is searched, as the same thread moved
    down its axis.
    """
    grid, crossings, maxima, placement, jet, samples = threads
    for i in range(9):
        placement[i] = place[N_ROTATION + i]
    p = bolt[pk.P]
    # Nothing of the thread lies below the nut's surface where the base does not.
    below = -lowest_height(place, bolt)
    edges = count
    azimuths = thread_azimuths(device)
    if below > 0.0 and samples[S_AZIMUTHS] != azimuths:
        set_columns(azimuths, bolt, grid)
        samples[S_AZIMUTHS] = azimuths
    # The first pitch comes last, so that its placement is left for the ridges that end at an edge.
    for turn in range(min(math.ceil(below / p), MAX_PITCHES) - 1, -1, -1):
        base = turn * p
        for i in range(3):
            placement[9 + i] = place[N_OFFSET + i] + base * place[N_ROTATION + 3 * i + 2]
        for j in range(ridge_maxima(azimuths, placement, bolt, nut, grid, crossings, maxima)):
            count = add_thread(
                maxima[j, 0], maxima[j, 1], base, reach, place, device, bolt, nut, threads, work, count, places
            )
    if below <= 0.0:
        return count
    # A ridge that goes from one edge to the other between two azimuths of the grid ends at a maximum along the edge,
    # from which phi rises into both threads: up the bolt's from its base, down it from the nut's surface.
    for i in range(edges):
        pair = int(places[i, G_PAIR])
        theta, z, inward = places[i, G_THETA], 0.0, 1.0
        if pair == THREAD_EDGE:
            x, y, z = moved_point(False, place, places[i, G_POINT], places[i, G_POINT + 1], places[i, G_POINT + 2])
            theta, inward = math.atan2(y, x), -1.0
        if pair == EDGE_THREAD or pair == EDGE_EDGE or pair == THREAD_EDGE:
            set_thread_jet(theta, z, placement, bolt, nut, jet)
            if inward * jet[TJ_B] > 0.0:
                count = add_thread(theta, z, 0.0, reach, place, device, bolt, nut, threads, work, count, places)
    return count


@kernel()
def lowest_height(place: Array, bolt: Array) -> float:
    """A height that no point of the bolt is below."""
    return place[N_OFFSET + 2] - bolt[pk.R_MAJOR] * math.hypot(place[N_ROTATION + 6], place[N_ROTATION + 7])


@kernel()
def add_thread(
    theta: float,
    z: float,
    base: float,
    reach: float,
    place: Array,
    device: Array,
    bolt: Array,
    nut: Array,
    threads: Threads,
    work: Array,
    count: int,
    places: Array,
) -> int:
    """Adds the maximum of phi near a point of the bolt's thread, if it is inside both threads; the number of places.

    ``z`` is counted from the height ``base`` over the bolt's base, to which the placement has moved the bolt.
    """
    placement, jet = threads[3], threads[4]
    theta, z, converged = thread_maximum(theta, z, placement, bolt, nut, jet)
    if not converged or jet[TJ_PHI] < -reach or base + z <= 0.0 or jet[TJ_Z] >= 0.0:
        return count
    theta, z, converged = polished_maximum(theta, z, placement, bolt, nut, jet)
    if converged and jet[TJ_PHI] >= -reach and base + z > 0.0 and jet[TJ_Z] < 0.0:
        return add_place(THREAD_THREAD, theta, base + z, place, device, bolt, nut, work, count, places)
    return count


@kernel()
def thread_maximum(
    theta: float, z: float, placement: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, float, bool]:
    """The maximum of phi over the bolt's thread that is near a point of a ridge; whether there is one.

    By Newton's method, and where phi is not curved downwards there, as beside a fillet, by steps along the ridge: long
    ones, and short ones where the ridge is short.
    """
    at, up, converged = nearby_maximum(theta, z, 0.0, placement, bolt, nut, jet)
    for step in (FIRST_RIDGE_STEP, LATER_RIDGE_STEP):
        if not converged:
            window = FIRST_WINDOW * bolt[pk.P]
            at, up, converged = bracketed_maximum(theta, z, step, window, placement, bolt, nut, jet)
            set_thread_jet(at, up, placement, bolt, nut, jet)
    return at, up, converged


@kernel()
def polished_maximum(
    theta: float, z: float, placement: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, float, bool]:
    """A maximum of phi over the bolt's thread to the last digits, from one that is near; whether it is a maximum."""
    from_theta, from_z = theta, z
    for _ in range(8):
        set_thread_jet(theta, z, placement, bolt, nut, jet)
        a, b, uu, uz, zz = jet[TJ_A], jet[TJ_B], jet[TJ_UU], jet[TJ_UZ], jet[TJ_ZZ]
        determinant = uu * zz - uz * uz
        if not (zz < 0.0 and determinant > 0.0):
            return theta, z, False
        du = (uz * b - zz * a) / determinant
        dz = (uz * a - uu * b) / determinant
        theta += du
        z += bolt[pk.LEAD] / TWO_PI * du + dz
        if abs(theta - from_theta) > 0.05 or abs(z - from_z) > 0.05 * bolt[pk.P]:
            return theta, z, False
        if abs(du) < 1e-13 and abs(dz) < 1e-13 * bolt[pk.P]:
            break
    set_thread_jet(theta, z, placement, bolt, nut, jet)
    return theta, z, True
