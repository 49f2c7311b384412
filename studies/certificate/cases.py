"""Boxes that the audit looks at: drawn at random, and those that searches of solved states visit."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from studies.certificate.motions import EdgeMotion, edge_motion
from threadstate.contact import _box_kernel as box
from threadstate.contact._edge_search_kernel import BATCH, box_at, pad_boxes, part_of, set_box_at
from threadstate.contact._geometry_kernel import MOTION_SIZE, TWO_PI, motion_scale
from threadstate.contact._initial_box_kernel import set_initial_boxes
from threadstate.contact._stage_kernel import rotation, set_motions
from threadstate.contact._surface_kernel import start_height
from threadstate.errors import UnresolvedPoseError
from threadstate.state.model import ContactState, FeaturePair
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.pair import Pair
from threadstate.thread.profile import Profile

Floats = NDArray[np.float64]

FORMS = (
    "1/4-20 UNC",
    "M6x1-6g/6H",
    "1/4-20 BSW-medium/normal",
    "1/4-16 ACME-2G",
    "Tr 8x1.5-7e/7H",
    "Tr 8x1.5-7e/7H with sharp corners",
    "M6x1-6g/6H LH",
    "Tr 8x1.5-7e/7H 2 starts",
    "Tr 8x1.5-7e/7H, flanks of 30 and 10 deg",
)
STAGES = ("descent", "second turn", "second turn about both planes", "third turn", "late turn")
SEED = 29
SLENDER = 50.0
MOST_VISITED = 600
"""Boxes of one search at most."""


@lru_cache
def pair_of(form: str) -> Pair:
    """The pair of a designation, or with the flanks that are named after it."""
    designation, _, flanks = form.partition(", flanks of ")
    pair = pair_by_designation(designation)
    if not flanks:
        return pair
    positive, negative = (float(angle) for angle in flanks.removesuffix(" deg").split(" and "))
    return replace(pair, form=replace(pair.form, flank_half_angle_deg=positive, flank_half_angle_neg_deg=negative))


@dataclass(frozen=True)
class Search:
    """A motion of one part's edge curve, for the kernels and in balls; what it is a case of."""

    form: str
    stage: str
    motion: Floats = field(repr=False)
    curve: Profile = field(repr=False)
    solid: Profile = field(repr=False)
    balls: EdgeMotion = field(repr=False)


@dataclass(frozen=True)
class Box:
    """A box of azimuth and time of a search: middle and half-width, start and end; whether a search visited it."""

    search: Search
    theta: float
    half: float
    start: float
    end: float
    visited: bool


def searches(form: str, stage: str, pose: Floats, point: Floats, axis: Floats) -> tuple[Search, Search]:
    """The motions of the bolt's edge and of the nut's, from a pose (rotation by rows, translation)."""
    bolt_motion, nut_motion = np.zeros(MOTION_SIZE), np.zeros(MOTION_SIZE)
    set_motions(pose, stage != "descent", stage.endswith("both planes"), point, axis, bolt_motion, nut_motion)
    bolt, nut = pair_of(form).bolt, pair_of(form).nut
    return (
        Search(form, stage, bolt_motion, bolt, nut, edge_motion(bolt_motion, bolt, nut)),
        Search(form, stage, nut_motion, nut, bolt, edge_motion(nut_motion, nut, bolt)),
    )


def random_search(form: str, stage: str, choose: np.random.Generator) -> Search:
    """A random motion of that stage; a late turn goes on from one of up to 45 deg, so that no tilt is left out."""
    pair = pair_of(form)
    p, r = pair.thread_pitch, pair.bolt.major_diameter / 2.0
    tilt = math.radians(10.0 ** choose.uniform(-8.0, 1.0))
    pose = np.zeros(12)
    rotation(*(tilt * choose.uniform(-1.0, 1.0, 2)), choose.uniform(0.0, TWO_PI), pose)
    point, axis = np.zeros(3), np.array([0.0, 0.0, -1.0])
    if stage != "descent":
        pose[9:] = choose.normal(0.0, 0.06 * p, 3) * (min(1.0, 30.0 * tilt) if choose.random() < 0.5 else 1.0)
        around, along = choose.uniform(0.0, TWO_PI, 2)
        point = np.array([r * math.cos(around), r * math.sin(around), choose.uniform(-0.4, 0.0) * p])
        axis = np.array([math.cos(along), math.sin(along), choose.normal(0.0, 0.05)])
        axis /= np.linalg.norm(axis)
    if stage == "late turn":
        pose[:9] = (_turn(axis, choose.uniform(0.0, 0.8)) @ pose[:9].reshape(3, 3)).ravel()
    pose[11] = choose.uniform(-0.1, 0.2) * p
    if stage.endswith("both planes"):
        # The line in which the bolt's base meets the nut's surface.
        normal = pose[[2, 5, 8]]
        axis = np.cross([0.0, 0.0, 1.0], normal)
        axis /= np.linalg.norm(axis)
        across = np.cross(axis, [0.0, 0.0, 1.0])
        reach = choose.uniform(0.5, 1.0) * r
        pose[11] = -reach * float(across @ normal) / float(normal[2]) + float(normal[:2] @ pose[9:11]) / normal[2]
        point = pose[9:] + reach * (across - across[2] * np.array([0.0, 0.0, 1.0]))
        point[2] = 0.0
        pose[11] = -float(normal[:2] @ (pose[9:11] - point[:2])) / float(normal[2])
    return searches(form, stage, pose, point, axis)[choose.integers(2)]


