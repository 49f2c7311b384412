"""How kernels are compiled (docs/decisions/0018-kernel-compilation.md, 0064-callees-are-linked.md).

Every kernel says all that decides its machine code: numba lets a callee inherit what it leaves open from the caller
that is compiled first, so that the same sources would give other bits in a process that begins elsewhere.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

from numba import njit, typeof
from numba.np import linalg

from threadstate._callee import CALLEE, ENTRY, EntryCache, let_kernels_call

_njit: Any = njit
"""Its type does not know ``no_cfunc_wrapper``."""
_entry_cache: Any = EntryCache
"""Numba's caches have no types."""


def _import_without_linear_algebra() -> None:
    """Import numba's functions of arrays without the library of linear algebra that it looks for meanwhile.

    That takes a sixth of a second of each start, and no kernel uses it. What others compile may: it is looked for then.
    """
    ensure_blas: Any = linalg.ensure_blas

    def none_yet() -> None:
        raise ImportError

    of_numba: Any = linalg
    of_numba.ensure_blas = none_yet
    try:
        arraymath: Any = import_module("numba.np.arraymath")
    finally:
        of_numba.ensure_blas = ensure_blas
    arraymath.ensure_blas = ensure_blas
    arraymath._HAVE_BLAS = find_spec("scipy") is not None


_import_without_linear_algebra()


def kernel(
    *, contract: bool = False, allocates: bool = False, **options: object
) -> Callable[[Callable[..., Any]], Any]:
    """A decorator for kernels: compiled when Python first calls them, with all that they call, and cached on disk.

    Args:
        contract: whether a product and a sum may be rounded once. For bounds and brackets, never for a result.
        allocates: whether it makes or returns arrays, or is handed them by what it calls. One that works on those of
            its caller alone does not count references to them, which took an eighth of the time of a pose.
        options: further options of ``numba.njit``.
    """

    def compiled(function: Callable[..., Any]) -> Any:
        setattr(function, "__signature__", inspect.signature(function))  # noqa: B010 - numba asks for it four times
        how = {
            "error_model": "numpy",
            "fastmath": {"contract"} if contract else False,
            "no_cfunc_wrapper": True,
            "_nrt": allocates,
            **options,
        }
        entry = _njit(pipeline_class=ENTRY, **how)(function)
        entry._cache = _entry_cache(function)
        let_kernels_call(entry, lambda: _njit(pipeline_class=CALLEE, no_cpython_wrapper=True, **how)(function))
        return entry

    return compiled


class Ahead(NamedTuple):
    """A kernel that Python calls, to be compiled before it does, and the types of its arguments."""

    kernel: Any
    types: tuple[Any, ...]


def ahead(function: Any, *arguments: object) -> Ahead:
    """A kernel to be compiled for arguments of these types."""
    return Ahead(function, tuple(map(typeof, arguments)))


def is_cached(function: Any) -> bool:
    """Whether the cache contains a kernel that Python calls."""
    module = function.py_func.__module__.rpartition(".")[2]
    return any(Path(str(function.stats.cache_path)).glob(f"{module}.{function.__name__}-*.nbc"))
