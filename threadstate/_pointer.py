"""Kernels as function pointers: compiled once, not again within each kernel that calls them.

A kernel that calls one takes its address as an argument, since an address that is compiled in could not be cached.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

from numba import cfunc, config, types
from numba.core import cgutils
from numba.extending import intrinsic

_IS_INTERPRETED: bool = vars(config)["DISABLE_JIT"]


class Pointer:
    """A plain function of kernels with the types of what it returns and takes.

    ``at`` is what kernels call: with an address it gives the function there.
    """

    def __init__(self, function: Callable[..., Any], signature: Any) -> None:
        self._function = function
        self._signature = signature
        self.at: Any = self._interpreted if _IS_INTERPRETED else self._intrinsic()

    @property
    def address(self) -> int:
        """The address at which the kernel is in this process, loaded from the cache or compiled."""
        return 0 if _IS_INTERPRETED else int(self._compiled.address)

    @cached_property
    def _compiled(self) -> Any:
        # Kept: an address is valid only while the compiled function lives.
        return cfunc(self._signature, cache=True, error_model="numpy", fastmath=False)(self._function)

    def _interpreted(self, _: int) -> Callable[..., Any]:
        return self._function

    def _intrinsic(self) -> Any:
        of_function = types.FunctionType(self._signature)

        @intrinsic
        def at(_: Any, address: Any) -> Any:
            def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
                function = cgutils.create_struct_proxy(signature.return_type)(context, builder)
                function.c_addr = builder.inttoptr(values[0], context.get_value_type(types.voidptr))
                return function._getvalue()

            return of_function(address), code

        return at
