"""Whether an onset is a contact: whether the wedge of both faces at the edge point is outside the other part there.

Else an overlap is open already. Where two edges cross, the plane that may separate the solids is that of both tangents;
how near its signs are to changing is told as well (docs/certificate.md, section 6).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact import _wide_kernel as wide
from threadstate.contact._beside_kernel import BESIDE, K_G, K_PHI, nearest_contact
from threadstate.contact._box_kernel import ONE_EDGE, ONE_THREAD
from threadstate.contact._double_double_kernel import Pair, add, azimuth
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._geometry_kernel import (
    M_KIND,
    M_SIGMA,
    TWO_PI,
    edge_point,
    phi_and_gradient,
    set_path,
    turn_vector,
    velocity,
)
from threadstate.contact._onset_kernel import J_X, J_Y, J_Z, jet_errors, onset_step
from threadstate.contact._range_kernel import error_beside, size_numbers
from threadstate.contact._refined_edge_kernel import REFINED_ERROR, is_refined, placement_at
from threadstate.contact._wide_kernel import MINUS_ONE, ZERO, Vector
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

LEAST_SINE = 1e-12
"""Edges at a smaller angle have no common normal in doubles."""

TANGENT_ERROR = 4e-15
"""What the directions of both tangents are rounded off by: that of a pose in doubles and of three products each."""

REFINED_TANGENT_ERROR = 1e-28
"""The same of refined edges."""

WEDGE_SIZE = 9

AZIMUTH_ROUNDING = 4e-16
"""Of an azimuth of up to a radian that is stored as a double."""


@kernel()
def set_wedge(theta: float, profile: Array, sigma: float, out: Array) -> None:
    """Unit vectors at the edge point: along the edge (counter-clockwise), into the flat face, into the thread face."""
    x, y, ex, ey = edge_point(theta, profile)
    n = math.hypot(ex, ey)
    ex /= n
    ey /= n
    _, gx, gy, gz = phi_and_gradient(x, y, 0.0, profile, sigma)
    out[0] = ex
    out[1] = ey
    out[2] = 0.0
    out[3] = sigma * ey
    out[4] = -sigma * ex
    out[5] = 0.0
    tx = -gz * ey
    ty = gz * ex
    tz = gx * ey - gy * ex
    n = math.sqrt(tx * tx + ty * ty + tz * tz)
    if sigma * tz > 0.0:
        n = -n
    out[6] = tx / n
    out[7] = ty / n
    out[8] = tz / n


@kernel()
def dot(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> float:
    """Scalar product."""
    return ax * bx + ay * by + az * bz


@kernel()
def wedge_components(motion: Array, tau: float, wedge: Array, nx: float, ny: float, nz: float) -> tuple[float, float]:
    """Components along n of the two face directions at the edge point (``set_wedge``) after ``tau``."""
    ax, ay, az = turn_vector(wedge[3], wedge[4], wedge[5], motion, tau)
    bx, by, bz = turn_vector(wedge[6], wedge[7], wedge[8], motion, tau)
    return dot(ax, ay, az, nx, ny, nz), dot(bx, by, bz, nx, ny, nz)


class Crossing(NamedTuple):
    """Two edges that cross: the sine of their angle, and components along their common normal.

    ``curve_1`` and ``curve_2`` are those of the directions into the two faces at the edge curve, ``solid_1`` and
    ``solid_2`` into those at the solid's edge (``set_wedge``).
    """

    sine: float
    curve_1: float
    curve_2: float
    solid_1: float
    solid_2: float


@kernel()
def crossing_at(curve_theta: float, solid_theta: float, tau: float, edge: Edge, wedge: Array) -> Crossing:
    """The crossing of two edges at an onset."""
    sigma = edge.motion[M_SIGMA]
    set_wedge(curve_theta, edge.curve, -sigma, wedge)
    ex, ey, ez = turn_vector(wedge[0], wedge[1], wedge[2], edge.motion, tau)
    _, _, sx, sy = edge_point(solid_theta, edge.solid)
    n = math.hypot(sx, sy)
    sx /= n
    sy /= n
    nx = -ez * sy
    ny = ez * sx
    nz = ex * sy - ey * sx
    n = math.sqrt(nx * nx + ny * ny + nz * nz)
    if n < LEAST_SINE:
        return Crossing(n, 0.0, 0.0, 0.0, 0.0)
    nx /= n
    ny /= n
    nz /= n
    c1, c2 = wedge_components(edge.motion, tau, wedge, nx, ny, nz)
    set_wedge(solid_theta, edge.solid, sigma, wedge)
    s1 = dot(wedge[3], wedge[4], wedge[5], nx, ny, nz)
    s2 = dot(wedge[6], wedge[7], wedge[8], nx, ny, nz)
    return Crossing(n, c1, c2, s1, s2)


@kernel()
def unit_component(v: Vector, n: Vector) -> float:
    """The component of a vector along another one, both as unit vectors."""
    return wide.dot(v, n)[0] / math.sqrt(wide.dot(v, v)[0] * wide.dot(n, n)[0])


@kernel()
def wide_wedge(theta: Pair, profile: Array, sigma: float) -> tuple[Vector, Vector, Vector]:
    """The vectors of ``set_wedge``, of any length."""
    k = wide.advance(profile)
    _, along, up = wide.thread_point(theta, ZERO, profile)
    ex, ey, ez = wide.edge_slope(along, up, k)
    inward = wide.times((ey, wide.times((ex, ZERO, ZERO), MINUS_ONE)[0], ZERO), (sigma, 0.0))
    thread = wide.cross(wide.cross(along, up), (ex, ey, ez))
    if sigma * thread[2][0] > 0.0:
        thread = wide.times(thread, MINUS_ONE)
    return (ex, ey, ZERO), inward, thread


@kernel()
def refined_crossing(theta: Pair, tau: Pair, edge: Edge) -> Crossing:
    """The crossing of two refined edges."""
    sigma = edge.motion[M_SIGMA]
    place = placement_at(tau, edge.motion, edge.wide)
    m3 = wide.cross(place.m1, place.m2)
    at, _, _ = wide.thread_point(theta, ZERO, edge.curve)
    x = wide.plus(place.origin, wide.plus(wide.times(place.m1, at[0]), wide.times(place.m2, at[1])))
    e, inward, thread = wide_wedge(theta, edge.curve, -sigma)
    s, solid_inward, solid_thread = wide_wedge(azimuth(x[0], x[1]), edge.solid, sigma)
    e = wide.plus(wide.times(place.m1, e[0]), wide.times(place.m2, e[1]))
    inward = wide.plus(wide.times(place.m1, inward[0]), wide.times(place.m2, inward[1]))
    thread = wide.plus(
        wide.plus(wide.times(place.m1, thread[0]), wide.times(place.m2, thread[1])), wide.times(m3, thread[2])
    )
    n = wide.cross(e, s)
    squared = wide.dot(n, n)[0]
    sine = math.sqrt(squared / (wide.dot(e, e)[0] * wide.dot(s, s)[0]))
    if sine < LEAST_SINE:
        return Crossing(sine, 0.0, 0.0, 0.0, 0.0)
    return Crossing(
        sine,
        unit_component(inward, n),
        unit_component(thread, n),
        unit_component(solid_inward, n),
        unit_component(solid_thread, n),
    )


@kernel()
def refined_root(theta: float, tau: float, jet: Array) -> tuple[Pair, Pair]:
    """The azimuth and the time of a crossing of refined edges, a step of Newton's method beyond their doubles."""
    _, d_theta, d_tau, _, _ = onset_step(int(ONE_EDGE), jet, 0.0, 0.0)
    return add((theta, 0.0), (d_theta, 0.0)), add((tau, 0.0), (d_tau, 0.0))


