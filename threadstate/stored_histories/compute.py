"""All that is stored of an orientation, computed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from threadstate.errors import UnresolvedPoseError
from threadstate.history.build import histories_of
from threadstate.history.descents import falls_of
from threadstate.history.height_curve import height_curve
from threadstate.history.records import RecordStore
from threadstate.history.window import windows_of
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import ChunkRows, HistoryRows, chunk_rows
from threadstate.mesh.options import MeshOptions
from threadstate.state.decode import decoded_answers
from threadstate.state.model import Answer, UndecidedPose
from threadstate.state.options import SolveOptions
from threadstate.state.solve import checked_poses
from threadstate.statics.rows import statics_by_ordinal
from threadstate.stored_histories.rows import history_rows
from threadstate.thread.pair import Pair

PoseDeg = tuple[float, float, float]


def exact_answers(
    pair: Pair, options: SolveOptions, poses: Sequence[PoseDeg], store: RecordStore | None = None
) -> list[Answer]:
    """The answers for poses (degrees) by the exact method; their records are added to ``store``."""
    checked = checked_poses(np.array(poses))
    return decoded_answers(pair, options, checked, (store or RecordStore(pair, options)).records(checked))


def mesh_answers(pair: Pair, options: SolveOptions, mesh: MeshOptions, poses: Sequence[PoseDeg]) -> list[Answer]:
    """The answers for poses (degrees) by the mesh method."""
    # Imported late: the collision library takes a while to load.
    from threadstate.mesh.solve import solve_poses_by_mesh

    def answer(pose: PoseDeg) -> Answer:
        try:
            return solve_poses_by_mesh(pair, [pose], mesh, options)[0]
        except UnresolvedPoseError as error:
            return UndecidedPose(*pose, error.reason)

    return [answer(pose) for pose in poses]


def computed_rows(inputs: LibraryInputs, index: int) -> tuple[ChunkRows, HistoryRows | None]:
    """The answers for all poses of an orientation and, by the exact method, its history, as rows.

    What this imports decides which library is which: see ``threadstate.library.identity``.
    """
    grid, pair = inputs.grid, inputs.pair
    orientation, poses = grid.orientation(index), grid.poses(index)
    first = grid.first_ordinal(index)
    if inputs.mesh is not None:
        answers = mesh_answers(pair, inputs.options, inputs.mesh, poses)
        return chunk_rows(orientation, first, answers, statics_by_ordinal(pair, first, answers)), None
    store = RecordStore(pair, inputs.options)
    answers = exact_answers(pair, inputs.options, poses, store)
    tilt = (orientation.roll_deg, orientation.pitch_deg)
    (history,) = histories_of(pair, [tilt], inputs.options, store=store)
    falls = falls_of(height_curve(pair, *tilt, inputs.options, store), pair.thread_pitch)
    statics = statics_by_ordinal(pair, first, answers, store.records(np.array(poses)))
    rows = chunk_rows(orientation, first, answers, statics)
    return rows, history_rows(history, windows_of(pair, history), falls)
