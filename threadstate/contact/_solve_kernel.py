"""All three stages of tilted poses, one record a pose."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact import _flush_kernel as fk
from threadstate.contact import _guess_kernel as near
from threadstate.contact import _record_kernel as rk
from threadstate.contact import _refine_kernel as refine
from threadstate.contact import _wide_kernel as wide
from threadstate.contact._beside_kernel import MOST_KEPT
from threadstate.contact._flush_kernel import EXTREME_SIZE
from threadstate.contact._geometry_kernel import TWO_PI, copy_numbers, edge_point
from threadstate.contact._lift_kernel import RETRY_OFFSET, crests_overlap, least_lift
from threadstate.contact._record_kernel import RECORD_SIZE
from threadstate.contact._refine_kernel import REFINED_SIZE
from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    CONTACT_SIZE,
    EDGE_EDGE,
    EDGE_SURFACE,
    K_BOLT_AZIMUTH,
    K_NUT_AZIMUTH,
    K_PAIR,
    K_TIME,
    K_X,
    K_Y,
    K_Z,
    MAX_CONTACTS,
    PROVED,
    RESOLVED,
    RIDGES,
    THREAD_EDGE,
    THREAD_SURFACE,
    THREAD_THREAD,
    UNRESOLVED,
    Stage,
    Wanted,
    Work,
    earliest,
    earliest_below,
    edges_overlap,
    new_work,
    rotation,
    turned,
)
from threadstate.contact._surface_kernel import meets_surface_first, start_height
from threadstate.contact._wide_kernel import WIDE_MOTION_SIZE
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# Options of a solve: limit of a turn (rad), tolerance of a tie (length), whether both outlines are convex (1 or 0),
# whether thread on thread is searched by branch and bound over rectangles (1) or along ridges (0), and whether no more
# than the first stage is wanted (1).
S_TURN_LIMIT, S_TIE, S_CONVEX, S_PROVE, S_FIRST_ONLY = range(5)
OPTIONS_SIZE = 5

ROTATION_SIZE = 9
"""Numbers of a row of :func:`solve_rows` that is a rotation and not a pose."""

NONE_BESIDE = np.empty((0, 2, RECORD_SIZE))
"""No records of poses next to those that are solved."""

UNDECIDED_CONTACT = -1
"""In place of how many contacts begin at once."""

NEAR_TIE_SHARE = 1e-8
"""Of what the tilt moves the rim by: all turns of a bolt that is all but level can be as short as the tolerance of a
tie. Contacts that are a tie by it alone are then beside where planes meet, or a whole strip; where that leads to no
certain state they are one within this share alone.
"""

GUESS_MARGIN = 1e-6
"""By which share of its time a contact may begin later than where it is guessed, so that the search is not made again.
"""

NEAR_PHASE = math.radians(2.0)
"""How far apart phases of poses are of which one's contacts are guesses of the other's."""

FLUSH_MARGIN = 1e-9
"""Where a turn ends flush, contacts are searched for up to this much (rad) before: there all edges meet at once."""


@kernel()
def lies_in_both_planes(pair: int) -> bool:
    """Whether a contact of these features lies both in the bolt's base plane and in the nut's surface plane."""
    return pair == EDGE_EDGE or pair == EDGE_SURFACE or pair == BASE_EDGE


@kernel()
def second_axis(contact: Array, pose: Array, bolt: Array, nut: Array, out: Array) -> None:
    """Sets the unit axis about which the bolt turns by a positive angle: the reverse of the method's t0."""
    pair = int(contact[K_PAIR])
    if pair == EDGE_EDGE or pair == BASE_EDGE or pair == THREAD_EDGE:
        _, _, x, y = edge_point(contact[K_NUT_AZIMUTH], nut)
        z = 0.0
    elif pair == THREAD_THREAD:
        x, y, z = -contact[K_Y], contact[K_X], bolt[pk.LEAD] / TWO_PI
    elif pair == THREAD_SURFACE:
        bx, by, _ = rk.in_bolt_frame(pose, contact[K_X], contact[K_Y], contact[K_Z])
        k = bolt[pk.LEAD] / TWO_PI
        x = -pose[0] * by + pose[1] * bx + pose[2] * k
        y = -pose[3] * by + pose[4] * bx + pose[5] * k
        z = 0.0
    else:
        _, _, dx, dy = edge_point(contact[K_BOLT_AZIMUTH], bolt)
        x = pose[0] * dx + pose[1] * dy
        y = pose[3] * dx + pose[4] * dy
        z = 0.0 if pair == EDGE_SURFACE else pose[6] * dx + pose[7] * dy
    n = math.sqrt(x * x + y * y + z * z)
    if contact[K_X] * y - contact[K_Y] * x > 0.0:
        n = -n
    out[0] = x / n
    out[1] = y / n
    out[2] = z / n


