"""Computing a success map: orientations that a file has stay, missing ones are computed and appended."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path

from threadstate.success.document import map_sha256
from threadstate.success.inputs import SuccessInputs
from threadstate.success.map_file import growing_map
from threadstate.success.model import OrientationMap
from worker.processes import running_processes
from worker.progress import progress_bar
from worker.rebuild import Progress


@dataclass(frozen=True)
class SuccessResult:
    """A map: its orientations in the order of the grid, its content hash, how many of them this run computed."""

    orientations: tuple[OrientationMap, ...]
    content_sha256: str
    computed: int


def computed_map(inputs: SuccessInputs, workers: int, path: Path | None, progress: Progress) -> SuccessResult:
    """The map of these inputs; with a file what is missing there is computed and appended.

    May be killed at any moment: a file loses the orientations in progress. The content depends on the inputs alone,
    neither on earlier runs nor on how many processes compute.

    Raises:
        InvalidValueError: the file is not of this map, or cannot be written.
        ComputeError: a computing process failed.
    """
    grid = inputs.grid
    with _growing(path, inputs) as (known, append):
        found = {one.index: one for one in known}
        missing = [index for index in range(grid.orientation_count) if index not in found]
        progress.begin(len(found) * grid.phase_count, grid.pose_count)
        if missing:
            with running_processes(partial(_serve, inputs), OrientationMap, min(workers, len(missing))) as processes:
                for one in processes.chunks(missing, progress.ready):
                    append(one)
                    found[one.index] = one
                    progress.advance(grid.phase_count)
    orientations = tuple(found[index] for index in range(grid.orientation_count))
    return SuccessResult(orientations, map_sha256(orientations), len(missing))


def computed_map_with_progress(inputs: SuccessInputs, workers: int, path: Path | None) -> SuccessResult:
    """As :func:`computed_map`, with a progress bar."""
    with progress_bar() as progress:
        return computed_map(inputs, workers, path, progress)


@contextmanager
def _growing(
    path: Path | None, inputs: SuccessInputs
) -> Iterator[tuple[list[OrientationMap], Callable[[OrientationMap], None]]]:
    if path is None:
        yield [], lambda _: None
        return
    with growing_map(path, inputs) as (known, append):
        yield known, append


def _serve(inputs: SuccessInputs, connection: Connection) -> None:
    # Imported in the computing process alone: the writing one does not need numba, which is slow to load.
    from worker.success.compute import serve_success

    serve_success(connection, inputs)
