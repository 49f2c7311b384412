"""Settled states of several pairs and devices, checked apart from the solver (docs/settle-checked.md).

Three parts: random commands, each state checked with random directions beside it; minima that the brute force finds,
from beside a state and along the growing push; and commands, dimensions and devices that are changed a little.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cache

import numpy as np
from numpy.typing import NDArray

from studies.methods import with_dimensions
from studies.settle.check import LOWER, Checked, check, held_bolt, place_of
from threadstate.device.compile import load_device
from threadstate.device.document import device_from_document
from threadstate.device.model import Device, Outcome, SettledState
from threadstate.device.settle import settle_pose
from threadstate.errors import ImpossibleThreadError
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]
PoseDeg = tuple[float, float, float]

SEED = 2031
TILT_DEG = 4.0
NEAR_PHASE_DEG = 20.0
"""Every third command is no farther than that from in phase, where threads touch."""
DIRECTIONS = 100
BESIDE = 2e-3
"""How far beside a state (nominal radii) the brute force begins."""
BOX = 2e-3
"""Its steps, in nominal radii."""
CAME_BACK = 1e-8
"""Potential above the state's (push times nominal radius) up to which the brute force has found it again."""
FOLLOW_PARTS = 16
"""Parts of the push in which the brute force follows it."""

PAIRS = (
    "1/4-20 UNC",
    "1/4-20 UNC-2A/2B at minimum material",
    "M6x1-6g/6H",
    "M20x2.5-6g/6H",
    "1/4-20 BSW-medium/normal",
    "M6x1-6g/6H LH",
)
DEVICES: dict[str, dict[str, object]] = {
    "default": {},
    "centre 10 mm above the base": {"centre": 10.0},
    "centre 10 mm below the tip": {"centre": -10.0},
    "soft twist, 500 N mm": {"k_twist": 500.0},
    "axial, 50 N/mm": {"k_axial": 50.0},
    "tilt 50 N mm": {"k_tilt": 50.0},
    "tilt 5,000 N mm": {"k_tilt": 5000.0},
    "turned about the bolt": {"about": "bolt"},
}
"""What each device has beside the default one."""


@cache
def pair_of(number: int) -> Pair:
    """The pair with a number; the first is the default one."""
    return quarter_twenty_unc() if number == 0 else pair_by_designation(PAIRS[number])


@cache
def device_of(number: int) -> Device:
    """The device with a number."""
    return device_from_document({"unit": "mm", **list(DEVICES.values())[number]})


class Part(StrEnum):
    """Which part of the study."""

    RANDOM = "random"
    BESIDE = "beside"
    FOLLOWED = "followed"
    CHANGED = "changed"


@dataclass(frozen=True)
class Task:
    """So many items of a part, from a number on."""

    part: Part
    first: int
    count: int


@dataclass(frozen=True)
class Amount:
    """How many items of each part; of changed ones, how many centres."""

    random: int
    beside: int
    followed: int
    centres: int


ITEMS_A_TASK = {Part.RANDOM: 100, Part.BESIDE: 5, Part.FOLLOWED: 1, Part.CHANGED: 25}


def tasks(amount: Amount) -> Iterator[Task]:
    """All of the work, part by part."""
    whole = {
        Part.RANDOM: amount.random,
        Part.BESIDE: amount.beside,
        Part.FOLLOWED: amount.followed,
        Part.CHANGED: amount.centres,
    }
    for part, count in whole.items():
        size = ITEMS_A_TASK[part]
        for first in range(0, count, size):
            yield Task(part, first, min(size, count - first))


@dataclass(slots=True)
class Found:
    """What was found of settled states; two of them add up. Faults are a command and what contradicts its state."""

    states: int = 0
    outcomes: Counter[str] = field(default_factory=Counter)
    contacts: Counter[int] = field(default_factory=Counter)
    falls: int = 0
    overlap: float = -np.inf
    apart: float = -np.inf
    least_force: float = np.inf
    residual: float = 0.0
    milliseconds: list[float] = field(default_factory=list)
    gains: list[float] = field(default_factory=list)
    """Of minima by brute force: their potential above the state's, over push times nominal radius."""
    beyond: list[str] = field(default_factory=list)
    """Commands beside whose state, beyond a barrier, the potential is lower."""
    undecided: list[str] = field(default_factory=list)
    """Commands without an answer, with the reason."""
    faults: list[str] = field(default_factory=list)

    def add(self, other: Found) -> None:
        """Add what was found of other states."""
        self.states += other.states
        self.outcomes.update(other.outcomes)
        self.contacts.update(other.contacts)
        self.falls += other.falls
        self.overlap = max(self.overlap, other.overlap)
        self.apart = max(self.apart, other.apart)
        self.least_force = min(self.least_force, other.least_force)
        self.residual = max(self.residual, other.residual)
        self.milliseconds += other.milliseconds
        self.gains += other.gains
        self.beyond += other.beyond
        self.undecided += other.undecided
        self.faults += other.faults

    def add_state(self, state: SettledState, milliseconds: float, name: str) -> None:
        """Count a state."""
        self.states += 1
        self.outcomes[", ".join([state.outcome.value, *(flag.value for flag in state.flags)])] += 1
        self.falls += len(state.falls) > 0
        self.milliseconds.append(milliseconds)
        if state.outcome is Outcome.UNDECIDED:
            self.undecided.append(f"{name}: {', '.join(flag.value for flag in state.flags)}")
        if state.outcome is Outcome.SETTLED:
            self.contacts[len(state.contacts)] += 1

    def add_checked(self, checked: Checked, name: str) -> None:
        """Add what the checks of a state measured."""
        self.overlap = max(self.overlap, checked.overlap)
        self.apart = max(self.apart, -checked.overlap)
        self.least_force = min(self.least_force, checked.least_force)
        self.residual = max(self.residual, checked.residual)
        if checked.beyond > 0:
            self.beyond.append(f"{name}: {checked.beyond} places")
        self.faults += [f"{name}: {fault}" for fault in checked.faults]