@kernel()
def turn_to_flush(pose: Array, axis: Array) -> float:
    """The turn about a horizontal ``axis`` in the base plane after which the base is level; negative: the other way."""
    nx, ny, nz = pose[2], pose[5], pose[8]
    return math.atan2(axis[0] * ny - axis[1] * nx, nz)


@kernel()
def append_flush_pose(
    stage: int,
    pose: Array,
    point: Array,
    axis: Array,
    tau: float,
    bolt: Array,
    nut: Array,
    extremes: Array,
    record: Array,
) -> bool:
    """Appends the flush pose and the extreme points of its patch; False if the outlines do not overlap."""
    level = scratch(12)
    turned(pose, point, axis, tau, level)
    # The base is level now: what differs from that is round-off.
    for i in (2, 5, 6, 7):
        level[i] = 0.0
    level[8] = 1.0
    level[11] = 0.0
    count = fk.extreme_points(level, bolt, nut, axis[0], axis[1], extremes)
    if count == 0:
        return False
    rk.append_pose(level, record)
    known = int(record[rk.O_CONTACTS])
    for i in range(count):
        x, y = extremes[i, fk.XP_X], extremes[i, fk.XP_Y]
        is_listed = False
        for j in range(known):
            c = rk.O_CONTACT + rk.POINT_SIZE * j + rk.P_POINT
            if abs(record[c] - x) + abs(record[c + 1] - y) + abs(record[c + 2]) < 1e-6 * bolt[pk.R_MAJOR]:
                is_listed = True
        if not is_listed:
            rk.append_flush_point(
                stage, extremes[i, fk.XP_THETA], extremes[i, fk.XP_CORNER] > 0.0, x, y, bolt, nut, record
            )
    record[rk.O_FLAGS] = int(record[rk.O_FLAGS]) | rk.FLAG_FLUSH
    return True


@kernel()
def add_flag(record: Array, flag: int) -> None:
    """Sets a flag."""
    record[rk.O_FLAGS] = int(record[rk.O_FLAGS]) | flag


@kernel()
def sort_simultaneous(found: Array, count: int, tie_tolerance: float) -> tuple[int, float]:
    """Sorts the contacts within a tolerance of the earliest by azimuth on the nut; their number, the earliest time.

    The earliest contact need not be the first after that.
    """
    n = 1
    first = found[0, K_TIME]
    while n < count and found[n, K_TIME] <= first + tie_tolerance:
        n += 1
    for i in range(1, n):
        j = i
        while j > 0 and azimuth(found[j]) < azimuth(found[j - 1]):
            for m in range(CONTACT_SIZE):
                found[j, m], found[j - 1, m] = found[j - 1, m], found[j, m]
            j -= 1
    return n, first


@kernel()
def azimuth(contact: Array) -> float:
    """Azimuth on the nut in [0, 2 pi)."""
    a = math.atan2(contact[K_Y], contact[K_X])
    return a + TWO_PI if a < 0.0 else a


class Scene(NamedTuple):
    """The options of a solve and the packed profiles of both parts.

    ``tie`` is the tolerance of a tie (length): that of the options, or less.
    """

    options: Array
    bolt: Array
    nut: Array
    tie: float


class Guesses(NamedTuple):
    """Contacts that poses near it have, by which a pose's are looked for first, and what they are followed with."""

    contacts: Array
    work: near.Work


