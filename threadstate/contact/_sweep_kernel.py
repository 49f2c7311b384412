"""All births of an overlap at one part's edge curve during a span of time, every box closed by a bound."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._birth_kernel import (
    J_G,
    J_PHI,
    J_X,
    J_Y,
    J_Z,
    JET_SIZE,
    add_candidate,
    is_contact,
    pin,
    pin_narrow,
    rises,
    set_jet,
)
from threadstate.contact._box_kernel import (
    BY_THETA,
    BY_TIME,
    CAPACITY,
    CLOSED,
    EMPTY,
    ONE_EDGE,
    ONE_PLANE,
    ONE_THREAD,
    PEAK_EDGE,
    PEAK_THREAD,
    X_BEND,
    X_DEPTH,
    X_END,
    X_HALF,
    X_START,
    X_THETA,
    X_VERDICT,
    judge_boxes,
)
from threadstate.contact._geometry_kernel import M_SIGMA, PATH_SIZE, TWO_PI
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

AZIMUTHS = 32
"""Boxes all round with which a span of time is begun."""

EPS_PUNCTURE = 1e-6
"""Half-width (rad) around an earlier contact within which nothing is told apart from it."""

BESIDE = 1e-2
"""Distance (rad) from an earlier contact up to which a birth may be one with it."""

REACH = 16.0
"""How near to an earlier contact, in its half-widths, a box is looked at together with it."""

AROUND = 8.0
"""How much larger the box is in which the birth is looked for that a narrow box may have, but has not."""

NOISE = 1e-14
"""Round-off of a distance from a surface, in thread pitches."""

MOST_BOXES = 4_000

PIN_COST = 24
"""How many boxes are looked at in the time that Newton's method takes to find nothing in a box."""

OVERFLOW = -1
LANES = 8

OUTSIDE, INSIDE, NOT_DECIDED = range(3)

# A list of entries: their number in the first row; then time, azimuth and place along the axis on the bolt's thread.
E_TIME, E_THETA, E_Z = range(3)
ENTRY_SIZE = 3
MAX_ENTRIES = 16


@kernel()
def begin(since: float, until: float, boxes: Array) -> int:
    """The boxes all round with which a span of time is begun; their number."""
    for i in range(AZIMUTHS):
        boxes[X_THETA + i] = TWO_PI * (i + 0.5) / AZIMUTHS
        boxes[X_HALF + i] = math.pi / AZIMUTHS
        boxes[X_START + i] = since
        boxes[X_END + i] = until
    return AZIMUTHS


@kernel()
def fill(count: int, boxes: Array) -> int:
    """Fills the last vector of a list with empty boxes; the number of boxes then."""
    while count % LANES != 0:
        boxes[X_THETA + count] = 0.0
        boxes[X_HALF + count] = 0.0
        boxes[X_START + count] = 0.0
        boxes[X_END + count] = 0.0
        count += 1
    return count


@kernel()
def keep_open(i: int, end: float, by_time: bool, count: int, boxes: Array) -> int:
    """Moves an open box to the front of its list, with how it is to be split; the number of open boxes then."""
    boxes[X_THETA + count] = boxes[X_THETA + i]
    boxes[X_HALF + count] = boxes[X_HALF + i]
    boxes[X_START + count] = boxes[X_START + i]
    boxes[X_END + count] = end
    boxes[X_VERDICT + count] = BY_TIME if by_time else BY_THETA
    return count + 1


@kernel()
def split(count: int, boxes: Array, others: Array) -> int:
    """Splits the boxes at the front of a list into another: in halves, or finer where lanes would stay idle."""
    parts = 2
    while 0 < 2 * parts * count <= LANES:
        parts *= 2
    m = 0
    for i in range(count):
        theta, half = boxes[X_THETA + i], boxes[X_HALF + i]
        start, end = boxes[X_START + i], boxes[X_END + i]
        by_time = boxes[X_VERDICT + i] == BY_TIME
        for j in range(parts):
            others[X_THETA + m] = theta if by_time else theta + half * ((2 * j + 1) / parts - 1.0)
            others[X_HALF + m] = half if by_time else half / parts
            others[X_START + m] = start + (end - start) * j / parts if by_time else start
            others[X_END + m] = start + (end - start) * (j + 1) / parts if by_time else end
            m += 1
    return m


@kernel()
def mark_distance(theta: float, marks: Array, mark_count: int) -> float:
    """How far from an azimuth the nearest earlier contact is (rad)."""
    nearest = math.pi
    for j in range(mark_count):
        gap = theta - marks[j]
        gap -= TWO_PI * math.floor(gap / TWO_PI + 0.5)
        nearest = min(nearest, abs(gap))
    return nearest


