"""All contact onsets on one part's edge curve during a span of time, by branch and bound over azimuth and time."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._beside_kernel import BESIDE, K_G, K_PHI, K_TANGENT, nearest_contact, values_beside
from threadstate.contact._box_kernel import (
    ALL_OUTSIDE,
    EXCLUDED,
    ONE_EDGE,
    ONE_PLANE,
    PEAK_EDGE,
    UNDECIDED_BOX,
    X_BEND_HIGH,
    X_BEND_LOW,
    X_BY_TIME,
    X_CLASS,
    X_DEEPEST,
    X_DEPTH,
    X_END,
    X_G_BESIDE,
    X_G_LOW,
    X_GAP,
    X_HALF,
    X_PHI_BESIDE,
    X_START,
    X_THETA,
    classify_boxes,
)
from threadstate.contact._branchless_kernel import VECTOR_WIDTH, larger, larger_or_nan, smaller, smaller_or_nan
from threadstate.contact._edge_kernel import Box, Edge
from threadstate.contact._flank_kernel import no_tangency_on_flanks
from threadstate.contact._geometry_kernel import M_SIGMA, motion_scale
from threadstate.contact._initial_box_kernel import drop_above, set_initial_boxes
from threadstate.contact._onset_kernel import (
    C_KIND,
    C_THETA,
    C_TIME,
    J_X,
    J_Y,
    J_Z,
    ROOT_AT_SIDE,
    ROOT_BESIDE,
    ROOT_INSIDE,
    TIME_SLACK,
    Candidate,
    insert_candidate,
    jet_errors,
    newton_onset,
    onset_step,
    rises,
    set_jet_beside,
)
from threadstate.contact._queue_kernel import ROOM, Queue, add, clear, first, remove_first, row, set_row
from threadstate.contact._refined_edge_kernel import classify_refined, is_refined
from threadstate.contact._wedge_kernel import crossing_of, is_contact, is_doubtful
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Bends = tuple[float, float]

AZIMUTH_TOLERANCE = 1e-6
"""Half-width (rad) around an earlier contact within which nothing is distinguished from it."""

SAME_AZIMUTH = 0.01
"""Distance (rad) up to which two roots, each found to round-off, may be the same one."""

NARROW = 16.0
"""A box beside a contact narrower than its distance over this is split by time: the way to it counts, not its width."""

FINE = 2.0**-10
"""Half-width (rad) of boxes from which on what is known of earlier contacts is used: of larger ones most are dropped
without, at less cost."""

SHALLOW = 1e-11
"""Depth (thread pitches) that no point of a box exceeds: of refined edges a wider one is evaluated in sums of two
doubles, too. Round-off hides what is in it, where that of a deeper one is its width's."""

PIECES = 4
"""Of the way from an earlier contact to a box: so many boxes are evaluated at once."""

OUTWEIGHED = 8.0
"""How far from a contact, in half-widths, a box is of which a bend of no certain sign may be outweighed by that of the
way: nearer it is not."""

ASIDE = 3.0
"""How far from a contact, in half-widths, a box is in which Newton's method is tried: nearer it ends in the contact."""

SLACK = 1e-12
"""Of the size of a sum: more than what its round-off can be."""

ENLARGEMENT = 8.0
"""How many times larger the box is in which the onset is searched for that was not found in a narrow box."""

MAX_BOXES = 16_000

MAX_REGIONS = 8
REGION_SIZES = 8
"""The most regions that are kept, and how many boxes about an onset are tried for one, each twice as large as the one
before."""

AT_ONCE = 8
BATCH = 16
"""Boxes evaluated at once: as many as a few are split into, as fewer would take about as long, and the most."""

SLENDER = 50.0
"""A box whose duration, over its half-width, is more than this is split by time: at a corner one of azimuth may leave
its uncertainty as it is."""

CLOSE = 2.0**-17
"""Half-width (rad) of a box about an earlier contact that is not split by time for being slender: at all times what is
left of it by azimuth ends as the contact itself."""

