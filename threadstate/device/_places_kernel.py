"""The places at which bolt and nut overlap or nearly touch: local maxima of the overlap along both edges and the
threads.

Edges are sampled, and each maximum between samples is bracketed by its slopes. It is a search: what it finds leads the
solver, and the certificate of ``_certificate_kernel`` says whether anything was missed.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import azimuth, profile_numbers, radius_and_slope, smaller
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._ridge_grid_kernel import (
    CROSSINGS_SIZE,
    GRID_SIZE,
    MAX_AZIMUTHS,
    MAX_CROSSINGS,
    set_columns,
)
from threadstate.contact._ridge_kernel import LATER_RIDGE_STEP, ridge_maxima
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
    TJ_B,
    TJ_PHI,
    TJ_X,
    TJ_Y,
    TJ_Z,
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
    G_VALUE,
    G_Z,
    GAP_WORK,
    edge_depth,
    moved_point,
    moved_vector,
    set_edge_jet,
    set_gap,
)
from threadstate.device._thread_maximum_kernel import (
    MAXIMUM,
    SLIGHT_SLOPE,
    maximum_within,
    polished_maximum,
    ridge_maximum,
    thread_maximum,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

SAMPLES = 96
FINE, FINEST = 8, 64
"""Samples of an edge, all round, and the parts into which an interval is divided: two maxima beside each other, where
the edge passes from one region to the next, have to be told apart. The most parts are for poses of which the
certificate finds an overlap that fewer have missed."""

LEVEL = 1e-12
"""Nominal radii by which a sample is higher than one beside it: what is less is round-off on an arc of one depth, or
the highest point of an edge that is nearly parallel to the other part's face.
"""

TOUCHING = 1e-5
"""Up to this gap (nominal radii) a place along an edge is searched for others beside it."""

MAX_PLACES = 24
"""The most places that are listed; a full list leaves the later ones out."""

MAX_PITCHES = 4
"""How many thread pitches of the bolt are searched from its base up: a bolt that is deeper is refused."""

SAME_PLACE, SAME_MAXIMUM = 1e-7, 1e-6
"""Places of the same features that are nearer to each other (nominal radii) are one; so is a maximum along the threads,
before its last digits are known, that is as near as the second to a place there."""

MAX_STEPS = 60
NEWTON_STEPS = 12
MAX_NARROWINGS = 8

# Scratch of the search: depths at samples, an edge's jet, the work of a gap.
W_DEPTHS = 0
W_JET = W_DEPTHS + SAMPLES * FINEST
W_GAP = W_JET + EDGE_JET_SIZE
PLACES_WORK = W_GAP + GAP_WORK

MAX_KNOWN, FORGOTTEN = 32, 16
"""Maxima of phi along the threads that are remembered, and the searches in a row without one of them after which it is
forgotten."""

# A maximum that is remembered: azimuth, height over the bolt's base, searches since it was last found, and its place in
# the present one's list, -1 for none.
KNOWN_THETA, KNOWN_Z, KNOWN_MISSED, KNOWN_PLACE = range(4)
KNOWN_SIZE = 4


class Threads(NamedTuple):
    """What the search knows of a pair, and its work.

    Of thread on thread: grid, crossings, maxima, placement and jet; ``samples`` of both edges, which the first search
    sets; and the maxima along the threads that the last searches have found, ``known``, with their number in
    ``known_count``: two of them between two azimuths of the grid are told apart by where they were before.
    """

    grid: Array
    crossings: Array
    maxima: Array
    placement: Array
    jet: Array
    samples: Array
    known: Array
    known_count: Indices


# Azimuths of the grid; of the edges' samples into how many parts an interval is divided, then all x and all y of the
# bolt's, then of the nut's.
S_AZIMUTHS, S_PARTS, S_POINTS = 0, 1, 2
SAMPLES_SIZE = S_POINTS + 4 * SAMPLES * FINEST


@kernel(allocates=True)
def new_threads(bolt: Array) -> Threads:
    """The work of the search of places for a pair, of which this is the bolt."""
    grid = np.empty(GRID_SIZE)
    samples = np.empty(SAMPLES_SIZE)
    set_columns(RIDGE_AZIMUTHS, bolt, grid)
    samples[S_AZIMUTHS] = RIDGE_AZIMUTHS
    samples[S_PARTS] = 0.0
    return Threads(
        grid,
        np.empty(CROSSINGS_SIZE),
        np.empty((MAX_CROSSINGS, 2)),
        np.zeros(PLACEMENT_SIZE),
        np.empty(TANGENCY_JET_SIZE),
        samples,
        np.empty((MAX_KNOWN, KNOWN_SIZE)),
        np.zeros(1, dtype=np.int64),
    )


@kernel()
def forget_maxima(threads: Threads) -> None:
    """Forgets the maxima that are remembered: the next search is of another path."""
    threads.known_count[0] = 0


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
        at = S_POINTS + i % count + (0 if i < count else 2 * count)
        samples[at] = r * math.cos(theta)
        samples[at + count] = r * math.sin(theta)


@kernel(contract=True)
def set_depths(
    of_bolt: bool, count: int, place: Array, edge_x: Array, edge_y: Array, solid: Array, depths: Array
) -> None:
    """Sets the lesser of g and phi at an edge's samples."""
    sigma = 1.0 if of_bolt else -1.0
    x_x, y_x, z_x = moved_vector(of_bolt, place, 1.0, 0.0, 0.0)
    x_y, y_y, z_y = moved_vector(of_bolt, place, 0.0, 1.0, 0.0)
    x_0, y_0, z_0 = moved_point(of_bolt, place, 0.0, 0.0, 0.0)
    k = solid[pk.LEAD] / TWO_PI
    numbers = profile_numbers(solid)
    for i in range(count):
        x = x_x * edge_x[i] + x_y * edge_y[i] + x_0
        y = y_x * edge_x[i] + y_y * edge_y[i] + y_0
        z = z_x * edge_x[i] + z_y * edge_y[i] + z_0
        away = math.sqrt(x * x + y * y)
        radius, _, _, _ = radius_and_slope(z - k * azimuth(x, y, away), numbers)
        depths[i] = smaller(-sigma * z, sigma * (away - radius))


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
def peak_beside(
    of_bolt: bool, middle: float, step: float, place: Array, curve: Array, solid: Array, jet: Array
) -> tuple[int, float]:
    """As :func:`bracketed_peak`, the maximum beside a sample that is higher than those a step before and after it.

    An end at which the slope is that of another maximum beside it is moved towards the sample, half-way each time.
    """
    low, high = middle - step, middle + step
    for _ in range(MAX_NARROWINGS):
        kind, theta = bracketed_peak(of_bolt, low, high, place, curve, solid, jet)
        if kind >= 0:
            return kind, theta
        if theta == low:
            low = 0.5 * (low + middle)
        else:
            high = 0.5 * (high + middle)
    return -1, middle


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
) -> tuple[int, int]:
    """Adds a place of overlap to the list, unless one of the same features is there already: their number, and which it
    is, -1 where the list is full.
    """
    if count == MAX_PLACES:
        return count, -1
    set_gap(pair, theta, z, False, place, device, bolt, nut, work[W_GAP : W_GAP + GAP_WORK], places[count])
    near = SAME_PLACE * bolt[pk.R_MAJOR]
    for i in range(count):
        apart = 0.0
        for j in range(3):
            apart += abs(places[i, G_POINT + j] - places[count, G_POINT + j])
        if apart < near and places[i, G_PAIR] == pair:
            return count, i
    return count + 1, count


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
    parts = int(device[D_FINE])
    if threads.samples[S_PARTS] != parts:
        set_samples(parts, bolt, nut, threads.samples)
    number = SAMPLES * parts
    depths = work[W_DEPTHS : W_DEPTHS + number]
    step = TWO_PI / number
    lowest = -reach - step * bolt[pk.R_MAJOR]
    level = LEVEL * bolt[pk.R_MAJOR]
    for part in range(2):
        of_bolt = part == 0
        curve = bolt if of_bolt else nut
        solid = nut if of_bolt else bolt
        points = threads.samples[S_POINTS + 2 * part * number :]
        set_depths(of_bolt, number, place, points, points[number:], solid, depths)
        highest = depths.argmax()
        for i in range(number):
            if depths[i] < lowest:
                continue
            before, after = depths[i - 1 if i > 0 else number - 1], depths[i + 1 if i < number - 1 else 0]
            is_level = depths[i] - min(before, after) < level
            if depths[i] < max(before, after) or (is_level and i != highest):
                continue
            kind, theta = peak_beside(of_bolt, i * step, step, place, curve, solid, jet)
            if kind < 0 or (kind == 2 and not of_bolt):
                # The crossing of both edges is found from the bolt's.
                continue
            if is_level and kind != 0:
                continue
            if min(jet[E_G], jet[E_PHI]) < -reach:
                continue
            if kind == 2:
                pair = EDGE_EDGE
            elif kind == 0:
                pair = EDGE_SURFACE if of_bolt else BASE_EDGE
            else:
                pair = EDGE_THREAD if of_bolt else THREAD_EDGE
            count, _ = add_place(pair, theta, 0.0, place, device, bolt, nut, work, count, places)
    if parts < FINEST:
        for i in range(count):
            if places[i, G_VALUE] > -TOUCHING * bolt[pk.R_MAJOR]:
                count = add_beside(i, reach, place, device, bolt, nut, work, count, places)
    return add_threads(reach, place, device, bolt, nut, threads, work, count, places)


