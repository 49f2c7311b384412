"""How deep the corners of either crest are in the other part: of a crest, the places where an overlap is narrowest."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._branchless_kernel import (
    Numbers,
    azimuth,
    profile_numbers,
    radius_and_slope,
    sine_cosine,
    smaller,
)
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._slope_kernel import placement_numbers
from threadstate.contact._tangency_kernel import PLACEMENT_OFF, PLACEMENT_ROT
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

CORNER_SAMPLES = 64
"""Points of a crest's corner, all round, between which its deepest points are bracketed."""
CORNER_STEP = TWO_PI / CORNER_SAMPLES
CORNER_REACH = 1e-3
"""Depth below zero, in thread pitches, down to which the greatest depth between samples of a corner is looked for."""
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
CORNER_BISECTIONS = 60


@kernel()
def depth_at_corner(
    angle: float, s: float, of_nut: bool, placement: Array, bolt: Array, nut: Array
) -> tuple[float, float, float]:
    """How deep a crest's helix is in the other part: the depth, and the place (theta, z) on the bolt's thread.

    The helix is the bolt's or the nut's, at the axial position ``s`` of its profile; ``angle`` is the azimuth there.
    """
    p = bolt[pk.P]
    k = bolt[pk.LEAD] / TWO_PI
    z = s + k * angle
    z -= p * math.floor(z / p)
    m = placement[PLACEMENT_ROT : PLACEMENT_ROT + 9]
    off = placement[PLACEMENT_OFF : PLACEMENT_OFF + 3]
    if of_nut:
        r = pk.radius(s, nut)
        x, y, up = r * math.cos(angle) - off[0], r * math.sin(angle) - off[1], z - p - off[2]
        bx, by = m[0] * x + m[3] * y + m[6] * up, m[1] * x + m[4] * y + m[7] * up
        bz = m[2] * x + m[5] * y + m[8] * up
        theta = math.atan2(by, bx)
        return min(pk.radius(bz - k * theta, bolt) - math.hypot(bx, by), bz, p - bz), theta, bz
    r = pk.radius(s, bolt)
    bx, by = r * math.cos(angle), r * math.sin(angle)
    x, y = m[0] * bx + m[1] * by + m[2] * z + off[0], m[3] * bx + m[4] * by + m[5] * z + off[1]
    up = m[6] * bx + m[7] * by + m[8] * z + off[2]
    return min(math.hypot(x, y) - pk.radius(up - k * math.atan2(y, x), nut), -up, p + up), angle, z


@kernel(contract=True)
def set_depths(s: float, of_nut: bool, r: float, p: float, k: float, m: Numbers, other: Numbers, depths: Array) -> None:
    """Sets :func:`depth_at_corner` of all samples, without branches; ``r`` is the helix's radius.

    ``m`` are the :func:`placement_numbers`, ``other`` the :func:`profile_numbers` of the other part.
    """
    inward = 1.0 if of_nut else 0.0
    xx, xy, xz = m[0], (m[3] if of_nut else m[1]), (m[6] if of_nut else m[2])
    yx, yy, yz = (m[1] if of_nut else m[3]), m[4], (m[7] if of_nut else m[5])
    zx, zy, zz = (m[2] if of_nut else m[6]), (m[5] if of_nut else m[7]), m[8]
    # From the one part's frame to the other's: offset before the rotation, or after it.
    before_x, before_y, before_z = -inward * m[9], -inward * m[10], -inward * (m[11] + p)
    after_x, after_y, after_z = (1.0 - inward) * m[9], (1.0 - inward) * m[10], (1.0 - inward) * m[11]
    sign = 1.0 if of_nut else -1.0
    for i in range(CORNER_SAMPLES):
        angle = CORNER_STEP * i
        sin, cos = sine_cosine(angle)
        z = s + k * angle
        z -= p * np.floor(z / p)
        x, y, z = r * cos + before_x, r * sin + before_y, z + before_z
        at_x, at_y = xx * x + xy * y + xz * z + after_x, yx * x + yy * y + yz * z + after_y
        at_z = zx * x + zy * y + zz * z + after_z
        radius = math.sqrt(at_x * at_x + at_y * at_y)
        surface, _, _, _ = radius_and_slope(at_z - k * azimuth(at_x, at_y, radius), other)
        depths[i] = smaller(smaller(sign * at_z, p - sign * at_z), sign * (surface - radius))


@kernel()
def deepest_corner_point(placement: Array, bolt: Array, nut: Array) -> tuple[float, float, float]:
    """The greatest depth found along the corners of both crests, and its place (theta, z) on the bolt's thread.

    It is the depth of the bolt's crest in the nut or that of the nut's crest in the bolt. Along a corner it is as
    smooth as the other part's flank, however sharp the corner is; across it phi has a ridge that samples step over.
    """
    p, k = bolt[pk.P], bolt[pk.LEAD] / TWO_PI
    m = placement_numbers(placement)
    depths = scratch(CORNER_SAMPLES)
    deepest, at_theta, at_z = -math.inf, 0.0, 0.0
    for part in range(2):
        of_nut = part == 1
        profile = nut if of_nut else bolt
        other = profile_numbers(bolt if of_nut else nut)
        for side in range(2):
            half = side * pk.FALLING
            u = 0.5 * (nut[pk.U_FLAT + half] + nut[pk.U_FLANK + half])
            if not of_nut:
                u = 0.5 * (bolt[pk.U_CREST + half] + bolt[pk.U_TOP + half])
            s = u if side == 0 else 0.5 * p - u
            set_depths(s, of_nut, pk.radius(s, profile), p, k, m, other, depths)
            highest = 0
            for i in range(CORNER_SAMPLES):
                if depths[i] > depths[highest]:
                    highest = i
            depth, theta, z = depth_at_corner(CORNER_STEP * highest, s, of_nut, placement, bolt, nut)
            if depth > deepest:
                deepest, at_theta, at_z = depth, theta, z
            for i in range(CORNER_SAMPLES):
                before, after = depths[i - 1], depths[(i + 1) % CORNER_SAMPLES]
                if depths[i] >= before and depths[i] >= after and depths[i] > -CORNER_REACH * p:
                    depth, theta, z = deepest_between(CORNER_STEP * (i - 1), s, of_nut, placement, bolt, nut)
                    if depth > deepest:
                        deepest, at_theta, at_z = depth, theta, z
    return deepest, at_theta, at_z


@kernel()
def deepest_between(
    low: float, s: float, of_nut: bool, placement: Array, bolt: Array, nut: Array
) -> tuple[float, float, float]:
    """The greatest depth of a corner within two steps from the azimuth ``low`` on, by golden sections; its place."""
    high = low + 2.0 * CORNER_STEP
    for _ in range(CORNER_BISECTIONS):
        left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        at_left, _, _ = depth_at_corner(left, s, of_nut, placement, bolt, nut)
        at_right, _, _ = depth_at_corner(right, s, of_nut, placement, bolt, nut)
        if at_left > at_right:
            high = right
        else:
            low = left
    return depth_at_corner(0.5 * (low + high), s, of_nut, placement, bolt, nut)
