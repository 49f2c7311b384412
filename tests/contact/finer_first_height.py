"""The brute force's first height with far denser samples: for pockets that its own samples step over.

Beside a jump the two edges share a sliver a few thousandths of a degree wide, and thread meets thread along a ridge
that is narrow across.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from oracle import first_height as oracle
from oracle.compiled import compiled
from oracle.pose import pose_rotation
from oracle.profile import P, bolt_profile, nut_profile
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

EDGE_SAMPLES = 400_000
"""0.0009 deg apart."""
AROUND, ALONG = 2880, 480

_height, _zoom_curve, _zoom_surface = oracle._height, oracle._zoom_curve, oracle._zoom_surface


@compiled
def _on_curve(feature: int, rot: Floats, bolt: Floats, nut: Floats) -> float:
    step = 2.0 * math.pi / EDGE_SAMPLES
    best, best_u = -1e9, 0.0
    for i in range(EDGE_SAMPLES):
        h = _height(feature, i * step, 0.0, rot, bolt, nut)
        if h > best:
            best, best_u = h, i * step
    return max(best, _zoom_curve(feature, best_u, step, rot, bolt, nut)[0])


@compiled
def _on_bolt_thread(floor: float, rot: Floats, bolt: Floats, nut: Floats) -> float:
    du, dv = 2.0 * math.pi / AROUND, bolt[P] / ALONG
    best = -1e9
    u, v = 0.0, 0.0
    for i in range(AROUND):
        for j in range(ALONG + 1):
            h = _height(oracle.BOLT_THREAD, i * du, j * dv, rot, bolt, nut)
            if h > best:
                best, u, v = h, i * du, j * dv
    if best < floor:
        return best
    return max(best, _zoom_surface(oracle.BOLT_THREAD, u, v, du, dv, rot, bolt, nut)[0])


def finer_first_height(pair: Pair, roll: float, pitch: float, phase: float) -> float:
    """Height of the bolt's origin at the first contact (pose in degrees), in the pair's unit."""
    bolt, nut, rot = bolt_profile(pair), nut_profile(pair), pose_rotation(roll, pitch, phase)
    edges = max(_on_curve(feature, rot, bolt, nut) for feature in (oracle.BOLT_EDGE, oracle.NUT_EDGE))
    return max(edges, _on_bolt_thread(edges - 0.04 * pair.thread_pitch, rot, bolt, nut))