@kernel()
def arches(
    theta: float,
    half: float,
    start: float,
    end: float,
    motion: Array,
    row_c: Array,
    row_s: Array,
    marks: Array,
    mark_count: int,
    spare: Array,
) -> bool:
    """Whether phi is concave from the nearest earlier contact to the far end of a box, as long as the box lasts.

    At that contact phi is not negative, so that no other point between can have a maximum there.
    """
    nearest = math.inf
    for j in range(mark_count):
        gap = theta - marks[j]
        gap -= TWO_PI * math.floor(gap / TWO_PI + 0.5)
        if abs(gap) < abs(nearest):
            nearest = gap
    near = theta - nearest
    far = theta + math.copysign(half, nearest)
    spare[X_THETA] = 0.5 * (near + far)
    spare[X_HALF] = 0.5 * abs(far - near) + 1e-12
    spare[X_START] = start
    spare[X_END] = end
    judge_boxes(1, motion, row_c, row_s, spare)
    return spare[X_BEND] < 0.0


@kernel()
def only_outside(
    verdict: int,
    theta: float,
    half: float,
    start: float,
    end: float,
    motion: Array,
    row_c: Array,
    row_s: Array,
    spare: Array,
    path: Array,
    jet: Array,
) -> bool:
    """Whether a larger box has at most one birth, too, and has it outside of this one."""
    span = end - start
    spare[X_THETA] = theta
    spare[X_HALF] = half * AROUND
    spare[X_START] = start - AROUND * span
    spare[X_END] = end + AROUND * span
    judge_boxes(1, motion, row_c, row_s, spare)
    if spare[X_VERDICT] != verdict:
        return spare[X_VERDICT] <= CLOSED
    inside, _, _ = pin(verdict, theta, half * AROUND, spare[X_START], spare[X_END], motion, row_c, row_s, path, jet)
    return inside


@kernel()
def joined(
    theta: float,
    tau: float,
    motion: Array,
    row_c: Array,
    row_s: Array,
    marks: Array,
    mark_count: int,
    path: Array,
    jet: Array,
) -> bool:
    """Whether a birth beside an earlier contact is one with it: the curve between them is nowhere outside.

    On the earlier contact the curve touches at all times, so that round-off alone can make a peak beside it rise.
    """
    for j in range(mark_count):
        gap = theta - marks[j]
        gap -= TWO_PI * math.floor(gap / TWO_PI + 0.5)
        if abs(gap) < EPS_PUNCTURE:
            return True
        if abs(gap) < BESIDE:
            apart = False
            for i in range(1, 8):
                set_jet(theta - gap * i / 8.0, tau, motion, row_c, row_s, path, jet)
                noise = -NOISE * row_s[pk.P]
                apart = apart or not (jet[J_G] >= noise and jet[J_PHI] >= noise)
            if not apart:
                return True
    return False


@kernel()
def add_entry(tau: float, theta: float, motion: Array, jet: Array, entries: Array) -> None:
    """Notes where on the bolt's thread an edge comes into an overlap that is open already; the earliest are kept."""
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
    bolt_walks = motion[M_SIGMA] > 0.0
    entries[place, E_TIME] = tau
    entries[place, E_THETA] = theta if bolt_walks else math.atan2(jet[J_Y], jet[J_X])
    entries[place, E_Z] = 0.0 if bolt_walks else jet[J_Z]


