"""Paths with friction, each with the usual longest steps, a half and a quarter of them (docs/paths-checked.md)."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from studies.paths.changes import Pose
from threadstate.device import _friction_kernel as fk
from threadstate.device import _friction_step_kernel as fs
from threadstate.device.command import LONGEST_STEP_WITH_FRICTION_DEG
from threadstate.device.confirmation import LEAST_FALL, heavy_falls
from threadstate.device.contact_changes import (
    RESOLVED_WITH_FRICTION_DEG,
    Comparison,
    ContactChange,
    compare_changes,
    contact_changes,
)
from threadstate.device.friction import (
    FrictionLeg,
    FrictionPath,
    friction_events,
    point_of,
    settled_with_friction,
)
from threadstate.device.model import Outcome, SettledState, default_device
from threadstate.device.settle import device_numbers, path_with_friction, settled_rows
from threadstate.thread.catalogue import quarter_twenty_unc

Floats = NDArray[np.float64]

SEED = 2033
TILT_DEG = 4.0
FRICTIONS = (0.02, 0.05, 0.1, 0.2)
STEPS_DEG = tuple(LONGEST_STEP_WITH_FRICTION_DEG / parts for parts in (1.0, 2.0, 4.0))
ACCURACY = 2e-3
"""How far half the step may move the pose at the end, in nominal radii. A fall is given to within the longest step."""

ENDS = {
    fs.REACHED: "turned",
    fs.TORQUE_OVER: "jammed",
    fs.SLIPPED_OFF: "slipped",
    fs.TOO_DEEP: "deep",
    fs.TOO_MANY: "too many contacts",
    fs.ON_PATCH: "tips off the surface, or leaves a strip",
    fs.PATH_FULL: "out of points",
    fs.NO_MINIMUM: "a fall that does not end",
}
ENDED = {"turned", "jammed", "slipped"}
"""Ends that are an answer."""


@dataclass(frozen=True)
class Followed:
    """A path at one longest step: how it ended, its balance and its losses over push times nominal radius.

    ``falls_deg`` are the phases of falls that are compared, ``changes`` the contacts gained and lost, ``place`` the
    pose's translation at the end over the nominal radius, ``ambiguous`` whether a step had several solutions,
    ``least_loss`` the least loss by friction in a step.
    """

    end: str
    balance: float
    friction: float
    falls: float
    least_loss: float
    falls_deg: tuple[float, ...]
    changes: tuple[ContactChange, ...]
    place: tuple[float, ...]
    ambiguous: bool
    seconds: float


@dataclass(frozen=True)
class Halved:
    """A command's paths with a longest step (deg) and with half of it."""

    name: str
    step_deg: float
    whole: Followed
    half: Followed

    @property
    def is_ended(self) -> bool:
        """Whether both paths end with an answer."""
        both = (self.whole, self.half)
        return all(path.end in ENDED and not path.ambiguous for path in both)

    @property
    def changes(self) -> Comparison:
        """What both have in common of contacts gained and lost, and what each has alone: within the longest step."""
        return compare_changes(self.whole.changes, self.half.changes, self.step_deg, RESOLVED_WITH_FRICTION_DEG)

    @property
    def moved(self) -> float:
        """How far apart the ends of both paths are, in nominal radii."""
        return math.dist(self.whole.place, self.half.place)

    @property
    def moved_fall_deg(self) -> float | None:
        """How far apart the same falls of both are, in degrees; None where they have other numbers of them."""
        before, after = self.whole.falls_deg, self.half.falls_deg
        if len(before) != len(after):
            return None
        return max((abs(a - b) for a, b in zip(before, after, strict=True)), default=0.0)


@dataclass(frozen=True)
class Compared:
    """A command: how it starts and its path with each of the longest steps; no path where the bolt does not settle."""

    name: str
    starts: tuple[str, ...]
    paths: tuple[Followed | None, ...]

    def halved(self, number: int) -> Halved | None:
        """The paths with the longest step of that number and with the next one; None where one of them is missing."""
        whole, half = self.paths[number : number + 2]
        return None if whole is None or half is None else Halved(self.name, STEPS_DEG[number], whole, half)


@dataclass
class Found:
    """What was found of paths that were turned by ``turn_deg``."""

    turn_deg: float
    paths: list[Compared] = field(default_factory=list)
    frictionless: list[Pose] = field(default_factory=list)

    def add(self, compared: Compared) -> None:
        """Add a path."""
        self.paths.append(compared)


