"""The maximum of phi over the bolt's thread near a point of a ridge: by Newton's method, or bracketed along the ridge.

Heights are counted from a height ``base`` over the bolt's base, to which the placement has moved the bolt. Steps along
a ridge end where it leaves either thread: a maximum beyond is no place of overlap.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._ridge_kernel import (
    FIRST_RIDGE_STEP,
    FIRST_WINDOW,
    LATER_RIDGE_STEP,
    MAX_RIDGE_STEPS,
    NARROW_AZIMUTHS,
    nearby_maximum,
    ridge_bracket,
)
from threadstate.contact._tangency_kernel import (
    TJ_A,
    TJ_B,
    TJ_PHI,
    TJ_UU,
    TJ_UZ,
    TJ_Z,
    TJ_ZZ,
    set_jet,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

NONE, MAXIMUM, OUTSIDE, NO_RIDGE, RISING, TOO_LOW = range(6)
"""What is near: no maximum, one, a ridge that rises out of either thread, or not even a ridge; a ridge that rises on
beyond the steps, or one that does not rise by its slope to where a maximum counts."""

SLOPE_LEFT, STEP_LEFT = 1e-13, 1e-14
"""The slope, and the step of Newton's method in thread pitches, at which a point counts as one of the ridge."""

POLISHED, POLISHED_NEAR = 1e-13, 1e-9
"""The last step of Newton's method, in radians and thread pitches: at which it ends, and the largest with which what it
has reached counts as a maximum."""

POLISH_STEPS = 12

SLIGHT_SLOPE, WITHIN = 0.05, 2e-3
"""Up to this slope of phi along the axis, from an edge's place out of the threads, a maximum within them is looked for
beside it, from so far within (nominal radii)."""

AZIMUTHS_BESIDE, SLIGHTEST_SLOPE = (0.0, 0.02, -0.02, 0.05, -0.05), 0.01
"""The azimuths (rad) from that of an edge's place on which ridges beside it are looked for: one may begin and end
between two of the search's. On those other than its own up to this slope, from the place into the threads."""

BISECTIONS = 12
"""Of the part of an azimuth on which there is a ridge."""

RIDGE_STEPS, CONVERGING = 8, 0.5
"""Of Newton's method to a ridge on an azimuth: the most steps, and each over the one before."""


@kernel()
def reduced(slope: float, retained: float, before: float) -> float:
    """The slope at a retained end of a bracket, reduced as Anderson and Bjorck (1973) do, after a step to ``slope``."""
    factor = 1.0 - slope / before
    return retained * (factor if factor > 0.0 else 0.5)


@kernel()
def ridge_point(
    theta: float, z: float, window: float, placement: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, bool]:
    """Where phi has a ridge near z on an azimuth: B falls through zero. Also returns whether there is one.

    By Newton's method while that converges close by; else it is bracketed, and then found by regula falsi with every
    third step a bisection.
    """
    at, before = z, 2.0 * window
    for _ in range(RIDGE_STEPS):
        set_jet(theta, at, placement, bolt, nut, jet)
        if not jet[TJ_ZZ] < 0.0:
            break
        step = -jet[TJ_B] / jet[TJ_ZZ]
        if abs(jet[TJ_B]) <= SLOPE_LEFT or abs(step) <= STEP_LEFT * bolt[pk.P]:
            return at, True
        if not abs(step) < CONVERGING * before:
            break
        at += step
        before = abs(step)
        if abs(at - z) > window:
            break
    w, b_low, b_high = ridge_bracket(theta, z, window, placement, bolt, nut, jet)
    if w == 0.0:
        return z, False
    low, high = z - w, z + w
    side, i = 0, 0
    while True:
        middle = 0.5 * (low + high)
        at = middle if i % 3 == 2 else (low * b_high - high * b_low) / (b_high - b_low)
        if not low < at < high:
            at = middle
        set_jet(theta, at, placement, bolt, nut, jet)
        b = jet[TJ_B]
        if abs(b) <= SLOPE_LEFT or not low < middle < high:
            return at, True
        if b > 0.0:
            if side > 0:
                b_high = reduced(b, b_high, b_low)
            low, b_low, side = at, b, 1
        else:
            if side < 0:
                b_low = reduced(b, b_low, b_high)
            high, b_high, side = at, b, -1
        i += 1


