"""Which library a name in a path means, known without asking the database at every request.

SQLite says by a number whether anybody else has committed since: a name is right as of the request. It is asked once
for all requests that have come meanwhile. PostgreSQL's names are looked up again after a second.
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

from service.libraries.identify import identified_library
from threadstate.errors import NotFoundError
from threadstate.library.address import is_sqlite
from threadstate.library.read import LibraryRecord

LONGEST_AGE_S = 1.0
"""How old a name may be where the database cannot say whether it has changed."""
MOST_NAMES = 1024


@dataclass(frozen=True)
class _Seen:
    """What was seen of the database: SQLite's count of others' commits, or a time of the steady clock."""

    value: float


class LibraryNames:
    """The libraries of a database by the names under which they are asked for."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._counting = is_sqlite(engine.url)
        self._watch: Connection | None = None
        self._cursor: Any = None
        self._seen: _Seen | None = None
        self._asked = False
        self._known: dict[str, LibraryRecord] = {}

    def known(self, name: str) -> LibraryRecord | None:
        """The library that a name means, if it is known and nothing has changed; does not wait.

        To be called within the service's event loop.
        """
        if self._counting:
            if not self._asked and self._commits() != self._seen:
                return None
            self._trust_until_next_turn()
        elif self._seen is None or time.monotonic() - self._seen.value > LONGEST_AGE_S:
            return None
        return self._known.get(name)

    async def look_up(self, name: str) -> LibraryRecord | None:
        """The library that a name means, by the database; None where there is none, or no database to ask."""
        seen = self._commits() if self._counting else _Seen(time.monotonic())
        try:
            found = await run_in_threadpool(self._ask, name)
        except (NotFoundError, SQLAlchemyError):
            return None
        # Not where another has committed meanwhile: that one may have published.
        if seen is not None and (not self._counting or seen == self._commits()):
            self._remember(seen, name, found)
        return found

    def close(self) -> None:
        """Close the connection that watches."""
        if self._watch is not None:
            self._watch.close()
            self._watch = self._cursor = None

    def _trust_until_next_turn(self) -> None:
        """Take the names for right in what the loop has begun already: it came before the database was asked."""
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
        """SQLite's count, which another's commit changes; None where it cannot be read now."""
        try:
            if self._cursor is None:
                self._watch = self._engine.connect()
                self._cursor = self._watch.connection.cursor()
                # Never wait for a lock here: everything else would wait too.
                self._cursor.execute("PRAGMA busy_timeout = 0")
            return _Seen(self._cursor.execute("PRAGMA data_version").fetchone()[0])
        except (SQLAlchemyError, sqlite3.Error):
            return None
