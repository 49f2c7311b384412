"""The earliest contacts of one part's edge curve with the other part, along one motion.

The entry time ``T(theta)`` of the edge curve is piecewise smooth. A component of the overlap that is born at an edge
curve is born at a local minimum of ``T``: where ``T`` is stationary on one face (the edge touches the plane or the
thread), or where the curve leaves the plane over the other part's edge (edge on edge). A minimum counts only where
the two wedges of material are separated by a plane there; otherwise the place is the border of an overlap that is
already open, the growth of an earlier contact.

The search holds a list of cells of ``theta``. A cell is closed when a bound says that nothing can hide in it:

* clear: no point of it enters before the limit (Lipschitz bound, ``clear_until``);
* monotone: the slope of ``T`` cannot vanish in it (bound on the second derivative).

All other cells are split; a change of face is split at its edge-edge point.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from threadstate.contact._bound_kernel import (
    B_BEND,
    B_C1,
    B_LIPSCHITZ,
    B_R_LOW,
    B_TILT,
    BOUNDS_SIZE,
    clear,
    helical,
    set_bounds,
    sine_of_tilt,
    thread_bend,
)
from threadstate.contact._entry_kernel import INSIDE, NEVER, NONE, PLANE, THREAD, entry, passage
from threadstate.contact._geometry_kernel import (
    M_COPLANAR,
    M_KIND,
    M_SIGMA,
    PATH_SIZE,
    TWO_PI,
    edge_point,
    field,
    phi,
    position,
    set_path,
    turn_vector,
    velocity,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# A node: theta, T, how it entered, derivative of the entered face's function by theta and by tau; when the walker
# enters and leaves the half space of the plane (NEVER beyond the horizon), and phi at those times.
N_THETA = 0
N_TIME = 1
N_HOW = 2
N_BY_THETA = 3
N_BY_TAU = 4
N_START = 5
N_AT_START = 6
N_STOP = 7
N_AT_STOP = 8
NODE_SIZE = 9
MAX_NODES = 20000
MAX_CELLS = 3000

# A candidate: time, kind, azimuth on the walker's curve, azimuth on the other part, point in the solid's frame.
C_TIME = 0
C_KIND = 1
C_THETA = 2
C_OTHER = 3
C_X = 4
C_Y = 5
C_Z = 6
CANDIDATE_SIZE = 7
MAX_CANDIDATES = 16

EDGE_EDGE = 0
ON_PLANE = 1
ON_THREAD = 2

EPS_PUNCTURE = 1e-4
"""Half-width (rad) around an earlier contact within which nothing is told apart from it."""

SMALLEST_CELL = 1e-7
"""Width (rad) at which splitting ends."""

NEIGHBOURHOOD = 1e-4
"""Half-width (rad) around a contact within which no other is looked for."""

PASSAGE_CELL = 1e-4
SMALLEST_PASSAGE = 1e-11
"""Widths (rad) at which splitting ends around a passage over the other edge inside growth: bracketed, and not."""

TURN_DOUBT = 2e-7
HEIGHT_DOUBT = 2e-9
SMALL_TILT = 1e-3
"""No contact of a turn comes earlier than the one found by more than this (rad); at a tilt below
``SMALL_TILT`` (rad) no first contact by more than that many thread pitches. That is what the cells prove."""

GROWTH_CELL = 1e-2
"""Width (rad) at which a cell of growth counts as monotone by the signs at its ends alone."""

START_CELLS = 24

OVERFLOW = -1


@njit(cache=True, error_model="numpy")
def set_node(
    theta: float,
    motion: Array,
    row_c: Array,
    row_s: Array,
    horizon: float,
    since: float,
    limit: float,
    bounds: Array,
    path: Array,
    node: Array,
    stays_out: bool = False,
) -> None:
    """Entry time at ``theta`` up to ``limit``, derivatives of the function that vanishes there, passages.

    ``stays_out``: it is known that there is no entry.
    """
    is_turn = motion[M_KIND] != 0.0
    sigma = motion[M_SIGMA]
    coplanar = motion[M_COPLANAR] != 0.0
    x, y, dx, dy = edge_point(theta, row_c)
    set_path(x, y, motion, path)
    time, how = NEVER, NONE
    if not stays_out:
        time, how = entry(
            path, is_turn, coplanar, row_s, sigma, since, limit, bounds[B_LIPSCHITZ], bounds[B_BEND], bounds[B_R_LOW]
        )
    node[N_THETA] = theta
    node[N_TIME] = time
    node[N_HOW] = how
    node[N_BY_THETA] = 0.0
    node[N_BY_TAU] = 0.0
    start, stop = passage(path, sigma, is_turn, coplanar)
    node[N_START] = NEVER
    node[N_STOP] = NEVER
    if start <= horizon:
        px, py, pz = position(path, start, is_turn)
        node[N_START] = start
        node[N_AT_START] = phi(px, py, pz, row_s, sigma)
    if stop <= horizon:
        px, py, pz = position(path, stop, is_turn)
        node[N_STOP] = stop
        node[N_AT_STOP] = phi(px, py, pz, row_s, sigma)
    if how == PLANE or how == THREAD:
        tx, ty, tz = turn_vector(dx, dy, 0.0, motion, time)
        vx, vy, vz = velocity(path, time, is_turn)
        if how == PLANE:
            node[N_BY_THETA] = -sigma * tz
            node[N_BY_TAU] = -sigma * vz
        else:
            px, py, pz = position(path, time, is_turn)
            _, gx, gy, gz = field(px, py, pz, row_s, sigma)
            node[N_BY_THETA] = gx * tx + gy * ty + gz * tz
            node[N_BY_TAU] = gx * vx + gy * vy + gz * vz


@njit(cache=True, error_model="numpy")
def over_plane(
    theta: float, leaving: bool, motion: Array, row_c: Array, row_s: Array, path: Array
) -> tuple[float, float]:
    """``phi`` where the walker passes the plane (entering the half space, or leaving it), and when."""
    is_turn = motion[M_KIND] != 0.0
    sigma = motion[M_SIGMA]
    x, y, _, _ = edge_point(theta, row_c)
    set_path(x, y, motion, path)
    start, stop = passage(path, sigma, is_turn, motion[M_COPLANAR] != 0.0)
    tau = stop if leaving else start
    if tau >= math.pi:
        return NEVER, NEVER
    px, py, pz = position(path, tau, is_turn)
    return phi(px, py, pz, row_s, sigma), tau


@njit(cache=True, error_model="numpy")
def edge_root(
    a: float, b: float, leaving: bool, motion: Array, row_c: Array, row_s: Array, path: Array
) -> tuple[float, float]:
    """Azimuth between ``a`` and ``b`` at which the walker passes the plane on the other edge, and when (Illinois)."""
    fa, ta = over_plane(a, leaving, motion, row_c, row_s, path)
    fb, tb = over_plane(b, leaving, motion, row_c, row_s, path)
    if ta == NEVER or tb == NEVER or (fa >= 0.0) == (fb >= 0.0):
        return NEVER, NEVER
    wa = fa
    wb = fb
    side = 0
    for _ in range(100):
        c = (a * wb - b * wa) / (wb - wa)
        if not (min(a, b) < c < max(a, b)):
            c = 0.5 * (a + b)
        fc, tc = over_plane(c, leaving, motion, row_c, row_s, path)
        if tc == NEVER:
            return NEVER, NEVER
        if (fc >= 0.0) == (fa >= 0.0):
            a = c
            fa = fc
            wa = fc
            ta = tc
            if side == -1:
                wb *= 0.5
            side = -1
        else:
            b = c
            fb = fc
            wb = fc
            tb = tc
            if side == 1:
                wa *= 0.5
            side = 1
        if abs(b - a) <= 4e-16 * (1.0 + abs(a)) or fc == 0.0:
            break
    if abs(fa) < abs(fb):
        return a, ta
    return b, tb


@njit(cache=True, error_model="numpy")
def stationary(
    left: Array,
    right: Array,
    motion: Array,
    row_c: Array,
    row_s: Array,
    limit: float,
    bounds: Array,
    path: Array,
    node: Array,
) -> bool:
    """Shrinks [left, right], whose slopes of T differ in sign on one face, to the stationary point; into ``node``."""
    a = left[N_THETA]
    b = right[N_THETA]
    wa = left[N_BY_THETA]
    wb = right[N_BY_THETA]
    how = left[N_HOW]
    side = 0
    for _ in range(100):
        c = (a * wb - b * wa) / (wb - wa)
        if not (min(a, b) < c < max(a, b)):
            c = 0.5 * (a + b)
        set_node(c, motion, row_c, row_s, limit, 0.0, limit, bounds, path, node)
        if node[N_HOW] != how:
            return False
        f = node[N_BY_THETA]
        if (f > 0.0) == (left[N_BY_THETA] > 0.0):
            a = c
            wa = f
            if side == -1:
                wb *= 0.5
            side = -1
        else:
            b = c
            wb = f
            if side == 1:
                wa *= 0.5
            side = 1
        if f == 0.0 or abs(b - a) <= 1e-12:
            return True
    return True


@njit(cache=True, error_model="numpy")
def wedge(theta: float, row: Array, sigma: float, out: Array) -> None:
    """Unit vectors at the edge point: along the edge (counter-clockwise), into the flat face, into the thread face."""
    x, y, ex, ey = edge_point(theta, row)
    n = math.hypot(ex, ey)
    ex /= n
    ey /= n
    _, gx, gy, gz = field(x, y, 0.0, row, sigma)
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


@njit(cache=True, error_model="numpy")
def dot(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> float:
    """Scalar product."""
    return ax * bx + ay * by + az * bz


@njit(cache=True, error_model="numpy")
def wedge_support(motion: Array, tau: float, w: Array, nx: float, ny: float, nz: float) -> tuple[float, float]:
    """Components along n of the walker's two face directions after ``tau``."""
    ax, ay, az = turn_vector(w[3], w[4], w[5], motion, tau)
    bx, by, bz = turn_vector(w[6], w[7], w[8], motion, tau)
    return dot(ax, ay, az, nx, ny, nz), dot(bx, by, bz, nx, ny, nz)


