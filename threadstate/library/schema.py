"""Whether a database has the schema that this code expects."""

from __future__ import annotations

from urllib.parse import unquote

from sqlalchemy import Engine, text
from sqlalchemy.exc import OperationalError

from threadstate.errors import SchemaError

SCHEMA_REVISION = "0001"
"""The newest migration, which the tables of ``threadstate.library.tables`` mirror."""

MENDING_COMMAND = "threadstate migrate"


def stored_revision(engine: Engine) -> str | None:
    """The revision of the database's schema; None where the file, or everything in it, is missing."""
    try:
        with engine.connect() as connection:
            return connection.execute(text("SELECT version_num FROM alembic_version")).scalar_one_or_none()
    except OperationalError as error:
        reason = str(error.orig)
        if "no such table" in reason or "unable to open database file" in reason:
            return None
        raise SchemaError(f"database {_file(engine)} cannot be read: {reason}") from None


def check_schema(engine: Engine) -> None:
    """Check at start-up that the database is migrated.

    Raises:
        SchemaError: it is not; the message names the command that mends it.
    """
    revision = stored_revision(engine)
    if revision != SCHEMA_REVISION:
        found = "has no schema yet" if revision is None else f"is at schema revision {revision}"
        raise SchemaError(
            f"database {_file(engine)} {found}, this code needs {SCHEMA_REVISION}; run `{MENDING_COMMAND}`"
        )


def _file(engine: Engine) -> str:
    """The database's file; a reader's engine has it as a URI."""
    name = str(engine.url.database)
    return unquote(name.removeprefix("file:")) if name.startswith("file:") else name
