from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from sqlalchemy import text
from sqlalchemy.exc import DBAPIError, SQLAlchemyError
from sqlalchemy.exc import TimeoutError as NoConnectionError

from harness.databases import Databases
from threadstate.library.database_errors import DatabaseFailure, database_failure
from threadstate.library.engine import reading, writing


def error_of(act: Callable[[], object]) -> DBAPIError:
    with pytest.raises(DBAPIError) as caught:
        act()
    return caught.value


def test_a_table_that_is_missing_is_nothing_particular(databases: Databases) -> None:
    with writing(databases.migrated()) as engine, engine.connect() as connection:
        assert (
            database_failure(error_of(lambda: connection.execute(text("SELECT * FROM nothing"))))
            is DatabaseFailure.OTHER
        )


def test_a_server_that_is_not_there_is_away(tmp_path: Path) -> None:
    with reading(f"postgresql+psycopg://somebody@/threads?host={tmp_path}") as engine:
        assert database_failure(error_of(engine.connect)) is DatabaseFailure.UNREACHABLE


@pytest.mark.postgresql_alone
def test_a_lock_that_another_has_is_held(databases: Databases) -> None:
    database = databases.migrated()
    lock = text("LOCK TABLE job IN ACCESS EXCLUSIVE MODE NOWAIT")
    with writing(database) as engine, engine.begin() as one, engine.begin() as other:
        one.execute(lock)
        assert database_failure(error_of(lambda: other.execute(lock))) is DatabaseFailure.LOCKED


def test_a_file_that_is_missing_is_away(tmp_path: Path) -> None:
    with reading(f"sqlite:///{tmp_path / 'none.sqlite3'}") as engine:
        assert database_failure(error_of(engine.connect)) is DatabaseFailure.UNREACHABLE


def test_an_error_that_is_no_database_s_is_nothing_particular() -> None:
    assert database_failure(NoConnectionError()) is DatabaseFailure.OTHER
    assert database_failure(SQLAlchemyError()) is DatabaseFailure.OTHER
