"""Thread on thread at one point: phi along the bolt's thread, its derivatives, and Newton's method to a tangency.

The bolt's thread is parametrised by azimuth and axial position (theta, z), 0 <= z <= p, in the bolt's frame. With the
nut's phi along it, a tangency is a point with phi = 0 and both derivatives zero; it is a contact where phi has a
maximum. Moving along the bolt's helix (theta + u, z + k u) keeps both profiles' positions nearly fixed, so that the
derivatives used are A (by u, along the helix) and B (by z, along the axis).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._geometry_kernel import (
    M_AXIS,
    M_KIND,
    M_OFF,
    M_POINT,
    M_ROT,
    TWO_PI,
    motion_scale,
    place_by_time,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# A tangency: time, theta and z on the bolt, point in the nut's frame.
T_TIME = 0
T_THETA = 1
T_Z = 2
T_X = 3
T_Y = 4
T_POINT_Z = 5
TANGENCY_SIZE = 6
MAX_TANGENCIES = 32

REACH_THETA = 0.12
"""How far (rad) from where Newton's method starts a tangency may lie."""
REACH_Z = 0.2
"""The same along the axis, in pitches."""

PHI_ROUND_OFF = 4e-15
"""Round-off of phi, in thread pitches: where phi changes slowly with time it bounds the last steps from below."""

ONE_REACH = 1e-3
"""How far (rad) from a tangency an earlier contact may be that round-off makes two of; within it second derivatives say
how phi falls.
"""

# The placement of the bolt after a motion: rotation by rows, offset, and its velocity there; that of a point x is
# ``axis x x + drift``.
PLACEMENT_ROT = 0
PLACEMENT_OFF = 9
PLACEMENT_AXIS = 12
PLACEMENT_DRIFT = 15
PLACEMENT_SIZE = 18

# phi at a point of the bolt's thread, its derivatives A (by u), B (by z) and its rate (by tau), the point in the nut's
# frame, and the second derivatives.
TJ_PHI = 0
TJ_A = 1
TJ_B = 2
TJ_RATE = 3
TJ_X = 4
TJ_Y = 5
TJ_Z = 6
TJ_UU = 7
TJ_UZ = 8
TJ_ZZ = 9
TJ_UT = 10
TJ_ZT = 11
TANGENCY_JET_SIZE = 12


@kernel()
def set_placement(motion: Array, tau: float, placement: Array) -> None:
    """Sets the placement of the bolt after ``tau`` of a motion."""
    if motion[M_KIND] == 0.0:
        for i in range(9):
            placement[PLACEMENT_ROT + i] = motion[M_ROT + i]
        for i in range(3):
            placement[PLACEMENT_OFF + i] = motion[M_OFF + i] + tau * motion[M_AXIS + i]
            placement[PLACEMENT_AXIS + i] = 0.0
            placement[PLACEMENT_DRIFT + i] = motion[M_AXIS + i]
        return
    ax, ay, az = motion[M_AXIS], motion[M_AXIS + 1], motion[M_AXIS + 2]
    px, py, pz = motion[M_POINT], motion[M_POINT + 1], motion[M_POINT + 2]
    c = math.cos(tau)
    s = math.sin(tau)
    for j in range(4):
        vx, vy, vz = motion[M_ROT + j], motion[M_ROT + 3 + j], motion[M_ROT + 6 + j]
        if j == 3:
            vx, vy, vz = motion[M_OFF] - px, motion[M_OFF + 1] - py, motion[M_OFF + 2] - pz
        h = ax * vx + ay * vy + az * vz
        wx, wy, wz = vx - h * ax, vy - h * ay, vz - h * az
        vx = h * ax + c * wx + s * (ay * wz - az * wy)
        vy = h * ay + c * wy + s * (az * wx - ax * wz)
        vz = h * az + c * wz + s * (ax * wy - ay * wx)
        if j < 3:
            placement[PLACEMENT_ROT + j] = vx
            placement[PLACEMENT_ROT + 3 + j] = vy
            placement[PLACEMENT_ROT + 6 + j] = vz
        else:
            placement[PLACEMENT_OFF] = px + vx
            placement[PLACEMENT_OFF + 1] = py + vy
            placement[PLACEMENT_OFF + 2] = pz + vz
    placement[PLACEMENT_AXIS] = ax
    placement[PLACEMENT_AXIS + 1] = ay
    placement[PLACEMENT_AXIS + 2] = az
    placement[PLACEMENT_DRIFT] = az * py - ay * pz
    placement[PLACEMENT_DRIFT + 1] = ax * pz - az * px
    placement[PLACEMENT_DRIFT + 2] = ay * px - ax * py


@kernel(forceinline=True)
def rotated(x: float, y: float, z: float, placement: Array) -> tuple[float, float, float]:
    """A vector of the bolt's frame in the nut's frame."""
    return (
        placement[0] * x + placement[1] * y + placement[2] * z,
        placement[3] * x + placement[4] * y + placement[5] * z,
        placement[6] * x + placement[7] * y + placement[8] * z,
    )


