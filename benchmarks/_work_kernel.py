"""The contacts of poses followed where they are known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import kernel
from threadstate.contact._guess_kernel import GUESS_SIZE, GUESSES, clear_guesses, new_work, set_guesses
from threadstate.history._follow_kernel import follow_pose

Array = NDArray[np.float64]


@kernel(allocates=True)
def follow_known(poses: Array, records: Array, turn_limit: float, bolt: Array, nut: Array, followed: Array) -> None:
    """Sets into rows what Newton's method makes of the contacts in the records of poses (angles in rad)."""
    work = new_work()
    guesses = np.empty((GUESSES, GUESS_SIZE))
    clear_guesses(guesses)
    for i in range(poses.shape[0]):
        set_guesses(records[i], guesses)
        follow_pose(poses[i, 0], poses[i, 1], poses[i, 2], turn_limit, guesses, bolt, nut, work, followed[i])
