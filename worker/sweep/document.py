"""The TOML file of a sweep: its schema, and the libraries that it describes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Annotated

from pydantic import Field

from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.solver_method import SolverMethod
from threadstate.mesh.options import DEFAULT_SCENE, Descent, FinalStep, MeshOptions, Scene, Tangent
from threadstate.mesh.presets import Preset
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair
from worker.pairs.document import TABLES as TABLES_OF_PAIRS
from worker.pairs.document import FileLocation, Name, Number, PairPart, Part, checked, read_toml
from worker.pairs.selection import known, pairs_of

_DEFAULTS = SolveOptions()


class GridPart(Part):
    """A grid, in degrees."""

    tilt_max: Number = 4.0
    tilt_step: Number = 1.0
    phase_step: Number = 1.0


class TolerancesPart(Part):
    """Limits and tolerances that all solver methods share."""

    turn_limit_deg: Number = _DEFAULTS.turn_limit_deg
    quasi_stable_fraction: Number = _DEFAULTS.quasi_stable_fraction
    tie_tolerance: Number = _DEFAULTS.tie_tolerance
    embedment_tolerance: Number = _DEFAULTS.embedment_tolerance


class MeshPart(Part):
    """Settings of the solver method by meshes."""

    preset: Preset = Preset.PAPER
    descent: Descent = Descent.SAFE
    final_step: FinalStep = FinalStep.ONE_MICROINCH
    tangent: Tangent = Tangent.EDGE
    scene: Scene = DEFAULT_SCENE
    checked: Annotated[bool, Field(strict=True)] = True


class MethodPart(Part):
    """A solver method and its settings."""

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

MAX_LIBRARIES = 100_000


def read_sweep(path: Path) -> tuple[LibraryInputs, ...]:
    """The inputs of the libraries of a file, in its order: each pair, of that each grid, of that each method.

    Raises:
        InvalidValueError: the file cannot be read, or something in it is not valid; the name says file and key.
    """
    location = FileLocation(f"{path}: ")
    document = checked(SweepDocument, read_toml(path), TABLES, location)
    pairs = _pairs_by_designation(document, location)
    libraries = tuple(_listed(document, pairs, location) if document.library else _crossed(document, pairs, location))
    if not libraries:
        raise location.invalid("pair", None, "one pair at least, as [[pair]]")
    if len(libraries) > MAX_LIBRARIES:
        raise InvalidValueError("libraries of the sweep", len(libraries), f"at most {MAX_LIBRARIES}")
    return tuple({one.sha256: one for one in libraries}.values())


def _pairs_by_designation(document: SweepDocument, location: FileLocation) -> dict[str, Pair]:
    """The pairs of the file by their designations."""
    pairs: dict[str, Pair] = {}
    for number, part in enumerate(document.pair, 1):
        for pair in pairs_of(part, location / f"pair[{number}]"):
            if pair.designation in pairs:
                raise (location / f"pair[{number}]").invalid("designation", pair.designation, "each designation once")
            pairs[pair.designation] = pair
    return pairs


def _crossed(document: SweepDocument, pairs: dict[str, Pair], location: FileLocation) -> Iterator[LibraryInputs]:
    grids = [_grid(one, location / f"grid[{i}]") for i, one in enumerate(document.grid or [GridPart()], 1)]
    methods = [_method(one, location / f"method[{i}]") for i, one in enumerate(document.method or [MethodPart()], 1)]
    for pair, grid, (options, mesh) in product(pairs.values(), grids, methods):
        yield LibraryInputs(pair, grid, options, mesh)


def _listed(document: SweepDocument, pairs: dict[str, Pair], location: FileLocation) -> Iterator[LibraryInputs]:
    for key in ("grid", "method"):
        if key in document.model_fields_set:
            raise location.invalid(key, "given", "within [[library]], where there is one")
    for number, part in enumerate(document.library, 1):
        of_library = location / f"library[{number}]"
        with of_library:
            pair = known(pairs, part.pair)
        options, mesh = _method(part.method, of_library / "method")
        yield LibraryInputs(pair, _grid(part.grid, of_library / "grid"), options, mesh)


def _grid(part: GridPart, location: FileLocation) -> Grid:
    with location:
        return Grid(part.tilt_max, part.tilt_step, part.phase_step)


def _method(part: MethodPart, location: FileLocation) -> tuple[SolveOptions, MeshOptions | None]:
    with location / "tolerances":
        options = SolveOptions(**dict(part.tolerances))
    if part.name is SolverMethod.MESH:
        return options, _mesh(part.mesh or MeshPart())
    if part.mesh is not None:
        raise location.invalid("mesh", "given", "of the method `mesh` alone")
    return options, None


def _mesh(part: MeshPart) -> MeshOptions:
    return MeshOptions(
        tessellation=part.preset.tessellation,
        descent=part.descent,
        final_step=part.final_step.thread_pitches,
        tangent=part.tangent,
        scene=part.scene,
        checked=part.checked,
    )
