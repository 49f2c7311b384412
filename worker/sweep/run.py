"""Computing the libraries of a sweep one after the other, or asking for them as jobs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

from sqlalchemy import Engine
from sqlalchemy.exc import IntegrityError

from threadstate.errors import ThreadstateError
from threadstate.jobs.queue import submit_job
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import library_by_input
from worker.cluster.errors import ClusterError
from worker.progress import progress_bar
from worker.rebuild import rebuild


class Outcome(StrEnum):
    """What became of a library."""

    PUBLISHED = "published"
    """It was computed."""
    THERE = "there"
    """It was published before."""
    QUEUED = "queued"
    """It is a job."""
    FAILED = "failed"


@dataclass(frozen=True)
class Swept:
    """What became of one library.

    Attributes:
        inputs: its inputs.
        outcome: whether it is there.
        library_id: its number, where it is published.
        content_sha256: hash of its content, likewise.
        job_id: number of its job, where it is one.
        reason: why it failed, where it did.
    """

    inputs: LibraryInputs
    outcome: Outcome
    library_id: int | None = None
    content_sha256: str | None = None
    job_id: int | None = None
    reason: str | None = None


def computed_sweep(
    engine: Engine, libraries: Sequence[LibraryInputs], workers: int, scheduler: str | None
) -> Iterator[Swept]:
    """Compute the libraries that are not published, one after the other; one that fails does not stop the others.

    Raises:
        ClusterError: the cluster cannot be used; it would fail the others too.
    """
    for inputs in libraries:
        if (there := _published(engine, inputs)) is not None:
            yield there
            continue
        try:
            with progress_bar() as progress:
                made = rebuild(engine, inputs, workers, progress, scheduler)
        except ClusterError:
            raise
        except (ThreadstateError, IntegrityError) as error:
            yield Swept(inputs, Outcome.FAILED, reason=" ".join(str(getattr(error, "orig", None) or error).split()))
        else:
            yield Swept(inputs, Outcome.PUBLISHED, made.library_id, made.content_sha256)


def queued_sweep(engine: Engine, libraries: Sequence[LibraryInputs]) -> Iterator[Swept]:
    """Ask for the libraries that are not published as jobs."""
    for inputs in libraries:
        there = _published(engine, inputs)
        yield there or Swept(inputs, Outcome.QUEUED, job_id=submit_job(engine, inputs).id)


def _published(engine: Engine, inputs: LibraryInputs) -> Swept | None:
    with engine.connect() as connection:
        record = library_by_input(connection, inputs.sha256)
    return None if record is None else Swept(inputs, Outcome.THERE, record.id, record.content_sha256)
