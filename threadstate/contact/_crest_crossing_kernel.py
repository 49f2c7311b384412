"""Where helices of the bolt's crest and root cross those of the nut's: there phi may have a narrow maximum.

After a turn of some tens of degrees such a maximum is a few hundredths of a radian wide and lasts for tenths of a
degree: a crest of the one part on a crest or in a root of the other. Along a helix of the bolt's thread the axial
position on the nut's profile passes that of a helix of the nut's where they cross.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._tangency_kernel import PLACEMENT_OFF, PLACEMENT_ROT
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

SAMPLES = 96
"""Points of a helix of the bolt's thread, all round, between which crossings are found."""
MAX_SEEDS = 64
BEYOND = 0.1
"""Thread pitches above the nut's surface and below its lower end in which a crossing is taken, too: it may move in."""


RISING_CORNER, FALLING_CORNER, ROOT = range(3)
"""Helices: in the middle of the fillets at the crest, and in the middle of the root."""


@kernel()
def helix(which: int, of_bolt: bool, profile: Array) -> float:
    """The axial position of a helix on the profile of the bolt or the nut."""
    if which == ROOT:
        return profile[pk.S_ROOT] if of_bolt else profile[pk.S_CREST]
    half = pk.FALLING if which == FALLING_CORNER else 0
    first, last = (pk.U_CREST, pk.U_TOP) if of_bolt else (pk.U_FLAT, pk.U_FLANK)
    u = 0.5 * (profile[first + half] + profile[last + half])
    return u if which == RISING_CORNER else 0.5 * profile[pk.P] - u


@kernel()
def crest_crossings(placement: Array, bolt: Array, nut: Array, seeds: Array) -> int:
    """Sets the ``seeds``, as (theta, z) on the bolt's thread, where helices cross, but roots roots; their number."""
    p = bolt[pk.P]
    k, k_nut = bolt[pk.LEAD] / TWO_PI, nut[pk.LEAD] / TWO_PI
    m = placement[PLACEMENT_ROT : PLACEMENT_ROT + 9]
    off = placement[PLACEMENT_OFF : PLACEMENT_OFF + 3]
    count = 0
    for of_bolt in range(3):
        s = helix(of_bolt, True, bolt)
        r = pk.radius(s, bolt)
        z_before, at_before, is_before = 0.0, 0.0, False
        for i in range(SAMPLES + 1):
            theta = TWO_PI * i / SAMPLES
            z = s + k * theta
            z -= p * math.floor(z / p)
            bx, by = r * math.cos(theta), r * math.sin(theta)
            x, y = m[0] * bx + m[1] * by + m[2] * z + off[0], m[3] * bx + m[4] * by + m[5] * z + off[1]
            height = m[6] * bx + m[7] * by + m[8] * z + off[2]
            at = height - k_nut * math.atan2(y, x)
            is_here = -(1.0 + BEYOND) * p < height < BEYOND * p
            # Across the ends of the bolt's thread, and of the range of azimuths, nothing crosses.
            joined = is_before and is_here and abs(z - z_before) < 0.5 * p
            for of_nut in range((2 if of_bolt == ROOT else 3) if joined else 0):
                target = helix(of_nut, False, nut)
                before = at_before - target
                turns = math.floor(before / p + 0.5)
                before -= turns * p
                here = at - target - turns * p
                here -= nut[pk.LEAD] * math.floor((here - before) / nut[pk.LEAD] + 0.5)
                if before * here <= 0.0 and before != here and abs(here - before) < 0.5 * p and count < MAX_SEEDS:
                    share = before / (before - here)
                    seeds[count, 0] = theta - TWO_PI / SAMPLES * (1.0 - share)
                    seeds[count, 1] = z_before + share * (z - z_before)
                    count += 1
            z_before, at_before, is_before = z, at, is_here
    return count
