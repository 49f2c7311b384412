"""Connected components of the overlap of bolt and nut, in any pose with a tilt of at most 25 deg, by brute force.

A horizontal ray from the nut's axis meets the nut's thread once, and leaves the bolt's thread once (its flanks are
60 deg from the ray; that holds up to a tilt of 25 deg, which is checked, and of flatter flanks up to their half-angle).
On the ray of azimuth ``theta`` at height ``z`` the overlap is therefore one interval of radii, which varies
continuously: the components of the overlap in space are those of the set of ``(theta, z)``, -p <= z <= 0, whose
interval is not empty. ``clearance`` is a length that is >= 0 exactly there: the least of

- how far the nut's thread lies inside the bolt's, in radius;
- how far the interval reaches above the bolt's base, and below its top, along the bolt's axis.

The set is sampled along the nut's top outline (z = 0), along the bolt's base outline, and on a grid; local maxima near
zero are polished, so that a component is found by its deepest point and not by a sample that happens to hit it. Samples
are joined where the clearance between them stays above ``-JOIN``; what still looks separate is flooded on ever finer
lattices from its deepest point before it counts as a component.

Resolution: components less deep than ``DEPTH`` count as touching, not as overlap. One that is deeper is missed only if
no sample within a cell (0.75 deg by p/32 on the threads, an eighth of a degree along the outlines) leads uphill to it.
Components closer to each other than lattice steps of 2e-6 in can resolve, or across a gap less than ``JOIN`` deep,
count as one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracle.compiled import compiled
from oracle.profile import LEAD, R_LARGE, R_SMALL, P, bolt_profile, nut_profile, radius
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

DEPTH = 1e-7
"""Overlap begins here: least clearance at the deepest point of a component, on the scale of 1/4-20 (in)."""
JOIN = 3e-9
"""A path of negative clearance down to this still joins (round-off, and the accuracy of given contacts)."""
LARGEST_TILT_DEG = 25.0
FAR = 0.02
"""Clearances below -FAR thread pitches are known only to be below it; no maximum is sought there."""

ROW, EDGE, AROUND, DOWN = 2880, 2880, 480, 32
_PER_COLUMN = ROW // AROUND
_FIRST_EDGE = ROW
_FIRST_GRID = ROW + EDGE
_FIRST_EXTRA = ROW + EDGE + AROUND * DOWN
_MAX_EXTRA = 4000
_TWO_PI = 2.0 * math.pi
_FLOOD_STEPS = (4e-3, 4e-4, 4e-5)
"""Lattice steps of the floods, relative to the thread pitch."""
_FLOOD_CELLS = 60_000


@dataclass(frozen=True)
class Component:
    """One connected component of the overlap, in the nut's frame.

    ``point`` is where it is deepest, ``depth`` the clearance there, ``extent`` the diagonal of its samples' box.
    """

    point: tuple[float, float, float]
    depth: float
    extent: float


@compiled
def _bolt_coordinates(x: float, y: float, z: float, rot: Floats, t: Floats) -> tuple[float, float, float]:
    x, y, z = x - t[0], y - t[1], z - t[2]
    return (
        rot[0, 0] * x + rot[1, 0] * y + rot[2, 0] * z,
        rot[0, 1] * x + rot[1, 1] * y + rot[2, 1] * z,
        rot[0, 2] * x + rot[1, 2] * y + rot[2, 2] * z,
    )


@compiled
def _thread_gap(r: float, c: float, s: float, z: float, rot: Floats, t: Floats, bolt: Floats) -> float:
    bx, by, bz = _bolt_coordinates(r * c, r * s, z, rot, t)
    return radius(bz - bolt[LEAD] * math.atan2(by, bx) / _TWO_PI, bolt) - math.sqrt(bx * bx + by * by)


@compiled
def interval(theta: float, z: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> tuple[float, float, float]:
    """Radius of the nut's thread, radius at which the ray leaves the bolt's thread, and the nut's depth in it."""
    c, s = math.cos(theta), math.sin(theta)
    inner = radius(z - nut[LEAD] * theta / _TWO_PI, nut)
    depth = _thread_gap(inner, c, s, z, rot, t, bolt)
    if depth <= 0.0:
        return inner, inner, depth
    low, high = inner, inner + 2.0 * depth + 1e-12
    at_low, at_high = depth, _thread_gap(high, c, s, z, rot, t, bolt)
    while at_high > 0.0:
        low, at_low = high, at_high
        high += 2.0 * depth
        at_high = _thread_gap(high, c, s, z, rot, t, bolt)
    side = 0
    for _ in range(60):
        # Regula falsi (Illinois): the bracket holds the root throughout.
        middle = (low * at_high - high * at_low) / (at_high - at_low)
        g = _thread_gap(middle, c, s, z, rot, t, bolt)
        if abs(g) < 1e-16 or high - low < 1e-16:
            return inner, middle, depth
        if g > 0.0:
            low, at_low = middle, g
            if side == 1:
                at_high *= 0.5
            side = 1
        else:
            high, at_high = middle, g
            if side == -1:
                at_low *= 0.5
            side = -1
    return inner, low, depth