@kernel(allocates=True)
def new_guesses() -> Guesses:
    """No guesses."""
    contacts = np.empty((near.GUESSES, near.GUESS_SIZE))
    near.clear_guesses(contacts)
    return Guesses(contacts, near.new_work())


class Course(NamedTuple):
    """A bolt on its way through the stages; numbers in pairs are sums of two doubles (``_refine_kernel``).

    Attributes:
        pose: its first pose, (12, 2).
        second: its second one.
        point: the first contact, (3, 2).
        axis: of the latest turn, (3, 2).
        motion: the latest, (18, 2).
        first: the first contact, refined.
        latest: the latest one, refined.
        known: the first two contacts.
        found: contacts of the latest search; then those of the latest stage that are not known yet.
        guesses: what is looked for first.
        work: scratch.
    """

    pose: Array
    second: Array
    point: Array
    axis: Array
    motion: Array
    first: Array
    latest: Array
    known: Array
    found: Array
    guesses: Guesses
    work: Work


@kernel()
def thread_search_of(scene: Scene) -> int:
    """How thread on thread is searched."""
    return PROVED if scene.options[S_PROVE] > 0.0 else RIDGES


@kernel()
def clear_record(record: Array) -> None:
    """Sets a record to that of nothing found yet."""
    record[:] = 0.0
    for i in (rk.O_LAMBDA, rk.O_MU, rk.O_DROP, rk.O_EMBEDMENT, rk.O_PIVOT):
        record[i] = math.nan


@kernel()
def append_stage(stage: int, contact: Array, pose: Array, bolt: Array, nut: Array, record: Array) -> None:
    """Appends a stage's pose and its contact."""
    rk.append_pose(pose, record)
    rk.append_contact(stage, contact, pose, bolt, nut, record)
    if rk.grazes(contact, pose, bolt, nut):
        add_flag(record, rk.FLAG_GRAZING)


@kernel()
def drop_found(dropped: int, simultaneous: int, found: Array) -> int:
    """Drops the first contacts of those that begin at once; returns how many are left."""
    for i in range(dropped, simultaneous):
        copy_numbers(found[i], found[i - dropped])
    return simultaneous - dropped


@kernel()
def solve_pose(
    roll: float,
    pitch: float,
    phase: float,
    options: Array,
    bolt: Array,
    nut: Array,
    guesses: Guesses,
    work: Work,
    record: Array,
) -> None:
    """Solves one tilted pose (angles in rad) into ``record``; see ``_record_kernel`` for its layout.

    Of the first stage alone the record has the bits that the whole one has: that of a bolt that is all but level is
    whole, as later stages may want a smaller tolerance of ties.
    """
    tie = options[S_TIE]
    nearer = NEAR_TIE_SHARE * math.hypot(roll, pitch) * bolt[pk.R_MAJOR]
    first_only = options[S_FIRST_ONLY] > 0.0 and nearer >= tie
    solve_stages(roll, pitch, phase, first_only, Scene(options, bolt, nut, tie), guesses, work, record)
    if record[rk.O_STATUS] != RESOLVED and nearer < tie:
        solve_stages(roll, pitch, phase, False, Scene(options, bolt, nut, nearer), guesses, work, record)


