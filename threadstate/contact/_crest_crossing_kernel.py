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
from threadstate.contact._branchless_kernel import azimuth
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._slope_kernel import placement_numbers
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

CREST_SAMPLES = 96
"""Points of a helix of the bolt's thread, all round, between which crossings are found."""
MAX_SEEDS = 64
BEYOND = 0.1
"""Thread pitches above the nut's surface and below its lower end in which a crossing is taken, too: it may move in."""


RISING_CORNER, FALLING_CORNER, ROOT = range(3)
HELICES = 3
"""Helices: in the middle of the fillets at the crest, and in the middle of the root."""

# Blocks of points of the bolt's helices, one helix after the other: place in its frame; then height in the nut's frame,
# and axial position on its profile; then, of each helix of the nut, where on the way from the point before it crosses.
HELIX_SIZE = 104
CRESTS_SIZE = HELICES * HELIX_SIZE
W_X = 0
W_Y = CRESTS_SIZE
W_Z = 2 * CRESTS_SIZE
W_HEIGHT = 3 * CRESTS_SIZE
W_POSITION = 4 * CRESTS_SIZE
W_SHARE = 5 * CRESTS_SIZE
CRESTS_ARRAY_SIZE = (5 + HELICES) * CRESTS_SIZE


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
def set_crests(bolt: Array, crests: Array) -> None:
    """Sets the points of the bolt's helices, all round and in its frame, in ``crests`` of ``CRESTS_ARRAY_SIZE``."""
    p, k = bolt[pk.P], bolt[pk.LEAD] / TWO_PI
    for which in range(HELICES):
        s = helix(which, True, bolt)
        r = pk.radius(s, bolt)
        for i in range(CREST_SAMPLES + 1):
            j = which * HELIX_SIZE + i
            theta = TWO_PI * i / CREST_SAMPLES
            z = s + k * theta
            crests[W_X + j], crests[W_Y + j] = r * math.cos(theta), r * math.sin(theta)
            crests[W_Z + j] = z - p * math.floor(z / p)


@kernel(contract=True)
def place_crests(placement: Array, nut: Array, crests: Array) -> None:
    """Sets the points' heights in the nut's frame, and their axial positions on its profile, for a placement."""
    k = nut[pk.LEAD] / TWO_PI
    mxx, mxy, mxz, myx, myy, myz, mzx, mzy, mzz, ox, oy, oz = placement_numbers(placement)
    for i in range(CRESTS_SIZE):
        bx, by, bz = crests[W_X + i], crests[W_Y + i], crests[W_Z + i]
        x, y = mxx * bx + mxy * by + mxz * bz + ox, myx * bx + myy * by + myz * bz + oy
        height = mzx * bx + mzy * by + mzz * bz + oz
        crests[W_HEIGHT + i] = height
        crests[W_POSITION + i] = height - k * azimuth(x, y, math.sqrt(x * x + y * y))


@kernel(contract=True)
def set_shares(of_nut: int, bolt: Array, nut: Array, crests: Array) -> None:
    """Sets at which part of the way from the point before a helix of the nut's is crossed: negative where none is.

    Beyond the nut, across the ends of the bolt's thread and of the range of azimuths nothing crosses.
    """
    p, lead = bolt[pk.P], nut[pk.LEAD]
    target = helix(of_nut, False, nut)
    low, high = -(1.0 + BEYOND) * p, BEYOND * p
    shares = W_SHARE + of_nut * CRESTS_SIZE
    for i in range(1, CRESTS_SIZE):
        height_before, height = crests[W_HEIGHT + i - 1], crests[W_HEIGHT + i]
        joined = low < height_before and height_before < high and low < height and height < high
        joined = joined and abs(crests[W_Z + i] - crests[W_Z + i - 1]) < 0.5 * p
        before, here = crests[W_POSITION + i - 1] - target, crests[W_POSITION + i] - target
        turned = p * math.floor(before / p + 0.5)
        before, here = before - turned, here - turned
        here -= lead * math.floor((here - before) / lead + 0.5)
        crosses = joined and before * here <= 0.0 and before != here and abs(here - before) < 0.5 * p
        share = before / (before - here)
        crests[shares + i] = share if crosses else -1.0


@kernel()
def crest_crossings(placement: Array, bolt: Array, nut: Array, crests: Array, seeds: Array) -> int:
    """Sets the ``seeds``, as (theta, z) on the bolt's thread, where helices cross, but roots roots; their number.

    ``crests`` is as :func:`set_crests` leaves it.
    """
    place_crests(placement, nut, crests)
    for of_nut in range(HELICES):
        set_shares(of_nut, bolt, nut, crests)
    count = 0
    for of_bolt in range(HELICES):
        first = of_bolt * HELIX_SIZE
        for i in range(first + 1, first + CREST_SAMPLES + 1):
            for of_nut in range(2 if of_bolt == ROOT else HELICES):
                share = crests[W_SHARE + of_nut * CRESTS_SIZE + i]
                if share >= 0.0 and count < MAX_SEEDS:
                    seeds[count, 0] = TWO_PI / CREST_SAMPLES * (i - first - 1 + share)
                    seeds[count, 1] = crests[W_Z + i - 1] + share * (crests[W_Z + i] - crests[W_Z + i - 1])
                    count += 1
    return count
