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
from threadstate.contact._tangency_kernel import PLACEMENT_AXIS, PLACEMENT_DRIFT
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

CREST_SAMPLES = 96
"""Points of a helix of the bolt's thread, all round, between which crossings are found."""
MAX_SEEDS = 64
SAGITTA = 0.5 * (math.pi / CREST_SAMPLES) ** 2
"""How far, in radii, a helix is from the chord between neighbouring points at most."""
BEYOND = 0.1
"""Thread pitches above the nut's surface and below its lower end in which a crossing is taken, too: it may move in."""


RISING_CORNER, FALLING_CORNER, ROOT = range(3)
HELICES = 3
"""Helices: in the middle of the fillets at the crest, and in the middle of the root."""

# Blocks of points of the bolt's helices, one helix after the other: place in its frame, then in the nut's; axial
# position on the nut's profile; then 0 where no helix of the nut's crosses on the way from the point before it.
HELIX_SIZE = 104
CRESTS_SIZE = HELICES * HELIX_SIZE
W_X = 0
W_Y = CRESTS_SIZE
W_Z = 2 * CRESTS_SIZE
W_NUT_X = 3 * CRESTS_SIZE
W_NUT_Y = 4 * CRESTS_SIZE
W_HEIGHT = 5 * CRESTS_SIZE
W_POSITION = 6 * CRESTS_SIZE
W_MAY_CROSS = 7 * CRESTS_SIZE
CRESTS_ARRAY_SIZE = 8 * CRESTS_SIZE


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
    """Sets the points of the bolt's helices, all round and in its frame, in ``crests`` of ``CRESTS_ARRAY_SIZE``.

    All else in it is zero: what pads a helix is no point.
    """
    for i in range(crests.shape[0]):
        crests[i] = 0.0
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
    """Sets the points' places in the nut's frame, and their axial positions on its profile, for a placement."""
    k = nut[pk.LEAD] / TWO_PI
    mxx, mxy, mxz, myx, myy, myz, mzx, mzy, mzz, ox, oy, oz = placement_numbers(placement)
    for i in range(CRESTS_SIZE):
        bx, by, bz = crests[W_X + i], crests[W_Y + i], crests[W_Z + i]
        x, y = mxx * bx + mxy * by + mxz * bz + ox, myx * bx + myy * by + myz * bz + oy
        height = mzx * bx + mzy * by + mzz * bz + oz
        crests[W_NUT_X + i], crests[W_NUT_Y + i], crests[W_HEIGHT + i] = x, y, height
        crests[W_POSITION + i] = height - k * azimuth(x, y, math.sqrt(x * x + y * y))


@kernel(contract=True)
def mark_crossings(bolt: Array, nut: Array, crests: Array) -> None:
    """Sets between which neighbouring points a helix of the nut's may be crossed: those that differ in which turns of
    it they lie between, or lie on both sides of the end of the range of azimuths.

    Beyond the nut and across the ends of the bolt's thread nothing crosses.
    """
    p = bolt[pk.P]
    inverse_p = 1.0 / p
    low, high = -(1.0 + BEYOND) * p, BEYOND * p
    rising, falling, root = helix(RISING_CORNER, False, nut), helix(FALLING_CORNER, False, nut), helix(ROOT, False, nut)
    for i in range(1, CRESTS_SIZE):
        height_before, height = crests[W_HEIGHT + i - 1], crests[W_HEIGHT + i]
        before, here = crests[W_POSITION + i - 1], crests[W_POSITION + i]
        way = abs(crests[W_Z + i] - crests[W_Z + i - 1])
        # All loads come first, and numbers stand for what is true: the loop becomes vector instructions.
        off = 0.0 if low < height_before else 1.0
        off = off if height_before < high else 1.0
        off = off if low < height else 1.0
        off = off if height < high else 1.0
        off = off if way < 0.5 * p else 1.0
        turns = abs(np.floor((before - rising) * inverse_p) - np.floor((here - rising) * inverse_p))
        turns += abs(np.floor((before - falling) * inverse_p) - np.floor((here - falling) * inverse_p))
        turns += abs(np.floor((before - root) * inverse_p) - np.floor((here - root) * inverse_p))
        turns = 1.0 if abs(here - before) >= 0.5 * p else turns
        crests[W_MAY_CROSS + i] = turns if off == 0.0 else 0.0


