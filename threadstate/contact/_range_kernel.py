"""Ranges of a walker's functions over a box of azimuth and time.

A walker at azimuth theta of its edge curve is at time tau at g = -sigma z below the solid's plane and inside the thread
by phi. With X its place, T = X_theta, V = X_tau, (r, t, z) the solid's cylindrical directions at X, and P and Q the
walker's own radial and azimuthal directions,

    s_U = U_z - (k / r) U_t,    grad phi . U = U_r - f' s_U,
    phi_UV = grad phi . X_UV + U_t V_t / r - f'' s_U s_V - f' (k / r^2) (U_r V_t + U_t V_r)      (sigma = +1).

All is exact in the middle of the box; the two profiles' own bends (r'' and f'') are taken over what they can reach in
it, and the rest may vary by bounds on the next derivatives. Those vanish with the misalignment of the two parts, so
that nearly coaxial parts, whose functions all but vanish too, keep sharp ranges.
"""

from __future__ import annotations

import math

from threadstate._compile import kernel
from threadstate.contact._frame_kernel import around_axis, moved, moving_by, polar, shares
from threadstate.contact._lane_kernel import Numbers, azimuth, bends, larger, radius_and_slope, sine_cosine, smaller


@kernel(contract=True, forceinline=True)
def third_derivatives(
    misaligned: float, sine: float, own: float, c1: float, big: float, slope: float, place: float, k_low: float
) -> tuple[float, float, float, float]:
    """Bounds, in proportion to the misalignment, on how fast by azimuth these vary over a box.

    The radial part of phi_thetatheta and its helical part (that f' multiplies), r'' and f'' apart; the two parts of the
    factor of r''.
    ``misaligned`` bounds P_t, Q_r and 1 - T_t / r, ``sine`` the axial parts of P and Q.
    """
    around = 1.0 + misaligned
    mix = misaligned * (4.0 + 3.0 * misaligned)
    jerk = place * (own * misaligned + 2.0 * slope * mix + 3.0 * big * around * misaligned)
    radial = (
        slope * misaligned * (18.0 + 10.0 * misaligned)
        + big * misaligned * (1.0 + around) * (1.0 + around)
        + own * misaligned * (2.0 + around)
        + c1 * jerk
    )
    pull = slope + big * misaligned
    helical = sine * (3.0 * slope + big + 2.0 * own) + k_low * (
        place * pull * (3.0 * big * around * misaligned + 2.0 * slope * mix)
        + (slope * misaligned + big * mix) * (1.0 + 2.0 * around)
        + 2.0 * big * jerk * misaligned
        + 2.0 * own * mix
        + 2.0 * slope * (jerk + misaligned * (1.0 + around) * (1.0 + around))
    )
    factor_r = misaligned * (1.0 + around)
    factor_s = sine + k_low * (mix + place * pull * misaligned)
    return radial, helical, factor_r, factor_s


