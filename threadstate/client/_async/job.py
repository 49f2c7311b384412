"""A job: its state, its events, waiting and cancelling."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable

import httpx2

from threadstate.client._async.transport import AsyncTransport
from threadstate.client.blocking import async_pause
from threadstate.client.calls import jobs
from threadstate.client.errors import ClientError, ConnectionFailedError, UnexpectedAnswerError
from threadstate.client.models.jobs import EventDocument, JobDocument
from threadstate.client.watching import POLL_S, STREAM_TIMEOUT_S, JobWait, StreamPosition, Watcher, is_done


class AsyncJob:
    """A job.

    Attributes:
        document: the job at the last request for it.
    """

    def __init__(self, transport: AsyncTransport, document: JobDocument) -> None:
        self._transport = transport
        self.document = document

    @property
    def id(self) -> int:
        """Number of the job."""
        return self.document.id

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.id}, {self.document.state.value})"

    async def refresh(self) -> JobDocument:
        """Request the job again."""
        self.document = await self._transport.send(jobs.job(self.id))
        return self.document

    async def cancel(self) -> JobDocument:
        """Cancel the job; needs a key for writing.

        Raises:
            ConflictError: it has ended otherwise.
        """
        self.document = await self._transport.send(jobs.cancel(self.id))
        return self.document

    async def events(self, after: int = 0) -> AsyncIterator[EventDocument]:
        """The events after the one of that number, past ones and those until the job ends.

        A broken connection is reopened; no event is repeated.
        """
        async for event in self._stream_events(after, lambda: STREAM_TIMEOUT_S):
            if event is not None:
                yield event

    async def wait(self, progress: Watcher | None = None, timeout_s: float | None = None) -> JobDocument:
        """Wait until the library is published; ``progress`` is called whenever the job's progress changes.

        Follows the job's events, or polls every two seconds if the events cannot be streamed.

        Raises:
            JobFailedError: the job failed.
            JobCancelledError: it was cancelled.
            WaitTimedOutError: it has not ended after ``timeout_s`` seconds (None: no limit).
        """
        wait = JobWait(self.id, progress, timeout_s)
        try:
            async for event in self._stream_events(0, lambda: wait.read_timeout_s):
                if event is not None:
                    wait.report(event)
                wait.check_time()
        except (ConnectionFailedError, UnexpectedAnswerError):
            pass  # perhaps a proxy buffers streams: poll the job instead
        while not is_done(await self.refresh()):
            wait.report(self.document)
            wait.check_time()
            await async_pause(min(POLL_S, wait.read_timeout_s))
        wait.report(self.document)
        return self.document

    async def _stream_events(
        self, after: int, read_timeout_s: Callable[[], float]
    ) -> AsyncIterator[EventDocument | None]:
        """The events, and None whenever nothing was received for ``read_timeout_s``."""
        call = jobs.events(self.id)
        position = StreamPosition(after, self._transport.options.retrying)
        while True:
            try:
                async with self._transport.stream(call, position.headers, read_timeout_s()) as response:
                    if response.status_code == httpx2.codes.NO_CONTENT:
                        return
                    async for event in httpx2.EventSource(response):
                        yield position.received(event)
                pause_s = position.pause_after_close_s()
            except ClientError as error:
                after_error_s = position.pause_after_s(call, error)
                if after_error_s is None:
                    raise
                pause_s = after_error_s
            yield None
            await async_pause(pause_s)