@kernel()
def share_of_way(i: int, of_nut: int, bolt: Array, nut: Array, crests: Array) -> float:
    """At which part of the way from the point before a helix of the nut's is crossed: negative where none is."""
    p, lead = bolt[pk.P], nut[pk.LEAD]
    target = helix(of_nut, False, nut)
    before, here = crests[W_POSITION + i - 1] - target, crests[W_POSITION + i] - target
    turned = p * math.floor(before / p + 0.5)
    before, here = before - turned, here - turned
    here -= lead * math.floor((here - before) / lead + 0.5)
    crosses = before * here <= 0.0 and before != here and abs(here - before) < 0.5 * p
    return before / (before - here) if crosses else -1.0


@kernel()
def is_near(
    i: int, share: float, radius: float, near: float, soon: float, placement: Array, nut: Array, crests: Array
) -> bool:
    """Whether phi at a crossing may be less than ``near``, or change by as much as it is within ``soon``.

    ``radius`` is that of the nut's helix. phi changes no faster than the point moves times the size of its gradient.
    """
    j = i - 1
    x = crests[W_NUT_X + j] + share * (crests[W_NUT_X + i] - crests[W_NUT_X + j])
    y = crests[W_NUT_Y + j] + share * (crests[W_NUT_Y + i] - crests[W_NUT_Y + j])
    z = crests[W_HEIGHT + j] + share * (crests[W_HEIGHT + i] - crests[W_HEIGHT + j])
    ax, ay, az = placement[PLACEMENT_AXIS], placement[PLACEMENT_AXIS + 1], placement[PLACEMENT_AXIS + 2]
    vx = ay * z - az * y + placement[PLACEMENT_DRIFT]
    vy = az * x - ax * z + placement[PLACEMENT_DRIFT + 1]
    vz = ax * y - ay * x + placement[PLACEMENT_DRIFT + 2]
    speed = math.sqrt(vx * vx + vy * vy + vz * vz)
    r = math.sqrt(x * x + y * y)
    k_r = nut[pk.LEAD] / (TWO_PI * r)
    cot = nut[pk.STEEPEST]
    gradient = math.sqrt(1.0 + cot * cot * (1.0 + k_r * k_r))
    return abs(r - radius) < near + SAGITTA * r + soon * gradient * speed


@kernel()
def crest_crossings(
    placement: Array, near: float, soon: float, bolt: Array, nut: Array, crests: Array, seeds: Array
) -> int:
    """Sets the ``seeds``, as (theta, z) on the bolt's thread, where helices cross, but roots roots; their number.

    Only where phi may be less than ``near``, or change by as much as it is within ``soon``. ``crests`` is as
    :func:`set_crests` leaves it.
    """
    place_crests(placement, nut, crests)
    mark_crossings(bolt, nut, crests)
    count = 0
    for of_bolt in range(HELICES):
        first = of_bolt * HELIX_SIZE
        for i in range(first + 1, first + CREST_SAMPLES + 1):
            if crests[W_MAY_CROSS + i] == 0.0:
                continue
            for of_nut in range(2 if of_bolt == ROOT else HELICES):
                share = share_of_way(i, of_nut, bolt, nut, crests)
                if share < 0.0 or count == MAX_SEEDS:
                    continue
                radius = pk.radius(helix(of_nut, False, nut), nut)
                if is_near(i, share, radius, near, soon, placement, nut, crests):
                    seeds[count, 0] = TWO_PI / CREST_SAMPLES * (i - first - 1 + share)
                    seeds[count, 1] = crests[W_Z + i - 1] + share * (crests[W_Z + i] - crests[W_Z + i - 1])
                    count += 1
    return count