SHORTEST = 1e-12
"""A box with at most one onset that is no longer than this, in units of ``motion_scale``, is split by azimuth."""

NARROWEST = 2.0**-51
"""Half-width (rad) of the narrowest box that is split by azimuth: of a narrower one the sides are the same number."""

NARROWEST_IN_DOUBLES = 2.0**-36
"""Half-width (rad) of a box that ends a search in doubles: round-off hides what is in it. Refined edges tell it."""

ROUND_OFF_BEFORE = 1024.0
"""An onset is not earlier than its time by so many times what the error of that can be."""

NEWTON_COST = 24
"""Cost of a failure of Newton's method in a narrow box, in evaluations of a box."""

OVERFLOW = -1

OUTSIDE, INSIDE, UNDECIDED = range(3)

# A list of entries of edges into open overlaps: in the first row their number, the earliest time of an onset of which
# it is doubtful if it is one, and one before which no contact and no such onset is; then time, azimuth and axial
# position on the bolt's thread.
E_DOUBTFUL, E_NONE_BEFORE = 1, 2
E_TIME, E_THETA, E_Z = range(3)
ENTRY_SIZE = 3
MAX_ENTRIES = 16


@kernel()
def pad_boxes(count: int, boxes: Array) -> int:
    """Pads the list to whole vectors with empty boxes; returns the number of boxes then."""
    while count % VECTOR_WIDTH != 0:
        boxes[X_THETA + count] = 0.0
        boxes[X_HALF + count] = 0.0
        boxes[X_START + count] = 0.0
        boxes[X_END + count] = 0.0
        count += 1
    return count


@kernel()
def set_box_at(box: Box, i: int, boxes: Array) -> None:
    """Sets the azimuths and times of a box of the list."""
    boxes[X_THETA + i], boxes[X_HALF + i], boxes[X_START + i], boxes[X_END + i] = box


@kernel(forceinline=True)
def box_at(i: int, boxes: Array) -> Box:
    """The azimuths and times of a box of the list."""
    return Box(boxes[X_THETA + i], boxes[X_HALF + i], boxes[X_START + i], boxes[X_END + i])


@kernel(forceinline=True)
def part_of(box: Box, by_time: bool, j: int, share: float) -> Box:
    """One of equal parts of a box, by time or by azimuth, each that ``share`` of it: a negative power of two."""
    theta, half, start, end = box
    if by_time:
        return Box(theta, half, start + (end - start) * j * share, start + (end - start) * (j + 1) * share)
    return Box(theta + half * ((2 * j + 1) * share - 1.0), half * share, start, end)


@kernel()
def evaluate_boxes(count: int, edge: Edge, boxes: Array) -> None:
    """Sets the classes of boxes; g and phi beside earlier contacts are differences from them."""
    for i in range(count):
        boxes[X_G_BESIDE + i], boxes[X_PHI_BESIDE + i], boxes[X_GAP + i] = math.nan, math.nan, math.nan
    if edge.kept[0, 0] > 0.0:
        for i in range(count):
            start, end = boxes[X_START + i], boxes[X_END + i]
            if boxes[X_HALF + i] <= FINE and 0.5 * (end - start) <= BESIDE:
                boxes[X_G_BESIDE + i], boxes[X_PHI_BESIDE + i], boxes[X_GAP + i] = values_beside(
                    boxes[X_THETA + i], 0.5 * (start + end), edge
                )
    classify_boxes(count, edge.motion, edge.curve, edge.solid, boxes)
    if is_refined(edge):
        classify_refined(count, EXCLUDED, FINE, SHALLOW * edge.solid[pk.P], edge, boxes)


@kernel()
def evaluate_box(box: Box, edge: Edge, boxes: Array) -> float:
    """The class of a single box, which is set as the first one of ``boxes``."""
    set_box_at(box, 0, boxes)
    evaluate_boxes(1, edge, boxes)
    return boxes[X_CLASS]


@kernel(forceinline=True)
def contact_distance(theta: float, kept: Array) -> float:
    """Distance from an azimuth to the nearest earlier contact (rad)."""
    return abs(nearest_contact(theta, kept)[0])


