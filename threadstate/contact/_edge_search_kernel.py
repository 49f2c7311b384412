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
    CAPACITY,
    EXCLUDED,
    ONE_EDGE,
    ONE_PLANE,
    PEAK_EDGE,
    SPLIT_THETA,
    SPLIT_TIME,
    X_BEND_HIGH,
    X_BEND_LOW,
    X_CLASS,
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
from threadstate.contact._branchless_kernel import VECTOR_WIDTH, larger, smaller
from threadstate.contact._edge_kernel import Box, Edge
from threadstate.contact._flank_kernel import no_tangency_on_flanks
from threadstate.contact._geometry_kernel import M_SIGMA, motion_scale
from threadstate.contact._onset_kernel import (
    C_KIND,
    C_THETA,
    C_TIME,
    J_X,
    J_Y,
    J_Z,
    JET_SIZE,
    TIME_SLACK,
    Candidate,
    insert_candidate,
    is_contact,
    newton_onset,
    rises,
    set_jet_beside,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

INITIAL_BOXES = 25
"""Number of boxes over all azimuths with which the search of a span of time begins."""

AZIMUTH_TOLERANCE = 1e-6
"""Half-width (rad) around an earlier contact within which nothing is distinguished from it."""

SAME_AZIMUTH = 0.01
"""Distance (rad) up to which two roots, each found to round-off, may be the same one."""

NARROW = 16.0
"""A box beside a contact narrower than its distance over this is split by time: the way to it counts, not its width."""

FINE = 2.0**-10
"""Half-width (rad) of boxes from which on what is known of earlier contacts is used: of larger ones most are dropped
without, at less cost."""

PIECES = 8
"""Of the way from an earlier contact to a box: so many boxes are evaluated at once."""

ASIDE = 3.0
"""How far from a contact, in half-widths, a box is in which Newton's method is tried: nearer it ends in the contact."""

SLACK = 1e-12
"""Of the size of a sum: more than what its round-off can be."""

ENLARGEMENT = 8.0
"""How many times larger the box is in which the onset is searched for that was not found in a narrow box."""

MAX_BOXES = 16_000

SLENDER = 50.0
"""A box whose duration, over its half-width, is more than this is split by time: at a corner one of azimuth may leave
its uncertainty as it is."""

NARROWEST = 2.0**-51
"""Half-width (rad) of the narrowest box that is split: of a narrower one the sides are the same number."""

NEWTON_COST = 24
"""Cost of a failure of Newton's method in a narrow box, in evaluations of a box."""

OVERFLOW = -1

OUTSIDE, INSIDE, UNDECIDED = range(3)

# A list of entries of edges into open overlaps: their number in the first row; then time, azimuth and axial position on
# the bolt's thread.
E_TIME, E_THETA, E_Z = range(3)
ENTRY_SIZE = 3
MAX_ENTRIES = 16


@kernel()
def set_initial_boxes(since: float, until: float, boxes: Array) -> int:
    """Sets the boxes over all azimuths with which the search of a span of time begins; returns their number.

    Their half-widths are powers of two, and their middles multiples of them: halves are exact, and leave no gap.
    """
    half = 2.0 ** math.floor(math.log2(math.pi / INITIAL_BOXES))
    count = math.ceil(math.pi / half)
    for i in range(count):
        boxes[X_THETA + i] = (2 * i + 1 - count) * half
        boxes[X_HALF + i] = half
        boxes[X_START + i] = since
        boxes[X_END + i] = until
    return count


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
def move_to_front(i: int, end: float, by_time: bool, count: int, boxes: Array) -> int:
    """Moves an undecided box to the front of the list, with how it is to be split; returns the number there then."""
    boxes[X_THETA + count] = boxes[X_THETA + i]
    boxes[X_HALF + count] = boxes[X_HALF + i]
    boxes[X_START + count] = boxes[X_START + i]
    boxes[X_END + count] = end
    boxes[X_CLASS + count] = SPLIT_TIME if by_time else SPLIT_THETA
    return count + 1


@kernel()
def split_boxes(count: int, boxes: Array, spare_boxes: Array) -> int:
    """Splits the boxes at the front of a list into another: in halves, or finer while they fit into one vector."""
    parts = 2
    while 0 < 2 * parts * count <= VECTOR_WIDTH:
        parts *= 2
    m = 0
    for i in range(count):
        theta, half = boxes[X_THETA + i], boxes[X_HALF + i]
        start, end = boxes[X_START + i], boxes[X_END + i]
        by_time = boxes[X_CLASS + i] == SPLIT_TIME
        for j in range(parts):
            spare_boxes[X_THETA + m] = theta if by_time else theta + half * ((2 * j + 1) / parts - 1.0)
            spare_boxes[X_HALF + m] = half if by_time else half / parts
            spare_boxes[X_START + m] = start + (end - start) * j / parts if by_time else start
            spare_boxes[X_END + m] = start + (end - start) * (j + 1) / parts if by_time else end
            m += 1
    return m


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
                    boxes[X_THETA + i],
                    0.5 * (start + end),
                    edge.motion,
                    edge.curve,
                    edge.solid,
                    edge.kept,
                    edge.path,
                )
    classify_boxes(count, edge.motion, edge.curve, edge.solid, boxes)


