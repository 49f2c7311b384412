"""The poses that are measured: chosen once for all by a seed, half of them on a library's grid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate.library.grid import Grid

SEED = 20060116

Poses = NDArray[np.float64]


def sample_poses(count: int) -> Poses:
    """``count`` poses (roll, pitch, phase in degrees), shape (count, 3): on the grid of 29,160 and off it by turns.

    Those off the grid have roll and pitch within 4 deg and any phase. A smaller sample is the start of a larger one.
    """
    grid = Grid()
    choose_on, choose_off = (np.random.default_rng([SEED, k]) for k in range(2))
    poses = np.empty((count, 3))
    for i in range(count):
        if i % 2:
            poses[i] = choose_off.uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0])
        else:
            orientation = grid.orientation(int(choose_on.integers(grid.orientation_count)))
            phase = grid.phases_deg[int(choose_on.integers(grid.phase_count))]
            poses[i] = orientation.roll_deg, orientation.pitch_deg, phase
    return poses
