"""Jobs: requested libraries."""

from __future__ import annotations

from datetime import datetime

from threadstate.client.models.answer import Answer
from threadstate.client.models.libraries import GridDocument
from threadstate.jobs.names import EventKind, JobState
from threadstate.library.solver_method import SolverMethod


class JobDocument(Answer):
    """A job: ``committed`` of its ``chunks`` (orientations) are computed, workers are computing ``at_work`` others.

    ``reason`` says why it failed, ``library`` is the number of the library once that is published.
    """

    id: int
    state: JobState
    reason: str | None
    designation: str
    method: SolverMethod
    grid: GridDocument
    options: dict[str, float | str | bool]
    input_sha256: str
    code_version: str
    chunks: int
    committed: int
    at_work: int
    library: int | None
    asked_at: datetime
    ended_at: datetime | None


class JobPage(Answer):
    """One page of jobs, the latest first."""

    jobs: tuple[JobDocument, ...]
    next: str | None

    @property
    def items(self) -> tuple[JobDocument, ...]:
        """The jobs."""
        return self.jobs


class EventDocument(Answer):
    """An event of a job, at which ``committed`` of its ``chunks`` were computed."""

    job: int
    kind: EventKind
    at: datetime
    committed: int
    chunks: int
    reason: str | None
