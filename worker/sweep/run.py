"""Computing the libraries of a sweep one after the other, or submitting them as jobs."""

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
    """The outcome for a library."""

    PUBLISHED = "published"
    """It was computed."""
    THERE = "there"
    """It was published before."""
    QUEUED = "queued"
    """It is a job."""
    FAILED = "failed"


@dataclass(frozen=True)
class SweepResult:
    """The result for one library of a sweep.

    Attributes:
        inputs: its inputs.
        outcome: the outcome.
        library_id: its id, if it is published.
        content_sha256: hash of its content, likewise.
        job_id: id of its job, if it is queued.
        reason: why it failed, if it did.
    """

    inputs: LibraryInputs
    outcome: Outcome
    library_id: int | None = None
    content_sha256: str | None = None
    job_id: int | None = None
    reason: str | None = None


def computed_sweep(
    engine: Engine, libraries: Sequence[LibraryInputs], workers: int, scheduler: str | None
) -> Iterator[SweepResult]:
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
            yield SweepResult(
                inputs, Outcome.FAILED, reason=" ".join(str(getattr(error, "orig", None) or error).split())
            )
        else:
            yield SweepResult(inputs, Outcome.PUBLISHED, made.library_id, made.content_sha256)


def queued_sweep(engine: Engine, libraries: Sequence[LibraryInputs]) -> Iterator[SweepResult]:
    """Submit the unpublished libraries as jobs."""
    for inputs in libraries:
        there = _published(engine, inputs)
        yield there or SweepResult(inputs, Outcome.QUEUED, job_id=submit_job(engine, inputs).id)


def _published(engine: Engine, inputs: LibraryInputs) -> SweepResult | None:
    with engine.connect() as connection:
        record = library_by_input(connection, inputs.sha256)
    return None if record is None else SweepResult(inputs, Outcome.THERE, record.id, record.content_sha256)