@kernel()
def add_beside(
    i: int, reach: float, place: Array, device: Array, bolt: Array, nut: Array, work: Array, count: int, places: Array
) -> int:
    """Adds the places along an edge beside place i of it that the samples do not tell apart; returns their number.

    Where an edge passes over a fillet it may touch on both sides of it. Depths are sampled most finely, as far as two
    samples of the search on either side.
    """
    pair, middle = int(places[i, G_PAIR]), places[i, G_THETA]
    if pair != EDGE_THREAD and pair != THREAD_EDGE:
        return count
    of_bolt = pair == EDGE_THREAD
    curve, solid = (bolt, nut) if of_bolt else (nut, bolt)
    jet = work[W_JET : W_JET + EDGE_JET_SIZE]
    level = LEVEL * bolt[pk.R_MAJOR]
    step = TWO_PI / (SAMPLES * FINEST)
    most = 2 * FINEST // FINE
    before = edge_depth(of_bolt, middle - (most + 1) * step, place, curve, solid)
    here = edge_depth(of_bolt, middle - most * step, place, curve, solid)
    for j in range(-most, most + 1):
        after = edge_depth(of_bolt, middle + (j + 1) * step, place, curve, solid)
        if abs(j) > 1 and here > max(before, after) and here - min(before, after) > level:
            kind, theta = peak_beside(of_bolt, middle + j * step, step, place, curve, solid, jet)
            if kind == 1 and jet[E_PHI] >= -reach:
                count, _ = add_place(pair, theta, 0.0, place, device, bolt, nut, work, count, places)
        before, here = here, after
    return count


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
    placement, samples, maxima = threads.placement, threads.samples, threads.maxima
    for i in range(9):
        placement[i] = place[N_ROTATION + i]
    p = bolt[pk.P]
    # Nothing of the thread lies below the nut's surface where the base does not.
    below = -lowest_height(place, bolt)
    if below <= 0.0:
        return count
    edges = count
    azimuths = thread_azimuths(device)
    if samples[S_AZIMUTHS] != azimuths:
        set_columns(azimuths, bolt, threads.grid)
        samples[S_AZIMUTHS] = azimuths
    set_base(0.0, place, placement)
    for i in range(threads.known_count[0]):
        theta, z = threads.known[i, KNOWN_THETA], threads.known[i, KNOWN_Z]
        count, found = add_thread(theta, z, 0.0, reach, place, device, bolt, nut, threads, work, count, places)
        threads.known[i, KNOWN_PLACE] = found
    # The first pitch comes last, so that its placement is left for the ridges that end at an edge.
    for turn in range(min(math.ceil(below / p), MAX_PITCHES) - 1, -1, -1):
        base = turn * p
        set_base(base, place, placement)
        for j in range(ridge_maxima(azimuths, placement, bolt, nut, threads.grid, threads.crossings, maxima)):
            count, _ = add_thread(
                maxima[j, 0], maxima[j, 1], base, reach, place, device, bolt, nut, threads, work, count, places
            )
    # A ridge that goes from one edge to the other between two azimuths of the grid ends at a maximum along the edge,
    # from which phi rises into both threads: up the bolt's from its base, down it from the nut's surface.
    for i in range(edges):
        pair = int(places[i, G_PAIR])
        theta, z, inward = places[i, G_THETA], 0.0, 1.0
        if pair == THREAD_EDGE:
            x, y, z = moved_point(False, place, places[i, G_POINT], places[i, G_POINT + 1], places[i, G_POINT + 2])
            theta, inward = math.atan2(y, x), -1.0
        if pair == EDGE_THREAD or pair == EDGE_EDGE or pair == THREAD_EDGE:
            set_thread_jet(theta, z, placement, bolt, nut, threads.jet)
            rise = inward * threads.jet[TJ_B]
            if rise > -SLIGHT_SLOPE:
                # Where phi falls a little from the edge it may rise again to a maximum just within.
                jet = threads.jet
                theta, z, kind = maximum_within(theta, z, inward, rise, -reach, placement, bolt, nut, jet)
                if kind == MAXIMUM:
                    count, _ = add_thread(theta, z, 0.0, reach, place, device, bolt, nut, threads, work, count, places)
    remember(edges, count, places, threads)
    return count


