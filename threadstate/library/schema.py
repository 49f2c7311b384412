"""Whether a database has the schema that this code expects."""

from __future__ import annotations

from pathlib import Path
from urllib.parse import unquote

from sqlalchemy import Engine, text
from sqlalchemy.exc import DatabaseError

from threadstate.errors import SchemaError, UnreadableDatabaseError
from threadstate.library.address import is_sqlite, shown
from threadstate.settings import DATABASE

SCHEMA_REVISION = "0008"
"""The newest migration, which the tables of ``threadstate.library.tables`` mirror."""

MIGRATE_COMMAND = "threadstate migrate"

_UNDEFINED_TABLE = "42P01"
"""PostgreSQL's code of a table that is not there."""


def stored_revision(engine: Engine) -> str | None:
    """The revision of the database's schema; None where a SQLite file, or everything in the database, is missing.

    Raises:
        UnreadableDatabaseError: the database cannot be read, as a file that is none or a server that does not answer.
    """
    try:
        with engine.connect() as connection:
            return connection.scalar(text("SELECT version_num FROM alembic_version"))
    except DatabaseError as error:
        reason = str(error.orig)
        missing = ("no such table", "unable to open database file") if is_sqlite(engine.url) else ()
        if getattr(error.orig, "sqlstate", None) == _UNDEFINED_TABLE or any(words in reason for words in missing):
            return None
        raise UnreadableDatabaseError(f"database {place(engine)} cannot be read: {reason}") from error


def check_schema(engine: Engine) -> None:
    """Check at start-up that the database is migrated.

    Raises:
        SchemaError: it is not, or its file does not exist; the message names what mends it.
    """
    revision = stored_revision(engine)
    if revision == SCHEMA_REVISION:
        return
    if is_sqlite(engine.url) and not Path(place(engine)).exists():
        raise SchemaError(
            f"database file {place(engine)} does not exist; --database or {DATABASE} says which file it is "
            "(`threadstate settings` shows it), `threadstate rebuild` makes it"
        )
    if revision is None:
        found, cure = "has no schema yet", f"run `{MIGRATE_COMMAND}`"
    elif revision < SCHEMA_REVISION:
        found, cure = f"is at schema revision {revision}", f"run `{MIGRATE_COMMAND}`"
    else:
        found, cure = f"is at schema revision {revision}, of a newer threadstate", "install that one"
    raise SchemaError(f"database {place(engine)} {found}; this code needs revision {SCHEMA_REVISION}: {cure}")


def place(engine: Engine) -> str:
    """Where an engine's database is, for people: a file, or an address without password."""
    if not is_sqlite(engine.url):
        return shown(engine.url.set(query={}))
    # A reader's engine has the file as a URI.
    name = str(engine.url.database)
    return unquote(name.removeprefix("file:")) if name.startswith("file:") else name
