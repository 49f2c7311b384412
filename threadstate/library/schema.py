"""Checks of the database's schema revision."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import unquote

from sqlalchemy import Engine, text
from sqlalchemy.exc import DatabaseError

from threadstate.errors import SchemaError, UnreadableDatabaseError
from threadstate.library.address import is_sqlite, masked_url
from threadstate.settings import DATABASE

SCHEMA_REVISION = "0012"
"""The newest migration; the tables of ``threadstate.library.tables`` match it."""

MIGRATE_COMMAND = "threadstate migrate"

_UNDEFINED_TABLE = "42P01"
"""PostgreSQL's code of an undefined table."""


def stored_revision(engine: Engine) -> str | None:
    """The revision of the database's schema; None if the SQLite file does not exist or the database is empty.

    Raises:
        UnreadableDatabaseError: the database cannot be read: the file is not a database, or the server does not answer.
    """
    try:
        with engine.connect() as connection:
            return connection.scalar(text("SELECT version_num FROM alembic_version"))
    except DatabaseError as error:
        reason = str(error.orig)
        missing = ("no such table", "unable to open database file") if is_sqlite(engine.url) else ()
        if getattr(error.orig, "sqlstate", None) == _UNDEFINED_TABLE or any(words in reason for words in missing):
            return None
        raise UnreadableDatabaseError(f"database {location(engine)} cannot be read: {reason}") from error


def check_schema(engine: Engine) -> None:
    """Check at start-up that the database is migrated.

    Raises:
        SchemaError: it is not, or its file does not exist; the message names the command to run.
    """
    revision = stored_revision(engine)
    if revision == SCHEMA_REVISION:
        return
    if is_sqlite(engine.url) and not Path(location(engine)).exists():
        raise SchemaError(
            f"database file {location(engine)} does not exist; --database or {DATABASE} says which file it is "
            "(`threadstate settings` shows it), `threadstate rebuild` makes it"
        )
    if revision is None:
        found, remedy = "has no schema yet", f"run `{MIGRATE_COMMAND}`"
    elif revision < SCHEMA_REVISION:
        found, remedy = f"is at schema revision {revision}", f"run `{MIGRATE_COMMAND}`"
    else:
        found, remedy = f"is at schema revision {revision}, of a newer threadstate", "install that one"
    raise SchemaError(f"database {location(engine)} {found}; this code needs revision {SCHEMA_REVISION}: {remedy}")


def location(engine: Engine) -> str:
    """The location of an engine's database, for messages: a file, or an address without password."""
    if not is_sqlite(engine.url):
        return masked_url(engine.url.set(query={}))
    # The engine of a reader has a URI.
    name = str(engine.url.database)
    return unquote(name.removeprefix("file:")) if name.startswith("file:") else name
