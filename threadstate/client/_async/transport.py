"""Sends the requests of a client and retries those that may be repeated."""

from __future__ import annotations

from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import TypeVar

import httpx2

from threadstate.atomic_file import replaced_file
from threadstate.client.blocking import async_pause, async_write
from threadstate.client.call import Call
from threadstate.client.errors import ClientError
from threadstate.client.options import Options
from threadstate.client.wire import build_request, check_success, client_errors, parse_response

Result = TypeVar("Result")


class AsyncTransport:
    """A pool of connections to the service; may be used by several tasks."""

    def __init__(self, options: Options) -> None:
        self.options = options
        self._http = httpx2.AsyncClient(auth=options.key, headers=options.headers, timeout=options.timeout)

    async def send(self, call: Call[Result]) -> Result:
        """The result of a call.

        Raises:
            ClientError: the request failed, also when it was retried.
        """
        return await self._with_retries(call, lambda: self._answer(call))

    async def download(self, call: Call[object], out: Path) -> None:
        """Write the response of a call to a file, atomically.

        Raises:
            ClientError: the request failed, also when it was retried from the beginning.
            OSError: the file cannot be written.
        """
        await self._with_retries(call, lambda: self._written(call, out))

    async def events(self, call: Call[object], received: Callable[[httpx2.ServerSentEvent], None]) -> None:
        """Call ``received`` with every event of a call's response.

        Raises:
            ClientError: the request failed, also when it was retried from the beginning.
        """
        await self._with_retries(call, lambda: self._listened(call, received))

    @asynccontextmanager
    async def stream(
        self, call: Call[object], headers: dict[str, str] | None = None, read_timeout_s: float | None = None
    ) -> AsyncIterator[httpx2.Response]:
        """A response whose content is read as a stream; not retried.

        Raises:
            ClientError: the request failed, or the response broke off.
        """
        with client_errors(call):
            request = build_request(self._http, self.options, call, headers, read_timeout_s)
            response = await self._http.send(request, stream=True)
            try:
                if not response.is_success:
                    await response.aread()
                check_success(call, response)
                yield response
            finally:
                await response.aclose()

    async def close(self) -> None:
        """Close the connections."""
        await self._http.aclose()

    async def _answer(self, call: Call[Result]) -> Result:
        with client_errors(call):
            response = await self._http.send(build_request(self._http, self.options, call))
        return parse_response(call, response)

    async def _written(self, call: Call[object], out: Path) -> None:
        async with self.stream(call) as response:
            with replaced_file(out) as file:
                async for part in response.aiter_bytes():
                    await async_write(file, part)

    async def _listened(self, call: Call[object], received: Callable[[httpx2.ServerSentEvent], None]) -> None:
        async with self.stream(call) as response:
            async for event in httpx2.EventSource(response):
                received(event)

    async def _with_retries(self, call: Call[object], attempt: Callable[[], Awaitable[Result]]) -> Result:
        failures = 0
        while True:
            try:
                return await attempt()
            except ClientError as error:
                pause_s = self.options.retrying.pause_s(error, failures, repeatable=call.repeatable)
                if pause_s is None:
                    raise
            failures += 1
            await async_pause(pause_s)