def _turn(axis: Floats, angle: float) -> Floats:
    cross = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    turned: Floats = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
    return turned


def random_box(search: Search, choose: np.random.Generator) -> Box:
    """A random box: half-widths log-uniform from 1e-9 rad to the search's largest, spans of time likewise."""
    scale = motion_scale(search.motion, search.curve.packed)
    half = 10.0 ** choose.uniform(-9.0, math.log10(math.pi / 32.0))
    span = scale * 10.0 ** choose.uniform(-10.0, math.log10(0.1))
    start = choose.uniform(0.0, 0.3 if search.stage != "late turn" else 0.8) * scale
    return Box(search, choose.uniform(0.0, TWO_PI), half, start, start + span, visited=False)


def random_boxes(number: int, count: int) -> Iterator[Box]:
    """Boxes of every form and stage in turn, eight of each motion; the same for the same number."""
    choose = np.random.default_rng([SEED, 1, number])
    kinds = [(form, stage) for form in FORMS for stage in STAGES]
    made = 0
    while made < count:
        form, stage = kinds[choose.integers(len(kinds))]
        search = random_search(form, stage, choose)
        for _ in range(min(8, count - made)):
            yield random_box(search, choose)
            made += 1


def state_searches(form: str, state: ContactState) -> list[tuple[Search, float]]:
    """The motions of a solved state, and their times; of the descent and of the turns that begin without a patch."""
    pair = pair_of(form)
    angles = (math.radians(a) for a in (state.roll_deg, state.pitch_deg, state.phase_deg))
    pose = np.zeros(12)
    rotation(*angles, pose)
    pose[11] = start_height(pose, pair.bolt.packed)
    if not pose[11] - state.poses[0].translation[2] > 0.0:
        return []
    down = np.array([0.0, 0.0, -1.0])
    found = [
        (one, pose[11] - state.poses[0].translation[2]) for one in searches(form, "descent", pose, np.zeros(3), down)
    ]
    for i, (stage, turn) in enumerate((("second turn", state.lambda_deg), ("third turn", state.mu_deg))):
        if turn and len(state.poses) > i + 1 and len(state.contacts) > i:
            start, end = (np.array(state.poses[j].rotation) for j in (i, i + 1))
            relative = end @ start.T
            axis = np.array(
                [relative[2, 1] - relative[1, 2], relative[0, 2] - relative[2, 0], relative[1, 0] - relative[0, 1]]
            )
            axis /= np.linalg.norm(axis)
            pose = np.array([*start.ravel(), *state.poses[i].translation])
            flat = i == 0 and state.contacts[0].features is FeaturePair.EDGE_SURFACE
            name = f"{stage} about both planes" if flat else stage
            found += [
                (one, math.radians(turn)) for one in searches(form, name, pose, np.array(state.contacts[0].point), axis)
            ]
    return found


def visited_boxes(search: Search, until: float) -> list[tuple[Box, int]]:
    """The boxes that a search for all onsets up to a time visits, with their classes, as far as they are many."""
    boxes = np.zeros(box.BOXES_SIZE)
    curve, solid = search.curve.packed, search.solid.packed
    slender = SLENDER * motion_scale(search.motion, solid)
    found: list[tuple[Box, int]] = []
    count = set_initial_boxes(0.0, until, boxes)
    waiting = deque(box_at(i, boxes) for i in range(count))
    while waiting and len(found) < MOST_VISITED:
        taken = [waiting.popleft() for _ in range(min(BATCH, len(waiting)))]
        for i, one in enumerate(taken):
            set_box_at(one, i, boxes)
        box.classify_boxes(pad_boxes(len(taken), boxes), search.motion, curve, solid, boxes)
        for i, (theta, half, start, end) in enumerate(taken):
            kind = int(boxes[box.X_CLASS + i])
            found.append((Box(search, theta, half, start, end, visited=True), kind))
            undecided = kind == box.UNDECIDED_BOX
            if undecided or (kind >= box.PEAK_EDGE and half > 1e-6):
                by_time = bool(boxes[box.X_BY_TIME + i]) or (undecided and end - start > slender * half)
                waiting.extend(part_of(taken[i], by_time, part, 0.5) for part in range(2))
    return found


def search_boxes(number: int, count: int) -> Iterator[Box]:
    """Boxes that searches of random poses visit, each taken with even chances; the same for the same number."""
    choose = np.random.default_rng([SEED, 2, number])
    made = 0
    while made < count:
        form = FORMS[choose.integers(len(FORMS))]
        tilt = 10.0 ** choose.uniform(-2.0, 1.0)
        near = 20.0 if choose.random() < 0.5 else 180.0
        try:
            roll, pitch = tilt * choose.uniform(-1.0, 1.0, 2)
            state = solve_pose(pair_of(form), float(roll), float(pitch), float(choose.uniform(-near, near)))
        except UnresolvedPoseError:
            continue
        for search, until in state_searches(form, state):
            visited = visited_boxes(search, until)
            for i in choose.permutation(len(visited))[:40]:
                if made < count:
                    yield visited[i][0]
                    made += 1
