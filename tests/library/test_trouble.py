from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from sqlalchemy import text
from sqlalchemy.exc import DBAPIError, SQLAlchemyError
from sqlalchemy.exc import TimeoutError as NoConnectionError

from harness.databases import Databases
from threadstate.library.engine import reading, writing
from threadstate.library.trouble import Trouble, trouble_of


def error_of(act: Callable[[], object]) -> DBAPIError:
    with pytest.raises(DBAPIError) as caught:
        act()
    return caught.value


def test_a_table_that_is_missing_is_nothing_particular(databases: Databases) -> None:
    with writing(databases.migrated()) as engine, engine.connect() as connection:
        assert trouble_of(error_of(lambda: connection.execute(text("SELECT * FROM nothing")))) is Trouble.OTHER


def test_a_server_that_is_not_there_is_away(tmp_path: Path) -> None:
    with reading(f"postgresql+psycopg://somebody@/threads?host={tmp_path}") as engine:
        assert trouble_of(error_of(engine.connect)) is Trouble.AWAY


@pytest.mark.postgresql_alone
def test_a_lock_that_another_has_is_held(databases: Databases) -> None:
    database = databases.migrated()
    lock = text("LOCK TABLE job IN ACCESS EXCLUSIVE MODE NOWAIT")
    with writing(database) as engine, engine.begin() as one, engine.begin() as other:
        one.execute(lock)
        assert trouble_of(error_of(lambda: other.execute(lock))) is Trouble.HELD


def test_a_file_that_is_missing_is_away(tmp_path: Path) -> None:
    with reading(f"sqlite:///{tmp_path / 'none.sqlite3'}") as engine:
        assert trouble_of(error_of(engine.connect)) is Trouble.AWAY


def test_an_error_that_is_no_database_s_is_nothing_particular() -> None:
    assert trouble_of(NoConnectionError()) is Trouble.OTHER
    assert trouble_of(SQLAlchemyError()) is Trouble.OTHER
