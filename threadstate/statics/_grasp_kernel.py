"""Points that carry forces: the wrenches of their forces, and the velocities that a twist gives them.

Lengths are over the pair's nominal radius, so that moments and forces are of one kind. Wrenches are (moment, force),
twists (angular, linear), both at the origin of the points. Forces act on the bolt; forces of k contacts are 3 k
numbers.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel

Array = NDArray[np.float64]

RANK_TOLERANCE = 1e-10
"""Relative size below which a direction of the contacts' wrenches is none."""


class Grasp(NamedTuple):
    """Contacts with what is computed of them once.

    Attributes:
        normals: shape (k, 3), unit vectors into the bolt.
        frames: shape (k, 2, 3), two unit vectors across each normal.
        matrix: shape (3 k, 6): row 3 i + j is the wrench of a unit force along axis j at point i.
        reflections: shape (6, 3 k), the unit vectors of Q in ``matrix[:, order] = Q R``.
        upper: shape (6, 6), R.
        order: shape (6).
        rank: of the matrix.
    """

    normals: Array
    frames: Array
    matrix: Array
    reflections: Array
    upper: Array
    order: NDArray[np.intp]
    rank: int


@kernel()
def set_frames(normals: Array, frames: Array) -> None:
    """Two unit vectors across each normal; normals of shape (k, 3), frames of shape (k, 2, 3)."""
    for i in range(normals.shape[0]):
        x, y, z = normals[i, 0], normals[i, 1], normals[i, 2]
        # The axis farthest from the normal.
        least = min(abs(x), abs(y), abs(z))
        ax, ay, az = 0.0, 0.0, 0.0
        if abs(z) == least:
            az = 1.0
        elif abs(y) == least:
            ay = 1.0
        else:
            ax = 1.0
        dot = ax * x + ay * y + az * z
        ax -= dot * x
        ay -= dot * y
        az -= dot * z
        size = math.sqrt(ax * ax + ay * ay + az * az)
        ax /= size
        ay /= size
        az /= size
        frames[i, 0, 0], frames[i, 0, 1], frames[i, 0, 2] = ax, ay, az
        frames[i, 1, 0] = y * az - z * ay
        frames[i, 1, 1] = z * ax - x * az
        frames[i, 1, 2] = x * ay - y * ax


@kernel()
def set_matrix(points: Array, matrix: Array) -> None:
    """Sets ``Grasp.matrix`` of points (k, 3)."""
    for i in range(points.shape[0]):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        for j in range(3):
            for m in range(6):
                matrix[3 * i + j, m] = 0.0
            matrix[3 * i + j, 3 + j] = 1.0
        matrix[3 * i, 1], matrix[3 * i, 2] = z, -y
        matrix[3 * i + 1, 0], matrix[3 * i + 1, 2] = -z, x
        matrix[3 * i + 2, 0], matrix[3 * i + 2, 1] = y, -x


@kernel(allocates=True)
def orthogonal_factor(matrix: Array, reflections: Array, upper: Array, order: NDArray[np.intp]) -> int:
    """Householder's QR of the transposed grasp matrix, columns by size; its rank."""
    rows = matrix.shape[0]
    left = matrix.copy()
    for j in range(6):
        order[j] = j
    largest = 0.0
    upper[:, :] = 0.0
    for j in range(min(6, rows)):
        best, at = -1.0, j
        for m in range(j, 6):
            size = 0.0
            for i in range(j, rows):
                size += left[i, m] * left[i, m]
            if size > best:
                best, at = size, m
        if at != j:
            for i in range(rows):
                left[i, j], left[i, at] = left[i, at], left[i, j]
            order[j], order[at] = order[at], order[j]
        size = math.sqrt(best)
        if j == 0:
            largest = size
        if size <= RANK_TOLERANCE * largest:
            for m in range(j, 6):
                for i in range(j):
                    upper[i, m] = left[i, m]
            return j
        sign = -1.0 if left[j, j] > 0.0 else 1.0
        norm = 0.0
        for i in range(rows):
            reflections[j, i] = left[i, j] if i >= j else 0.0
        reflections[j, j] -= sign * size
        for i in range(j, rows):
            norm += reflections[j, i] * reflections[j, i]
        norm = math.sqrt(norm)
        for i in range(j, rows):
            reflections[j, i] /= norm
        for m in range(j, 6):
            dot = 0.0
            for i in range(j, rows):
                dot += reflections[j, i] * left[i, m]
            for i in range(j, rows):
                left[i, m] -= 2.0 * dot * reflections[j, i]
        for m in range(j, 6):
            upper[j, m] = left[j, m]
        for i in range(j):
            upper[i, j] = left[i, j]
    for m in range(6):
        for i in range(min(m + 1, rows)):
            upper[i, m] = left[i, m]
    return min(6, rows)


