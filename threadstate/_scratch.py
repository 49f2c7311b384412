"""Arrays for the time of a call, on the stack (docs/decisions/0078-scratch-on-the-stack.md)."""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.imputils import lower_builtin
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.np.arrayobj import make_array, populate_array
from numpy.typing import NDArray

ALIGNMENT = 32
"""Of the first number (bytes): a vector of four doubles."""


def scratch(rows: int, columns: int | None = None) -> NDArray[np.float64]:
    """A new array of shape (rows,) or (rows, columns), its numbers not set.

    In a kernel it lives as long as the call in which it is made: it must not be returned. Its sizes are constants
    there: names of a module's own numbers, or numbers written down.
    """
    return np.empty(rows if columns is None else (rows, columns))


def zeros(rows: int, columns: int | None = None) -> NDArray[np.float64]:
    """As :func:`scratch`, its numbers 0."""
    return np.zeros(rows if columns is None else (rows, columns))


@infer_global(scratch)
@infer_global(zeros)
class _OfConstantSize(AbstractTemplate):
    """The type of an array of constant sizes."""

    prefer_literal = True

    def generic(self, args: tuple[Any, ...], kws: dict[str, Any]) -> Any:
        """The signature for these sizes; none where one is no constant."""
        if kws or not all(isinstance(one, types.IntegerLiteral) for one in args):
            return None
        return signature(types.Array(types.float64, len(args), "C"), *args)


@lower_builtin(scratch, types.VarArg(types.IntegerLiteral))
def _lower(context: Any, builder: Any, of_call: Any, _: Any) -> Any:
    """Room in the frame of the function, and an array over it of which no reference is counted."""
    sizes = [one.literal_value for one in of_call.args]
    with builder.goto_entry_block():
        room = builder.alloca(ir.ArrayType(ir.DoubleType(), int(np.prod(sizes))))
        room.align = ALIGNMENT
    array = make_array(of_call.return_type)(context, builder)
    item = context.get_abi_sizeof(ir.DoubleType())
    steps = [item * int(np.prod(sizes[i + 1 :])) for i in range(len(sizes))]
    populate_array(
        array,
        data=builder.bitcast(room, array.data.type),
        shape=[context.get_constant(types.intp, one) for one in sizes],
        strides=[context.get_constant(types.intp, one) for one in steps],
        itemsize=context.get_constant(types.intp, item),
        meminfo=None,
    )
    return array._getvalue()


@lower_builtin(zeros, types.VarArg(types.IntegerLiteral))
def _lower_zeros(context: Any, builder: Any, of_call: Any, args: Any) -> Any:
    """The same, filled with zeros at each call."""
    value = _lower(context, builder, of_call, args)
    array = make_array(of_call.return_type)(context, builder, value)
    size = context.get_abi_sizeof(ir.DoubleType()) * int(np.prod([one.literal_value for one in of_call.args]))
    cgutils.memset(builder, array.data, context.get_constant(types.intp, size), 0)
    return value
