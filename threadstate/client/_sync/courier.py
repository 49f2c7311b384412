# Made of _async/courier.py by `make client`: edit that one.
"""Sends the requests of a client, and tries again what may be tried again."""

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
from threadstate.client.wire import check_success, request_of, result_of, understood_failures

Result = TypeVar("Result")


class Courier:
    """A pool of connections to the service; may be used by several threads."""

    def __init__(self, options: Options) -> None:
        self.options = options
        self._http = httpx2.Client(auth=options.key, headers=options.headers, timeout=options.timeout)

    def send(self, call: Call[Result]) -> Result:
        """The result of a call.

        Raises:
            ClientError: there is none, also when it was asked for again.
        """
        return self._repeated(call, lambda: self._answer(call))

    def download(self, call: Call[object], out: Path) -> None:
        """Write what a call is answered by to a file, which is there whole or not at all.

        Raises:
            ClientError: it cannot be had, also when it was asked for again from its beginning.
            OSError: the file cannot be written.
        """
        self._repeated(call, lambda: self._written(call, out))

    @contextmanager
    def stream(
        self, call: Call[object], headers: dict[str, str] | None = None, quiet_s: float | None = None
    ) -> Iterator[httpx2.Response]:
        """An answer whose content is still to come; asked for once.

        Raises:
            ClientError: there is none, or it breaks off.
        """
        with understood_failures(call):
            request = request_of(self._http, self.options, call, headers, quiet_s)
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
        with understood_failures(call):
            response = self._http.send(request_of(self._http, self.options, call))
        return result_of(call, response)

    def _written(self, call: Call[object], out: Path) -> None:
        with self.stream(call) as response:
            with replaced_file(out) as file:
                for part in response.iter_bytes():
                    write(file, part)

    def _repeated(self, call: Call[object], attempt: Callable[[], Result]) -> Result:
        tried = 0
        while True:
            try:
                return attempt()
            except ClientError as error:
                pause_s = self.options.retrying.pause_s(error, tried, repeatable=call.repeatable)
                if pause_s is None:
                    raise
            tried += 1
            pause(pause_s)