@kernel()
def bend_excludes(
    box: Box, nearest: float, contact: float, touches: bool, tangent: bool, bends: Bends, edge: Edge, scratch: Array
) -> bool:
    """Whether the bend of phi on the way from a contact to a box excludes a tangency with the thread in it.

    At a tangency the integral of s phi_thetatheta over the distance s from the contact is phi at the contact, which is
    zero; where phi_theta is zero there, too, so is that of phi_thetatheta, and of (s - s0) phi_thetatheta for any s0
    (docs/certificate.md, section 7). ``nearest`` is how far the box's middle is from the azimuth of the ``contact``;
    ``touches`` and ``tangent`` say if phi and phi_theta are zero there, ``bends`` is the range of phi_thetatheta over
    the box.
    """
    _, half, start, end = box
    bend_low, bend_high = bends
    gap = abs(nearest)
    width = (gap - half) / PIECES
    for i in range(PIECES):
        scratch[X_THETA + i] = contact + math.copysign((i + 0.5) * width, nearest)
        scratch[X_HALF + i] = 0.5 * width + 1e-15
        scratch[X_START + i], scratch[X_END + i] = start, end
        scratch[X_G_BESIDE + i], scratch[X_PHI_BESIDE + i], scratch[X_GAP + i] = math.nan, math.nan, math.nan
    classify_boxes(PIECES, edge.motion, edge.curve, edge.solid, scratch)
    if is_refined(edge):
        classify_refined(PIECES, -1.0, math.inf, 0.0, edge, scratch)
    for j in range(1 + PIECES if tangent else 1):
        last = 2.0 * half * (gap - j * width)
        low, high = smaller(0.0, bend_low) * last, larger(0.0, bend_high) * last
        size = high - low
        for i in range(PIECES):
            weight = (i + 0.5 - j) * width * width
            one, other = weight * scratch[X_BEND_LOW + i], weight * scratch[X_BEND_HIGH + i]
            low += smaller_or_nan(one, other)
            high += larger_or_nan(one, other)
            size += larger_or_nan(abs(one), abs(other))
        if high < -SLACK * size or (touches and low > SLACK * size):
            return True
    return False


@kernel()
def no_onset_from_contact(box: Box, bends: Bends, edge: Edge, scratch: Array) -> tuple[bool, bool]:
    """Whether there is no tangency with the thread in a box, as the nearest contact touches at all times.

    ``bends`` is the range of phi_thetatheta over the box. Then whether there may be none in a shorter time.
    """
    theta, half, start, end = box
    kept = edge.kept
    nearest, contact, number = nearest_contact(theta, kept)
    touches = kept[number, K_PHI] != 0.0
    tangent = touches and kept[number, K_G] == 0.0 and kept[0, K_TANGENT] != 0.0
    is_one_way = bends[1] < 0.0 or (touches and bends[0] > 0.0)
    if (is_one_way or abs(nearest) > OUTWEIGHED * half) and bend_excludes(
        box, nearest, contact, touches, tangent, bends, edge, scratch
    ):
        return True, False
    if not tangent:
        return False, False
    way = nearest + math.copysign(half, nearest)
    return no_tangency_on_flanks(contact, way, start, end, edge.motion, edge.curve, edge.solid)


@kernel()
def is_the_one(box_class: int, box: Box, t: float, tau: float, edge: Edge, scratch: Array) -> bool:
    """Whether a root in a box, or beside it, is the only one there: the box widened to it has at most one, too."""
    theta, half, start, end = box
    if abs(t - theta) <= half and start <= tau <= end:
        return True
    widened = Box(theta, max(half, abs(t - theta)), min(start, tau), max(end, tau))
    return evaluate_box(widened, edge, scratch) == box_class


