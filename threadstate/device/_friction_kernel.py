"""The path of a held bolt with friction: push and phase of the command move in steps, whose length is what it takes.

A step is halved where contacts change in it, the potential does as nothing explains, or there are several solutions;
where the shortest one has none, or one that only a jump leads to, the bolt falls (``_friction_step_kernel``,
``_friction_held_kernel``, ``_friction_fall_kernel``).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch, zeros
from threadstate.contact._geometry_kernel import copy_numbers
from threadstate.contact._stage_kernel import FLUSH as FLUSH_PAIR
from threadstate.contact._stage_kernel import new_work as new_stage
from threadstate.device._certificate_kernel import overlap
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_CENTRE,
    D_ROTATION,
    D_SCALE,
    PLACE_SIZE,
    elastic_energy,
    set_place,
)
from threadstate.device._descent_kernel import DEEPEST
from threadstate.device._friction_fall_kernel import FRICTIONLESS, fall_with_friction
from threadstate.device._friction_held_kernel import ENERGY_STEP, contacts_of_tip, lies_throughout, step_held
from threadstate.device._friction_step_kernel import (
    GOES_ON,
    NO_MINIMUM,
    PATH_FULL,
    REACHED,
    SHORTER,
    SLIPPED_OFF,
    SNAP_REACHED,
    TOO_DEEP,
    TORQUE_OVER,
    friction_loss,
    kept,
    step_with_friction,
)
from threadstate.device._gap_kernel import G_VALUE, GAP_SIZE
from threadstate.device._leg_kernel import (
    BELOW_TOP,
    DEGREE,
    M_ABOUT_BOLT,
    M_LONGEST,
    M_PUSH,
    M_TILT,
    ON_CONTACTS,
    ON_STRIP,
    ON_SURFACE,
    SNAP_FALL,
    SNAP_SPAN,
    set_phase,
)
from threadstate.device._modes_kernel import CONTACT_SIZE as K_SIZE
from threadstate.device._modes_kernel import (
    K_FORCE,
    K_MODE,
    K_PAIR,
    K_POINT,
    MOST_CANDIDATES,
    REACH,
    SLIPS,
    new_modes_work,
)
from threadstate.device._places_kernel import MAX_PLACES, PLACES_WORK, find_places, new_threads
from threadstate.device._rest_kernel import new_work
from threadstate.device._same_contacts_kernel import same_contacts
from threadstate.device._settle_kernel import LEAST_GAP, OVERLAP_LIMIT, distance
from threadstate.device._slide_kernel import (
    is_level,
)
from threadstate.device._step_modes_kernel import DISTINCT, Setting, Solutions, new_solutions, set_guess
from threadstate.device._turn_kernel import ABOVE, EVENT_WIDTH, TORQUE_LIMIT
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

LONGEST_TURN, LONGEST_PUSH = 1.0 * DEGREE, 1.0 / 16.0
FIRST_PART, LEAST_PART = 0.25, 1.0 / 256.0
"""The longest steps of phase (rad) and of push (parts of its whole) where no others are asked for; the first and the
shortest over the longest."""

BRIDGING = 4.0
"""How much longer the steps of a growing push become that are tried where no step is short enough: contacts that have
all but ceased to slide have no solution then."""

TRIED_AGAIN = 16
"""Of falls in a row each is followed by a first step of half the length, and every so many-th by one of the full
length: where a bolt has fallen in the shortest step again and again longer ones have no solution as a rule."""

MOST_BARE = 4
"""The most falls without friction in a row: in more of them the path has not the friction that it is said to have."""

BENT, LONGER = 1e-4, 4.0
"""How far (nominal radii) a step may end from where it would as the one before it went; and how many times as far one
of twice the length would."""

MAX_POINTS = 2500

# A point: phase (rad), push, what holds the bolt, potential, elastic energy, torque, contacts, coordinates, rotation
# and translation, friction loss of the step, loss of a fall, number of solutions of the step: 0 after a fall with
# friction, and FRICTIONLESS.
P_PHASE, P_PUSH, P_KIND, P_POTENTIAL, P_ENERGY, P_TORQUE, P_COUNT, P_COORDINATES, P_POSE = (
    0,
    1,
    2,
    3,
    4,
    5,
    6,
    7,
    13,
)
P_FRICTION, P_FALL, P_SOLUTIONS = 25, 26, 27
POINT_SIZE = 28

Path = tuple[Array, Array]
"""Points, and their contacts."""

MAX_BRANCHES = 64
"""The most branches of a leg that are told."""

Branches = tuple[Array, Array, Indices]
"""Of other solutions of steps: the point each sets, its contacts, and the number of the path's point that it is instead
of; as many as there is room for, the last -1 where there are no more."""


@kernel()
def torque_with(q: Array, count: int, contacts: Array, command: Array, device: Array) -> float:
    """The hand's work a radian of phase, of contacts with their whole forces."""
    by_q = scratch(COORDINATES)
    elastic_energy(q, device, by_q)
    ax, ay, az = 0.0, 0.0, 1.0
    torque = 0.0
    if command[M_ABOUT_BOLT] > 0.0:
        ax, ay, az = command[M_TILT + 2], command[M_TILT + 5], command[M_TILT + 8]
    else:
        x, y = device[D_CENTRE] * device[D_ROTATION + 2], device[D_CENTRE] * device[D_ROTATION + 5]
        torque = by_q[3] * y - by_q[4] * x
    for i in range(count):
        fx, fy, fz = contacts[i, K_FORCE], contacts[i, K_FORCE + 1], contacts[i, K_FORCE + 2]
        px, py, pz = contacts[i, K_POINT] - q[3], contacts[i, K_POINT + 1] - q[4], contacts[i, K_POINT + 2] - q[5]
        torque -= ax * (py * fz - pz * fy) + ay * (pz * fx - px * fz) + az * (px * fy - py * fx)
    return torque


