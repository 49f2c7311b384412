"""Estimates of the rows, bytes and time of a sweep, from a few chunks that are computed first."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass

from sqlalchemy import Engine, select

from threadstate.library.address import is_sqlite
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import ChunkRows, chunk_rows
from threadstate.library.tables import chunk, library
from threadstate.stored_histories.compute import mesh_answers
from threadstate.warm_up import load_kernels_exclusively
from worker.compute import compute_library_chunk
from worker.messages import LibraryChunk

SQLITE_BYTES_A_ROW, POSTGRESQL_BYTES_A_ROW = 150, 295
"""Table and indexes, of a full library (docs/scale.md)."""
SQLITE_S_A_ROW, POSTGRESQL_S_A_ROW = 7e-6, 6e-5
"""Processor time of committing, the server's too (docs/scale.md)."""
MESH_POSES = 2
"""How many poses are solved by meshes: one takes up to ten seconds."""


@dataclass(frozen=True)
class Estimate:
    """The estimate of one library.

    Attributes:
        inputs: its inputs.
        published: whether it is published.
        committed: number of its committed orientations.
        row_count: number of rows in all tables.
        bytes: their size in the database, with indexes.
        seconds: time until it is published; 0 if it is.
    """

    inputs: LibraryInputs
    published: bool
    committed: int
    row_count: int
    bytes: int
    seconds: float


@dataclass(frozen=True)
class _Sample:
    """Means of an orientation."""

    rows: float
    seconds: float


def estimates(
    engine: Engine, libraries: Sequence[LibraryInputs], parallelism: int, *, is_empty: bool
) -> list[Estimate]:
    """The estimates of libraries for a number of processes, or threads of a cluster.

    Orientations of one library of each method and step of phase are computed first, in this process.

    Args:
        engine: the database to write to.
        libraries: their inputs.
        parallelism: number of processes or threads that compute.
        is_empty: whether the database has no schema yet.
    """
    load_kernels_exclusively()
    samples: dict[tuple[object, ...], _Sample] = {}
    found = []
    for inputs in libraries:
        # Level orientations are cheaper than others.
        key = (inputs.options, inputs.mesh, inputs.grid.phase_step_deg, inputs.grid.orientation_count == 1)
        if key not in samples:
            samples[key] = _sample(inputs)
        there = (False, 0) if is_empty else _committed(engine, inputs)
        found.append(_estimate(inputs, samples[key], there, engine, parallelism))
    return found


def _estimate(
    inputs: LibraryInputs, sample: _Sample, there: tuple[bool, int], engine: Engine, parallelism: int
) -> Estimate:
    published, committed = there
    orientations = inputs.grid.orientation_count
    row_count = round(sample.rows * orientations)
    if is_sqlite(engine.url):
        bytes_a_row, a_row_s = SQLITE_BYTES_A_ROW, SQLITE_S_A_ROW
    else:
        bytes_a_row, a_row_s = POSTGRESQL_BYTES_A_ROW, POSTGRESQL_S_A_ROW
    missing = 0 if published else orientations - committed
    an_orientation_s = max(sample.seconds / min(parallelism, max(missing, 1)), sample.rows * a_row_s)
    return Estimate(inputs, published, committed, row_count, row_count * bytes_a_row, missing * an_orientation_s)


def _sample(inputs: LibraryInputs) -> _Sample:
    """Two orientations of a library, a quarter from either end of their order; by meshes a few poses."""
    count, phases = inputs.grid.orientation_count, inputs.grid.phase_count
    if inputs.mesh is not None:
        poses = inputs.grid.poses(count // 4)[:: max(1, phases // MESH_POSES)][:MESH_POSES]
        began = time.process_time()
        answers = mesh_answers(inputs.pair, inputs.options, inputs.mesh, poses)
        a_pose_s = (time.process_time() - began) / len(poses)
        rows = chunk_rows(inputs.grid.orientation(count // 4), 0, answers)
        return _Sample(_row_count(rows) / len(poses) * phases, a_pose_s * phases)
    indices = sorted({count // 4, 3 * count // 4})
    began = time.process_time()
    chunks = [compute_library_chunk(inputs, index) for index in indices]
    seconds = time.process_time() - began
    return _Sample(sum(_rows_of(one) for one in chunks) / len(chunks), seconds / len(chunks))


def _rows_of(one: LibraryChunk) -> int:
    history = 0 if one.history is None else sum(len(rows) for _, rows in one.history.of_orientation())
    return _row_count(one.rows) + history


def _row_count(rows: ChunkRows) -> int:
    return sum(map(len, (rows.states, rows.stage_poses, rows.contacts, rows.flags, rows.undecided)))


def _committed(engine: Engine, inputs: LibraryInputs) -> tuple[bool, int]:
    """Whether a library is published, and how many of its orientations are committed."""
    with engine.connect() as connection:
        row = connection.execute(
            select(library.c.id, library.c.published_at).where(library.c.input_sha256 == inputs.sha256)
        ).first()
        if row is None:
            return False, 0
        chunks = connection.scalars(select(chunk.c.orientation).where(chunk.c.library_id == row.id)).all()
        return row.published_at is not None, len(chunks)
