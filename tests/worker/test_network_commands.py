from __future__ import annotations

import json
from collections.abc import Callable

import pytest

from tests.archive.history_library import histories_of_grid, store_histories
from tests.databases import Databases
from tests.worker.conftest import CommandLine
from threadstate.library.grid import Grid
from threadstate.settings import DATABASE

GRID = Grid(2.0, 2.0, 180.0)

pytestmark = pytest.mark.sqlite_alone


@pytest.fixture(scope="module")
def database(databases: Databases) -> str:
    url = databases.migrated()
    store_histories(url, GRID, histories_of_grid(GRID))
    return url


@pytest.fixture
def ask(
    command_line_on: Callable[[str], CommandLine], database: str, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., str]:
    """What a command on the library prints."""
    monkeypatch.setenv(DATABASE, database)
    command_line = command_line_on(database)

    def asked(*arguments: str) -> str:
        code, out, err = command_line.here(*arguments)
        assert code == 0, err
        return out

    return asked


def test_a_history_stored_is_the_one_computed(ask: Callable[..., str]) -> None:
    orientation = ("--roll", "0", "--pitch", "-2", "--json")
    assert json.loads(ask("history", *orientation, "--stored")) == json.loads(ask("history", *orientation))


def test_heights_stored_are_those_computed(ask: Callable[..., str]) -> None:
    orientation = ("--roll", "0", "--pitch", "-2")
    heights = json.loads(ask("heights", *orientation, "--stored", "--json"))
    assert heights == json.loads(ask("heights", *orientation, "--json"))
    lines = ask("heights", *orientation, "--stored").splitlines()
    assert len(lines) == 1 + len(heights["phases"])
    assert f"{heights['first_heights'][0]:.9f}" in lines[1]


def test_tables_name_what_the_objects_hold(ask: Callable[..., str]) -> None:
    history = json.loads(ask("history", "--roll", "0", "--pitch", "-2", "--stored", "--json"))
    shown = ask("history", "--roll", "0", "--pitch", "-2", "--stored")
    assert all(one["formation"]["key"] in shown for one in history["intervals"])
    (window,) = (json.loads(line) for line in ask("windows", "--roll", "0", "--pitch", "-2", "--json").splitlines())
    assert f"{window['snap']['phase']:.6f}" in ask("windows", "--roll", "0", "--pitch", "-2")
    key = next(one for one in history["intervals"] if not one["in_window"])["formation"]["key"]
    node = json.loads(ask("formation", "--key", key, "--json"))
    assert all(one["formation"] in ask("formation", "--key", key) for one in node["following"])
    path = json.loads(ask("path", "--from", key, "--roll", "0", "--pitch", "-2", "--json"))
    assert f"{path['turning']:.6f} deg" in ask("path", "--from", key, "--roll", "0", "--pitch", "-2")
    location = json.loads(ask("locate", "--class", "stable_three_point", "--contacts", "3", "--json"))
    assert f"{100.0 * location['share']:.3f} %" in ask("locate", "--class", "stable_three_point", "--contacts", "3")
    summary = json.loads(ask("network", "--json"))
    assert str(summary["edges"]) in ask("network")
    assert ask("network", "--export", "dot").count(" -> ") == summary["edges"]
    for name in ("node-link", "graphml"):
        assert ask("network", "--export", name).count(key) > 0
    lines = ask("transitions", "--roll", "0", "--pitch", "-2", "--move", "ccw", "--limit", "5", "--json").splitlines()
    assert [json.loads(line)["move"] for line in lines] == ["ccw"] * 5
    assert json.loads(lines[0])["target"]["formation"] in ask("transitions", "--roll", "0", "--pitch", "-2")


def test_what_cannot_be_asked_is_said(
    command_line_on: Callable[[str], CommandLine], database: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(DATABASE, database)
    command_line = command_line_on(database)
    for arguments, code, words in (
        (("formation", "--key", "0123456789"), 4, "no formation 0123456789"),
        (("history", "--roll", "1", "--pitch", "0", "--stored"), 4, "no orientation of roll 1"),
        (("path", "--from", "0123456789", "--moves", "sideways"), 2, "sideways"),
        (("path", "--from", "0123456789", "--roll", "1"), 2, "roll and pitch"),
        (("locate", "--contact", "9"), 2, "stage"),
        (("history", "--roll", "11", "--pitch", "0"), 2, "roll is 11"),
    ):
        found, _, error = command_line.here(*arguments)
        assert (found, words in error) == (code, True), error