@kernel()
def add_path_point(
    i: int,
    phase: float,
    push: float,
    kind: int,
    q: Array,
    count: int,
    contacts: Array,
    losses: Array,
    command: Array,
    device: Array,
    path: Path,
) -> None:
    """Sets a point of the path.

    ``losses`` are friction, fall, the number of solutions, and the moment about z on the bolt beside that of contacts.
    """
    points, all_contacts = path
    by_q = scratch(COORDINATES)
    place = scratch(PLACE_SIZE)
    set_place(q, device, place)
    energy = elastic_energy(q, device, by_q)
    points[i, P_PHASE], points[i, P_PUSH], points[i, P_KIND] = phase, push, kind
    points[i, P_POTENTIAL], points[i, P_ENERGY] = energy + push * q[5], energy
    along = command[M_TILT + 8] if command[M_ABOUT_BOLT] > 0.0 else 1.0
    points[i, P_TORQUE] = torque_with(q, count, contacts, command, device) - along * losses[3]
    points[i, P_COUNT] = count
    copy_numbers(q, points[i, P_COORDINATES : P_COORDINATES + COORDINATES])
    copy_numbers(place[0:12], points[i, P_POSE : P_POSE + 12])
    copy_numbers(losses[0:3], points[i, P_FRICTION : P_FRICTION + 3])
    for c in range(count):
        copy_numbers(contacts[c], all_contacts[i, c])


@kernel()
def has_ended(i: int, stop_at_snap: bool, count: int, contacts: Array, setting: Setting, path: Path) -> int:
    """Whether the path ends at its last point: by a snap, by the torque, or as the bolt slipped or went too deep."""
    command, bolt = setting[0], setting[3]
    points, _ = path
    r = bolt[pk.R_MAJOR]
    if abs(points[i, P_TORQUE]) > TORQUE_LIMIT * command[M_PUSH] * r:
        return TORQUE_OVER
    if math.hypot(points[i, P_POSE + 9], points[i, P_POSE + 10]) > r:
        return SLIPPED_OFF
    if points[i, P_POSE + 11] < -DEEPEST * bolt[pk.P]:
        return TOO_DEEP
    is_below = False
    for c in range(count):
        is_below = is_below or contacts[c, K_POINT + 2] < -BELOW_TOP * r
    j = i - 1
    while stop_at_snap and is_below and j >= 0:
        if abs(points[j, P_PHASE] - points[i, P_PHASE]) > SNAP_SPAN * (1.0 + 1e-9):
            break
        if points[j, P_POSE + 11] - points[i, P_POSE + 11] > SNAP_FALL * bolt[pk.P]:
            return SNAP_REACHED
        j -= 1
    return GOES_ON


