"""What a file of a sweep may say; which values are possible is for the domain to say."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from threadstate.library.method import Method
from threadstate.mesh.options import DEFAULT_SCENE, Descent, FinalStep, Tangent
from threadstate.mesh.presets import Preset
from threadstate.mesh.scene_name import Scene
from threadstate.state.options import SolveOptions
from threadstate.units import LengthUnit

LARGEST_DESIGNATION = 100

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1, max_length=LARGEST_DESIGNATION)]
_DEFAULTS = SolveOptions()


class Part(BaseModel):
    """A table of the file, which may hold the keys below and no others."""

    model_config = ConfigDict(extra="forbid")

    def given(self) -> dict[str, Any]:
        """The values that the file gives."""
        return {name: getattr(self, name) for name in self.model_fields_set}


class FormPart(Part):
    """A thread form; fillets in multiples of the thread pitch."""

    name: Name | None = None
    flank_half_angle_deg: Number | None = None
    bolt_root_fillet: Number | None = None
    bolt_crest_fillet: Number | None = None
    nut_root_fillet: Number | None = None
    nut_crest_fillet: Number | None = None


class FitPart(Part):
    """A fit, in the pair's unit."""

    name: Name | None = None
    bolt_major_diameter: Number | None = None
    bolt_pitch_diameter: Number | None = None
    bolt_minor_diameter: Number | None = None
    nut_major_diameter: Number | None = None
    nut_pitch_diameter: Number | None = None
    nut_minor_diameter: Number | None = None


class PairPart(Part):
    """A pair: a known one by its designation, or one's own by its dimensions, which ``like`` may give in part."""

    designation: Name
    like: str | None = None
    unit: LengthUnit | None = None
    nominal_diameter: Number | None = None
    thread_pitch: Number | None = None
    form: FormPart | None = None
    fit: FitPart | None = None
    fits: Annotated[list[FitPart], Field(min_length=1)] | None = None


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

    name: Method = Method.EXACT
    tolerances: TolerancesPart = TolerancesPart()
    mesh: MeshPart | None = None


class LibraryPart(Part):
    """One library of a list: a pair of the file or a known one, by its designation."""

    pair: Name
    grid: GridPart = GridPart()
    method: MethodPart = MethodPart()


class SweepDocument(Part):
    """The file: every pair over every grid by every method, or a list of libraries."""

    pair: list[PairPart] = []
    grid: list[GridPart] = []
    method: list[MethodPart] = []
    library: list[LibraryPart] = []


TABLES: dict[str, type[Part]] = {
    "pair": PairPart,
    "form": FormPart,
    "fit": FitPart,
    "fits": FitPart,
    "grid": GridPart,
    "method": MethodPart,
    "tolerances": TolerancesPart,
    "mesh": MeshPart,
    "library": LibraryPart,
}
"""The tables by the key that they stand under."""
