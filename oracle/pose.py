"""Rotations of the method's section 2, written out once more."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def pose_rotation(roll_deg: float, pitch_deg: float, phase_deg: float) -> Floats:
    """``Rz(phase) Ry(pitch) Rx(roll)``, shape (3, 3): bolt to nut."""
    a, b, c = (math.radians(v) for v in (roll_deg, pitch_deg, phase_deg))
    rx = np.array([[1.0, 0.0, 0.0], [0.0, math.cos(a), -math.sin(a)], [0.0, math.sin(a), math.cos(a)]])
    ry = np.array([[math.cos(b), 0.0, math.sin(b)], [0.0, 1.0, 0.0], [-math.sin(b), 0.0, math.cos(b)]])
    rz = np.array([[math.cos(c), -math.sin(c), 0.0], [math.sin(c), math.cos(c), 0.0], [0.0, 0.0, 1.0]])
    return rz @ ry @ rx


def turn_about(direction: Floats, angle_deg: float) -> Floats:
    """The rotation by ``angle_deg`` (right-handed) about ``direction`` through the origin, shape (3, 3)."""
    x, y, z = direction / np.linalg.norm(direction)
    a = math.radians(angle_deg)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + math.sin(a) * cross + (1.0 - math.cos(a)) * cross @ cross)