@njit(cache=True, error_model="numpy")
def edges_apart(
    theta_c: float, theta_s: float, tau: float, motion: Array, row_c: Array, row_s: Array, w: Array
) -> bool:
    """Whether at a crossing of two edges a plane separates the two wedges."""
    sigma = motion[M_SIGMA]
    wedge(theta_c, row_c, -sigma, w)
    ex, ey, ez = turn_vector(w[0], w[1], w[2], motion, tau)
    _, _, sx, sy = edge_point(theta_s, row_s)
    n = math.hypot(sx, sy)
    sx /= n
    sy /= n
    nx = -ez * sy
    ny = ez * sx
    nz = ex * sy - ey * sx
    n = math.sqrt(nx * nx + ny * ny + nz * nz)
    if n < 1e-12:
        return False
    nx /= n
    ny /= n
    nz /= n
    c1, c2 = wedge_support(motion, tau, w, nx, ny, nz)
    wedge(theta_s, row_s, sigma, w)
    s1 = dot(w[3], w[4], w[5], nx, ny, nz)
    s2 = dot(w[6], w[7], w[8], nx, ny, nz)
    tol = 1e-12
    return (c1 >= -tol and c2 >= -tol and s1 <= tol and s2 <= tol) or (
        c1 <= tol and c2 <= tol and s1 >= -tol and s2 >= -tol
    )