@kernel()
def ridge_maximum(
    theta: float,
    z: float,
    base: float,
    step: float,
    lowest: float,
    placement: Array,
    bolt: Array,
    nut: Array,
    jet: Array,
) -> tuple[float, float, int]:
    """The highest point of phi along the ridge near (theta, z), by steps in azimuth uphill and then by regula falsi.

    Along the ridge A falls through zero there. At each azimuth the ridge is looked for within a window of where its
    tangent at the point before leads, or of the line between two ridge points. A maximum counts from ``lowest`` on.
    Also returns what there is.
    """
    k = bolt[pk.LEAD] / TWO_PI
    window = FIRST_WINDOW * bolt[pk.P]
    z, found = ridge_point(theta, z, window, placement, bolt, nut, jet)
    if not found:
        return theta, z, NO_RIDGE
    slope = jet[TJ_A]
    if jet[TJ_PHI] + MAX_RIDGE_STEPS * step * abs(slope) < lowest:
        return theta, z, TOO_LOW
    uphill = math.copysign(step, slope)
    after, z_after, after_slope = theta, z, slope
    for _ in range(MAX_RIDGE_STEPS):
        lean = -jet[TJ_UZ] / jet[TJ_ZZ] if jet[TJ_ZZ] < 0.0 else 0.0
        after, z_after = theta + uphill, z + k * uphill + min(max(lean * uphill, -window), window)
        z_after, found = ridge_point(after, z_after, window, placement, bolt, nut, jet)
        if not found:
            return theta, z, NONE
        after_slope = jet[TJ_A]
        if not after_slope * uphill > 0.0:
            break
        if base + z_after <= 0.0 or jet[TJ_Z] >= 0.0:
            return after, z_after, OUTSIDE
        theta, z, slope = after, z_after, after_slope
    if after_slope * uphill > 0.0:
        return theta, z, RISING
    side, i = 0, 0
    while True:
        part = 0.5 if i % 3 == 2 else slope / (slope - after_slope)
        at = theta + part * (after - theta)
        z_at, found = ridge_point(at, z + part * (z_after - z), window, placement, bolt, nut, jet)
        if not found:
            return theta, z, NONE
        a = jet[TJ_A]
        if abs(after - theta) < NARROW_AZIMUTHS or abs(a) <= SLOPE_LEFT * bolt[pk.R_MAJOR]:
            return at, z_at, MAXIMUM
        if a * uphill > 0.0:
            if side > 0:
                after_slope = reduced(a, after_slope, slope)
            theta, z, slope, side = at, z_at, a, 1
        else:
            if side < 0:
                slope = reduced(a, slope, after_slope)
            after, z_after, after_slope, side = at, z_at, a, -1
        i += 1


@kernel()
def thread_maximum(
    theta: float, z: float, base: float, lowest: float, placement: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, float, int]:
    """The maximum of phi over the bolt's thread that is near a point of a ridge, and what there is.

    By Newton's method, and where phi is not curved downwards there, as beside a fillet, by steps along the ridge: long
    ones, and short ones from where it ends between two of these; where it is shorter than these, by Newton's method
    from the ridge. A maximum counts from ``lowest`` on.
    """
    at, up, converged = nearby_maximum(theta, z, 0.0, placement, bolt, nut, jet)
    if converged:
        return at, up, MAXIMUM
    at, up, kind = ridge_maximum(theta, z, base, FIRST_RIDGE_STEP, lowest, placement, bolt, nut, jet)
    if kind == NONE:
        at, up, kind = ridge_maximum(at, up, base, LATER_RIDGE_STEP, lowest, placement, bolt, nut, jet)
    if kind == NONE:
        at, up, converged = nearby_maximum(at, up, 0.0, placement, bolt, nut, jet)
        return at, up, MAXIMUM if converged else NONE
    set_jet(at, up, placement, bolt, nut, jet)
    return at, up, kind


