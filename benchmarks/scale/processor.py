"""Processor time of this process and of the server's that works for it: what else the machine does is not in it."""

from __future__ import annotations

import time
from pathlib import Path

from sqlalchemy import Connection, Engine, text

from threadstate.library.address import is_sqlite

NANOSECONDS = 1e9


class Stopwatch:
    """Seconds of processor time since it was made, on this side and, of PostgreSQL on this machine, on the other.

    The server has a process for each connection.
    """

    def __init__(self, connection: Connection) -> None:
        self._server: Path | None = None
        if not is_sqlite(connection.engine.url):
            process = connection.scalar(text("SELECT pg_backend_pid()"))
            self._server = Path(f"/proc/{process}/schedstat")
        self._began_s = self._now_s()

    @classmethod
    def on(cls, engine: Engine) -> Stopwatch:
        """One of an engine whose connections are used one after the other, so that they are one."""
        with engine.connect() as connection:
            return cls(connection)

    @property
    def sides_s(self) -> tuple[float, float]:
        """Here, and there."""
        here, there = self._now_s()
        return here - self._began_s[0], there - self._began_s[1]

    @property
    def seconds(self) -> float:
        """Both."""
        return sum(self.sides_s)

    def _now_s(self) -> tuple[float, float]:
        server_s = 0.0 if self._server is None else int(self._server.read_text().split()[0]) / NANOSECONDS
        return time.process_time(), server_s
