"""Computing a library: committed chunks stay, missing ones are computed, the complete library is published."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from sqlalchemy import Engine

from threadstate.library.engine import writing
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import LibraryRecord, library_by_input
from threadstate.library.schema import check_schema, stored_revision
from threadstate.library.write import committed_orientations, open_library, publish
from threadstate.mesh.options import MeshOptions
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair
from worker.chunk_source import chunk_source
from worker.commit import commit_chunk
from worker.forkserver import running_forkserver
from worker.migrate import migrate
from worker.progress import progress_bar


@dataclass(frozen=True)
class RebuildResult:
    """The result of a rebuild.

    Attributes:
        library_id: the library's id.
        input_sha256: hash of its inputs.
        content_sha256: hash of its content.
        state_count: number of states.
        undecided_count: number of poses that its solver method could not decide.
        computed: number of poses that this run computed.
        was_published: whether it was published before, so that nothing was computed.
    """

    library_id: int
    input_sha256: str
    content_sha256: str
    state_count: int
    undecided_count: int
    computed: int
    was_published: bool


class Progress(Protocol):
    """An observer of a rebuild; counts are of poses."""

    def begin(self, committed: int, total: int) -> None:
        """The library is open; an earlier run has committed ``committed`` of ``total`` poses."""

    def ready(self) -> None:
        """The kernels are loaded and the computation begins."""

    def advance(self, poses: int) -> None:
        """``poses`` more poses are committed."""


def rebuild(
    engine: Engine, inputs: LibraryInputs, workers: int, progress: Progress, scheduler: str | None = None
) -> RebuildResult:
    """Compute the missing chunks of a library and publish it.

    May be killed at any moment: each chunk is committed in one transaction, and the library is published only when all
    are. The content depends on the inputs alone, not on earlier runs or on who computes: ``workers`` processes, or the
    workers of the Dask cluster at ``scheduler``. This process alone writes, each chunk when it arrives.

    Raises:
        ComputeError: a computing process failed.
        ClusterError: the cluster cannot be used, or becomes unreachable.
    """
    known = _published(engine, inputs)
    if known is not None:
        return _result(known, 0, was_published=True)

    grid = inputs.grid
    library_id = open_library(engine, inputs)
    committed = committed_orientations(engine, library_id)
    missing = [index for index in range(grid.orientation_count) if index not in committed]
    progress.begin(len(committed) * grid.phase_count, grid.pose_count)
    computed = 0
    if missing:
        with chunk_source(inputs, min(workers, len(missing)), scheduler) as computing:
            for chunk in computing.chunks(missing, progress.ready):
                if commit_chunk(engine, library_id, chunk):
                    computed += grid.phase_count
                progress.advance(grid.phase_count)
    publish(engine, library_id, grid)
    made = _published(engine, inputs)
    assert made is not None
    return _result(made, computed, was_published=False)


def _published(engine: Engine, inputs: LibraryInputs) -> LibraryRecord | None:
    with engine.connect() as connection:
        return library_by_input(connection, inputs.sha256)


def _result(library: LibraryRecord, computed: int, *, was_published: bool) -> RebuildResult:
    return RebuildResult(
        library.id,
        library.input_sha256,
        library.content_sha256,
        library.state_count,
        library.undecided_count,
        computed,
        was_published,
    )


def rebuild_library(
    database: str,
    *,
    pair: Pair,
    phase_step_deg: float,
    tilt_max_deg: float,
    tilt_step_deg: float,
    workers: int,
    scheduler: str | None = None,
    mesh: MeshOptions | None = None,
) -> RebuildResult:
    """Compute and publish the library of a pair and a grid with a progress bar; an empty database is migrated first.

    By the exact method, or with ``mesh`` by meshes.

    Raises:
        InvalidValueError: a value is not valid.
        SchemaError: the database is at another revision.
        ComputeError: a computing process failed.
        ClusterError: the cluster cannot be used, or becomes unreachable.
    """
    inputs = LibraryInputs(pair, Grid(tilt_max_deg, tilt_step_deg, phase_step_deg), SolveOptions(), mesh)
    with writing(database) as engine:
        if stored_revision(engine) is None:
            if scheduler is None:
                running_forkserver()  # loads the kernels during the migration
            migrate(engine)
        check_schema(engine)
        with progress_bar() as progress:
            return rebuild(engine, inputs, workers, progress, scheduler)
