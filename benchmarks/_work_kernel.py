"""The contacts of poses followed where they are known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.history._follow_kernel import (
    CANDIDATE_SIZE,
    CANDIDATES,
    F_STAGE,
    follow_pose,
    new_work,
    set_candidates,
)

Array = NDArray[np.float64]


@kernel(allocates=True)
def follow_known(poses: Array, records: Array, turn_limit: float, bolt: Array, nut: Array, followed: Array) -> None:
    """Sets into rows what Newton's method makes of the contacts in the records of poses (angles in rad)."""
    work = new_work()
    candidates = np.empty((CANDIDATES, CANDIDATE_SIZE))
    candidates[:, F_STAGE] = 0.0
    for i in range(poses.shape[0]):
        set_candidates(records[i], candidates)
        follow_pose(poses[i, 0], poses[i, 1], poses[i, 2], turn_limit, candidates, bolt, nut, work, followed[i])
