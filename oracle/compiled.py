"""Compilation of the oracle's loops, cached on disk beside the kernels under the hash of all the oracle's sources.

numba checks a function's own file alone; with the hash an edit of one file leaves no stale cache of another.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import ParamSpec, TypeVar, cast
from unittest.mock import patch

from numba import config, njit

import threadstate

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")

assert threadstate  # its import sets NUMBA_CACHE_DIR, by the kernels' sources


def _sources_hash() -> str:
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


CACHE = str(Path(os.environ["NUMBA_CACHE_DIR"]) / f"oracle-{_sources_hash()}")


def compiled(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """The function, compiled by numba at its first call ever."""
    with patch.object(config, "CACHE_DIR", CACHE):
        return cast("Callable[Arguments, Result]", njit(cache=True)(function))
