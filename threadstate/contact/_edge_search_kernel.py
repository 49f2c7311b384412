"""All contact onsets on one part's edge curve during a span of time, by branch and bound over azimuth and time."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._box_kernel import (
    ALL_OUTSIDE,
    CAPACITY,
    EXCLUDED,
    ONE_EDGE,
    ONE_PLANE,
    ONE_THREAD,
    PEAK_EDGE,
    PEAK_THREAD,
    SPLIT_THETA,
    SPLIT_TIME,
    X_CLASS,
    X_DEPTH,
    X_END,
    X_HALF,
    X_LARGEST_DEPTH,
    X_PHI_THETA_THETA,
    X_START,
    X_THETA,
    classify_boxes,
)
from threadstate.contact._geometry_kernel import M_SIGMA, PATH_SIZE, TWO_PI, motion_scale
from threadstate.contact._onset_kernel import (
    J_G,
    J_PHI,
    J_X,
    J_Y,
    J_Z,
    JET_SIZE,
    bracketed_onset,
    insert_candidate,
    is_contact,
    newton_onset,
    rises,
    set_jet,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

INITIAL_BOXES = 25
"""Number of boxes over all azimuths with which the search of a span of time begins."""

AZIMUTH_TOLERANCE = 1e-6
"""Half-width (rad) around an earlier contact within which nothing is distinguished from it."""

JOIN_DISTANCE = 1e-2
"""Distance (rad) from an earlier contact up to which an onset may be joined to it."""

CONCAVITY_REACH = 16.0
"""Distance from an earlier contact, in half-widths of a box, up to which phi is tested for concavity from there on."""

ENLARGEMENT = 8.0
"""How many times larger the box is in which the onset is searched for that was not found in a narrow box."""

ROUND_OFF = 1e-14
"""What the round-off of a distance from a surface is taken for, in thread pitches (docs/certificate.md, section 7)."""

TOUCHING = 4.0
"""A box in which that distance is known to be so many times larger somewhere does not touch throughout."""

LEAST_DIP = 4e-15
"""The same of the values that bounds of boxes are made of: a curve that leaves the surface by less lies on it."""

LEAST_DEPTH = 2e-15
"""A box in which the distance from the surface is less, as far as round-off lets it be known, lies on it."""

MAX_BOXES = 16_000

SLENDER = 50.0
"""A box whose duration, over its half-width, is more than this is split by time: at a corner one of azimuth may leave
its uncertainty as it is."""

NARROWEST = 2.0**-51
"""Half-width (rad) of the narrowest box that is split: of a narrower one the sides are the same number."""

NEWTON_COST = 24
"""Cost of a failure of Newton's method in a narrow box, in evaluations of a box."""

OVERFLOW = -1
VECTOR_WIDTH = 8

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
def contact_distance(theta: float, contact_azimuths: Array, azimuth_count: int) -> float:
    """Distance from an azimuth to the nearest earlier contact (rad)."""
    nearest = math.pi
    for j in range(azimuth_count):
        gap = theta - contact_azimuths[j]
        gap -= TWO_PI * math.floor(gap / TWO_PI + 0.5)
        nearest = min(nearest, abs(gap))
    return nearest


@kernel()
def concave_from_contact(
    theta: float,
    half: float,
    start: float,
    end: float,
    motion: Array,
    curve_profile: Array,
    solid_profile: Array,
    contact_azimuths: Array,
    azimuth_count: int,
    scratch: Array,
) -> bool:
    """Whether phi is concave from the nearest earlier contact to the far end of a box, at all times of the box.

    At that contact phi is not negative, so that phi then rises through zero at no maximum between.
    """
    nearest = math.inf
    for j in range(azimuth_count):
        gap = theta - contact_azimuths[j]
        gap -= TWO_PI * math.floor(gap / TWO_PI + 0.5)
        if abs(gap) < abs(nearest):
            nearest = gap
    near = theta - nearest
    far = theta + math.copysign(half, nearest)
    scratch[X_THETA] = 0.5 * (near + far)
    scratch[X_HALF] = 0.5 * abs(far - near) + 1e-12
    scratch[X_START] = start
    scratch[X_END] = end
    classify_boxes(1, motion, curve_profile, solid_profile, scratch)
    return scratch[X_PHI_THETA_THETA] < 0.0


@kernel()
def onset_only_outside(
    box_class: int,
    theta: float,
    half: float,
    start: float,
    end: float,
    motion: Array,
    curve_profile: Array,
    solid_profile: Array,
    scratch: Array,
    path: Array,
    jet: Array,
) -> bool:
    """Whether a larger box has at most one onset, too, and has it outside of this one."""
    span = end - start
    scratch[X_THETA] = theta
    scratch[X_HALF] = half * ENLARGEMENT
    scratch[X_START] = start - ENLARGEMENT * span
    scratch[X_END] = end + ENLARGEMENT * span
    classify_boxes(1, motion, curve_profile, solid_profile, scratch)
    if scratch[X_CLASS] != box_class:
        return scratch[X_CLASS] <= EXCLUDED
    inside, t, tau = newton_onset(
        box_class,
        theta,
        half * ENLARGEMENT,
        scratch[X_START],
        scratch[X_END],
        motion,
        curve_profile,
        solid_profile,
        path,
        jet,
    )
    return inside and (abs(t - theta) >= half or tau <= start or tau >= end)