@kernel()
def set_base(base: float, place: Array, placement: Array) -> None:
    """Moves a placement of the bolt, in its axes, to where a height over its base is that of the base."""
    for i in range(3):
        placement[9 + i] = place[N_OFFSET + i] + base * place[N_ROTATION + 3 * i + 2]


@kernel(allocates=True)
def remember(edges: int, count: int, places: Array, threads: Threads) -> None:
    """Remembers the places on the threads, which come after those on edges, and forgets maxima that are long missed."""
    known = threads.known
    new = np.ones(MAX_PLACES)
    kept = 0
    for i in range(threads.known_count[0]):
        j = int(known[i, KNOWN_PLACE])
        missed = known[i, KNOWN_MISSED] + 1.0
        if missed > FORGOTTEN or (j >= 0 and new[j] == 0.0):
            continue
        if j < 0:
            set_known(known[i, KNOWN_THETA], known[i, KNOWN_Z], missed, known[kept])
        else:
            set_known(places[j, G_THETA], places[j, G_Z], 0.0, known[kept])
            new[j] = 0.0
        kept += 1
    for j in range(edges, count):
        if new[j] > 0.0 and kept < MAX_KNOWN:
            set_known(places[j, G_THETA], places[j, G_Z], 0.0, known[kept])
            kept += 1
    threads.known_count[0] = kept