@dataclass(frozen=True)
class Item:
    """A command of a pair held by a device."""

    pair: Pair
    device: Device
    pose_deg: PoseDeg
    name: str

    def settled(self, found: Found) -> SettledState:
        """Its state, counted."""
        start = time.process_time()
        state = settle_pose(self.pair, *self.pose_deg, self.device)
        found.add_state(state, 1e3 * (time.process_time() - start), self.name)
        return state


def item(part: Part, number: int) -> tuple[Item, np.random.Generator]:
    """The item with a number of a part, and the generator of all that is random about it."""
    choose = np.random.default_rng([SEED, list(Part).index(part), number])
    roll, pitch = choose.uniform(-TILT_DEG, TILT_DEG, 2)
    phase = choose.uniform(-180.0, 180.0)
    if number % 3 == 0:
        phase *= NEAR_PHASE_DEG / 180.0
    # Every other item is of the default pair, every other of the default device.
    pair = 0 if number % 2 == 0 else int(choose.integers(len(PAIRS)))
    device = 0 if number % 4 < 2 else int(choose.integers(len(DEVICES)))
    pose = float(roll), float(pitch), float(phase)
    name = f"{PAIRS[pair]}, {list(DEVICES)[device]}, {pose}"
    return Item(pair_of(pair), device_of(device), pose, name), choose


@cache
def _load_kernels() -> None:
    """Load the kernels once a process, so that no state's time has it."""
    load_device()


def done(task: Task) -> Found:
    """What a task finds."""
    _load_kernels()
    found = Found()
    for number in range(task.first, task.first + task.count):
        one, choose = item(task.part, number)
        if task.part is Part.CHANGED:
            _look_at_changes(one, number, choose, found)
            continue
        state = one.settled(found)
        if state.outcome is not Outcome.SETTLED:
            continue
        if task.part is Part.RANDOM:
            found.add_checked(check(one.pair, one.device, state, DIRECTIONS, choose), one.name)
        else:
            _look_for_minimum(one, state, task.part, choose, found)
    return found


def _look_for_minimum(one: Item, state: SettledState, part: Part, choose: np.random.Generator, found: Found) -> None:
    """The minimum that the brute force finds from beside the state, or from the first contact as the push grows."""
    held = held_bolt(one.pair, one.device, state)
    place, height = place_of(state)
    r = one.pair.nominal_diameter / 2.0
    value, _ = held.potential(place, height)
    if part is Part.BESIDE:
        way = choose.standard_normal(5) * (held.scale > 0.0)
        beside = place + BESIDE * r / np.linalg.norm(way) * way * held.scale
        end, _, lowest = held.lowest_by_programs(beside, height, BOX * r)
    else:
        at, up = np.zeros(5), held.first
        for share in range(1, FOLLOW_PARTS + 1):
            push = held.push * share / FOLLOW_PARTS
            at, up, lowest = held.lowest_by_programs(at, up, BOX * r, push)
    gain = (lowest - value) / (held.push * r)
    found.gains.append(gain)
    if gain < -LOWER and part is Part.BESIDE:
        text = f"{one.name}: the brute force from beside it finds a potential lower by {-gain:.2e} F r"
        is_beyond = held.is_beyond_barrier(place, height, end - place, LOWER * held.push * r)
        (found.beyond if is_beyond else found.faults).append(text)


CHANGES = 20
DECADES = (-12, -1)
"""Exponents of the changes: of a command in deg, of dimensions in thread pitches, of a device in parts of itself."""


def centre_of(one: Item, number: int) -> Item:
    """The command whose changes are looked at: every other one where something is on an edge.

    They are level or nearly so, on the grid, in phase, or symmetric.
    """
    roll, pitch, phase = one.pose_deg
    poses = (
        (round(roll), round(pitch), 10.0 * round(phase / 10.0)),
        (0.0, 0.0, phase),
        (1e-6 * roll, 1e-6 * pitch, phase),
        (roll, pitch, 0.0),
        (0.25 * roll, 0.25 * pitch, 90.0),
    )
    return one if number % 2 == 0 else replace(one, pose_deg=poses[number // 2 % len(poses)])


def _look_at_changes(one: Item, number: int, choose: np.random.Generator, found: Found) -> None:
    centre = centre_of(one, number)
    for trial in range(CHANGES):
        size = 10.0 ** choose.uniform(*DECADES)
        change = choose.uniform(-1.0, 1.0, 3) * size
        roll, pitch, phase = (np.array(centre.pose_deg) + change).tolist()
        pair, device = centre.pair, centre.device
        if trial % 4 == 2:
            try:
                pair = with_dimensions(
                    pair, tuple((1e-3 * size * pair.thread_pitch * choose.uniform(-1, 1, 7)).tolist())
                )
            except ImpossibleThreadError:
                continue
        if trial % 4 == 3:
            stiffness = np.array(device.stiffness) * (1.0 + size * choose.uniform(-1.0, 1.0))
            rows = tuple(tuple(row) for row in stiffness.tolist())
            device = replace(device, stiffness=rows, push=device.push * (1.0 + size * float(choose.uniform(-1.0, 1.0))))
        changed = Item(pair, device, (roll, pitch, phase), f"{centre.name} changed to {(roll, pitch, phase)}")
        state = changed.settled(found)
        if state.outcome is Outcome.SETTLED:
            found.add_checked(check(pair, device, state, 5, choose), changed.name)