@kernel()
def evaluate_box(box: Box, edge: Edge, boxes: Array) -> float:
    """The class of a single box, which is set as the first one of ``boxes``."""
    boxes[X_THETA], boxes[X_HALF], boxes[X_START], boxes[X_END] = box
    evaluate_boxes(1, edge, boxes)
    return boxes[X_CLASS]


@kernel(forceinline=True)
def contact_distance(theta: float, kept: Array) -> float:
    """Distance from an azimuth to the nearest earlier contact (rad)."""
    return abs(nearest_contact(theta, kept)[0])


@kernel()
def no_onset_from_contact(box: Box, bend_low: float, bend_high: float, edge: Edge, scratch: Array) -> tuple[bool, bool]:
    """Whether the bend of phi from the nearest contact to a box excludes a tangency with the thread in it.

    At a tangency the integral of s phi_thetatheta over the distance s from the contact is phi at the contact, which is
    zero; where phi_theta is zero there, too, so is that of phi_thetatheta, and of (s - s0) phi_thetatheta for any s0
    (docs/certificate.md, section 7). ``bend_low`` and ``bend_high`` are the range of phi_thetatheta over the box.
    Then whether it may do so in a shorter time.
    """
    theta, half, start, end = box
    kept = edge.kept
    nearest, contact, row = nearest_contact(theta, kept)
    gap = abs(nearest)
    width = (gap - half) / PIECES
    for i in range(PIECES):
        scratch[X_THETA + i] = contact + math.copysign((i + 0.5) * width, nearest)
        scratch[X_HALF + i] = 0.5 * width + 1e-15
        scratch[X_START + i], scratch[X_END + i] = start, end
        scratch[X_G_BESIDE + i], scratch[X_PHI_BESIDE + i], scratch[X_GAP + i] = math.nan, math.nan, math.nan
    classify_boxes(PIECES, edge.motion, edge.curve, edge.solid, scratch)
    touches = kept[row, K_PHI] != 0.0
    tangent = touches and kept[row, K_G] == 0.0 and kept[0, K_TANGENT] != 0.0
    for j in range(1 + PIECES if tangent else 1):
        last = 2.0 * half * (gap - j * width)
        low, high = smaller(bend_low, 0.0) * last, larger(bend_high, 0.0) * last
        size = high - low
        for i in range(PIECES):
            weight = (i + 0.5 - j) * width * width
            one, other = weight * scratch[X_BEND_LOW + i], weight * scratch[X_BEND_HIGH + i]
            low += smaller(one, other)
            high += larger(one, other)
            size += larger(abs(one), abs(other))
        if high < -SLACK * size or (touches and low > SLACK * size):
            return True, False
    if not tangent:
        return False, False
    way = math.copysign(gap + half, nearest)
    return no_tangency_on_flanks(contact, way, start, end, edge.motion, edge.curve, edge.solid)


@kernel()
def onset_only_outside(box_class: int, box: Box, edge: Edge, scratch: Array, jet: Array) -> bool:
    """Whether a larger box has at most one onset, too, and has it outside of this one."""
    theta, half, start, end = box
    span = end - start
    larger_box = Box(theta, half * ENLARGEMENT, start - ENLARGEMENT * span, end + ENLARGEMENT * span)
    found = evaluate_box(larger_box, edge, scratch)
    if found != box_class:
        return found <= EXCLUDED
    inside, t, tau = newton_onset(box_class, larger_box, edge, jet)
    return inside and (abs(t - theta) >= half or tau <= start or tau >= end)


