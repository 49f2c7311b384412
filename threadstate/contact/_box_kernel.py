"""Branch and bound: the classification of boxes of azimuth and time by whether an onset can lie in them.

The curve is in the solid where min(g, phi) >= 0. A new arc of it enters at an *onset*, where that minimum has a local
maximum over theta that rises through zero: at an edge on edge (g = phi = 0, opposite slopes), at a tangency with the
thread (phi = phi_theta = 0, phi_thetatheta < 0) or with the plane (g = g_theta = 0). Where the ranges of these
functions over a box admit no onset of any kind the box is excluded.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._branchless_kernel import Numbers, larger, profile_numbers, smaller
from threadstate.contact._frame_kernel import motion_numbers
from threadstate.contact._range_kernel import error_beside, ranges, size_numbers
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# Boxes are stored column by column in a flat buffer of that capacity: middle and half-width of theta, start and end of
# tau, class, min(g, phi) in the middle, range of phi_thetatheta, least g; then g and phi in the
# middle as differences from a contact, and its distance, NaN where they are not given (``_beside_kernel``); whether an
# undecided box is to be split by time (1) or by azimuth (0).
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
BOXES_SIZE = 13 * COLUMN

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


@kernel(contract=True, forceinline=True)
def tangency(a: float, b: float, of_one: Numbers, slope_error: float, remainder: float) -> tuple[bool, bool]:
    """Whether the linear expansions of a function and of its slope exclude a common zero in a box.

    Then whether the time blurs the height of a peak more than the azimuth. ``of_one`` is the function in the middle,
    its derivatives by theta and tau, the range of the second one by theta, the mixed one and its variation, a bound on
    the second one by tau; ``remainder`` is what the function may differ by from its expansion.
    """
    value, slope, rate, tt_low, tt_high, tv_mid, tv_var, vv_bound = of_one
    tt_mid, tt_var = 0.5 * (tt_low + tt_high), 0.5 * (tt_high - tt_low)
    slope_remainder = tt_var * a + tv_var * b + slope_error
    det = slope * tv_mid - rate * tt_mid
    excluded = abs(rate * slope - value * tv_mid) > a * abs(det) + remainder * abs(tv_mid) + slope_remainder * abs(
        rate
    ) or abs(tt_mid * value - slope * slope) > b * abs(det) + remainder * abs(tt_mid) + slope_remainder * abs(slope)
    by_time = b * (abs(det) + 0.5 * vv_bound * b * abs(tt_mid) + tv_var * abs(slope))
    by_theta = a * (
        (0.5 * larger(tt_high, -tt_low) * a + (abs(tv_mid) + tv_var) * b) * abs(tt_mid) + tt_var * abs(slope)
    )
    return excluded, by_time > by_theta


@kernel(contract=True, forceinline=True)
def classify_box(
    a: float, b: float, of_phi: Numbers, of_g: Numbers, depth: float, p: float
) -> tuple[float, float, float]:
    """The class of a box with half-widths ``a`` (theta) and ``b`` (tau) from its :func:`ranges`, the least g in it, and
    whether to split it by time (1) or by azimuth (0) where that leaves it undecided.

    In names, ``tt``, ``tv`` and ``vv`` are second derivatives by theta twice, theta and tau, tau twice; ``bound`` is a
    bound on the size, ``var`` on the variation from the value in the middle, ``low`` and ``high`` are the range.
    """
    phi, phi_theta, phi_tau, phi_tt_low, phi_tt_high, phi_tv_mid, phi_tv_var, phi_vv_bound = of_phi[:8]
    phi_theta_change, phi_tau_change, phi_error, phi_theta_error, phi_tau_error = of_phi[8:]
    g, g_theta, g_tau, g_tt_low, g_tt_high, g_tv_mid, g_tv_var, g_vv_bound, g_theta_change = of_g[:9]
    g_error, g_theta_error, g_tau_error = of_g[9:]
    phi_tv_bound = abs(phi_tv_mid) + phi_tv_var
    g_tv_bound = abs(g_tv_mid) + g_tv_var
    phi_tt_bound = larger(phi_tt_high, -phi_tt_low)
    g_tt_bound = larger(g_tt_high, -g_tt_low)
    phi_theta_bound = abs(phi_theta) + phi_theta_error + phi_tv_bound * b
    peak_offset = smaller(phi_theta_bound / -phi_tt_high if phi_tt_high < 0.0 else a, a)
    phi_time_change = abs(phi_tau) * b + smaller(phi_tau_error + 0.5 * phi_vv_bound * b, phi_tau_change) * b
    phi_azimuth_change = (abs(phi_theta) + phi_theta_change) * a
    phi_rise = phi_theta_bound * peak_offset + 0.5 * phi_tt_high * peak_offset * peak_offset
    phi_fall = phi_theta_bound * a - 0.5 * smaller(phi_tt_low, 0.0) * a * a
    phi_high = phi + phi_time_change + smaller(phi_rise, phi_azimuth_change) + phi_error
    phi_low = phi - phi_time_change - smaller(phi_fall, phi_azimuth_change) - phi_error
    g_time_change = (abs(g_tau) + g_tau_error) * b + 0.5 * g_vv_bound * b * b
    g_azimuth_change = (abs(g_theta) + g_theta_change) * a
    g_linear_change = (abs(g_theta) + g_theta_error) * a + g_tv_bound * a * b
    g_rise = g_linear_change + 0.5 * larger(g_tt_high, 0.0) * a * a
    g_fall = g_linear_change - 0.5 * smaller(g_tt_low, 0.0) * a * a
    g_high = g + g_time_change + smaller(g_rise, g_azimuth_change) + g_error
    g_low = g - g_time_change - smaller(g_fall, g_azimuth_change) - g_error
    phi_theta_var = smaller(phi_tt_bound * a + phi_tv_bound * b + phi_theta_error, phi_theta_change)
    phi_tau_var = smaller(phi_tv_bound * a + phi_vv_bound * b + phi_tau_error, phi_tau_change)
    g_theta_var = smaller(g_tt_bound * a + g_tv_bound * b + g_theta_error, g_theta_change)
    g_tau_var = g_tv_bound * a + g_vv_bound * b + g_tau_error
    phi_monotonic = abs(phi_theta) > phi_theta_var
    g_monotonic = abs(g_theta) > g_theta_var
    all_outside = phi_high < 0.0 or g_high < 0.0 or depth > p
    # The Jacobian determinant of (g, phi); a root of either pair of equations is excluded where the linear expansion
    # with its remainder has none in the box.
    jac = g_tau * phi_theta - phi_tau * g_theta
    jac_var = (
        g_tau_var * (abs(phi_theta) + phi_theta_var)
        + abs(g_tau) * phi_theta_var
        + phi_tau_var * (abs(g_theta) + g_theta_var)
        + abs(phi_tau) * g_theta_var
    )
    remainder_g = (
        smaller(0.5 * g_tt_bound * a + g_tv_bound * b + g_theta_error, g_theta_change) * a
        + (0.5 * g_vv_bound * b + g_tau_error) * b
        + g_error
    )
    remainder_phi = (
        smaller(
            (0.5 * phi_tt_bound * a + phi_tv_bound * b + phi_theta_error) * a
            + (0.5 * phi_vv_bound * b + phi_tau_error) * b,
            phi_theta_change * a + phi_tau_change * b,
        )
        + phi_error
    )
    edge_root_excluded = abs(g * phi_tau - phi * g_tau) > a * abs(jac) + remainder_g * abs(
        phi_tau
    ) + remainder_phi * abs(g_tau) or abs(g * phi_theta - phi * g_theta) > b * abs(jac) + remainder_g * abs(
        phi_theta
    ) + remainder_phi * abs(g_theta)
    thread_root_excluded, thread_by_time = tangency(
        a,
        b,
        (phi, phi_theta, phi_tau, phi_tt_low, phi_tt_high, phi_tv_mid, phi_tv_var, phi_vv_bound),
        phi_theta_error,
        remainder_phi,
    )
    plane_root_excluded, plane_by_time = tangency(
        a,
        b,
        (g, g_theta, g_tau, g_tt_low, g_tt_high, g_tv_mid, g_tv_var, g_vv_bound),
        g_theta_error,
        remainder_g,
    )
    # At most one onset: the peak is unique, and rises or falls at all times.
    peak_edge = phi_monotonic and g_monotonic
    peak_thread = g_low > 0.0 and phi_tt_high < 0.0
    peak_plane = phi_low > 0.0 and g_tt_high < 0.0
    one_edge = peak_edge and abs(jac) > jac_var
    one_thread = peak_thread and abs(phi_tau) > phi_tau_var
    one_plane = peak_plane and abs(g_tau) > g_tau_var
    edge_peak_sinks = one_edge and jac * (phi_theta - g_theta) < 0.0
    thread_peak_is_open = phi - (phi_tau + phi_tau_error + 0.5 * phi_vv_bound * b) * b > phi_error
    plane_peak_is_open = g - (g_tau + g_tau_error + 0.5 * g_vv_bound * b) * b > g_error
    thread_peak_no_onset = one_thread and (phi_tau < 0.0 or thread_peak_is_open)
    plane_peak_no_onset = one_plane and (g_tau < 0.0 or plane_peak_is_open)
    no_edge = (
        g_low > 0.0
        or phi_low > 0.0
        or (peak_edge and phi_theta * g_theta > 0.0)
        or edge_root_excluded
        or edge_peak_sinks
    )
    no_thread = phi_monotonic or phi_tt_low > 0.0 or phi_low > 0.0 or thread_peak_no_onset or thread_root_excluded
    no_plane = g_monotonic or g_tt_low > 0.0 or g_low > 0.0 or plane_peak_no_onset or plane_root_excluded
    excluded = no_edge and no_thread and no_plane
    # Where to split: by the variable that contributes more to the uncertainty of a peak's height, or else to the
    # relative uncertainty of the undecided functions.
    edge_by_time = b * abs(jac) + 0.5 * b * b * (g_vv_bound * abs(phi_theta) + phi_vv_bound * abs(g_theta))
    edge_by_theta = a * (
        (0.5 * g_tt_bound * a + g_tv_bound * b) * abs(phi_theta)
        + (0.5 * phi_tt_bound * a + phi_tv_bound * b) * abs(g_theta)
    )
    phi_weight = 0.0 if phi_monotonic and not g_monotonic else 1.0
    g_weight = 0.0 if g_low > 0.0 or (g_monotonic and not phi_monotonic) else 1.0
    size_phi, size_phi_theta = abs(phi) + 1e-30, abs(phi_theta) + 1e-30
    size_g, size_g_theta = abs(g) + 1e-30, abs(g_theta) + 1e-30
    phi_value_weight = phi_weight * size_phi_theta * size_g * size_g_theta
    phi_slope_weight = phi_weight * size_phi * size_g * size_g_theta
    g_value_weight = g_weight * size_phi * size_phi_theta * size_g_theta
    g_slope_weight = g_weight * size_phi * size_phi_theta * size_g
    uncertainty_by_theta = (
        phi_theta_bound * phi_value_weight
        + phi_tt_bound * phi_slope_weight
        + abs(g_theta) * g_value_weight
        + g_tt_bound * g_slope_weight
    ) * a
    uncertainty_by_time = (
        phi_time_change * phi_value_weight
        + phi_tv_bound * b * phi_slope_weight
        + abs(g_tau) * b * g_value_weight
        + g_tv_bound * b * g_slope_weight
    )
    by_time = uncertainty_by_time > uncertainty_by_theta
    by_time = plane_by_time if peak_plane else by_time
    by_time = thread_by_time if peak_thread else by_time
    by_time = edge_by_time > edge_by_theta if peak_edge else by_time
    box_class = PEAK_PLANE if peak_plane else UNDECIDED_BOX
    box_class = PEAK_THREAD if peak_thread else box_class
    box_class = PEAK_EDGE if peak_edge else box_class
    box_class = ONE_PLANE if one_plane else box_class
    box_class = ONE_THREAD if one_thread else box_class
    box_class = ONE_EDGE if one_edge else box_class
    box_class = EXCLUDED if excluded else box_class
    return ALL_OUTSIDE if all_outside else box_class, g_low, 1.0 if by_time else 0.0


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
        start, end = boxes[X_START + i], boxes[X_END + i]
        tau, b = 0.5 * (start + end), 0.5 * (end - start) + OVERLAP * abs(end)
        of_phi, of_g, depth = ranges(boxes[X_THETA + i], a, tau, b, x_axis, y_axis, origin, rest, curve, solid, sizes)
        g, phi = boxes[X_G_BESIDE + i], boxes[X_PHI_BESIDE + i]
        error = error_beside(tau, sizes) * boxes[X_GAP + i]
        of_g = of_g if math.isnan(g) else (g, *of_g[1:9], error, *of_g[10:])
        of_phi = of_phi if math.isnan(phi) else (phi, *of_phi[1:10], error, *of_phi[11:])
        boxes[X_CLASS + i], boxes[X_G_LOW + i], boxes[X_BY_TIME + i] = classify_box(a, b, of_phi, of_g, depth, p)
        boxes[X_DEPTH + i] = smaller(of_phi[0], of_g[0])
        boxes[X_BEND_LOW + i], boxes[X_BEND_HIGH + i] = of_phi[3], of_phi[4]