@kernel()
def sweep(
    since: float,
    until: float,
    motion: Array,
    row_c: Array,
    row_s: Array,
    marks: Array,
    mark_count: int,
    best: float,
    any_birth: bool,
    slack: float,
    boxes: Array,
    others: Array,
    count: int,
    found: Array,
    entries: Array,
) -> tuple[int, int, float]:
    """Contacts of the edge curve of ``row_c`` with the solid of ``row_s`` from ``since`` to ``until``.

    ``marks`` are the azimuths of earlier contacts on this curve, ``best`` the earliest time known; nothing later than
    ``slack`` after it is looked for. With ``any_birth`` a birth that is no contact ends the search, too. Returns the
    number of candidates in ``found`` (earliest first), the number of boxes looked at (OVERFLOW: too many), the
    earliest time. Births that are no contacts are added to ``entries``: there the edge comes into an open overlap.
    """
    path = np.empty(PATH_SIZE)
    jet = np.empty(JET_SIZE)
    w = np.empty(9)
    looked = 0
    n = begin(since, min(until, best + slack), boxes)
    while n > 0:
        n = fill(n, boxes)
        judge_boxes(n, motion, row_c, row_s, boxes)
        looked += n
        m = 0
        for i in range(n):
            verdict = int(boxes[X_VERDICT + i])
            half = boxes[X_HALF + i]
            start = boxes[X_START + i]
            if verdict <= CLOSED or half == 0.0 or start > best + slack:
                continue
            theta = boxes[X_THETA + i]
            end = boxes[X_END + i]
            gap = mark_distance(theta, marks, mark_count)
            if gap + half < EPS_PUNCTURE or (gap <= half + 1e-13 and verdict < BY_THETA):
                continue
            concave = verdict == ONE_THREAD or verdict == PEAK_THREAD
            if (
                concave
                and gap < REACH * half
                and arches(theta, half, start, end, motion, row_c, row_s, marks, mark_count, others)
            ):
                continue
            touches = gap < BESIDE and half < EPS_PUNCTURE and abs(boxes[X_DEPTH + i]) < NOISE * row_s[pk.P]
            if touches and joined(theta, 0.5 * (start + end), motion, row_c, row_s, marks, mark_count, path, jet):
                continue
            if touches or verdict <= ONE_PLANE:
                kind = verdict
                if touches:
                    wide, span = AROUND * half, AROUND * (end - start)
                    inside, kind, t, tau = pin_narrow(
                        theta, wide, start - span, end + span, motion, row_c, row_s, path, jet
                    )
                else:
                    inside, t, tau = pin(verdict, theta, half, start, end, motion, row_c, row_s, path, jet)
                if inside:
                    set_jet(t, tau, motion, row_c, row_s, path, jet)
                if (
                    inside
                    and tau <= best + slack
                    and rises(kind, jet)
                    and not joined(t, tau, motion, row_c, row_s, marks, mark_count, path, jet)
                ):
                    set_jet(t, tau, motion, row_c, row_s, path, jet)
                    contact = is_contact(kind, t, tau, motion, row_c, row_s, jet, w)
                    if contact:
                        x, y, z = jet[J_X], jet[J_Y], jet[J_Z]
                        count = add_candidate(tau, kind, t, math.atan2(y, x), x, y, z, count, found)
                    else:
                        add_entry(tau, t, motion, jet, entries)
                    if contact or any_birth:
                        best = min(best, tau)
                if touches:
                    continue
                if inside or (
                    half < EPS_PUNCTURE
                    and only_outside(verdict, theta, half, start, end, motion, row_c, row_s, others, path, jet)
                ):
                    continue
                looked += PIN_COST if half < EPS_PUNCTURE else 0
            by_time = verdict == BY_TIME or (verdict < BY_THETA and end - start > half)
            m = keep_open(i, min(end, best + slack), by_time, m, boxes)
        if 2 * m + LANES > CAPACITY or looked > MOST_BOXES:
            return count, OVERFLOW, best
        n = split(m, boxes, others)
        boxes, others = others, boxes
    return count, looked, best


@kernel()
def inside_at(
    motion: Array,
    row_c: Array,
    row_s: Array,
    marks: Array,
    mark_count: int,
    shallow: float,
    narrow: float,
    boxes: Array,
    others: Array,
) -> tuple[int, float]:
    """Whether the edge curve is inside the other solid at the start of a motion, beyond its contacts ``marks``.

    INSIDE and the azimuth of a point that is; OUTSIDE: nowhere by more than ``shallow`` thread pitches over more than
    ``narrow`` (rad); NOT_DECIDED: too many boxes.
    """
    n = begin(0.0, 0.0, boxes)
    while n > 0:
        n = fill(n, boxes)
        judge_boxes(n, motion, row_c, row_s, boxes)
        m = 0
        deepest, azimuth = shallow * row_s[pk.P], 0.0
        for i in range(n):
            verdict = int(boxes[X_VERDICT + i])
            half = boxes[X_HALF + i]
            if verdict == EMPTY or half < narrow:
                continue
            theta, depth = boxes[X_THETA + i], boxes[X_DEPTH + i]
            if depth > deepest:
                deepest, azimuth = depth, theta
            if (verdict == ONE_EDGE or verdict == PEAK_EDGE) and mark_distance(theta, marks, mark_count) <= half:
                continue
            m = keep_open(i, 0.0, False, m, boxes)
        if deepest > shallow * row_s[pk.P]:
            return INSIDE, azimuth
        if 2 * m + LANES > CAPACITY:
            return NOT_DECIDED, 0.0
        n = split(m, boxes, others)
        boxes, others = others, boxes
    return OUTSIDE, 0.0
