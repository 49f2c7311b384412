"""Bringing a database's schema to the newest revision."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Engine

from threadstate.library.schema import SCHEMA_REVISION, check_schema, stored_revision
from threadstate.library.turns import Turn, take_turn


@dataclass(frozen=True)
class Migration:
    """The schema's revision before and after; ``before`` is None for an empty database."""

    before: str | None
    after: str


def migrate(engine: Engine) -> Migration:
    """Run all migrations that the database lacks, in one transaction.

    Raises:
        SchemaError: the database is at a revision that this code does not know.
    """
    before = stored_revision(engine)
    if before is not None and before > SCHEMA_REVISION:
        check_schema(engine)
    if before != SCHEMA_REVISION:
        _upgrade(engine)
    return Migration(before, SCHEMA_REVISION)


def migrate_empty(engine: Engine) -> None:
    """Make the schema where there is none, and check the one that there is.

    Raises:
        SchemaError: the database is at another revision.
    """
    if stored_revision(engine) is None:
        _upgrade(engine)
    check_schema(engine)


def _upgrade(engine: Engine) -> None:
    # Alembic takes half a second to import; a database that needs nothing is not to wait for it.
    from alembic import command
    from alembic.config import Config

    import migrations

    config = Config()
    config.set_main_option("script_location", str(Path(migrations.__file__).parent).replace("%", "%%"))
    with engine.begin() as connection:
        take_turn(connection, Turn.MIGRATE)
        config.attributes["connection"] = connection
        command.upgrade(config, SCHEMA_REVISION)