@kernel()
def set_known(theta: float, z: float, missed: float, row: Array) -> None:
    """Sets a maximum that is remembered."""
    row[KNOWN_THETA], row[KNOWN_Z], row[KNOWN_MISSED] = theta, z, missed


@kernel()
def lowest_height(place: Array, bolt: Array) -> float:
    """A height that no point of the bolt is below."""
    return place[N_OFFSET + 2] - bolt[pk.R_MAJOR] * math.hypot(place[N_ROTATION + 6], place[N_ROTATION + 7])


@kernel()
def place_of_maximum(count: int, places: Array, jet: Array, near: float) -> int:
    """Which place of thread on thread is within ``near`` of a jet's point, -1 for none."""
    for i in range(count):
        apart = abs(places[i, G_POINT] - jet[TJ_X])
        apart += abs(places[i, G_POINT + 1] - jet[TJ_Y]) + abs(places[i, G_POINT + 2] - jet[TJ_Z])
        if places[i, G_PAIR] == THREAD_THREAD and apart < near:
            return i
    return -1


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
) -> tuple[int, int]:
    """Adds the maximum of phi near a point of the bolt's thread, if it is inside both threads.

    Returns the number of places, and which it is, -1 where there is none.

    ``z`` is counted from the height ``base`` over the bolt's base, to which the placement has moved the bolt.
    """
    placement, jet = threads.placement, threads.jet
    theta, z, kind = thread_maximum(theta, z, base, -reach, placement, bolt, nut, jet)
    if kind != MAXIMUM or jet[TJ_PHI] < -reach or base + z <= 0.0 or jet[TJ_Z] >= 0.0:
        return count, -1
    known = place_of_maximum(count, places, jet, SAME_MAXIMUM * bolt[pk.R_MAJOR])
    if known >= 0:
        return count, known
    at, up, converged = polished_maximum(theta, z, placement, bolt, nut, jet)
    if not converged:
        # Beside a jump of the curvature Newton's method goes to and fro.
        at, up, kind = ridge_maximum(theta, z, base, LATER_RIDGE_STEP, -reach, placement, bolt, nut, jet)
        converged = kind == MAXIMUM
    if converged and jet[TJ_PHI] >= -reach and base + up > 0.0 and jet[TJ_Z] < 0.0:
        return add_place(THREAD_THREAD, at, base + up, place, device, bolt, nut, work, count, places)
    return count, -1