@njit(cache=True, error_model="numpy")
def face_apart(
    theta_c: float, tau: float, nx: float, ny: float, nz: float, motion: Array, row_c: Array, w: Array
) -> bool:
    """Whether the walker's wedge lies on the side of a face to which its outward normal n points."""
    wedge(theta_c, row_c, -motion[M_SIGMA], w)
    c1, c2 = wedge_support(motion, tau, w, nx, ny, nz)
    return c1 >= -1e-12 and c2 >= -1e-12


@njit(cache=True, error_model="numpy")
def add_candidate(
    time: float, kind: int, theta: float, other: float, x: float, y: float, z: float, count: int, found: Array
) -> int:
    """Appends a candidate unless it is listed already; the list stays sorted by time and keeps the earliest."""
    for i in range(count):
        if found[i, C_KIND] == kind and abs(found[i, C_X] - x) + abs(found[i, C_Y] - y) + abs(
            found[i, C_Z] - z
        ) < 1e-9 * (abs(x) + abs(y)):
            return count
    if count == MAX_CANDIDATES:
        if time >= found[count - 1, C_TIME]:
            return count
        count -= 1
    i = count
    while i > 0 and found[i - 1, C_TIME] > time:
        for j in range(CANDIDATE_SIZE):
            found[i, j] = found[i - 1, j]
        i -= 1
    found[i, C_TIME] = time
    found[i, C_KIND] = kind
    found[i, C_THETA] = theta
    found[i, C_OTHER] = other
    found[i, C_X] = x
    found[i, C_Y] = y
    found[i, C_Z] = z
    return count + 1


