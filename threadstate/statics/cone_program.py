"""Cone programs that Python solves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from threadstate.statics._cone_kernel import solve_program

Floats = NDArray[np.float64]


def solved_program(c: Floats, g: Floats, h: Floats, sizes: Sequence[int] | NDArray[np.intp]) -> tuple[Floats, Floats]:
    """Both solutions, x (n,) and z (m,), of a cone program with c (n,), g (m, n) and h (m,); approximations.

    The cones of ``sizes`` follow each other, as ``_cone_kernel.solve_program`` has them.
    """
    x, z = np.zeros(len(c)), np.zeros(len(h))
    g, h = np.ascontiguousarray(g, dtype=np.float64), np.ascontiguousarray(h, dtype=np.float64)
    solve_program(np.ascontiguousarray(c), g, h, np.array(sizes, np.intp), x, z)
    return x, z
