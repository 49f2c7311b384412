"""A record: the result of a pose as one row of numbers, in which kernels return it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate._scratch import scratch
from threadstate.contact._geometry_kernel import TWO_PI, copy_numbers, edge_point, phi_and_gradient
from threadstate.contact._stage_kernel import (
    BASE_EDGE,
    CONTACT_SIZE,
    EDGE_EDGE,
    EDGE_SURFACE,
    EDGE_THREAD,
    FLUSH,
    K_BOLT_AZIMUTH,
    K_NUT_AZIMUTH,
    K_PAIR,
    K_X,
    K_Y,
    K_Z,
    THREAD_EDGE,
    THREAD_SURFACE,
    THREAD_THREAD,
    UNRESOLVED,
)
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

# A record: status, flags, number of poses, lambda, mu (rad, NaN where absent), drop, embedment, pivot offset
# (NaN where absent), number of contacts; three poses of twelve numbers; the contacts.
(
    O_STATUS,
    O_FLAGS,
    O_POSES,
    O_LAMBDA,
    O_MU,
    O_DROP,
    O_EMBEDMENT,
    O_PIVOT,
    O_CONTACTS,
) = range(9)
O_POSE = 9
O_CONTACT = O_POSE + 36

# A contact: stage, pair, point in the nut's frame, in the bolt's, normal, region indices, margins.
P_STAGE, P_PAIR, P_POINT, P_BOLT_POINT, P_NORMAL, P_BOLT_REGION, P_NUT_REGION, P_BOLT_MARGIN, P_NUT_MARGIN = (
    0,
    1,
    2,
    5,
    8,
    11,
    12,
    13,
    14,
)
POINT_SIZE = 15
MAX_RECORD_CONTACTS = 16
"""The corners of four strips of flank, on which a level bolt of four starts rests."""
RECORD_SIZE = O_CONTACT + MAX_RECORD_CONTACTS * POINT_SIZE

POSITIVE_FLANK = 2
"""Index of the flank on which the radius grows with z, of both parts."""
FLAT_FACE = 8
"""Index of the ninth region (base or surface)."""

FLAG_FLUSH, FLAG_TIE, FLAG_BALANCED, FLAG_GRAZING, FLAG_NO_SECOND, FLAG_NO_THIRD = 1, 2, 4, 8, 16, 32

GRAZING_SINE = 1e-3
"""Two edges that cross at a smaller angle (its sine) graze."""


@kernel()
def in_bolt_frame(pose: Array, x: float, y: float, z: float) -> tuple[float, float, float]:
    """A point of the nut's frame in the bolt's."""
    x -= pose[9]
    y -= pose[10]
    z -= pose[11]
    return (
        pose[0] * x + pose[3] * y + pose[6] * z,
        pose[1] * x + pose[4] * y + pose[7] * z,
        pose[2] * x + pose[5] * y + pose[8] * z,
    )


@kernel()
def append_pose(pose: Array, record: Array) -> None:
    """Appends the pose of a stage."""
    n = int(record[O_POSES])
    for i in range(12):
        record[O_POSE + 12 * n + i] = pose[i]
    record[O_POSES] = n + 1


@kernel()
def append_contact(stage: int, contact: Array, pose: Array, bolt: Array, nut: Array, record: Array) -> None:
    """Appends a contact with its points, normal, regions and margins; a full record becomes unresolved instead."""
    n = int(record[O_CONTACTS])
    if n == MAX_RECORD_CONTACTS:
        record[O_STATUS] = UNRESOLVED
        return
    c = record[O_CONTACT + POINT_SIZE * n : O_CONTACT + POINT_SIZE * (n + 1)]
    pair = int(contact[K_PAIR])
    x, y, z = contact[K_X], contact[K_Y], contact[K_Z]
    bx, by, bz = in_bolt_frame(pose, x, y, z)
    on_bolt_edge = pair == EDGE_EDGE or pair == EDGE_SURFACE or pair == EDGE_THREAD
    on_nut_edge = pair == EDGE_EDGE or pair == BASE_EDGE or pair == THREAD_EDGE
    if on_bolt_edge:
        bz = 0.0
    c[P_STAGE] = stage
    c[P_PAIR] = pair
    c[P_POINT], c[P_POINT + 1], c[P_POINT + 2] = x, y, z
    c[P_BOLT_POINT], c[P_BOLT_POINT + 1], c[P_BOLT_POINT + 2] = bx, by, bz
    set_normal(pair, contact, pose, bolt, nut, c)
    k = bolt[pk.LEAD] / TWO_PI
    if pair == BASE_EDGE:
        c[P_BOLT_REGION] = FLAT_FACE
        c[P_BOLT_MARGIN] = pk.radius(-k * math.atan2(by, bx), bolt) - math.hypot(bx, by)
    else:
        index, margin = pk.region_index((0.0 if on_bolt_edge else bz) - k * math.atan2(by, bx), bolt)
        c[P_BOLT_REGION] = index
        c[P_BOLT_MARGIN] = margin
    if pair == EDGE_SURFACE or pair == THREAD_SURFACE:
        c[P_NUT_REGION] = FLAT_FACE
        c[P_NUT_MARGIN] = math.hypot(x, y) - pk.radius(-k * math.atan2(y, x), nut)
    else:
        index, margin = pk.region_index((0.0 if on_nut_edge else z) - k * math.atan2(y, x), nut)
        c[P_NUT_REGION] = index
        c[P_NUT_MARGIN] = margin
    record[O_CONTACTS] = n + 1


@kernel()
def set_normal(pair: int, contact: Array, pose: Array, bolt: Array, nut: Array, c: Array) -> None:
    """Sets the unit normal, from the nut into the bolt."""
    x, y, z = contact[K_X], contact[K_Y], contact[K_Z]
    if pair == EDGE_EDGE:
        _, _, dx, dy = edge_point(contact[K_BOLT_AZIMUTH], bolt)
        ex = pose[0] * dx + pose[1] * dy
        ey = pose[3] * dx + pose[4] * dy
        ez = pose[6] * dx + pose[7] * dy
        _, _, sx, sy = edge_point(contact[K_NUT_AZIMUTH], nut)
        nx, ny, nz = -ez * sy, ez * sx, ex * sy - ey * sx
        # The bolt's material lies on the side of its axis above the base.
        bx = pose[9] + 0.5 * bolt[pk.P] * pose[2] - x
        by = pose[10] + 0.5 * bolt[pk.P] * pose[5] - y
        bz = pose[11] + 0.5 * bolt[pk.P] * pose[8] - z
        flip = nx * bx + ny * by + nz * bz < 0.0
    elif pair == EDGE_SURFACE or pair == THREAD_SURFACE or pair == FLUSH:
        nx, ny, nz = 0.0, 0.0, 1.0
        flip = False
    elif pair == BASE_EDGE:
        nx, ny, nz = pose[2], pose[5], pose[8]
        flip = False
    elif pair == THREAD_EDGE:
        bx, by, bz = in_bolt_frame(pose, x, y, z)
        _, gx, gy, gz = phi_and_gradient(bx, by, bz, bolt, -1.0)
        nx = pose[0] * gx + pose[1] * gy + pose[2] * gz
        ny = pose[3] * gx + pose[4] * gy + pose[5] * gz
        nz = pose[6] * gx + pose[7] * gy + pose[8] * gz
        flip = False
    else:
        _, gx, gy, gz = phi_and_gradient(x, y, z, nut, 1.0)
        nx, ny, nz = -gx, -gy, -gz
        flip = False
    n = math.sqrt(nx * nx + ny * ny + nz * nz)
    if flip:
        n = -n
    c[P_NORMAL], c[P_NORMAL + 1], c[P_NORMAL + 2] = nx / n, ny / n, nz / n


@kernel()
def append_flush_point(
    stage: int, theta: float, corner: bool, x: float, y: float, bolt: Array, nut: Array, record: Array
) -> None:
    """Appends an extreme point of a flush patch: the bolt's edge at ``theta``, on the nut's edge if ``corner``.

    A full record becomes unresolved instead.
    """
    n = int(record[O_CONTACTS])
    if n == MAX_RECORD_CONTACTS:
        record[O_STATUS] = UNRESOLVED
        return
    c = record[O_CONTACT + POINT_SIZE * n : O_CONTACT + POINT_SIZE * (n + 1)]
    k = bolt[pk.LEAD] / TWO_PI
    c[P_STAGE] = stage
    c[P_PAIR] = FLUSH
    c[P_POINT], c[P_POINT + 1], c[P_POINT + 2] = x, y, 0.0
    bx, by, _, _ = edge_point(theta, bolt)
    c[P_BOLT_POINT], c[P_BOLT_POINT + 1], c[P_BOLT_POINT + 2] = bx, by, 0.0
    c[P_NORMAL], c[P_NORMAL + 1], c[P_NORMAL + 2] = 0.0, 0.0, 1.0
    index, margin = pk.region_index(-k * theta, bolt)
    c[P_BOLT_REGION] = index
    c[P_BOLT_MARGIN] = margin
    azimuth = math.atan2(y, x)
    if corner:
        index, margin = pk.region_index(-k * azimuth, nut)
        c[P_NUT_REGION] = index
        c[P_NUT_MARGIN] = margin
    else:
        c[P_NUT_REGION] = FLAT_FACE
        c[P_NUT_MARGIN] = math.hypot(x, y) - pk.radius(-k * azimuth, nut)
    record[O_CONTACTS] = n + 1


@kernel()
def append_strip_corner(contact: Array, pose: Array, bolt: Array, nut: Array, record: Array) -> None:
    """Appends a corner of the strip of flank on which a level bolt rests, as a contact of the first stage.

    The flank of one part ends there, so that round-off would decide its region: both regions are set to the flank.
    """
    n = int(record[O_CONTACTS])
    strip = scratch(CONTACT_SIZE)
    copy_numbers(contact, strip)
    strip[K_PAIR] = THREAD_THREAD
    append_contact(1, strip, pose, bolt, nut, record)
    c = record[O_CONTACT + POINT_SIZE * n : O_CONTACT + POINT_SIZE * (n + 1)]
    c[P_PAIR] = FLUSH
    c[P_BOLT_REGION] = POSITIVE_FLANK
    c[P_NUT_REGION] = POSITIVE_FLANK


@kernel()
def grazes(contact: Array, pose: Array, bolt: Array, nut: Array) -> bool:
    """Whether a contact's features are nearly parallel: edges that cross at a very small angle."""
    if int(contact[K_PAIR]) != EDGE_EDGE:
        return False
    _, _, dx, dy = edge_point(contact[K_BOLT_AZIMUTH], bolt)
    ex = pose[0] * dx + pose[1] * dy
    ey = pose[3] * dx + pose[4] * dy
    ez = pose[6] * dx + pose[7] * dy
    _, _, sx, sy = edge_point(contact[K_NUT_AZIMUTH], nut)
    nx, ny, nz = -ez * sy, ez * sx, ex * sy - ey * sx
    size = math.sqrt(nx * nx + ny * ny + nz * nz)
    return size < GRAZING_SINE * math.hypot(dx, dy) * math.hypot(sx, sy)
