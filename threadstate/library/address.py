"""The address of a database: a SQLite file's or a PostgreSQL database's."""

from __future__ import annotations

from pathlib import Path

from sqlalchemy import URL, make_url
from sqlalchemy.exc import ArgumentError

from threadstate.errors import InvalidValueError

SQLITE = "sqlite"
POSTGRESQL = "postgresql"
POSTGRESQL_DRIVER = "postgresql+psycopg"

_VALID = (
    "a SQLite file's URL, such as sqlite:////absolute/path/threadstate.sqlite3, or a PostgreSQL database's, such as "
    f"{POSTGRESQL_DRIVER}://user@host/name"
)


def database_url(database: str) -> URL:
    """The database's address, checked; PostgreSQL's with the driver's name.

    Raises:
        InvalidValueError: it is not the URL of a SQLite file or a PostgreSQL database.
    """
    try:
        url = make_url(database)
    except ArgumentError:
        # An invalid URL may still contain a password, between a colon and an at sign.
        raise InvalidValueError("database", "***" if "@" in database else database, _VALID) from None
    if url.drivername == SQLITE and url.database and url.database != ":memory:" and not url.query:
        return url
    if url.drivername in (POSTGRESQL, POSTGRESQL_DRIVER) and url.database:
        return url.set(drivername=POSTGRESQL_DRIVER)
    raise InvalidValueError("database", masked_url(url), _VALID)


def is_sqlite(url: URL) -> bool:
    """Whether the database is a SQLite file."""
    return url.drivername == SQLITE


def sqlite_path(url: URL) -> Path:
    """The file behind a SQLite database's address."""
    return Path(str(url.database))


def masked_url(url: URL) -> str:
    """The address without its password, for messages."""
    return url.render_as_string(hide_password=True)
