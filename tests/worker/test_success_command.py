"""``threadstate success``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.worker.conftest import CommandLine
from tests.worker.test_rebuild import _kill, _wait_for
from threadstate.device.assemble import assemble_pose
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.library.grid import Grid
from threadstate.success.document import map_sha256, orientation_document
from threadstate.success.inputs import SuccessInputs
from threadstate.success.map_file import read_map
from threadstate.success.model import OrientationMap
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.processes import ComputeError, computing_processes

pytestmark = [pytest.mark.slow, pytest.mark.sqlite_alone]

INPUTS = SuccessInputs(
    quarter_twenty_unc(), default_device(), Strategy.CW, Grid(4.0, 4.0, 360.0), (0.0,), phase_tolerance_deg=360.0
)
COMMAND = (
    *("success", "--strategy", "cw", "--mu", "0", "--phases", "1", "--phase-tolerance", "360"),
    *("--tilt-max", "4", "--tilt-step", "4"),
)


@pytest.fixture(scope="module")
def expected_content() -> str:
    """The content hash of the small map, computed by one process."""
    with computing_processes(INPUTS, 1) as processes:
        found = processes.chunks(range(INPUTS.grid.orientation_count), lambda: None)
        return map_sha256([one for one in found if isinstance(one, OrientationMap)])


def test_the_content_does_not_depend_on_the_number_of_workers(
    command_line: CommandLine, expected_content: str, tmp_path: Path
) -> None:
    path = tmp_path / "two.map"
    result = json.loads(command_line.out(*COMMAND, "--workers", "2", "--out", str(path), "--json"))
    assert result["content_sha256"] == expected_content
    assert result["input_sha256"] == INPUTS.sha256
    assert result["computed"] == 9
    assert [(one["roll"], one["pitch"]) for one in result["orientations"][:2]] == [(-4.0, -4.0), (-4.0, 0.0)]
    (summary,) = result["summary"]
    assert sum(summary["outcomes"].values()) == INPUTS.grid.pose_count
    stored = read_map(path, INPUTS)
    assert map_sha256(stored) == expected_content
    for one, document in zip(stored, result["orientations"], strict=True):
        assert {**orientation_document(one), "summary": document["summary"]} == document
        for cell in one.cells:
            alone = assemble_pose(INPUTS.pair, one.roll_deg, one.pitch_deg, cell.phase_deg, strategy=Strategy.CW)
            assert (cell.outcome, cell.flags) == (alone.outcome, alone.flags)
            assert cell.torque == (None if alone.travel is None else alone.travel.torque)
    in_mm = json.loads(command_line.out(*COMMAND, "--out", str(path), "--unit", "mm", "--json"))
    assert (in_mm["unit"], in_mm["content_sha256"]) == ("mm", expected_content)
    for own, other in zip(result["orientations"], in_mm["orientations"], strict=True):
        for name in ("torque", "shift"):
            before, after = (one["summary"][0][name] for one in (own, other))
            assert after == (None if before is None else pytest.approx(25.4 * before, rel=1e-15))
        assert [cell["tilt"] for cell in own["cells"]] == [cell["tilt"] for cell in other["cells"]]
    assert "shift (mm)" in command_line.out(*COMMAND, "--out", str(path), "--unit", "mm")
    again = command_line.out(*COMMAND, "--out", str(path))
    assert f"content {expected_content[:12]}: 0 orientations computed" in again
    assert "9 read from the file" in again


def test_killed_it_goes_on_to_the_same_bits(command_line: CommandLine, expected_content: str, tmp_path: Path) -> None:
    path = tmp_path / "killed.map"
    with command_line.start(*COMMAND, "--workers", "2", "--out", str(path)) as process:
        assert _wait_for(lambda: path.is_file() and path.read_bytes().count(b"\n") >= 3)
        _kill(process)
    kept = len(read_map(path, INPUTS))
    assert kept >= 2
    result = json.loads(command_line.out(*COMMAND, "--workers", "1", "--out", str(path), "--json"))
    assert (result["content_sha256"], result["computed"]) == (expected_content, 9 - kept)


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (("--mu", "0,1.5"), "mu is 1.5; valid: 0 to 1"),
        (("--mu", "0.2,0.1"), "valid: frictions that ascend"),
        (("--mu", "smooth"), "mu is 'smooth'"),
        (("--phases", "7"), "phases is 7; valid: a number that divides 360 deg into decimals"),
        (("--phases", "0"), "0 is below 1"),
        (("--strategy", "sideways"), "ccw_then_cw"),
        (("--phase-tolerance", "0"), "phase_tolerance is 0.0; valid: 0.01 to 360 deg"),
        (("--mu-tolerance", "0"), "mu_tolerance is 0.0; valid: 0.0001 to 1"),
        (("--point-limit", "3"), "point_limit is 3; valid: 10 to 2500"),
        (("--tilt-step", "3"), "tilt_step is 3.0"),
        (("--pair", "M6 with sharp corners"), "bolt_root_fillet is 0.0; valid: at least 0.01"),
        (("--device", "nothing.toml"), "nothing.toml"),
        (("--out", "nowhere/success.map"), "map file is 'nowhere/success.map'"),
    ],
)
def test_what_is_not_valid_is_a_clear_error(command_line: CommandLine, options: tuple[str, ...], named: str) -> None:
    code, out, err = command_line.here("success", *options)
    assert (code, out) == (2, "")
    assert named in err


def test_a_process_that_fails_says_why() -> None:
    with (
        computing_processes(INPUTS, 1) as processes,
        pytest.raises(ComputeError, match="failed: IndexError"),
    ):
        list(processes.chunks([INPUTS.grid.orientation_count], lambda: None))
