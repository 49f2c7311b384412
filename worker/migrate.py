"""Migrating a database to the newest revision: its schema, and the data that older libraries lack."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Engine

from threadstate.library.advisory_locks import WriterLock, take_lock
from threadstate.library.schema import SCHEMA_REVISION, check_schema, stored_revision
from threadstate.library.states_json import fill_states_json, orientations_without_json
from threadstate.stored_histories.falls import add_falls, orientations_without_falls
from threadstate.stored_histories.statics import fill_statics, orientations_without_statics
from worker.progress import with_progress


@dataclass(frozen=True)
class Migration:
    """The schema's revision before and after; ``before`` is None for an empty database.

    ``completed`` is the number of orientations whose falls were added.
    """

    before: str | None
    after: str
    completed: int


def migrate(engine: Engine) -> Migration:
    """Run all missing migrations in one transaction; then add missing data, one orientation after another.

    An interrupted call is resumed by the next one.

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
    """Create the schema of an empty database; check that of any other.

    Raises:
        SchemaError: the database is at another revision.
    """
    if stored_revision(engine) is None:
        _upgrade(engine)
    check_schema(engine)


def _complete(engine: Engine) -> int:
    """Add missing data with progress bars on stderr.

    Returns:
        The number of orientations whose falls were added.
    """
    incomplete = orientations_without_falls(engine)
    without_statics = orientations_without_statics(engine)
    without_json = orientations_without_json(engine)
    if incomplete:
        _exhaust(with_progress(add_falls(engine, incomplete), "descents", len(incomplete)))
    if without_statics:
        _exhaust(with_progress(fill_statics(engine, without_statics), "statics", len(without_statics)))
    if without_json:
        _exhaust(with_progress(fill_states_json(engine, without_json), "states as JSON", len(without_json)))
    return len(incomplete)


def _exhaust(steps: Iterable[object]) -> None:
    for _ in steps:
        pass


def _upgrade(engine: Engine) -> None:
    # Imported late: alembic takes half a second, and a migrated database does not need it.
    from alembic import command
    from alembic.config import Config

    import migrations

    config = Config()
    config.set_main_option("script_location", str(Path(migrations.__file__).parent).replace("%", "%%"))
    with engine.begin() as connection:
        take_lock(connection, WriterLock.MIGRATE)
        config.attributes["connection"] = connection
        command.upgrade(config, SCHEMA_REVISION)