@kernel()
def set_jet(theta: float, z: float, placement: Array, bolt: Array, nut: Array, jet: Array) -> None:
    """Phi and its derivatives at (theta, z) of the bolt's thread, for a placement.

    One formula whose terms share their factors.
    """
    k = bolt[pk.LEAD] / TWO_PI
    r_b, slope, second_derivative = pk.jet(z - k * theta, bolt)
    cos = math.cos(theta)
    sin = math.sin(theta)
    x, y, zz = rotated(r_b * cos, r_b * sin, z, placement)
    x += placement[PLACEMENT_OFF]
    y += placement[PLACEMENT_OFF + 1]
    zz += placement[PLACEMENT_OFF + 2]
    # Derivatives of the point by u, z and tau, and the second derivatives by u and z.
    ux, uy, uz = rotated(-r_b * sin, r_b * cos, k, placement)
    zx, zy, z_z = rotated(slope * cos, slope * sin, 1.0, placement)
    outx, outy, outz = rotated(cos, sin, 0.0, placement)
    acrossx, acrossy, acrossz = rotated(-sin, cos, 0.0, placement)
    ax, ay, az = placement[PLACEMENT_AXIS], placement[PLACEMENT_AXIS + 1], placement[PLACEMENT_AXIS + 2]
    tx = ay * zz - az * y + placement[PLACEMENT_DRIFT]
    ty = az * x - ax * zz + placement[PLACEMENT_DRIFT + 1]
    tz = ax * y - ay * x + placement[PLACEMENT_DRIFT + 2]
    r = math.sqrt(x * x + y * y)
    f, f1, f2 = pk.jet(zz - k * math.atan2(y, x), nut)
    ex = x / r
    ey = y / r
    k_r = k / r
    gx = ex - f1 * k_r * ey
    gy = ey + f1 * k_r * ex
    # Radial and azimuthal components of the three derivatives, and the derivatives of s along them.
    ur, ua = ex * ux + ey * uy, ex * uy - ey * ux
    zr, za = ex * zx + ey * zy, ex * zy - ey * zx
    tr, ta = ex * tx + ey * ty, ex * ty - ey * tx
    us = uz - k_r * ua
    zs = z_z - k_r * za
    ts = tz - k_r * ta
    twist = f1 * k_r / r
    jet[TJ_PHI] = r - f
    jet[TJ_A] = ur - f1 * us
    jet[TJ_B] = zr - f1 * zs
    jet[TJ_RATE] = tr - f1 * ts
    jet[TJ_X] = x
    jet[TJ_Y] = y
    jet[TJ_Z] = zz
    along_out = gx * outx + gy * outy - f1 * outz
    along_across = gx * acrossx + gy * acrossy - f1 * acrossz
    jet[TJ_UU] = ua * ua / r - f2 * us * us - 2.0 * twist * ur * ua - r_b * along_out
    jet[TJ_UZ] = ua * za / r - f2 * us * zs - twist * (ur * za + ua * zr) + slope * along_across
    jet[TJ_ZZ] = za * za / r - f2 * zs * zs - 2.0 * twist * zr * za + second_derivative * along_out
    jet[TJ_UT] = (
        ua * ta / r
        - f2 * us * ts
        - twist * (ur * ta + ua * tr)
        + gx * (ay * uz - az * uy)
        + gy * (az * ux - ax * uz)
        - f1 * (ax * uy - ay * ux)
    )
    jet[TJ_ZT] = (
        za * ta / r
        - f2 * zs * ts
        - twist * (zr * ta + za * tr)
        + gx * (ay * z_z - az * zy)
        + gy * (az * zx - ax * z_z)
        - f1 * (ax * zy - ay * zx)
    )


@kernel()
def tangency_step(jet: Array) -> tuple[float, float, float, float]:
    """Newton's step to phi = A = B = 0: the determinant, and the changes of u, z and tau."""
    phi, a, b, rate = jet[TJ_PHI], jet[TJ_A], jet[TJ_B], jet[TJ_RATE]
    uu, uz, zz, ut, zt = jet[TJ_UU], jet[TJ_UZ], jet[TJ_ZZ], jet[TJ_UT], jet[TJ_ZT]
    # Cramer's rule: minors of the rows of A and B, and the combinations of A and B with each column.
    minor_u = uz * zt - ut * zz
    minor_z = uu * zt - ut * uz
    minor_t = uu * zz - uz * uz
    rest_u = a * uz - uu * b
    rest_z = a * zz - uz * b
    rest_t = a * zt - ut * b
    det = a * minor_u - b * minor_z + rate * minor_t
    du = (-phi * minor_u + b * rest_t - rate * rest_z) / det
    dz = (phi * minor_z - a * rest_t + rate * rest_u) / det
    dt = (-phi * minor_t + a * rest_z - b * rest_u) / det
    return det, du, dz, dt


