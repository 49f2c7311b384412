"""What the method of a library says of poses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from threadstate.errors import UnresolvedPoseError
from threadstate.library.identity import LibraryInputs
from threadstate.state.model import Answer, ContactState, UndecidedPose
from threadstate.state.solve import solve_poses

PoseDeg = tuple[float, float, float]


def answers(inputs: LibraryInputs, poses: Sequence[PoseDeg]) -> list[Answer]:
    """The state of each pose, or why the method cannot decide it; in the order of the poses (degrees)."""
    if inputs.mesh is None:
        exact = partial(solve_poses, inputs.pair, options=inputs.options)
        try:
            return [*exact(poses)]
        except UnresolvedPoseError:
            return [_answer(exact, pose) for pose in poses]
    # Its collision library takes a while to load, and the exact method needs none.
    from threadstate.mesh.solve import solve_poses_by_mesh

    by_mesh = partial(solve_poses_by_mesh, inputs.pair, mesh=inputs.mesh, options=inputs.options)
    return [_answer(by_mesh, pose) for pose in poses]


def _answer(solve: Callable[[list[PoseDeg]], list[ContactState]], pose: PoseDeg) -> Answer:
    try:
        return solve([pose])[0]
    except UnresolvedPoseError as error:
        return UndecidedPose(*pose, error.reason)