@kernel()
def unexplained(before: Array, after: Array) -> float:
    """The potential lost in the step from a point to the next that neither torque, push nor friction explains."""
    lost = before[P_POTENTIAL] - after[P_POTENTIAL] - after[P_FRICTION]
    lost += 0.5 * (before[P_TORQUE] + after[P_TORQUE]) * (after[P_PHASE] - before[P_PHASE])
    height = 0.5 * (before[P_COORDINATES + 5] + after[P_COORDINATES + 5])
    return lost + height * (after[P_PUSH] - before[P_PUSH])


@kernel(allocates=True)
def set_branch(
    k: int,
    number: int,
    phase: float,
    push: float,
    i: int,
    b: int,
    setting: Setting,
    solutions: Solutions,
    path: Path,
    branch: Path,
) -> bool:
    """Sets row b of a branch to a step's solution k, one of a number, from point i on; whether its work explains it.

    One that it does not is a finite way off: no motion without a jump leads there.
    """
    command, device, bolt = setting[0], setting[1], setting[3]
    places, all_contacts, counts = solutions
    points, point_contacts = path
    losses = zeros(4)
    contacts = all_contacts[k].copy()
    losses[0] = friction_loss(int(points[i, P_COUNT]), point_contacts[i], int(counts[k]), contacts)
    losses[2] = number
    count = kept(int(counts[k]), contacts, command[M_PUSH])
    add_path_point(b, phase, push, ON_CONTACTS, places[k], count, contacts, losses, command, device, branch)
    return abs(unexplained(points[i], branch[0][b])) <= ENERGY_STEP * command[M_PUSH] * bolt[pk.R_MAJOR]


@kernel()
def has_several(
    number: int,
    phase: float,
    push: float,
    i: int,
    q: Array,
    setting: Setting,
    solutions: Solutions,
    path: Path,
    spare: Path,
) -> bool:
    """Whether a step from point i has another solution than ``q`` that no jump leads to."""
    device = setting[1]
    for k in range(number):
        if distance(q, solutions[0][k], device) < DISTINCT * device[D_SCALE]:
            continue
        if set_branch(k, number, phase, push, i, 0, setting, solutions, path, spare):
            return True
    return False


@kernel()
def add_branches(
    i: int, number: int, q: Array, setting: Setting, solutions: Solutions, path: Path, branches: Branches
) -> int:
    """Adds a branch for each of the step's other solutions that no jump leads to, to point i; how many there are."""
    device = setting[1]
    points = path[0]
    rows, row_contacts, indices = branches
    total = 0
    while total < MAX_BRANCHES and indices[total] >= 0:
        total += 1
    added = 0
    for k in range(number):
        if distance(q, solutions[0][k], device) < DISTINCT * device[D_SCALE]:
            continue
        b = min(total, MAX_BRANCHES - 1)
        phase, push = points[i, P_PHASE], points[i, P_PUSH]
        if not set_branch(k, number, phase, push, i - 1, b, setting, solutions, path, (rows, row_contacts)):
            continue
        added += 1
        if total < MAX_BRANCHES:
            indices[total] = i
            total += 1
    return added


