"""What makes a library this very library: the SHA-256 of everything that its content depends on."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, fields, is_dataclass
from functools import cache, cached_property
from pathlib import Path

import threadstate
from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair

METHOD = "exact"
"""The method by which states are found: closed-form kernels, no mesh."""

PHYSICS = ("thread/*.py", "contact/*.py", "state/*.py")
NOT_PHYSICS = ("state/document.py",)


@dataclass(frozen=True)
class LibraryInputs:
    """All that a library's content depends on."""

    pair: Pair
    grid: Grid
    options: SolveOptions

    @cached_property
    def pair_json(self) -> str:
        """The pair as canonical JSON."""
        return canonical_json(self.pair)

    @cached_property
    def options_json(self) -> str:
        """The options as canonical JSON."""
        return canonical_json(self.options)

    @cached_property
    def sha256(self) -> str:
        """SHA-256, in hexadecimal, of pair, grid, method, options and code version."""
        parts = (self.pair_json, canonical_json(self.grid), METHOD, self.options_json, code_version())
        return hashlib.sha256(json.dumps(parts, separators=(",", ":")).encode()).hexdigest()


def canonical_json(value: object) -> str:
    """A frozen dataclass of numbers, names and such dataclasses as JSON that equal values share byte for byte.

    Keys are sorted; every number is written as the shortest decimal that gives the double back.

    Raises:
        InvalidValueError: a number is not finite or a value has no JSON form.
    """
    return json.dumps(_plain(value, type(value).__name__), sort_keys=True, separators=(",", ":"), allow_nan=False)


def _plain(value: object, name: str) -> object:
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: _plain(getattr(value, field.name), field.name) for field in fields(value)}
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
def code_version() -> str:
    """The project's version and the first 12 digits of :func:`physics_sha256` of the code that runs.

    Any change of the physics makes new libraries beside the old ones without anyone having to remember a number.
    """
    return f"{threadstate.__version__}+{physics_sha256(Path(threadstate.__file__).parent)[:12]}"


def physics_sha256(package: Path) -> str:
    """SHA-256, in hexadecimal, of the names and sources of the physics in a folder that holds this package."""
    digest = hashlib.sha256()
    for path in sorted(path for pattern in PHYSICS for path in package.glob(pattern)):
        name = path.relative_to(package).as_posix()
        if name not in NOT_PHYSICS:
            source = path.read_bytes()
            digest.update(f"{name} {len(source)}\n".encode())
            digest.update(source)
    return digest.hexdigest()
