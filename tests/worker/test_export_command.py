from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path

import pytest
from pyarrow import parquet

from harness.databases import Databases
from tests.service.conftest import StoredLibrary, store_library
from tests.service.made_up_states import made_up_states
from tests.worker.conftest import CommandLine
from threadstate.library.grid import Grid
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.exit_codes import ExitCode

pytestmark = pytest.mark.sqlite_alone


@pytest.fixture(scope="module")
def library(sqlite_databases: Databases) -> StoredLibrary:
    """A library of 108 made-up states."""
    return store_library(sqlite_databases.migrated(), quarter_twenty_unc(), Grid(1.0, 1.0, 30.0), made_up_states)


@pytest.fixture
def command(command_line_on: Callable[[str], CommandLine], library: StoredLibrary) -> CommandLine:
    """A command line on that library."""
    return command_line_on(library.database)


def _export(command: CommandLine, *arguments: str) -> tuple[int, str, str]:
    return command.here("export", "--database", command.database, *arguments)


def test_the_format_is_that_of_the_name(command: CommandLine, library: StoredLibrary, tmp_path: Path) -> None:
    out = tmp_path / "states.parquet"
    code, said, _ = _export(command, "--out", str(out))
    assert (code, said) == (0, f"{out}: states of library 1, {out.stat().st_size} bytes, lengths in in\n")
    assert parquet.read_metadata(out).num_rows == len(library.states)
    lines = tmp_path / "states.txt"
    assert _export(command, "--out", str(lines), "--format", "ndjson", "--library", "1")[0] == 0
    assert len(lines.read_text().splitlines()) == len(library.states)


def test_what_was_written_is_told_as_json(command: CommandLine, library: StoredLibrary, tmp_path: Path) -> None:
    out = tmp_path / "states.csv"
    out.write_text("before")
    code, said, _ = _export(command, "--out", str(out), "--unit", "mm", "--json")
    told = json.loads(said)
    assert (code, told["file"], told["bytes"]) == (0, str(out), out.stat().st_size)
    assert (told["library"], told["table"], told["format"], told["unit"]) == (1, "states", "csv", "mm")
    with out.open(newline="") as file:
        drops = [float(row["drop"]) if row["drop"] else None for row in csv.DictReader(file)]
    assert drops == [None if state.drop is None else state.drop * 25.4 for state in library.states]
    assert [path.name for path in tmp_path.iterdir()] == ["states.csv"]


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["--out", "states.xlsx"], ExitCode.USAGE),
        (["--out", "no/such/folder/states.csv"], ExitCode.USAGE),
        (["--out", "states.csv", "--library", "99"], ExitCode.NOT_FOUND),
    ],
)
def test_what_cannot_be_written_leaves_nothing(
    command: CommandLine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], code: ExitCode
) -> None:
    monkeypatch.chdir(tmp_path)
    found, _, said = _export(command, *arguments)
    assert found == code
    assert len(said.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []
