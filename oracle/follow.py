"""Paths of a held bolt that is turned, by time steps: small steps of the hand, contacts at places that samples find.

Each step is implicit (Moreau and Jean): device, push and contact forces with Coulomb friction balance at its end, with
the slip of the whole step. It is solved by linear steps on the places nearest to each other, with a damping of each
that vanishes as they do. A bolt that would go far in a step of the hand, or finds no balance, falls instead: small
implicit steps at the same command, with a drag on the way of each that is lowered as the bolt slows down. Inside,
lengths are in nominal radii and forces in pushes. A place of the bolt is five numbers: the first two of the rotation
vector in the commanded bolt's axes, the shift of the compliance centre across the nut's axis, and its height.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracle.compiled import compiled
from oracle.coulomb import contact_step
from oracle.first_height import first_height
from oracle.near_places import BODY, GAP, NORMAL, ON_THREAD, PART, POINT, U, V, near_places, place_at
from oracle.pose import pose_rotation
from oracle.profile import COT, FALLING, bolt_profile, nut_profile
from oracle.rest import turned
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]
Pose = tuple[Floats, Floats]

WINDOW = 0.06
"""Places with a smaller gap count in a step."""
LARGEST = 0.02
"""No linear step is longer, in any coordinate."""
FALL = 0.009
"""A bolt that goes farther within a step of the hand falls."""
FLOW, MOST_FLOW, FLOWN, FLOW_STEPS = 100.0, 1e5, 0.01, 300
"""Drag on a fall at its beginning and at most, the longest of its steps, and the most of them."""
LEAST_DRAG, MOST_DRAG = 0.5, 1e4
BALANCED = 1e-5
"""What drag is left at the end of a step, over the push."""
TOUCHING = 1e-6
"""Overlap at the end of a step."""
NEARLY_BALANCED, NEARLY_TOUCHING, NEARLY_AFTER = 1e-2, 1e-4, 25
"""The same that are enough after so many linear steps: peaks that are flat move to and fro."""
ACCURACY = 1e-6
"""Of contact forces over the push, in each linear step."""
STEPS = 100
"""The most linear steps of one implicit step."""
FRESH = 8
"""After so many linear steps all places are sampled again."""
FORCES = 14
"""Column of the contact force on the bolt in the nut's frame, beside those of a place."""
BALANCE, NEARLY, LOOSE = 0, 1, 2
"""How a step ends: balanced, nearly so, or after the most linear steps."""


@compiled
def commanded(tilt: Floats, phase: float) -> Floats:
    """The commanded rotation: a tilt that goes round with the phase (rad)."""
    c, s = math.cos(phase), math.sin(phase)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ tilt


@compiled
def pose_of(q: Floats, command: Floats, centre: float) -> Pose:
    """The rotation and the origin of a bolt at a place."""
    rot = turned(command, q[0], q[1], 0.0)
    t = np.array([q[2] + centre * command[0, 2], q[3] + centre * command[1, 2], q[4]]) - centre * rot[:, 2]
    return rot, t


@compiled
def _turn_axes(q: Floats, command: Floats) -> Floats:
    """The angular velocities of both coordinates of rotation, in the nut's frame, shape (3, 2)."""
    x, y = q[0], q[1]
    angle = math.sqrt(x * x + y * y)
    cross = np.array([[0.0, 0.0, y], [0.0, 0.0, -x], [-y, x, 0.0]])
    jacobian = np.eye(3)
    if angle > 1e-9:
        half = (1.0 - math.cos(angle)) / (angle * angle)
        jacobian = jacobian + half * cross + (angle - math.sin(angle)) / angle**3 * (cross @ cross)
    return (command @ jacobian)[:, :2].copy()


@compiled
def _metric(q: Floats, command: Floats, centre: float) -> Floats:
    """The squared length of motions, rotations in rad and the way of the bolt's origin in radii, shape (5, 5)."""
    axes = _turn_axes(q, command)
    along = turned(command, q[0], q[1], 0.0)[:, 2].copy()
    turning, way = np.zeros((3, 5)), np.zeros((3, 5))
    turning[:, :2] = axes
    way[:, 2:] = np.eye(3)
    for k in range(2):
        way[:, k] = -centre * np.cross(axes[:, k].copy(), along)
    return turning.T.copy() @ turning + way.T.copy() @ way


@compiled
def _tangents(normal: Floats) -> tuple[Floats, Floats]:
    axis = np.array([1.0, 0.0, 0.0]) if abs(normal[0]) < 0.6 else np.array([0.0, 1.0, 0.0])
    first = np.cross(normal, axis)
    first = first / math.sqrt(first @ first)
    return first, np.cross(normal, first)


@compiled
def _linearised(
    places: Floats, q: Floats, command: Floats, centre: float, reference: Pose
) -> tuple[Floats, Floats, Floats, Floats]:
    """Velocities, gaps, slips since a pose, and forces of all places, along normal and tangents."""
    rot, t = pose_of(q, command, centre)
    axes = _turn_axes(q, command)
    middle = t + centre * rot[:, 2]
    n = len(places)
    rows, slips, forces = np.empty((n, 3, 5)), np.empty((n, 2)), np.empty((n, 3))
    for i in range(n):
        normal, point = places[i, NORMAL : NORMAL + 3].copy(), places[i, POINT : POINT + 3].copy()
        body, force = places[i, BODY : BODY + 3].copy(), places[i, FORCES : FORCES + 3].copy()
        way = point - (reference[0] @ body + reference[1])
        first, second = _tangents(normal)
        arm = point - middle
        for k in range(3):
            along = normal if k == 0 else (first if k == 1 else second)
            rows[i, k, :2] = np.cross(arm, along) @ axes
            rows[i, k, 2:] = along
            forces[i, k] = along @ force
        slips[i, 0], slips[i, 1] = first @ way, second @ way
    return rows, places[:, GAP].copy(), slips, forces


