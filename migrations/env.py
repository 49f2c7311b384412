"""Alembic's entry: runs the migrations on the connection that the caller hands over, or on the settings' database."""

from __future__ import annotations

from alembic import context
from sqlalchemy import Connection

from threadstate.library.engine import writer_engine
from threadstate.settings import read_settings
from threadstate.tables import metadata


def _run(connection: Connection) -> None:
    # SQLite can roll back DDL; Alembic does not assume it.
    context.configure(connection=connection, target_metadata=metadata, transactional_ddl=True)
    with context.begin_transaction():
        context.run_migrations()


def _migrate() -> None:
    connection = context.config.attributes.get("connection")
    if connection is not None:
        _run(connection)
        return
    with writer_engine(read_settings().database).begin() as own:
        _run(own)


_migrate()