@kernel()
def solve_stages(
    roll: float,
    pitch: float,
    phase: float,
    first_only: bool,
    scene: Scene,
    guesses: Guesses,
    work: Work,
    record: Array,
) -> None:
    """The stages of a pose, or the ``first_only``, into ``record``."""
    clear_record(record)
    bolt, nut = scene.bolt, scene.nut
    course = Course(
        scratch(12, 2),
        scratch(12, 2),
        scratch(3, 2),
        scratch(3, 2),
        scratch(WIDE_MOTION_SIZE, 2),
        scratch(REFINED_SIZE, 2),
        scratch(REFINED_SIZE, 2),
        scratch(2, CONTACT_SIZE),
        scratch(MAX_CONTACTS, CONTACT_SIZE),
        guesses,
        work,
    )
    simultaneous = first_stage(roll, pitch, phase, scene, course)
    if simultaneous == 0:
        record[rk.O_STATUS] = UNRESOLVED
        return
    pose = scratch(12)
    wide.round_numbers(course.pose, pose)
    append_stage(1, course.known[0], pose, bolt, nut, record)
    if first_only:
        return
    for i in range(3):
        wide.set_entry(course.point, i, wide.entry(course.first, refine.F_POINT + i))
    if simultaneous > 1:
        add_flag(record, rk.FLAG_TIE)
        record[rk.O_LAMBDA] = 0.0
        copy_numbers(course.found[1], course.known[1])
        for i in range(course.pose.shape[0]):
            copy_numbers(course.pose[i], course.second[i])
        refine.set_unrefined(course.known[1], course.second, course.latest)
        left = drop_found(2, simultaneous, course.found)
    else:
        left = second_stage(pose, scene, course, record)
        if left < 0:
            return
    second = scratch(12)
    wide.round_numbers(course.second, second)
    append_stage(2, course.known[1], second, bolt, nut, record)

    # The turn about the pivot axis, in the sense that lowers the bolt's origin.
    refine.set_pivot_axis(course.first, course.latest, course.axis)
    rise = set_pivot_offset(second, course, record)
    if left > 0:
        record[rk.O_MU] = 0.0
        append_third_pose(second, 0.0, left, scene, course, record)
        return
    if rise > 0.0:
        refine.reverse(course.axis)
    if abs(rise) > scene.options[S_TIE]:
        third_stage(scene, course, record)
        return
    # Balanced: the origin lies on the axis (or over it), both senses are followed and the shorter turn is chosen.
    add_flag(record, rk.FLAG_BALANCED)
    other_record = scratch(RECORD_SIZE)
    copy_numbers(record, other_record)
    third_stage(scene, course, record)
    refine.reverse(course.axis)
    third_stage(scene, course, other_record)
    choose_shorter_turn(record, other_record)


@kernel()
def limit_by_guess(stage: Stage, limit: float, tie: float, scene: Scene, guesses: Guesses) -> float:
    """Up to when the contacts of a motion are looked for first: a little after those that are guessed; ``limit`` where
    none is, or thread on thread.
    """
    contact = scratch(CONTACT_SIZE)
    number = 1 + stage.known_count
    is_guessed = near.earliest_guess(
        number,
        stage.pose,
        stage.point,
        stage.axis,
        stage.known,
        limit,
        guesses.contacts,
        scene.bolt,
        scene.nut,
        guesses.work,
        contact,
    )
    if not is_guessed or int(contact[K_PAIR]) == THREAD_THREAD:
        return limit
    return min(limit, (1.0 + GUESS_MARGIN) * (contact[K_TIME] + tie))


@kernel(forceinline=True)
def hangs_on_limit(contact: Array, alone: bool, latest: float) -> bool:
    """Whether what a motion comes to first may be another contact, or have other bits, if the search reaches farther.

    Where thread on thread is sampled hangs on that, and what is not refined has the bits of its search. A contact later
    than ``latest`` may lack others that tie with it.
    """
    return int(contact[K_PAIR]) == THREAD_THREAD or refine.is_unrefined(contact, alone) or contact[K_TIME] > latest


