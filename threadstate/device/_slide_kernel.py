"""A bolt that lies flush on the nut's surface with friction: where it slides to, and whether it stays there.

Rigid parts do not say how the pressure is spread over the patch, on which the torque of friction depends. It is
declared: of all pressures along the patch's outline with the force and the moment of the balance, the one of greatest
entropy (``w_i`` in proportion to ``exp(a . x_i)``), which is there, unique and positive for every centre of pressure
inside the patch's hull. Friction opposes the slip of each point of the outline. A bolt that is not turned sticks where
friction can hold it, and else slides without turning: there the pressure does not matter. Units: forces as the push's,
lengths as the pair's.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch, zeros
from threadstate.device._chart_kernel import (
    COORDINATES,
    D_RIGID,
    D_STIFFNESS,
    N_CENTRE,
    N_OFFSET,
    N_ROTATION,
    PLACE_SIZE,
    elastic_energy,
    set_place,
)
from threadstate.device._flush_kernel import NEAR_SURFACE, NEARLY_LEVEL, centre_of_pressure, set_flush
from threadstate.device._patch_kernel import (
    H_X,
    H_Y,
    HULL_ROWS,
    POINT_SIZE,
    POINTS,
    patch_points,
    set_patch_hull,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

WEIGHT_STEPS, PLACE_STEPS, ROUNDS, SHORTENINGS = 60, 60, 60, 30
"""The most steps of Newton's method for the weights and for the place, the most rounds of both in turn, and the most
halvings of a step."""

WEIGHTED, NEARLY_WEIGHTED = 1e-12, 1e-6
"""How near (nominal radii) the centre of the weights is to that of pressure; from where on steps are whole, where
round-off decides between values."""

LEAST_EXPONENT = -700.0
"""Up to which weights are zero: beside the largest, and slow to compute."""

TURNED_BACK, INWARD = 3, 0.1
"""In how many rounds the centre of pressure may be outside the patch's hull, and by which part of the way to the middle
of the patch's points it is moved, and moved again, until it is inside."""

LATERAL_LEFT, SAME_ROUND = 1e-13, 1e-10
"""The lateral force (over the push) that is left; the change of force (over the push) and of place (nominal radii) in a
round that is the last."""

LEAST_SLIP = 1e-12
"""Added, in nominal radii, to slips in squares: the point about which the bolt turns has no direction."""

LEVEL_TILT = 1e-9
"""Tilt (rad) below which a bolt counts as level."""

# How a bolt lies on the surface after a step: centre of pressure, force along z, friction along x and y, its moment
# about z beside that of the resultant at the centre of pressure, the work against friction in the step, and whether it
# slides.
L_X, L_Y, L_FORCE, L_FRICTION, L_MOMENT, L_LOSS, L_SLIDES = 0, 1, 2, 3, 5, 6, 7
LYING_SIZE = 8


@kernel()
def lies_beside(q: Array, device: Array, r: float) -> bool:
    """Whether a bolt is nearly level, near the nut's surface."""
    place = scratch(PLACE_SIZE)
    set_place(q, device, place)
    tilt = math.hypot(place[N_ROTATION + 6], place[N_ROTATION + 7])
    return tilt < NEARLY_LEVEL and abs(place[N_OFFSET + 2]) < NEAR_SURFACE * r


@kernel()
def is_level(q: Array, device: Array) -> bool:
    """Whether a bolt is level."""
    place = scratch(PLACE_SIZE)
    set_place(q, device, place)
    return math.hypot(place[N_ROTATION + 6], place[N_ROTATION + 7]) < LEVEL_TILT


@kernel()
def set_weights(count: int, points: Array, x: float, y: float, r: float, rates: Array, weights: Array) -> bool:
    """Sets the weights of greatest entropy of points whose centre is (x, y); False where it is not inside them.

    Newton's method for the minimum of the logarithm of the sum of ``exp(a . (x_i - x))``, which is convex in ``a``. It
    begins with the ``rates`` (2), which are set to ``a``.
    """
    ax, ay = rates[0], rates[1]
    for _ in range(WEIGHT_STEPS):
        total, mx, my, xx, xy, yy = weighted_sums(count, points, x, y, ax, ay, weights)
        if math.hypot(mx, my) <= WEIGHTED * r:
            for i in range(count):
                weights[i] /= total
            rates[0], rates[1] = ax, ay
            return True
        xx, xy, yy = xx - mx * mx, xy - mx * my, yy - my * my
        determinant = xx * yy - xy * xy
        if not determinant > 0.0:
            return False
        sx, sy = -(yy * mx - xy * my) / determinant, -(xx * my - xy * mx) / determinant
        # Beside the hull's outline the minimum is far away, as one over the distance to it.
        part = min(1.0, (10.0 + r * math.hypot(ax, ay)) / (r * math.hypot(sx, sy)))
        value = math.log(total) + highest(count, points, x, y, ax, ay)
        for _ in range(SHORTENINGS if math.hypot(mx, my) > NEARLY_WEIGHTED * r else 0):
            bx, by = ax + part * sx, ay + part * sy
            other, _, _, _, _, _ = weighted_sums(count, points, x, y, bx, by, weights)
            if math.log(other) + highest(count, points, x, y, bx, by) <= value:
                break
            part *= 0.5
        ax, ay = ax + part * sx, ay + part * sy
    return False