@njit(cache=True, error_model="numpy")
def try_edge(
    theta: float,
    time: float,
    motion: Array,
    row_c: Array,
    row_s: Array,
    path: Array,
    w: Array,
    count: int,
    found: Array,
) -> int:
    """Adds the crossing of the edges at ``theta``, ``time`` if the wedges are apart there."""
    is_turn = motion[M_KIND] != 0.0
    x, y, _, _ = edge_point(theta, row_c)
    set_path(x, y, motion, path)
    px, py, pz = position(path, time, is_turn)
    other = math.atan2(py, px)
    if edges_apart(theta, other, time, motion, row_c, row_s, w):
        return add_candidate(time, EDGE_EDGE, theta, other, px, py, pz, count, found)
    return count


@njit(cache=True, error_model="numpy")
def try_face(
    node: Array, motion: Array, row_c: Array, row_s: Array, path: Array, w: Array, count: int, found: Array
) -> int:
    """Adds the tangency at ``node`` if the walker's wedge is outside the face there."""
    is_turn = motion[M_KIND] != 0.0
    sigma = motion[M_SIGMA]
    theta = node[N_THETA]
    time = node[N_TIME]
    x, y, _, _ = edge_point(theta, row_c)
    set_path(x, y, motion, path)
    px, py, pz = position(path, time, is_turn)
    if -sigma * pz > row_s[pk.P]:
        # Beyond the far end of the part, which is one thread pitch long.
        return count
    if node[N_HOW] == PLANE:
        if face_apart(theta, time, 0.0, 0.0, sigma, motion, row_c, w):
            return add_candidate(time, ON_PLANE, theta, math.atan2(py, px), px, py, pz, count, found)
        return count
    _, gx, gy, gz = field(px, py, pz, row_s, sigma)
    n = math.sqrt(gx * gx + gy * gy + gz * gz)
    if face_apart(theta, time, -gx / n, -gy / n, -gz / n, motion, row_c, w):
        return add_candidate(time, ON_THREAD, theta, math.atan2(py, px), px, py, pz, count, found)
    return count


@njit(cache=True, error_model="numpy")
def steady(node: Array, half: float, motion: Array, row_c: Array, row_s: Array, bounds: Array, path: Array) -> bool:
    """Whether the slope of ``T`` keeps its sign within ``half`` of a node, by the bound on the second derivative."""
    slope = abs(node[N_BY_THETA])
    rate = node[N_BY_TAU]
    if rate <= 0.0:
        return False
    theta = node[N_THETA]
    tau = node[N_TIME]
    is_turn = motion[M_KIND] != 0.0
    k = row_c[pk.P] / TWO_PI
    drift = 2.0 * slope / rate
    x, y, dx, dy = edge_point(theta, row_c)
    set_path(x, y, motion, path)
    if node[N_HOW] == PLANE:
        own_low, own_high = pk.bend_range(-k * theta, k * half, row_c)
        c2 = k * k * max(own_high, -own_low) + row_c[pk.R_MAJOR] + 2.0 * k * row_c[pk.COT]
        bend = sine_of_tilt(motion, bounds, tau) * c2
        if is_turn:
            bend += drift * bounds[B_C1]
        return slope > bend * half
    px, py, pz = position(path, tau, is_turn)
    tx, ty, tz = turn_vector(dx, dy, 0.0, motion, tau)
    s, s_slope, r = helical(px, py, pz, tx, ty, tz, k)
    low, high = thread_bend(theta, half, s, s_slope, r, tau, motion, row_c, row_s, bounds)
    bend = max(high, -low)
    if is_turn:
        reach = (abs(s_slope) + 2.0 * path[9] * drift) * half
        f_low, f_high = pk.bend_range(s, reach, row_s)
        k_r = k / bounds[B_R_LOW]
        bend += drift * (
            max(f_high, -f_low) * (abs(s_slope) + reach) * path[9] * (1.0 + k_r)
            + bounds[B_C1] * path[9] * (row_s[pk.COT] * k_r + 1.0) / bounds[B_R_LOW]
            + bounds[B_LIPSCHITZ] * bounds[B_C1]
        )
    return slope > bend * half