@compiled
def _sampled(places: Floats, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> Floats:
    """All near places of a pose, with the forces of the nearest ones of those before."""
    found = near_places(WINDOW, rot, t, bolt, nut)
    new = np.zeros((len(found), FORCES + 3))
    taken = np.zeros(len(places))
    for i in range(len(found)):
        new[i, :FORCES] = found[i]
        nearest, least = -1, 0.1
        for k in range(len(places)):
            away = math.sqrt(((places[k, POINT : POINT + 3] - found[i, POINT : POINT + 3]) ** 2).sum())
            if places[k, PART] == found[i, PART] and taken[k] == 0.0 and away < least:
                nearest, least = k, away
        if nearest >= 0:
            new[i, FORCES:] = places[nearest, FORCES:]
            taken[nearest] = 1.0
    return new


@compiled
def _tracked(places: Floats, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> Floats:
    """The same places in a new pose, each zoomed on from where it was."""
    new = places.copy()
    for i in range(len(places)):
        part = int(places[i, PART])
        new[i, :FORCES] = place_at(part, places[i, U], places[i, V], rot, t, bolt, nut)
    return new


@compiled
def _keep_forces(places: Floats, forces: Floats) -> None:
    for i in range(len(places)):
        normal = places[i, NORMAL : NORMAL + 3].copy()
        first, second = _tangents(normal)
        places[i, FORCES:] = forces[i, 0] * normal + forces[i, 1] * first + forces[i, 2] * second


@compiled
def _new_drag(drag: float, step: Floats, before: Floats) -> float:
    """More drag where steps go to and fro, less where they go on."""
    size, last = math.sqrt(step @ step), math.sqrt(before @ before)
    if last == 0.0 or size == 0.0:
        return drag
    cosine = (step @ before) / (size * last)
    if cosine < 0.0 and size > 0.3 * last:
        return min(3.0 * drag, MOST_DRAG)
    if cosine > 0.8 and size > 0.3 * last:
        return max(0.8 * drag, LEAST_DRAG)
    return drag


@compiled
def implicit_step(
    q: Floats,
    places: Floats,
    reference: Pose,
    command: Floats,
    flow: float,
    push: float,
    mu: float,
    device: tuple[Floats, float, float],
    bolt: Floats,
    nut: Floats,
) -> tuple[Floats, Floats, int, int]:
    """The place and contacts at the end of a step to a command, how it ends, and the number of linear steps.

    ``reference`` is the pose before the step, ``flow`` a drag on the way since then: 0 but in a fall. ``device`` is the
    stiffness (5, 5), the height of the centre over the base, and the height of the centre at the first contact.
    """
    stiffness, centre, first = device
    start, q = q.copy(), q.copy()
    rot, t = pose_of(q, command, centre)
    places = _sampled(places, rot, t, bolt, nut)
    metric = _metric(q, command, centre)
    at_rest = np.array([0.0, 0.0, 0.0, 0.0, first])
    drag, before = LEAST_DRAG, np.zeros(5)
    end = LOOSE
    number = 0
    while number < STEPS and end == LOOSE:
        rows, gaps, slips, forces = _linearised(places, q, command, centre, reference)
        load = -(stiffness @ (q - at_rest)) - flow * (metric @ (q - start))
        load[4] -= push
        inverse = np.linalg.inv(stiffness + flow * metric + drag * np.eye(5)).astype(np.float64)
        if mu == 0.0:
            forces[:, 1:] = 0.0
        step, solved = contact_step(rows, gaps, slips, load, inverse, mu, forces, ACCURACY * push)
        size = np.abs(step).max()
        is_long = size > LARGEST
        if is_long:
            step *= LARGEST / size
        _keep_forces(places, forces)
        q += step
        rot, t = pose_of(q, command, centre)
        is_still = not is_long and size * drag < BALANCED
        if is_still or number % FRESH == FRESH - 1 or is_long:
            places = _sampled(places, rot, t, bolt, nut)
        else:
            places = _tracked(places, rot, t, bolt, nut)
        least = places[:, GAP].min() if len(places) > 0 else 1.0
        number += 1
        if is_still and solved and least > -TOUCHING:
            end = BALANCE
        elif number > NEARLY_AFTER and not is_long and size * drag < NEARLY_BALANCED and least > -NEARLY_TOUCHING:
            end = NEARLY
        drag = _new_drag(drag, step, before)
        before = step
    return q, places, end, number


@compiled
def hand_step(
    q: Floats,
    places: Floats,
    reference: Pose,
    command: Floats,
    push: float,
    mu: float,
    device: tuple[Floats, float, float],
    bolt: Floats,
    nut: Floats,
) -> tuple[Floats, Floats, int, int, float]:
    """The place and contacts after a step of the hand to a command; ``reference`` is the pose before it.

    Returns also how the step ends, the number of linear steps, and how far the bolt fell.
    """
    centre = device[1]
    end_q, end_places, end, steps = implicit_step(q, places, reference, command, 0.0, push, mu, device, bolt, nut)
    if end != LOOSE and np.abs(end_q - q).max() < FALL:
        return end_q, end_places, end, steps, 0.0
    at, flow, worst = q.copy(), FLOW, BALANCE
    for _ in range(FLOW_STEPS):
        new, new_places, end, more = implicit_step(at, places, reference, command, flow, push, mu, device, bolt, nut)
        steps += more
        way = np.abs(new - at).max()
        if (end == LOOSE or way > FLOWN) and flow < MOST_FLOW:
            flow *= 4.0
            continue
        worst = max(worst, end)
        at, places = new, new_places
        reference = pose_of(at, command, centre)
        if end != LOOSE and flow * way < BALANCED:
            return at, places, worst, steps, np.abs(at - q).max()
        if way < 0.25 * FLOWN:
            flow *= 0.25
    return at, places, LOOSE, steps, np.abs(at - q).max()


@dataclass(frozen=True)
class Hand:
    """A device that turns about the nut's axis, with a rigid twist, in the pair's unit.

    ``stiffness`` is 6 x 6, rotation first, ``centre`` the height of the compliance centre over the base.
    """

    stiffness: Floats
    centre: float
    push: float


@dataclass(frozen=True)
class Point:
    """The bolt after a step of the hand; lengths in nominal radii, angles in rad, forces over the push.

    ``turn`` is the bolt's own turn about the nut's axis less the phase, ``torque`` the hand's about the nut's axis,
    ``fall`` how far the bolt fell in the step, ``below`` whether a contact that carries a force is one of threads.
    """

    phase: float
    rotation: Floats
    origin: Floats
    turn: float
    torque: float
    largest_force: float
    contacts: int
    below: bool
    fall: float
    nearly: bool
    loose: bool
    linear_steps: int

    @property
    def tilt(self) -> float:
        """The angle between the bolt's axis and the nut's."""
        return math.atan2(math.hypot(self.rotation[0, 2], self.rotation[1, 2]), self.rotation[2, 2])


def scaled(profile: Floats, radius: float) -> Floats:
    """A packed profile with lengths in nominal radii."""
    new = profile / radius
    new[[COT, COT + FALLING]] = profile[[COT, COT + FALLING]]
    return np.asarray(new)


class Follower:
    """A bolt in a hand, followed from its first contact."""

    def __init__(self, pair: Pair, hand: Hand, pose_deg: tuple[float, float, float], mu: float) -> None:
        self._r = r = pair.nominal_diameter / 2.0
        self._profiles = scaled(bolt_profile(pair), r), scaled(nut_profile(pair), r)
        self._tilt = pose_rotation(pose_deg[0], pose_deg[1], 0.0)
        lengths = np.array([1.0, 1.0, 1.0, r, r, r])
        stiffness = np.outer(lengths, lengths) * hand.stiffness / (hand.push * r)
        kept = [0, 1, 3, 4, 5]
        centre = hand.centre / r
        self.phase = math.radians(pose_deg[2])
        first = first_height(pair, *pose_deg).height / r + centre * self._tilt[2, 2]
        self._device = (np.ascontiguousarray(stiffness[np.ix_(kept, kept)]), centre, first)
        self._mu = mu
        self._q = np.array([0.0, 0.0, 0.0, 0.0, first])
        self._places = np.zeros((0, FORCES + 3))
        self._push = 0.0

    @property
    def potential(self) -> float:
        """Elastic energy and that of the push, over push times nominal radius."""
        stiffness, _, first = self._device
        deviation = self._q - np.array([0.0, 0.0, 0.0, 0.0, first])
        return float(0.5 * deviation @ stiffness @ deviation + self._push * self._q[4])

    def step(self, phase: float, push: float) -> Point:
        """Turn the hand to a phase (rad) and let the push grow to a part of it."""
        centre = self._device[1]
        reference = pose_of(self._q, commanded(self._tilt, self.phase), centre)
        command = commanded(self._tilt, phase)
        self._q, self._places, end, steps, fall = hand_step(
            self._q, self._places, reference, command, push, self._mu, self._device, *self._profiles
        )
        self.phase, self._push = phase, push
        rot, t = pose_of(self._q, command, centre)
        points, forces = self._places[:, POINT : POINT + 3], self._places[:, FORCES:]
        moment = float((points[:, 0] * forces[:, 1] - points[:, 1] * forces[:, 0]).sum())
        sizes = np.linalg.norm(forces, axis=1)
        loaded = sizes > 1e-3
        twist = math.atan2(rot[1, 0] - rot[0, 1], rot[0, 0] + rot[1, 1])
        return Point(
            phase=phase,
            rotation=rot,
            origin=t,
            turn=math.remainder(twist - phase, 2.0 * math.pi),
            torque=-moment,
            largest_force=float(sizes.max(initial=0.0)),
            contacts=int(loaded.sum()),
            below=bool((self._places[loaded, ON_THREAD] > 0.0).any()),
            fall=fall,
            nearly=end == NEARLY,
            loose=end == LOOSE,
            linear_steps=steps,
        )
