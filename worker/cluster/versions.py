"""The versions of code and libraries on which a chunk's bits depend besides its inputs."""

from __future__ import annotations

import platform
from dataclasses import dataclass, fields
from functools import cache
from importlib.metadata import version
from pathlib import Path

import threadstate
import worker
from threadstate.library.identity import physics_sha256

EVERY_SOURCE = ("**/*.py",)
OF_WORKER = ("compute.py",)
SHOWN_DIGITS = 12


@dataclass(frozen=True)
class Versions:
    """The versions of a process that computes.

    ``code`` is the version and a hash of all sources of ``threadstate``, and of what calls them here: more than a
    library's code version, which covers what its rows are computed by alone.
    """

    code: str
    python: str
    numpy: str
    scipy: str
    numba: str
    llvmlite: str

    def differences(self, other: Versions) -> str:
        """The differences, as "name ours here, theirs there"; empty if there are none."""
        sides = ((field.name, getattr(self, field.name), getattr(other, field.name, "none")) for field in fields(self))
        return "; ".join(f"{name} {ours} here, {theirs} there" for name, ours, theirs in sides if ours != theirs)


@cache
def own_versions() -> Versions:
    """The versions of this process."""
    packages = Path(threadstate.__file__).parent, Path(worker.__file__).parent
    hashes = (
        physics_sha256(package, patterns)[:SHOWN_DIGITS]
        for package, patterns in zip(packages, (EVERY_SOURCE, OF_WORKER), strict=True)
    )
    return Versions(
        "+".join((threadstate.__version__, *hashes)),
        ".".join(platform.python_version_tuple()[:2]),
        *(version(name) for name in ("numpy", "scipy", "numba", "llvmlite")),
    )
