"""A sweep from its file."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from pathlib import Path

from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.solver_method import SolverMethod
from threadstate.mesh.options import MeshOptions
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair
from worker.pairs.build import known, pairs_of
from worker.pairs.place import Place
from worker.pairs.toml import checked, read_toml
from worker.sweep.document import TABLES, GridPart, MeshPart, MethodPart, SweepDocument

MOST_LIBRARIES = 100_000


def read_sweep(path: Path) -> tuple[LibraryInputs, ...]:
    """The inputs of the libraries of a file, in its order: each pair, of that each grid, of that each method.

    Raises:
        InvalidValueError: the file cannot be read, or something in it is not valid; the name says file and key.
    """
    place = Place(f"{path}: ")
    document = checked(SweepDocument, read_toml(path), TABLES, place)
    pairs = _pairs(document, place)
    libraries = tuple(_listed(document, pairs, place) if document.library else _crossed(document, pairs, place))
    if not libraries:
        raise place.invalid("pair", None, "one pair at least, as [[pair]]")
    if len(libraries) > MOST_LIBRARIES:
        raise InvalidValueError("libraries of the sweep", len(libraries), f"at most {MOST_LIBRARIES}")
    return tuple({one.sha256: one for one in libraries}.values())


def _pairs(document: SweepDocument, place: Place) -> dict[str, Pair]:
    """The pairs of the file by their designations."""
    pairs: dict[str, Pair] = {}
    for number, part in enumerate(document.pair, 1):
        for pair in pairs_of(part, place / f"pair[{number}]"):
            if pair.designation in pairs:
                raise (place / f"pair[{number}]").invalid("designation", pair.designation, "each designation once")
            pairs[pair.designation] = pair
    return pairs


def _crossed(document: SweepDocument, pairs: dict[str, Pair], place: Place) -> Iterator[LibraryInputs]:
    grids = [_grid(one, place / f"grid[{i}]") for i, one in enumerate(document.grid or [GridPart()], 1)]
    methods = [_method(one, place / f"method[{i}]") for i, one in enumerate(document.method or [MethodPart()], 1)]
    for pair, grid, (options, mesh) in product(pairs.values(), grids, methods):
        yield LibraryInputs(pair, grid, options, mesh)


def _listed(document: SweepDocument, pairs: dict[str, Pair], place: Place) -> Iterator[LibraryInputs]:
    for key in ("grid", "method"):
        if key in document.model_fields_set:
            raise place.invalid(key, "given", "within [[library]], where there is one")
    for number, part in enumerate(document.library, 1):
        of_library = place / f"library[{number}]"
        with of_library:
            pair = known(pairs, part.pair)
        options, mesh = _method(part.method, of_library / "method")
        yield LibraryInputs(pair, _grid(part.grid, of_library / "grid"), options, mesh)


def _grid(part: GridPart, place: Place) -> Grid:
    with place:
        return Grid(part.tilt_max, part.tilt_step, part.phase_step)


def _method(part: MethodPart, place: Place) -> tuple[SolveOptions, MeshOptions | None]:
    with place / "tolerances":
        options = SolveOptions(**dict(part.tolerances))
    if part.name is SolverMethod.MESH:
        return options, _mesh(part.mesh or MeshPart())
    if part.mesh is not None:
        raise place.invalid("mesh", "given", "of the method `mesh` alone")
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
