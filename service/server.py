"""The server: uvicorn, with an end that no client notices.

Told to end by SIGTERM it goes on for a moment, and every answer says ``Connection: close``: a client that is at work
takes its next request elsewhere, and no connection is cut under a request that is on its way. Then what is left is idle
and is closed, and requests in flight are waited for. Ctrl-C leaves out the moment.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import signal
import socket
from collections.abc import Iterator, Mapping
from types import FrameType

import uvicorn

from service.edge.drain import Drain
from threadstate.errors import ThreadstateError

LEAVE_TAKING_S = 1.0
"""How long connections are given to make their next request."""
_FIRST_INHERITED = 3

_log = logging.getLogger(__name__)


class ListenError(ThreadstateError):
    """The address cannot be listened on."""


def inherited_socket(environment: Mapping[str, str]) -> socket.socket | None:
    """The listening socket that was passed on by systemd's protocol (``LISTEN_PID``, ``LISTEN_FDS``), if one was.

    Raises:
        ListenError: there are several.
    """
    if environment.get("LISTEN_PID") != str(os.getpid()):
        return None
    if environment.get("LISTEN_FDS") != "1":
        raise ListenError(f"LISTEN_FDS is {environment.get('LISTEN_FDS')!r}; valid: 1")
    return socket.socket(fileno=_FIRST_INHERITED)


def bound_socket(host: str, port: int) -> socket.socket:
    """A socket that is bound to that address; port 0 is a free one.

    Raises:
        ListenError: it cannot be bound, as where another process listens.
    """
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        bound = socket.socket(family, kind, protocol)
        bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        bound.bind(address)
    except OSError as error:
        raise ListenError(f"cannot listen on {host} port {port}: {error.strerror or error}") from None
    return bound


class Server(uvicorn.Server):
    """Serves until it is told to end; ends with code 0."""

    def __init__(self, config: uvicorn.Config, drain: Drain) -> None:
        super().__init__(config)
        self._drain = drain
        self._at_once = False

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Take SIGTERM and SIGINT; unlike uvicorn's own this does not raise them again at the end."""
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, self.handle_exit)
        yield

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Begin to end; a second signal leaves out what is waited for."""
        self._at_once = sig == signal.SIGINT
        if self.should_exit:
            self.force_exit = True
        self.should_exit = True
        _ = frame

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Listen, and say where."""
        await super().startup(sockets)
        for one in sockets or ():
            host, port = one.getsockname()[:2]
            _log.info("running on http://%s:%d", f"[{host}]" if ":" in host else host, port)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Take leave of clients, then end."""
        self._drain.begin()
        if not self._at_once:
            await asyncio.sleep(LEAVE_TAKING_S)
        await super().shutdown(sockets)
