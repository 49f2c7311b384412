"""Computing orientations of grids of several steps, and committing them."""

from __future__ import annotations

import pickle
import random
import time
from collections.abc import Sequence

from sqlalchemy import Engine

from benchmarks.scale.figures import Committed, Computed
from benchmarks.scale.processor import Stopwatch
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.write import open_library, write_chunk
from threadstate.state.options import SolveOptions
from threadstate.stored_histories.compute import exact_answers
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.compute import compute_library_chunk
from worker.messages import LibraryChunk

SEED = 20060128
GRIDS = (Grid(4.0, 1.0, 1.0), Grid(4.0, 1.0, 0.5), Grid(4.0, 0.1, 0.1))
"""The library's, one of twice the phases, and the plan's."""
ORIENTATIONS = 8


def inputs_on(grid: Grid) -> LibraryInputs:
    """1/4-20 UNC over a grid."""
    return LibraryInputs(quarter_twenty_unc(), grid, SolveOptions())


def computed(grid: Grid) -> tuple[Computed, list[LibraryChunk]]:
    """Random orientations of a grid, and what they took."""
    inputs = inputs_on(grid)
    indices = random.Random(SEED).sample(range(grid.orientation_count), ORIENTATIONS)
    began = time.process_time()
    for index in indices:
        exact_answers(inputs.pair, inputs.options, grid.poses(index))
    answered = time.process_time()
    chunks = [compute_library_chunk(inputs, index) for index in indices]
    whole_s = time.process_time() - answered
    histories = [chunk.history for chunk in chunks if chunk.history is not None]
    count = len(chunks)
    return Computed(
        grid.tilt_step_deg,
        grid.phase_step_deg,
        count,
        grid.phase_count,
        answers_s=(answered - began) / count,
        history_s=(whole_s - (answered - began)) / count,
        state_rows=sum(
            len(one.rows.states) + len(one.rows.stage_poses) + len(one.rows.contacts) + len(one.rows.flags)
            for one in chunks
        )
        / count,
        history_rows=sum(len(rows) for one in histories for _, rows in one.of_orientation()) / count,
        intervals=sum(len(one.intervals) for one in histories) / count,
        pickled_bytes=sum(len(pickle.dumps(one, pickle.HIGHEST_PROTOCOL)) for one in chunks) / count,
    ), chunks


def committed(engine: Engine, database: str, grid: Grid, chunks: Sequence[LibraryChunk]) -> Committed:
    """Commit chunks to a library of their own, and what that took each."""
    library_id = open_library(engine, inputs_on(grid))
    stopwatch = Stopwatch.on(engine)
    for chunk in chunks:
        write_chunk(engine, library_id, chunk.rows, chunk.history)
    here_s, server_s = stopwatch.sides_s
    return Committed(database, grid.phase_step_deg, here_s / len(chunks), server_s / len(chunks))
