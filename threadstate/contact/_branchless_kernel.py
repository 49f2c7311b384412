"""Elementary functions without branches or library calls, so that loops over many arguments become vector instructions.

They serve bounds and brackets, never a result: each is accurate to a few units of 1e-15, ``coarse_azimuth`` to 1e-9.
NaN stays NaN: an unknown bound must exclude nothing.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]
Numbers = tuple[float, ...]

VECTOR_WIDTH = 4
"""Boxes and columns are processed in groups of this size: of vectors of so many doubles LLVM makes loops, with AVX-512
too."""

TWO_OVER_PI = 2.0 / math.pi
HALF_PI_HIGH = 1.5707963267341256
HALF_PI_LOW = 6.077100506506192e-11
"""A quarter turn in two parts, of which the first has few enough digits that small multiples of it are exact."""

SINE = tuple((-1.0) ** n / math.factorial(2 * n + 1) for n in range(8))
COSINE = tuple((-1.0) ** n / math.factorial(2 * n) for n in range(9))
ARC_TANGENT = (
    0.9999999999999981,
    -0.333333333332038,
    0.1999999997945624,
    -0.14285712905593942,
    0.11111061695593873,
    -0.09089857935461004,
    0.07678292623160822,
    -0.06547173662587889,
    0.05235714228376474,
    -0.031214975598123744,
    0.0069422257580898546,
)
"""Coefficients of atan(t) / t in powers of t^2 up to tan(pi / 8), Chebyshev interpolation: error at most 2e-15."""

COARSE_ARC_TANGENT = (
    0.9999999995535374,
    -0.3333332248891262,
    0.1999955810042456,
    -0.142785760257065,
    0.11050771281994035,
    -0.08785043305631318,
    0.06685281570644816,
    -0.04392841146790397,
    0.021912946480916233,
    -0.007030669755244828,
    0.001057607494003086,
)
"""The same up to tan(pi / 4): error at most 3e-10."""

ROUNDING_SHIFT = 1.5 * 2.0**52
"""Adding and subtracting it rounds to the nearest integer."""
TINY = 1e-300


@kernel(contract=True, forceinline=True)
def sine_cosine(x: float) -> tuple[float, float]:
    """Sine and cosine of an angle of a few turns at most (rad): Taylor series about the nearest quarter turn."""
    n = (x * TWO_OVER_PI + ROUNDING_SHIFT) - ROUNDING_SHIFT
    r = (x - n * HALF_PI_HIGH) - n * HALF_PI_LOW
    w = r * r
    s = SINE[6] + w * SINE[7]
    s = SINE[5] + w * s
    s = SINE[4] + w * s
    s = SINE[3] + w * s
    s = SINE[2] + w * s
    s = SINE[1] + w * s
    s = r + r * w * s
    c = COSINE[7] + w * COSINE[8]
    c = COSINE[6] + w * c
    c = COSINE[5] + w * c
    c = COSINE[4] + w * c
    c = COSINE[3] + w * c
    c = COSINE[2] + w * c
    c = 1.0 - 0.5 * w + w * w * c
    quarter = n - 4.0 * np.floor(0.25 * n)
    odd = quarter == 1.0 or quarter == 3.0
    sine = c if odd else s
    cosine = s if odd else c
    return (-sine if quarter >= 2.0 else sine), (-cosine if quarter == 1.0 or quarter == 2.0 else cosine)


@kernel(contract=True, forceinline=True)
def azimuth(x: float, y: float, r: float) -> float:
    """``atan2(y, x)`` where ``r`` is the length of (x, y): a polynomial of the tangent of a quarter of it."""
    t = abs(y) / (r + abs(x))
    t = t / (1.0 + math.sqrt(1.0 + t * t))
    w = t * t
    a = ARC_TANGENT[9] + w * ARC_TANGENT[10]
    a = ARC_TANGENT[8] + w * a
    a = ARC_TANGENT[7] + w * a
    a = ARC_TANGENT[6] + w * a
    a = ARC_TANGENT[5] + w * a
    a = ARC_TANGENT[4] + w * a
    a = ARC_TANGENT[3] + w * a
    a = ARC_TANGENT[2] + w * a
    a = ARC_TANGENT[1] + w * a
    a = 4.0 * t * (ARC_TANGENT[0] + w * a)
    a = math.pi - a if x < 0.0 else a
    return -a if y < 0.0 else a


@kernel(contract=True, forceinline=True)
def coarse_azimuth(x: float, y: float, r: float) -> tuple[float, float]:
    """``atan2(y, x)`` to 1e-9 where ``r`` is the length of (x, y), for searches; and 1 / ``r`` of the same division."""
    longer = r + abs(x)
    inverse = 1.0 / (r * longer)
    t = abs(y) * r * inverse
    w = t * t
    v = w * w
    even = COARSE_ARC_TANGENT[8] + v * COARSE_ARC_TANGENT[10]
    even = COARSE_ARC_TANGENT[6] + v * even
    even = COARSE_ARC_TANGENT[4] + v * even
    even = COARSE_ARC_TANGENT[2] + v * even
    even = COARSE_ARC_TANGENT[0] + v * even
    odd = COARSE_ARC_TANGENT[7] + v * COARSE_ARC_TANGENT[9]
    odd = COARSE_ARC_TANGENT[5] + v * odd
    odd = COARSE_ARC_TANGENT[3] + v * odd
    odd = COARSE_ARC_TANGENT[1] + v * odd
    a = 2.0 * t * (even + w * odd)
    a = math.pi - a if x < 0.0 else a
    return (-a if y < 0.0 else a), longer * inverse


@kernel(contract=True, forceinline=True)
def larger(x: float, y: float) -> float:
    """The larger of two numbers, a single instruction: NaN where ``y`` is, and ``y`` where ``x`` alone is.

    Of two bounds on a number either may be ``x``: where it is not known the other one holds. Else ``y`` is what may be
    NaN, or both are.
    """
    return x if x > y else y


@kernel(contract=True, forceinline=True)
def smaller(x: float, y: float) -> float:
    """The smaller of two numbers, as :func:`larger`."""
    return x if x < y else y


@kernel(contract=True, forceinline=True)
def larger_or_nan(x: float, y: float) -> float:
    """The larger of two numbers; NaN where either is."""
    return x if x > y or math.isnan(x) else y


@kernel(contract=True, forceinline=True)
def smaller_or_nan(x: float, y: float) -> float:
    """The smaller of two numbers; NaN where either is."""
    return x if x < y or math.isnan(x) else y


@kernel(contract=True, forceinline=True)
def profile_numbers(profile: Array) -> Numbers:
    """The parameters of a packed profile that :func:`radius_and_slope` and :func:`second_derivative_range` take.

    Those of the rising half period, those of the falling one, then what both share.
    """
    p = profile[pk.P]
    root, width = profile[pk.S_ROOT], profile[pk.S_CREST] - profile[pk.S_ROOT]
    return (
        profile[pk.U_FLAT],
        profile[pk.U_FLANK],
        profile[pk.COT],
        profile[pk.U_CREST],
        profile[pk.U_TOP],
        profile[pk.U_FAR_FLAT],
        profile[pk.U_FAR_TOP],
        profile[pk.U_FLAT + pk.FALLING],
        profile[pk.U_FLANK + pk.FALLING],
        profile[pk.COT + pk.FALLING],
        profile[pk.U_CREST + pk.FALLING],
        profile[pk.U_TOP + pk.FALLING],
        profile[pk.U_FAR_FLAT + pk.FALLING],
        profile[pk.U_FAR_TOP + pk.FALLING],
        p,
        1.0 / p,
        -root / p,
        width,
        width - p,
        root,
        root + p,
        0.5 * p - root,
        -(0.5 * p + root),
        profile[pk.R_PITCH],
        profile[pk.R_MINOR] + profile[pk.RHO_MINOR],
        profile[pk.R_MAJOR] - profile[pk.RHO_MAJOR],
        profile[pk.RHO_MINOR] * profile[pk.RHO_MINOR],
        profile[pk.RHO_MAJOR] * profile[pk.RHO_MAJOR],
        profile[pk.F2_LEAST],
        profile[pk.F2_GREATEST],
        profile[pk.U_REACH_FLAT],
        profile[pk.U_REACH_TOP],
        profile[pk.U_REACH_FLAT + pk.FALLING],
        profile[pk.U_REACH_TOP + pk.FALLING],
    )


@kernel(contract=True, forceinline=True)
def radius_and_slope(s: float, numbers: Numbers) -> tuple[float, float, float, bool]:
    """The profile's radius and slope at ``s``, the coordinate ``u`` of its half period, and whether that rises."""
    p, inverse_p, shift, width, beyond = numbers[14:19]
    r_pitch, low_middle, high_middle, minor2, major2 = numbers[23:28]
    turns = s * inverse_p + shift
    # From the middle of the groove, -p/2 to p/2.
    q = (turns - ((turns + ROUNDING_SHIFT) - ROUNDING_SHIFT)) * p
    ahead = q > 0.0
    rises = q < (width if ahead else beyond)
    u = q + (numbers[19] if ahead else numbers[20]) if rises else (numbers[21] if ahead else numbers[22]) - q
    u_flat = numbers[0] if rises else numbers[7]
    u_flank = numbers[1] if rises else numbers[8]
    cot = numbers[2] if rises else numbers[9]
    u_crest = numbers[3] if rises else numbers[10]
    u_top = numbers[4] if rises else numbers[11]
    low = u < 0.5 * (u_flank + u_crest)
    du = u - u_flat if low else u_top - u
    du = 0.0 if du <= 0.0 else du
    # On the flank, and at a corner without a fillet, this may be negative: the flank's own values replace it below.
    radicand = (minor2 if low else major2) - du * du
    c = math.sqrt(TINY if radicand <= TINY else radicand)
    slope = du / c
    radius = low_middle - c if low else high_middle + c
    on_flank = slope >= cot
    radius = r_pitch + u * cot if on_flank else radius
    slope = cot if on_flank else slope
    return radius, (slope if rises else -slope), u, rises