@njit(cache=True, error_model="numpy")
def monotone(a: Array, b: Array, motion: Array, row_c: Array, row_s: Array, bounds: Array, path: Array) -> bool:
    """Whether ``T`` has no stationary point between two nodes of one face."""
    if (a[N_BY_THETA] > 0.0) != (b[N_BY_THETA] > 0.0):
        return False
    half = 0.5 * (b[N_THETA] - a[N_THETA])
    return steady(a, half, motion, row_c, row_s, bounds, path) and steady(b, half, motion, row_c, row_s, bounds, path)


@njit(cache=True, error_model="numpy")
def holds_mark(a: float, b: float, marks: Array, mark_count: int) -> bool:
    """Whether [a, b] is the closed neighbourhood of an earlier contact."""
    if b - a > 2.5 * EPS_PUNCTURE:
        return False
    for j in range(mark_count):
        if a < marks[j] < b or a < marks[j] + TWO_PI < b:
            return True
    return False


@njit(cache=True, error_model="numpy")
def split_at(a: float, b: float, marks: Array, mark_count: int) -> float:
    """Where a cell is split: in the middle, or near a mark where the distances from it are in proportion."""
    for j in range(mark_count):
        for turn in (0.0, TWO_PI):
            near = a - marks[j] - turn
            far = b - marks[j] - turn
            if near > 0.0 and near < 0.3 * far < 0.15:
                return marks[j] + turn + math.sqrt(near * far)
            if far < 0.0 and far > 0.3 * near > -0.15:
                return marks[j] + turn - math.sqrt(near * far)
    return 0.5 * (a + b)


@njit(cache=True, error_model="numpy")
def smallest_growth(a: Array, b: Array) -> float:
    """The width down to which a cell of growth is split.

    Small where both ends are on one face; smaller where a passage over the other edge lies between and is bracketed, so
    that no turning point hides beside it; next to nothing where a passage must lie between and is not bracketed yet.
    """
    if a[N_HOW] == b[N_HOW]:
        return GROWTH_CELL
    if crosses(a[N_START], b[N_START], a[N_AT_START], b[N_AT_START]) or crosses(
        a[N_STOP], b[N_STOP], a[N_AT_STOP], b[N_AT_STOP]
    ):
        return PASSAGE_CELL
    # T rises from the end that enters to the one that does not, or a turning point lies between.
    if a[N_HOW] == NONE and in_half_space(a, b[N_TIME]):
        return GROWTH_CELL if b[N_BY_THETA] >= 0.0 else SMALLEST_CELL
    if b[N_HOW] == NONE and in_half_space(b, a[N_TIME]):
        return GROWTH_CELL if a[N_BY_THETA] <= 0.0 else SMALLEST_CELL
    return SMALLEST_PASSAGE


@njit(cache=True, error_model="numpy")
def crosses(time_a: float, time_b: float, at_a: float, at_b: float) -> bool:
    """Whether two walkers pass the plane on different sides of the other edge."""
    if time_a == NEVER or time_b == NEVER or (time_a == 0.0 and time_b == 0.0):
        return False
    return (at_a >= 0.0) != (at_b >= 0.0)


@njit(cache=True, error_model="numpy")
def in_half_space(node: Array, time: float) -> bool:
    """Whether the walker is below the plane at ``time``: then it has not come in because the thread is farther off."""
    return node[N_START] <= time < node[N_STOP]


