from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime
from pathlib import Path
from threading import Barrier

import pytest
from alembic import command
from alembic.config import Config
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, Engine, String, inspect, text
from sqlalchemy.exc import DBAPIError, IntegrityError

import migrations
from harness.databases import Databases
from threadstate.errors import SchemaError
from threadstate.library.engine import reader_engine, reading, writer_engine, writing
from threadstate.library.schema import MIGRATE_COMMAND, SCHEMA_REVISION, check_schema, stored_revision
from threadstate.tables import metadata
from worker.migrate import Migration, migrate

_WINDOW = {"library_id": 1, "orientation": 0, "position": 0}
_HEIGHTS = {"enter_height": 0.0, "leave_height": 0.0, "lowest_height": 0.0}
ROWS_OF_A_COURSE: dict[str, dict[str, object]] = {
    "library": {
        "id": 1,
        "designation": "M6",
        "length_unit": "mm",
        "input_sha256": "a",
        "pair": "{}",
        "method": "exact",
        "options": "{}",
        "code_version": "0",
        "tilt_max_deg": 0.0,
        "tilt_step_deg": 1.0,
        "phase_step_deg": 360.0,
        "tilt_count": 1,
        "phase_count": 1,
        "state_count": 1,
        "created_at": datetime(2026, 1, 1, tzinfo=UTC),
    },
    "chunk": {
        "library_id": 1,
        "orientation": 0,
        "roll_deg": 0.0,
        "pitch_deg": 0.0,
        "state_count": 1,
        "content_sha256": "a",
    },
    "clearance_window": {**_WINDOW, **_HEIGHTS, "enter_deg": 0.0, "leave_deg": 1.0, "lowest_deg": 0.5},
    "clearance_window_course": {
        **_WINDOW,
        "place": 0,
        "features": "thread-surface",
        "start_deg": 0.0,
        "end_deg": 1.0,
        "start_height": 0.0,
        "end_height": 0.0,
    },
}
"""A library with one stretch of a window on a pair of features of revision 0010."""


@pytest.fixture
def database(databases: Databases) -> str:
    """The URL of a migrated, empty database whose schema may be changed."""
    return databases.migrated()


@pytest.fixture
def empty(databases: Databases) -> Iterator[Engine]:
    engine = writer_engine(databases.new())
    yield engine
    engine.dispose()


def _config(engine: Engine) -> Config:
    config = Config()
    config.set_main_option("script_location", str(Path(migrations.__file__).parent))
    config.attributes["engine"] = engine
    return config


def _schema(engine: Engine) -> dict[str, object]:
    """Everything that the database says of its tables, in an order that does not depend on how they were made."""
    inspector = inspect(engine)
    without_rowid = _without_rowid(engine)
    schema: dict[str, object] = {}
    for table in inspector.get_table_names():
        if table == "alembic_version":
            continue
        schema[table] = (
            [{**column, "type": str(column["type"])} for column in inspector.get_columns(table)],
            inspector.get_pk_constraint(table),
            sorted(inspector.get_foreign_keys(table), key=str),
            sorted(inspector.get_unique_constraints(table), key=str),
            sorted(inspector.get_check_constraints(table), key=str),
            sorted(inspector.get_indexes(table), key=str),
            table in without_rowid,
        )
    return schema


def _without_rowid(engine: Engine) -> set[str]:
    """The tables that SQLite keeps in the order of their primary keys."""
    if engine.dialect.name != "sqlite":
        return set()
    with engine.connect() as connection:
        return set(connection.scalars(text("SELECT name FROM pragma_table_list WHERE wr")))


def test_the_migrated_schema_is_that_of_the_tables(writer: Engine, empty: Engine) -> None:
    metadata.create_all(empty)
    migrated, declared = _schema(writer), _schema(empty)
    assert set(migrated) == {table.name for table in metadata.sorted_tables}
    assert migrated == declared


def test_every_constraint_has_a_name(writer: Engine) -> None:
    inspector = inspect(writer)
    for table in metadata.sorted_tables:
        constraints = [
            inspector.get_pk_constraint(table.name),
            *inspector.get_foreign_keys(table.name),
            *inspector.get_unique_constraints(table.name),
            *inspector.get_check_constraints(table.name),
        ]
        assert all(constraint["name"] for constraint in constraints), table.name


def test_the_revision_that_the_code_expects_is_the_newest(writer: Engine) -> None:
    assert ScriptDirectory.from_config(_config(writer)).get_heads() == [SCHEMA_REVISION]
    assert stored_revision(writer) == SCHEMA_REVISION


def test_migrating_twice_changes_nothing(writer: Engine) -> None:
    before = _schema(writer)
    migration = migrate(writer)
    assert migration.before == migration.after == SCHEMA_REVISION
    assert _schema(writer) == before


