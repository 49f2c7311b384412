"""A cache of the libraries that names in paths mean, so that most requests need no query.

On SQLite the cache is valid as long as ``PRAGMA data_version`` has not changed, which another connection's commit does;
it is read once for all requests of one iteration of the event loop. On PostgreSQL names are cached for a second.
"""

from __future__ import annotations

import asyncio
import sqlite3
import time
from dataclasses import dataclass
from typing import Any

from fastapi.concurrency import run_in_threadpool
from sqlalchemy import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

from service.libraries.requested import identified_library
from threadstate.errors import NotFoundError
from threadstate.library.address import is_sqlite
from threadstate.library.read import LibraryRecord

LONGEST_AGE_S = 1.0
"""How long names are cached on PostgreSQL."""
MOST_NAMES = 1024


@dataclass(frozen=True)
class _Seen:
    """A version of the database: SQLite's ``data_version``, or a time of the monotonic clock."""

    value: float


class LibraryNames:
    """The cached libraries of a database, by the names of requests."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._counting = is_sqlite(engine.url)
        self._watch: Connection | None = None
        self._cursor: Any = None
        self._seen: _Seen | None = None
        self._asked = False
        self._known: dict[str, LibraryRecord] = {}

    def known(self, name: str) -> LibraryRecord | None:
        """The cached library of a name; None if it is not cached or the cache is outdated. Does not block.

        Must be called in the event loop.
        """
        if self._counting:
            if not self._asked and self._commits() != self._seen:
                return None
            self._trust_until_next_turn()
        elif self._seen is None or time.monotonic() - self._seen.value > LONGEST_AGE_S:
            return None
        return self._known.get(name)

    async def look_up(self, name: str) -> LibraryRecord | None:
        """The library of a name, read from the database; None if it does not exist or the database cannot be read."""
        seen = self._commits() if self._counting else _Seen(time.monotonic())
        try:
            found = await run_in_threadpool(self._ask, name)
        except (NotFoundError, SQLAlchemyError):
            return None
        # Not cached if another connection has committed meanwhile, which may have published a library.
        if seen is not None and (not self._counting or seen == self._commits()):
            self._remember(seen, name, found)
        return found

    def close(self) -> None:
        """Close the connection that reads ``data_version``."""
        if self._watch is not None:
            self._watch.close()
            self._watch = self._cursor = None

    def _trust_until_next_turn(self) -> None:
        """Consider the cache valid for the rest of this iteration of the event loop, whose requests came before the
        read.
        """
        if not self._asked:
            self._asked = True
            asyncio.get_running_loop().call_soon(self._ask_again)

    def _ask_again(self) -> None:
        self._asked = False

    def _remember(self, seen: _Seen, name: str, found: LibraryRecord) -> None:
        outdated = self._seen is None or (
            self._seen != seen if self._counting else seen.value - self._seen.value > LONGEST_AGE_S
        )
        if outdated or len(self._known) >= MOST_NAMES:
            self._known.clear()
            self._seen = seen
        self._known[name] = found

    def _ask(self, name: str) -> LibraryRecord:
        with self._engine.connect() as connection:
            return identified_library(connection, name)

    def _commits(self) -> _Seen | None:
        """SQLite's ``data_version``; None if it cannot be read now."""
        try:
            if self._cursor is None:
                self._watch = self._engine.connect()
                self._cursor = self._watch.connection.cursor()
                # Never wait for a lock here, as the event loop would wait too.
                self._cursor.execute("PRAGMA busy_timeout = 0")
            return _Seen(self._cursor.execute("PRAGMA data_version").fetchone()[0])
        except (SQLAlchemyError, sqlite3.Error):
            return None