@kernel(allocates=True)
def new_grasp(points: Array, normals: Array) -> Grasp:
    """The grasp of contacts at points of shape (k, 3)."""
    k = points.shape[0]
    frames = np.empty((k, 2, 3))
    set_frames(normals, frames)
    matrix = np.empty((3 * k, 6))
    set_matrix(points, matrix)
    reflections = np.zeros((6, 3 * k))
    upper = np.zeros((6, 6))
    order = np.empty(6, np.intp)
    rank = orthogonal_factor(matrix, reflections, upper, order)
    return Grasp(normals, frames, matrix, reflections, upper, order, rank)


@kernel()
def reflect(grasp: Grasp, vector: Array) -> None:
    """Multiplies by Q, in place."""
    for j in range(grasp.rank - 1, -1, -1):
        dot = 0.0
        for i in range(j, vector.shape[0]):
            dot += grasp.reflections[j, i] * vector[i]
        for i in range(j, vector.shape[0]):
            vector[i] -= 2.0 * dot * grasp.reflections[j, i]


@kernel()
def balancing_forces(load: Array, grasp: Grasp, forces: Array) -> float:
    """The forces of least norm whose wrenches sum to ``-load``, as far as any do; the norm of what is left over."""
    forces[:] = 0.0
    # The matrix' transpose times f is -load: solve R' u = -load[order], f = Q u.
    for j in range(grasp.rank):
        total = -load[grasp.order[j]]
        for i in range(j):
            total -= grasp.upper[i, j] * forces[i]
        forces[j] = total / grasp.upper[j, j]
    reflect(grasp, forces)
    left = 0.0
    for m in range(6):
        total = load[m]
        for i in range(forces.shape[0]):
            total += grasp.matrix[i, m] * forces[i]
        left += total * total
    return math.sqrt(left)


@kernel(allocates=True)
def internal_forces(grasp: Grasp) -> Array:
    """An orthonormal basis of the forces that balance each other, as rows of (3 k - rank, 3 k): Q's last columns."""
    size = grasp.matrix.shape[0]
    basis = np.zeros((size - grasp.rank, size))
    for j in range(basis.shape[0]):
        basis[j, grasp.rank + j] = 1.0
        reflect(grasp, basis[j])
    return basis


@kernel()
def normal_part(forces: Array, grasp: Grasp, i: int) -> float:
    """The normal force of contact i."""
    n = grasp.normals[i]
    return forces[3 * i] * n[0] + forces[3 * i + 1] * n[1] + forces[3 * i + 2] * n[2]


@kernel()
def tangential_part(forces: Array, grasp: Grasp, i: int) -> tuple[float, float]:
    """The tangential force of contact i in its frame."""
    a, b = grasp.frames[i, 0], grasp.frames[i, 1]
    return (
        forces[3 * i] * a[0] + forces[3 * i + 1] * a[1] + forces[3 * i + 2] * a[2],
        forces[3 * i] * b[0] + forces[3 * i + 1] * b[1] + forces[3 * i + 2] * b[2],
    )