@kernel()
def next_contact(
    is_turn: bool,
    pose: Array,
    exact: Array,
    known_count: int,
    limit: float,
    tie: float,
    scene: Scene,
    course: Course,
    moved: Array,
    refined: Array,
) -> tuple[int, float]:
    """The earliest contacts of a motion up to ``limit``, in ``course.found``: how many begin at once, and when.

    ``pose`` and ``exact`` are where it begins, in doubles and in sums of two; point and axis are those of the course.
    Sets the pose ``moved`` to where it ends and what is ``refined`` of the first contact. None: 0; UNDECIDED_CONTACT:
    the search did not end, or what it ends with is no contact, with refined edges neither. Contacts that are guessed
    shorten the search where that decides nothing else.
    """
    point, axis = scratch(3), scratch(3)
    wide.round_numbers(course.point, point)
    wide.round_numbers(course.axis, axis)
    wide.set_motion(exact, course.point, course.axis, course.motion)
    bolt, nut, found = scene.bolt, scene.nut, course.found
    stage = Stage(pose, is_turn, point, axis, course.motion, course.known, known_count)
    nearer = limit_by_guess(stage, limit, tie, scene, course.guesses)
    for i in range(0 if nearer < limit else 1, 3):
        wanted = Wanted(nearer if i == 0 else limit, tie, thread_search_of(scene))
        count, status, _ = earliest(stage, wanted, i == 2, bolt, nut, course.work, found)
        if i == 0 and (status != RESOLVED or count == 0):
            continue
        if status != RESOLVED:
            break
        if count == 0:
            return 0, limit
        simultaneous, time = sort_simultaneous(found, count, tie)
        if i == 0 and hangs_on_limit(found[0], simultaneous == 1, nearer - tie):
            continue
        time, settles = refine.refine_contact(
            is_turn,
            exact,
            course.point,
            course.axis,
            bolt,
            nut,
            found[0],
            time,
            simultaneous == 1,
            i > 0,
            moved,
            refined,
        )
        if settles:
            return simultaneous, time
    return UNDECIDED_CONTACT, limit


@kernel()
def first_stage(roll: float, pitch: float, phase: float, scene: Scene, course: Course) -> int:
    """The way straight down to the first contact: how many begin at once; 0: unresolved."""
    pose = scratch(12)
    found, bolt, nut = course.found, scene.bolt, scene.nut
    rotation(roll, pitch, phase, pose)
    pose[9] = 0.0
    pose[10] = 0.0
    high = start_height(pose, bolt)
    pose[11] = high
    simultaneous = 1
    if scene.options[S_CONVEX] > 0.0 and meets_surface_first(pose, bolt, nut, found[0]):
        pose[11] = found[0, K_TIME]
        wide.widen_numbers(pose, course.pose)
        refine.set_unrefined(found[0], course.pose, course.first)
    else:
        limit = high + bolt[pk.P]
        start = scratch(12, 2)
        refine.set_first_pose(roll, pitch, phase, high, start)
        wide.set_vector(course.point, 0, (wide.ZERO, wide.ZERO, wide.ZERO))
        wide.set_vector(course.axis, 0, (wide.ZERO, wide.ZERO, wide.MINUS_ONE))
        simultaneous, _ = next_contact(
            False, pose, start, 0, limit, scene.tie, scene, course, course.pose, course.first
        )
        if simultaneous <= 0:
            return 0
    copy_numbers(found[0], course.known[0])
    return simultaneous


@kernel()
def second_stage(pose: Array, scene: Scene, course: Course, record: Array) -> int:
    """The turn about the tangent at the first contact up to the second one.

    Returns how many third contacts begin with it; -1: there is no second one, or it is unresolved.
    """
    point, axis, extremes = scratch(3), scratch(3), scratch(4, EXTREME_SIZE)
    found, known, bolt, nut = course.found, course.known, scene.bolt, scene.nut
    pair = int(known[0, K_PAIR])
    refine.set_second_axis(pair, course.first, course.pose, bolt, nut, course.axis)
    wide.round_numbers(course.point, point)
    wide.round_numbers(course.axis, axis)
    limit, flush, simultaneous, turn = scene.options[S_TURN_LIMIT], -1.0, 0, math.nan
    if pair == EDGE_SURFACE:
        flush = turn_to_flush(pose, axis)
        if flush <= limit:
            limit = flush - FLUSH_MARGIN
    # With convex outlines the bolt lies wholly on the other side of the axis and above the nut until it is flush.
    if flush < 0.0 or scene.options[S_CONVEX] == 0.0:
        simultaneous, turn = next_contact(
            True,
            pose,
            course.pose,
            1,
            limit,
            scene.tie / bolt[pk.R_MAJOR],
            scene,
            course,
            course.second,
            course.latest,
        )
        if simultaneous == UNDECIDED_CONTACT:
            record[rk.O_STATUS] = UNRESOLVED
            return -1
    if simultaneous == 0:
        if flush >= 0.0 and append_flush_pose(2, pose, point, axis, flush, bolt, nut, extremes, record):
            record[rk.O_LAMBDA] = flush
        else:
            add_flag(record, rk.FLAG_NO_SECOND | rk.FLAG_NO_THIRD)
        return -1
    if simultaneous > 1:
        add_flag(record, rk.FLAG_TIE)
    record[rk.O_LAMBDA] = turn
    copy_numbers(found[0], known[1])
    return drop_found(1, simultaneous, found)


