"""Waiting for a job: how far it is, how long it may take, how it ended."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

from threadstate.client.errors import JobCancelledError, JobFailedError, WaitTimedOutError
from threadstate.client.following import QUIET_S
from threadstate.client.models.jobs import EventDocument, JobDocument
from threadstate.jobs.names import JobState
from threadstate.numbers import number_text

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
