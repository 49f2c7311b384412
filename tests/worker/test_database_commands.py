"""Commands that say what a database holds, or that it holds nothing."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from harness.databases import Databases
from tests.worker.conftest import ONE_ORIENTATION, CommandLine
from threadstate.library.schema import SCHEMA_REVISION
from worker.exit_codes import ExitCode

READING = ["summary", "libraries", "windows", "network", "serve"]


def _check_refusal(command_line: CommandLine, name: str, words: str) -> None:
    code, out, err = command_line.here(name)
    assert (code, out) == (ExitCode.SCHEMA, "")
    assert words in err
    assert len(err.splitlines()) == 1


@pytest.mark.postgresql_alone
@pytest.mark.parametrize("name", READING)
def test_a_database_that_is_not_migrated_ends_with_3(command_line: CommandLine, name: str) -> None:
    _check_refusal(command_line, name, "run `threadstate migrate`")


@pytest.mark.sqlite_alone
@pytest.mark.parametrize("name", READING)
def test_a_file_without_schema_is_told_from_one_that_does_not_exist(command_line: CommandLine, name: str) -> None:
    file = Path(command_line.database.removeprefix("sqlite:///"))
    _check_refusal(command_line, name, f"database file {file} does not exist; --database or THREADSTATE_DATABASE")
    assert not file.exists()
    file.parent.mkdir(exist_ok=True)
    file.touch()
    _check_refusal(command_line, name, "run `threadstate migrate`")


def test_nothing_published_ends_with_4(command_line: CommandLine) -> None:
    assert command_line.here("migrate")[0] == 0
    code, out, err = command_line.here("summary")
    assert (code, out) == (ExitCode.NOT_FOUND, "")
    assert "run `threadstate rebuild`" in err


def test_migrate_says_what_it_did(command_line: CommandLine) -> None:
    assert json.loads(command_line.here("migrate", "--json")[1]) == {
        "before": None,
        "after": SCHEMA_REVISION,
        "completed": 0,
    }
    assert json.loads(command_line.here("migrate", "--json")[1]) == {
        "before": SCHEMA_REVISION,
        "after": SCHEMA_REVISION,
        "completed": 0,
    }
    assert "already" in command_line.here("migrate")[1]


@pytest.mark.sqlite_alone
def test_the_summary_counts_every_state_once(command_line: CommandLine) -> None:
    command_line.out("rebuild", *ONE_ORIENTATION)
    summary = json.loads(command_line.here("summary", "--json")[1])
    assert summary["states"] == 24
    assert sum(summary["classes"].values()) == 24
    readable = command_line.here("summary")[1]
    for name, count in (summary["classes"] | summary["flags"]).items():
        assert re.search(rf"^{name} +{count}$", readable, re.M)


def test_a_copy_is_proved_by_its_hash(command_line: CommandLine, databases: Databases) -> None:
    published = json.loads(command_line.out("rebuild", *ONE_ORIENTATION, "--json"))
    target = databases.new()
    code, out, _ = command_line.here("copy", "--to", target, "--json")
    assert (code, json.loads(out)) == (
        0,
        {
            "library": published["library"],
            "copy": 1,
            "content_sha256": published["content_sha256"],
            "poses": published["states"],
            "was_there": False,
        },
    )
    assert "is there already" in command_line.here("copy", "--to", target, "--library", "1")[1]
    assert command_line.here("copy", "--to", target, "--library", "2")[0] == ExitCode.NOT_FOUND
    summary = json.loads(command_line.here("summary", "--database", target, "--json")[1])
    assert summary["content_sha256"] == published["content_sha256"]


def test_nothing_to_copy_ends_with_4(command_line: CommandLine, databases: Databases) -> None:
    command_line.here("migrate")
    assert command_line.here("copy", "--to", databases.new())[0] == ExitCode.NOT_FOUND


@pytest.mark.sqlite_alone
def test_a_key_is_shown_once_listed_without_its_secret_and_revoked(command_line: CommandLine) -> None:
    command_line.here("migrate")
    code, out, err = command_line.here("key", "create", "--name", "designer")
    key = out.strip()
    key_id = key.split("_")[1]
    assert (code, err) == (0, "This is the key; it is shown this once.\n")
    _, read_key, _ = command_line.here("key", "create", "--name", "reader", "--scope", "read", "--json")
    assert json.loads(read_key)["key"] != key
    listed = [json.loads(line) for line in command_line.here("key", "list", "--json")[1].splitlines()]
    assert [(one["name"], one["scope"], one["revoked_at"]) for one in listed] == [
        ("designer", "write", None),
        ("reader", "read", None),
    ]
    assert f"{key_id}  write  valid  designer" in command_line.here("key", "list")[1]
    assert command_line.here("key", "revoke", "--id", key_id)[0] == 0
    assert f"{key_id}  write  revoked" in command_line.here("key", "list")[1]
    assert key.split("_", 2)[2] not in command_line.here("key", "list")[1]
    assert command_line.here("key", "revoke", "--id", "0" * 12)[0] == ExitCode.NOT_FOUND
    for arguments in (("create",), ("revoke",), ("create", "--name", "")):
        assert command_line.here("key", *arguments)[0] == ExitCode.USAGE