@kernel()
def is_listed(box_class: int, t: float, tau: float, edge: Edge, scratch: Array, count: int, found: Array) -> bool:
    """Whether a root is a candidate that is listed: there is a box around both that has at most one onset."""
    for i in range(count):
        if found[i, C_KIND] == box_class and abs(found[i, C_THETA] - t) < SAME_AZIMUTH:
            theta, half = 0.5 * (found[i, C_THETA] + t), 0.5 * abs(found[i, C_THETA] - t) + 1e-15
            around_both = Box(theta, half, min(found[i, C_TIME], tau), max(found[i, C_TIME], tau))
            if evaluate_box(around_both, edge, scratch) == box_class:
                return True
    return False


@kernel()
def insert_entry(tau: float, theta: float, motion: Array, jet: Array, entries: Array) -> None:
    """Inserts the point of the bolt's thread at which an edge enters an open overlap; a full list drops the latest."""
    place = int(entries[0, 0]) + 1
    if place == entries.shape[0]:
        place = 1
        for i in range(2, entries.shape[0]):
            if entries[i, E_TIME] > entries[place, E_TIME]:
                place = i
        if not tau < entries[place, E_TIME]:
            return
    else:
        entries[0, 0] = place
    is_bolt_edge = motion[M_SIGMA] > 0.0
    entries[place, E_TIME] = tau
    entries[place, E_THETA] = theta if is_bolt_edge else math.atan2(jet[J_Y], jet[J_X])
    entries[place, E_Z] = 0.0 if is_bolt_edge else jet[J_Z]


class EdgeSearch(NamedTuple):
    """What a search of a motion is to find, and its lists.

    Attributes:
        any_onset: whether an onset that is not a contact ends the search, too.
        tie_tolerance: how long after the earliest time the search ends.
        boxes: a list of boxes.
        scratch: another one.
        queue: undecided boxes (``_queue_kernel``).
        regions: in the first row how many were kept, and how many boxes were evaluated since that was zero; then boxes
            about onsets that are found, in which there is no other one, the latest ``MAX_REGIONS``: rows as the fields
            of ``Box``.
        entries: onsets that are not contacts: there an edge enters an open overlap. In the first row the time of one
            of which round-off hides if it is, and one before which there is neither such a one nor a contact.
        jet: scratch of an onset.
        wedge: scratch of a crossing.
    """

    any_onset: bool
    tie_tolerance: float
    boxes: Array
    scratch: Array
    queue: Queue
    regions: Array
    entries: Array
    jet: Array
    wedge: Array


@kernel()
def list_onset(
    box_class: int, t: float, tau: float, edge: Edge, search: EdgeSearch, scratch: Array, count: int, found: Array
) -> tuple[int, bool]:
    """Lists the onset at a root: in ``found`` if it is a contact, else among the entries.

    Returns the number found, and whether it ends the search.
    """
    jet, wedge, entries = search.jet, search.wedge, search.entries
    set_jet_beside(t, tau, edge, jet)
    if not rises(box_class, jet) or contact_distance(t, edge.kept) < AZIMUTH_TOLERANCE:
        return count, False
    errors = jet_errors(tau, edge)
    _, _, _, _, tau_error = onset_step(box_class, jet, errors[0], errors[1])
    not_before = tau - ROUND_OFF_BEFORE * tau_error
    crossing = crossing_of(box_class, t, tau, edge, jet, wedge)
    if box_class == ONE_EDGE and is_doubtful(t, tau, crossing, search.tie_tolerance, edge, jet, wedge):
        entries[0, E_DOUBTFUL] = min(entries[0, E_DOUBTFUL], tau)
        entries[0, E_NONE_BEFORE] = min(entries[0, E_NONE_BEFORE], not_before)
    if not is_contact(box_class, t, tau, crossing, edge, jet, wedge):
        insert_entry(tau, t, edge.motion, jet, entries)
        return count, search.any_onset
    entries[0, E_NONE_BEFORE] = min(entries[0, E_NONE_BEFORE], not_before)
    if not is_listed(box_class, t, tau, edge, scratch, count, found):
        x, y, z = jet[J_X], jet[J_Y], jet[J_Z]
        count = insert_candidate(Candidate(tau, box_class, t, math.atan2(y, x), x, y, z), count, found)
    return count, True