@kernel()
def crossing_of(kind: int, theta: float, tau: float, edge: Edge, jet: Array, wedge: Array) -> Crossing:
    """The crossing at an onset of a kind of box; with an angle of zero where no edges cross."""
    if kind != ONE_EDGE:
        return Crossing(0.0, 0.0, 0.0, 0.0, 0.0)
    if is_refined(edge):
        at, time = refined_root(theta, tau, jet)
        return refined_crossing(at, time, edge)
    return crossing_at(theta, math.atan2(jet[J_Y], jet[J_X]), tau, edge, wedge)


@kernel()
def separates(one: Crossing, tolerance: float) -> bool:
    """Whether the common normal is that of a plane with a wedge on either side, up to a tolerance of its components."""
    low, high = min(one.curve_1, one.curve_2), max(one.curve_1, one.curve_2)
    least, most = min(one.solid_1, one.solid_2), max(one.solid_1, one.solid_2)
    return one.sine >= LEAST_SINE and (
        (low >= -tolerance and most <= tolerance) or (high <= tolerance and least >= -tolerance)
    )


@kernel()
def tangent_rate(theta: float, profile: Array) -> float:
    """By how much the tangent of an edge turns per rad of its azimuth."""
    k = profile[pk.LEAD] / TWO_PI
    r, d1, d2 = pk.jet(-k * theta, profile)
    dr, ddr = -k * d1, k * k * d2
    return abs(r * r + 2.0 * dr * dr - r * ddr) / (r * r + dr * dr)


