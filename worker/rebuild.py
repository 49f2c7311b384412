"""Computing a library: what is committed stays, what is missing is computed, the whole is published."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from sqlalchemy import Engine

from threadstate.library.identity import LibraryInputs
from threadstate.library.read import LibraryRecord, library_by_input
from threadstate.library.write import committed_orientations, open_library, publish, write_chunk
from worker.computers import computers


@dataclass(frozen=True)
class Rebuild:
    """What a rebuild came to.

    Attributes:
        library_id: the library's id.
        input_sha256: hash of its inputs.
        content_sha256: hash of its content.
        state_count: how many states it has.
        undecided_count: how many poses its method could not decide.
        computed: for how many poses this run computed the answer.
        was_published: whether it was published already, so that nothing was to be done.
    """

    library_id: int
    input_sha256: str
    content_sha256: str
    state_count: int
    undecided_count: int
    computed: int
    was_published: bool


class Progress(Protocol):
    """Somebody who watches a rebuild; counts are of poses."""

    def begin(self, committed: int, total: int) -> None:
        """The library is open; ``committed`` of ``total`` poses are there from an earlier run."""

    def ready(self) -> None:
        """The kernels are loaded, poses are being computed."""

    def advance(self, poses: int) -> None:
        """That many more poses are committed."""


def rebuild(
    engine: Engine, inputs: LibraryInputs, workers: int, progress: Progress, scheduler: str | None = None
) -> Rebuild:
    """Compute and publish the library of these inputs, going on from the chunks that are committed.

    May be killed at any moment: a chunk is committed whole or not at all, and the library is published only when all
    are. The content depends on the inputs alone, not on earlier runs or on who computes: ``workers`` processes, or the
    workers of the Dask cluster at ``scheduler``. Either way this process alone writes, each chunk when it is there.

    Raises:
        ComputeError: a computing process failed.
        ClusterError: the cluster cannot be used, or not any more.
    """
    known = _published(engine, inputs)
    if known is not None:
        return _rebuild(known, 0, was_published=True)

    grid = inputs.grid
    library_id = open_library(engine, inputs)
    committed = committed_orientations(engine, library_id)
    missing = [index for index in range(grid.orientation_count) if index not in committed]
    progress.begin(len(committed) * grid.phase_count, grid.pose_count)
    computed = 0
    if missing:
        with computers(inputs, min(workers, len(missing)), scheduler) as computing:
            for chunk in computing.chunks(missing, progress.ready):
                if write_chunk(engine, library_id, chunk.rows, chunk.history):
                    computed += chunk.rows.pose_count
                progress.advance(chunk.rows.pose_count)
    publish(engine, library_id, grid)
    made = _published(engine, inputs)
    assert made is not None
    return _rebuild(made, computed, was_published=False)


def _published(engine: Engine, inputs: LibraryInputs) -> LibraryRecord | None:
    with engine.connect() as connection:
        return library_by_input(connection, inputs.sha256)


def _rebuild(library: LibraryRecord, computed: int, *, was_published: bool) -> Rebuild:
    return Rebuild(
        library.id,
        library.input_sha256,
        library.content_sha256,
        library.state_count,
        library.undecided_count,
        computed,
        was_published,
    )
