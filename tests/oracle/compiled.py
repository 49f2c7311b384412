"""Compilation of the oracle's loops; never cached on disk, so that an edit of one file leaves no other one stale."""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec, TypeVar, cast

from numba import njit

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def compiled(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """The function, compiled by numba at its first call."""
    return cast("Callable[Arguments, Result]", njit(function))