@njit(cache=True, error_model="numpy")
def survey(
    motion: Array,
    row_c: Array,
    row_s: Array,
    marks: Array,
    mark_count: int,
    limit: float,
    any_entry: bool,
    slack: float,
    nodes: Array,
    found: Array,
) -> tuple[int, int, float]:
    """First look: a few nodes all round, closer near the marks, and the contacts that they bracket.

    Its only purpose is a limit near the final one; nothing rests on it. Returns the number of candidates, of nodes
    (sorted by theta, the first repeated at the end), and the earliest time.
    """
    bounds = np.empty(BOUNDS_SIZE)
    path = np.empty(PATH_SIZE)
    w = np.empty(9)
    spare = np.empty(NODE_SIZE)
    set_bounds(motion, row_c, row_s, bounds)
    total = 0
    for i in range(START_CELLS):
        theta = TWO_PI * (i + 0.5) / START_CELLS
        close = False
        for j in range(mark_count):
            d = abs(theta - marks[j])
            if min(d, TWO_PI - d) < 0.03:
                close = True
        if not close:
            nodes[total, N_THETA] = theta
            total += 1
    for j in range(mark_count):
        for step in (EPS_PUNCTURE, 1e-3, 1e-2):
            for side in (-1.0, 1.0):
                theta = marks[j] + side * step
                nodes[total, N_THETA] = theta - TWO_PI * math.floor(theta / TWO_PI)
                total += 1
    nodes[:total, N_THETA].sort()
    best = limit
    for i in range(total):
        set_node(nodes[i, N_THETA], motion, row_c, row_s, limit, 0.0, best + slack, bounds, path, nodes[i])
        if any_entry and nodes[i, N_TIME] < best:
            best = nodes[i, N_TIME]
    for j in range(NODE_SIZE):
        nodes[total, j] = nodes[0, j]
    nodes[total, N_THETA] += TWO_PI
    total += 1
    count = 0
    for i in range(total - 1):
        if holds_mark(nodes[i, N_THETA], nodes[i + 1, N_THETA], marks, mark_count):
            continue
        count = bracket(
            nodes[i], nodes[i + 1], motion, row_c, row_s, limit, best + slack, bounds, path, w, spare, count, found
        )
        if count > 0:
            best = min(best, found[0, C_TIME])
    return count, total, best


@njit(cache=True, error_model="numpy")
def close_cells(
    motion: Array,
    row_c: Array,
    row_s: Array,
    marks: Array,
    mark_count: int,
    limit: float,
    best: float,
    anchored: bool,
    any_entry: bool,
    slack: float,
    nodes: Array,
    total: int,
    cells: NDArray[np.int64],
    count: int,
    found: Array,
) -> tuple[int, bool, int, float]:
    """Closes every cell between the surveyed nodes by a bound, splitting where none holds.

    ``marks`` are azimuths in [0, 2 pi) of earlier contacts on this curve. With ``any_entry`` there are none and every
    entry is a contact (first contact, lift). ``best`` is the earliest time known, on either curve; ``anchored`` says
    that it is a contact's and not only a node's. Returns the
    number of candidates (earliest first), whether any part of the curve is inside before the earliest (growth), the
    number of nodes (OVERFLOW if they ran out) and the earliest time.
    """
    bounds = np.empty(BOUNDS_SIZE)
    path = np.empty(PATH_SIZE)
    w = np.empty(9)
    spare = np.empty(NODE_SIZE)
    set_bounds(motion, row_c, row_s, bounds)
    is_turn = motion[M_KIND] != 0.0
    proved = np.zeros(MAX_CELLS)
    tangent = np.empty(9)
    depth = 0
    for i in range(total - 1):
        cells[depth, 0] = i
        cells[depth, 1] = i + 1
        depth += 1
    growth = False
    while depth > 0:
        depth -= 1
        ia = cells[depth, 0]
        ib = cells[depth, 1]
        since = proved[depth]
        a = nodes[ia]
        b = nodes[ib]
        if holds_mark(a[N_THETA], b[N_THETA], marks, mark_count):
            continue
        width = b[N_THETA] - a[N_THETA]
        middle = 0.5 * (a[N_THETA] + b[N_THETA])
        doubt = TURN_DOUBT if is_turn else (HEIGHT_DOUBT * row_c[pk.P] if bounds[B_TILT] < SMALL_TILT else 0.0)
        sure = best - doubt if anchored and doubt > 0.0 else best + slack
        if a[N_TIME] < sure or b[N_TIME] < sure:
            if not any_entry:
                growth = True
                if width < smallest_growth(a, b):
                    continue
            elif width < SMALLEST_CELL:
                continue
            if a[N_HOW] == INSIDE and b[N_HOW] == INSIDE:
                continue
            if a[N_HOW] == b[N_HOW] and monotone(a, b, motion, row_c, row_s, bounds, path):
                continue
        else:
            if width < SMALLEST_CELL:
                continue
            half = 0.5 * width
            since = clear(middle, half, since, sure, motion, row_c, row_s, bounds, path, tangent)
            if since == NEVER:
                continue
            if near_candidate(middle, half, best + slack, count, found):
                continue
        if total + 1 >= MAX_NODES or depth + 2 >= MAX_CELLS:
            return count, growth, OVERFLOW, best
        c = nodes[total]
        theta = split_at(a[N_THETA], b[N_THETA], marks, mark_count)
        late = a[N_TIME] >= sure and b[N_TIME] >= sure
        out = late and clear(theta, 0.0, since, best + slack, motion, row_c, row_s, bounds, path, tangent) == NEVER
        set_node(theta, motion, row_c, row_s, limit, since, best + slack, bounds, path, c, out)
        if any_entry and c[N_TIME] < best:
            best = c[N_TIME]
            anchored = False
        count = bracket(a, c, motion, row_c, row_s, limit, best + slack, bounds, path, w, spare, count, found)
        count = bracket(c, b, motion, row_c, row_s, limit, best + slack, bounds, path, w, spare, count, found)
        if count > 0 and found[0, C_TIME] <= best + slack:
            best = min(best, found[0, C_TIME])
            anchored = True
        cells[depth, 0] = ia
        cells[depth, 1] = total
        cells[depth + 1, 0] = total
        cells[depth + 1, 1] = ib
        proved[depth] = since
        proved[depth + 1] = since
        depth += 2
        total += 1
    return count, growth, total, best