def test_downgrading_leaves_nothing_behind(writer: Engine) -> None:
    config = _config(writer)
    with writer.begin() as connection:
        config.attributes["connection"] = connection
        command.downgrade(config, "base")
    assert inspect(writer).get_table_names() == ["alembic_version"]


def test_features_that_came_later_are_taken_after_a_migration_and_go_with_their_library(writer: Engine) -> None:
    config = _config(writer)

    def to(revision: str) -> None:
        with writer.begin() as connection:
            config.attributes["connection"] = connection
            move = command.upgrade if revision == SCHEMA_REVISION else command.downgrade
            move(config, revision)

    def add_course(connection: Connection) -> None:
        for table, values in ROWS_OF_A_COURSE.items():
            connection.execute(metadata.tables[table].insert().values(values))

    before = _schema(writer)
    to("0009")
    with pytest.raises(IntegrityError, match="features_known"), writer.begin() as connection:
        add_course(connection)
    to(SCHEMA_REVISION)
    assert _schema(writer) == before
    with writer.begin() as connection:
        add_course(connection)
    to("0009")
    with writer.connect() as connection:
        assert connection.scalars(text("SELECT id FROM library")).all() == []


def test_a_migration_that_fails_leaves_nothing_behind(empty: Engine) -> None:
    with empty.begin() as connection:
        connection.execute(text("CREATE TABLE state_flag (something INTEGER)"))
    with pytest.raises(DBAPIError, match=r'state_flag"? already exists'):
        migrate(empty)
    assert inspect(empty).get_table_names() == ["state_flag"]


def test_an_empty_database_names_the_command_that_mends_it(empty: Engine) -> None:
    with pytest.raises(SchemaError, match=f"has no schema yet.*{MIGRATE_COMMAND}"):
        check_schema(empty)


@pytest.mark.parametrize(("revision", "cure"), [("0000", MIGRATE_COMMAND), ("9999", "newer threadstate")])
def test_another_revision_names_its_cure(writer: Engine, revision: str, cure: str) -> None:
    with writer.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = :revision"), {"revision": revision})
    with pytest.raises(SchemaError, match=f"revision {revision}.*{cure}"):
        check_schema(writer)


def test_two_migrations_at_once_make_one_schema(databases: Databases) -> None:
    database = databases.new()
    migrations_begin = Barrier(2, timeout=60.0)

    def migrated() -> Migration:
        with writing(database) as engine:
            stored_revision(engine)
            migrations_begin.wait()
            return migrate(engine)

    with ThreadPoolExecutor(2) as pool:
        results = [future.result() for future in [pool.submit(migrated) for _ in range(2)]]
    assert {result.after for result in results} == {SCHEMA_REVISION}
    with reading(database) as engine:
        check_schema(engine)


def test_a_newer_database_is_not_migrated(writer: Engine) -> None:
    with writer.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    with pytest.raises(SchemaError, match="newer threadstate"):
        migrate(writer)


def test_reading_a_missing_database_does_not_make_it(tmp_path: Path) -> None:
    path = tmp_path / "not there %41?#.sqlite3"
    engine = reader_engine(f"sqlite:///{path}".replace("%", "%25").replace("?", "%3F"))
    with pytest.raises(SchemaError, match="not there"):
        check_schema(engine)
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_no_database_is_named(tmp_path: Path) -> None:
    path = tmp_path / "notes.txt"
    path.write_text("not a database, but long enough to be looked at by SQLite " * 20)
    engine = reader_engine(f"sqlite:///{path}")
    with pytest.raises(SchemaError, match=r"notes\.txt cannot be read"):
        check_schema(engine)
    engine.dispose()


def test_a_server_that_does_not_answer_is_named_without_its_password(tmp_path: Path) -> None:
    engine = reader_engine(f"postgresql://somebody:secret@/threads?host={tmp_path}")
    with pytest.raises(SchemaError, match=r"somebody.*/threads cannot be read") as caught:
        check_schema(engine)
    assert "secret" not in str(caught.value)


def test_every_text_of_postgresql_is_compared_byte_by_byte(empty: Engine) -> None:
    metadata.create_all(empty)
    inspector = inspect(empty)
    texts = [
        column["type"]
        for table in metadata.tables
        for column in inspector.get_columns(table)
        if isinstance(column["type"], String)
    ]
    assert len(texts) > 20
    expected = "C" if empty.dialect.name == "postgresql" else None
    assert {text.collation for text in texts} == {expected}


def test_every_table_is_documented(repository_root: Path) -> None:
    documented = [
        line.split("`")[1]
        for name in ("library.md", "jobs.md")
        for line in (repository_root / "docs" / name)
        .read_text()
        .partition("## Tables")[2]
        .partition("\n## ")[0]
        .splitlines()
        if line.startswith("| `")
    ]
    assert sorted(documented) == sorted(metadata.tables)
