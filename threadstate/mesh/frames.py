"""The frames of the paper's section 6 as (4, 4) transforms; ``T_a_b`` takes coordinates of frame b to frame a.

F is the nut's (fixed) frame, B the bolt's, C0 has its origin at the first contact and its x axis along the tangent
there, C1 is C0 carried on by the second turn, P0 has its x axis from the first to the second contact, P1 is P0 carried
on by the third turn. Angles are in rad, lengths in one unit.

The paper writes products from left to right in the order in which its axes are turned, and calls the inverse of
``T_fixed_bolt`` its name; here every product is one of active matrices (method, section 2).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from threadstate.mesh.solid import Floats


def rot_x(angle: float) -> Floats:
    """Right-handed rotation about x."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[1.0, 0.0, 0.0, 0.0], [0.0, c, -s, 0.0], [0.0, s, c, 0.0], [0.0, 0.0, 0.0, 1.0]])


def rot_y(angle: float) -> Floats:
    """Right-handed rotation about y."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s, 0.0], [0.0, 1.0, 0.0, 0.0], [-s, 0.0, c, 0.0], [0.0, 0.0, 0.0, 1.0]])


def rot_z(angle: float) -> Floats:
    """Right-handed rotation about z."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]])


def trans(vector: ArrayLike) -> Floats:
    """Translation by a vector of shape (3,)."""
    out = np.eye(4)
    out[:3, 3] = vector
    return out


def inverse(T: Floats) -> Floats:
    """The inverse of a rotation with a translation."""
    out = np.eye(4)
    out[:3, :3] = T[:3, :3].T
    out[:3, 3] = -T[:3, :3].T @ T[:3, 3]
    return out


def apply(T: Floats, points: ArrayLike) -> Floats:
    """Points of shape (..., 3) in the other frame."""
    return np.asarray(points, dtype=np.float64) @ T[:3, :3].T + T[:3, 3]


def fixed_from_bolt(roll: float, pitch: float, phase: float, t: ArrayLike) -> Floats:
    """``T_fixed_bolt`` of a pose (Eqs. 2 and 3); its inverse is Eq. 4."""
    return trans(t) @ rot_z(phase) @ rot_y(pitch) @ rot_x(roll)


def axis_angles(direction: ArrayLike) -> tuple[float, float]:
    """The turns about z and then about the new y that bring x to a direction (Eqs. 7, 9 and 11), by atan2.

    Along +-z the first of them is free, and 0.
    """
    x, y, z = (float(v) for v in np.asarray(direction, dtype=np.float64))
    return math.atan2(y, x), math.atan2(-z, math.hypot(x, y))


def along(direction: ArrayLike, origin: ArrayLike) -> Floats:
    """``T_c_a``: from frame a to that with x along a direction through an origin, both given in a (Eqs. 6, 8, 12)."""
    about_z, about_y = axis_angles(direction)
    return rot_y(-about_y) @ rot_z(-about_z) @ trans(-np.asarray(origin, dtype=np.float64))


def turned(T_fixed_bolt: Floats, T_frame_fixed: Floats, angle: float) -> Floats:
    """The pose after a turn about the x axis of a frame (Eq. 10 for C0, Eq. 15 for P0)."""
    return inverse(T_frame_fixed) @ rot_x(angle) @ T_frame_fixed @ T_fixed_bolt