def command(number: int) -> tuple[float, float, float, float]:
    """Roll, pitch and phase (deg) and friction of the path with a number."""
    choose = np.random.default_rng([SEED, number])
    roll, pitch = choose.uniform(-TILT_DEG, TILT_DEG, 2)
    return float(roll), float(pitch), float(choose.uniform(-180.0, 180.0)), FRICTIONS[number % len(FRICTIONS)]


def done(task: tuple[int, float]) -> Compared:
    """The path with a number, turned clockwise by so many degrees, with each of the longest steps."""
    number, turn_deg = task
    roll, pitch, phase, mu = command(number)
    name = f"roll {roll:.3f}, pitch {pitch:.3f}, phase {phase:.3f}, mu {mu}"
    starts, paths = zip(*(followed((roll, pitch, phase), mu, turn_deg, step) for step in STEPS_DEG), strict=True)
    return Compared(name, starts, paths)


def followed(
    pose_deg: tuple[float, float, float], mu: float, turn_deg: float, longest_step_deg: float
) -> tuple[str, Followed | None]:
    """How a bolt settles with friction, and its path as it is turned clockwise; None where it does not settle."""
    pair = quarter_twenty_unc()
    device = default_device().in_unit(pair.unit)
    numbers = device_numbers(pair, device)
    pose = np.array(pose_deg)
    _, rows = settled_rows(pair, device, numbers, pose[None])
    began = time.process_time()
    path = path_with_friction(pair, device, numbers, pose, rows[0][0], mu, longest_step_deg=longest_step_deg)
    if not isinstance(path, FrictionPath):
        return named(path), None
    phase = math.radians(pose_deg[2])
    grown = path.follow((phase, phase), (0.0, device.push))
    state = settled_with_friction(device, pose, path, grown)
    start = named(state) + (", of several" if grown.branches else "")
    if state.outcome is not Outcome.SETTLED:
        return start, None
    leg = path.follow((phase, phase - math.radians(turn_deg)), (device.push, device.push))
    seconds = time.process_time() - began
    points = [
        point_of(row, contacts, numbers, path.command) for row, contacts in zip(leg.points, leg.contacts, strict=True)
    ]
    changes = contact_changes(friction_events(points, leg.points))
    unit = device.push * pair.nominal_diameter / 2.0
    return start, measured(leg, changes, unit, pair.nominal_diameter / 2.0, seconds)


def named(state: SettledState) -> str:
    """The outcome of a state and its flags."""
    return ", ".join([state.outcome.value, *(flag.value for flag in state.flags)])


def _falls(rows: Floats, unit: float) -> list[tuple[float, float]]:
    """The phases (deg) of falls and their losses over ``unit``."""
    fallen = rows[rows[:, fk.P_FALL] > 0.0]
    phases_deg, losses = np.degrees(fallen[:, fk.P_PHASE]), fallen[:, fk.P_FALL] / unit
    return list(zip(phases_deg.tolist(), losses.tolist(), strict=True))


def measured(leg: FrictionLeg, changes: tuple[ContactChange, ...], unit: float, r: float, seconds: float) -> Followed:
    """What a leg says of its energy, falls, changes and end; energies over ``unit``, lengths over ``r``."""
    rows = leg.points
    work = float((0.5 * (rows[1:, fk.P_TORQUE] + rows[:-1, fk.P_TORQUE]) * np.diff(rows[:, fk.P_PHASE])).sum())
    friction, falls = float(rows[:, fk.P_FRICTION].sum()), float(rows[:, fk.P_FALL].sum())
    gained = float(rows[-1, fk.P_POTENTIAL] - rows[0, fk.P_POTENTIAL])
    return Followed(
        ENDS[leg.status],
        (work - gained - friction - falls) / unit,
        friction / unit,
        falls / unit,
        float(rows[:, fk.P_FRICTION].min()) / unit,
        heavy_falls(_falls(rows, unit), LONGEST_STEP_WITH_FRICTION_DEG, LEAST_FALL),
        changes,
        tuple(float(x) for x in rows[-1, fk.P_POSE + 9 : fk.P_POSE + 12] / r),
        bool((rows[:, fk.P_SOLUTIONS] > 1.0).any()),
        seconds,
    )
