"""The solver of cone programs as a function pointer: compiled once, not again within each kernel that calls it."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

from numba import cfunc, config, types
from numba.core import cgutils
from numba.extending import intrinsic

from threadstate._compile import kernel
from threadstate.statics._cone_kernel import Array, Integers, solve_program

Program = Callable[..., float]
"""``solve_program`` of ``_cone_kernel``, as kernels are given it."""

_IS_INTERPRETED: bool = vars(config)["DISABLE_JIT"]
_ROW, _TABLE = types.float64[::1], types.float64[:, ::1]
SIGNATURE = types.float64(_ROW, _TABLE, _ROW, types.Array(types.intp, 1, "C"), _ROW, _ROW)
"""The types of what ``solve_program`` returns and takes."""


def program_address() -> int:
    """The address at which ``solve_program`` is in this process, loaded from the cache or compiled."""
    return 0 if _IS_INTERPRETED else int(_compiled_program().address)


@lru_cache(maxsize=1)
def _compiled_program() -> Any:
    # Cached: an address is valid only while the compiled function lives.
    return cfunc(SIGNATURE, cache=True, error_model="numpy", fastmath=False)(solve_program)


@intrinsic
def _program_at(_: Any, address: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        function = cgutils.create_struct_proxy(signature.return_type)(context, builder)
        function.c_addr = builder.inttoptr(values[0], context.get_value_type(types.voidptr))
        return function._getvalue()

    return types.FunctionType(SIGNATURE)(address), code


def _interpreted(_: int) -> Program:
    return solve_program


program_at: Any = _interpreted if _IS_INTERPRETED else _program_at
"""What kernels call: the :data:`Program` at :func:`program_address`."""


@kernel()
def solve_with(program: int, c: Array, g: Array, h: Array, sizes: Integers, x: Array, z: Array) -> float:
    """As ``solve_program``, with the program at an address."""
    return float(program_at(program)(c, g, h, sizes, x, z))