@kernel()
def set_pivot_offset(second: Array, course: Course, record: Array) -> float:
    """Sets the distance of the bolt's origin from the pivot axis; returns by how much a turn about it lifts the origin
    (a length a rad).
    """
    point, axis = scratch(3), scratch(3)
    wide.round_numbers(course.point, point)
    wide.round_numbers(course.axis, axis)
    ox, oy, oz = second[9] - point[0], second[10] - point[1], second[11] - point[2]
    cx = axis[1] * oz - axis[2] * oy
    cy = axis[2] * ox - axis[0] * oz
    cz = axis[0] * oy - axis[1] * ox
    record[rk.O_PIVOT] = math.sqrt(cx * cx + cy * cy + cz * cz)
    return cz


@kernel()
def choose_shorter_turn(record: Array, other_record: Array) -> None:
    """Copies into ``record`` the sense of the third turn that ends first; unresolved where that is not certain.

    A sense whose turn is known is compared by it, even where its embedment is unresolved: if the other one is shorter
    that does not matter.
    """
    for sense in (record, other_record):
        if sense[rk.O_STATUS] != RESOLVED and math.isnan(sense[rk.O_MU]):
            record[rk.O_STATUS] = UNRESOLVED
            return
    if not math.isnan(other_record[rk.O_MU]) and not record[rk.O_MU] <= other_record[rk.O_MU]:
        copy_numbers(other_record, record)


@kernel()
def third_stage(scene: Scene, course: Course, record: Array) -> None:
    """The turn about the pivot axis up to the third contact, the drop and the embedment."""
    second, point, axis = scratch(12), scratch(3), scratch(3)
    known, bolt, nut = course.known, scene.bolt, scene.nut
    wide.round_numbers(course.second, second)
    wide.round_numbers(course.point, point)
    wide.round_numbers(course.axis, axis)
    limit, flush = scene.options[S_TURN_LIMIT], -1.0
    if lies_in_both_planes(int(known[0, K_PAIR])) and lies_in_both_planes(int(known[1, K_PAIR])):
        flush = turn_to_flush(second, axis)
        if 0.0 < flush <= limit:
            limit = flush - FLUSH_MARGIN
    third, fine_third, latest = scratch(12), scratch(12, 2), scratch(REFINED_SIZE, 2)
    tie = scene.tie / bolt[pk.R_MAJOR]
    simultaneous, turn = next_contact(True, second, course.second, 2, limit, tie, scene, course, fine_third, latest)
    if simultaneous == UNDECIDED_CONTACT:
        record[rk.O_STATUS] = UNRESOLVED
        return
    if simultaneous == 0:
        extremes = scratch(4, EXTREME_SIZE)
        if flush > 0.0 and append_flush_pose(3, second, point, axis, flush, bolt, nut, extremes, record):
            record[rk.O_MU] = flush
            record[rk.O_DROP] = second[11] - record[rk.O_POSE + 35]
            record[rk.O_EMBEDMENT] = 0.0
        else:
            add_flag(record, rk.FLAG_NO_THIRD)
        return
    if simultaneous > 1:
        add_flag(record, rk.FLAG_TIE)
    record[rk.O_MU] = turn
    wide.round_numbers(fine_third, third)
    append_third_pose(third, second[11] - third[11], simultaneous, scene, course, record)


