"""Computing a library of settled states: committed chunks stay, missing ones are computed, the whole is published."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import Engine

from threadstate.library.engine import writing
from threadstate.settled.inputs import SettledInputs
from threadstate.settled.read import (
    SettledCounts,
    SettledLibrary,
    settled_counts,
    settled_library_by_input,
)
from threadstate.settled.write import committed_settled, open_settled, publish_settled
from worker.chunk_source import chunk_source
from worker.commit import commit_chunk
from worker.migrate import migrate_empty
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


def rebuild_settled(
    engine: Engine, inputs: SettledInputs, workers: int, progress: Progress, scheduler: str | None = None
) -> SettledResult:
    """Compute the missing chunks of a library of settled states and publish it.

    May be killed at any moment: each chunk is committed in one transaction, and the library is published only when all
    are. The content depends on the inputs alone, not on earlier runs or on who computes: ``workers`` processes, or the
    workers of the Dask cluster at ``scheduler``. This process alone writes.

    Raises:
        ComputeError: a computing process failed.
        ClusterError: the cluster cannot be used, or becomes unreachable.
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
        with chunk_source(inputs, min(workers, len(missing)), scheduler) as computing:
            for chunk in computing.chunks(missing, progress.ready):
                if commit_chunk(engine, library_id, chunk):
                    computed += grid.phase_count
                progress.advance(grid.phase_count)
    publish_settled(engine, library_id, grid)
    made = _published(engine, inputs, computed, was_published=False)
    assert made is not None
    return made


def rebuild_settled_library(
    database: str, inputs: SettledInputs, workers: int, scheduler: str | None = None
) -> SettledResult:
    """As :func:`rebuild_settled`, with a progress bar; an empty database is migrated first.

    Raises:
        SchemaError: the database is at another revision.
        ComputeError: a computing process failed.
        ClusterError: the cluster cannot be used, or becomes unreachable.
    """
    with writing(database) as engine:
        migrate_empty(engine)
        with progress_bar() as progress:
            return rebuild_settled(engine, inputs, workers, progress, scheduler)


def _published(engine: Engine, inputs: SettledInputs, computed: int, *, was_published: bool) -> SettledResult | None:
    with engine.connect() as connection:
        library = settled_library_by_input(connection, inputs.sha256)
        if library is None:
            return None
        return SettledResult(library, settled_counts(connection, library.id), computed, was_published)
