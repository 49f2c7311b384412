"""Paths without friction, each with the usual longest steps, a half and a quarter of them: the contacts they change."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath, PathEventKind
from threadstate.device.command import LONGEST_STEP_DEG
from threadstate.device.confirmation import LEAST_FALL, have_same_falls
from threadstate.device.contact_changes import WITHIN_DEG, Comparison, compare_changes, contact_changes
from threadstate.device.model import SettledFlag, default_device
from threadstate.thread.catalogue import quarter_twenty_unc

SEED = 2056
TILT_DEG = 4.0
STEPS_DEG = tuple(LONGEST_STEP_DEG / parts for parts in (1.0, 2.0, 4.0))


@dataclass(frozen=True)
class Turned:
    """A path at one longest step: its outcome, whether a flag says that it hangs on the steps, and how often it was
    bridged.
    """

    outcome: AssemblyOutcome
    is_flagged: bool
    bridged: int


@dataclass(frozen=True)
class Halves:
    """A path with a longest step and with half of it: how their changes compare, and whether their falls are alike."""

    changes: Comparison
    same_falls: bool


@dataclass(frozen=True)
class Pose:
    """A command, its path with each longest step, and what each step and its half have in common."""

    name: str
    turned: tuple[Turned, ...]
    halves: tuple[Halves, ...]

    def is_decided(self, number: int) -> bool:
        """Whether the paths with the longest step of that number and with the next one have an outcome."""
        return all(path.outcome is not AssemblyOutcome.UNDECIDED for path in self.turned[number : number + 2])


def pose_deg(number: int) -> tuple[float, float, float]:
    """Roll, pitch and phase (deg) of the path with a number."""
    choose = np.random.default_rng([SEED, number])
    roll, pitch = choose.uniform(-TILT_DEG, TILT_DEG, 2)
    return float(roll), float(pitch), float(choose.uniform(0.0, 360.0))


def turned(number: int) -> Pose:
    """The path with a number, with each of the longest steps."""
    roll, pitch, phase = pose_deg(number)
    pair = quarter_twenty_unc()
    device = default_device().in_unit(pair.unit)
    least = LEAST_FALL * device.push * pair.nominal_diameter / 2.0
    paths = [assemble_pose(pair, roll, pitch, phase, device, longest_step=step) for step in STEPS_DEG]
    halves = [
        Halves(
            compare_changes(contact_changes(path.events), contact_changes(half.events), WITHIN_DEG),
            have_same_falls(path, half, step, least),
        )
        for path, half, step in zip(paths, paths[1:], STEPS_DEG, strict=False)
    ]
    return Pose(f"roll {roll:.3f}, pitch {pitch:.3f}, phase {phase:.3f}", tuple(map(_turned, paths)), tuple(halves))


def _turned(path: AssemblyPath) -> Turned:
    bridged = sum(event.kind is PathEventKind.BRIDGED for event in path.events)
    return Turned(path.outcome, SettledFlag.STEP_DEPENDENT in path.flags, bridged)
