"""A record's contacts in its last pose: points about the bolt's origin, and the normals there (forces, section 2)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._geometry_kernel import edge_point
from threadstate.contact._record_kernel import (
    O_CONTACT,
    O_CONTACTS,
    O_POSE,
    O_POSES,
    P_BOLT_POINT,
    P_NORMAL,
    P_PAIR,
    P_POINT,
    P_STAGE,
    POINT_SIZE,
)
from threadstate.contact._stage_kernel import BASE_EDGE, EDGE_EDGE, THREAD_EDGE
from threadstate.thread import _profile_kernel as pk

Array = NDArray[np.float64]

PARALLEL_SINE = 1e-9
"""Edges that cross at a smaller angle (its sine) in the last pose have no certain normal."""


@kernel()
def set_last_normal(contact: Array, then: Array, last: Array, bolt: Array, nut: Array, normal: Array) -> bool:
    """Sets the unit normal of a record's contact in the last pose: the nut's, the bolt's turned, or across both edges.

    ``then`` is the pose of the contact's stage; poses have twelve numbers. Returns whether the normal is certain: not
    where edges are parallel.
    """
    features = int(contact[P_PAIR])
    point = contact[P_POINT : P_POINT + 3]
    if features == EDGE_EDGE:
        _, _, dx, dy = edge_point(math.atan2(contact[P_BOLT_POINT + 1], contact[P_BOLT_POINT]), bolt)
        _, _, nx, ny = edge_point(math.atan2(point[1], point[0]), nut)
        bx = last[0] * dx + last[1] * dy
        by = last[3] * dx + last[4] * dy
        bz = last[6] * dx + last[7] * dy
        normal[0], normal[1], normal[2] = -bz * ny, bz * nx, bx * ny - by * nx
        size = math.sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2])
        if not size > PARALLEL_SINE * math.hypot(dx, dy) * math.hypot(nx, ny):
            return False
        # The bolt's material lies on the side of its axis above the base, as in the pose of the contact's stage.
        inward = 0.0
        for i in range(3):
            inward += normal[i] * (last[9 + i] + last[3 * i + 2] * bolt[pk.P] / 2.0 - point[i])
        if inward < 0.0:
            size = -size
        for i in range(3):
            normal[i] /= size
        return True
    stored = contact[P_NORMAL : P_NORMAL + 3]
    for i in range(3):
        normal[i] = stored[i]
    if features == BASE_EDGE or features == THREAD_EDGE:
        for i in range(3):
            normal[i] = 0.0
            for j in range(3):
                on_bolt = then[j] * stored[0] + then[3 + j] * stored[1] + then[6 + j] * stored[2]
                normal[i] += last[3 * i + j] * on_bolt
    return True


@kernel()
def set_contacts(record: Array, bolt: Array, nut: Array, points: Array, normals: Array) -> int:
    """Sets the contacts' points about the bolt's origin and normals, both (k, 3), in a record's last pose.

    Returns the place of the first contact that has no certain normal; k if all have one.
    """
    count = int(record[O_CONTACTS])
    poses = int(record[O_POSES])
    last = record[O_POSE + 12 * (poses - 1) : O_POSE + 12 * poses]
    for i in range(count):
        contact = record[O_CONTACT + POINT_SIZE * i : O_CONTACT + POINT_SIZE * (i + 1)]
        for j in range(3):
            points[i, j] = contact[P_POINT + j] - last[9 + j]
        stage = min(int(contact[P_STAGE]), poses)
        then = record[O_POSE + 12 * (stage - 1) : O_POSE + 12 * stage]
        if not set_last_normal(contact, then, last, bolt, nut, normals[i]):
            return i
    return count
