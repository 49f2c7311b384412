"""The search of a stage as a function pointer: compiled once, not again within each kernel that calls it."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

from numba import cfunc, config, types
from numba.core import cgutils
from numba.extending import intrinsic

from threadstate.contact._stage_kernel import earliest

Search = Callable[..., tuple[int, int, float]]
"""``earliest`` of ``_stage_kernel``, as kernels are given it."""

_IS_INTERPRETED: bool = vars(config)["DISABLE_JIT"]
_FLOAT, _INT = types.float64, types.int64
_ROW, _TABLE = _FLOAT[::1], _FLOAT[:, ::1]
_PROFILE = types.Array(_FLOAT, 1, "C", readonly=True)
_WORK = types.Tuple((_ROW, _ROW, _TABLE, _TABLE, _ROW, _ROW, _TABLE, _TABLE, _TABLE))
_RETURNED = types.Tuple((_INT, _INT, _FLOAT))
_STAGE = (_ROW, types.boolean, _ROW, _ROW, _TABLE, _INT, _FLOAT, _FLOAT, _PROFILE, _PROFILE, _INT, _WORK, _TABLE)
SIGNATURE = _RETURNED(*_STAGE)
"""The types of what ``earliest`` returns and takes."""


def search_address() -> int:
    """The address at which ``earliest`` is in this process, loaded from the cache or compiled."""
    return 0 if _IS_INTERPRETED else int(_compiled_search().address)


@lru_cache(maxsize=1)
def _compiled_search() -> Any:
    # Cached: an address is valid only while the compiled function lives.
    return cfunc(SIGNATURE, cache=True, error_model="numpy", fastmath=False)(earliest)


@intrinsic
def _search_at(_: Any, address: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        function = cgutils.create_struct_proxy(signature.return_type)(context, builder)
        function.c_addr = builder.inttoptr(values[0], context.get_value_type(types.voidptr))
        return function._getvalue()

    return types.FunctionType(SIGNATURE)(address), code


def _interpreted(_: int) -> Search:
    return earliest


search_at: Any = _interpreted if _IS_INTERPRETED else _search_at
"""What kernels call: the :data:`Search` at :func:`search_address`."""
