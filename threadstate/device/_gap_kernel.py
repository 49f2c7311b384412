"""How deep the parts overlap at one place, with first and second derivatives by the bolt's coordinates.

A point of one part (of its edge, or of the bolt's thread) has two depths in the other part: ``g`` below its flat face
and ``phi`` inside its thread. The overlap at a place is a local maximum of one of them over the points of the edge or
thread, or of the lesser of both where they cross along an edge. It is negative where the parts are apart, and its
derivatives are those of a value function: the point that is deepest moves with the bolt.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    EDGE_EDGE,
    EDGE_SURFACE,
    THREAD_EDGE,
    THREAD_THREAD,
)
from threadstate.device._chart_kernel import D_CENTRE, N_OFFSET, N_ROTATION, to_chart
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# A place of overlap: pair of features, azimuth of the point on its edge or thread, axial position there, overlap,
# gradient by the coordinates, Hessian by rows, point in the nut's frame, unit normal from the nut into the bolt, then
# the norm of the gradient by the centre.
G_PAIR, G_THETA, G_Z, G_VALUE, G_GRADIENT, G_HESSIAN, G_POINT, G_NORMAL, G_NORM = 0, 1, 2, 3, 4, 10, 46, 49, 52
GAP_SIZE = 53

# Of a point on an edge: g and phi and their first two derivatives by azimuth.
E_G, E_G1, E_G2, E_PHI, E_PHI1, E_PHI2 = range(6)
EDGE_JET_SIZE = 6

LEAST_BEND = 1e-9
"""Second derivative by azimuth, in nominal radii, below which a maximum counts as flat: its point stays where it is."""


@kernel()
def solid_jet(x: float, y: float, z: float, profile: Array, sigma: float, out: Array) -> float:
    """``phi = sigma (r - f(s))`` at a point; sets its gradient (3 numbers) and its Hessian (9, by rows)."""
    k = profile[pk.LEAD] / TWO_PI
    r = math.sqrt(x * x + y * y)
    f, f1, f2 = pk.jet(z - k * math.atan2(y, x), profile)
    ex, ey = x / r, y / r
    kr = k / r
    sx, sy = kr * ey, -kr * ex
    out[0] = sigma * (ex - f1 * sx)
    out[1] = sigma * (ey - f1 * sy)
    out[2] = -sigma * f1
    bend = kr / r * f1
    out[3] = sigma * (ey * ey / r - f2 * sx * sx + 2.0 * bend * ex * ey)
    out[4] = sigma * (-ex * ey / r - f2 * sx * sy + bend * (ey * ey - ex * ex))
    out[5] = -sigma * f2 * sx
    out[6] = out[4]
    out[7] = sigma * (ex * ex / r - f2 * sy * sy - 2.0 * bend * ex * ey)
    out[8] = -sigma * f2 * sy
    out[9] = out[5]
    out[10] = out[8]
    out[11] = -sigma * f2
    return sigma * (r - f)


@kernel()
def edge_vectors(theta: float, profile: Array, out: Array) -> None:
    """Sets the edge point at an azimuth and its first two derivatives, each of three numbers."""
    k = profile[pk.LEAD] / TWO_PI
    r, d1, d2 = pk.jet(-k * theta, profile)
    dr, ddr = -k * d1, k * k * d2
    c, s = math.cos(theta), math.sin(theta)
    out[0], out[1], out[2] = r * c, r * s, 0.0
    out[3], out[4], out[5] = dr * c - r * s, dr * s + r * c, 0.0
    out[6], out[7], out[8] = (ddr - r) * c - 2.0 * dr * s, (ddr - r) * s + 2.0 * dr * c, 0.0


@kernel()
def moved_point(of_bolt: bool, place: Array, x: float, y: float, z: float) -> tuple[float, float, float]:
    """A point of one part in the other part's frame: of the bolt in the nut's, or of the nut in the bolt's."""
    m = place[N_ROTATION : N_ROTATION + 9]
    if of_bolt:
        return (
            m[0] * x + m[1] * y + m[2] * z + place[N_OFFSET],
            m[3] * x + m[4] * y + m[5] * z + place[N_OFFSET + 1],
            m[6] * x + m[7] * y + m[8] * z + place[N_OFFSET + 2],
        )
    x, y, z = x - place[N_OFFSET], y - place[N_OFFSET + 1], z - place[N_OFFSET + 2]
    return m[0] * x + m[3] * y + m[6] * z, m[1] * x + m[4] * y + m[7] * z, m[2] * x + m[5] * y + m[8] * z


