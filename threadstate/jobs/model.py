"""What a job is: its record, its events, and its inputs as JSON."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from functools import cache

from pydantic import TypeAdapter

from threadstate.errors import ThreadstateError
from threadstate.jobs.names import EventKind, JobKind, JobState
from threadstate.library.identity import EXACT_CODE, MESH_CODE, LibraryInputs, version_of_code
from threadstate.settled.inputs import SETTLED_CODE, SettledInputs
from threadstate.success.inputs import SUCCESS_CODE, SuccessInputs

JobInputs = LibraryInputs | SettledInputs | SuccessInputs
"""What a job is computed from; its type says what kind of job it is."""

_INPUTS: dict[JobKind, type[JobInputs]] = {
    JobKind.LIBRARY: LibraryInputs,
    JobKind.SETTLED: SettledInputs,
    JobKind.SUCCESS: SuccessInputs,
}


class JobEndedError(ThreadstateError):
    """A job cannot be cancelled: it is done or has failed."""


@dataclass(frozen=True)
class JobRecord:
    """A job: what was requested, and its progress.

    Attributes:
        id: number of the job.
        state: state of the job.
        reason: why it failed; None if it has not failed.
        inputs: what it is computed from.
        input_sha256: hash of the inputs, computed by the code that accepted the job.
        code_version: version of that code; workers of other versions do not take the job.
        chunk_count: number of orientations.
        done_count: number of committed orientations that the job has counted.
        lease_count: number of orientations leased to workers.
        published_id: id of the published library or map of these inputs; None if there is none.
        event_count: number of the latest event.
        asked_at: time of the latest request for it.
        ended_at: time of its end; None before.
    """

    id: int
    state: JobState
    reason: str | None
    inputs: JobInputs
    input_sha256: str
    code_version: str
    chunk_count: int
    done_count: int
    lease_count: int
    published_id: int | None
    event_count: int
    asked_at: datetime
    ended_at: datetime | None

    @property
    def kind(self) -> JobKind:
        """What it computes."""
        return kind_of(self.inputs)


@dataclass(frozen=True)
class JobEvent:
    """An event of a job; ``number`` counts from 1, ``done_count`` is the number of committed chunks at the time."""

    number: int
    kind: EventKind
    at: datetime
    done_count: int
    reason: str | None


def kind_of(inputs: JobInputs) -> JobKind:
    """What is computed from these inputs."""
    return next(kind for kind, of_kind in _INPUTS.items() if isinstance(inputs, of_kind))


def code_versions() -> frozenset[str]:
    """The versions of the jobs that this code computes: of each kind, and of libraries for each solver method."""
    return frozenset(version_of_code(*code) for code in (EXACT_CODE, MESH_CODE, SETTLED_CODE, SUCCESS_CODE))


def inputs_json(inputs: JobInputs) -> str:
    """The inputs as JSON; every double is written so that it reads back the same.

    A chamfer is not named: none of the kinds is computed of a bolt that has one.
    """
    return _adapter(kind_of(inputs)).dump_json(inputs, exclude={"pair": {"chamfer"}}).decode()


def inputs_from_json(kind: JobKind, content: str) -> JobInputs:
    """The inputs stored with a job of a kind."""
    return _adapter(kind).validate_json(content)


@cache
def _adapter(kind: JobKind) -> TypeAdapter[JobInputs]:
    return TypeAdapter(_INPUTS[kind])
