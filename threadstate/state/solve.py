"""Contact states of poses by the exact method."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.state.decode import decoded_states
from threadstate.state.model import ContactState
from threadstate.state.options import TILT_LIMIT_DEG, SolveOptions
from threadstate.state.records import solve_records
from threadstate.thread.pair import Pair

__all__ = ["SolveOptions", "solve_pose", "solve_poses"]


def solve_pose(
    pair: Pair, roll_deg: float, pitch_deg: float, phase_deg: float, options: SolveOptions | None = None
) -> ContactState:
    """The contact state of one pose, its angles in degrees; as :func:`solve_poses` of this pose alone.

    Raises:
        InvalidValueError: a value not finite, roll or pitch beyond 10 deg.
        UnresolvedPoseError: the search could not exclude all its boxes.
    """
    return solve_poses(pair, [(roll_deg, pitch_deg, phase_deg)], options)[0]


def solve_poses(pair: Pair, poses: ArrayLike, options: SolveOptions | None = None) -> list[ContactState]:
    """The contact states of poses of shape (n, 3): roll, pitch and phase in degrees, in their order.

    Lengths are in the pair's unit, frames as in the method's section 2. The same pose gives the same bits whatever
    the others are.

    Raises:
        InvalidValueError: poses not of shape (n, 3), a value not finite, roll or pitch beyond 10 deg.
        UnresolvedPoseError: the search could not exclude all its boxes.
    """
    options = options or SolveOptions()
    wanted = checked_poses(poses)
    return decoded_states(pair, options, wanted, solve_records(pair, options, wanted))


def checked_poses(poses: ArrayLike) -> NDArray[np.float64]:
    """Poses as an array of shape (n, 3), each valid; see :func:`solve_poses` for what is raised."""
    wanted = np.array(poses, dtype=np.float64, ndmin=2)
    if wanted.size == 0:
        return wanted.reshape(0, 3)
    if wanted.ndim != 2 or wanted.shape[1] != 3:
        raise InvalidValueError("poses", wanted.shape, "an array of shape (n, 3): roll, pitch, phase in deg")
    for column, name in enumerate(("roll", "pitch")):
        bad = ~(np.abs(wanted[:, column]) <= TILT_LIMIT_DEG)
        if bad.any():
            value = float(wanted[np.flatnonzero(bad)[0], column])
            raise InvalidValueError(name, value, f"{number_text(-TILT_LIMIT_DEG)} to {number_text(TILT_LIMIT_DEG)} deg")
    bad = ~np.isfinite(wanted[:, 2])
    if bad.any():
        raise InvalidValueError("phase", float(wanted[np.flatnonzero(bad)[0], 2]), "a finite angle in deg")
    return wanted
