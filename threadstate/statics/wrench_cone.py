"""The cone of the wrenches that contacts carry at a friction, by cone programs (forces, section 2).

A contact's force has three coordinates (s, a, b), within its friction cone where ``|(a, b)| <= s``: the normal part is
``s cos(phi)``, the tangential one ``(a, b) sin(phi)``, with ``tan(phi)`` the friction; without friction s alone. Its
map, shape (6, 3) or (6, 1), takes them to a wrench, and transposed a twist to the contact's velocity. Lengths
are over the pair's nominal radius.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from threadstate.statics.cone_program import solved_program

Floats = NDArray[np.float64]

RANK_TOLERANCE = 1e-10
"""Relative size below which a direction of wrenches is none."""
OPENING_TOLERANCE = 1e-9
"""Contacts wedge that no twist of size 1 opens faster."""
PRESSED = 1e-6
"""A contact is pressed by forces of which its own is more than this part of the largest."""
SCALES = (1.0, 1e1, 1e2, 1e3, 1e4, 1e5)
"""Sizes of forces, over the load, in whose units forces within their cones are sought."""
STILL = 1e-12
"""Velocities below this part of the largest one are none."""
MOST_FORCE = 1e12
"""Forces that wedge are not taken larger, over the load, to hold those of other contacts in their cones."""


def tangents(normals: Floats) -> Floats:
    """Two unit vectors across each normal: shape (k, 2, 3)."""
    first = np.cross(normals, np.eye(3)[np.argmin(np.abs(normals), axis=1)])
    first /= np.linalg.norm(first, axis=1)[:, np.newaxis]
    return np.stack([first, np.cross(normals, first)], axis=1)


def contact_maps(points: Floats, normals: Floats, mu: float) -> Floats:
    """The maps of contacts at points (k, 3) with normals (k, 3): shape (k, 6, 3), without friction (k, 6, 1)."""
    if mu == 0.0:
        return force_maps(points, normals)[:, :, :1]
    return force_maps(points, normals) * (np.array([1.0, mu, mu]) / math.hypot(1.0, mu))


def force_maps(points: Floats, normals: Floats) -> Floats:
    """The wrenches of unit forces along the normal and two tangents of each contact: shape (k, 6, 3)."""
    axes = np.concatenate([normals[:, np.newaxis, :], tangents(normals)], axis=1)
    return np.swapaxes(np.concatenate([np.cross(points[:, np.newaxis, :], axes), axes], axis=2), 1, 2)


def slacks(forces: Floats) -> Floats:
    """By how much forces, or velocities, of coordinates (k, 3) or (k, 1) lie in their cones: ``s - |(a, b)|``."""
    return np.asarray(forces[:, 0] - np.linalg.norm(forces[:, 1:], axis=1))


def moved(maps: Floats, twist: Floats) -> Floats:
    """The contacts' velocities under a twist, in the coordinates of their forces."""
    return np.einsum("kqc,q->kc", maps, twist)


def carried(maps: Floats, forces: Floats) -> Floats:
    """The wrench of contact forces."""
    return np.einsum("kqc,kc->q", maps, forces)


def driven(maps: Floats, load: Floats) -> tuple[Floats, Floats]:
    """The twist of size at most 1 on which a load (q) of norm 1 does most work while no contact withstands it.

    With it the contacts' forces (k, parts), on the border of their cones, that come nearest to minus the load.
    """
    k, q, parts = maps.shape
    g = np.zeros((k * parts + q + 1, q))
    g[: k * parts] = -np.swapaxes(maps, 1, 2).reshape(k * parts, q)
    g[k * parts + 1 :] = -np.eye(q)
    h = np.zeros(len(g))
    h[k * parts] = 1.0
    twist, z = solved_program(-load, g, h, [parts] * k + [q + 1])
    return twist, z[: k * parts].reshape(k, parts)


def withstood(points: Floats, normals: Floats, twist: Floats) -> Floats:
    """The frictions (k) from which on contacts withstand a twist (6); minus infinity where it presses them."""
    velocity = twist[3:] + np.cross(twist[:3], points)
    along = np.einsum("ka,ka->k", velocity, normals)
    across = np.linalg.norm(velocity - along[:, np.newaxis] * normals, axis=1)
    scale = np.abs(velocity).max()
    moving = across > STILL * scale
    ratio = np.where(moving, along / np.where(moving, across, 1.0), math.inf)
    ratio[along < -STILL * scale] = -math.inf
    return np.asarray(ratio)