@njit(cache=True, error_model="numpy")
def bracket(
    a: Array,
    b: Array,
    motion: Array,
    row_c: Array,
    row_s: Array,
    limit: float,
    best: float,
    bounds: Array,
    path: Array,
    w: Array,
    spare: Array,
    count: int,
    found: Array,
) -> int:
    """Adds the contact that two neighbouring nodes bracket, if they do."""
    how = a[N_HOW]
    # T falls towards the right of a and towards the left of b.
    if (
        how == b[N_HOW]
        and (how == PLANE or how == THREAD)
        and a[N_BY_THETA] > 0.0
        and b[N_BY_THETA] < 0.0
        and a[N_BY_TAU] > 0.0
        and b[N_BY_TAU] > 0.0
        and stationary(a, b, motion, row_c, row_s, limit, bounds, path, spare)
    ):
        count = try_face(spare, motion, row_c, row_s, path, w, count, found)
    if passes_edge(a[N_START], b[N_START], a[N_AT_START], b[N_AT_START], best):
        theta, time = edge_root(a[N_THETA], b[N_THETA], False, motion, row_c, row_s, path)
        if 0.0 < time <= best:
            count = try_edge(theta, time, motion, row_c, row_s, path, w, count, found)
    if passes_edge(a[N_STOP], b[N_STOP], a[N_AT_STOP], b[N_AT_STOP], best):
        theta, time = edge_root(a[N_THETA], b[N_THETA], True, motion, row_c, row_s, path)
        if 0.0 < time <= best:
            count = try_edge(theta, time, motion, row_c, row_s, path, w, count, found)
    return count


@njit(cache=True, error_model="numpy")
def passes_edge(time_a: float, time_b: float, at_a: float, at_b: float, best: float) -> bool:
    """Whether between two walkers one passes the plane on the other edge, early enough to matter."""
    if not crosses(time_a, time_b, at_a, at_b):
        return False
    return min(time_a, time_b) - abs(time_a - time_b) <= best


@njit(cache=True, error_model="numpy")
def near_candidate(middle: float, half: float, best: float, count: int, found: Array) -> bool:
    """Whether the cell is the immediate neighbourhood of a contact that is listed already."""
    for i in range(count):
        if found[i, C_TIME] > best:
            break
        gap = middle - found[i, C_THETA]
        gap -= TWO_PI * math.floor(gap / TWO_PI + 0.5)
        if abs(gap) + half < NEIGHBOURHOOD:
            return True
    return False
