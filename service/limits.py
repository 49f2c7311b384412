"""LimitsMiddleware of concurrent and queued requests, of streams and of time.

Responses from the cache are not limited. An endpoint that exceeds its time cannot be stopped: it keeps its place until
it has ended, and only its client gets an error.
"""

from __future__ import annotations

import asyncio
import logging
import re

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from service.problems import OUT_OF_TIME, TOO_MANY_REQUESTS, TOO_MANY_STREAMS, Kind, problem_response
from threadstate.numbers import number_text

LIMITED = "/v1/"
"""Paths below compute or read the database; the others serve monitoring, or files from memory."""
QUEUED_PER_PLACE = 16
"""Queued requests per place: threads that read rows slow each other down, so few at once answer more than many."""
RETRY_AFTER_S = 1

_log = logging.getLogger(__name__)
_STREAM = re.compile(r"/v1/jobs/[0-9]+/events")


class Admission:
    """Counts of requests that compute, wait for a place, or stream events."""

    def __init__(self, places: int, streams: int) -> None:
        self._places = places
        self._most_streams = streams
        self._free = asyncio.Semaphore(places)
        self.computing = 0
        self.queued = 0
        self.streams = 0

    @property
    def is_full(self) -> bool:
        """Whether the queue is full."""
        return self.queued >= self._places * QUEUED_PER_PLACE

    @property
    def streams_are_full(self) -> bool:
        """Whether no further stream may be opened."""
        return self.streams >= self._most_streams

    def queue(self) -> None:
        """Join the queue; a call of :meth:`enter` must follow."""
        self.queued += 1

    async def enter(self) -> None:
        """Wait for a place and leave the queue."""
        try:
            await self._free.acquire()
        finally:
            self.queued -= 1
        self.computing += 1

    def leave(self) -> None:
        """Release the place."""
        self.computing -= 1
        self._free.release()


class LimitsMiddleware:
    """Rejects requests above the limits (429) and those that exceed the time limit (503), both with ``Retry-After``."""

    def __init__(self, app: ASGIApp, admission: Admission, time_limit_s: float) -> None:
        self._app = app
        self._admission = admission
        self._time_limit = time_limit_s
        self._ending: set[asyncio.Task[None]] = set()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle one connection (ASGI)."""
        if scope["type"] != "http" or not scope["path"].startswith(LIMITED):
            await self._app(scope, receive, send)
        elif scope["method"] == "GET" and _STREAM.fullmatch(scope["path"]):
            await self._stream(scope, receive, send)
        elif self._admission.is_full:
            await _refuse(TOO_MANY_REQUESTS, "as many requests as this process takes are being answered", send)
        else:
            await self._in_time(scope, receive, send)

    async def _stream(self, scope: Scope, receive: Receive, send: Send) -> None:
        if self._admission.streams_are_full:
            await _refuse(TOO_MANY_STREAMS, "as many streams as this process takes are open", send)
            return
        self._admission.streams += 1
        try:
            await self._app(scope, receive, send)
        finally:
            self._admission.streams -= 1

    async def _in_time(self, scope: Scope, receive: Receive, send: Send) -> None:
        begun = asyncio.get_running_loop().create_future()
        given_up = False

        async def send_in_time(message: Message) -> None:
            if given_up:
                return
            if not begun.done():
                begun.set_result(None)
            await send(message)

        self._admission.queue()
        task = asyncio.create_task(self._in_place(scope, receive, send_in_time))
        try:
            await asyncio.wait((task, begun), timeout=self._time_limit, return_when=asyncio.FIRST_COMPLETED)
            if task.done() or begun.done():
                await task
                return
            given_up = True
            await _refuse(OUT_OF_TIME, f"no answer within {number_text(self._time_limit)} s", send)
        finally:
            if not task.done():
                self._let_end(task)

    def _let_end(self, task: asyncio.Task[None]) -> None:
        """Cancel a task: one that waits for a place ends at once, one that computes when its endpoint returns."""
        task.cancel()
        self._ending.add(task)
        task.add_done_callback(self._ended)

    def _ended(self, task: asyncio.Task[None]) -> None:
        self._ending.discard(task)
        if not task.cancelled() and (error := task.exception()) is not None:
            _log.error("a request that timed out has failed", exc_info=error)

    async def _in_place(self, scope: Scope, receive: Receive, send: Send) -> None:
        await self._admission.enter()
        try:
            await self._app(scope, receive, send)
        finally:
            self._admission.leave()


async def _refuse(kind: Kind, detail: str, send: Send) -> None:
    response = problem_response(kind, detail, headers={"Retry-After": str(RETRY_AFTER_S)})
    await send({"type": "http.response.start", "status": response.status_code, "headers": response.raw_headers})
    await send({"type": "http.response.body", "body": response.body})
