"""``threadstate rebuild-settled``."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from sqlalchemy import select

from tests.worker.conftest import CommandLine
from tests.worker.test_rebuild import _kill, _wait_for
from threadstate.device.document import device_from_document
from threadstate.device.model import default_device
from threadstate.device.settle import settle_poses
from threadstate.library.engine import reader_engine, reading
from threadstate.library.fingerprint import library_sha256
from threadstate.library.grid import Grid
from threadstate.library.schema import stored_revision
from threadstate.library.settled_tables import settled_chunk
from threadstate.settled.compute import computed_rows
from threadstate.settled.inputs import SettledInputs
from threadstate.settled.read import named_settled_library, settled_libraries, settled_states_between
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.processes import ComputeError, computing_processes

pytestmark = [pytest.mark.slow, pytest.mark.sqlite_alone]

GRID = Grid(2.0, 1.0, 120.0)
COMMAND = ("rebuild-settled", "--tilt-max", "2", "--tilt-step", "1", "--phase-step", "120")


@pytest.fixture(scope="module")
def expected_content() -> str:
    """The content hash of the small library, computed in this process."""
    rows = [computed_rows(quarter_twenty_unc(), GRID, default_device(), i) for i in range(GRID.orientation_count)]
    return library_sha256([one.content_sha256 for one in rows])


def _committed(database: str) -> int:
    engine = reader_engine(database)
    try:
        if stored_revision(engine) is None:
            return 0
        with engine.connect() as connection:
            return len(connection.execute(select(settled_chunk.c.orientation)).all())
    finally:
        engine.dispose()


def test_the_content_does_not_depend_on_the_number_of_workers(command_line: CommandLine, expected_content: str) -> None:
    result = json.loads(command_line.out(*COMMAND, "--workers", "3", "--json"))
    assert result["content_sha256"] == expected_content
    assert result["computed"] == result["states"] == sum(result["outcomes"].values()) == GRID.pose_count
    assert not result["was_published"]
    with reading(command_line.database) as engine, engine.connect() as connection:
        record = named_settled_library(connection, "latest")
        states = settled_states_between(connection, record.id, 0, GRID.pose_count - 1)
    assert (record.id, record.grid, record.device) == (result["settled_library"], GRID, default_device())
    poses = [pose for index in range(GRID.orientation_count) for pose in GRID.poses(index)]
    assert states == [replace(state, path=()) for state in settle_poses(quarter_twenty_unc(), poses)]
    again = json.loads(command_line.out(*COMMAND, "--json"))
    assert (again["was_published"], again["computed"]) == (True, 0)
    assert again["content_sha256"] == expected_content
    assert "published already; nothing to do" in command_line.out(*COMMAND)


def test_killed_it_goes_on_to_the_same_bits(command_line: CommandLine, expected_content: str) -> None:
    with command_line.start(*COMMAND, "--workers", "2") as process:
        assert _wait_for(lambda: _committed(command_line.database) >= 1)
        _kill(process)
    kept = _committed(command_line.database)
    with reading(command_line.database) as engine, engine.connect() as connection:
        published = len(settled_libraries(connection))
    assert published == 0 or kept == GRID.orientation_count
    result = json.loads(command_line.out(*COMMAND, "--workers", "1", "--json"))
    assert result["content_sha256"] == expected_content
    assert result["was_published"] or result["computed"] == GRID.pose_count - kept * GRID.phase_count


def test_another_device_makes_another_library(command_line: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "device.toml"
    path.write_text('unit = "mm"\nk_tilt = 250\npush = 5\n')
    level = ("rebuild-settled", "--tilt-max", "0", "--phase-step", "90", "--workers", "1")
    first = json.loads(command_line.out(*level, "--json"))
    second = json.loads(command_line.out(*level, "--device", str(path), "--json"))
    assert first["settled_library"] != second["settled_library"]
    assert first["input_sha256"] != second["input_sha256"]
    with reading(command_line.database) as engine, engine.connect() as connection:
        stored = named_settled_library(connection, str(second["settled_library"]))
    assert stored.device == device_from_document({"unit": "mm", "k_tilt": 250.0, "push": 5.0})


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (("--pair", "M6 with sharp corners"), "bolt_root_fillet is 0.0; valid: at least 0.01"),
        (("--pair", "M6 with chamfer"), "chamfer is"),
        (("--device", "nothing.toml"), "nothing.toml"),
        (("--phase-step", "7"), "phase_step is 7.0"),
    ],
)
def test_what_is_not_valid_is_a_clear_error(command_line: CommandLine, options: tuple[str, ...], named: str) -> None:
    code, out, err = command_line.here("rebuild-settled", *options)
    assert (code, out) == (2, "")
    assert named in err


def test_a_process_that_fails_says_why() -> None:
    inputs = SettledInputs(quarter_twenty_unc(), GRID, default_device())
    with (
        computing_processes(inputs, 1) as processes,
        pytest.raises(ComputeError, match="failed: IndexError"),
    ):
        list(processes.chunks([GRID.orientation_count], lambda: None))
