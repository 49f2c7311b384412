"""What a job is to those who ask for it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from threadstate.errors import ThreadstateError
from threadstate.jobs.names import EventKind, JobState
from threadstate.library.identity import LibraryInputs


class JobEndedError(ThreadstateError):
    """A job that is done or failed was to be cancelled."""


@dataclass(frozen=True)
class JobRecord:
    """A job: the library that is to be there, and how far it is.

    Attributes:
        id: number of the job.
        state: how far it is.
        reason: why it failed; None where it did not.
        inputs: what the library is to be computed from.
        input_sha256: hash of these, by the code that was asked.
        code_version: version of that code; workers of another do not take the job.
        chunk_count: how many orientations there are.
        done_count: how many of them are committed, as far as this job knows.
        lease_count: how many of them workers are at.
        library_id: the published library of these inputs, if there is one.
        event_count: number of the latest event.
        asked_at: when it was asked for, the last time.
        ended_at: when it ended; None while it has not.
    """

    id: int
    state: JobState
    reason: str | None
    inputs: LibraryInputs
    input_sha256: str
    code_version: str
    chunk_count: int
    done_count: int
    lease_count: int
    library_id: int | None
    event_count: int
    asked_at: datetime
    ended_at: datetime | None


@dataclass(frozen=True)
class JobEvent:
    """Something that happened to a job; ``number`` counts from 1, ``done_count`` chunks were committed then."""

    number: int
    kind: EventKind
    at: datetime
    done_count: int
    reason: str | None
