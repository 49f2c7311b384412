"""What bounds say of boxes of azimuth and time: whether a contact can be born in them.

The curve is in the solid where min(g, phi) >= 0, and a new piece of it enters where that minimum has a local maximum
over theta that rises through zero: at an edge on edge (g = phi = 0, opposite slopes), at a tangency with the thread
(phi = phi_theta = 0, phi_thetatheta < 0) or with the plane (g = g_theta = 0). Where the ranges of these functions over
a box exclude every kind of birth the box is closed.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._frame_kernel import motion_numbers
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._lane_kernel import Numbers, larger, profile_numbers, smaller
from threadstate.contact._range_kernel import ranges
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# Boxes are kept column by column in one flat buffer of that capacity: middle and half-width of theta, start and end of
# tau, verdict, min(g, phi) in the middle, largest phi_thetatheta.
CAPACITY = 4096
X_THETA = 0
X_HALF = CAPACITY
X_START = 2 * CAPACITY
X_END = 3 * CAPACITY
X_VERDICT = 4 * CAPACITY
X_DEPTH = 5 * CAPACITY
X_BEND = 6 * CAPACITY
BOXES_SIZE = 7 * CAPACITY

# Verdicts. A birth is excluded, and no point of the box is inside; excluded; at most one birth on the edge, the thread,
# the plane; the same but for the time (a point of the curve that stays in contact is such a one); open, to be split by
# azimuth or by time.
EMPTY, CLOSED, ONE_EDGE, ONE_THREAD, ONE_PLANE, PEAK_EDGE, PEAK_THREAD, PEAK_PLANE, BY_THETA, BY_TIME = (
    0.0,
    1.0,
    2.0,
    3.0,
    4.0,
    5.0,
    6.0,
    7.0,
    8.0,
    9.0,
)

PAD = 4e-15
"""Round-off of the middle's values, in thread pitches."""


