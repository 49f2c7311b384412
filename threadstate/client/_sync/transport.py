# Made of _async/transport.py by `make client`: edit that one.
"""Sends the requests of a client and retries those that may be repeated."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

import httpx2

from threadstate.atomic_file import replaced_file
from threadstate.client.blocking import pause, write
from threadstate.client.call import Call
from threadstate.client.errors import ClientError
from threadstate.client.options import Options
from threadstate.client.wire import build_request, check_success, client_errors, parse_response

Result = TypeVar("Result")


class Transport:
    """A pool of connections to the service; may be used by several threads."""

    def __init__(self, options: Options) -> None:
        self.options = options
        self._http = httpx2.Client(auth=options.key, headers=options.headers, timeout=options.timeout)

    def send(self, call: Call[Result]) -> Result:
        """The result of a call.

        Raises:
            ClientError: the request failed, also when it was retried.
        """
        return self._with_retries(call, lambda: self._answer(call))

    def download(self, call: Call[object], out: Path) -> None:
        """Write the response of a call to a file, atomically.

        Raises:
            ClientError: the request failed, also when it was retried from the beginning.
            OSError: the file cannot be written.
        """
        self._with_retries(call, lambda: self._written(call, out))

    def events(self, call: Call[object], received: Callable[[httpx2.ServerSentEvent], None]) -> None:
        """Call ``received`` with every event of a call's response.

        Raises:
            ClientError: the request failed, also when it was retried from the beginning.
        """
        self._with_retries(call, lambda: self._listened(call, received))

    @contextmanager
    def stream(
        self, call: Call[object], headers: dict[str, str] | None = None, read_timeout_s: float | None = None
    ) -> Iterator[httpx2.Response]:
        """A response whose content is read as a stream; not retried.

        Raises:
            ClientError: the request failed, or the response broke off.
        """
        with client_errors(call):
            request = build_request(self._http, self.options, call, headers, read_timeout_s)
            response = self._http.send(request, stream=True)
            try:
                if not response.is_success:
                    response.read()
                check_success(call, response)
                yield response
            finally:
                response.close()

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def _answer(self, call: Call[Result]) -> Result:
        with client_errors(call):
            response = self._http.send(build_request(self._http, self.options, call))
        return parse_response(call, response)

    def _written(self, call: Call[object], out: Path) -> None:
        with self.stream(call) as response:
            with replaced_file(out) as file:
                for part in response.iter_bytes():
                    write(file, part)

    def _listened(self, call: Call[object], received: Callable[[httpx2.ServerSentEvent], None]) -> None:
        with self.stream(call) as response:
            for event in httpx2.EventSource(response):
                received(event)

    def _with_retries(self, call: Call[object], attempt: Callable[[], Result]) -> Result:
        failures = 0
        while True:
            try:
                return attempt()
            except ClientError as error:
                pause_s = self.options.retrying.pause_s(error, failures, repeatable=call.repeatable)
                if pause_s is None:
                    raise
            failures += 1
            pause(pause_s)
