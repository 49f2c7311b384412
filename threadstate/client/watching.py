"""Following a job's events over as many connections as it takes, and waiting for its end."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import httpx2
from pydantic import ValidationError

from threadstate.client.call import Call
from threadstate.client.errors import (
    ClientError,
    JobCancelledError,
    JobFailedError,
    TimedOutError,
    UnexpectedAnswerError,
    WaitTimedOutError,
)
from threadstate.client.models.jobs import EventDocument, JobDocument
from threadstate.client.retrying import Retrying, backoff_s
from threadstate.jobs.names import JobState
from threadstate.numbers import integer, number_text

QUIET_S = 10.0
"""A stream on which nothing came for so many seconds is left and asked for again: the connection may be dead."""


class Place:
    """Where a follower of a job's events is: what it has received, and how often it has failed since.

    ``after`` is the number of the last event that is known already.
    """

    def __init__(self, after: int, retrying: Retrying) -> None:
        self._last = after
        self._retrying = retrying
        self._failed = 0

    @property
    def headers(self) -> dict[str, str]:
        """What tells the service where to go on."""
        return {"Last-Event-ID": str(self._last)} if self._last else {}

    def received(self, event: httpx2.ServerSentEvent) -> EventDocument:
        """What an event says; the next connection goes on after it.

        Raises:
            UnexpectedAnswerError: it is no event of a job.
        """
        try:
            document = EventDocument.model_validate_json(event.data)
            number = integer(event.id)
        except (ValidationError, ValueError):
            raise UnexpectedAnswerError(f"{event.data[:100]!r} is no event of a job") from None
        self._last, self._failed = number, 0
        return document

    def pause_after_close_s(self) -> float:
        """How long to wait after the service, or a proxy, closed the stream although the job goes on."""
        self._failed += 1
        return backoff_s(self._failed - 1)

    def pause_after_s(self, call: Call[object], error: ClientError) -> float | None:
        """How long to wait after a failure; None where it is final. A stream that was only quiet is no failure."""
        if isinstance(error, TimedOutError) and error.reached:
            return 0.0
        self._failed += 1
        return self._retrying.pause_s(error, self._failed - 1, repeatable=call.repeatable)


POLL_S = 2.0
"""Seconds between two looks at a job where its events cannot be followed."""


@dataclass(frozen=True)
class Progress:
    """How far a job is: ``committed`` of its ``chunks`` (orientations) are computed."""

    job: int
    committed: int
    chunks: int

    @property
    def share(self) -> float:
        """The part that is done, 0 to 1."""
        return self.committed / self.chunks


Watcher = Callable[[Progress], object]


class Waiting:
    """Somebody who waits for a job, at most ``timeout_s``, and is told through ``watcher`` how far it is."""

    def __init__(self, job_id: int, watcher: Watcher | None, timeout_s: float | None) -> None:
        self._job_id = job_id
        self._watcher = watcher
        self._timeout_s = math.inf if timeout_s is None else timeout_s
        self._end = time.monotonic() + self._timeout_s
        self._told: Progress | None = None

    @property
    def quiet_s(self) -> float:
        """How long to listen to a stream on which nothing comes."""
        return max(0.001, min(QUIET_S, self._end - time.monotonic()))

    def tell(self, seen: EventDocument | JobDocument) -> None:
        """Tell how far the job is, if it has moved."""
        progress = Progress(self._job_id, seen.committed, seen.chunks)
        if progress != self._told and self._watcher is not None:
            self._watcher(progress)
        self._told = progress

    def check_time(self) -> None:
        """Go on waiting.

        Raises:
            WaitTimedOutError: it has taken too long.
        """
        if time.monotonic() >= self._end:
            raise WaitTimedOutError(f"job {self._job_id} did not end within {number_text(self._timeout_s)} s")


def ended_well(job: JobDocument) -> bool:
    """Whether a job has ended with a library; False while it goes on.

    Raises:
        JobFailedError: it failed.
        JobCancelledError: it was cancelled.
    """
    if job.state is JobState.FAILED:
        raise JobFailedError(job)
    if job.state is JobState.CANCELLED:
        raise JobCancelledError(job)
    return job.state is JobState.DONE
