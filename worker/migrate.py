"""Bringing a database to the newest revision: its schema, and what older libraries lack."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Engine

from threadstate.library.advisory_locks import WriterLock, take_lock
from threadstate.library.schema import SCHEMA_REVISION, check_schema, stored_revision
from threadstate.library.states_json import fill_states_json, orientations_without_json
from threadstate.stored_histories.falls import add_falls, orientations_without_falls
from worker.progress import followed


@dataclass(frozen=True)
class Migration:
    """The schema's revision before and after; ``before`` is None for an empty database.

    ``completed`` is of how many orientations the falls were added to a stored history.
    """

    before: str | None
    after: str
    completed: int


def migrate(engine: Engine) -> Migration:
    """Run all migrations that the database lacks, in one transaction; then add what stored histories lack, one by one.

    Stopped on its way, the next call goes on.

    Raises:
        SchemaError: the database is at a revision that this code does not know.
    """
    before = stored_revision(engine)
    if before is not None and before > SCHEMA_REVISION:
        check_schema(engine)
    if before != SCHEMA_REVISION:
        _upgrade(engine)
    return Migration(before, SCHEMA_REVISION, 0 if before is None else _complete(engine))


def migrate_empty(engine: Engine) -> None:
    """Make the schema where there is none, and check the one that there is.

    Raises:
        SchemaError: the database is at another revision.
    """
    if stored_revision(engine) is None:
        _upgrade(engine)
    check_schema(engine)


def _complete(engine: Engine) -> int:
    """Add to what is stored what it lacks, with progress bars on stderr; to how many orientations falls were added."""
    incomplete = orientations_without_falls(engine)
    without_json = orientations_without_json(engine)
    if incomplete:
        _exhaust(followed(add_falls(engine, incomplete), "descents", len(incomplete)))
    if without_json:
        _exhaust(followed(fill_states_json(engine, without_json), "states as JSON", len(without_json)))
    return len(incomplete)


def _exhaust(steps: Iterable[object]) -> None:
    for _ in steps:
        pass


def _upgrade(engine: Engine) -> None:
    # Alembic takes half a second to import; a database that needs nothing is not to wait for it.
    from alembic import command
    from alembic.config import Config

    import migrations

    config = Config()
    config.set_main_option("script_location", str(Path(migrations.__file__).parent).replace("%", "%%"))
    with engine.begin() as connection:
        take_lock(connection, WriterLock.MIGRATE)
        config.attributes["connection"] = connection
        command.upgrade(config, SCHEMA_REVISION)
