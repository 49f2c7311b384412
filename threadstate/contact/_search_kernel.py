"""The search of a stage as a function pointer."""

from __future__ import annotations

from collections.abc import Callable

from numba import types

from threadstate._pointer import Pointer
from threadstate.contact._stage_kernel import Work, earliest

Search = Callable[..., tuple[int, int, float]]
"""``earliest`` of ``_stage_kernel``, as kernels are given it."""

_FLOAT, _INT = types.float64, types.int64
_ROW, _TABLE = _FLOAT[::1], _FLOAT[:, ::1]
_PROFILE = types.Array(_FLOAT, 1, "C", readonly=True)
_WORK = types.NamedTuple((_ROW, _ROW, *4 * (_TABLE,), _ROW, _ROW, *3 * (_TABLE,)), Work)
_RETURNED = types.Tuple((_INT, _INT, _FLOAT))
_STAGE = (
    _ROW,
    types.boolean,
    _ROW,
    _ROW,
    _TABLE,
    _TABLE,
    _INT,
    _FLOAT,
    _FLOAT,
    _PROFILE,
    _PROFILE,
    _INT,
    types.boolean,
    _WORK,
    _TABLE,
)

SEARCH = Pointer(earliest, _RETURNED(*_STAGE))
search_at = SEARCH.at


def search_address() -> int:
    """The address of the search in this process."""
    return SEARCH.address
