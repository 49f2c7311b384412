"""``threadstate libraries``: which libraries there are, and which one ``latest`` means."""

from __future__ import annotations

import json
from typing import Any

import pytest

from harness.databases import Databases
from tests.service.conftest import store_library
from tests.service.made_up_states import made_up_states
from tests.service.settled_library import LEVEL, store_settled
from tests.worker.conftest import CommandLine
from threadstate.device.document import device_from_document
from threadstate.library.grid import Grid
from threadstate.mesh.options import MeshOptions
from threadstate.thread.catalogue import RootForm, quarter_twenty_unc
from worker.exit_codes import ExitCode

GRID = Grid(0.0, 1.0, 180.0)


@pytest.fixture
def stored(command_line: CommandLine) -> CommandLine:
    """A command line on three libraries: of the classic root, of the newer one, and by meshes."""
    command_line.here("migrate")
    store_library(command_line.database, quarter_twenty_unc(), GRID, made_up_states)
    store_library(command_line.database, quarter_twenty_unc(RootForm.NEWER), GRID, made_up_states)
    store_library(command_line.database, quarter_twenty_unc(), GRID, made_up_states, MeshOptions())
    return command_line


def _libraries(command_line: CommandLine, *arguments: str) -> list[dict[str, Any]]:
    code, out, err = command_line.here("libraries", *arguments, "--json")
    assert (code, err) == (0, "")
    document = json.loads(out)
    assert list(document) == ["libraries"]
    found: list[dict[str, Any]] = document["libraries"]
    return found


def _marks(command_line: CommandLine, *arguments: str) -> list[tuple[int, bool, bool]]:
    return [(one["id"], one["latest"], one["pinned"]) for one in _libraries(command_line, *arguments)]


def test_all_published_libraries_are_listed_the_latest_first(stored: CommandLine) -> None:
    mesh, newer, classic = _libraries(stored)
    assert [one["id"] for one in (mesh, newer, classic)] == [3, 2, 1]
    assert [one["method"] for one in (mesh, newer, classic)] == ["mesh", "exact", "exact"]
    assert (classic["designation"], classic["slug"], classic["unit"]) == ("1/4-20 UNC", "1-4-20-unc", "in")
    assert (classic["tilt_max"], classic["tilt_step"], classic["phase_step"], classic["states"]) == (0.0, 1.0, 180.0, 2)
    lines = stored.here("libraries")[1].splitlines()
    assert [line.split()[0] for line in lines] == ["id", "3", "2", "1"]
    assert [line.endswith("latest") for line in lines] == [False, False, True, False]


def test_one_is_pinned_at_a_time_and_latest_means_it(stored: CommandLine) -> None:
    assert _marks(stored) == [(3, False, False), (2, True, False), (1, False, False)]
    assert _marks(stored, "--pin", "1-4-20-unc") == [(3, False, False), (2, False, False), (1, True, True)]
    assert stored.here("libraries")[1].splitlines()[-1].endswith("latest, pinned")
    assert json.loads(stored.here("summary", "--json")[1])["library"] == 1
    assert _marks(stored, "--pin", "2") == [(3, False, False), (2, True, True), (1, False, False)]
    assert _marks(stored, "--unpin") == [(3, False, False), (2, True, False), (1, False, False)]
    assert json.loads(stored.here("summary", "--json")[1])["library"] == 2


def test_what_cannot_be_pinned_is_said(stored: CommandLine) -> None:
    for arguments, code, words in (
        (("--pin", "m6x1"), ExitCode.NOT_FOUND, "published are: 3 (1-4-20-unc, by meshes), 2"),
        (("--pin", "latest-mesh"), ExitCode.USAGE, "--pin is 'latest-mesh'; valid: a library by the exact method"),
        (("--pin", "1", "--unpin"), ExitCode.USAGE, "--pin is '1'; valid: without --unpin"),
    ):
        found, out, err = stored.here("libraries", *arguments)
        assert (found, out, words in err) == (code, "", True), err
    assert not any(pinned for _, _, pinned in _marks(stored))


@pytest.mark.sqlite_alone
def test_where_nothing_is_published_the_list_is_empty(command_line: CommandLine) -> None:
    assert command_line.here("libraries", "--unpin")[0] == ExitCode.SCHEMA
    command_line.here("migrate")
    assert _libraries(command_line) == []
    assert "run `threadstate rebuild`" in command_line.here("libraries")[2]


def test_a_copy_has_the_libraries_named_and_no_pin(stored: CommandLine, databases: Databases) -> None:
    target = databases.new()
    stored.here("libraries", "--pin", "1")
    for name, number in (("1/4-20 UNC newer root", 2), ("latest", 1)):
        code, out, _ = stored.here("copy", "--to", target, "--library", name, "--json")
        assert (code, json.loads(out)["library"]) == (0, number)
    assert not any(pinned for _, _, pinned in _marks(stored, "--database", target))


def test_libraries_of_settled_states_are_listed_with_their_devices(command_line: CommandLine) -> None:
    command_line.here("migrate")
    assert json.loads(command_line.out("libraries", "--settled", "--json")) == {"settled": []}
    code, _, err = command_line.here("libraries", "--settled")
    assert (code, "run `threadstate rebuild-settled`" in err) == (0, True)
    device = {"unit": "mm", "k_lateral": 5.0, "k_axial": 0.0, "k_tilt": 250.0, "k_twist": "rigid"}
    device |= {"centre": 0.0, "push": 4.0, "about": "nut", "ccw_turn": 360.0}
    store_settled(command_line.database)
    store_settled(command_line.database, device=device_from_document(device))
    latest, first = json.loads(command_line.out("libraries", "--settled", "--json"))["settled"]
    assert (latest["id"], first["id"]) == (2, 1)
    assert latest["device"] == device
    assert (latest["states"], latest["unit"], latest["tilt_max"]) == (LEVEL.pose_count, "in", 0.0)
    assert len(latest["content_sha256"]) == 64
    lines = command_line.out("libraries", "--settled").splitlines()
    assert [line.split()[0] for line in lines] == ["id", "2", "1"]
    assert "k_tilt 250.0" in lines[1]


@pytest.mark.parametrize("option", [("--unpin",), ("--pin", "1")])
def test_settled_states_are_not_pinned(command_line: CommandLine, option: tuple[str, ...]) -> None:
    code, _, err = command_line.here("libraries", "--settled", *option)
    assert (code, "without --pin and --unpin" in err) == (ExitCode.USAGE, True)