@kernel(contract=True, forceinline=True)
def slope_change_limit(slope: float, u: float, reach: float, rises: bool, numbers: Numbers) -> float:
    """How far ``f'`` can be from the ``slope`` at ``u`` of a half period within ``reach``, however it bends there.

    Within a half period, and up to the other one's fillets, its size is between 0 and that of the flank's slope.
    """
    start = numbers[30] if rises else numbers[32]
    end = numbers[31] if rises else numbers[33]
    cot = numbers[2] if rises else numbers[9]
    size = abs(slope)
    is_within = u - reach >= start and u + reach <= end
    return larger(size, cot - size) if is_within else larger(numbers[2], numbers[9]) + size


class ProfileCourse(NamedTuple):
    """What a profile does within reach of a place, as differences from its tangent there.

    ``slope_low`` to ``slope_high`` is the range of what ``f'`` differs by, ``low`` to ``high`` that of ``f``.
    """

    slope_low: float
    slope_high: float
    low: float
    high: float


@kernel(contract=True, forceinline=True)
def course_over(radius: float, slope: float, u: float, reach: float, rises: bool, numbers: Numbers) -> ProfileCourse:
    """The course of a profile within ``reach`` of ``u`` of a half period, where its ``radius`` and ``slope`` are these.

    ``f`` is unbounded where the reach is longer than a half period. docs/certificate.md, section 3, says why the ends
    decide.
    """
    p, width = numbers[14], numbers[17]
    u_flank = numbers[1] if rises else numbers[8]
    cot = numbers[2] if rises else numbers[9]
    u_crest = numbers[3] if rises else numbers[10]
    start = numbers[30] if rises else numbers[32]
    end = numbers[31] if rises else numbers[33]
    s = u if rises else 0.5 * p - u
    forward = reach if rises else -reach
    f_after, slope_after, _, _ = radius_and_slope(s + forward, numbers)
    f_before, slope_before, _, _ = radius_and_slope(s - forward, numbers)
    slope_after = slope_after if rises else -slope_after
    slope_before = slope_before if rises else -slope_before
    size = abs(slope)
    # The slope grows up to the flank and falls from it, down to minus that of the other half's flank.
    is_bounded = reach <= smaller(width, p - width)
    is_within = u - reach >= start and u + reach <= end
    steepest = slope_before if is_bounded and u - reach >= u_crest else cot
    steepest = slope_after if is_bounded and u + reach <= u_flank else steepest
    flattest = smaller(slope_before, slope_after) if is_within else -larger(numbers[2], numbers[9])
    change_low, change_high = smaller(0.0, flattest - size), larger(0.0, steepest - size)
    after = f_after - radius - size * reach
    before = f_before - radius + size * reach
    high = 0.0 if u >= u_crest else (after if slope_after >= size else (cot - size) * reach)
    low = 0.0 if u <= u_flank else (before if slope_before >= size else (size - cot) * reach)
    return ProfileCourse(
        change_low if rises else -change_high,
        change_high if rises else -change_low,
        smaller(0.0, smaller(low, after)) if is_bounded else -math.inf,
        larger(0.0, larger(high, before)) if is_bounded else math.inf,
    )


