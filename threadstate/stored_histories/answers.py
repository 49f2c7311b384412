"""What the method of a library says of poses."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from threadstate.errors import UnresolvedPoseError
from threadstate.history.records import RecordStore
from threadstate.mesh.options import MeshOptions
from threadstate.state.decode import decoded_answers
from threadstate.state.model import Answer, UndecidedPose
from threadstate.state.options import SolveOptions
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair

PoseDeg = tuple[float, float, float]


def exact_answers(
    pair: Pair, options: SolveOptions, poses: Sequence[PoseDeg], store: RecordStore | None = None
) -> list[Answer]:
    """The state of each pose (degrees), or that the exact method cannot decide it; records go into the ``store``."""
    wanted = checked_poses(np.array(poses))
    return decoded_answers(pair, options, wanted, (store or RecordStore(pair, options)).records(wanted))


def mesh_answers(pair: Pair, options: SolveOptions, mesh: MeshOptions, poses: Sequence[PoseDeg]) -> list[Answer]:
    """The state of each pose (degrees) by meshes, or why these cannot decide it."""
    # The collision library takes a while to load, and the exact method needs none.
    from threadstate.mesh.solve import solve_poses_by_mesh

    def answer(pose: PoseDeg) -> Answer:
        try:
            return solve_poses_by_mesh(pair, [pose], mesh, options)[0]
        except UnresolvedPoseError as error:
            return UndecidedPose(*pose, error.reason)

    return [answer(pose) for pose in poses]
