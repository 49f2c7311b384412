"""Computing a library of settled states: committed chunks stay, missing ones are computed, the whole is published."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection

from sqlalchemy import Engine

from threadstate.library.engine import writing
from threadstate.settled.inputs import SettledInputs
from threadstate.settled.read import (
    SettledCounts,
    SettledLibrary,
    settled_counts,
    settled_library_by_input,
)
from threadstate.settled.rows import SettledRows
from threadstate.settled.write import committed_settled, open_settled, publish_settled, write_settled
from worker.migrate import migrate_empty
from worker.processes import running_processes
from worker.progress import progress_bar
from worker.rebuild import Progress


@dataclass(frozen=True)
class SettledResult:
    """The result of a rebuild.

    Attributes:
        library: the library.
        counts: how many of its states have each outcome and flag.
        computed: number of poses that this run computed.
        was_published: whether it was published before, so that nothing was computed.
    """

    library: SettledLibrary
    counts: SettledCounts
    computed: int
    was_published: bool


def rebuild_settled(engine: Engine, inputs: SettledInputs, workers: int, progress: Progress) -> SettledResult:
    """Compute the missing chunks of a library of settled states and publish it.

    May be killed at any moment: each chunk is committed in one transaction, and the library is published only when all
    are. The content depends on the inputs alone, neither on earlier runs nor on how many processes compute. This
    process alone writes.

    Raises:
        ComputeError: a computing process failed.
    """
    known = _published(engine, inputs, 0, was_published=True)
    if known is not None:
        return known
    grid = inputs.grid
    library_id = open_settled(engine, inputs)
    committed = committed_settled(engine, library_id)
    missing = [index for index in range(grid.orientation_count) if index not in committed]
    progress.begin(len(committed) * grid.phase_count, grid.pose_count)
    computed = 0
    if missing:
        with running_processes(partial(_settle, inputs), SettledRows, min(workers, len(missing))) as processes:
            for rows in processes.chunks(missing, progress.ready):
                if write_settled(engine, library_id, rows):
                    computed += len(rows.states)
                progress.advance(len(rows.states))
    publish_settled(engine, library_id, grid)
    made = _published(engine, inputs, computed, was_published=False)
    assert made is not None
    return made


def rebuild_settled_library(database: str, inputs: SettledInputs, workers: int) -> SettledResult:
    """As :func:`rebuild_settled`, with a progress bar; an empty database is migrated first.

    Raises:
        SchemaError: the database is at another revision.
        ComputeError: a computing process failed.
    """
    with writing(database) as engine:
        migrate_empty(engine)
        with progress_bar() as progress:
            return rebuild_settled(engine, inputs, workers, progress)


def _settle(inputs: SettledInputs, connection: Connection) -> None:
    # Imported in the computing process alone: the writing one does not need numba, which is slow to load.
    from worker.settled.compute import serve_settled

    serve_settled(connection, inputs)


def _published(engine: Engine, inputs: SettledInputs, computed: int, *, was_published: bool) -> SettledResult | None:
    with engine.connect() as connection:
        library = settled_library_by_input(connection, inputs.sha256)
        if library is None:
            return None
        return SettledResult(library, settled_counts(connection, library.id), computed, was_published)
