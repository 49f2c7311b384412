"""How far a load is from what contacts without friction balance (forces, section 3).

The distance is that of the negative load, made of norm 1, from the boundary of the contacts' cone within the cone's
span: positive inside, negative outside. Lengths are over the pair's nominal radius; wrenches are (moment, force).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.statics._cone_kernel import factor, solve_factored, solve_program

Array = NDArray[np.float64]

SPAN_TOLERANCE = 1e-9
"""A load that is no farther from a cone lies in it: half the digits of a double, and beyond those of a contact."""


FEW_RAYS = 4
"""Up to so many rays each face of their cone is tried; the faces double with every ray."""


@kernel(allocates=True)
def support_margin(load: Array, points: Array, normals: Array) -> float:
    """The margin of a load on contacts at points (k, 3) with normals (k, 3).

    Dependent rays (a strip of flank): a load among them is supported, but how far it is from the sides of their cone is
    not computed: 0.
    """
    k = points.shape[0]
    rays = np.empty((k, 6))
    unit = scratch(6)
    size = 0.0
    for m in range(6):
        size += load[m] * load[m]
    for m in range(6):
        unit[m] = load[m] / math.sqrt(size)
    for i in range(k):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        nx, ny, nz = normals[i, 0], normals[i, 1], normals[i, 2]
        rays[i, 0], rays[i, 1], rays[i, 2] = y * nz - z * ny, z * nx - x * nz, x * ny - y * nx
        rays[i, 3], rays[i, 4], rays[i, 5] = nx, ny, nz
    distance = distance_by_faces(unit, rays) if k <= FEW_RAYS else distance_by_program(unit, rays)
    if distance > SPAN_TOLERANCE:
        return -distance
    depth = depth_in_simplex(unit, rays)
    return max(depth, 0.0) if not math.isnan(depth) else 0.0


@kernel(allocates=True)
def distance_by_faces(load: Array, rays: Array) -> float:
    """The distance of ``-load`` from the cone of rays (k, 6): the least of those from the faces it projects into."""
    k = rays.shape[0]
    least = 0.0
    for m in range(6):
        least += load[m] * load[m]
    chosen = np.empty(k, np.intp)
    for face in range(1, 1 << k):
        count = 0
        for i in range(k):
            if face >> i & 1:
                chosen[count] = i
                count += 1
        gram = np.empty((count, count))
        shares = np.zeros(count)
        for a in range(count):
            for m in range(6):
                shares[a] -= rays[chosen[a], m] * load[m]
            for b in range(count):
                gram[a, b] = 0.0
                for m in range(6):
                    gram[a, b] += rays[chosen[a], m] * rays[chosen[b], m]
        # Of dependent rays fewer span the same face.
        if not factor(gram):
            continue
        solve_factored(gram, shares)
        lowest = shares[0]
        for a in range(1, count):
            lowest = min(lowest, shares[a])
        if lowest < 0.0:
            continue
        squared = 0.0
        for m in range(6):
            left = load[m]
            for a in range(count):
                left += shares[a] * rays[chosen[a], m]
            squared += left * left
        least = min(least, squared)
    return math.sqrt(least)


@kernel(allocates=True)
def distance_by_program(load: Array, rays: Array) -> float:
    """As :func:`distance_by_faces`, for any number of rays, by the solver of cone programs."""
    k = rays.shape[0]
    g = np.zeros((7 + k, k + 1))
    h = np.zeros(7 + k)
    c = np.zeros(k + 1)
    sizes = np.ones(k + 1, np.intp)
    sizes[0] = 7
    c[k] = 1.0
    g[0, k] = -1.0
    for m in range(6):
        h[1 + m] = load[m]
        for i in range(k):
            g[1 + m, i] = -rays[i, m]
    for i in range(k):
        g[7 + i, i] = -1.0
    x = np.zeros(k + 1)
    z = np.zeros(7 + k)
    solve_program(c, g, h, sizes, x, z)
    distance = 0.0
    for m in range(6):
        left = load[m]
        for i in range(k):
            left += max(x[i], 0.0) * rays[i, m]
        distance += left * left
    return math.sqrt(distance)


@kernel(allocates=True)
def depth_in_simplex(load: Array, rays: Array) -> float:
    """The distance of ``-load`` from the sides of the cone of rays that it lies in; NaN if the rays are dependent.

    It is the least, over the rays, of the load's share of a ray times the ray's distance from the span of the others.
    """
    k = rays.shape[0]
    gram = np.empty((k, k))
    shares = np.empty(k)
    for i in range(k):
        shares[i] = 0.0
        for m in range(6):
            shares[i] -= rays[i, m] * load[m]
        for j in range(k):
            gram[i, j] = 0.0
            for m in range(6):
                gram[i, j] += rays[i, m] * rays[j, m]
    if not factor(gram):
        return math.nan
    solve_factored(gram, shares)
    unit = np.empty(k)
    depth = math.inf
    for i in range(k):
        unit[:] = 0.0
        unit[i] = 1.0
        solve_factored(gram, unit)
        depth = min(depth, shares[i] / math.sqrt(unit[i]))
    return depth


@kernel()
def patch_margin(load: Array, hull: Array) -> float:
    """The margin of a load on a level patch whose hull (n, 2) runs counter-clockwise.

    The load's moments are about a point of the patch's plane, the hull's coordinates from there.
    """
    n = hull.shape[0]
    # The patch carries a push along z and its moments; each side of its cone holds two neighbours of the hull.
    size = 0.0
    for m in range(6):
        size += load[m] * load[m]
    size = math.sqrt(size)
    mx, my, fz = -load[0] / size, -load[1] / size, -load[5] / size
    across = (load[2] * load[2] + load[3] * load[3] + load[4] * load[4]) / (size * size)
    inside = math.inf
    for i in range(n):
        j = (i + 1) % n
        ax, ay = hull[i, 0], hull[i, 1]
        bx, by = hull[j, 0], hull[j, 1]
        # Rays (y, -x, 1): their cross product points into the cone.
        nx, ny, nz = bx - ax, by - ay, ax * by - ay * bx
        size = math.sqrt(nx * nx + ny * ny + nz * nz)
        inside = min(inside, (nx * mx + ny * my + nz * fz) / size)
    if inside >= 0.0:
        return inside if across <= SPAN_TOLERANCE * SPAN_TOLERANCE else -math.sqrt(across)
    distance = math.inf
    for i in range(n):
        j = (i + 1) % n
        distance = min(distance, distance_to_side(mx, my, fz, hull[i], hull[j]))
    return -math.sqrt(distance * distance + across)


@kernel()
def distance_to_side(mx: float, my: float, fz: float, a: Array, b: Array) -> float:
    """The distance of (mx, my, fz) from the plane cone of the rays (y, -x, 1) of two points."""
    aa = a[0] * a[0] + a[1] * a[1] + 1.0
    bb = b[0] * b[0] + b[1] * b[1] + 1.0
    ab = a[0] * b[0] + a[1] * b[1] + 1.0
    pa = a[1] * mx - a[0] * my + fz
    pb = b[1] * mx - b[0] * my + fz
    determinant = aa * bb - ab * ab
    s, t = 0.0, 0.0
    if determinant > 0.0:
        s = (bb * pa - ab * pb) / determinant
        t = (aa * pb - ab * pa) / determinant
    if determinant <= 0.0 or s < 0.0 or t < 0.0:
        on_a, on_b = max(pa, 0.0) / aa, max(pb, 0.0) / bb
        if on_a * on_a * aa >= on_b * on_b * bb:
            s, t = on_a, 0.0
        else:
            s, t = 0.0, on_b
    x = mx - s * a[1] - t * b[1]
    y = my + s * a[0] + t * b[0]
    z = fz - s - t
    return math.sqrt(x * x + y * y + z * z)