@kernel(contract=True, forceinline=True)
def ranges(
    theta: float,
    a: float,
    tau: float,
    b: float,
    x_axis: Numbers,
    y_axis: Numbers,
    origin: Numbers,
    rest: Numbers,
    curve: Numbers,
    solid: Numbers,
    sizes: Numbers,
) -> tuple[Numbers, Numbers, float]:
    """What phi and g can be over theta +- a, tau +- b, and the least depth below the solid's plane.

    ``x_axis`` to ``rest`` are the :func:`motion_numbers`, ``curve`` and ``solid`` the :func:`profile_numbers`.
    ``sizes``: k, the curve's largest radius and largest dr / dtheta, the solid's cot of the flank, and a radius that is
    never reached. Of either function: its value in the middle, its derivatives there by theta and tau, the least and
    the largest second derivative by theta, the mixed one (middle, and how far it varies), the largest size of the
    second by tau.
    """
    turning, sigma, moving, ax, ay, az = rest
    k, big, slope_c, cot, r_floor = sizes
    c1 = math.sqrt(big * big + slope_c * slope_c)
    # The edge curve: r, r', the range of r''.
    sin_theta, cos_theta = sine_cosine(theta)
    r, slope, u = radius_and_slope(-k * theta, curve)
    dr = -k * slope
    own_low, own_high = bends(u, k * a, curve)
    own_low *= k * k
    own_high *= k * k
    own = larger(own_high, -own_low)
    # Where it is at tau, and its derivatives.
    by_sine, by_versine, d_sine, d_versine = shares(tau, turning)
    m1, m2, place_o = (
        moved(x_axis, by_sine, by_versine),
        moved(y_axis, by_sine, by_versine),
        moved(origin, by_sine, by_versine),
    )
    n1, n2, speed_o = (
        moving_by(x_axis, d_sine, d_versine),
        moving_by(y_axis, d_sine, d_versine),
        moving_by(origin, d_sine, d_versine),
    )
    p_ = around_axis(m1, m2, cos_theta, sin_theta)
    q_ = around_axis(m2, m1, cos_theta, -sin_theta)
    p_tau = around_axis(n1, n2, cos_theta, sin_theta)
    q_tau = around_axis(n2, n1, cos_theta, -sin_theta)
    x, y, z = r * p_[0] + place_o[0], r * p_[1] + place_o[1], r * p_[2] + place_o[2]
    t_ = (dr * p_[0] + r * q_[0], dr * p_[1] + r * q_[1], dr * p_[2] + r * q_[2])
    v_ = (r * p_tau[0] + speed_o[0], r * p_tau[1] + speed_o[1], r * p_tau[2] + speed_o[2])
    w_ = (dr * p_tau[0] + r * q_tau[0], dr * p_tau[1] + r * q_tau[1], dr * p_tau[2] + r * q_tau[2])
    a_ = (
        (ay * v_[2] - az * v_[1]) * turning,
        (az * v_[0] - ax * v_[2]) * turning,
        (ax * v_[1] - ay * v_[0]) * turning,
    )
    # phi in the middle; its second derivatives without the profiles' own bends.
    radius = math.sqrt(x * x + y * y)
    inverse = 1.0 / radius
    rx, ry = x * inverse, y * inverse
    k_r = k * inverse
    k_rr = k_r * inverse
    f, f1, u = radius_and_slope(z - k * azimuth(x, y, radius), solid)
    tr, tt, ts = polar(t_, rx, ry, k_r)
    vr, vt, vs = polar(v_, rx, ry, k_r)
    pr, pt, ps = polar(p_, rx, ry, k_r)
    qr, _, qs = polar(q_, rx, ry, k_r)
    wr, _, ws = polar(w_, rx, ry, k_r)
    ar, _, a_s = polar(a_, rx, ry, k_r)
    phi, phi_t, phi_v = radius - f, tr - f1 * ts, vr - f1 * vs
    bent_s = -r * ps + 2.0 * dr * qs + 2.0 * k_rr * tr * tt
    flat_tt = -r * pr + 2.0 * dr * qr + tt * tt * inverse - f1 * bent_s
    flat_tv = wr - f1 * ws + tt * vt * inverse - f1 * k_rr * (tr * vt + tt * vr)
    flat_vv = ar - f1 * a_s + vt * vt * inverse - 2.0 * f1 * k_rr * vr * vt
    # How fast and how far the curve can move in the box; by how much its directions and the solid's can turn.
    speed = math.sqrt(v_[0] * v_[0] + v_[1] * v_[1] + v_[2] * v_[2])
    fast = speed + turning * c1 * a + turning * b * (speed + c1 * a)
    c2 = own + big + 2.0 * slope_c
    r_low = larger(radius - c1 * a - fast * b, r_floor)
    place = 1.0 / r_low
    k_low = k * place
    twist = (c1 * a + fast * b) * place
    spin = a + turning * b + twist
    late = b * (turning + fast * place)
    sine = smaller(math.sqrt(m1[2] * m1[2] + m2[2] * m2[2]) + turning * b, 1.0)
    # P_t, Q_r, 1 - T_t / r grow by azimuth at a rate in proportion to themselves (Gronwall).
    rate = own * place + 6.5
    misaligned = larger(abs(pt), abs(qr)) + abs(1.0 - tt * inverse)
    misaligned = (misaligned + sine * sine + late * (1.0 + 2.0 * c1 * place)) * (1.0 + 1.8 * rate * a)
    aligned = rate * a < 1.0 and misaligned < 0.25
    radial_3, helical_3, factor_r, factor_s = third_derivatives(misaligned, sine, own, c1, big, slope_c, place, k_low)
    # The helical coordinate, and with it f' and f'', over the box.
    bend_s = (1.0 + k_low) * ((big + 2.0 * slope_c + own) * spin + slope_c * a + 2.0 * own * a) + (
        4.0 * k_low * place * c1 * (c1 * spin + own * a + c1 * twist)
    )
    near_s = helical_3 * a + (1.0 + k_low) * (big + 2.0 * slope_c + own) * late + 4.0 * k_low * place * c1 * c1 * late
    bend_s = abs(bent_s) + own * abs(ps) + (smaller(near_s, bend_s) if aligned else bend_s)
    s_tv = turning * c1 * (1.0 + k_low) + 2.0 * k_low * c1 * fast * place
    s_vv = turning * fast * (1.0 + k_low) + 2.0 * k_low * fast * fast * place
    most_t = abs(ts) + bend_s * a + s_tv * b
    most_v = abs(vs) + s_tv * a + s_vv * b
    least_t = larger(abs(ts) - bend_s * a - s_tv * b, 0.0)
    reach = most_t * a + most_v * b
    f2_low, f2_high = bends(u, reach, solid)
    f2 = larger(f2_high, -f2_low)
    d_f1 = smaller(f2 * reach, 2.0 * cot)
    steep = 1.0 + smaller(abs(f1) + d_f1, cot) * (1.0 + k_low)
    # How much the second derivatives vary, r'' and f'' apart.
    d_t, d_v = c1 * spin + own * a, fast * spin + fast - speed
    thin = ((abs(tr) + c1 * spin) * a + (abs(vr) + fast * spin) * b) * place
    whirl = place * (1.0 + 2.0 * cot * k_low)
    var_tt = (
        steep * ((big + 2.0 * slope_c) * spin + slope_c * a + 2.0 * own * a)
        + place * (2.0 * c1 * d_t + c1 * c1 * thin)
        + 2.0 * cot * k_low * place * (c1 * d_t + c1 * c1 * thin)
    )
    near_tt = (radial_3 + cot * helical_3) * a + (
        steep * (big + 2.0 * slope_c) + place * c1 * c1 * (3.0 + 4.0 * cot * k_low)
    ) * late
    var_tt = (smaller(near_tt, var_tt) if aligned else var_tt) + d_f1 * abs(bent_s)
    var_tv = (
        steep * turning * (c1 * spin + c2 * a)
        + whirl * (c1 * d_v + fast * d_t + c1 * fast * thin)
        + d_f1 * (abs(ws) + k_rr * abs(tr * vt + tt * vr))
    )
    var_vv = (
        steep * turning * d_v
        + whirl * (2.0 * fast * d_v + fast * fast * thin)
        + d_f1 * (abs(a_s) + 2.0 * k_rr * abs(vr * vt))
    )
    # With them: r'' times grad phi . P, less f'' s_U s_V.
    along = pr - f1 * ps
    near_along = (factor_r + cot * factor_s) * a + steep * late
    var_along = (smaller(near_along, steep * spin) if aligned else steep * spin) + d_f1 * abs(ps)
    tt_high = flat_tt + var_tt + own_high * (along + var_along if own_high > 0.0 else along - var_along)
    tt_low = flat_tt - var_tt + own_low * (along + var_along if own_low < 0.0 else along - var_along)
    tt_high -= f2_low * (most_t * most_t if f2_low < 0.0 else least_t * least_t)
    tt_low -= f2_high * (most_t * most_t if f2_high > 0.0 else least_t * least_t)
    tv_mid = flat_tv - 0.5 * (f2_low + f2_high) * ts * vs
    tv_var = var_tv + 0.5 * (f2_high - f2_low) * abs(ts * vs) + f2 * (most_t * most_v - abs(ts * vs))
    vv = abs(flat_vv) + var_vv + f2 * most_v * most_v
    outward = sigma > 0.0
    of_phi = (
        sigma * phi,
        sigma * phi_t,
        sigma * phi_v,
        tt_low if outward else -tt_high,
        tt_high if outward else -tt_low,
        sigma * tv_mid,
        tv_var,
        vv,
    )
    # g; where the axis lies in both planes its sign stays that of the start, which stands for it.
    m1z = m1[2] if moving > 0.0 else x_axis[2]
    m2z = m2[2] if moving > 0.0 else y_axis[2]
    height = place_o[2] if moving > 0.0 else origin[2]
    swings = turning * moving
    p_g = -sigma * (m1z * cos_theta + m2z * sin_theta)
    q_g = -sigma * (m2z * cos_theta - m1z * sin_theta)
    var_g = sine * (a * (big + 3.0 * slope_c) + 2.0 * own * a) + swings * b * (big + 2.0 * slope_c)
    var_g += own * (sine * a + swings * b)
    flat_g = 2.0 * dr * q_g - r * p_g
    of_g = (
        r * p_g - sigma * height,
        dr * p_g + r * q_g,
        -sigma * v_[2] * moving,
        flat_g - var_g + (own_low if p_g > 0.0 else own_high) * p_g,
        flat_g + var_g + (own_high if p_g > 0.0 else own_low) * p_g,
        -sigma * w_[2] * swings,
        swings * (c2 * a + c1 * b),
        swings * (abs(a_[2]) + c1 * a + fast * b),
    )
    sag = c2 * a * a + turning * (c1 * a + fast * b) * b
    return of_phi, of_g, -sigma * z - abs(t_[2]) * a - abs(v_[2]) * b - sag
