"""Random poses, the same in every run; rows of roll, pitch, phase in degrees."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
PoseDeg = tuple[float, float, float]


def random_poses(seed: int, count: int, *, tilt_deg: float, phase_deg: float = 180.0) -> Floats:
    """Roll and pitch within +-``tilt_deg``, phase within +-``phase_deg``, all uniform."""
    rng = np.random.default_rng(seed)
    tilts = rng.uniform(-tilt_deg, tilt_deg, (count, 2))
    return np.column_stack([tilts, rng.uniform(-phase_deg, phase_deg, count)])


def around(seed: int, centres: tuple[PoseDeg, ...], each: int, *, largest_deg: float) -> Floats:
    """Poses whose phase differs from a centre's by up to ``largest_deg``, many of them by far less."""
    rng = np.random.default_rng(seed)
    poses = np.repeat(np.array(centres), each, axis=0)
    size = largest_deg * 10.0 ** rng.uniform(-6.0, 0.0, len(poses))
    poses[:, 2] += rng.choice([-1.0, 1.0], len(poses)) * size
    return poses


def as_poses(rows: Floats) -> list[PoseDeg]:
    """The rows as tuples of plain floats."""
    return [(roll, pitch, phase) for roll, pitch, phase in rows.tolist()]
