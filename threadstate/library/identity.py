"""The identity of a library: the SHA-256 of everything that its content depends on."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, fields, is_dataclass
from functools import cache, cached_property
from importlib.metadata import version
from pathlib import Path

from pydantic import TypeAdapter

import threadstate
from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid
from threadstate.library.solver_method import SolverMethod
from threadstate.mesh.options import MeshOptions
from threadstate.state.flat_base import require_flat_base
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair

STATES = (
    "_callee.py",
    "_compile.py",
    "_scratch.py",
    "errors.py",
    "units.py",
    "thread/*.py",
    "contact/*.py",
    "state/*.py",
    "statics/_cone_kernel.py",
    "statics/_effort_kernel.py",
    "statics/_family_kernel.py",
    "statics/_friction_kernel.py",
    "statics/_grasp_kernel.py",
    "statics/_last_pose_kernel.py",
    "statics/_numbers_kernel.py",
    "statics/_patch_kernel.py",
    "statics/_support_kernel.py",
    "statics/_triangle_kernel.py",
    "statics/cone_program.py",
    "statics/hold_bounds.py",
    "statics/load.py",
    "statics/numbers.py",
    "statics/rows.py",
    "statics/scene.py",
    "statics/solve.py",
    "statics/stored.py",
    "statics/touching.py",
    "statics/verdict.py",
    "statics/wrench_cone.py",
    "library/fingerprint.py",
    "library/grid.py",
    "library/rows.py",
    "stored_histories/compute.py",
)
"""The sources that decide what is stored of states, whatever the method."""
HELD = (
    "_callee.py",
    "_compile.py",
    "_scratch.py",
    "errors.py",
    "units.py",
    "thread/*.py",
    "contact/*.py",
    "state/*.py",
    "device/*.py",
)
"""The sources that decide where a held bolt rests and how it moves."""
PHYSICS = (
    *STATES,
    "history/*.py",
    "network/cells.py",
    "network/formation.py",
    "network/from_history.py",
    "network/moves.py",
    "stored_histories/model.py",
    "stored_histories/rows.py",
)
"""With those of histories, windows and falls: what is stored by the exact method."""
MESH_PHYSICS = (*STATES, "mesh/*.py")
NOT_PHYSICS = (
    *("thread/catalogue.py", "thread/profiles_svg.py", "history/heights.py"),
    *("device/compile.py", "device/document.py"),
)
"""Files of these folders that no stored row is computed by: pairs and devices, which are inputs, and what is read out
of them.
"""
COMPUTING = ("llvmlite", "numba", "numpy")
"""Libraries whose code ends in the bits, by either method."""
MESH_COMPUTING = (*COMPUTING, "scipy")
COLLISION_LIBRARY = "python-fcl"
EXACT_CODE = (PHYSICS, COMPUTING)
MESH_CODE = (MESH_PHYSICS, MESH_COMPUTING)


@dataclass(frozen=True)
class LibraryInputs:
    """All that a library's content depends on; with ``mesh`` the solver method is that of meshes, else the exact
    one.

    Raises:
        InvalidValueError: the pair's bolt has a chamfer, for whose contacts the tables have no region.
    """

    pair: Pair
    grid: Grid
    options: SolveOptions
    mesh: MeshOptions | None = None

    def __post_init__(self) -> None:
        require_flat_base(self.pair, "a stored library")

    @property
    def method(self) -> SolverMethod:
        """How states are found."""
        return SolverMethod.EXACT if self.mesh is None else SolverMethod.MESH

    @cached_property
    def pair_json(self) -> str:
        """The pair as canonical JSON."""
        return canonical_json(self.pair)

    @cached_property
    def options_json(self) -> str:
        """The options as canonical JSON, those of meshes and those that all solver methods share."""
        options = _flat(_plain(self.options, "options"))
        if self.mesh is not None:
            options |= _flat(_plain(self.mesh, "mesh")) | {COLLISION_LIBRARY: version(COLLISION_LIBRARY)}
        return _json(options)

    @property
    def code_version(self) -> str:
        """The project's version and the first 12 digits of the hash of the code that computes what is stored."""
        return version_of_code(*(EXACT_CODE if self.mesh is None else MESH_CODE))

    @cached_property
    def sha256(self) -> str:
        """SHA-256, in hexadecimal, of pair, grid, method, options and code version."""
        return inputs_sha256(self.pair_json, self.grid, self.method, self.options_json, self.code_version)


