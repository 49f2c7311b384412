"""The solver of cone programs as a function pointer."""

from __future__ import annotations

from numba import types

from threadstate._pointer import Pointer
from threadstate.statics._cone_kernel import solve_program

_ROW, _TABLE = types.float64[::1], types.float64[:, ::1]

PROGRAM = Pointer(solve_program, types.float64(_ROW, _TABLE, _ROW, types.Array(types.intp, 1, "C"), _ROW, _ROW))
program_at = PROGRAM.at


def program_address() -> int:
    """The address of the solver in this process."""
    return PROGRAM.address