def opening(maps: Floats) -> tuple[float, Floats, Floats]:
    """The twist of size at most 1 that leaves every contact fastest, however it slides: rate and twist.

    With it forces of the contacts whose s sum to 1 and which balance each other as far as any do: the rate is the size
    of what is left, not positive where contacts wedge.
    """
    k, q, parts = maps.shape
    g = np.zeros((k * parts + q + 1, q + 1))
    g[: k * parts, :q] = -np.swapaxes(maps, 1, 2).reshape(k * parts, q)
    g[: k * parts : parts, q] = 1.0
    g[k * parts + 1 :, :q] = -np.eye(q)
    h = np.zeros(len(g))
    h[k * parts] = 1.0
    x, z = solved_program(-np.eye(q + 1)[q], g, h, [parts] * k + [q + 1])
    twist = x[:q] / max(1.0, float(np.linalg.norm(x[:q])))
    return float(slacks(moved(maps, twist)).min()), twist, z[: k * parts].reshape(k, parts)


@dataclass(frozen=True, slots=True)
class Divided:
    """Contacts, divided by what those balance that wedge.

    Attributes:
        pressed: which contacts wedge, shape (k).
        free: orthonormal wrenches across all that these carry, shape (6, p).
        maps: those of the other contacts to the free wrenches, shape (k - pressed, p, parts).
        rate, twist: by how much which free twist (p) leaves all of the others; infinite without others.
    """

    pressed: NDArray[np.bool_]
    free: Floats
    maps: Floats
    rate: float
    twist: Floats


def divided(maps: Floats) -> Divided:
    """Contacts with maps (k, q, parts), divided by those that wedge."""
    q = maps.shape[1]
    pressed = np.zeros(len(maps), dtype=np.bool_)
    free = np.eye(q)
    while not pressed.all():
        rest = np.einsum("qp,kqc->kpc", free, maps[~pressed])
        if free.shape[1] == 0:
            pressed[:] = True
            break
        rate, twist, forces = opening(rest)
        if rate > OPENING_TOLERANCE:
            return Divided(pressed, free, rest, rate, twist)
        pressed[np.flatnonzero(~pressed)[forces[:, 0] > PRESSED * forces[:, 0].max()]] = True
        free = complement(np.concatenate(list(maps[pressed]), axis=1))
    return Divided(pressed, free, np.zeros((0, free.shape[1], maps.shape[2])), math.inf, np.zeros(free.shape[1]))


def complement(columns: Floats) -> Floats:
    """Orthonormal vectors across all columns (q, n): shape (q, q - rank)."""
    left, sizes, _ = np.linalg.svd(columns)
    rank = int((sizes > RANK_TOLERANCE * sizes.max(initial=0.0)).sum())
    return np.asarray(left[:, rank:])


def null_space(columns: Floats) -> Floats:
    """Orthonormal vectors that the columns (q, n) take to zero: shape (n, n - rank)."""
    return complement(columns.T)


def balanced_by_wedging(maps: Floats, load: Floats) -> Floats:
    """Forces (k, parts) of contacts that all wedge, in their cones, which balance what they can of a load."""
    k, _, parts = maps.shape
    columns = np.concatenate(list(maps), axis=1)
    forces = least_forces(columns, load).reshape(k, parts)
    _, _, press = opening(maps)
    size = 1.0
    while slacks(forces + size * press).min() < 0.0 and size < MOST_FORCE:
        size *= 2.0
    return into_cones(forces + size * press)


def into_cones(forces: Floats) -> Floats:
    """Forces (k, parts), those outside of their cones scaled across into them."""
    found = forces.copy()
    found[:, 0] = np.maximum(found[:, 0], 0.0)
    across = np.linalg.norm(found[:, 1:], axis=1)
    outside = across > found[:, 0]
    found[outside, 1:] *= (found[outside, 0] / across[outside])[:, np.newaxis]
    return found


def least_forces(columns: Floats, load: Floats) -> Floats:
    """The forces (n) of least norm that balance what they can of a load (q), of which ``columns`` are the wrenches."""
    n = columns.shape[1]
    return np.asarray(-np.linalg.lstsq(columns, load, rcond=RANK_TOLERANCE)[0] if len(columns) else np.zeros(n))


def deepest_forces(start: Floats, basis: Floats, parts: int) -> Floats:
    """Forces (k parts) that are deep in their cones, among ``start`` and the span of the columns of ``basis``.

    The least slack of a contact is as large as it can be, or the first of ``SCALES`` that can be reached.
    """
    n, d = basis.shape
    if d == 0:
        return start
    g = np.zeros((n + 1, d + 1))
    g[:n, :d] = -basis
    g[:n:parts, d] = 1.0
    g[n, d] = 1.0
    best, depth = start, -math.inf
    for scale in SCALES:
        x, _ = solved_program(-np.eye(d + 1)[d], g, np.append(start / scale, 1.0), [parts] * (n // parts) + [1])
        forces = start + scale * (basis @ x[:d])
        slack = float(slacks(forces.reshape(-1, parts)).min())
        if slack > depth:
            best, depth = forces, slack
        if depth > 0.0:
            break
    return np.asarray(best)
