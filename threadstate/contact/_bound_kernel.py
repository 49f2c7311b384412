"""Constants that bound how fast phi and its gradient can change during a motion."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import M_KIND, TWO_PI
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# Constants of one search.
B_LIPSCHITZ = 0
"""Bound on |grad phi|."""
B_BEND = 1
"""Bound on the second derivative of phi as a function of place."""
B_TILT = 2
"""Angle between the axes at the start."""
B_OFFSET = 3
"""Distance of the walker's origin from the other axis at the start, and its speed."""
B_DRIFT = 4
B_C1 = 5
"""Bound on |C'| of the edge curve."""
B_R_LOW = 6
BOUNDS_SIZE = 7


@kernel()
def second_derivative_bound(row: Array) -> float:
    """Largest |f''| of a profile; infinite for a sharp corner."""
    cube = (1.0 + row[pk.COT] * row[pk.COT]) ** 1.5
    rho = min(row[pk.RHO_MINOR], row[pk.RHO_MAJOR])
    return cube / rho if rho > 0.0 else math.inf


@kernel()
def set_bounds(motion: Array, row_c: Array, row_s: Array, bounds: Array) -> None:
    """The constants of a search for the edge curve of ``row_c`` in the solid of ``row_s``."""
    k = row_c[pk.P] / TWO_PI
    cot = row_s[pk.COT]
    r_low = 0.5 * row_s[pk.R_MINOR]
    k_r = k / r_low
    bounds[B_LIPSCHITZ] = math.sqrt(1.0 + cot * cot * (1.0 + k_r * k_r))
    bounds[B_BEND] = second_derivative_bound(row_s) * (1.0 + k_r * k_r) + (cot * k_r + 1.0) / r_low
    bounds[B_TILT] = math.asin(min(1.0, math.hypot(motion[2], motion[5])))
    bounds[B_OFFSET] = math.hypot(motion[9], motion[10])
    if motion[M_KIND] == 0.0:
        bounds[B_DRIFT] = math.hypot(motion[16], motion[17])
    else:
        dx = motion[9] - motion[13]
        dy = motion[10] - motion[14]
        dz = motion[11] - motion[15]
        bounds[B_DRIFT] = math.sqrt(dx * dx + dy * dy + dz * dz)
    bounds[B_C1] = math.hypot(row_c[pk.R_MAJOR], k * row_c[pk.COT])
    bounds[B_R_LOW] = r_low


@kernel()
def sine_of_tilt(motion: Array, bounds: Array, tau: float) -> float:
    """Bound on the sine of the angle between the axes up to ``tau``."""
    if motion[M_KIND] == 0.0:
        return math.sin(bounds[B_TILT])
    return math.sin(min(bounds[B_TILT] + tau, 0.5 * math.pi))
