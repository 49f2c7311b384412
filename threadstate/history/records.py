"""The kernels' records of poses, which say that a pose is undecided instead of raising an error."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.contact import _solve_kernel as sk
from threadstate.contact.level import solve_level
from threadstate.state.solve import LEVEL_TILT_DEG, SolveOptions, _packed
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def records_of(pair: Pair, options: SolveOptions, poses_deg: Floats) -> Floats:
    """Records of shape (n, RECORD_SIZE) of valid poses of shape (n, 3): roll, pitch, phase in degrees.

    The same pose gives the same bits whatever the others are, those of ``threadstate.state.solve.solve_poses``.
    """
    records = np.empty((len(poses_deg), rk.RECORD_SIZE))
    level = (np.abs(poses_deg[:, 0]) < LEVEL_TILT_DEG) & (np.abs(poses_deg[:, 1]) < LEVEL_TILT_DEG)
    if not level.any():
        sk.solve_rows(poses_deg * (math.pi / 180.0), _packed(pair, options), pair.bolt.row, pair.nut.row, records)
        return records
    if not level.all():
        records[~level] = records_of(pair, options, poses_deg[~level])
    for i in np.flatnonzero(level):
        solve_level(pair, math.radians(poses_deg[i, 2]), records[i])
    return records
