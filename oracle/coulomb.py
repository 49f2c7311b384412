"""Contact forces of one step with Coulomb friction: nonlinear Gauss-Seidel over the contacts (Jean and Moreau).

The step of a body on springs is ``inverse (load + sum of rows^T force)``. At each contact the normal force is >= 0 and
vanishes unless the gap after the step does; the tangential force has a size of at most mu times the normal one, and has
that size against the slip where there is any. Units are the caller's.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from oracle.compiled import compiled

Floats = NDArray[np.float64]

SWEEPS = 300
"""The most of them; in one each contact's force is corrected once."""


@compiled
def contact_step(
    rows: Floats,
    gaps: Floats,
    slips: Floats,
    load: Floats,
    inverse: Floats,
    mu: float,
    forces: Floats,
    tolerance: float,
) -> tuple[Floats, bool]:
    """The step, shape (m,), and whether the forces changed by less than the tolerance in the last sweep.

    ``rows``, shape (n, 3, m), are the normal and two tangential velocities of each contact for each coordinate;
    ``gaps`` (n,) and ``slips`` (n, 2) are those before the step. ``forces``, shape (n, 3), is what they begin with, and
    is overwritten.
    """
    n, m = len(gaps), len(load)
    step = inverse @ load
    lifted = np.empty((n, 3, m))
    along = np.empty((n, 2))
    for i in range(n):
        for k in range(3):
            lifted[i, k] = inverse @ rows[i, k]
            step += lifted[i, k] * forces[i, k]
        along[i, 0] = 1.0 / (rows[i, 0] @ lifted[i, 0])
        a, b, c = rows[i, 1] @ lifted[i, 1], rows[i, 2] @ lifted[i, 2], rows[i, 1] @ lifted[i, 2]
        along[i, 1] = 1.0 / (0.5 * (a + b) + math.sqrt(0.25 * (a - b) ** 2 + c * c))
    for _ in range(SWEEPS):
        change = 0.0
        for i in range(n):
            before = forces[i].copy()
            forces[i, 0] = max(0.0, before[0] - along[i, 0] * (gaps[i] + rows[i, 0] @ step))
            step += lifted[i, 0] * (forces[i, 0] - before[0])
            if mu > 0.0:
                first = before[1] - along[i, 1] * (slips[i, 0] + rows[i, 1] @ step)
                second = before[2] - along[i, 1] * (slips[i, 1] + rows[i, 2] @ step)
                size, most = math.sqrt(first * first + second * second), mu * forces[i, 0]
                share = 1.0 if size <= most else most / size
                forces[i, 1], forces[i, 2] = share * first, share * second
                step += lifted[i, 1] * (forces[i, 1] - before[1]) + lifted[i, 2] * (forces[i, 2] - before[2])
            for k in range(3):
                change = max(change, abs(forces[i, k] - before[k]))
        if change < tolerance:
            return step, True
    return step, False
