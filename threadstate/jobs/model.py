"""What a job is: its record, its events, and its inputs as JSON."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from functools import cache

from pydantic import TypeAdapter

from threadstate.errors import ThreadstateError
from threadstate.jobs.names import EventKind, JobState
from threadstate.library.identity import LibraryInputs


class JobEndedError(ThreadstateError):
    """A job cannot be cancelled: it is done or has failed."""


@dataclass(frozen=True)
class JobRecord:
    """A job: a requested library and its progress.

    Attributes:
        id: number of the job.
        state: state of the job.
        reason: why it failed; None if it has not failed.
        inputs: the inputs of the library.
        input_sha256: hash of the inputs, computed by the code that accepted the job.
        code_version: version of that code; workers of other versions do not take the job.
        chunk_count: number of orientations.
        done_count: number of committed orientations that the job has counted.
        lease_count: number of orientations leased to workers.
        library_id: id of the published library of these inputs; None if there is none.
        event_count: number of the latest event.
        asked_at: time of the latest request for it.
        ended_at: time of its end; None before.
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
    """An event of a job; ``number`` counts from 1, ``done_count`` is the number of committed chunks at the time."""

    number: int
    kind: EventKind
    at: datetime
    done_count: int
    reason: str | None


def inputs_json(inputs: LibraryInputs) -> str:
    """The inputs as JSON; every double is written so that it reads back the same.

    Libraries are of pairs without a chamfer, which is not named.
    """
    return _adapter().dump_json(inputs, exclude={"pair": {"chamfer"}}).decode()


def inputs_from_json(content: str) -> LibraryInputs:
    """The inputs stored with a job."""
    return _adapter().validate_json(content)


@cache
def _adapter() -> TypeAdapter[LibraryInputs]:
    return TypeAdapter(LibraryInputs)