@kernel()
def set_weights_inside(count: int, points: Array, x: float, y: float, r: float, rates: Array, weights: Array) -> bool:
    """As :func:`set_weights`, of the first point inside on the way from (x, y) to the middle of the points."""
    middle_x, middle_y = 0.0, 0.0
    for i in range(count):
        middle_x += points[i, H_X] / count
        middle_y += points[i, H_Y] / count
    for _ in range(SHORTENINGS):
        x += INWARD * (middle_x - x)
        y += INWARD * (middle_y - y)
        if set_weights(count, points, x, y, r, rates, weights):
            return True
    return False


@kernel()
def highest(count: int, points: Array, x: float, y: float, ax: float, ay: float) -> float:
    """The largest exponent of the weights."""
    most = -math.inf
    for i in range(count):
        most = max(most, ax * (points[i, H_X] - x) + ay * (points[i, H_Y] - y))
    return most


@kernel()
def weighted_sums(
    count: int, points: Array, x: float, y: float, ax: float, ay: float, weights: Array
) -> tuple[float, float, float, float, float, float]:
    """Sets weights ``exp(a . (x_i - x))`` over the largest; returns their sum, and first and second moments over it."""
    most = highest(count, points, x, y, ax, ay)
    total, mx, my, xx, xy, yy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(count):
        dx, dy = points[i, H_X] - x, points[i, H_Y] - y
        exponent = ax * dx + ay * dy - most
        w = math.exp(exponent) if exponent > LEAST_EXPONENT else 0.0
        weights[i] = w
        total += w
        mx += w * dx
        my += w * dy
        xx += w * dx * dx
        xy += w * dx * dy
        yy += w * dy * dy
    return total, mx / total, my / total, xx / total, xy / total, yy / total


@kernel()
def set_friction(
    count: int, points: Array, weights: Array, strength: float, before: Array, place: Array, r: float, out: Array
) -> float:
    """Sets friction's force, moment about z at the centre, and how the force changes with the place; the loss.

    ``strength`` is the friction times the force along z. ``out``: force (2), moment, derivative by the place (4).
    """
    m, b = place[N_ROTATION:], before[N_ROTATION:]
    # The bolt's turn back to where it was, of level poses.
    cos, sin = b[0] * m[0] + b[1] * m[1], b[3] * m[0] + b[4] * m[1]
    cx, cy = place[N_CENTRE], place[N_CENTRE + 1]
    ex, ey = cx - before[N_CENTRE], cy - before[N_CENTRE + 1]
    least = LEAST_SLIP * r
    loss = 0.0
    for i in range(7):
        out[i] = 0.0
    for i in range(count):
        x, y = points[i, H_X] - cx, points[i, H_Y] - cy
        sx, sy = x - (cos * x - sin * y) + ex, y - (sin * x + cos * y) + ey
        slip = math.sqrt(sx * sx + sy * sy + least * least)
        size = strength * weights[i]
        fx, fy = -size * sx / slip, -size * sy / slip
        out[0] += fx
        out[1] += fy
        out[2] += x * fy - y * fx
        loss -= fx * sx + fy * sy
        # The slip changes with the place by the turn back; its direction by what of that is across it.
        across = size / slip
        nx, ny = sx / slip, sy / slip
        along_x, along_y = nx * cos + ny * sin, -nx * sin + ny * cos
        out[3] -= across * (cos - nx * along_x)
        out[4] -= across * (-sin - nx * along_y)
        out[5] -= across * (sin - ny * along_x)
        out[6] -= across * (cos - ny * along_y)
    return loss


@kernel()
def slide_to_balance(
    count: int,
    points: Array,
    weights: Array,
    strength: float,
    unit: float,
    before: Array,
    r: float,
    device: Array,
    q: Array,
    friction: Array,
) -> tuple[bool, float]:
    """Slides a level bolt, in place, to where friction balances the device's lateral force: whether, and the loss."""
    place = scratch(PLACE_SIZE)
    by_q = scratch(COORDINATES)
    k = device[D_STIFFNESS:]
    set_place(q, device, place)
    elastic_energy(q, device, by_q)
    loss = set_friction(count, points, weights, strength, before, place, r, friction)
    gx, gy = friction[0] - by_q[3], friction[1] - by_q[4]
    for _ in range(PLACE_STEPS):
        size = math.hypot(gx, gy)
        if size <= LATERAL_LEFT * unit:
            return True, loss
        xx, xy, yx, yy = friction[3] - k[21], friction[4] - k[22], friction[5] - k[27], friction[6] - k[28]
        determinant = xx * yy - xy * yx
        if not determinant > 0.0:
            return False, loss
        sx, sy = -(yy * gx - xy * gy) / determinant, -(xx * gy - yx * gx) / determinant
        from_x, from_y, part = q[3], q[4], 1.0
        for _ in range(SHORTENINGS):
            q[3], q[4] = from_x + part * sx, from_y + part * sy
            set_place(q, device, place)
            elastic_energy(q, device, by_q)
            loss = set_friction(count, points, weights, strength, before, place, r, friction)
            gx, gy = friction[0] - by_q[3], friction[1] - by_q[4]
            if math.hypot(gx, gy) < size:
                break
            part *= 0.5
        if not math.hypot(gx, gy) < size:
            # Round-off of the forces decides.
            return size <= 1e3 * LATERAL_LEFT * unit, loss
    return False, loss