@kernel()
def append_third_pose(
    third: Array, drop: float, simultaneous: int, scene: Scene, course: Course, record: Array
) -> None:
    """Appends the third pose and its contacts, the first ``simultaneous`` found; sets the drop and the embedment."""
    bolt, nut, work = scene.bolt, scene.nut, course.work
    rk.append_pose(third, record)
    contacts = scratch(MOST_KEPT, CONTACT_SIZE)
    for i in range(2):
        copy_numbers(course.known[i], contacts[i])
    for i in range(simultaneous):
        copy_numbers(course.found[i], contacts[2 + i])
        rk.append_contact(3, course.found[i], third, bolt, nut, record)
        if rk.grazes(course.found[i], third, bolt, nut):
            add_flag(record, rk.FLAG_GRAZING)
    record[rk.O_DROP] = drop
    record[rk.O_EMBEDMENT] = 0.0
    if (
        threads_touch(contacts, 2 + simultaneous)
        or edges_overlap(third, contacts, 2 + simultaneous, bolt, nut, work)
        or crests_overlap(third, RETRY_OFFSET * bolt[pk.P], bolt, nut, work)
    ):
        lift, status = least_lift(third, scene.options[S_TIE], bolt, nut, work, course.found)
        record[rk.O_EMBEDMENT] = lift
        if status != RESOLVED:
            record[rk.O_STATUS] = UNRESOLVED


@kernel()
def threads_touch(contacts: Array, count: int) -> bool:
    """Whether thread meets thread at one of the contacts: beside it they may overlap with no edge inside."""
    for i in range(count):
        if int(contacts[i, K_PAIR]) == THREAD_THREAD:
            return True
    return False


@kernel()
def first_height(rotation: Array, tie_tolerance: float, bolt: Array, nut: Array, work: Work) -> float:
    """The height of the bolt's origin at its first contact from above, on the nut's axis; NaN where it is not certain.

    ``rotation`` (9) is the bolt's, by rows.
    """
    pose = scratch(12)
    for i in range(9):
        pose[i] = rotation[i]
    pose[9], pose[10], pose[11] = 0.0, 0.0, 0.0
    high = start_height(pose, bolt)
    pose[11] = high
    found = scratch(MAX_CONTACTS, CONTACT_SIZE)
    wanted = Wanted(high + bolt[pk.P], tie_tolerance, RIDGES)
    count, status, _ = earliest_below(pose, wanted, bolt, nut, work, found)
    return high - found[0, K_TIME] if status == RESOLVED and count > 0 else math.nan


@kernel()
def is_near(one: Array, other: Array) -> bool:
    """Whether two poses differ by their phases alone, and not by much."""
    return one[0] == other[0] and one[1] == other[1] and abs(one[2] - other[2]) <= NEAR_PHASE


@kernel(nogil=True, allocates=True)
def solve_rows(poses: Array, options: Array, bolt: Array, nut: Array, beside: Array, rows: Array) -> int:
    """Solves poses of shape (n, 3), roll, pitch, phase in rad, none level, into rows of shape (n, RECORD_SIZE).

    Guesses are the contacts of the records ``beside`` each pose, of shape (n, m, RECORD_SIZE), m at most 2; where there
    are none (``NONE_BESIDE``), those of the row before, if that pose is near.

    Of rotations of shape (n, 9) it sets heights of shape (n, 1) as :func:`first_height` has them, alone: the machine
    code of the search is made once for both. The global interpreter lock is released meanwhile. Returns how many boxes
    of edges were evaluated.
    """
    work = new_work()
    guesses = new_guesses()
    are_rotations = poses.shape[1] == ROTATION_SIZE
    for i in range(poses.shape[0]):
        if are_rotations:
            rows[i, 0] = first_height(poses[i], options[S_TIE], bolt, nut, work)
        else:
            near.clear_guesses(guesses.contacts)
            if beside.shape[0] > 0:
                for j in range(beside.shape[1]):
                    near.set_guesses(beside[i, j], guesses.contacts[j * rk.MAX_RECORD_CONTACTS :])
            elif i > 0 and is_near(poses[i - 1], poses[i]):
                near.set_guesses(rows[i - 1], guesses.contacts)
            solve_pose(poses[i, 0], poses[i, 1], poses[i, 2], options, bolt, nut, guesses, work, rows[i])
    return int(work.regions[0, 1])