@kernel()
def is_the_one(
    box_class: int,
    theta: float,
    half: float,
    start: float,
    end: float,
    t: float,
    tau: float,
    motion: Array,
    curve_profile: Array,
    solid_profile: Array,
    scratch: Array,
) -> bool:
    """Whether a root found in a box, or just beside it, is the only one there: the box widened to it has one, too."""
    if abs(t - theta) <= half and start <= tau <= end:
        return True
    scratch[X_THETA] = theta
    scratch[X_HALF] = max(half, abs(t - theta))
    scratch[X_START] = min(start, tau)
    scratch[X_END] = max(end, tau)
    classify_boxes(1, motion, curve_profile, solid_profile, scratch)
    return scratch[X_CLASS] == box_class


@kernel()
def joined_to_contact(
    theta: float,
    tau: float,
    motion: Array,
    curve_profile: Array,
    solid_profile: Array,
    contact_azimuths: Array,
    azimuth_count: int,
    noise: float,
    path: Array,
    jet: Array,
) -> bool:
    """Whether an onset beside an earlier contact is joined to it: the curve between is outside by ``noise`` at most.

    At the earlier contact the curve touches at all times, so that round-off alone can make a peak beside it rise.
    """
    for j in range(azimuth_count):
        gap = theta - contact_azimuths[j]
        gap -= TWO_PI * math.floor(gap / TWO_PI + 0.5)
        if abs(gap) < AZIMUTH_TOLERANCE:
            return True
        if abs(gap) < JOIN_DISTANCE:
            leaves = False
            for i in range(1, 8):
                set_jet(theta - gap * i / 8.0, tau, motion, curve_profile, solid_profile, path, jet)
                leaves = leaves or not (jet[J_G] >= -noise and jet[J_PHI] >= -noise)
            if not leaves:
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


