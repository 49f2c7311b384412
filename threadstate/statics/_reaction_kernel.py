"""The least wrench that must be added to a load so that contacts balance it at a friction (forces, section 3).

It is what is left of the load after its projection on the cone of what the contacts balance, a second-order cone
program. Lengths are over the pair's nominal radius; wrenches are (moment, force).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.statics._grasp_kernel import set_frames, set_matrix
from threadstate.statics._program_kernel import program_at

Array = NDArray[np.float64]


@kernel()
def reaction_with(
    program: int, load: Array, mu: float, points: Array, normals: Array, reaction: Array, twist: Array
) -> float:
    """Sets the least wrench that must be added to ``load`` at ``mu``; the contacts have shape (k, 3).

    ``twist`` (6), of norm 1 at most, is set to a motion along which the load's work is the size of the least reaction.

    Returns:
        Its size; infinite where the program was not solved.
    """
    k = points.shape[0]
    frames = np.empty((k, 2, 3))
    set_frames(normals, frames)
    matrix = np.empty((3 * k, 6))
    set_matrix(points, matrix)
    # Variables: the normal part of each force, its tangential ones if there is friction, and the size of what is left.
    d = 1 if mu == 0.0 else 3
    n = d * k + 1
    wrenches = np.zeros((6, d * k))
    for i in range(k):
        for m in range(6):
            for j in range(3):
                wrenches[m, d * i] += normals[i, j] * matrix[3 * i + j, m]
                for q in range(d - 1):
                    wrenches[m, d * i + 1 + q] += frames[i, q, j] * matrix[3 * i + j, m]
    c = np.zeros(n)
    c[n - 1] = 1.0
    g = np.zeros((7 + d * k, n))
    h = np.zeros(7 + d * k)
    sizes = np.empty(k + 1, np.intp)
    sizes[:] = d
    sizes[0] = 7
    g[0, n - 1] = -1.0
    for m in range(6):
        h[1 + m] = load[m]
        for j in range(d * k):
            g[1 + m, j] = -wrenches[m, j]
    for i in range(k):
        g[7 + d * i, d * i] = -1.0 if d == 1 else -mu
        for q in range(d - 1):
            g[8 + d * i + q, d * i + 1 + q] = -1.0
    x = np.zeros(n)
    z = np.zeros(7 + d * k)
    gap = program_at(program)(c, g, h, sizes, x, z)
    if not gap < math.inf:
        return math.inf
    for m in range(6):
        reaction[m] = -load[m]
        twist[m] = -z[1 + m]
    for i in range(k):
        # Into the cone, where round-off has left it.
        normal = max(x[d * i], 0.0)
        across = 0.0
        for q in range(d - 1):
            across = math.hypot(across, x[d * i + 1 + q])
        share = 1.0 if across <= mu * normal else mu * normal / across
        for m in range(6):
            reaction[m] -= wrenches[m, d * i] * normal
            for q in range(d - 1):
                reaction[m] -= share * wrenches[m, d * i + 1 + q] * x[d * i + 1 + q]
    size = 0.0
    for m in range(6):
        size += reaction[m] * reaction[m]
    return math.sqrt(size)


@kernel()
def least_withstood(twist: Array, mu: float, points: Array, normals: Array) -> tuple[float, int]:
    """The least work, over the normal force, that a force within its cone does along a twist, and at which contact.

    Where it is not negative no contact works against the twist: no reaction is smaller than the load's work along it.
    """
    least, at = math.inf, 0
    for i in range(points.shape[0]):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        vx = twist[3] + twist[1] * z - twist[2] * y
        vy = twist[4] + twist[2] * x - twist[0] * z
        vz = twist[5] + twist[0] * y - twist[1] * x
        along = vx * normals[i, 0] + vy * normals[i, 1] + vz * normals[i, 2]
        tx, ty, tz = vx - along * normals[i, 0], vy - along * normals[i, 1], vz - along * normals[i, 2]
        work = along - mu * math.sqrt(tx * tx + ty * ty + tz * tz)
        if work < least:
            least, at = work, i
    return least, at
