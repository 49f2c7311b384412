from __future__ import annotations

import sqlite3
from urllib.parse import parse_qs, urlsplit

import pytest

from benchmarks.load.report import Case, document, table
from benchmarks.load.requests import HISTORY_BY_DATASETTE, POSE, POSE_BY_DATASETTE
from benchmarks.load.wrk import LoadError, LoadResult, RequestPattern, load
from tests.service.conftest import StoredLibrary, client_of


def _result(rate: float, p99_ms: float = 1.0) -> LoadResult:
    return LoadResult(rate, 0.5, p99_ms, 2.6)


def test_promises_are_held_against_what_was_found() -> None:
    met = Case("pose", _result(3000.0), _result(1500.0), _result(375.0), 3000.0, 15.0, 8.0)
    assert met.broken == []
    for case, said in (
        (Case("pose", _result(2999.0), least_rate=3000.0), "2999/s instead of 3000/s"),
        (Case("pose", _result(1.0, 15.1), most_p99_ms=15.0), "p99 15 ms instead of 15 ms"),
        (Case("pose", _result(3000.0), _result(1499.0), least_rate=3000.0), "during a rebuild: 1499/s"),
        (Case("pose", _result(79.0), datasette=_result(10.0), times_datasette=8.0), "7.9 times Datasette's"),
    ):
        (line,) = case.broken
        assert said in line
    assert "| pose | 2.6 | 3,000 | 0.5 | 1.0 | 3,000/s, p99 15 ms, 8 times | 1,500 | 1.0 | 375.0 | 8 |" in table([met])
    assert "Every promise was met" in document([met], 5.0)
    assert "- pose: 2999/s" in document([Case("pose", _result(2999.0), least_rate=3000.0)], 5.0)


def test_server_that_is_not_there_is_an_error() -> None:
    with pytest.raises(LoadError):
        load("http://127.0.0.1:9", RequestPattern("/"), 0.1, 1)


@pytest.mark.sqlite_alone
def test_both_servers_are_asked_the_same(made_up: StoredLibrary) -> None:
    with sqlite3.connect(made_up.database.removeprefix("sqlite:///")) as connection:
        pose, history = (
            connection.execute(_sql(pattern), {"roll": 1.0, "pitch": -1.0, "phase": 30.0}).fetchall()
            for pattern in (POSE_BY_DATASETTE, HISTORY_BY_DATASETTE)
        )
    with client_of(made_up.database) as client:
        state = client.get(POSE.path % (1, -1, 30)).json()
    (row,) = pose
    assert row[:3] == (state["roll"], state["pitch"], state["phase"])
    for column, name in ((-3, "poses"), (-2, "contacts"), (-1, "flags")):
        assert row[column].count("{") == len(state[name])
    assert len(history) == made_up.grid.phase_count


def _sql(pattern: RequestPattern) -> str:
    """The statement in an address."""
    (sql,) = parse_qs(urlsplit(pattern.path.replace("%%", "%")).query)["sql"]
    return sql
