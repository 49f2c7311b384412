from __future__ import annotations

from pathlib import Path

import pytest

from threadstate.errors import InvalidValueError
from threadstate.library.address import database_url, masked_url
from threadstate.library.engine import reader_engine, writer_engine
from threadstate.settings import DATABASE_PASSWORD_FILE


@pytest.mark.parametrize(
    "database",
    [
        "",
        "threads.sqlite3",
        "sqlite://",
        "sqlite:///:memory:",
        "sqlite:///x?mode=ro",
        "postgresql://host",
        "postgresql+asyncpg://host/name",
        "mysql://host/name",
    ],
)
def test_what_is_neither_database_is_refused(database: str) -> None:
    with pytest.raises(InvalidValueError, match="database is"):
        database_url(database)


@pytest.mark.parametrize("scheme", ["postgresql", "postgresql+psycopg"])
def test_an_address_of_postgresql_names_its_driver_and_keeps_the_rest(scheme: str) -> None:
    url = database_url(f"{scheme}://somebody:secret@host:5433/threads?sslmode=require")
    assert url.render_as_string(hide_password=False) == (
        "postgresql+psycopg://somebody:secret@host:5433/threads?sslmode=require"
    )
    assert "secret" not in masked_url(url)


@pytest.mark.parametrize("database", ["mysql://user:secret@host/name", "postgresql:/user:secret@host/name"])
def test_a_password_in_a_refused_address_is_not_repeated(database: str) -> None:
    with pytest.raises(InvalidValueError) as caught:
        database_url(database)
    assert "secret" not in str(caught.value)


@pytest.mark.parametrize(("address", "password"), [("user@host", "from file"), ("user:in-url@host", "in-url")])
def test_postgresql_takes_a_files_password_where_the_address_has_none(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, address: str, password: str
) -> None:
    (tmp_path / "password").write_text("from file\n")
    monkeypatch.setenv(DATABASE_PASSWORD_FILE, str(tmp_path / "password"))
    for engine in (writer_engine(f"postgresql://{address}/threads"), reader_engine(f"postgresql://{address}/threads")):
        assert engine.url.password == password
        assert password not in repr(engine)
