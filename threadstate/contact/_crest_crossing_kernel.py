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
from threadstate._scratch import scratch
from threadstate.contact._branchless_kernel import coarse_azimuth
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

# Rows of points of the bolt's helices, one helix after the other: place in its frame, then in the nut's; axial
# position on the nut's profile; then 0 where no helix of the nut's crosses on the way from the point before it. The
# last ones of a helix pad it to a multiple of ``BLOCK``, so many of which are looked at together: of those beyond the
# nut nothing but the height is set.
BLOCK = 8
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
    for i in range(CREST_SAMPLES + 1):
        theta = TWO_PI * i / CREST_SAMPLES
        cosine, sine = math.cos(theta), math.sin(theta)
        for which in range(HELICES):
            s = helix(which, True, bolt)
            r, z = pk.radius(s, bolt), s + k * theta
            j = which * HELIX_SIZE + i
            crests[W_X + j], crests[W_Y + j] = r * cosine, r * sine
            crests[W_Z + j] = z - p * np.floor(z / p)


@kernel()
def helices_of_nut(nut: Array, helices: Array) -> None:
    """Sets the axial positions and the radii of the nut's helices."""
    for which in range(HELICES):
        s = helix(which, False, nut)
        helices[which, 0], helices[which, 1] = s, pk.radius(s, nut)


@kernel(contract=True)
def set_heights(placement: Array, crests: Array) -> None:
    """Sets how high the points are over the nut's surface, for a placement."""
    _, _, _, _, _, _, mzx, mzy, mzz, _, _, oz = placement_numbers(placement)
    for i in range(CRESTS_SIZE):
        crests[W_HEIGHT + i] = mzx * crests[W_X + i] + mzy * crests[W_Y + i] + mzz * crests[W_Z + i] + oz


@kernel()
def is_beyond(first: int, p: float, crests: Array) -> bool:
    """Whether all points of a block are beyond the nut."""
    low, high = -(1.0 + BEYOND) * p, BEYOND * p
    for i in range(first, first + BLOCK):
        if low < crests[W_HEIGHT + i] < high:
            return False
    return True


@kernel(contract=True)
def place_crests(first: int, count: int, placement: Array, nut: Array, crests: Array) -> None:
    """Sets the places in the nut's frame of so many points from ``first`` on, and their positions on its profile."""
    k = nut[pk.LEAD] / TWO_PI
    mxx, mxy, mxz, myx, myy, myz, _, _, _, ox, oy, _ = placement_numbers(placement)
    view = crests[first:]
    for i in range(count):
        bx, by, bz = view[W_X + i], view[W_Y + i], view[W_Z + i]
        x, y = mxx * bx + mxy * by + mxz * bz + ox, myx * bx + myy * by + myz * bz + oy
        view[W_NUT_X + i], view[W_NUT_Y + i] = x, y
        around, _ = coarse_azimuth(x, y, math.sqrt(x * x + y * y))
        view[W_POSITION + i] = view[W_HEIGHT + i] - k * around


@kernel(contract=True)
def mark_crossings(first: int, count: int, p: float, helices: Array, crests: Array) -> None:
    """Sets on which ways to so many points from ``first`` on a helix of the nut's may be crossed: those whose ends
    differ in which turns of it they lie between, or lie on both sides of the end of the range of azimuths.

    Beyond the nut and across the ends of the bolt's thread nothing crosses. There is no way to the first point of all.
    ``helices`` are the :func:`helices_of_nut`.
    """
    inverse_p = 1.0 / p
    low, high = -(1.0 + BEYOND) * p, BEYOND * p
    rising, falling, root = helices[RISING_CORNER, 0], helices[FALLING_CORNER, 0], helices[ROOT, 0]
    start = max(first, 1)
    view = crests[start - 1 :]
    for i in range(first + count - start):
        height_before, height = view[W_HEIGHT + i], view[W_HEIGHT + i + 1]
        before, here = view[W_POSITION + i], view[W_POSITION + i + 1]
        way = abs(view[W_Z + i + 1] - view[W_Z + i])
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
        view[W_MAY_CROSS + i + 1] = turns if off == 0.0 else 0.0


@kernel()
def share_of_way(i: int, target: float, p: float, lead: float, crests: Array) -> float:
    """At which part of the way from the point before a helix of the nut's is crossed: negative where it is not.

    ``target`` is the helix's axial position.
    """
    before, here = crests[W_POSITION + i - 1] - target, crests[W_POSITION + i] - target
    turned = p * np.floor(before / p + 0.5)
    before, here = before - turned, here - turned
    here -= lead * np.floor((here - before) / lead + 0.5)
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
    p, lead = bolt[pk.P], nut[pk.LEAD]
    helices = scratch(HELICES, 2)
    helices_of_nut(nut, helices)
    set_heights(placement, crests)
    count, end = 0, 0
    while end < CRESTS_SIZE:
        first = end
        end += BLOCK
        if is_beyond(first, p, crests):
            continue
        while end < CRESTS_SIZE and not is_beyond(end, p, crests):
            end += BLOCK
        place_crests(first, end - first, placement, nut, crests)
        mark_crossings(first, end - first, p, helices, crests)
        for i in range(first, end):
            if crests[W_MAY_CROSS + i] == 0.0:
                continue
            of_bolt = i // HELIX_SIZE
            sample = i - of_bolt * HELIX_SIZE
            if sample == 0 or sample > CREST_SAMPLES:
                continue
            for of_nut in range(2 if of_bolt == ROOT else HELICES):
                share = share_of_way(i, helices[of_nut, 0], p, lead, crests)
                if share < 0.0 or count == MAX_SEEDS:
                    continue
                if is_near(i, share, helices[of_nut, 1], near, soon, placement, nut, crests):
                    seeds[count, 0] = TWO_PI / CREST_SAMPLES * (sample - 1 + share)
                    seeds[count, 1] = crests[W_Z + i - 1] + share * (crests[W_Z + i] - crests[W_Z + i - 1])
                    count += 1
    return count
