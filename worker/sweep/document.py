"""What a file of a sweep may say; which values are possible is for the domain to say."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from threadstate.library.solver_method import SolverMethod
from threadstate.mesh.options import DEFAULT_SCENE, Descent, FinalStep, Tangent
from threadstate.mesh.presets import Preset
from threadstate.mesh.scene_name import Scene
from threadstate.state.options import SolveOptions
from worker.pairs.document import TABLES as TABLES_OF_PAIRS
from worker.pairs.document import Name, Number, PairPart, Part

_DEFAULTS = SolveOptions()


class GridPart(Part):
    """A grid, in degrees."""

    tilt_max: Number = 4.0
    tilt_step: Number = 1.0
    phase_step: Number = 1.0


class TolerancesPart(Part):
    """Limits and tolerances of every method."""

    turn_limit_deg: Number = _DEFAULTS.turn_limit_deg
    quasi_stable_fraction: Number = _DEFAULTS.quasi_stable_fraction
    tie_tolerance: Number = _DEFAULTS.tie_tolerance
    embedment_tolerance: Number = _DEFAULTS.embedment_tolerance


class MeshPart(Part):
    """Settings of the method by meshes."""

    preset: Preset = Preset.PAPER
    descent: Descent = Descent.SAFE
    final_step: FinalStep = FinalStep.ONE_MICROINCH
    tangent: Tangent = Tangent.EDGE
    scene: Scene = DEFAULT_SCENE
    checked: Annotated[bool, Field(strict=True)] = True


class MethodPart(Part):
    """A method."""

    name: SolverMethod = SolverMethod.EXACT
    tolerances: TolerancesPart = TolerancesPart()
    mesh: MeshPart | None = None


class LibraryPart(Part):
    """One library of a list: a pair of the file or a known one, by its designation."""

    pair: Name
    grid: GridPart = GridPart()
    method: MethodPart = MethodPart()


class SweepDocument(Part):
    """The file: every pair over every grid by every method, or a list of libraries."""

    pair: list[PairPart] = Field(default_factory=list)
    grid: list[GridPart] = Field(default_factory=list)
    method: list[MethodPart] = Field(default_factory=list)
    library: list[LibraryPart] = Field(default_factory=list)


TABLES: dict[str, type[Part]] = {
    **TABLES_OF_PAIRS,
    "grid": GridPart,
    "method": MethodPart,
    "tolerances": TolerancesPart,
    "mesh": MeshPart,
    "library": LibraryPart,
}
"""The tables by the key that they stand under."""
