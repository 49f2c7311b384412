"""Computing samples: those that a file has stay, missing ones are computed and appended."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from threadstate.chances.document import records_sha256
from threadstate.chances.inputs import ChancesInputs
from threadstate.chances.model import Record
from threadstate.chances.record_file import growing_records
from worker.chunk_source import chunk_source
from worker.progress import progress_bar
from worker.rebuild import Progress


@dataclass(frozen=True)
class ChancesResult:
    """The samples by their numbers, their content hash, how many of them this run computed."""

    records: tuple[Record, ...]
    content_sha256: str
    computed: int


def computed_records(
    inputs: ChancesInputs,
    samples: int,
    workers: int,
    path: Path | None,
    progress: Progress,
    scheduler: str | None = None,
) -> ChancesResult:
    """The first ``samples`` samples; with a file what is missing there is computed and appended.

    May be killed at any moment: a file loses the samples in progress. The content depends on the inputs and the number
    of samples alone, not on earlier runs or on who computes: ``workers`` processes, or the workers of the Dask cluster
    at ``scheduler``.

    Raises:
        InvalidValueError: the file is not of these samples, or cannot be written.
        ComputeError: a computing process failed.
        ClusterError: the cluster cannot be used, or becomes unreachable.
    """
    with _growing(path, inputs) as (known, append):
        found = {one.approach.index: one for one in known if one.approach.index < samples}
        missing = [index for index in range(samples) if index not in found]
        progress.begin(len(found), samples)
        if missing:
            with chunk_source(inputs, min(workers, len(missing)), scheduler) as computing:
                for one in computing.chunks(missing, progress.ready):
                    assert isinstance(one, Record)
                    append(one)
                    found[one.approach.index] = one
                    progress.advance(1)
    records = tuple(found[index] for index in range(samples))
    return ChancesResult(records, records_sha256(records), len(missing))


def computed_records_with_progress(
    inputs: ChancesInputs, samples: int, workers: int, path: Path | None, scheduler: str | None = None
) -> ChancesResult:
    """As :func:`computed_records`, with a progress bar."""
    with progress_bar() as progress:
        return computed_records(inputs, samples, workers, path, progress, scheduler)


@contextmanager
def _growing(path: Path | None, inputs: ChancesInputs) -> Iterator[tuple[list[Record], Callable[[Record], None]]]:
    if path is None:
        yield [], lambda _: None
        return
    with growing_records(path, inputs) as (known, append):
        yield known, append