@kernel()
def moved_vector(of_bolt: bool, place: Array, x: float, y: float, z: float) -> tuple[float, float, float]:
    """A vector of one part in the other part's frame."""
    m = place[N_ROTATION : N_ROTATION + 9]
    if of_bolt:
        return m[0] * x + m[1] * y + m[2] * z, m[3] * x + m[4] * y + m[5] * z, m[6] * x + m[7] * y + m[8] * z
    return m[0] * x + m[3] * y + m[6] * z, m[1] * x + m[4] * y + m[7] * z, m[2] * x + m[5] * y + m[8] * z


@kernel()
def set_edge_jet(of_bolt: bool, theta: float, place: Array, curve: Array, solid: Array, out: Array) -> None:
    """Sets g and phi of an edge point, and their derivatives by its azimuth."""
    sigma = 1.0 if of_bolt else -1.0
    k = curve[pk.LEAD] / TWO_PI
    r, d1, d2 = pk.jet(-k * theta, curve)
    dr, ddr = -k * d1, k * k * d2
    c, s = math.cos(theta), math.sin(theta)
    x, y, z = moved_point(of_bolt, place, r * c, r * s, 0.0)
    tx, ty, tz = moved_vector(of_bolt, place, dr * c - r * s, dr * s + r * c, 0.0)
    bx, by, bz = moved_vector(of_bolt, place, (ddr - r) * c - 2.0 * dr * s, (ddr - r) * s + 2.0 * dr * c, 0.0)
    rr = math.sqrt(x * x + y * y)
    f, f1, f2 = pk.jet(z - k * math.atan2(y, x), solid)
    ex, ey = x / rr, y / rr
    kr = k / rr
    tr, tt = tx * ex + ty * ey, ty * ex - tx * ey
    br, bt = bx * ex + by * ey, by * ex - bx * ey
    ts, bs = tz - kr * tt, bz - kr * bt
    out[E_G] = -sigma * z
    out[E_G1] = -sigma * tz
    out[E_G2] = -sigma * bz
    out[E_PHI] = sigma * (rr - f)
    out[E_PHI1] = sigma * (tr - f1 * ts)
    out[E_PHI2] = sigma * (br - f1 * bs + tt * tt / rr - f2 * ts * ts - 2.0 * f1 * kr / rr * tr * tt)


@kernel()
def edge_depth(of_bolt: bool, theta: float, place: Array, curve: Array, solid: Array) -> float:
    """The lesser of g and phi of an edge point."""
    sigma = 1.0 if of_bolt else -1.0
    k = curve[pk.LEAD] / TWO_PI
    r = pk.radius(-k * theta, curve)
    x, y, z = moved_point(of_bolt, place, r * math.cos(theta), r * math.sin(theta), 0.0)
    return min(-sigma * z, sigma * (math.sqrt(x * x + y * y) - pk.radius(z - k * math.atan2(y, x), solid)))


@kernel()
def add_second_order(
    of_bolt: bool, weight: float, gradient: Array, arm: Array, place: Array, hessian: Array, scratch: Array
) -> None:
    """Adds what the curvature of a turn gives to the Hessian by (w, C): ``gradient`` by the moved point, in its
    frame.
    """
    m = place[N_ROTATION : N_ROTATION + 9]
    if of_bolt:
        for i in range(3):
            scratch[i] = m[i] * gradient[0] + m[3 + i] * gradient[1] + m[6 + i] * gradient[2]
    else:
        for i in range(3):
            scratch[i] = gradient[i]
    along = scratch[0] * arm[0] + scratch[1] * arm[1] + scratch[2] * arm[2]
    for i in range(3):
        for j in range(3):
            hessian[i, j] += weight * 0.5 * (scratch[j] * arm[i] + scratch[i] * arm[j])
        hessian[i, i] -= weight * along
    if not of_bolt:
        for j in range(3):
            # gradient . (unit(i) x row j of the rotation) = (row j x gradient)_i
            x, y, z = m[3 * j], m[3 * j + 1], m[3 * j + 2]
            cx = y * gradient[2] - z * gradient[1]
            cy = z * gradient[0] - x * gradient[2]
            cz = x * gradient[1] - y * gradient[0]
            hessian[0, 3 + j] += weight * cx
            hessian[1, 3 + j] += weight * cy
            hessian[2, 3 + j] += weight * cz
            hessian[3 + j, 0] += weight * cx
            hessian[3 + j, 1] += weight * cy
            hessian[3 + j, 2] += weight * cz