@kernel(contract=True, forceinline=True)
def fillet_second_derivative(d: float, rho2: float, least: float) -> float:
    """The size of f'' on a fillet of squared radius ``rho2`` at ``d`` from its flat; ``least`` ends it at the flank."""
    d = 0.0 if d <= 0.0 else d
    radicand = rho2 - d * d
    radicand = rho2 * least if radicand <= rho2 * least else radicand
    return rho2 / (radicand * math.sqrt(radicand))


@kernel(contract=True, forceinline=True)
def second_derivative_range(u: float, reach: float, rises: bool, numbers: Numbers) -> tuple[float, float]:
    """Smallest and largest ``f''`` within ``reach`` of ``u`` of a half period; NaN at a corner without a fillet, or of
    NaN.

    On the small fillet f'' grows towards the flank, on the large one it falls from it: the extremes are at the ends.
    """
    minor2, major2 = numbers[26:28]
    u_flat = numbers[0] if rises else numbers[7]
    u_flank = numbers[1] if rises else numbers[8]
    cot = numbers[2] if rises else numbers[9]
    u_crest = numbers[3] if rises else numbers[10]
    u_top = numbers[4] if rises else numbers[11]
    far_flat = numbers[5] if rises else numbers[12]
    far_top = numbers[6] if rises else numbers[13]
    first = u - reach
    last = u + reach
    on_minor = last > u_flat and first < u_flank
    on_major = first < u_top and last > u_crest
    # At the flank a fillet's slope is cot: there rho^2 - d^2 is rho^2 / (1 + cot^2), and not less anywhere on it.
    least = 1.0 / (1.0 + cot * cot)
    high = fillet_second_derivative(last - u_flat if on_minor else u_top - last, minor2 if on_minor else major2, least)
    high = high if on_minor else (-high if first >= u_crest and last <= u_top else 0.0)
    low = fillet_second_derivative(u_top - first if on_major else first - u_flat, major2 if on_major else minor2, least)
    low = -low if on_major else (low if first >= u_flat and last <= u_flank else 0.0)
    either = first < far_flat or last > far_top
    low = numbers[28] if either else low
    high = numbers[29] if either else high
    known = first <= last
    return (low if known else math.nan), (high if known else math.nan)