@kernel(forceinline=True)
def tangent_error(edge: Edge) -> float:
    """What the directions of both tangents at a crossing are rounded off by."""
    return REFINED_TANGENT_ERROR if is_refined(edge) else TANGENT_ERROR


@kernel()
def crossing_errors(theta: float, tau: float, edge: Edge) -> tuple[float, float]:
    """Bounds on the round-off of g and of phi where two edges cross (docs/certificate.md, section 6)."""
    error, _ = jet_errors(tau, edge)
    nearest, _, row = nearest_contact(theta, edge.kept)
    if not abs(nearest) < BESIDE:
        return error, error
    beside = error_beside(tau, size_numbers(edge.motion, edge.curve, edge.solid)) * abs(nearest)
    beside *= REFINED_ERROR if is_refined(edge) else 1.0
    kept = edge.kept
    return beside if kept[row, K_G] != 0.0 else error, beside if kept[row, K_PHI] != 0.0 else error


@kernel()
def is_beyond_end(jet: Array, edge: Edge) -> bool:
    """Whether an onset is beyond the far end of the solid, which is one thread pitch long."""
    return -edge.motion[M_SIGMA] * jet[J_Z] > edge.solid[pk.P]


@kernel()
def crossing_beside(
    theta: float, tau: float, d_theta: float, d_tau: float, edge: Edge, jet: Array, wedge: Array
) -> Crossing:
    """The crossing of two edges so far beside an onset, where the solid's edge is as near."""
    if is_refined(edge):
        at, time = refined_root(theta, tau, jet)
        return refined_crossing(add(at, (d_theta, 0.0)), add(time, (d_tau, 0.0)), edge)
    x, y, ex, ey = edge_point(theta, edge.curve)
    tx, ty, _ = turn_vector(ex, ey, 0.0, edge.motion, tau)
    set_path(x, y, edge.motion, edge.path)
    vx, vy, _ = velocity(edge.path, tau, edge.motion[M_KIND] != 0.0)
    at_x, at_y = jet[J_X], jet[J_Y]
    way_x, way_y = tx * d_theta + vx * d_tau, ty * d_theta + vy * d_tau
    turn = (at_x * way_y - at_y * way_x) / (at_x * at_x + at_y * at_y)
    return crossing_at(theta + d_theta, math.atan2(at_y, at_x) + turn, tau + d_tau, edge, wedge)