@compiled
def clearance(theta: float, z: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> float:
    """>= 0 exactly where the ray of ``theta`` and ``z`` meets the overlap; about a depth (see above)."""
    p = nut[P]
    c, s = math.cos(theta), math.sin(theta)
    inner = radius(z - nut[LEAD] * theta / _TWO_PI, nut)
    bx, by, bz = _bolt_coordinates(inner * c, inner * s, z, rot, t)
    depth = radius(bz - bolt[LEAD] * math.atan2(by, bx) / _TWO_PI, bolt) - math.sqrt(bx * bx + by * by)
    if depth <= 0.0 or 0.0 <= bz <= p:
        return min(depth, bz, p - bz)
    outward = rot[0, 2] * c + rot[1, 2] * s
    if (bz < 0.0) != (outward > 0.0):
        return min(depth, bz, p - bz)
    # Where the ray has left the thread before it comes near the base, the answer is far below zero: no need to know it.
    lacking = (-bz if bz < 0.0 else p - bz) / outward
    if lacking * abs(outward) > FAR * p:
        near_base = inner + lacking - FAR * p / abs(outward)
        if _thread_gap(near_base, c, s, z, rot, t, bolt) < 0.0:
            return min(depth, bz, p - bz)
    _, outer, _ = interval(theta, z, rot, t, bolt, nut)
    far = bz + outward * (outer - inner)
    return min(depth, max(bz, far), p - min(bz, far))


@compiled
def end_distance(theta: float, z: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> float:
    """How far the overlap on a ray is from the nearer of the ends without a face, z_B = p and z_F = -p."""
    inner, outer, _ = interval(theta, z, rot, t, bolt, nut)
    c, s = math.cos(theta), math.sin(theta)
    near = _bolt_coordinates(inner * c, inner * s, z, rot, t)[2]
    far = _bolt_coordinates(outer * c, outer * s, z, rot, t)[2]
    return min(bolt[P] - min(near, far), z + nut[P])


@compiled
def _edge_point(u: float, rot: Floats, t: Floats, bolt: Floats) -> tuple[float, float, float]:
    r = radius(-bolt[LEAD] * u / _TWO_PI, bolt)
    bx, by = r * math.cos(u), r * math.sin(u)
    return (
        rot[0, 0] * bx + rot[0, 1] * by + t[0],
        rot[1, 0] * bx + rot[1, 1] * by + t[1],
        rot[2, 0] * bx + rot[2, 1] * by + t[2],
    )


@compiled
def edge_clearance(u: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> tuple[float, float, float]:
    """How deep the point of the bolt's base outline at bolt azimuth ``u`` lies in the nut, its azimuth, its height."""
    x, y, z = _edge_point(u, rot, t, bolt)
    theta = math.atan2(y, x)
    inside = math.sqrt(x * x + y * y) - radius(z - nut[LEAD] * theta / _TWO_PI, nut)
    return min(inside, -z, z + nut[P]), theta, z


@compiled
def _root(parent: Ints, i: int) -> int:
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@compiled
def _join(parent: Ints, i: int, j: int) -> None:
    a, b = _root(parent, i), _root(parent, j)
    if a != b:
        parent[max(a, b)] = min(a, b)


@compiled
def _open_path(
    theta: float,
    z: float,
    to_theta: float,
    to_z: float,
    samples: int,
    rot: Floats,
    t: Floats,
    bolt: Floats,
    nut: Floats,
) -> bool:
    """Whether the straight path in (theta, z) stays in the set; the ends are not tested."""
    d = to_theta - theta
    d -= _TWO_PI * math.floor(d / _TWO_PI + 0.5)
    for k in range(1, samples):
        f = k / samples
        if clearance(theta + f * d, z + f * (to_z - z), rot, t, bolt, nut) < -JOIN:
            return False
    return True


@compiled
def _open_edge(u: float, to_u: float, samples: int, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> bool:
    """The same along the bolt's outline, between two bolt azimuths."""
    least = 0.0
    for k in range(1, samples):
        least = min(least, edge_clearance(u + (to_u - u) * k / samples, rot, t, bolt, nut)[0])
    return least >= -JOIN


@compiled
def _polish_chain(
    on_edge: bool, u: float, width: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats
) -> tuple[float, float]:
    best = edge_clearance(u, rot, t, bolt, nut)[0] if on_edge else clearance(u, 0.0, rot, t, bolt, nut)
    while width > 1e-13:
        middle = u
        for k in range(-8, 9):
            at = middle + width * k / 8.0
            v = edge_clearance(at, rot, t, bolt, nut)[0] if on_edge else clearance(at, 0.0, rot, t, bolt, nut)
            if v > best:
                best, u = v, at
        width *= 0.25
    return best, u


@compiled
def _polish_grid(
    theta: float, z: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats
) -> tuple[float, float, float]:
    p = nut[P]
    best = clearance(theta, z, rot, t, bolt, nut)
    dt, dz = _TWO_PI / AROUND, p / DOWN
    while dt > 1e-8:
        mt, mz = theta, z
        for i in range(-4, 5):
            for j in range(-4, 5):
                at_z = min(max(mz + dz * j / 4.0, -p), 0.0)
                # Steps follow the helix: overlaps of the threads are long along it and thin across.
                at_t = mt + dt * i / 4.0
                at_z = min(max(at_z + nut[LEAD] * (at_t - mt) / _TWO_PI, -p), 0.0)
                v = clearance(at_t, at_z, rot, t, bolt, nut)
                if v > best:
                    best, theta, z = v, at_t, at_z
        if abs(theta - mt) < 0.9 * dt and abs(z - mz) < 0.9 * dz:
            dt *= 0.5
            dz *= 0.5
    return best, theta, z


@compiled
def _reaches_outline(
    theta: float, z: float, value: Floats, reach: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats
) -> int:
    """A sample of the bolt's outline to which an open path leads from (theta, z); -1 if none within ``reach``."""
    _, outer, _ = interval(theta, z, rot, t, bolt, nut)
    bx, by, bz = _bolt_coordinates(outer * math.cos(theta), outer * math.sin(theta), z, rot, t)
    if abs(bz) > reach:
        return -1
    u = math.atan2(by, bx) % _TWO_PI
    v, to_theta, to_z = edge_clearance(u, rot, t, bolt, nut)
    if v < -JOIN or not _open_path(theta, z, to_theta, to_z, 16, rot, t, bolt, nut):
        return -1
    i = int(u / _TWO_PI * EDGE)
    for k in (i, i + 1):
        if value[_FIRST_EDGE + k % EDGE] >= -JOIN and _open_edge(u, _TWO_PI * k / EDGE, 8, rot, t, bolt, nut):
            return _FIRST_EDGE + k % EDGE
    return -1


@compiled
def _sample(
    rot: Floats, t: Floats, bolt: Floats, nut: Floats, excluded: Floats
) -> tuple[Floats, Floats, Floats, Ints, int]:
    """All samples with their clearance, joined; the excluded points (given as theta, z, bolt azimuth or nan) come last.

    Returns azimuths, heights, clearances, the union-find parents, and the number of samples.
    """
    p = nut[P]
    size = _FIRST_EXTRA + _MAX_EXTRA
    theta, z, value = np.empty(size), np.empty(size), np.empty(size)
    parent = np.arange(size)
    for i in range(ROW):
        theta[i], z[i] = _TWO_PI * i / ROW, 0.0
        value[i] = clearance(theta[i], 0.0, rot, t, bolt, nut)
    for i in range(EDGE):
        k = _FIRST_EDGE + i
        value[k], theta[k], z[k] = edge_clearance(_TWO_PI * i / EDGE, rot, t, bolt, nut)
    for i in range(AROUND):
        for j in range(DOWN):
            k = _FIRST_GRID + i * DOWN + j
            theta[k], z[k] = _TWO_PI * i / AROUND, -p * (j + 1) / DOWN
            value[k] = clearance(theta[k], z[k], rot, t, bolt, nut)
    n = _FIRST_EXTRA

    for chain in range(2):
        start, count = (0, ROW) if chain == 0 else (_FIRST_EDGE, EDGE)
        for i in range(count):
            here, after, before = start + i, start + (i + 1) % count, start + (i - 1) % count
            if value[here] >= -JOIN and value[after] >= -JOIN:
                _join(parent, here, after)
            near_zero = -FAR * p < value[here] < DEPTH
            if near_zero and value[here] >= value[before] and value[here] >= value[after] and n < size - 100:
                at = _TWO_PI * i / count
                v, u = _polish_chain(chain == 1, at, _TWO_PI / count, rot, t, bolt, nut)
                if v >= DEPTH:
                    value[n] = v
                    if chain == 0:
                        theta[n], z[n] = u, 0.0
                    else:
                        _, theta[n], z[n] = edge_clearance(u, rot, t, bolt, nut)
                    for k in (before, here, after):
                        to = at + _TWO_PI * (k - here) / count if abs(k - here) <= 1 else at
                        if value[k] < -JOIN or (k != here and to == at):
                            continue
                        if chain == 0 and _open_path(u, 0.0, to, 0.0, 8, rot, t, bolt, nut):
                            _join(parent, n, k)
                        if chain == 1 and _open_edge(u, to, 8, rot, t, bolt, nut):
                            _join(parent, n, k)
                    n += 1

    for i in range(AROUND):
        for j in range(DOWN):
            k = _FIRST_GRID + i * DOWN + j
            up = k - 1 if j > 0 else i * _PER_COLUMN
            right = _FIRST_GRID + ((i + 1) % AROUND) * DOWN + j
            left = _FIRST_GRID + ((i - 1) % AROUND) * DOWN + j
            if value[k] >= -JOIN:
                if value[up] >= -JOIN:
                    _join(parent, k, up)
                if value[right] >= -JOIN:
                    _join(parent, k, right)
            if -FAR * p < value[k] < DEPTH and n < size - 100:
                below = value[k + 1] if j < DOWN - 1 else -1.0
                if value[k] >= value[up] and value[k] >= below and value[k] >= value[left] and value[k] >= value[right]:
                    v, at, at_z = _polish_grid(theta[k], z[k], rot, t, bolt, nut)
                    if v >= DEPTH:
                        value[n], theta[n], z[n] = v, at, at_z
                        n += 1
    first_point = n
    for i in range(excluded.shape[0]):
        theta[n], z[n] = excluded[i, 0], excluded[i, 1]
        value[n] = 0.0
        n += 1

    # The bolt's outline, polished maxima and excluded points are joined to the grid around them.
    for k in range(_FIRST_EDGE, n):
        if (_FIRST_GRID <= k < _FIRST_EXTRA) or value[k] < -JOIN:
            continue
        if z[k] > 0.0 or z[k] < -p:
            if k < first_point:
                continue
            z[k] = min(max(z[k], -p), 0.0)
        a = theta[k] % _TWO_PI
        i = int(a / _TWO_PI * AROUND) % AROUND
        j = int(-z[k] / p * DOWN)
        reach = 1 if k >= _FIRST_EXTRA else 0
        for di in range(-reach, 2 + reach):
            for dj in range(-1 - reach, 1 + reach):
                jj = j + dj
                if jj < -1 or jj >= DOWN:
                    continue
                column = (i + di) % AROUND
                m = column * _PER_COLUMN if jj == -1 else _FIRST_GRID + column * DOWN + jj
                if value[m] < -JOIN or _root(parent, m) == _root(parent, k):
                    continue
                if _open_path(theta[k], z[k], theta[m], z[m], 8, rot, t, bolt, nut):
                    _join(parent, k, m)
        if z[k] > -2.0 * p / DOWN and _open_path(theta[k], z[k], theta[k], 0.0, 8, rot, t, bolt, nut):
            i = int(a / _TWO_PI * ROW) % ROW
            for m in (i, (i + 1) % ROW):
                if value[m] >= -JOIN and _open_path(theta[k], 0.0, theta[m], 0.0, 8, rot, t, bolt, nut):
                    _join(parent, k, m)
    for k in range(_FIRST_EXTRA, n):
        m = _reaches_outline(theta[k], z[k], value, 2.0 * p / DOWN, rot, t, bolt, nut)
        if m >= 0:
            _join(parent, k, m)
    # An excluded point on the bolt's outline is also joined along it.
    for i in range(excluded.shape[0]):
        u = excluded[i, 2]
        if math.isnan(u):
            continue
        u = u % _TWO_PI
        m = int(u / _TWO_PI * EDGE)
        for k in (m, m + 1):
            if value[_FIRST_EDGE + k % EDGE] >= -JOIN and _open_edge(u, _TWO_PI * k / EDGE, 16, rot, t, bolt, nut):
                _join(parent, first_point + i, _FIRST_EDGE + k % EDGE)
    return theta[:n], z[:n], value[:n], parent[:n], first_point


@compiled
def _neighbour(
    seed: int,
    here_t: float,
    here_z: float,
    step: float,
    theta: Floats,
    z: Floats,
    value: Floats,
    parent: Ints,
    first_point: int,
    rot: Floats,
    t: Floats,
    bolt: Floats,
    nut: Floats,
) -> int:
    """A sample of another component than the seed's to which an open path leads from a point near it; -1 if none."""
    p, own = nut[P], _root(parent, seed)
    reach = 3.0 * step
    for k in range(first_point, theta.shape[0]):
        d = here_t - theta[k]
        d -= _TWO_PI * math.floor(d / _TWO_PI + 0.5)
        if abs(d) * bolt[R_LARGE] > reach or abs(here_z - z[k]) > reach or _root(parent, k) == own:
            continue
        if _open_path(here_t, here_z, theta[k], z[k], 24, rot, t, bolt, nut):
            return k
    i = int((here_t % _TWO_PI) / _TWO_PI * ROW) % ROW
    if here_z > -reach and _open_path(here_t, here_z, here_t, 0.0, 8, rot, t, bolt, nut):
        for k in (i, (i + 1) % ROW):
            if value[k] < -JOIN or _root(parent, k) == own:
                continue
            if _open_path(here_t, 0.0, theta[k], 0.0, 16, rot, t, bolt, nut):
                return k
    column = i // _PER_COLUMN
    j = int(-here_z / p * DOWN)
    for c in (column, (column + 1) % AROUND):
        for jj in (j - 1, j):
            k = _FIRST_GRID + c * DOWN + jj
            if jj < 0 or jj >= DOWN or value[k] < -JOIN or _root(parent, k) == own:
                continue
            if _open_path(here_t, here_z, theta[k], z[k], 16, rot, t, bolt, nut):
                return k
    k = _reaches_outline(here_t, here_z, value, reach, rot, t, bolt, nut)
    return k if k >= 0 and _root(parent, k) != own else -1


@compiled
def _flood(
    seed: int,
    step: float,
    theta: Floats,
    z: Floats,
    value: Floats,
    parent: Ints,
    first_point: int,
    rot: Floats,
    t: Floats,
    bolt: Floats,
    nut: Floats,
) -> bool:
    """Flood from a sample on a lattice of that step along the helix and across; join what it reaches.

    Returns whether it reached a sample of another component; it stops at the first.
    """
    p = nut[P]
    r = 0.5 * (bolt[R_LARGE] + bolt[R_SMALL])
    seen = {(0, 0)}
    queue = np.empty((_FLOOD_CELLS, 2), np.int64)
    queue[0, 0] = queue[0, 1] = 0
    head, tail = 0, 1
    while head < tail:
        a, b = queue[head, 0], queue[head, 1]
        head += 1
        here_t = theta[seed] + a * step / r
        here_z = min(max(z[seed] + b * step + nut[LEAD] * a * step / r / _TWO_PI, -p), 0.0)
        m = _neighbour(seed, here_t, here_z, step, theta, z, value, parent, first_point, rot, t, bolt, nut)
        if m >= 0:
            _join(parent, m, seed)
            return True
        for da in range(-1, 2):
            for db in range(-1, 2):
                na, nb = a + da, b + db
                if (na, nb) in seen or tail >= _FLOOD_CELLS:
                    continue
                to_t = theta[seed] + na * step / r
                to_z = min(max(z[seed] + nb * step + nut[LEAD] * na * step / r / _TWO_PI, -p), 0.0)
                if clearance(to_t, to_z, rot, t, bolt, nut) < -JOIN:
                    continue
                if not _open_path(here_t, here_z, to_t, to_z, 3, rot, t, bolt, nut):
                    continue
                seen.add((na, nb))
                queue[tail, 0], queue[tail, 1] = na, nb
                tail += 1
    return False


@compiled
def _flood_finer(
    seed: int,
    theta: Floats,
    z: Floats,
    value: Floats,
    parent: Ints,
    first_point: int,
    rot: Floats,
    t: Floats,
    bolt: Floats,
    nut: Floats,
) -> bool:
    for relative in _FLOOD_STEPS:
        if _flood(seed, relative * nut[P], theta, z, value, parent, first_point, rot, t, bolt, nut):
            return True
    return False


@compiled
def _exclude_at_ends(
    theta: Floats,
    z: Floats,
    value: Floats,
    parent: Ints,
    is_excluded: Bools,
    rot: Floats,
    t: Floats,
    bolt: Floats,
    nut: Floats,
) -> None:
    """Exclude components with a sample within one and a half of the grid's steps of an end without a face."""
    for k in range(value.shape[0]):
        if value[k] >= DEPTH and end_distance(theta[k], z[k], rot, t, bolt, nut) < 1.5 * nut[P] / DOWN:
            is_excluded[_root(parent, k)] = True


@compiled
def _deepest(value: Floats, parent: Ints, first_point: int, is_excluded: Bools) -> int:
    """The deepest sample of the deepest component that holds no excluded point; -1 if none."""
    n = value.shape[0]
    for k in range(first_point, n):
        is_excluded[_root(parent, k)] = True
    best, at = DEPTH, -1
    for k in range(first_point):
        if value[k] >= best and not is_excluded[_root(parent, k)]:
            best, at = value[k], k
    return at


@compiled
def free_component(
    rot: Floats, t: Floats, bolt: Floats, nut: Floats, excluded: Floats, at_ends: bool
) -> tuple[float, float, float]:
    """Depth, azimuth and height of the deepest component that holds no excluded point; depth 0 if there is none.

    Without ``at_ends`` only of those that do not reach an end without a face.
    """
    theta, z, value, parent, first_point = _sample(rot, t, bolt, nut, excluded)
    while True:
        is_excluded = np.zeros(value.shape[0], np.bool_)
        if not at_ends:
            _exclude_at_ends(theta, z, value, parent, is_excluded, rot, t, bolt, nut)
        k = _deepest(value, parent, first_point, is_excluded)
        if k < 0:
            return 0.0, 0.0, 0.0
        if not _flood_finer(k, theta, z, value, parent, first_point, rot, t, bolt, nut):
            return value[k], theta[k], z[k]


def witness(theta: float, z: float, rot: Floats, t: Floats, bolt: Floats, nut: Floats) -> Floats:
    """A point of the overlap on the ray of ``theta`` and ``z``, highest above the bolt's base; nut's frame."""
    inner, outer, _ = interval(theta, z, rot, t, bolt, nut)
    outward = rot[0, 2] * math.cos(theta) + rot[1, 2] * math.sin(theta)
    r = outer if outward > 0.0 else inner
    return np.array([r * math.cos(theta), r * math.sin(theta), z])


def excluded_rows(rot: Floats, t: Floats, points: Floats) -> Floats:
    """Azimuth, height and bolt azimuth (nan off the bolt's base plane) of points in the nut's frame, shape (n, 3)."""
    points = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    in_bolt = (points - t) @ rot
    azimuth = np.where(np.abs(in_bolt[:, 2]) < DEPTH, np.arctan2(in_bolt[:, 1], in_bolt[:, 0]), np.nan)
    height = np.where(np.abs(points[:, 2]) < DEPTH, 0.0, points[:, 2])
    return np.column_stack([np.arctan2(points[:, 1], points[:, 0]), height, azimuth])


def check_tilt(rot: Floats) -> None:
    """Raise ValueError where the bolt is tilted too far for horizontal rays to leave its thread only once."""
    tilt = math.degrees(math.acos(min(1.0, float(rot[2, 2]))))
    if tilt > LARGEST_TILT_DEG:
        raise ValueError(f"tilt is {tilt} deg; valid: at most {LARGEST_TILT_DEG}")


def overlap_components(pair: Pair, rotation: Floats, translation: Floats) -> list[Component]:
    """The components of bolt and nut's overlap in the pose ``x_nut = rotation x_bolt + translation``, deepest first.

    Raises:
        ValueError: the bolt is tilted by more than 25 deg.
    """
    rot, t = np.ascontiguousarray(rotation, dtype=np.float64), np.asarray(translation, dtype=np.float64)
    check_tilt(rot)
    bolt, nut = bolt_profile(pair), nut_profile(pair)
    theta, z, value, parent, first_point = _sample(rot, t, bolt, nut, np.empty((0, 3)))
    settled: set[int] = set()
    while True:
        roots = np.array([_root(parent, k) for k in range(len(parent))])
        open_roots = sorted({int(r) for r in roots[value >= DEPTH]} - settled)
        if not open_roots:
            break
        members = np.flatnonzero(roots == open_roots[0])
        seed = int(members[np.argmax(value[members])])
        if not _flood_finer(seed, theta, z, value, parent, first_point, rot, t, bolt, nut):
            settled.add(open_roots[0])
    components = []
    for root in {int(r) for r in roots[value >= DEPTH]}:
        members = np.flatnonzero((roots == root) & (value >= 0.0))
        points = np.array([witness(theta[k], z[k], rot, t, bolt, nut) for k in members])
        deepest = int(np.argmax(value[members]))
        x, y, height = (float(c) for c in points[deepest])
        extent = float(np.linalg.norm(np.ptp(points, axis=0)))
        components.append(Component((x, y, height), float(value[members][deepest]), extent))
    return sorted(components, key=lambda c: -c.depth)
