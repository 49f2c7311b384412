from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from alembic import command
from alembic.config import Config
from alembic.script import ScriptDirectory
from sqlalchemy import Engine, inspect, text

import migrations
from threadstate.errors import InvalidValueError, SchemaError
from threadstate.library.engine import reader_engine, writer_engine
from threadstate.library.schema import MENDING_COMMAND, SCHEMA_REVISION, check_schema, stored_revision
from threadstate.library.tables import metadata
from worker.migrate import migrate


@pytest.fixture
def empty(tmp_path: Path) -> Iterator[Engine]:
    engine = writer_engine(f"sqlite:///{tmp_path / 'other.sqlite3'}")
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
    with engine.connect() as connection:
        tables = connection.execute(text("SELECT name, wr FROM pragma_table_list"))
        without_rowid = {name: bool(wr) for name, wr in tables}
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
            without_rowid[table],
        )
    return schema


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


def test_a_migration_that_fails_leaves_nothing_behind(empty: Engine) -> None:
    with empty.begin() as connection:
        connection.execute(text("CREATE TABLE state_flag (something INTEGER)"))
    with pytest.raises(Exception, match="state_flag already exists"):
        migrate(empty)
    assert inspect(empty).get_table_names() == ["state_flag"]


def test_an_empty_database_names_the_command_that_mends_it(empty: Engine) -> None:
    with pytest.raises(SchemaError, match=f"has no schema yet.*{MENDING_COMMAND}"):
        check_schema(empty)


@pytest.mark.parametrize(("revision", "cure"), [("0000", MENDING_COMMAND), ("9999", "newer threadstate")])
def test_another_revision_names_its_cure(writer: Engine, revision: str, cure: str) -> None:
    with writer.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = :revision"), {"revision": revision})
    with pytest.raises(SchemaError, match=f"revision {revision}.*{cure}"):
        check_schema(writer)


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


@pytest.mark.parametrize(
    "database",
    ["", "threads.sqlite3", "sqlite://", "sqlite:///:memory:", "postgresql://host/name", "sqlite:///x?mode=ro"],
)
def test_what_is_no_sqlite_file_is_refused(database: str) -> None:
    with pytest.raises(InvalidValueError, match="database is"):
        reader_engine(database)


def test_a_password_in_a_refused_address_is_not_repeated() -> None:
    with pytest.raises(InvalidValueError) as caught:
        writer_engine("postgresql://user:secret@host/name")
    assert "secret" not in str(caught.value)


def test_every_table_is_documented(repository_root: Path) -> None:
    text = (repository_root / "docs" / "library.md").read_text()
    assert {line.split("`")[1] for line in text.splitlines() if line.startswith("| `")} == set(metadata.tables)
