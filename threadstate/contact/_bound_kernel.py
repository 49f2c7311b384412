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
B_SECOND_DERIVATIVE = 1
"""Bound on the second derivative (operator norm of the Hessian) of phi as a function of position."""
B_TILT = 2
"""Angle between the axes of the parts at the start (rad)."""
B_OFFSET = 3
"""Distance of the curve's origin from the solid's axis at the start."""
B_OFFSET_RATE = 4
"""Speed of the curve's origin."""
B_CURVE_DERIVATIVE = 5
"""Bound on |C'|, the derivative of the edge curve by azimuth."""
B_LEAST_RADIUS = 6
"""A radius that no point of either part comes below."""
BOUNDS_SIZE = 7


@kernel()
def second_derivative_bound(profile: Array) -> float:
    """Largest |f''| of a profile; infinite for a sharp corner."""
    square = 1.0 + profile[pk.STEEPEST] * profile[pk.STEEPEST]
    cube = square * math.sqrt(square)
    rho = min(profile[pk.RHO_MINOR], profile[pk.RHO_MAJOR])
    return cube / rho if rho > 0.0 else math.inf


@kernel()
def set_bounds(motion: Array, curve_profile: Array, solid_profile: Array, bounds: Array) -> None:
    """The constants of a search for the edge curve of ``curve_profile`` in the solid of ``solid_profile``."""
    k = abs(curve_profile[pk.LEAD]) / TWO_PI
    cot = solid_profile[pk.STEEPEST]
    r_low = 0.5 * solid_profile[pk.R_MINOR]
    k_r = k / r_low
    bounds[B_LIPSCHITZ] = math.sqrt(1.0 + cot * cot * (1.0 + k_r * k_r))
    bounds[B_SECOND_DERIVATIVE] = second_derivative_bound(solid_profile) * (1.0 + k_r * k_r) + (cot * k_r + 1.0) / r_low
    bounds[B_TILT] = math.asin(min(1.0, math.hypot(motion[2], motion[5])))
    bounds[B_OFFSET] = math.hypot(motion[9], motion[10])
    if motion[M_KIND] == 0.0:
        bounds[B_OFFSET_RATE] = math.hypot(motion[16], motion[17])
    else:
        dx = motion[9] - motion[13]
        dy = motion[10] - motion[14]
        dz = motion[11] - motion[15]
        bounds[B_OFFSET_RATE] = math.sqrt(dx * dx + dy * dy + dz * dz)
    bounds[B_CURVE_DERIVATIVE] = math.hypot(curve_profile[pk.R_MAJOR], k * curve_profile[pk.STEEPEST])
    bounds[B_LEAST_RADIUS] = r_low


@kernel()
def sine_of_tilt(motion: Array, bounds: Array, tau: float) -> float:
    """Bound on the sine of the angle between the axes up to ``tau``."""
    if motion[M_KIND] == 0.0:
        return math.sin(bounds[B_TILT])
    return math.sin(min(bounds[B_TILT] + tau, 0.5 * math.pi))