@kernel()
def newton_tangency(
    theta_start: float,
    z_start: float,
    tau: float,
    limit: float,
    motion: Array,
    bolt: Array,
    nut: Array,
    placement: Array,
    jet: Array,
    found: Array,
    count: int,
) -> int:
    """Newton's method on phi = A = B = 0 in (u, z, tau); adds the tangency to ``found`` if it is a contact.

    Returns the number of contacts found.
    """
    k = bolt[pk.LEAD] / TWO_PI
    theta = theta_start
    z = z_start
    set_placement(motion, tau, placement)
    set_jet(theta, z, placement, bolt, nut, jet)
    converged = False
    step = motion_scale(motion, bolt)
    # Round-off in the place on a fillet, over its radius, is that of the slopes there.
    fillet = min(bolt[pk.RHO_MINOR], bolt[pk.RHO_MAJOR], nut[pk.RHO_MINOR], nut[pk.RHO_MAJOR])
    settled = max(1e-8, 2.0 * PHI_ROUND_OFF * bolt[pk.P] / fillet)
    for _ in range(30):
        determinant, du, dz, dt = tangency_step(jet)
        if determinant == 0.0:
            return count
        theta += du
        z += k * du + dz
        tau += dt
        if abs(theta - theta_start) > REACH_THETA or abs(z - z_start) > REACH_Z * bolt[pk.P]:
            return count
        set_placement(motion, tau, placement)
        set_jet(theta, z, placement, bolt, nut, jet)
        small = abs(du) < 1e-11 and abs(dz) < 1e-11 * bolt[pk.P] and abs(dt) < 1e-14 * (step + abs(tau))
        if small or (
            abs(jet[TJ_PHI]) < PHI_ROUND_OFF * bolt[pk.P] and abs(du) < settled and abs(dz) < 1e-8 * bolt[pk.P]
        ):
            converged = True
            break
    if not converged or tau <= 0.0 or tau > limit or not is_contact_of_threads(z, jet, bolt):
        return count
    return insert_tangency(tau, theta, z, jet, bolt, found, count)


@kernel()
def is_contact_of_threads(z: float, jet: Array, bolt: Array) -> bool:
    """Whether a tangency is on both parts, one thread pitch long, and a maximum of phi that rises: a contact."""
    on_both = 0.0 <= z <= bolt[pk.P] and -bolt[pk.P] <= jet[TJ_Z] <= 0.0
    # At a maximum the Hessian in (u, z) is negative definite.
    is_maximum = jet[TJ_UU] < 0.0 and jet[TJ_UU] * jet[TJ_ZZ] - jet[TJ_UZ] * jet[TJ_UZ] > 0.0
    return on_both and jet[TJ_RATE] > 0.0 and is_maximum


@kernel()
def is_one_with(tangency: Array, x: float, y: float, z: float, motion: Array, bolt: Array, nut: Array) -> bool:
    """Whether round-off alone parts a tangency from an earlier contact, a point of the axis of a turn.

    Phi is zero at the earlier contact all the time, and at a tangency it has a maximum of zero: it falls from there by
    its second derivatives, so that both are one unless it falls by more than its round-off. A bolt that is all but
    level has such maxima, from 1e-5 in on beside its first contact, from which the overlap of the threads grows.
    """
    placement, jet = scratch(PLACEMENT_SIZE), scratch(TANGENCY_JET_SIZE)
    theta = tangency[T_THETA]
    set_placement(motion, tangency[T_TIME], placement)
    set_jet(theta, tangency[T_Z], placement, bolt, nut, jet)
    x -= placement[PLACEMENT_OFF]
    y -= placement[PLACEMENT_OFF + 1]
    z -= placement[PLACEMENT_OFF + 2]
    on_bolt_x = placement[0] * x + placement[3] * y + placement[6] * z
    on_bolt_y = placement[1] * x + placement[4] * y + placement[7] * z
    on_bolt_z = placement[2] * x + placement[5] * y + placement[8] * z
    cos, sin = math.cos(theta), math.sin(theta)
    u = math.atan2(on_bolt_y * cos - on_bolt_x * sin, on_bolt_x * cos + on_bolt_y * sin)
    if abs(u) > ONE_REACH:
        return False
    v = on_bolt_z - tangency[T_Z] - bolt[pk.LEAD] / TWO_PI * u
    fall = -0.5 * (jet[TJ_UU] * u * u + 2.0 * jet[TJ_UZ] * u * v + jet[TJ_ZZ] * v * v)
    return fall <= PHI_ROUND_OFF * bolt[pk.P]


@kernel()
def insert_tangency(tau: float, theta: float, z: float, jet: Array, bolt: Array, found: Array, count: int) -> int:
    """Inserts a tangency by time unless it is listed; a full list drops the latest. Returns the number listed."""
    for i in range(count):
        if abs(found[i, T_X] - jet[TJ_X]) + abs(found[i, T_Y] - jet[TJ_Y]) < 1e-6 * bolt[pk.P]:
            return count
    i, listed = place_by_time(tau, count, found)
    if i < 0:
        return listed
    found[i, T_TIME] = tau
    found[i, T_THETA] = theta
    found[i, T_Z] = z
    found[i, T_X] = jet[TJ_X]
    found[i, T_Y] = jet[TJ_Y]
    found[i, T_POINT_Z] = jet[TJ_Z]
    return listed