@kernel()
def is_the_one(box_class: int, box: Box, t: float, tau: float, edge: Edge, scratch: Array) -> bool:
    """Whether a root found in a box, or just beside it, is the only one there: the box widened to it has one, too."""
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
        spare_boxes: another one.
        entries: onsets that are not contacts: there an edge enters an open overlap.
    """

    any_onset: bool
    tie_tolerance: float
    boxes: Array
    spare_boxes: Array
    entries: Array


@kernel()
def list_onset(
    box_class: int, t: float, tau: float, edge: Edge, search: EdgeSearch, scratch: Array, count: int, found: Array
) -> tuple[int, bool]:
    """Lists the onset at a root: in ``found`` if it is a contact, else among the entries.

    Returns the number found, and whether it ends the search.
    """
    jet, wedge = np.empty(JET_SIZE), np.empty(9)
    set_jet_beside(t, tau, edge, jet)
    if not rises(box_class, jet) or contact_distance(t, edge.kept) < AZIMUTH_TOLERANCE:
        return count, False
    if not is_contact(box_class, t, tau, edge, jet, wedge):
        insert_entry(tau, t, edge.motion, jet, search.entries)
        return count, search.any_onset
    if not is_listed(box_class, t, tau, edge, scratch, count, found):
        x, y, z = jet[J_X], jet[J_Y], jet[J_Z]
        count = insert_candidate(Candidate(tau, box_class, t, math.atan2(y, x), x, y, z), count, found)
    return count, True


@kernel()
def search_edge(
    since: float, until: float, best: float, edge: Edge, search: EdgeSearch, count: int, found: Array
) -> tuple[int, int, float]:
    """Contacts of an edge curve with the other part's solid from ``since`` to ``until``.

    ``best`` is the earliest time known. Returns the number of candidates in ``found`` (earliest first), the number of
    boxes evaluated (OVERFLOW: too many) and the earliest time. A root that round-off puts before the start counts as
    before it.
    """
    boxes, spare_boxes = search.boxes, search.spare_boxes
    jet = np.empty(JET_SIZE)
    scale = motion_scale(edge.motion, edge.solid)
    earliest = since - TIME_SLACK * scale
    evaluated = 0
    narrowest = math.inf
    n = set_initial_boxes(since, min(until, best + search.tie_tolerance), boxes)
    while n > 0:
        n = pad_boxes(n, boxes)
        evaluate_boxes(n, edge, boxes)
        evaluated += n
        m = 0
        for i in range(n):
            box_class = int(boxes[X_CLASS + i])
            box = Box(boxes[X_THETA + i], boxes[X_HALF + i], boxes[X_START + i], boxes[X_END + i])
            if box_class <= EXCLUDED or box.half == 0.0 or box.start > best + search.tie_tolerance:
                continue
            gap = contact_distance(box.theta, edge.kept)
            if gap + box.half < AZIMUTH_TOLERANCE or (gap <= box.half + 1e-13 and box_class < SPLIT_THETA):
                continue
            shorter = False
            if box.half <= FINE and box.half < gap < BESIDE and boxes[X_G_LOW + i] > 0.0:
                bends = boxes[X_BEND_LOW + i], boxes[X_BEND_HIGH + i]
                no_onset, shorter = no_onset_from_contact(box, bends[0], bends[1], edge, spare_boxes)
                if no_onset:
                    continue
            if box_class <= ONE_PLANE and gap > ASIDE * box.half:
                inside, t, tau = newton_onset(box_class, box, edge, jet)
                inside = inside and is_the_one(box_class, box, t, tau, edge, spare_boxes)
                if inside and earliest <= tau <= best + search.tie_tolerance:
                    count, ends = list_onset(box_class, t, tau, edge, search, spare_boxes, count, found)
                    best = min(best, tau) if ends else best
                if inside or (
                    box.half < AZIMUTH_TOLERANCE and onset_only_outside(box_class, box, edge, spare_boxes, jet)
                ):
                    continue
                evaluated += NEWTON_COST if box.half < AZIMUTH_TOLERANCE else 0
            by_time = (
                box_class == SPLIT_TIME
                or (box_class < SPLIT_THETA and box.end - box.start > box.half)
                or box.end - box.start > SLENDER * scale * box.half
                or (shorter and box.half < gap / NARROW)
            )
            narrowest = min(narrowest, box.half)
            m = move_to_front(i, min(box.end, best + search.tie_tolerance), by_time, m, boxes)
        if 2 * m + VECTOR_WIDTH > CAPACITY or evaluated > MAX_BOXES or narrowest < NARROWEST:
            return count, OVERFLOW, best
        n = split_boxes(m, boxes, spare_boxes)
        boxes, spare_boxes = spare_boxes, boxes
    return count, evaluated, best


@kernel()
def find_inside(edge: Edge, shallow: float, narrow: float, boxes: Array, spare_boxes: Array) -> tuple[int, float]:
    """Whether the edge curve is inside the other solid at the start of a motion, except at earlier contacts.

    Returns INSIDE and the azimuth of a point that is; OUTSIDE: nowhere by more than ``shallow`` thread pitches over
    more than ``narrow`` (rad); UNDECIDED: too many boxes.
    """
    n = set_initial_boxes(0.0, 0.0, boxes)
    while n > 0:
        n = pad_boxes(n, boxes)
        evaluate_boxes(n, edge, boxes)
        m = 0
        deepest, azimuth = shallow * edge.solid[pk.P], 0.0
        for i in range(n):
            box_class = int(boxes[X_CLASS + i])
            half = boxes[X_HALF + i]
            if box_class == ALL_OUTSIDE or half < narrow:
                continue
            theta, depth = boxes[X_THETA + i], boxes[X_DEPTH + i]
            if depth > deepest:
                deepest, azimuth = depth, theta
            if (box_class == ONE_EDGE or box_class == PEAK_EDGE) and contact_distance(theta, edge.kept) <= half:
                continue
            m = move_to_front(i, 0.0, False, m, boxes)
        if deepest > shallow * edge.solid[pk.P]:
            return INSIDE, azimuth
        if 2 * m + VECTOR_WIDTH > CAPACITY:
            return UNDECIDED, 0.0
        n = split_boxes(m, boxes, spare_boxes)
        boxes, spare_boxes = spare_boxes, boxes
    return OUTSIDE, 0.0
