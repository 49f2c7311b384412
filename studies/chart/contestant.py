"""What is measured: methods with their settings, grouped in series, and how much of each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum

from threadstate.mesh.options import Descent, MeshOptions, Scene
from threadstate.mesh.presets import Preset
from threadstate.state.options import SolveOptions

TURN_LIMIT_DEG = 10.0
"""Where a turn ends without a contact, in this study.

Hardly any second and one third contact in thirty come later; on the way to 45 deg a mesh takes seconds to find nothing.
"""


@dataclass(frozen=True)
class Scale:
    """Poses that every contestant solves, that the finest mesh is compared on, and that are extrapolated; and presets.

    ``bracketings`` are numbers of boxes of azimuth that the exact search begins with, beside its own; ``chords`` the
    chord heights (thread pitches) that heights are extrapolated from.
    """

    poses: int
    compared: int
    extrapolated: int
    presets: tuple[Preset, ...]
    bracketings: tuple[int, ...]
    chords: tuple[float, ...]


FULL = Scale(
    poses=30,
    compared=100,
    extrapolated=20,
    presets=tuple(Preset),
    bracketings=(16, 64),
    chords=tuple(4e-4 * 0.66**k for k in range(8)),
)


MICROINCH = 2e-5
"""A microinch on the paper's thread, in thread pitches."""
FINAL_STEPS = (10.0, 1.0, 0.1)
"""Final steps in microinches."""
ONE_MICROINCH = ", 1 uin"
"""How the label of one whose final step is a microinch ends."""
COAL_PRESETS = 4
"""How many of the presets, from the coarsest, coal is given, too: it takes twice the time."""
TIE_TOLERANCES = (1e-13, 1e-8, 1e-6)
"""Tolerances of a tie, in thread pitches, beside the default."""


class Series(StrEnum):
    """A line of the chart."""

    EXACT = "exact method"
    EDGES = "meshes fine along the edges"
    FULL = "full solids"
    BAND = "band without walls"
    CURVES = "two edge curves, no mesh"
    DECADES = "decade descent"
    COAL = "coal in place of fcl"


class Engine(StrEnum):
    """The collision library."""

    FCL = "fcl"
    COAL = "coal"


@dataclass(frozen=True)
class ByMesh:
    """The mesh method."""

    options: MeshOptions
    engine: Engine = Engine.FCL


@dataclass(frozen=True)
class Exactly:
    """The exact method; ``boxes`` is how many boxes of azimuth an edge is begun with, None as it is built."""

    boxes: int | None = None
    proved: bool = False


@dataclass(frozen=True)
class Contestant:
    """A method with its settings; ``label`` distinguishes it within its series."""

    series: Series
    label: str
    way: ByMesh | Exactly
    options: SolveOptions


LIMITED = SolveOptions(turn_limit_deg=TURN_LIMIT_DEG)
DEFAULT = Contestant(Series.EXACT, "as built", Exactly(), LIMITED)


def contestants(scale: Scale) -> list[Contestant]:
    """All of them, series by series, from coarse to fine."""
    found = [DEFAULT, replace(DEFAULT, label="threads by rectangles", way=Exactly(proved=True))]
    found += [replace(DEFAULT, label=f"{boxes} boxes", way=Exactly(boxes)) for boxes in scale.bracketings]
    found += [
        replace(DEFAULT, label=f"tie {tolerance:g} p", options=replace(LIMITED, tie_tolerance=tolerance))
        for tolerance in TIE_TOLERANCES
    ]
    for series, scene in ((Series.EDGES, Scene.EDGES), (Series.CURVES, Scene.CURVES)):
        found += [_by_mesh(series, scene, preset, step) for preset in scale.presets for step in FINAL_STEPS]
    for series, scene in ((Series.FULL, Scene.FULL), (Series.BAND, Scene.BAND)):
        found += [_by_mesh(series, scene, preset, 1.0) for preset in scale.presets]
    for preset in scale.presets:
        tenth = _by_mesh(Series.DECADES, Scene.EDGES, preset, 1.0)
        assert isinstance(tenth.way, ByMesh)
        found.append(
            replace(tenth, way=replace(tenth.way, options=replace(tenth.way.options, descent=Descent.DECADES)))
        )
    for preset in scale.presets[:COAL_PRESETS]:
        other = _by_mesh(Series.COAL, Scene.EDGES, preset, 1.0)
        assert isinstance(other.way, ByMesh)
        found.append(replace(other, way=replace(other.way, engine=Engine.COAL)))
    return found


def _by_mesh(series: Series, scene: Scene, preset: Preset, microinches: float) -> Contestant:
    options = MeshOptions(preset.tessellation, final_step=microinches * MICROINCH, scene=scene)
    return Contestant(series, f"{preset.value}, {microinches:g} uin", ByMesh(options), LIMITED)
