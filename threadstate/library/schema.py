"""Whether a database has the schema that this code expects."""

from __future__ import annotations

from urllib.parse import unquote

from sqlalchemy import Engine, text
from sqlalchemy.exc import DatabaseError

from threadstate.errors import SchemaError

SCHEMA_REVISION = "0004"
"""The newest migration, which the tables of ``threadstate.library.tables`` mirror."""

MENDING_COMMAND = "threadstate migrate"


def stored_revision(engine: Engine) -> str | None:
    """The revision of the database's schema; None where the file, or everything in it, is missing.

    Raises:
        SchemaError: the file is no database.
    """
    try:
        with engine.connect() as connection:
            return connection.scalar(text("SELECT version_num FROM alembic_version"))
    except DatabaseError as error:
        reason = str(error.orig)
        if "no such table" in reason or "unable to open database file" in reason:
            return None
        raise SchemaError(f"database {_file(engine)} cannot be read: {reason}") from None


def check_schema(engine: Engine) -> None:
    """Check at start-up that the database is migrated.

    Raises:
        SchemaError: it is not; the message names what mends it.
    """
    revision = stored_revision(engine)
    if revision == SCHEMA_REVISION:
        return
    if revision is None:
        found, cure = "has no schema yet", f"run `{MENDING_COMMAND}`"
    elif revision < SCHEMA_REVISION:
        found, cure = f"is at schema revision {revision}", f"run `{MENDING_COMMAND}`"
    else:
        found, cure = f"is at schema revision {revision}, of a newer threadstate", "install that one"
    raise SchemaError(f"database {_file(engine)} {found}; this code needs revision {SCHEMA_REVISION}: {cure}")


def _file(engine: Engine) -> str:
    """The database's file; a reader's engine has it as a URI."""
    name = str(engine.url.database)
    return unquote(name.removeprefix("file:")) if name.startswith("file:") else name