@kernel(contract=True, forceinline=True)
def verdict(a: float, b: float, of_phi: Numbers, of_g: Numbers, depth: float, p: float) -> float:
    """What the :func:`ranges` of a box with half-widths ``a`` and ``b`` say of it."""
    phi, phi_t, phi_v, tt_low, tt_high, tv_mid, tv_var, vv = of_phi
    g, g_t, g_v, gg_low, gg_high, g_tv_mid, g_tv_var, g_vv = of_g
    pad = PAD * p
    tv = abs(tv_mid) + tv_var
    g_tv = abs(g_tv_mid) + g_tv_var
    tt_big = larger(tt_high, -tt_low)
    gg_big = larger(gg_high, -gg_low)
    wind = abs(phi_t) + tv * b
    crown = smaller(wind / -tt_high if tt_high < 0.0 else a, a)
    wave = abs(phi_v) * b + 0.5 * vv * b * b
    phi_high = phi + wave + wind * crown + 0.5 * tt_high * crown * crown + pad
    phi_low = phi - wave - wind * a + 0.5 * smaller(tt_low, 0.0) * a * a - pad
    g_lean = abs(g_t) * a + abs(g_v) * b + g_tv * a * b + 0.5 * g_vv * b * b
    g_high = g + g_lean + 0.5 * larger(gg_high, 0.0) * a * a + pad
    g_low = g - g_lean + 0.5 * smaller(gg_low, 0.0) * a * a - pad
    phi_t_var = tt_big * a + tv * b + pad
    phi_v_var = tv * a + vv * b + pad
    g_t_var = gg_big * a + g_tv * b + pad
    g_v_var = g_tv * a + g_vv * b + pad
    phi_runs = abs(phi_t) > phi_t_var
    g_runs = abs(g_t) > g_t_var
    outside = phi_high < 0.0 or g_high < 0.0 or depth > p
    # The slopes' determinant at an edge on edge; where no zero of the expansions can lie in the box.
    jac = g_v * phi_t - phi_v * g_t
    jac_var = (
        g_v_var * (abs(phi_t) + phi_t_var)
        + abs(g_v) * phi_t_var
        + phi_v_var * (abs(g_t) + g_t_var)
        + abs(phi_v) * g_t_var
    )
    rest_g = 0.5 * gg_big * a * a + g_tv * a * b + 0.5 * g_vv * b * b + pad
    rest_phi = 0.5 * tt_big * a * a + tv * a * b + 0.5 * vv * b * b + pad
    elsewhere = abs(g * phi_v - phi * g_v) > a * abs(jac) + rest_g * abs(phi_v) + rest_phi * abs(g_v) or abs(
        g * phi_t - phi * g_t
    ) > b * abs(jac) + rest_g * abs(phi_t) + rest_phi * abs(g_t)
    tt_mid = 0.5 * (tt_low + tt_high)
    rest_slope = 0.5 * (tt_high - tt_low) * a + tv_var * b + pad
    det = phi_t * tv_mid - phi_v * tt_mid
    untouched = abs(phi_v * phi_t - phi * tv_mid) > a * abs(det) + rest_phi * abs(tv_mid) + rest_slope * abs(
        phi_v
    ) or abs(tt_mid * phi - phi_t * phi_t) > b * abs(det) + rest_phi * abs(tt_mid) + rest_slope * abs(phi_t)
    gg_mid = 0.5 * (gg_low + gg_high)
    rest_slope = 0.5 * (gg_high - gg_low) * a + g_tv_var * b + pad
    det = g_t * g_tv_mid - g_v * gg_mid
    aloof = abs(g_v * g_t - g * g_tv_mid) > a * abs(det) + rest_g * abs(g_tv_mid) + rest_slope * abs(g_v) or abs(
        gg_mid * g - g_t * g_t
    ) > b * abs(det) + rest_g * abs(gg_mid) + rest_slope * abs(g_t)
    # At most one birth: the peak is unique, and rises or falls throughout.
    peak_edge = phi_runs and g_runs
    peak_thread = g_low > 0.0 and tt_high < 0.0
    peak_plane = phi_low > 0.0 and gg_high < 0.0
    one_edge = peak_edge and abs(jac) > jac_var
    one_thread = peak_thread and abs(phi_v) > phi_v_var
    one_plane = peak_plane and abs(g_v) > g_v_var
    sinks_edge = one_edge and jac * (phi_t - g_t) < 0.0
    open_thread = one_thread and (phi_v < 0.0 or phi - phi_v * b - 0.5 * vv * b * b > pad)
    open_plane = one_plane and (g_v < 0.0 or g - g_v * b - 0.5 * g_vv * b * b > pad)
    no_edge = g_low > 0.0 or phi_low > 0.0 or (peak_edge and phi_t * g_t > 0.0) or elsewhere or sinks_edge
    no_thread = phi_runs or tt_low > 0.0 or phi_low > 0.0 or open_thread or untouched
    no_plane = g_runs or gg_low > 0.0 or g_low > 0.0 or open_plane or aloof
    closed = no_edge and no_thread and no_plane
    # Where to split: by the direction that blurs the undecided functions more.
    ask_phi = 0.0 if phi_runs and not g_runs else 1.0
    ask_g = 0.0 if g_low > 0.0 or (g_runs and not phi_runs) else 1.0
    size_phi, size_phi_t = abs(phi) + 1e-30, abs(phi_t) + 1e-30
    size_g, size_g_t = abs(g) + 1e-30, abs(g_t) + 1e-30
    far_phi = ask_phi * size_phi_t * size_g * size_g_t
    flat_phi = ask_phi * size_phi * size_g * size_g_t
    far_g = ask_g * size_phi * size_phi_t * size_g_t
    flat_g = ask_g * size_phi * size_phi_t * size_g
    from_theta = (wind * far_phi + tt_big * flat_phi + abs(g_t) * far_g + gg_big * flat_g) * a
    from_time = wave * far_phi + tv * b * flat_phi + abs(g_v) * b * far_g + g_tv * b * flat_g
    word = BY_THETA if from_theta >= from_time else BY_TIME
    word = PEAK_PLANE if peak_plane else word
    word = PEAK_THREAD if peak_thread else word
    word = PEAK_EDGE if peak_edge else word
    word = ONE_PLANE if one_plane else word
    word = ONE_THREAD if one_thread else word
    word = ONE_EDGE if one_edge else word
    word = CLOSED if closed else word
    return EMPTY if outside else word


@kernel(contract=True)
def judge_boxes(count: int, motion: Array, row_c: Array, row_s: Array, boxes: Array) -> None:
    """Sets the verdicts of the first ``count`` boxes."""
    x_axis, y_axis, origin, rest = motion_numbers(motion)
    curve = profile_numbers(row_c)
    solid = profile_numbers(row_s)
    p = row_c[pk.P]
    k = p / TWO_PI
    sizes = (k, row_c[pk.R_MAJOR], k * row_c[pk.COT], row_s[pk.COT], 0.5 * row_s[pk.R_MINOR])
    for i in range(count):
        a = boxes[X_HALF + i]
        start, end = boxes[X_START + i], boxes[X_END + i]
        tau, b = 0.5 * (start + end), 0.5 * (end - start)
        of_phi, of_g, depth = ranges(boxes[X_THETA + i], a, tau, b, x_axis, y_axis, origin, rest, curve, solid, sizes)
        boxes[X_VERDICT + i] = verdict(a, b, of_phi, of_g, depth, p)
        boxes[X_DEPTH + i] = smaller(of_phi[0], of_g[0])
        boxes[X_BEND + i] = of_phi[4]
