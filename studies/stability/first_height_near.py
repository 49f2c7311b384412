"""The brute force's first height looked for about one place with dense samples.

Beside a jump the two edges share a sliver a few thousandths of a degree wide, which samples all round step over.
"""

from __future__ import annotations

import math

import numpy as np

from oracle import first_height as oracle
from oracle.compiled import compiled
from oracle.pose import pose_rotation
from oracle.profile import Floats, bolt_profile, nut_profile
from threadstate.state.model import Contact
from threadstate.thread.pair import Pair

HALF_WIDTH_DEG = 0.1
SAMPLES = 20_001
"""1e-5 deg apart."""

_height, _zoom_curve = oracle._height, oracle._zoom_curve


@compiled
def _highest(feature: int, middle: float, half: float, rot: Floats, bolt: Floats, nut: Floats) -> float:
    step = 2.0 * half / (SAMPLES - 1)
    best, best_u = -1e9, middle
    for i in range(SAMPLES):
        u = middle - half + i * step
        h = _height(feature, u, 0.0, rot, bolt, nut)
        if h > best:
            best, best_u = h, u
    return max(best, _zoom_curve(feature, best_u, step, rot, bolt, nut)[0])


def first_height_near(pair: Pair, pose_deg: tuple[float, float, float], contact: Contact) -> float:
    """Height of the bolt's origin (pose in degrees) at which either edge first touches near a contact's azimuths.

    In the pair's unit.
    """
    bolt, nut, rot = bolt_profile(pair), nut_profile(pair), pose_rotation(*pose_deg)
    half = math.radians(HALF_WIDTH_DEG)
    on_bolt, on_nut = (math.atan2(point[1], point[0]) for point in (contact.point_bolt, contact.point))
    rot = np.ascontiguousarray(rot)
    return max(
        float(_highest(feature, azimuth, half, rot, bolt, nut))
        for feature, azimuth in ((oracle.BOLT_EDGE, on_bolt), (oracle.NUT_EDGE, on_nut))
    )