@kernel()
def set_point_derivatives(of_bolt: bool, arm: Array, place: Array, out: Array) -> None:
    """Sets the derivative of the moved point by (w, C): 3 x 6."""
    m = place[N_ROTATION : N_ROTATION + 9]
    ax, ay, az = arm[0], arm[1], arm[2]
    if of_bolt:
        # R (unit(i) x arm)
        for i in range(3):
            out[i, 0] = -m[3 * i + 1] * az + m[3 * i + 2] * ay
            out[i, 1] = m[3 * i] * az - m[3 * i + 2] * ax
            out[i, 2] = -m[3 * i] * ay + m[3 * i + 1] * ax
            for j in range(3):
                out[i, 3 + j] = 1.0 if i == j else 0.0
        return
    # -unit(i) x arm
    out[0, 0], out[1, 0], out[2, 0] = 0.0, az, -ay
    out[0, 1], out[1, 1], out[2, 1] = -az, 0.0, ax
    out[0, 2], out[1, 2], out[2, 2] = ay, -ax, 0.0
    for i in range(3):
        for j in range(3):
            out[i, 3 + j] = -m[3 * j + i]


@kernel()
def set_gap(
    pair: int,
    theta: float,
    z: float,
    stays: bool,
    place: Array,
    device: Array,
    bolt: Array,
    nut: Array,
    work: Array,
    gap: Array,
) -> None:
    """Sets a place of overlap whose deepest point is known, with all derivatives by the coordinates.

    Where it ``stays`` they are those of the depth of this point of the part, which the deepest one may leave behind; a
    crossing of edges never does.
    """
    of_bolt = not (pair == BASE_EDGE or pair == THREAD_EDGE)
    on_thread = pair == THREAD_THREAD
    sigma = 1.0 if of_bolt else -1.0
    curve = bolt if of_bolt else nut
    solid = nut if of_bolt else bolt
    vectors = work[0:18]
    parameters = 2 if on_thread else 1
    if on_thread:
        # Along the helix (theta + u, z + k u) and along the axis; the last is the mixed derivative.
        k = bolt[pk.LEAD] / TWO_PI
        r, d1, d2 = pk.jet(z - k * theta, bolt)
        c, s = math.cos(theta), math.sin(theta)
        vectors[0], vectors[1], vectors[2] = r * c, r * s, z
        vectors[3], vectors[4], vectors[5] = -r * s, r * c, k
        vectors[6], vectors[7], vectors[8] = -r * c, -r * s, 0.0
        vectors[9], vectors[10], vectors[11] = d1 * c, d1 * s, 1.0
        vectors[12], vectors[13], vectors[14] = d2 * c, d2 * s, 0.0
        vectors[15], vectors[16], vectors[17] = -d1 * s, d1 * c, 0.0
    else:
        edge_vectors(theta, curve, vectors)
    x, y, zz = moved_point(of_bolt, place, vectors[0], vectors[1], vectors[2])
    arm = work[18:21]
    if of_bolt:
        arm[0], arm[1], arm[2] = vectors[0], vectors[1], vectors[2] - device[D_CENTRE]
    else:
        arm[0], arm[1], arm[2] = x, y, zz - device[D_CENTRE]
    first = work[21:39].reshape((3, 6))
    set_point_derivatives(of_bolt, arm, place, first)
    jet = work[39:51]
    phi = solid_jet(x, y, zz, solid, sigma, jet)
    # The weights of g and phi: their gradients' combination does not change along an edge.
    g = -sigma * zz
    on_plane, on_solid = 0.0, 1.0
    moved = work[51:57]
    for i in range(parameters):
        a, b, d = moved_vector(of_bolt, place, vectors[3 + 6 * i], vectors[4 + 6 * i], vectors[5 + 6 * i])
        moved[3 * i], moved[3 * i + 1], moved[3 * i + 2] = a, b, d
    g1 = -sigma * moved[2]
    phi1 = jet[0] * moved[0] + jet[1] * moved[1] + jet[2] * moved[2]
    if pair == EDGE_SURFACE or pair == BASE_EDGE:
        on_plane, on_solid = 1.0, 0.0
    elif pair == EDGE_EDGE:
        on_plane = phi1 / (phi1 - g1)
        on_solid = 1.0 - on_plane
    value = on_plane * g + on_solid * phi
    slope = work[57:60]
    for i in range(3):
        slope[i] = on_solid * jet[i]
    slope[2] -= on_plane * sigma
    gradient = gap[G_GRADIENT : G_GRADIENT + 6]
    hessian = gap[G_HESSIAN : G_HESSIAN + 36].reshape((6, 6))
    # The Hessian of phi times the derivative of the point, 3 x 6, then both derivatives by the coordinates.
    bent = work[60:78].reshape((3, 6))
    for i in range(3):
        for j in range(6):
            bent[i, j] = on_solid * (
                jet[3 + 3 * i] * first[0, j] + jet[4 + 3 * i] * first[1, j] + jet[5 + 3 * i] * first[2, j]
            )
    for j in range(6):
        gradient[j] = slope[0] * first[0, j] + slope[1] * first[1, j] + slope[2] * first[2, j]
        for i in range(6):
            hessian[i, j] = first[0, i] * bent[0, j] + first[1, i] * bent[1, j] + first[2, i] * bent[2, j]
    add_second_order(of_bolt, 1.0, slope, arm, place, hessian, work[78:81])
    # By a parameter and the coordinates; by parameters twice.
    mixed = work[81:93].reshape((2, 6))
    twice = work[93:96]
    for i in range(parameters):
        for j in range(6):
            mixed[i, j] = moved[3 * i] * bent[0, j] + moved[3 * i + 1] * bent[1, j] + moved[3 * i + 2] * bent[2, j]
        if of_bolt:
            vx, vy, vz = vectors[3 + 6 * i], vectors[4 + 6 * i], vectors[5 + 6 * i]
            gx, gy, gz = moved_vector(False, place, slope[0], slope[1], slope[2])
            mixed[i, 0] += vy * gz - vz * gy
            mixed[i, 1] += vz * gx - vx * gz
            mixed[i, 2] += vx * gy - vy * gx
        else:
            vx, vy, vz = moved[3 * i], moved[3 * i + 1], moved[3 * i + 2]
            mixed[i, 0] -= vy * slope[2] - vz * slope[1]
            mixed[i, 1] -= vz * slope[0] - vx * slope[2]
            mixed[i, 2] -= vx * slope[1] - vy * slope[0]
    for i in range(parameters + parameters - 1):
        # First parameter twice, second twice, both.
        source = 6 if i == 0 else (12 if i == 1 else 15)
        a, b, d = moved_vector(of_bolt, place, vectors[source], vectors[source + 1], vectors[source + 2])
        m, n = (0, 0) if i == 0 else ((1, 1) if i == 1 else (0, 1))
        total = slope[0] * a + slope[1] * b + slope[2] * d
        for j in range(3):
            for h in range(3):
                total += on_solid * moved[3 * m + j] * jet[3 + 3 * j + h] * moved[3 * n + h]
        twice[i] = total
    if pair == EDGE_EDGE:
        # The crossing moves such that g and phi stay the same.
        moves = work[96:102]
        for j in range(6):
            difference = -sigma * first[2, j]
            for i in range(3):
                difference -= jet[i] * first[i, j]
            moves[j] = -difference / (g1 - phi1)
        for i in range(6):
            for j in range(6):
                hessian[i, j] += mixed[0, i] * moves[j] + moves[i] * mixed[0, j] + twice[0] * moves[i] * moves[j]
    elif on_thread and not stays:
        determinant = twice[0] * twice[1] - twice[2] * twice[2]
        for i in range(6):
            for j in range(6):
                hessian[i, j] -= (
                    mixed[0, i] * (twice[1] * mixed[0, j] - twice[2] * mixed[1, j])
                    + mixed[1, i] * (twice[0] * mixed[1, j] - twice[2] * mixed[0, j])
                ) / determinant
    elif not stays and -twice[0] > LEAST_BEND * bolt[pk.R_MAJOR]:
        for i in range(6):
            for j in range(6):
                hessian[i, j] -= mixed[0, i] * mixed[0, j] / twice[0]
    to_chart(place, gradient, hessian, work[102:150])
    gap[G_PAIR] = pair
    gap[G_THETA] = theta
    gap[G_Z] = z
    gap[G_VALUE] = value
    if of_bolt:
        gap[G_POINT], gap[G_POINT + 1], gap[G_POINT + 2] = x, y, zz
    else:
        gap[G_POINT], gap[G_POINT + 1], gap[G_POINT + 2] = vectors[0], vectors[1], vectors[2]
    norm = math.sqrt(gradient[3] ** 2 + gradient[4] ** 2 + gradient[5] ** 2)
    gap[G_NORM] = norm
    for i in range(3):
        gap[G_NORMAL + i] = -gradient[3 + i] / norm


GAP_WORK = 150
