"""All that is stored of an orientation, computed."""

from __future__ import annotations

from threadstate.history.build import histories_of
from threadstate.history.descents import falls_of
from threadstate.history.height_curve import height_curve
from threadstate.history.records import RecordStore
from threadstate.history.window import windows_of
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import ChunkRows, HistoryRows, chunk_rows
from threadstate.stored_histories.answers import exact_answers, mesh_answers
from threadstate.stored_histories.mapping import history_rows


def computed_rows(inputs: LibraryInputs, index: int) -> tuple[ChunkRows, HistoryRows | None]:
    """The answers for all poses of an orientation and, by the exact method, its history, as rows.

    What this imports decides which library is which: see ``threadstate.library.identity``.
    """
    grid, pair = inputs.grid, inputs.pair
    orientation, poses = grid.orientation(index), grid.poses(index)
    first = grid.first_ordinal(index)
    if inputs.mesh is not None:
        return chunk_rows(orientation, first, mesh_answers(pair, inputs.options, inputs.mesh, poses)), None
    store = RecordStore(pair, inputs.options)
    answers = exact_answers(pair, inputs.options, poses, store)
    tilt = (orientation.roll_deg, orientation.pitch_deg)
    (history,) = histories_of(pair, [tilt], inputs.options, store=store)
    falls = falls_of(height_curve(pair, *tilt, inputs.options, store), pair.thread_pitch)
    return chunk_rows(orientation, first, answers), history_rows(history, windows_of(pair, history), falls)
