"""Computing a success map: orientations that a file has stay, missing ones are computed and appended."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from threadstate.success.document import map_sha256
from threadstate.success.inputs import SuccessInputs
from threadstate.success.map_file import growing_map
from threadstate.success.model import OrientationMap
from worker.chunk_source import chunk_source
from worker.progress import progress_bar
from worker.rebuild import Progress


@dataclass(frozen=True)
class SuccessResult:
    """A map: its orientations in the order of the grid, its content hash, how many of them this run computed."""

    orientations: tuple[OrientationMap, ...]
    content_sha256: str
    computed: int


def computed_map(
    inputs: SuccessInputs, workers: int, path: Path | None, progress: Progress, scheduler: str | None = None
) -> SuccessResult:
    """The map of these inputs; with a file what is missing there is computed and appended.

    May be killed at any moment: a file loses the orientations in progress. The content depends on the inputs alone,
    not on earlier runs or on who computes: ``workers`` processes, or the workers of the Dask cluster at ``scheduler``.

    Raises:
        InvalidValueError: the file is not of this map, or cannot be written.
        ComputeError: a computing process failed.
        ClusterError: the cluster cannot be used, or becomes unreachable.
    """
    grid = inputs.grid
    with _growing(path, inputs) as (known, append):
        found = {one.index: one for one in known}
        missing = [index for index in range(grid.orientation_count) if index not in found]
        progress.begin(len(found) * grid.phase_count, grid.pose_count)
        if missing:
            with chunk_source(inputs, min(workers, len(missing)), scheduler) as computing:
                for one in computing.chunks(missing, progress.ready):
                    assert isinstance(one, OrientationMap)
                    append(one)
                    found[one.index] = one
                    progress.advance(grid.phase_count)
    orientations = tuple(found[index] for index in range(grid.orientation_count))
    return SuccessResult(orientations, map_sha256(orientations), len(missing))


def computed_map_with_progress(
    inputs: SuccessInputs, workers: int, path: Path | None, scheduler: str | None = None
) -> SuccessResult:
    """As :func:`computed_map`, with a progress bar."""
    with progress_bar() as progress:
        return computed_map(inputs, workers, path, progress, scheduler)


@contextmanager
def _growing(
    path: Path | None, inputs: SuccessInputs
) -> Iterator[tuple[list[OrientationMap], Callable[[OrientationMap], None]]]:
    if path is None:
        yield [], lambda _: None
        return
    with growing_map(path, inputs) as (known, append):
        yield known, append
