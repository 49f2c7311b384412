"""A server that answers as a script says, one request after another, and remembers what it was asked."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

BREAK_OFF = b""
"""An answer that is none: the connection is closed."""
SILENCE = b"silence"
"""No answer, and the connection stays open."""


def answer(status: int, body: str = "{}", media_type: str = "application/json", **headers: str) -> bytes:
    """An answer; an underscore in the name of a header is a hyphen."""
    lines = [f"HTTP/1.1 {status} Some Reason", f"Content-Type: {media_type}", f"Content-Length: {len(body.encode())}"]
    lines += [f"{name.replace('_', '-')}: {value}" for name, value in headers.items()]
    return "\r\n".join([*lines, "Connection: close", "", body]).encode()


@dataclass
class ScriptedServer:
    """The server's address, and the heads of the requests that it got."""

    address: str
    heads: list[str] = field(default_factory=list)


@contextmanager
def scripted_server(script: Sequence[bytes]) -> Iterator[ScriptedServer]:
    """Answers the first request by the first line of the script, and so on; the last one answers all others."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        server = ScriptedServer(f"http://127.0.0.1:{listening.getsockname()[1]}")
        open_connections: list[socket.socket] = []
        thread = threading.Thread(target=_serve, args=(listening, script, server, open_connections.append))
        thread.start()
        try:
            yield server
        finally:
            with socket.create_connection(listening.getsockname()):
                pass  # wakes the thread, which ends at a connection that says nothing
            thread.join()
            for connection in open_connections:
                connection.close()


def _serve(
    listening: socket.socket,
    script: Sequence[bytes],
    server: ScriptedServer,
    keep: Callable[[socket.socket], object],
) -> None:
    while True:
        connection, _ = listening.accept()
        head = _head(connection)
        if not head:
            connection.close()
            return
        line = script[min(len(server.heads), len(script) - 1)]
        server.heads.append(head)
        if line == SILENCE:
            keep(connection)
            continue
        connection.sendall(line)
        connection.shutdown(socket.SHUT_WR)
        connection.close()


def _head(connection: socket.socket) -> str:
    content = b""
    while b"\r\n\r\n" not in content:
        part = connection.recv(65536)
        if not part:
            break
        content += part
    return content.decode("latin-1")
