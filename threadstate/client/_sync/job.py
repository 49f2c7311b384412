# Made of _async/job.py by `make client`: edit that one.
"""A job as a thing to be watched, waited for and cancelled."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import httpx2

from threadstate.client._sync.courier import Courier
from threadstate.client.blocking import pause
from threadstate.client.calls import jobs
from threadstate.client.errors import ClientError, ConnectionFailedError, UnexpectedAnswerError
from threadstate.client.models.jobs import EventDocument, JobDocument
from threadstate.client.watching import POLL_S, QUIET_S, Place, Waiting, Watcher, ended_well


class Job:
    """A job.

    Attributes:
        document: the job as it was when it was last looked at.
    """

    def __init__(self, courier: Courier, document: JobDocument) -> None:
        self._courier = courier
        self.document = document

    @property
    def id(self) -> int:
        """Number of the job."""
        return self.document.id

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.id}, {self.document.state.value})"

    def refresh(self) -> JobDocument:
        """Look at the job again."""
        self.document = self._courier.send(jobs.job(self.id))
        return self.document

    def cancel(self) -> JobDocument:
        """Cancel the job; needs a key for writing.

        Raises:
            ConflictError: it has ended otherwise.
        """
        self.document = self._courier.send(jobs.cancel(self.id))
        return self.document

    def events(self, after: int = 0) -> Iterator[EventDocument]:
        """What has happened after the event of that number, and what happens until the job ends.

        A connection that breaks is made again, and nothing is told twice.
        """
        for event in self._followed(after, lambda: QUIET_S):
            if event is not None:
                yield event

    def wait(self, progress: Watcher | None = None, timeout_s: float | None = None) -> JobDocument:
        """Wait until the library is published; ``progress`` is told how far it is whenever that changes.

        Follows the job's events, and looks every two seconds where these do not come through.

        Raises:
            JobFailedError: the job failed.
            JobCancelledError: somebody cancelled it.
            WaitTimedOutError: it has not ended after ``timeout_s`` seconds (None: there is no end to waiting).
        """
        waiting = Waiting(self.id, progress, timeout_s)
        try:
            for event in self._followed(0, lambda: waiting.quiet_s):
                if event is not None:
                    waiting.tell(event)
                waiting.check_time()
        except (ConnectionFailedError, UnexpectedAnswerError):
            pass  # a proxy that holds streams back, perhaps: the job itself says how far it is
        while not ended_well(self.refresh()):
            waiting.tell(self.document)
            waiting.check_time()
            pause(min(POLL_S, waiting.quiet_s))
        waiting.tell(self.document)
        return self.document

    def _followed(self, after: int, quiet_s: Callable[[], float]) -> Iterator[EventDocument | None]:
        """The events, and None whenever nothing came for ``quiet_s``."""
        call = jobs.events(self.id)
        place = Place(after, self._courier.options.retrying)
        while True:
            try:
                with self._courier.stream(call, place.headers, quiet_s()) as response:
                    if response.status_code == httpx2.codes.NO_CONTENT:
                        return
                    for event in httpx2.EventSource(response):
                        yield place.received(event)
                pause_s = place.pause_after_close_s()
            except ClientError as error:
                after_error_s = place.pause_after_s(call, error)
                if after_error_s is None:
                    raise
                pause_s = after_error_s
            yield None
            pause(pause_s)
