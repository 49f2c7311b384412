"""All methods behind one protocol: cases in, for each a contact state or a refusal with its reason out.

A case is a pose of a pair, under options. The methods are the exact one and the collision of meshes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from itertools import groupby
from typing import Protocol

from threadstate.errors import MeshUndecidedError, UnresolvedPoseError
from threadstate.mesh.options import Descent, FinalStep, MeshOptions
from threadstate.mesh.presets import Preset
from threadstate.mesh.solve import mesh_procedure, solve_poses_by_mesh
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_poses
from threadstate.thread.fit import Fit
from threadstate.thread.pair import Pair

FIT_DIAMETERS = tuple(field.name for field in fields(Fit) if field.name != "name")
"""The six diameters of a fit."""

USUAL = SolveOptions()

PoseDeg = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Case:
    """A pose (roll, pitch, phase in degrees) of a pair, and what the user chose.

    ``scale`` is how many times as large the pair is as the 1/4-20 UNC from which it was scaled.
    """

    pair: Pair
    pose_deg: PoseDeg
    options: SolveOptions = USUAL
    scale: float = 1.0

    @property
    def tilt(self) -> float:
        """The angle between the axes of bolt and nut, in rad."""
        roll, pitch, _ = (math.radians(angle) for angle in self.pose_deg)
        return math.hypot(math.sin(pitch), math.sin(roll) * math.cos(pitch))

    @property
    def reach(self) -> float:
        """No point of the bolt is farther from its origin; in the pair's unit."""
        return math.hypot(self.pair.fit.bolt_major_diameter / 2.0, self.pair.thread_pitch)


def moved(one: Case, other: Case) -> float:
    """How far the inputs of two cases are apart, in the pair's unit.

    The turn between two poses, no more than the sum of the angles' changes, times the bolt's reach; and the changes of
    the radii and of the thread pitch, all added. Whole turns of phase do not count.
    """
    (roll, pitch, phase), (roll_too, pitch_too, phase_too) = one.pose_deg, other.pose_deg
    turned = abs(roll - roll_too) + abs(pitch - pitch_too)
    turned += abs(math.remainder(math.remainder(phase, 360.0) - math.remainder(phase_too, 360.0), 360.0))
    far = math.radians(turned) * one.reach
    if one.pair is other.pair:
        return far
    radii = sum(abs(getattr(one.pair.fit, name) - getattr(other.pair.fit, name)) / 2.0 for name in FIT_DIAMETERS)
    return float(far + radii + abs(one.pair.thread_pitch - other.pair.thread_pitch))


def between(one: Case, other: Case) -> Case:
    """The case half-way between two; its pair is ``one``'s where both have the same."""
    roll, pitch, phase = (0.5 * (a + b) for a, b in zip(one.pose_deg, other.pose_deg, strict=True))
    if one.pair is other.pair:
        return replace(one, pose_deg=(roll, pitch, phase))
    a, b = one.pair, other.pair
    diameters = {name: 0.5 * (getattr(a.fit, name) + getattr(b.fit, name)) for name in FIT_DIAMETERS}
    pair = replace(a, fit=replace(a.fit, **diameters), thread_pitch=0.5 * (a.thread_pitch + b.thread_pitch))
    return replace(one, pair=pair, pose_deg=(roll, pitch, phase))


def same_input(one: Case, other: Case) -> bool:
    """Whether two cases differ in nothing that :func:`between` changes."""
    return one.pose_deg == other.pose_deg and (one.pair is other.pair or one.pair == other.pair)


def with_dimensions(pair: Pair, changes: tuple[float, ...]) -> Pair:
    """The pair with its six diameters and its thread pitch changed by lengths in its unit."""
    diameters = {
        name: getattr(pair.fit, name) + change for name, change in zip(FIT_DIAMETERS, changes[:6], strict=True)
    }
    return replace(pair, fit=replace(pair.fit, **diameters), thread_pitch=pair.thread_pitch + changes[6])


def scaled(pair: Pair, factor: float) -> Pair:
    """The pair with every length multiplied."""
    diameters = {name: factor * getattr(pair.fit, name) for name in FIT_DIAMETERS}
    return replace(
        pair,
        nominal_diameter=factor * pair.nominal_diameter,
        thread_pitch=factor * pair.thread_pitch,
        fit=replace(pair.fit, **diameters),
    )


@dataclass(frozen=True, slots=True)
class Refusal:
    """A method says that it cannot answer, and why."""

    reason: str


Answer = ContactState | Refusal


class Method(Protocol):
    """Anything that answers cases; it must be picklable, and the same case must have the same answer."""

    @property
    def name(self) -> str:
        """What it is called on the page."""

    def declared_error(self, pair: Pair) -> float:
        """How far its contacts may be off the surfaces and its heights off the true ones, in the pair's unit."""

    def answers(self, cases: Sequence[Case]) -> list[Answer]:
        """The answers in the order of the cases."""


BATCH = 32
DECLARED_PITCHES = 2e-8


@dataclass(frozen=True)
class ExactMethod:
    """Contacts from edge curves, closed by bounds (decision 1)."""

    name: str = "exact"

    def declared_error(self, pair: Pair) -> float:
        """1e-9 in on a 1/4-20."""
        return DECLARED_PITCHES * pair.thread_pitch

    def answers(self, cases: Sequence[Case]) -> list[Answer]:
        """The answers in the order of the cases; neighbours of one pair are solved together."""
        found: list[Answer] = []
        for _, group in groupby(cases, key=lambda case: (id(case.pair), case.options)):
            together = list(group)
            for start in range(0, len(together), BATCH):
                found += _batch(together[start : start + BATCH])
        return found


def _batch(cases: list[Case]) -> list[Answer]:
    try:
        return [*solve_poses(cases[0].pair, [case.pose_deg for case in cases], cases[0].options)]
    except UnresolvedPoseError as error:
        if len(cases) == 1:
            return [Refusal(str(error).rpartition("deg: ")[2])]
        return [answer for case in cases for answer in _batch([case])]


@dataclass(frozen=True)
class MeshStates:
    """States by meshes of a preset, stepped to a final step in thread pitches (decision 4).

    A safe descent is checked by a second tessellation; decades are not, as the paper has no such check.
    """

    preset: Preset
    descent: Descent
    final_step: float = FinalStep.ONE_MICROINCH.thread_pitches

    @property
    def name(self) -> str:
        """What it is called on the page."""
        return f"mesh {self.descent}, {self.preset}"

    @property
    def options(self) -> MeshOptions:
        """Its settings."""
        checked = self.descent is Descent.SAFE
        return MeshOptions(self.preset.tessellation, self.descent, self.final_step, checked=checked)

    def declared_error(self, pair: Pair) -> float:
        """How far both meshes' edges are off the true ones, and the final step."""
        return mesh_procedure(pair, self.options).edge_deviation + self.final_step * pair.thread_pitch

    def answers(self, cases: Sequence[Case]) -> list[Answer]:
        """The answers in the order of the cases."""
        return [self._answer(case) for case in cases]

    def _answer(self, case: Case) -> Answer:
        try:
            return solve_poses_by_mesh(case.pair, [case.pose_deg], self.options, case.options)[0]
        except MeshUndecidedError as error:
            return Refusal(error.reason)