@kernel()
def keep_region(box_class: int, box: Box, t: float, tau: float, edge: Edge, search: EdgeSearch) -> None:
    """Keeps the largest box about the onset found in ``box`` that has no other one, of those that are evaluated.

    Without it what lies beside an onset would be split until its bounds tell it from the onset itself: the cluster
    effect of branch and bound.
    """
    scratch, regions = search.scratch, search.regions
    room = contact_distance(t, edge.kept)
    half, duration = box.half, box.end - box.start
    number = int(regions[0, 0])
    place = 1 + number % MAX_REGIONS
    for _ in range(REGION_SIZES // VECTOR_WIDTH):
        for i in range(VECTOR_WIDTH):
            set_box_at(Box(t, half, tau - duration, tau + duration), i, scratch)
            half, duration = 2.0 * half, 2.0 * duration
        evaluate_boxes(VECTOR_WIDTH, edge, scratch)
        for i in range(VECTOR_WIDTH):
            if scratch[X_CLASS + i] != box_class or scratch[X_HALF + i] >= room:
                return
            regions[place, 0], regions[place, 1], regions[place, 2], regions[place, 3] = box_at(i, scratch)
            regions[0, 0] = number + 1


@kernel(forceinline=True)
def outside_regions(box: Box, regions: Array) -> Box:
    """What is left of a box without the times at which all its azimuths are in a region; half-width 0: nothing."""
    theta, half, start, end = box
    for i in range(1, 1 + min(int(regions[0, 0]), MAX_REGIONS)):
        if abs(theta - regions[i, 0]) + half + NARROWEST > regions[i, 1]:
            continue
        since, until = regions[i, 2], regions[i, 3]
        if start >= since and end <= until:
            return Box(theta, 0.0, start, end)
        if since <= start < until:
            start = until
        elif since < end <= until:
            end = since
    return Box(theta, half, start, end)


@kernel()
def list_in_time(
    box_class: int,
    t: float,
    tau: float,
    since: float,
    best: float,
    edge: Edge,
    search: EdgeSearch,
    count: int,
    found: Array,
) -> tuple[int, float]:
    """Lists the onset at a root that begins in time; returns the number in ``found``, and the earliest time."""
    if since <= tau <= best + search.tie_tolerance:
        count, ends = list_onset(box_class, t, tau, edge, search, search.scratch, count, found)
        best = min(best, tau) if ends else best
    return count, best


@kernel()
def close_by_onset(
    box_class: int, box: Box, since: float, best: float, edge: Edge, search: EdgeSearch, count: int, found: Array
) -> tuple[bool, int, float]:
    """Whether Newton's method closes a box with at most one onset: it finds the one there is, in the box or beside it.

    It is listed in ``found`` if it begins in time, and is not beside the box by more than round-off: from the neighbour
    that may put it into this one. Returns the number there then, and the earliest time.
    """
    theta, half, start, end = box
    is_narrow = half < AZIMUTH_TOLERANCE
    place, t, tau = newton_onset(box_class, box, edge, search.jet)
    is_located = place == ROOT_INSIDE or place == ROOT_BESIDE or (place == ROOT_AT_SIDE and is_narrow)
    if is_located and is_the_one(box_class, box, t, tau, edge, search.scratch):
        if place != ROOT_BESIDE:
            keep_region(box_class, box, t, tau, edge, search)
            count, best = list_in_time(box_class, t, tau, since, best, edge, search, count, found)
        return True, count, best
    if not is_narrow:
        return False, count, best
    longer = ENLARGEMENT * (end - start)
    larger_box = Box(theta, half * ENLARGEMENT, start - longer, end + longer)
    larger_class = evaluate_box(larger_box, edge, search.scratch)
    if larger_class != box_class:
        return larger_class <= EXCLUDED, count, best
    place, t, tau = newton_onset(box_class, larger_box, edge, search.jet)
    if place != ROOT_INSIDE:
        return False, count, best
    count, best = list_in_time(box_class, t, tau, since, best, edge, search, count, found)
    return True, count, best


@kernel(forceinline=True)
def splits_by_time(box_class: int, box: Box, shorter: bool, gap: float, by_time: bool, scale: float) -> bool:
    """Whether an undecided box is split by time: where its bounds say so (``by_time``), as long as it is not short.

    And where it is slender, unless it is ``CLOSE`` about a contact, or is as narrow as the way to the nearest contact
    allows that excludes it in a ``shorter`` time. The narrowest ones are split by time alone.
    """
    duration = box.end - box.start
    shortest = NARROWEST * min(scale, box.end)
    if box.half < NARROWEST:
        return duration > shortest
    if box_class < UNDECIDED_BOX:
        return (by_time and duration > SHORTEST * scale) or (shorter and box.half < gap / NARROW)
    return (
        (by_time and duration > shortest)
        or (duration > SLENDER * scale * box.half and (gap > box.half or box.half > CLOSE))
        or (shorter and box.half < gap / NARROW)
    )


@kernel()
def search_edge(
    since: float, until: float, best: float, edge: Edge, search: EdgeSearch, count: int, found: Array
) -> tuple[int, int, float, float]:
    """Contacts of an edge curve with the other part's solid from ``since`` to ``until``.

    ``best`` is the earliest time known. Boxes are looked at in the order of their starts, so that an early contact
    spares the later ones. Returns the number of candidates in ``found`` (earliest first), the number of boxes evaluated
    (OVERFLOW: too many), the earliest time, and the time before which nothing is undecided. A root that round-off puts
    before the start counts as before it.
    """
    boxes, queue = search.boxes, search.queue
    scale = motion_scale(edge.motion, edge.solid)
    earliest = since - TIME_SLACK * scale
    search.regions[0, 0] = 0.0
    clear(queue)
    evaluated = 0
    waiting = 0
    narrowest = math.inf
    ending = NARROWEST if is_refined(edge) else NARROWEST_IN_DOUBLES
    n = drop_above(set_initial_boxes(since, min(until, best + search.tie_tolerance), boxes), edge, boxes)
    while n > 0:
        evaluate_boxes(pad_boxes(n, boxes), edge, boxes)
        evaluated += n
        search.regions[0, 1] += n
        m = 0
        for i in range(n):
            box_class = int(boxes[X_CLASS + i])
            box = box_at(i, boxes)
            if box_class <= EXCLUDED or box.half == 0.0 or box.start > best + search.tie_tolerance:
                continue
            gap = contact_distance(box.theta, edge.kept)
            if gap + box.half < AZIMUTH_TOLERANCE or (gap <= box.half + 1e-13 and box_class < UNDECIDED_BOX):
                continue
            shorter = False
            if box.half <= FINE and box.half < gap < BESIDE and boxes[X_G_LOW + i] > 0.0:
                bends = boxes[X_BEND_LOW + i], boxes[X_BEND_HIGH + i]
                no_onset, shorter = no_onset_from_contact(box, bends, edge, search.scratch)
                if no_onset:
                    continue
            if box_class <= ONE_PLANE and gap > ASIDE * box.half:
                closed, count, best = close_by_onset(box_class, box, earliest, best, edge, search, count, found)
                if closed:
                    continue
                evaluated += NEWTON_COST if box.half < AZIMUTH_TOLERANCE else 0
            by_time = splits_by_time(box_class, box, shorter, gap, boxes[X_BY_TIME + i] > 0.0, scale)
            narrowest = narrowest if by_time else min(narrowest, box.half)
            box = outside_regions(box, search.regions)
            if box.half > 0.0:
                set_box_at(box, m, boxes)
                boxes[X_BY_TIME + m] = 1.0 if by_time else 0.0
                m += 1
        if waiting + AT_ONCE * m > ROOM or evaluated > MAX_BOXES or narrowest < ending:
            undecided = first(queue).start if waiting > 0 else until
            for i in range(m):
                undecided = min(undecided, boxes[X_START + i])
            return count, OVERFLOW, best, undecided
        waiting = add_parts(m, best + search.tie_tolerance, boxes, waiting, queue)
        n, waiting = take_batch(best + search.tie_tolerance, boxes, waiting, queue)
    return count, evaluated, best, until


@kernel()
def parts_for(count: int) -> int:
    """Into how many parts so many boxes are split: in halves, or finer while all are ``AT_ONCE``."""
    parts = 2
    while 0 < 2 * parts * count <= AT_ONCE:
        parts *= 2
    return parts


@kernel()
def add_parts(count: int, latest: float, boxes: Array, waiting: int, queue: Queue) -> int:
    """Splits the first boxes of a list and adds the parts that start by ``latest`` to those that wait.

    They are halves, or finer if none are waiting. Returns how many wait then.
    """
    parts = parts_for(count) if waiting == 0 else 2
    share = 1.0 / parts
    for i in range(count):
        theta, half, start, end = box_at(i, boxes)
        box, by_time = Box(theta, half, start, min(end, latest)), boxes[X_BY_TIME + i] > 0.0
        for j in range(parts):
            part = part_of(box, by_time, j, share)
            if part.start <= latest:
                add(part, queue)
                waiting += 1
    return waiting


@kernel()
def take_batch(latest: float, boxes: Array, waiting: int, queue: Queue) -> tuple[int, int]:
    """Takes the first boxes of those that wait into a list, up to ``BATCH``; returns how many, and how many still wait.

    Where the first one starts after ``latest`` all are dropped.
    """
    n = 0
    while n < BATCH and waiting > 0:
        theta, half, start, end = first(queue)
        if start > latest:
            clear(queue)
            return n, 0
        set_box_at(Box(theta, half, start, min(end, latest)), n, boxes)
        n += 1
        remove_first(queue)
        waiting -= 1
    return n, waiting


@kernel()
def find_inside(edge: Edge, shallow: float, narrow: float, boxes: Array, queue: Queue) -> tuple[int, float]:
    """Whether the edge curve is inside the other solid at the start of a motion, except at earlier contacts.

    Returns INSIDE and the azimuth of a point that is; OUTSIDE: nowhere by more than ``shallow`` thread pitches over
    more than ``narrow`` (rad); UNDECIDED: too many boxes.
    """
    undecided = ROOM // 2
    n = drop_above(set_initial_boxes(0.0, 0.0, boxes), edge, boxes)
    for i in range(n):
        set_row(Box(boxes[X_THETA + i], boxes[X_HALF + i], 0.0, 0.0), i, queue)
    while n > 0:
        m = 0
        deepest, azimuth = shallow * edge.solid[pk.P], 0.0
        for begin in range(0, n, BATCH):
            size = min(BATCH, n - begin)
            for i in range(size):
                set_box_at(row(begin + i, queue), i, boxes)
            evaluate_boxes(pad_boxes(size, boxes), edge, boxes)
            for i in range(size):
                box_class = int(boxes[X_CLASS + i])
                theta, half, depth = boxes[X_THETA + i], boxes[X_HALF + i], boxes[X_DEPTH + i]
                is_shallow = boxes[X_DEEPEST + i] <= shallow * edge.solid[pk.P]
                if box_class == ALL_OUTSIDE or is_shallow or half < narrow:
                    continue
                if depth > deepest:
                    deepest, azimuth = depth, theta
                if (box_class == ONE_EDGE or box_class == PEAK_EDGE) and contact_distance(theta, edge.kept) <= half:
                    continue
                set_row(Box(theta, half, 0.0, 0.0), undecided + m, queue)
                m += 1
        if deepest > shallow * edge.solid[pk.P]:
            return INSIDE, azimuth
        parts = parts_for(m)
        if m * parts > undecided:
            return UNDECIDED, 0.0
        share = 1.0 / parts
        for i in range(m):
            box = row(undecided + i, queue)
            for j in range(parts):
                set_row(part_of(box, False, j, share), parts * i + j, queue)
        n = m * parts
    return OUTSIDE, 0.0
