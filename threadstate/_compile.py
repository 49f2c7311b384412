"""How kernels are compiled (docs/decisions/0018-kernel-compilation.md).

Every kernel says all that decides its machine code: numba lets a callee inherit what it leaves open from the caller
that is compiled first, so that the same sources would give other bits in a process that begins elsewhere.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import njit, types

_njit: Any = njit
"""Its type does not know ``no_cfunc_wrapper``."""


def kernel(
    *, contract: bool = False, allocates: bool = False, **options: object
) -> Callable[[Callable[..., Any]], Any]:
    """A decorator for kernels: compiled when first called, and cached on disk.

    Args:
        contract: whether a product and a sum may be rounded once. For bounds and brackets, never for a result.
        allocates: whether it makes or returns arrays, or is handed them by what it calls. One that works on those of
            its caller alone does not count references to them, which took an eighth of the time of a pose.
        options: further options of ``numba.njit``.
    """

    def compiled(function: Callable[..., Any]) -> Any:
        fastmath = {"contract"} if contract else False
        decorate = _njit(
            cache=True, error_model="numpy", fastmath=fastmath, no_cfunc_wrapper=True, _nrt=allocates, **options
        )
        return _without_literals(decorate(function))

    return compiled


def _without_literals(dispatcher: Any) -> Any:
    """Let calls with constants share the one specialisation: numba makes another for every constant of a caller."""
    template = dispatcher.get_call_template

    def get_call_template(args: tuple[Any, ...], kws: dict[str, Any]) -> Any:
        return template(tuple(map(types.unliteral, args)), {name: types.unliteral(one) for name, one in kws.items()})

    dispatcher.get_call_template = get_call_template
    return dispatcher
