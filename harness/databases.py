"""Databases, empty or migrated, of either kind."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from itertools import count
from pathlib import Path
from typing import Protocol

from harness.postgresql_server import PostgresqlServer
from threadstate.library.engine import writing
from threadstate.tables import metadata
from worker.migrate import migrate

SQLITE = "sqlite"
POSTGRESQL = "postgresql"
KINDS = (SQLITE, POSTGRESQL)


class Databases(Protocol):
    """Makes databases."""

    def new(self) -> str:
        """The URL of a database without a schema; a SQLite file is not there yet."""

    def migrated(self) -> str:
        """The URL of a database with the schema and nothing in it; made through the migrations, as a user's is."""

    def lent(self) -> AbstractContextManager[str]:
        """As ``migrated``, of a database that is another's afterwards; its schema is to be left as it is."""


class SqliteDatabases:
    """Files in a folder."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._numbers = count()
        self._template: Path | None = None

    def new(self) -> str:
        """The URL of a file that does not exist, in a folder of its own."""
        return f"sqlite:///{self._new_path()}"

    def migrated(self) -> str:
        """The URL of a copy of a migrated file."""
        if self._template is None:
            template = self._new_path()
            _migrate(f"sqlite:///{template}")
            self._template = template
        path = self._new_path()
        shutil.copy(self._template, path)
        return f"sqlite:///{path}"

    @contextmanager
    def lent(self) -> Iterator[str]:
        """The URL of a copy of a migrated file."""
        yield self.migrated()

    def _new_path(self) -> Path:
        folder = self._folder / str(next(self._numbers))
        folder.mkdir()
        return folder / "threads.sqlite3"


class PostgresqlDatabases:
    """Databases of a server."""

    def __init__(self, server: PostgresqlServer) -> None:
        self._server = server
        self._numbers = count()
        self._template: str | None = None
        self._free: list[str] = []

    def new(self) -> str:
        """The URL of an empty database."""
        return self._server.url(self._create("template0"))

    def migrated(self) -> str:
        """The URL of a copy of a migrated database."""
        if self._template is None:
            template = self._create("template0")
            _migrate(self._server.url(template))
            self._template = template
        return self._server.url(self._create(self._template))

    @contextmanager
    def lent(self) -> Iterator[str]:
        """The URL of a migrated database, which is emptied afterwards: that takes a tenth of the time of a new one."""
        url = self._free.pop() if self._free else self.migrated()
        yield url
        with writing(url) as engine, engine.begin() as connection:
            tables = ", ".join(metadata.tables)
            connection.exec_driver_sql(f"TRUNCATE {tables} RESTART IDENTITY")
        self._free.append(url)

    def _create(self, template: str) -> str:
        name = f"threads_{next(self._numbers)}"
        self._server.execute(f"CREATE DATABASE {name} TEMPLATE {template}")
        return name


def _migrate(url: str) -> None:
    with writing(url) as engine:
        migrate(engine)