@kernel()
def bend(i: int, q: Array, reached: float, earlier: float, target: float, path: Path, device: Array) -> float:
    """How far (nominal radii) a step from point i ends from where it would as the one before it went.

    The parts of the leg at the point before, at i and at the end are ``earlier``, ``reached`` and ``target``.
    """
    before, here = path[0][i - 1, P_COORDINATES : P_COORDINATES + COORDINATES], path[0][i, P_COORDINATES:]
    ahead = scratch(COORDINATES)
    for j in range(COORDINATES):
        ahead[j] = here[j] + (here[j] - before[j]) * (target - reached) / (reached - earlier)
    return distance(ahead, q, device) / device[D_SCALE]


@kernel()
def go_back(i: int, q: Array, contacts: Array, path: Path) -> int:
    """Sets coordinates and contacts to those of a point; the number of contacts."""
    points, all_contacts = path
    copy_numbers(points[i, P_COORDINATES : P_COORDINATES + COORDINATES], q)
    count = int(points[i, P_COUNT])
    for c in range(count):
        copy_numbers(all_contacts[i, c], contacts[c])
    return count


class LastStep(NamedTuple):
    """The last step on contacts that was solved, or fall: the next one begins as it went on.

    Attributes:
        size: how much of the leg it was, 0 where the next step begins without it.
        found: the number of its contacts.
        contacts: these, at its end.
        begin: coordinates where it began.
        end: and where it ended.
    """

    size: Array
    found: Indices
    contacts: Array
    begin: Array
    end: Array


@kernel(allocates=True)
def new_last_step() -> LastStep:
    """One without which the first step begins."""
    return LastStep(
        np.zeros(1),
        np.zeros(1, dtype=np.int64),
        np.empty((MOST_CANDIDATES, K_SIZE)),
        np.empty(COORDINATES),
        np.empty(COORDINATES),
    )


@kernel()
def set_last_step(size: float, begin: Array, end: Array, count: int, contacts: Array, last: LastStep) -> None:
    """Sets the last step."""
    last.size[0], last.found[0] = size, count
    copy_numbers(begin, last.begin)
    copy_numbers(end, last.end)
    for c in range(count):
        copy_numbers(contacts[c], last.contacts[c])


@kernel()
def step_on_contacts(
    size: float,
    begin: Array,
    q: Array,
    push: float,
    mu: float,
    turns: bool,
    begins_anew: bool,
    before: Array,
    count: int,
    contacts: Array,
    last: LastStep,
    setting: Setting,
    solutions: Solutions,
    losses: Array,
) -> tuple[int, int]:
    """A step as :func:`step_with_friction`, with the guess that the last one leaves, which it is then.

    ``begin`` are the coordinates of the path's point before, from which ``q`` differs where the bolt has been tipped.
    """
    guessed = int(last.found[0]) if last.size[0] > 0.0 else 0
    part = size / last.size[0] if guessed > 0 else 0.0
    set_guess(part, q, last.begin, last.end, guessed, last.contacts, setting[7])
    ended, next_count = step_with_friction(
        q, push, mu, turns, begins_anew, before, count, contacts, setting, solutions, losses
    )
    if ended == GOES_ON:
        set_last_step(size, begin, q, next_count, contacts, last)
    return ended, next_count


@kernel()
def next_step(size: float, falls: int, longest: float, least: float) -> float:
    """How long the step after one of a size is, the last of so many falls in a row."""
    if falls == 0:
        return min(2.0 * size, longest)
    tried = 0 if falls % TRIED_AGAIN == 0 else falls - 1
    return max(FIRST_PART * longest * 0.5**tried, least)


