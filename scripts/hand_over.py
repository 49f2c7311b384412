"""Ends one service after another by SIGTERM under load, and counts every request: ``python -m scripts.hand_over``.

The listening socket is passed on as systemd does it. Clients with connections that are kept alive ask without a pause;
some rest between requests, so that they are idle when connections are closed. Each request is answered in full, or
was sent into a connection that was closed already and is sent once more, as HTTP has clients do (RFC 9112, 9.3.1).
"""

from __future__ import annotations

import argparse
import http.client
import os
import random
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field

from threadstate.settings import DATABASE, read_settings

PATHS = ("/v1/libraries/latest/states/0/0/0", "/v1/libraries/latest/histories/1/-1", "/v1/libraries", "/healthz")
BUSY, RESTING = 6, 4
LONGEST_REST_S = 1.5
LONGEST_START_S = 60.0
# What the protocol says: the first socket is number 3, and the number of the process is told.
_LISTEN = """
import os, sys
os.dup2(int(sys.argv[1]), 3)
environment = {**os.environ, "LISTEN_PID": str(os.getpid()), "LISTEN_FDS": "1"}
os.execve(sys.executable, [sys.executable, "-m", "service"], environment)
"""


@dataclass
class Tally:
    """What became of requests; ``sent_again`` are those that met a connection closed before them."""

    answered: int = 0
    sent_again: int = 0
    failed: list[str] = field(default_factory=list)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def add(self, answered: int, sent_again: int, failed: Sequence[str]) -> None:
        """Add those of one client."""
        with self._lock:
            self.answered += answered
            self.sent_again += sent_again
            self.failed += failed


def hand_over(database: str, times: int, apart_s: float) -> Tally:
    """Replace the service that many times, under load.

    Raises:
        AssertionError: a service did not start, or did not end with code 0.
    """
    tally, over = Tally(), threading.Event()
    with socket.socket() as listening, ExitStack() as services:
        listening.bind(("127.0.0.1", 0))
        listening.listen(1024)
        port = listening.getsockname()[1]
        running = services.enter_context(_service(database, listening))
        clients = [
            threading.Thread(target=_ask, args=(port, over, tally, 0.0 if i < BUSY else LONGEST_REST_S, i))
            for i in range(BUSY + RESTING)
        ]
        for client in clients:
            client.start()
        try:
            for _ in range(times):
                time.sleep(apart_s)
                successor = services.enter_context(_service(database, listening))
                running.send_signal(signal.SIGTERM)
                code = running.wait(LONGEST_START_S)
                assert code == 0, f"a service ended with {code}"
                running = successor
        finally:
            over.set()
            for client in clients:
                client.join()
    return tally


@contextmanager
def _service(database: str, listening: socket.socket) -> Iterator[subprocess.Popen[str]]:
    """A service that listens on a socket."""
    passed_on = listening.fileno()
    command = (sys.executable, "-c", _LISTEN, str(passed_on))
    environment = {**os.environ, DATABASE: database}
    with subprocess.Popen(
        command, env=environment, pass_fds=(passed_on,), stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stderr is not None
        try:
            said = []
            for line in process.stderr:
                said.append(line)
                if "running on http" in line:
                    break
            else:
                raise AssertionError("".join(said))
            # What it logs is not to fill the pipe.
            threading.Thread(target=process.stderr.read, daemon=True).start()
            yield process
        finally:
            process.terminate()


def _ask(port: int, over: threading.Event, tally: Tally, longest_rest_s: float, seed: int) -> None:
    chance = random.Random(seed)
    answered, sent_again, failed = 0, 0, list[str]()
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=LONGEST_START_S)
    while not over.is_set():
        path = chance.choice(PATHS)
        used_before = connection.sock is not None
        try:
            response = _response(connection, path)
            if response is None and used_before:
                sent_again += 1
                response = _response(connection, path)
            if response is None:
                failed.append(f"{path}: closed without an answer")
                continue
            response.read()
        except (OSError, http.client.HTTPException) as error:
            failed.append(f"{path}: {error!r}")
            connection.close()
            continue
        answered += 1
        if response.status != 200:
            failed.append(f"{path}: {response.status}")
        time.sleep(chance.uniform(0.0, longest_rest_s))
    connection.close()
    tally.add(answered, sent_again, failed)


def _response(connection: http.client.HTTPConnection, path: str) -> http.client.HTTPResponse | None:
    """The answer, its content not read yet; None where the connection was closed before any of it."""
    try:
        connection.request("GET", path)
        return connection.getresponse()
    except (http.client.RemoteDisconnected, ConnectionResetError, BrokenPipeError):
        connection.close()
        return None


def main() -> int:
    """Hand over, and tell what became of the requests.

    Returns:
        0 if none failed.
    """
    parser = argparse.ArgumentParser(prog="python -m scripts.hand_over", description=__doc__)
    parser.add_argument("--times", type=int, default=5, help="how often the service is replaced [%(default)s]")
    parser.add_argument("--apart", type=float, default=2.0, help="seconds between [%(default)s]")
    arguments = parser.parse_args()
    tally = hand_over(read_settings().database, arguments.times, arguments.apart)
    sys.stdout.write(
        f"{arguments.times} services ended by SIGTERM: {tally.answered} requests answered, {tally.sent_again} of them "
        f"sent again, {len(tally.failed)} failed\n"
    )
    sys.stdout.writelines(f"{line}\n" for line in tally.failed[:20])
    return 1 if tally.failed else 0


if __name__ == "__main__":
    sys.exit(main())
