"""Databases for tests: empty or migrated, of either kind."""

from __future__ import annotations

import shutil
from itertools import count
from pathlib import Path
from typing import Protocol

from tests.postgresql_server import PostgresqlServer
from threadstate.library.engine import writer_engine
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

    def _create(self, template: str) -> str:
        name = f"threads_{next(self._numbers)}"
        self._server.execute(f"CREATE DATABASE {name} TEMPLATE {template}")
        return name


def _migrate(url: str) -> None:
    engine = writer_engine(url)
    migrate(engine)
    engine.dispose()
