"""What ails a database that fails, in words and without what its driver tells of addresses and statements."""

from __future__ import annotations

import sqlite3
from enum import StrEnum

from sqlalchemy.exc import DBAPIError, SQLAlchemyError


class Trouble(StrEnum):
    """What ails a database; nothing was changed, and asking again later may succeed."""

    HELD = "another process holds the database"
    FULL = "no room is left where the database is"
    AWAY = "the database does not answer"
    OTHER = "the database cannot be read or written"


_SQLITE = {
    sqlite3.SQLITE_BUSY: Trouble.HELD,
    sqlite3.SQLITE_LOCKED: Trouble.HELD,
    sqlite3.SQLITE_FULL: Trouble.FULL,
    sqlite3.SQLITE_CANTOPEN: Trouble.AWAY,
}
"""By the last byte of SQLite's code, which is the kind without its particulars."""
_POSTGRESQL = {
    "55P03": Trouble.HELD,
    "40P01": Trouble.HELD,
    "40001": Trouble.HELD,
    "53100": Trouble.FULL,
    "53300": Trouble.AWAY,
    "57P01": Trouble.AWAY,
    "57P02": Trouble.AWAY,
    "57P03": Trouble.AWAY,
}


def trouble_of(error: SQLAlchemyError) -> Trouble:
    """What an error of the database comes from."""
    cause = error.orig if isinstance(error, DBAPIError) else None
    if isinstance(cause, sqlite3.Error):
        return _SQLITE.get(getattr(cause, "sqlite_errorcode", -1) & 0xFF, Trouble.OTHER)
    state = getattr(cause, "sqlstate", "")
    if state is None:
        # The server did not get so far as to say anything.
        return Trouble.AWAY
    return _POSTGRESQL.get(state, Trouble.OTHER)