@kernel(nogil=True, allocates=True)
def follow_friction(
    q: Array,
    phases: Array,
    pushes: Array,
    mu: float,
    stop_at_snap: bool,
    count: int,
    contacts: Array,
    command: Array,
    device: Array,
    strip: Array,
    bolt: Array,
    nut: Array,
    begun: int,
    path: Path,
    branches: Branches,
) -> tuple[int, int, int]:
    """Follows a bolt from ``q``, in place, while phase and push go from the first to the second of theirs.

    ``contacts`` are the ``count`` ones at the beginning, and are set to those of the end. Of a path that has ``begun``
    so many points are there: it goes on from the last of them. Returns how it ended, the number of points set, and that
    of contacts; ``branches`` are those of the points that are new.
    """
    setting = (command, device, strip, bolt, nut, new_threads(bolt), new_work(), new_modes_work())
    turn, growth, r = phases[1] - phases[0], pushes[1] - pushes[0], bolt[pk.R_MAJOR]
    turns = turn != 0.0
    longest = command[M_LONGEST] / abs(turn) if turns else LONGEST_PUSH * command[M_LONGEST] / LONGEST_TURN
    least = LEAST_PART * longest
    bridging, falling, jumps, is_shortened, bare, falls = False, False, False, False, 0, 0
    step, reached, earlier, i, kind = FIRST_PART * longest, 0.0, -1.0, 0, ON_CONTACTS
    solutions, last = new_solutions(), new_last_step()
    before, losses = scratch(PLACE_SIZE), zeros(4)
    spare = (scratch(1, POINT_SIZE), np.empty((1, MOST_CANDIDATES, K_SIZE)))
    branches[2][:] = -1
    set_phase(phases[0], command, device)
    if begun > 0:
        i = begun - 1
        count, kind = go_back(i, q, contacts, path), int(path[0][i, P_KIND])
        reached = (path[0][i, P_PHASE] - phases[0]) / turn if turns else (path[0][i, P_PUSH] - pushes[0]) / growth
    else:
        if count == 1 and contacts[0, K_PAIR] == FLUSH_PAIR and is_level(q, device):
            kind = ON_SURFACE
        add_path_point(0, phases[0], pushes[0], kind, q, count, contacts, losses, command, device, path)
    while reached < 1.0:
        if i + 1 == MAX_POINTS:
            return PATH_FULL, i + 1, count
        left = 1.0 - reached
        size = left if left <= ABOVE * step else step
        target = 1.0 if size == left else reached + size
        push = pushes[0] + target * growth
        set_phase(phases[0] + reached * turn, command, device)
        set_place(q, device, before)
        set_phase(phases[0] + target * turn, command, device)
        next_kind, next_count, ended = step_held(
            kind, q, push, mu, (target - reached) * turn, before, contacts, setting, losses
        )
        tips = next_kind == ON_CONTACTS and kind == ON_SURFACE
        is_coarse = size > least and size * abs(turn) > ABOVE * EVENT_WIDTH
        if is_coarse and next_kind == kind == ON_SURFACE and path[1][i, 0, K_MODE] == SLIPS:
            # From rest friction first turns to where the bolt slides.
            phase = phases[0] + reached * turn
            tips = not lies_throughout(phase, (target - reached) * turn, push, mu, before, setting)
        if tips and is_coarse:
            # Where it tips is narrowed first.
            count = go_back(i, q, contacts, path)
            step = max(0.5 * size, EVENT_WIDTH / abs(turn), least)
            continue
        if next_kind == ON_CONTACTS and ended == GOES_ON:
            if tips:
                count = contacts_of_tip(q, push, setting, contacts)
            # Of steps that become shorter only the first and the shortest are begun anew: it takes most of their time.
            begins_anew = size <= least or not is_shortened
            ended, begin = SHORTER, path[0][i, P_COORDINATES : P_COORDINATES + COORDINATES]
            if not jumps:
                ended, next_count = step_on_contacts(
                    size,
                    begin,
                    q,
                    push,
                    mu,
                    turns,
                    begins_anew,
                    before,
                    count,
                    contacts,
                    last,
                    setting,
                    solutions,
                    losses,
                )
        is_several = turns and ended == GOES_ON and losses[2] > 1.0
        if is_several and size > least:
            phase = phases[0] + target * turn
            is_several = has_several(int(losses[2]), phase, push, i, q, setting, solutions, path, spare)
        if size > least and not bridging and (ended == SHORTER or is_several):
            is_shortened = is_shortened or ended == SHORTER
            count = go_back(i, q, contacts, path)
            step = max(0.5 * size, least)
            continue
        if ended == SHORTER and not (turns or falling):
            count = go_back(i, q, contacts, path)
            bridging = size < min(longest, 1.0 - reached)
            falling = not bridging
            step = min(BRIDGING * size, longest) if bridging else least
            continue
        if ended == SHORTER:
            next_kind, next_count, ended = fall_with_friction(
                q, push, mu, before, count, contacts, setting, solutions, losses
            )
            # The next step may end where the fall did, with contacts that do as they did at its end.
            is_bare = losses[2] == FRICTIONLESS
            set_last_step(0.0 if is_bare or next_kind != ON_CONTACTS else size, q, q, next_count, contacts, last)
            bare = bare + 1 if is_bare else 0
            if bare > MOST_BARE:
                return NO_MINIMUM, i + 1, count
        if ended != GOES_ON:
            return ended, i + 1, count
        count = next_count
        add_path_point(
            i + 1, phases[0] + target * turn, push, next_kind, q, count, contacts, losses, command, device, path
        )
        lost = unexplained(path[0][i], path[0][i + 1])
        if abs(lost) > ENERGY_STEP * command[M_PUSH] * r and next_kind != ON_STRIP:
            if size > least and not bridging:
                count = go_back(i, q, contacts, path)
                step = max(0.5 * size, least)
                continue
            if turns and next_kind == ON_CONTACTS and losses[2] == 1.0:
                # The solution is a finite way off, and no motion leads there but a fall that may end before.
                count = go_back(i, q, contacts, path)
                jumps = True
                continue
            path[0][i + 1, P_FALL] = max(lost, 0.0)
        changed = next_kind != kind
        is_resolved = not turns or next_kind == ON_STRIP or size * abs(turn) <= ABOVE * EVENT_WIDTH
        if turns and next_kind == kind == ON_CONTACTS:
            count_before, contacts_before = int(path[0][i, P_COUNT]), path[1][i]
            changed = not same_contacts(before, count_before, contacts_before, count, contacts, setting)
        bent = 0.0
        goes_on = next_kind == kind == ON_CONTACTS and not changed and path[0][i + 1, P_FALL] == 0.0
        if goes_on and earlier >= 0.0 and turns:
            bent = bend(i, q, reached, earlier, target, path, device)
        if not is_resolved and (changed or bent > BENT):
            count = go_back(i, q, contacts, path)
            step = max(0.5 * size, EVENT_WIDTH / abs(turn))
            continue
        i += 1
        earlier = reached if goes_on and losses[2] > 0.0 else -1.0
        reached, kind = target, next_kind
        bare = bare if losses[2] == FRICTIONLESS else 0
        if losses[2] > 1.0:
            path[0][i, P_SOLUTIONS] = 1.0 + add_branches(i, int(losses[2]), q, setting, solutions, path, branches)
        ended = has_ended(i, stop_at_snap, count, contacts, setting, path)
        if ended != GOES_ON:
            return ended, i + 1, count
        bridging, falling, jumps, is_shortened = False, False, False, False
        falls = falls + 1 if losses[2] <= 0.0 else 0
        step = next_step(size, falls, longest, least)
        if LONGER * bent > BENT:
            step = min(step, size)
    return REACHED, i + 1, count


@kernel(nogil=True, allocates=True)
def certified_pose(q: Array, device: Array, bolt: Array, nut: Array) -> int:
    """What the certificate says of overlaps at a pose, whose places of contact are searched for."""
    r = bolt[pk.R_MAJOR]
    place = scratch(PLACE_SIZE)
    places = np.empty((MAX_PLACES + 1, GAP_SIZE))
    set_place(q, device, place)
    found = find_places(REACH * r, place, device, bolt, nut, new_threads(bolt), scratch(PLACES_WORK), places)
    touching = 0
    for j in range(found):
        if places[j, G_VALUE] > -LEAST_GAP * r:
            copy_numbers(places[j], places[touching])
            touching += 1
    return overlap(place[0:12], OVERLAP_LIMIT * r, touching, places, bolt, nut, new_stage())
