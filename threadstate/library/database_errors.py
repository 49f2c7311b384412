"""Failures of a database by kind, described without the addresses and statements of the driver's message."""

from __future__ import annotations

import sqlite3
from enum import StrEnum

from sqlalchemy.exc import DBAPIError, SQLAlchemyError


class DatabaseFailure(StrEnum):
    """Why the database failed; nothing was changed, and a retry may succeed."""

    LOCKED = "another process holds the database"
    FULL = "no room is left where the database is"
    UNREACHABLE = "the database does not answer"
    OTHER = "the database cannot be read or written"


_SQLITE = {
    sqlite3.SQLITE_BUSY: DatabaseFailure.LOCKED,
    sqlite3.SQLITE_LOCKED: DatabaseFailure.LOCKED,
    sqlite3.SQLITE_FULL: DatabaseFailure.FULL,
    sqlite3.SQLITE_CANTOPEN: DatabaseFailure.UNREACHABLE,
}
"""By SQLite's primary result code: the last byte of the extended one."""
_POSTGRESQL = {
    "55P03": DatabaseFailure.LOCKED,
    "40P01": DatabaseFailure.LOCKED,
    "40001": DatabaseFailure.LOCKED,
    "53100": DatabaseFailure.FULL,
    "53300": DatabaseFailure.UNREACHABLE,
    "57P01": DatabaseFailure.UNREACHABLE,
    "57P02": DatabaseFailure.UNREACHABLE,
    "57P03": DatabaseFailure.UNREACHABLE,
}


def database_failure(error: SQLAlchemyError) -> DatabaseFailure:
    """The kind of failure behind an error of SQLAlchemy."""
    cause = error.orig if isinstance(error, DBAPIError) else None
    if isinstance(cause, sqlite3.Error):
        return _SQLITE.get(getattr(cause, "sqlite_errorcode", -1) & 0xFF, DatabaseFailure.OTHER)
    state = getattr(cause, "sqlstate", "")
    if state is None:
        # The connection failed before the server answered.
        return DatabaseFailure.UNREACHABLE
    return _POSTGRESQL.get(state, DatabaseFailure.OTHER)
