"""Jobs: requested libraries and success maps."""

from __future__ import annotations

from datetime import datetime

from threadstate.client.models.answer import Answer
from threadstate.client.models.libraries import GridDocument
from threadstate.client.models.settled import Device
from threadstate.jobs.names import EventKind, JobKind, JobState
from threadstate.library.solver_method import SolverMethod


class JobDocument(Answer):
    """A job: ``committed`` of its ``chunks`` (orientations) are computed, workers are computing ``at_work`` others.

    ``reason`` says why it failed, ``result`` is the address of what it computes once that is published, and ``library``
    its number where that is a library of contact states.
    """

    id: int
    kind: JobKind
    state: JobState
    reason: str | None
    designation: str
    method: SolverMethod | None
    device: Device | None
    grid: GridDocument
    options: dict[str, float | str | bool | list[float]]
    input_sha256: str
    code_version: str
    chunks: int
    committed: int
    at_work: int
    library: int | None
    result: str | None
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
