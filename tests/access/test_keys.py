from __future__ import annotations

from collections.abc import Iterator

import pytest
from sqlalchemy import Engine, select

from harness.databases import Databases
from threadstate.access.keys import (
    KeyRefusedError,
    ScopeRefusedError,
    create_key,
    keys,
    require_key,
    revoke_key,
)
from threadstate.access.scope import Scope
from threadstate.access.tables import api_key
from threadstate.errors import InvalidValueError, NotFoundError
from threadstate.library.engine import writing


@pytest.fixture
def engine(databases: Databases) -> Iterator[Engine]:
    with databases.lent() as database, writing(database) as engine:
        yield engine


def _check(engine: Engine, key: str | None, scope: Scope) -> None:
    with engine.connect() as connection:
        require_key(connection, key, scope)


def test_a_key_counts_for_its_scope(engine: Engine) -> None:
    write, read = create_key(engine, "designer", Scope.WRITE), create_key(engine, "reader", Scope.READ)
    for key, scope in ((write, Scope.WRITE), (write, Scope.READ), (read, Scope.READ)):
        _check(engine, key, scope)
    with pytest.raises(ScopeRefusedError):
        _check(engine, read, Scope.WRITE)


def test_a_revoked_key_counts_no_more(engine: Engine) -> None:
    key, other = create_key(engine, "one", Scope.WRITE), create_key(engine, "other", Scope.WRITE)
    key_id = key.split("_")[1]
    for _ in range(2):
        revoke_key(engine, key_id)
        with pytest.raises(KeyRefusedError):
            _check(engine, key, Scope.READ)
    _check(engine, other, Scope.WRITE)
    with engine.connect() as connection:
        assert {one.id: one.revoked_at is None for one in keys(connection)} == {
            key_id: False,
            other.split("_")[1]: True,
        }
    with pytest.raises(NotFoundError):
        revoke_key(engine, "0" * 12)


def test_what_is_no_key_is_refused_and_not_repeated(engine: Engine) -> None:
    key = create_key(engine, "one", Scope.WRITE)
    changed = key[:-1] + ("A" if key[-1] != "A" else "B")
    unknown = f"ts_{'0' * 12}_{key.split('_', 2)[2]}"
    for wrong in (
        None,
        "",
        "x",
        changed,
        unknown,
        key.upper(),
        f"{key} ",
        f"{key}\n",
        "\x00",
        "ts_\udcff",
        "9" * 10_000,
    ):
        with pytest.raises(KeyRefusedError) as refused:
            _check(engine, wrong, Scope.READ)
        assert not wrong or len(wrong) < 3 or wrong not in str(refused.value)


def test_the_database_has_hashes_alone(engine: Engine) -> None:
    key = create_key(engine, "one", Scope.WRITE)
    secret = key.split("_", 2)[2]
    with engine.connect() as connection:
        (row,) = connection.execute(select(api_key)).all()
    assert all(secret not in str(value) for value in row)
    assert len({create_key(engine, "one", Scope.WRITE) for _ in range(20)}) == 20


@pytest.mark.sqlite_alone
def test_hashes_are_compared_in_constant_time_whether_the_id_is_known_or_not(
    engine: Engine, monkeypatch: pytest.MonkeyPatch
) -> None:
    key = create_key(engine, "one", Scope.WRITE)
    compared: list[tuple[str, str]] = []

    def compare_digest(one: str, other: str) -> bool:
        compared.append((one, other))
        return one == other

    monkeypatch.setattr("hmac.compare_digest", compare_digest)
    _check(engine, key, Scope.WRITE)
    for wrong in (f"ts_{'0' * 12}_{'A' * 43}", "no key at all", None):
        with pytest.raises(KeyRefusedError):
            _check(engine, wrong, Scope.WRITE)
    assert len(compared) == 4
    assert all(len(one) == len(other) == 64 for one, other in compared)


@pytest.mark.parametrize("name", ["", "x" * 101, "a\nb"])
def test_a_name_that_cannot_be_shown_is_refused(engine: Engine, name: str) -> None:
    with pytest.raises(InvalidValueError):
        create_key(engine, name, Scope.WRITE)
