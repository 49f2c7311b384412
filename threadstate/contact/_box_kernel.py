"""Branch and bound: the classification of boxes of azimuth and time by whether an onset can lie in them.

The curve is in the solid where min(g, phi) >= 0. A new arc of it enters at an *onset*, where that minimum has a local
maximum over theta that rises through zero: at an edge on edge (g = phi = 0, opposite slopes), at a tangency with the
thread (phi = phi_theta = 0, phi_thetatheta < 0) or with the plane (g = g_theta = 0). Where the ranges of these
functions over a box admit no onset of any kind the box is excluded.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import larger, larger_or_nan, profile_numbers, smaller
from threadstate.contact._frame_kernel import motion_numbers
from threadstate.contact._range_kernel import Ranges, error_beside, ranges, size_numbers
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# Boxes are stored column by column in a flat buffer of that capacity: middle and half-width of theta, start and end of
# tau, class, min(g, phi) in the middle, range of phi_thetatheta, least g; then g and phi in the
# middle as differences from a contact, and its distance, NaN where they are not given (``_beside_kernel``); whether an
# undecided box is to be split by time (1) or by azimuth (0); and what min(g, phi) is at most.
CAPACITY = 64
COLUMN = CAPACITY + 16
"""Distance of columns: a power of two would have the same rows of all of them compete for the same lines of a cache."""
X_THETA = 0
X_HALF = COLUMN
X_START = 2 * COLUMN
X_END = 3 * COLUMN
X_CLASS = 4 * COLUMN
X_DEPTH = 5 * COLUMN
X_BEND_LOW = 6 * COLUMN
X_BEND_HIGH = 7 * COLUMN
X_G_LOW = 8 * COLUMN
X_G_BESIDE = 9 * COLUMN
X_PHI_BESIDE = 10 * COLUMN
X_GAP = 11 * COLUMN
X_BY_TIME = 12 * COLUMN
X_DEEPEST = 13 * COLUMN
BOXES_SIZE = 14 * COLUMN

# Classes, in this order: no onset and no point inside; no onset (excluded); at most one onset, on the edge, the thread
# or the plane; at most one peak of min(g, phi) at each time, of that kind, but whether and when it rises through zero
# is undecided (a point of the curve that stays in contact is such a peak); undecided.
ALL_OUTSIDE, EXCLUDED, ONE_EDGE, ONE_THREAD, ONE_PLANE, PEAK_EDGE, PEAK_THREAD, PEAK_PLANE, UNDECIDED_BOX = (
    0.0,
    1.0,
    2.0,
    3.0,
    4.0,
    5.0,
    6.0,
    7.0,
    8.0,
)

OVERLAP = 2.0**-51
"""A box is evaluated longer by so much of its time: neighbours overlap though the middle and half of it are rounded."""


class Sizes(NamedTuple):
    """Bounds over a box on the sizes of g's or phi's second derivatives by theta, and by theta and tau.

    Then on how far the first derivatives by theta and tau vary from the middle.
    """

    tt: float
    tv: float
    theta_var: float
    tau_var: float


@kernel(contract=True, forceinline=True)
def sizes_over(a: float, b: float, of_one: Ranges) -> Sizes:
    """The sizes of g's or phi's derivatives over a box."""
    tt = larger_or_nan(of_one.tt_high, -of_one.tt_low)
    tv = abs(of_one.tv) + of_one.tv_var
    return Sizes(
        tt,
        tv,
        smaller(tt * a + tv * b + of_one.theta_error, of_one.theta_change),
        smaller(tv * a + of_one.vv * b + of_one.tau_error, of_one.tau_change),
    )


@kernel(contract=True, forceinline=True)
def phi_over(a: float, b: float, phi: Ranges, size: Sizes) -> tuple[float, float, float, float]:
    """The least and the largest phi in a box; bounds on its slope by theta, and on how far time changes it."""
    theta_bound = abs(phi.by_theta) + phi.theta_error + size.tv * b
    peak_offset = smaller(theta_bound / -phi.tt_high if phi.tt_high < 0.0 else a, a)
    time_change = abs(phi.by_tau) * b + smaller(phi.tau_error + 0.5 * phi.vv * b, phi.tau_change) * b
    azimuth_change = (abs(phi.by_theta) + phi.theta_change) * a
    rise = theta_bound * peak_offset + 0.5 * phi.tt_high * peak_offset * peak_offset
    fall = theta_bound * a - 0.5 * smaller(0.0, phi.tt_low) * a * a
    linear_change = (abs(phi.by_theta) + phi.theta_error) * a + (abs(phi.by_tau) + phi.tau_error) * b
    high = phi.value + smaller(time_change + smaller(rise, azimuth_change), linear_change + phi.above) + phi.error
    low = phi.value - smaller(time_change + smaller(fall, azimuth_change), linear_change + phi.below) - phi.error
    return low, high, theta_bound, time_change


@kernel(contract=True, forceinline=True)
def g_over(a: float, b: float, g: Ranges, size: Sizes) -> tuple[float, float]:
    """The least and the largest g in a box."""
    time_change = (abs(g.by_tau) + g.tau_error) * b + 0.5 * g.vv * b * b
    azimuth_change = (abs(g.by_theta) + g.theta_change) * a
    linear_change = (abs(g.by_theta) + g.theta_error) * a + size.tv * a * b
    rise = linear_change + 0.5 * larger(0.0, g.tt_high) * a * a
    fall = linear_change - 0.5 * smaller(0.0, g.tt_low) * a * a
    high = g.value + time_change + smaller(rise, azimuth_change) + g.error
    low = g.value - time_change - smaller(fall, azimuth_change) - g.error
    return low, high


@kernel(contract=True, forceinline=True)
def jacobian(phi: Ranges, g: Ranges, phi_size: Sizes, g_size: Sizes) -> tuple[float, float]:
    """The determinant of the derivatives of (g, phi) in the middle of a box, and how far it varies over the box."""
    jac = g.by_tau * phi.by_theta - phi.by_tau * g.by_theta
    jac_var = (
        g_size.tau_var * (abs(phi.by_theta) + phi_size.theta_var)
        + abs(g.by_tau) * phi_size.theta_var
        + phi_size.tau_var * (abs(g.by_theta) + g_size.theta_var)
        + abs(phi.by_tau) * g_size.theta_var
    )
    return jac, jac_var


@kernel(contract=True, forceinline=True)
def remainders(a: float, b: float, phi: Ranges, g: Ranges, phi_size: Sizes, g_size: Sizes) -> tuple[float, float]:
    """What phi and g may differ by, in a box, from their linear expansions."""
    of_g = (
        smaller(0.5 * g_size.tt * a + g_size.tv * b + g.theta_error, g.theta_change) * a
        + (0.5 * g.vv * b + g.tau_error) * b
        + g.error
    )
    of_phi = (
        smaller(
            (0.5 * phi_size.tt * a + phi_size.tv * b + phi.theta_error) * a + (0.5 * phi.vv * b + phi.tau_error) * b,
            smaller(
                phi.theta_change * a + phi.tau_change * b,
                larger(phi.above, phi.below) + phi.theta_error * a + phi.tau_error * b,
            ),
        )
        + phi.error
    )
    return of_phi, of_g


@kernel(contract=True, forceinline=True)
def excludes_edge_root(a: float, b: float, phi: Ranges, g: Ranges, jac: float, of_phi: float, of_g: float) -> bool:
    """Whether the linear expansions of g and phi with their remainders exclude a common zero in a box."""
    return abs(g.value * phi.by_tau - phi.value * g.by_tau) > a * abs(jac) + of_g * abs(phi.by_tau) + of_phi * abs(
        g.by_tau
    ) or abs(g.value * phi.by_theta - phi.value * g.by_theta) > b * abs(jac) + of_g * abs(phi.by_theta) + of_phi * abs(
        g.by_theta
    )


@kernel(contract=True, forceinline=True)
def tangency(a: float, b: float, of_one: Ranges, remainder: float) -> tuple[bool, bool]:
    """Whether the linear expansions of a function and of its slope exclude a common zero in a box.

    Then whether the time blurs the height of a peak more than the azimuth. ``remainder`` is what the function may
    differ by from its expansion.
    """
    value, slope, rate = of_one.value, of_one.by_theta, of_one.by_tau
    tt_low, tt_high, tv_mid, tv_var = of_one.tt_low, of_one.tt_high, of_one.tv, of_one.tv_var
    tt_mid, tt_var = 0.5 * (tt_low + tt_high), 0.5 * (tt_high - tt_low)
    slope_remainder = tt_var * a + tv_var * b + of_one.theta_error
    det = slope * tv_mid - rate * tt_mid
    excluded = abs(rate * slope - value * tv_mid) > a * abs(det) + remainder * abs(tv_mid) + slope_remainder * abs(
        rate
    ) or abs(tt_mid * value - slope * slope) > b * abs(det) + remainder * abs(tt_mid) + slope_remainder * abs(slope)
    by_time = b * (abs(det) + 0.5 * of_one.vv * b * abs(tt_mid) + tv_var * abs(slope))
    by_theta = a * (
        (0.5 * larger(tt_high, -tt_low) * a + (abs(tv_mid) + tv_var) * b) * abs(tt_mid) + tt_var * abs(slope)
    )
    return excluded, by_time > by_theta


@kernel(contract=True, forceinline=True)
def splits_edge_by_time(a: float, b: float, phi: Ranges, g: Ranges, phi_size: Sizes, g_size: Sizes, jac: float) -> bool:
    """Whether the time blurs the height of a peak on the edge more than the azimuth."""
    by_time = b * abs(jac) + 0.5 * b * b * (g.vv * abs(phi.by_theta) + phi.vv * abs(g.by_theta))
    by_theta = a * (
        (0.5 * g_size.tt * a + g_size.tv * b) * abs(phi.by_theta)
        + (0.5 * phi_size.tt * a + phi_size.tv * b) * abs(g.by_theta)
    )
    return by_time > by_theta


@kernel(contract=True, forceinline=True)
def splits_by_time(
    a: float,
    b: float,
    phi: Ranges,
    g: Ranges,
    phi_size: Sizes,
    g_size: Sizes,
    weights: tuple[float, float],
    theta_bound: float,
    time_change: float,
) -> bool:
    """Whether the time adds more than the azimuth to the relative uncertainty of g, phi and their slopes.

    ``weights`` are 0 or 1 for phi and g; ``theta_bound`` and ``time_change`` are phi's (:func:`phi_over`).
    """
    phi_weight, g_weight = weights
    size_phi, size_phi_theta = abs(phi.value) + 1e-30, abs(phi.by_theta) + 1e-30
    size_g, size_g_theta = abs(g.value) + 1e-30, abs(g.by_theta) + 1e-30
    phi_value_weight = phi_weight * size_phi_theta * size_g * size_g_theta
    phi_slope_weight = phi_weight * size_phi * size_g * size_g_theta
    g_value_weight = g_weight * size_phi * size_phi_theta * size_g_theta
    g_slope_weight = g_weight * size_phi * size_phi_theta * size_g
    by_theta = (
        theta_bound * phi_value_weight
        + phi_size.tt * phi_slope_weight
        + abs(g.by_theta) * g_value_weight
        + g_size.tt * g_slope_weight
    ) * a
    by_time = (
        time_change * phi_value_weight
        + phi_size.tv * b * phi_slope_weight
        + abs(g.by_tau) * b * g_value_weight
        + g_size.tv * b * g_slope_weight
    )
    return by_time > by_theta


@kernel(contract=True, forceinline=True)
def classify_box(
    a: float, b: float, phi: Ranges, g: Ranges, depth: float, p: float
) -> tuple[float, float, float, float]:
    """The class of a box with half-widths ``a`` (theta) and ``b`` (tau) from its :func:`ranges`, the least g in it,
    whether to split it by time (1) or by azimuth (0) where that leaves it undecided, and what min(g, phi) is at most.

    It is split by the variable that contributes more to the uncertainty of a peak's height, or else to the relative
    uncertainty of the undecided functions. The function is long: it is the list of the cases, each named once.
    """
    phi_size, g_size = sizes_over(a, b, phi), sizes_over(a, b, g)
    phi_low, phi_high, theta_bound, time_change = phi_over(a, b, phi, phi_size)
    g_low, g_high = g_over(a, b, g, g_size)
    phi_monotonic = abs(phi.by_theta) > phi_size.theta_var or phi.theta_low > 0.0 or phi.theta_high < 0.0
    g_monotonic = abs(g.by_theta) > g_size.theta_var
    all_outside = phi_high < 0.0 or g_high < 0.0 or depth > p
    jac, jac_var = jacobian(phi, g, phi_size, g_size)
    remainder_phi, remainder_g = remainders(a, b, phi, g, phi_size, g_size)
    edge_root_excluded = excludes_edge_root(a, b, phi, g, jac, remainder_phi, remainder_g)
    thread_root_excluded, thread_by_time = tangency(a, b, phi, remainder_phi)
    plane_root_excluded, plane_by_time = tangency(a, b, g, remainder_g)
    # At most one onset: the peak is unique, and rises or falls at all times.
    peak_edge = phi_monotonic and g_monotonic
    peak_thread = g_low > 0.0 and phi.tt_high < 0.0
    peak_plane = phi_low > 0.0 and g.tt_high < 0.0
    one_edge = peak_edge and abs(jac) > jac_var
    one_thread = peak_thread and abs(phi.by_tau) > phi_size.tau_var
    one_plane = peak_plane and abs(g.by_tau) > g_size.tau_var
    edge_peak_sinks = one_edge and jac * (phi.by_theta - g.by_theta) < 0.0
    thread_peak_is_open = phi.value - (phi.by_tau + phi.tau_error + 0.5 * phi.vv * b) * b > phi.error
    plane_peak_is_open = g.value - (g.by_tau + g.tau_error + 0.5 * g.vv * b) * b > g.error
    thread_peak_no_onset = one_thread and (phi.by_tau < 0.0 or thread_peak_is_open)
    plane_peak_no_onset = one_plane and (g.by_tau < 0.0 or plane_peak_is_open)
    no_edge = (
        g_low > 0.0
        or phi_low > 0.0
        or (peak_edge and phi.by_theta * g.by_theta > 0.0)
        or edge_root_excluded
        or edge_peak_sinks
    )
    no_thread = phi_monotonic or phi.tt_low > 0.0 or phi_low > 0.0 or thread_peak_no_onset or thread_root_excluded
    no_plane = g_monotonic or g.tt_low > 0.0 or g_low > 0.0 or plane_peak_no_onset or plane_root_excluded
    excluded = no_edge and no_thread and no_plane
    weights = (
        0.0 if phi_monotonic and not g_monotonic else 1.0,
        0.0 if g_low > 0.0 or (g_monotonic and not phi_monotonic) else 1.0,
    )
    by_time = splits_by_time(a, b, phi, g, phi_size, g_size, weights, theta_bound, time_change)
    by_time = plane_by_time if peak_plane else by_time
    by_time = thread_by_time if peak_thread else by_time
    by_time = splits_edge_by_time(a, b, phi, g, phi_size, g_size, jac) if peak_edge else by_time
    box_class = PEAK_PLANE if peak_plane else UNDECIDED_BOX
    box_class = PEAK_THREAD if peak_thread else box_class
    box_class = PEAK_EDGE if peak_edge else box_class
    box_class = ONE_PLANE if one_plane else box_class
    box_class = ONE_THREAD if one_thread else box_class
    box_class = ONE_EDGE if one_edge else box_class
    box_class = EXCLUDED if excluded else box_class
    return ALL_OUTSIDE if all_outside else box_class, g_low, 1.0 if by_time else 0.0, smaller(phi_high, g_high)


@kernel(contract=True, forceinline=True)
def with_value(of_one: Ranges, value: float, error: float) -> Ranges:
    """Ranges of which the value in the middle and its error are known better; NaN: they are not."""
    is_known = not math.isnan(value)
    return Ranges(
        value if is_known else of_one.value,
        of_one.by_theta,
        of_one.by_tau,
        of_one.tt_low,
        of_one.tt_high,
        of_one.tv,
        of_one.tv_var,
        of_one.vv,
        of_one.theta_low,
        of_one.theta_high,
        of_one.theta_change,
        of_one.tau_change,
        of_one.below,
        of_one.above,
        error if is_known else of_one.error,
        of_one.theta_error,
        of_one.tau_error,
    )


@kernel(contract=True, forceinline=True)
def box_times(i: int, boxes: Array) -> tuple[float, float]:
    """The middle of a box by time, and half its duration as it is evaluated."""
    start, end = boxes[X_START + i], boxes[X_END + i]
    return 0.5 * (start + end), 0.5 * (end - start) + OVERLAP * abs(end)


@kernel(contract=True, forceinline=True)
def set_class(i: int, a: float, b: float, phi: Ranges, g: Ranges, depth: float, p: float, boxes: Array) -> None:
    """Sets the class of a box, and what is stored with it, from its ranges."""
    box_class, g_low, by_time, deepest = classify_box(a, b, phi, g, depth, p)
    boxes[X_CLASS + i], boxes[X_G_LOW + i], boxes[X_BY_TIME + i] = box_class, g_low, by_time
    boxes[X_DEEPEST + i] = deepest
    boxes[X_DEPTH + i] = smaller(g.value, phi.value)
    boxes[X_BEND_LOW + i], boxes[X_BEND_HIGH + i] = phi.tt_low, phi.tt_high


@kernel(contract=True)
def classify_boxes(count: int, motion: Array, curve_profile: Array, solid_profile: Array, boxes: Array) -> None:
    """Evaluates the bounds of the first ``count`` boxes and sets their classes."""
    x_axis, y_axis, origin, rest = motion_numbers(motion)
    curve = profile_numbers(curve_profile)
    solid = profile_numbers(solid_profile)
    p = solid_profile[pk.P]
    sizes = size_numbers(motion, curve_profile, solid_profile)
    for i in range(count):
        a = boxes[X_HALF + i]
        tau, b = box_times(i, boxes)
        of_phi, of_g, depth = ranges(boxes[X_THETA + i], a, tau, b, x_axis, y_axis, origin, rest, curve, solid, sizes)
        error = error_beside(tau, sizes) * boxes[X_GAP + i]
        g = with_value(of_g, boxes[X_G_BESIDE + i], error)
        phi = with_value(of_phi, boxes[X_PHI_BESIDE + i], error)
        set_class(i, a, b, phi, g, depth, p, boxes)