def pair_of(pair_json: str) -> Pair:
    """The pair of its canonical JSON."""
    return _adapter().validate_json(pair_json)


def options_of(options_json: str) -> SolveOptions:
    """The options that all solver methods share, of their canonical JSON."""
    stored = json.loads(options_json)
    return SolveOptions(**{field.name: stored[field.name] for field in fields(SolveOptions)})


@cache
def _adapter() -> TypeAdapter[Pair]:
    return TypeAdapter(Pair)


def inputs_sha256(pair_json: str, grid: Grid, method: SolverMethod, options_json: str, code_version: str) -> str:
    """SHA-256, in hexadecimal, of what a library's content depends on."""
    parts = (pair_json, canonical_json(grid), method, options_json, code_version)
    return hashlib.sha256(json.dumps(parts, separators=(",", ":")).encode()).hexdigest()


def canonical_json(value: object) -> str:
    """A frozen dataclass of numbers, names and such dataclasses as JSON that equal values share byte for byte.

    Keys are sorted; every number is written as the shortest decimal that gives the double back.

    Raises:
        InvalidValueError: a number is not finite or a value has no JSON form.
    """
    return _json(_plain(value, type(value).__name__))


def _json(value: object) -> str:
    return json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)


def _flat(value: object) -> dict[str, object]:
    """The numbers and names of nested objects, by their own keys alone."""
    assert isinstance(value, dict)
    flat: dict[str, object] = {}
    for name, part in value.items():
        flat |= _flat(part) if isinstance(part, dict) else {name: part}
    return flat


def _plain(value: object, name: str) -> object:
    if is_dataclass(value) and not isinstance(value, type):
        named = {field.name: (getattr(value, field.name), field.default) for field in fields(value)}
        # What may be absent, and is, is not written: a flank's own angle, say.
        return {name: _plain(one, name) for name, (one, default) in named.items() if (one, default) != (None, None)}
    if isinstance(value, bool | None):
        return value
    if isinstance(value, int | float):
        number = float(value) + 0.0
        if number - number != 0.0:
            raise InvalidValueError(name, value, "a finite number")
        return number
    if isinstance(value, str):
        return str(value)
    raise InvalidValueError(name, value, "a number, a name or a dataclass of them")


@cache
def version_of_code(patterns: tuple[str, ...], libraries: tuple[str, ...]) -> str:
    """The project's version and the first 12 digits of the hash of these sources, and of these libraries' versions."""
    # Any change of the physics makes new libraries beside the old ones without anyone having to remember a number.
    sources = physics_sha256(Path(threadstate.__file__).parent, patterns)
    versions = "".join(f"\n{name} {version(name)}" for name in libraries)
    return f"{threadstate.__version__}+{hashlib.sha256((sources + versions).encode()).hexdigest()[:12]}"


def physics_sha256(package: Path, patterns: tuple[str, ...] = PHYSICS) -> str:
    """SHA-256, in hexadecimal, of the names and sources of the physics in a folder that holds this package."""
    digest = hashlib.sha256()
    for path in sorted(path for pattern in patterns for path in package.glob(pattern)):
        name = path.relative_to(package).as_posix()
        if name not in NOT_PHYSICS:
            source = path.read_bytes()
            digest.update(f"{name} {len(source)}\n".encode())
            digest.update(source)
    return digest.hexdigest()
