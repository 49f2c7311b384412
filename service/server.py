"""The server: uvicorn with a graceful shutdown.

After SIGTERM it serves for ``DRAIN_S`` more, and every response has ``Connection: close``: active clients open their
next connection elsewhere, and no connection is closed while a request is on its way. Then no more are accepted, and
those just accepted have ``FIRST_REQUEST_S`` to send their request: a client may send again what an idle connection was
closed on, but not what it opened a connection for. At last idle connections are closed and requests in progress are
completed. SIGINT skips the draining.
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

from service.shutdown import Shutdown
from threadstate.errors import ThreadstateError

DRAIN_S = 1.0
"""How long connections may send one more request."""
FIRST_REQUEST_S = 1.0
"""How long after the last connection was accepted one without a request yet may send it."""
_POLL_S = 0.02
_FIRST_INHERITED = 3

_log = logging.getLogger(__name__)


class ListenError(ThreadstateError):
    """The address cannot be listened on."""


def inherited_socket(environment: Mapping[str, str]) -> socket.socket | None:
    """The listening socket passed by systemd's protocol (``LISTEN_PID``, ``LISTEN_FDS``), if one was.

    Raises:
        ListenError: more than one was passed.
    """
    if environment.get("LISTEN_PID") != str(os.getpid()):
        return None
    if environment.get("LISTEN_FDS") != "1":
        raise ListenError(f"LISTEN_FDS is {environment.get('LISTEN_FDS')!r}; valid: 1")
    return socket.socket(fileno=_FIRST_INHERITED)


def bound_socket(host: str, port: int) -> socket.socket:
    """A socket bound to that address; port 0 chooses a free port.

    Raises:
        ListenError: it cannot be bound, for example because another process listens.
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
    """Serves until SIGTERM or SIGINT; ends with exit code 0."""

    def __init__(self, config: uvicorn.Config, shutdown: Shutdown) -> None:
        super().__init__(config)
        self._shutdown_flag = shutdown
        self._skip_draining = False

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Handle SIGTERM and SIGINT; unlike uvicorn's method this does not raise them again at the end."""
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, self.handle_exit)
        yield

    def handle_exit(self, sig: int, frame: FrameType | None) -> None:
        """Start the shutdown; a second signal forces it."""
        self._skip_draining = sig == signal.SIGINT
        if self.should_exit:
            self.force_exit = True
        self.should_exit = True
        _ = frame

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Listen, and log the address."""
        await super().startup(sockets)
        for one in sockets or ():
            host, port = one.getsockname()[:2]
            _log.info("running on http://%s:%d", f"[{host}]" if ":" in host else host, port)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Drain connections, then shut down."""
        self._shutdown_flag.start()
        if not self._skip_draining:
            await asyncio.sleep(DRAIN_S)
            for server in self.servers:
                server.close()
            await self._first_requests()
        await super().shutdown(sockets)

    async def _first_requests(self) -> None:
        """Wait until each connection has sent a request, ``FIRST_REQUEST_S`` at most."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(FIRST_REQUEST_S):
                await asyncio.sleep(_POLL_S)  # what was accepted last is among the connections after that
                while not self.force_exit and any(map(_awaits_first_request, self.server_state.connections)):
                    await asyncio.sleep(_POLL_S)


def _awaits_first_request(protocol: object) -> bool:
    """Whether no request was read on a connection; uvicorn's protocols of HTTP have a cycle from their first on."""
    return getattr(protocol, "cycle", protocol) is None