@kernel()
def search_edge(
    since: float,
    until: float,
    motion: Array,
    curve_profile: Array,
    solid_profile: Array,
    contact_azimuths: Array,
    azimuth_count: int,
    best: float,
    any_onset: bool,
    tie_tolerance: float,
    boxes: Array,
    spare_boxes: Array,
    count: int,
    found: Array,
    entries: Array,
) -> tuple[int, int, float]:
    """Contacts of the edge curve of ``curve_profile`` with the solid of ``solid_profile`` from ``since`` to ``until``.

    ``contact_azimuths`` are those of earlier contacts on this curve, ``best`` the earliest time known: the search ends
    ``tie_tolerance`` after it. With ``any_onset`` an onset that is not a contact ends the search, too. Returns the
    number of candidates in ``found`` (earliest first), the number of boxes evaluated (OVERFLOW: too many) and the
    earliest time. Onsets that are not contacts are added to ``entries``: there the edge enters an open overlap.
    """
    path = np.empty(PATH_SIZE)
    jet = np.empty(JET_SIZE)
    wedge = np.empty(9)
    p = solid_profile[pk.P]
    slender = SLENDER * motion_scale(motion, solid_profile)
    evaluated = 0
    narrowest = math.inf
    n = set_initial_boxes(since, min(until, best + tie_tolerance), boxes)
    while n > 0:
        n = pad_boxes(n, boxes)
        classify_boxes(n, motion, curve_profile, solid_profile, boxes)
        evaluated += n
        m = 0
        for i in range(n):
            box_class = int(boxes[X_CLASS + i])
            half = boxes[X_HALF + i]
            start = boxes[X_START + i]
            if box_class <= EXCLUDED or half == 0.0 or start > best + tie_tolerance:
                continue
            theta = boxes[X_THETA + i]
            end = boxes[X_END + i]
            gap = contact_distance(theta, contact_azimuths, azimuth_count)
            if gap + half < AZIMUTH_TOLERANCE or (gap <= half + 1e-13 and box_class < SPLIT_THETA):
                continue
            concave = box_class == ONE_THREAD or box_class == PEAK_THREAD
            if (
                concave
                and gap < CONCAVITY_REACH * half
                and concave_from_contact(
                    theta,
                    half,
                    start,
                    end,
                    motion,
                    curve_profile,
                    solid_profile,
                    contact_azimuths,
                    azimuth_count,
                    spare_boxes,
                )
            ):
                continue
            noise = ROUND_OFF * p
            touches = (
                gap < JOIN_DISTANCE
                and half < AZIMUTH_TOLERANCE
                and abs(boxes[X_DEPTH + i]) < noise
                and not TOUCHING * noise < boxes[X_LARGEST_DEPTH + i] < math.inf
            )
            # Where the curve's curvature at an earlier contact vanishes during a turn, it lies on the surface around.
            lies_on_surface = (
                box_class > ONE_PLANE and gap < JOIN_DISTANCE and boxes[X_LARGEST_DEPTH + i] < LEAST_DEPTH * p
            )
            if (touches or lies_on_surface) and joined_to_contact(
                theta,
                0.5 * (start + end),
                motion,
                curve_profile,
                solid_profile,
                contact_azimuths,
                azimuth_count,
                noise if touches else LEAST_DIP * p,
                path,
                jet,
            ):
                continue
            if touches or box_class <= ONE_PLANE:
                kind = box_class
                if touches:
                    wide, span = ENLARGEMENT * half, ENLARGEMENT * (end - start)
                    inside, kind, t, tau = bracketed_onset(
                        theta, wide, start - span, end + span, motion, curve_profile, solid_profile, path, jet
                    )
                else:
                    inside, t, tau = newton_onset(
                        box_class, theta, half, start, end, motion, curve_profile, solid_profile, path, jet
                    )
                    inside = inside and is_the_one(
                        box_class, theta, half, start, end, t, tau, motion, curve_profile, solid_profile, spare_boxes
                    )
                if inside:
                    set_jet(t, tau, motion, curve_profile, solid_profile, path, jet)
                if (
                    inside
                    and tau <= best + tie_tolerance
                    and rises(kind, jet)
                    and not joined_to_contact(
                        t, tau, motion, curve_profile, solid_profile, contact_azimuths, azimuth_count, noise, path, jet
                    )
                ):
                    set_jet(t, tau, motion, curve_profile, solid_profile, path, jet)
                    onset_is_contact = is_contact(kind, t, tau, motion, curve_profile, solid_profile, jet, wedge)
                    if onset_is_contact:
                        x, y, z = jet[J_X], jet[J_Y], jet[J_Z]
                        count = insert_candidate(tau, kind, t, math.atan2(y, x), x, y, z, count, found)
                    else:
                        insert_entry(tau, t, motion, jet, entries)
                    if onset_is_contact or any_onset:
                        best = min(best, tau)
                if touches:
                    continue
                if inside or (
                    half < AZIMUTH_TOLERANCE
                    and onset_only_outside(
                        box_class, theta, half, start, end, motion, curve_profile, solid_profile, spare_boxes, path, jet
                    )
                ):
                    continue
                evaluated += NEWTON_COST if half < AZIMUTH_TOLERANCE else 0
            by_time = (
                box_class == SPLIT_TIME
                or (box_class < SPLIT_THETA and end - start > half)
                or end - start > slender * half
            )
            narrowest = min(narrowest, half)
            m = move_to_front(i, min(end, best + tie_tolerance), by_time, m, boxes)
        if 2 * m + VECTOR_WIDTH > CAPACITY or evaluated > MAX_BOXES or narrowest < NARROWEST:
            return count, OVERFLOW, best
        n = split_boxes(m, boxes, spare_boxes)
        boxes, spare_boxes = spare_boxes, boxes
    return count, evaluated, best


@kernel()
def find_inside(
    motion: Array,
    curve_profile: Array,
    solid_profile: Array,
    contact_azimuths: Array,
    azimuth_count: int,
    shallow: float,
    narrow: float,
    boxes: Array,
    spare_boxes: Array,
) -> tuple[int, float]:
    """Whether the edge curve is inside the other solid at the start of a motion, except at ``contact_azimuths``.

    Returns INSIDE and the azimuth of a point that is; OUTSIDE: nowhere by more than ``shallow`` thread pitches over
    more than ``narrow`` (rad); UNDECIDED: too many boxes.
    """
    n = set_initial_boxes(0.0, 0.0, boxes)
    while n > 0:
        n = pad_boxes(n, boxes)
        classify_boxes(n, motion, curve_profile, solid_profile, boxes)
        m = 0
        deepest, azimuth = shallow * solid_profile[pk.P], 0.0
        for i in range(n):
            box_class = int(boxes[X_CLASS + i])
            half = boxes[X_HALF + i]
            if box_class == ALL_OUTSIDE or half < narrow:
                continue
            theta, depth = boxes[X_THETA + i], boxes[X_DEPTH + i]
            if depth > deepest:
                deepest, azimuth = depth, theta
            if (box_class == ONE_EDGE or box_class == PEAK_EDGE) and contact_distance(
                theta, contact_azimuths, azimuth_count
            ) <= half:
                continue
            m = move_to_front(i, 0.0, False, m, boxes)
        if deepest > shallow * solid_profile[pk.P]:
            return INSIDE, azimuth
        if 2 * m + VECTOR_WIDTH > CAPACITY:
            return UNDECIDED, 0.0
        n = split_boxes(m, boxes, spare_boxes)
        boxes, spare_boxes = spare_boxes, boxes
    return OUTSIDE, 0.0
