"""A bolt that lies flush on the nut: how it begins there, its pose, and forces on the patch that balance the push."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate.contact.level import level_contact, strip_extremes
from threadstate.device import _chart_kernel as ck
from threadstate.device import _flush_kernel as fk
from threadstate.device import _patch_kernel as pk
from threadstate.device.equilibrium import balance
from threadstate.device.model import Device, LoadedContact
from threadstate.state.model import FeaturePair
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]


LEAST_SHARE = 1e-12
"""A corner of the hull that carries less of the force than this carries none: the others are in line with it."""

LEAST_SINE = 1e-12
"""The sine of the angle at a corner below which a triangle of the hull has no area."""

TIP = 1e-6
"""How far (rad) a level bolt that its patch does not support is tipped, so that it touches at points."""


def level_start(pair: Pair, phase_deg: float, command: Floats) -> tuple[float, Floats]:
    """The height of a level bolt at its first contact, and the rotation vector by which a small push tips it.

    It touches along a patch of the surface, or along a strip of flank. Where the bolt's axis is inside the hull of the
    patch it stays, and the vector is zero; else it tips over the nearest side of the hull, or away from the strip.
    """
    contact = level_contact(pair, math.radians(phase_deg))
    hull = np.empty((0, 2))
    if contact.on_thread:
        points = np.array(strip_extremes(pair, contact.height))[:, :2]
        margin, side = -math.inf, 0
    else:
        place = np.zeros(ck.PLACE_SIZE)
        place[:9] = command
        points, hull, margin, side = patch_hull(pair, place, 0.0, 0.0)
    away = -points.mean(axis=0) if len(points) else np.array([1.0, 0.0])
    if len(hull) > 2:
        if margin >= 0.0:
            return contact.height, np.zeros(3)
        edge = hull[(side + 1) % len(hull)] - hull[side]
        away = np.array([edge[1], -edge[0]])
    x, y = away / np.linalg.norm(away)
    return contact.height, np.asarray(command.reshape(3, 3).T @ np.array([-y, x, 0.0]) * TIP)


def level_numbers(numbers: Floats) -> tuple[Floats, Floats]:
    """The coordinates of the level pose of a device, and its rotation by rows and translation."""
    q = np.empty(ck.COORDINATES)
    place = np.empty(ck.PLACE_SIZE)
    fk.set_flush(numbers, q)
    ck.set_place(q, numbers, place)
    # The base is level there: what differs from that is round-off.
    pose = place[:12].copy()
    pose[[2, 5, 6, 7]], pose[8], pose[11] = 0.0, 1.0, 0.0
    return q, pose


def flush_contacts(
    pair: Pair, device: Device, numbers: Floats, q: Floats, pose: Floats
) -> tuple[tuple[LoadedContact, ...], float | None, float]:
    """Points of the patch's hull with the forces there, the margin of the centre of pressure in it, and the residual.

    The margin is None where there is no patch. The forces are those of three extreme points about the centre of
    pressure; any others on the patch with the same sum and moment balance the push as well.
    """
    place = np.empty(ck.PLACE_SIZE)
    ck.set_place(q, numbers, place)
    x, y, force, _ = fk.centre_of_pressure(q, device.push, place, numbers, np.zeros(3))
    _, hull, margin, _ = patch_hull(pair, place, x, y)
    if len(hull) < 3:
        return (), None, math.inf
    if not margin > 0.0 or not force > 0.0:
        return (), margin, math.inf
    corners, shares = triangle_about(hull, x, y)
    contacts = tuple(
        LoadedContact((float(px), float(py), 0.0), (0.0, 0.0, 1.0), FeaturePair.FLUSH, (0.0, 0.0, float(share * force)))
        for (px, py), share in zip(corners, shares, strict=True)
        if share > LEAST_SHARE
    )
    return contacts, margin, balance(pair, device, q, pose, numbers, contacts)


def patch_hull(pair: Pair, place: Floats, x: float, y: float) -> tuple[Floats, Floats, float, int]:
    """Points of the patch, shape (n, 2), and the corners of their convex hull; how far inside the patch's hull a point
    is, negative: outside, and the side of the hull of which that is said.
    """
    bolt, nut = pair.bolt.packed, pair.nut.packed
    points = np.empty((pk.POINTS, pk.POINT_SIZE))
    hull = np.empty((pk.HULL_ROWS, pk.POINT_SIZE))
    count, margin, side, size = pk.set_patch_hull(x, y, place, bolt, nut, points, hull)
    return points[:count, :2].copy(), hull[:size, :2].copy(), margin, side


def triangle_about(hull: Floats, x: float, y: float) -> tuple[Floats, Floats]:
    """Three corners of a convex polygon about a point inside it, and the point's barycentric coordinates.

    They are one corner, the farthest from the point, and the ends of the side that the ray from it through the point
    leaves by. Corners that are as good as one, as where edges cross, make no side.
    """
    point = np.array([x, y])
    first = int(np.argmax(np.linalg.norm(hull - point, axis=1)))
    best: tuple[float, int, Floats] = (-math.inf, 0, np.zeros(3))
    count = len(hull)
    for i in range(1, count - 1):
        corners = hull[[first, (first + i) % count, (first + i + 1) % count]]
        (ax, ay), (bx, by) = corners[1:] - corners[0]
        if not ax * by - ay * bx > LEAST_SINE * math.hypot(ax, ay) * math.hypot(bx, by):
            continue
        shares = np.linalg.solve(np.vstack([corners.T, np.ones(3)]), [x, y, 1.0])
        if shares.min() > best[0]:
            best = (float(shares.min()), i, np.asarray(shares, dtype=np.float64))
    i = best[1]
    return hull[[first, (first + i) % count, (first + i + 1) % count]], best[2]
