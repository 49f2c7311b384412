"""Following a job's events over several connections, and waiting for its end."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import httpx2
from pydantic import ValidationError

from threadstate.client.call import EVENT_STREAM, Call, name_of
from threadstate.client.errors import (
    ClientError,
    JobCancelledError,
    JobFailedError,
    TimedOutError,
    UnexpectedAnswerError,
    WaitTimedOutError,
    problem_error,
)
from threadstate.client.models.assemblies import Assembly, AssemblyProgress
from threadstate.client.models.jobs import EventDocument, JobDocument
from threadstate.client.models.service import Problem
from threadstate.client.retrying import Retrying, backoff_s
from threadstate.jobs.names import JobState
from threadstate.numbers import integer, number_text

STREAM_TIMEOUT_S = 10.0
"""Read timeout of a stream; it is reopened then, as the connection may be dead."""


class StreamPosition:
    """The position in a job's event stream: the last event received, and the failures since.

    ``after`` is the number of the last event that is already known.
    """

    def __init__(self, after: int, retrying: Retrying) -> None:
        self._last = after
        self._retrying = retrying
        self._failed = 0

    @property
    def headers(self) -> dict[str, str]:
        """The header that resumes the stream."""
        return {"Last-Event-ID": str(self._last)} if self._last else {}

    def received(self, event: httpx2.ServerSentEvent) -> EventDocument:
        """Parse an event; the next connection resumes after it.

        Raises:
            UnexpectedAnswerError: it is not an event of a job.
        """
        try:
            document = EventDocument.model_validate_json(event.data)
            number = integer(event.id)
        except (ValidationError, ValueError):
            raise UnexpectedAnswerError(f"{event.data[:100]!r} is not an event of a job") from None
        self._last, self._failed = number, 0
        return document

    def pause_after_close_s(self) -> float:
        """The pause after the service or a proxy closed the stream before the job ended."""
        self._failed += 1
        return backoff_s(self._failed - 1)

    def pause_after_s(self, call: Call[object], error: ClientError) -> float | None:
        """The pause after a failure; None if it is final. A read timeout of the stream is not a failure."""
        if isinstance(error, TimedOutError) and error.reached:
            return 0.0
        self._failed += 1
        return self._retrying.pause_s(error, self._failed - 1, repeatable=call.repeatable)


POLL_S = 2.0
"""Seconds between polls of a job whose events cannot be streamed."""


@dataclass(frozen=True)
class Progress:
    """Progress of a job: ``committed`` of its ``chunks`` (orientations) are computed."""

    job: int
    committed: int
    chunks: int

    @property
    def share(self) -> float:
        """The part that is done, 0 to 1."""
        return self.committed / self.chunks


Watcher = Callable[[Progress], object]
AssemblyWatcher = Callable[[AssemblyProgress], object]


class AssemblyEvents:
    """The events of a path that is computed: ``watcher`` is called with how far it is; the last one is the answer.

    Attributes:
        call: the request for the events.
    """

    def __init__(self, call: Call[Assembly], watcher: AssemblyWatcher) -> None:
        self.call = replace(call, accept=EVENT_STREAM)
        self._watcher = watcher
        self._answer: Assembly | None = None

    def received(self, event: httpx2.ServerSentEvent) -> None:
        """Parse an event.

        Raises:
            ProblemError: it says why there is no answer.
            UnexpectedAnswerError: it is not an event of a path.
        """
        name = name_of(self.call)
        try:
            match event.event:
                case "progress":
                    self._watcher(AssemblyProgress.model_validate_json(event.data))
                case "answer":
                    self._answer = Assembly.model_validate_json(event.data)
                case "problem":
                    raise problem_error(name, Problem.model_validate_json(event.data), None)
        except ValidationError:
            raise UnexpectedAnswerError(f"{name}: {event.data[:100]!r} is not an event of a path") from None

    def answer(self) -> Assembly:
        """The answer.

        Raises:
            UnexpectedAnswerError: the stream ended without it.
        """
        if self._answer is None:
            raise UnexpectedAnswerError(f"{name_of(self.call)}: the stream ended without an answer")
        return self._answer


class JobWait:
    """Waits for a job for at most ``timeout_s`` and reports its progress to ``watcher``."""

    def __init__(self, job_id: int, watcher: Watcher | None, timeout_s: float | None) -> None:
        self._job_id = job_id
        self._watcher = watcher
        self._timeout_s = math.inf if timeout_s is None else timeout_s
        self._end = time.monotonic() + self._timeout_s
        self._reported: Progress | None = None

    @property
    def read_timeout_s(self) -> float:
        """Read timeout of the stream: no later than the end of waiting."""
        return max(0.001, min(STREAM_TIMEOUT_S, self._end - time.monotonic()))

    def report(self, seen: EventDocument | JobDocument) -> None:
        """Report the progress of the job if it has changed."""
        progress = Progress(self._job_id, seen.committed, seen.chunks)
        if progress != self._reported and self._watcher is not None:
            self._watcher(progress)
        self._reported = progress

    def check_time(self) -> None:
        """Check the time limit.

        Raises:
            WaitTimedOutError: the time limit has passed.
        """
        if time.monotonic() >= self._end:
            raise WaitTimedOutError(f"job {self._job_id} did not end within {number_text(self._timeout_s)} s")


def is_done(job: JobDocument) -> bool:
    """Whether a job has ended with a library; False while it runs.

    Raises:
        JobFailedError: it failed.
        JobCancelledError: it was cancelled.
    """
    if job.state is JobState.FAILED:
        raise JobFailedError(job)
    if job.state is JobState.CANCELLED:
        raise JobCancelledError(job)
    return job.state is JobState.DONE
