"""The solver of cone programs as a function pointer."""

from __future__ import annotations

from numba import types

from threadstate._compile import kernel
from threadstate._pointer import Pointer
from threadstate.statics._cone_kernel import Array, Integers, solve_program

_ROW, _TABLE = types.float64[::1], types.float64[:, ::1]

PROGRAM = Pointer(solve_program, types.float64(_ROW, _TABLE, _ROW, types.Array(types.intp, 1, "C"), _ROW, _ROW))
program_at = PROGRAM.at


def program_address() -> int:
    """The address of the solver in this process."""
    return PROGRAM.address


@kernel(allocates=True)
def solve_with(program: int, c: Array, g: Array, h: Array, sizes: Integers, x: Array, z: Array) -> float:
    """As ``solve_program``, with the program at an address."""
    return float(program_at(program)(c, g, h, sizes, x, z))