@kernel()
def changes_at_corners(
    theta: float, tau: float, t_error: float, tau_error: float, edge: Edge, jet: Array, wedge: Array
) -> bool:
    """Whether it changes if a crossing is a contact at the corners of what round-off makes of its place and time.

    Along two edges that all but touch both tangents turn by nearly the same: less than by their sum.
    """
    is_contact_there = False
    for i in range(4):
        d_theta, d_tau = t_error if i % 2 == 0 else -t_error, tau_error if i < 2 else -tau_error
        one = crossing_beside(theta, tau, d_theta, d_tau, edge, jet, wedge)
        if not one.sine >= LEAST_SINE:
            return True
        tolerance = tangent_error(edge) / one.sine
        there = separates(one, tolerance)
        if there != separates(one, -tolerance) or (i > 0 and there != is_contact_there):
            return True
        is_contact_there = there
    return False


@kernel()
def is_doubtful(
    theta: float, tau: float, crossing: Crossing, tie_tolerance: float, edge: Edge, jet: Array, wedge: Array
) -> bool:
    """Whether round-off hides if a crossing of two edges is a contact, or when it is to within ``tie_tolerance``.

    Of refined edges the time is what can be known: beside the contact that a turn is about it may be no better.

    Its place and time have an error of that of g and phi over the sine of the edges' angle, and their common normal has
    one of that of the tangents there over this sine once more (docs/certificate.md, section 6).
    """
    if is_beyond_end(jet, edge):
        return False
    is_turn = edge.motion[M_KIND] != 0.0
    x, y, ex, ey = edge_point(theta, edge.curve)
    _, _, _, t_error, tau_error = onset_step(int(ONE_EDGE), jet, *crossing_errors(theta, tau, edge))
    if not is_refined(edge) and not tau_error <= tie_tolerance:
        return True
    set_path(x, y, edge.motion, edge.path)
    vx, vy, _ = velocity(edge.path, tau, is_turn)
    t_error += 0.0 if is_refined(edge) else AZIMUTH_ROUNDING * (1.0 + abs(theta))
    solid_theta = math.atan2(jet[J_Y], jet[J_X])
    along = math.hypot(ex, ey) * t_error + math.hypot(vx, vy) * tau_error
    turned = tangent_rate(theta, edge.curve) * t_error + (tau_error if is_turn else 0.0)
    turned += tangent_rate(solid_theta, edge.solid) * along / edge.solid[pk.R_MINOR] + tangent_error(edge)
    if not crossing.sine >= LEAST_SINE:
        return True
    tolerance = turned / crossing.sine
    if separates(crossing, tolerance) == separates(crossing, -tolerance):
        return False
    return changes_at_corners(theta, tau, t_error, tau_error, edge, jet, wedge)


@kernel()
def face_separated(curve_theta: float, tau: float, nx: float, ny: float, nz: float, edge: Edge, wedge: Array) -> bool:
    """Whether the wedge at the edge point lies on the side of a face to which the face's outward normal n points."""
    set_wedge(curve_theta, edge.curve, -edge.motion[M_SIGMA], wedge)
    c1, c2 = wedge_components(edge.motion, tau, wedge, nx, ny, nz)
    return c1 >= -1e-12 and c2 >= -1e-12


@kernel()
def is_contact(kind: int, theta: float, tau: float, crossing: Crossing, edge: Edge, jet: Array, wedge: Array) -> bool:
    """Whether at an onset the wedge at the edge point is outside the other part; else an overlap is open already.

    ``crossing`` is that of two edges there (``crossing_of``).
    """
    sigma = edge.motion[M_SIGMA]
    x, y, z = jet[J_X], jet[J_Y], jet[J_Z]
    if is_beyond_end(jet, edge):
        return False
    if kind == ONE_EDGE:
        return separates(crossing, 0.0)
    if kind == ONE_THREAD:
        _, gx, gy, gz = phi_and_gradient(x, y, z, edge.solid, sigma)
        n = math.sqrt(gx * gx + gy * gy + gz * gz)
        return face_separated(theta, tau, -gx / n, -gy / n, -gz / n, edge, wedge)
    return face_separated(theta, tau, 0.0, 0.0, sigma, edge, wedge)