@kernel(allocates=True)
def lie_flush(
    push: float,
    mu: float,
    turns: bool,
    before: Array,
    device: Array,
    bolt: Array,
    nut: Array,
    level: Array,
    lying: Array,
) -> tuple[bool, float]:
    """Lays a bolt flush on the surface after a step: whether it stays so, and else the direction (rad) it tips in.

    ``level`` is set to where it is, ``lying`` to how it lies; ``before`` is its pose before the step.
    """
    r = bolt[pk.R_MAJOR]
    if not set_flush(device, level) or not device[D_RIGID] > 0.0:
        return False, 0.0
    place, by_q = scratch(PLACE_SIZE), scratch(COORDINATES)
    points, hull = scratch(POINTS, POINT_SIZE), scratch(HULL_ROWS, POINT_SIZE)
    weights, rates, friction = scratch(POINTS), zeros(2), zeros(7)
    free_x, free_y = level[3], level[4]
    level[3], level[4] = before[N_CENTRE], before[N_CENTRE + 1]
    elastic_energy(level, device, by_q)
    strength = mu * (push + by_q[5])
    pull = math.hypot(by_q[3], by_q[4])
    sticks = not turns and pull <= strength
    if sticks or turns:
        # Of a bolt that slides while it is turned: where the rounds begin.
        part = min(1.0, strength / pull) if pull > 0.0 else 0.0
        friction[0], friction[1] = part * by_q[3], part * by_q[4]
    else:
        level[3], level[4] = free_x, free_y
    loss, x, y, force = 0.0, 0.0, 0.0, 0.0
    is_balanced, turned_back = False, 0
    # The patch is that of the place before: which samples of the outlines are in it would change from round to round.
    set_place(level, device, place)
    count = patch_points(place, bolt, nut, points)
    for _ in range(ROUNDS):
        is_inside = True
        was_x, was_y, was_fx, was_fy, was_moment = level[3], level[4], friction[0], friction[1], friction[2]
        set_place(level, device, place)
        x, y, force, _ = centre_of_pressure(level, push, place, device, friction)
        if not force > 0.0:
            return False, 0.0
        if sticks or not turns:
            # One direction of slip: friction has a resultant at the centre of pressure.
            weights[0], points[0, H_X], points[0, H_Y], count = 1.0, x, y, 1
        elif not set_weights(count, points, x, y, r, rates, weights):
            # Friction as it was may have it outside where friction as it is does not.
            if turned_back == TURNED_BACK or not set_weights_inside(count, points, x, y, r, rates, weights):
                break
            turned_back += 1
            is_inside = False
        if sticks:
            friction[2] = (x - place[N_CENTRE]) * friction[1] - (y - place[N_CENTRE + 1]) * friction[0]
        else:
            is_there, loss = slide_to_balance(
                count, points, weights, mu * force, push, before, r, device, level, friction
            )
            if not is_there:
                return False, 0.0
        change = max(abs(level[3] - was_x), abs(level[4] - was_y)) / r
        change = max(change, abs(friction[0] - was_fx) / push, abs(friction[1] - was_fy) / push)
        if is_inside and max(change, abs(friction[2] - was_moment) / (push * r)) <= SAME_ROUND:
            is_balanced = True
            break
    set_place(level, device, place)
    _, margin, side, size = set_patch_hull(x, y, place, bolt, nut, points, hull)
    if not margin > 0.0 or not is_balanced:
        if size < 3:
            # Nothing of the patch is left to tip over: it tips towards where it is pressed.
            return False, math.atan2(y - place[N_OFFSET + 1], x - place[N_OFFSET])
        other = side + 1 if side + 1 < size else 0
        return False, math.atan2(hull[side, H_X] - hull[other, H_X], hull[other, H_Y] - hull[side, H_Y])
    lying[L_X], lying[L_Y], lying[L_FORCE] = x, y, force
    lying[L_FRICTION], lying[L_FRICTION + 1] = friction[0], friction[1]
    at_centre = (x - place[N_CENTRE]) * friction[1] - (y - place[N_CENTRE + 1]) * friction[0]
    lying[L_MOMENT] = friction[2] - at_centre
    lying[L_LOSS], lying[L_SLIDES] = loss, 0.0 if sticks else 1.0
    return True, 0.0