@kernel()
def ridge_within(
    theta: float, z: float, inward: float, placement: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, bool]:
    """The ridge on an azimuth within the threads, from an edge's height on, and whether there is one close by.

    About the edge itself none need be bracketed: beyond it the thread that it ends may rise as well.
    """
    set_jet(theta, z, placement, bolt, nut, jet)
    low, rises, way = z, inward * jet[TJ_B] > 0.0, WITHIN * bolt[pk.R_MAJOR]
    while way < FIRST_WINDOW * bolt[pk.P]:
        high = z + inward * way
        set_jet(theta, high, placement, bolt, nut, jet)
        if rises and inward * jet[TJ_B] < 0.0:
            for _ in range(BISECTIONS):
                middle = 0.5 * (low + high)
                set_jet(theta, middle, placement, bolt, nut, jet)
                if inward * jet[TJ_B] > 0.0:
                    low = middle
                else:
                    high = middle
            return 0.5 * (low + high), True
        low, rises = high, inward * jet[TJ_B] > 0.0
        way *= 2.0
    return z, False


@kernel()
def maximum_within(
    theta: float,
    z: float,
    inward: float,
    rise: float,
    lowest: float,
    placement: Array,
    bolt: Array,
    nut: Array,
    jet: Array,
) -> tuple[float, float, int]:
    """As :func:`thread_maximum`, one near a place of an edge, from which phi has the slope ``rise`` into both threads.

    ``inward`` is 1 where they are up the bolt's axis from there, -1 where they are down it. It is looked for from the
    edge where phi rises there; where it falls, or rises but little and there is none, from ridges within on that
    azimuth and on those beside it, and from just within.
    """
    if rise > 0.0:
        at, up, kind = thread_maximum(theta, z, 0.0, lowest, placement, bolt, nut, jet)
        if kind == MAXIMUM or rise > SLIGHT_SLOPE:
            return at, up, kind
    for turn in AZIMUTHS_BESIDE:
        if abs(rise) > SLIGHTEST_SLOPE and turn != 0.0:
            break
        ridge, is_near = ridge_within(theta + turn, z, inward, placement, bolt, nut, jet)
        if is_near:
            at, up, kind = thread_maximum(theta + turn, ridge, 0.0, lowest, placement, bolt, nut, jet)
            if kind == MAXIMUM:
                return at, up, kind
    within = z + inward * WITHIN * bolt[pk.R_MAJOR]
    return thread_maximum(theta, within, 0.0, lowest, placement, bolt, nut, jet)


@kernel()
def polished_maximum(
    theta: float, z: float, placement: Array, bolt: Array, nut: Array, jet: Array
) -> tuple[float, float, bool]:
    """A maximum of phi over the bolt's thread to the last digits, from one that is near; whether it is a maximum.

    ``jet`` is that of the point from which it goes, and then that of the maximum.
    """
    from_theta, from_z = theta, z
    p = bolt[pk.P]
    left = math.inf
    for _ in range(POLISH_STEPS):
        a, b, uu, uz, zz = jet[TJ_A], jet[TJ_B], jet[TJ_UU], jet[TJ_UZ], jet[TJ_ZZ]
        determinant = uu * zz - uz * uz
        if not (zz < 0.0 and determinant > 0.0):
            return theta, z, False
        du = (uz * b - zz * a) / determinant
        dz = (uz * a - uu * b) / determinant
        theta += du
        z += bolt[pk.LEAD] / TWO_PI * du + dz
        if abs(theta - from_theta) > 0.05 or abs(z - from_z) > 0.05 * p:
            return theta, z, False
        set_jet(theta, z, placement, bolt, nut, jet)
        left = max(abs(du), abs(dz) / p)
        if left < POLISHED:
            break
    return theta, z, left < POLISHED_NEAR