@kernel()
def friction_of(forces: Array, grasp: Grasp) -> float:
    """The least friction that every contact force needs; infinite if one of them pulls.

    A force smaller than 1e-14 of the largest counts as none.
    """
    largest = 0.0
    for i in range(forces.shape[0]):
        largest = max(largest, abs(forces[i]))
    worst = 0.0
    for i in range(grasp.normals.shape[0]):
        n = normal_part(forces, grasp, i)
        a, b = tangential_part(forces, grasp, i)
        t = math.hypot(a, b)
        if t <= 1e-14 * largest and n >= -1e-14 * largest:
            continue
        if not (n > 0.0 and t < math.inf):
            return math.inf
        worst = max(worst, t / n)
    return worst


@kernel(allocates=True)
def twist_of(velocities: Array, grasp: Grasp, twist: Array) -> None:
    """The twist that gives the contacts these velocities (3 k), by least squares."""
    moved = velocities.copy()
    rows = moved.shape[0]
    for j in range(grasp.rank):
        along = 0.0
        for i in range(j, rows):
            along += grasp.reflections[j, i] * moved[i]
        for i in range(j, rows):
            moved[i] -= 2.0 * along * grasp.reflections[j, i]
    twist[:] = 0.0
    for j in range(grasp.rank - 1, -1, -1):
        total = moved[j]
        for m in range(j + 1, grasp.rank):
            total -= grasp.upper[j, m] * twist[grasp.order[m]]
        twist[grasp.order[j]] = total / grasp.upper[j, j]


@kernel()
def contact_velocities(twist: Array, grasp: Grasp, found: Array) -> float:
    """Normal and tangential velocity of every contact, into ``found`` (k, 2); the largest of them."""
    largest = 0.0
    for i in range(grasp.normals.shape[0]):
        n, a, b = 0.0, 0.0, 0.0
        for j in range(3):
            velocity = 0.0
            for m in range(6):
                velocity += grasp.matrix[3 * i + j, m] * twist[m]
            n += velocity * grasp.normals[i, j]
            a += velocity * grasp.frames[i, 0, j]
            b += velocity * grasp.frames[i, 1, j]
        found[i, 0] = n
        found[i, 1] = math.hypot(a, b)
        largest = max(largest, abs(n), found[i, 1])
    return largest


@kernel()
def least_ratio(found: Array, largest: float) -> float:
    """The least ratio of normal to tangential velocity of contacts that move: less friction does no work against them.

    Velocities below 1e-12 of the largest count as none.
    """
    least = math.inf
    for i in range(found.shape[0]):
        if abs(found[i, 0]) + found[i, 1] <= 1e-12 * largest:
            continue
        if found[i, 1] > 0.0:
            least = min(least, found[i, 0] / found[i, 1])
        elif found[i, 0] < 0.0:
            return -math.inf
    return least


@kernel(allocates=True)
def least_ratio_of(twist: Array, grasp: Grasp) -> float:
    """As :func:`least_ratio`, of a twist; minus infinity if it is zero."""
    found = np.empty((grasp.normals.shape[0], 2))
    largest = contact_velocities(twist, grasp, found)
    return least_ratio(found, largest) if largest > 0.0 else -math.inf


@kernel(allocates=True)
def withstands(twist: Array, mu: float, load: Array, grasp: Grasp) -> float:
    """How large contact forces at ``mu`` must be, over the load, to withstand a motion that the load drives.

    Along the twist the load does work, and forces within their cones do none against it but for round-off: infinite
    where they do none at all. Not positive where the load does not drive the motion.
    """
    power = 0.0
    size = 0.0
    for m in range(6):
        power += load[m] * twist[m]
        size += load[m] * load[m]
    if power <= 0.0:
        return power
    found = np.empty((grasp.normals.shape[0], 2))
    contact_velocities(twist, grasp, found)
    worst = 0.0
    for i in range(found.shape[0]):
        worst = max(worst, mu * found[i, 1] - found[i, 0])
    return power / (worst * math.sqrt(size)) if worst > 0.0 else math.inf
