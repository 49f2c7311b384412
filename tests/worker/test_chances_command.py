"""``threadstate chances``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.worker.conftest import CommandLine
from worker.exit_codes import ExitCode

SMALL = ("chances", "--strategy", "cw", "--mu", "0", "--tilt-sd", "1", "--tilt-mean", "0,-2")

pytestmark = pytest.mark.sqlite_alone


@pytest.mark.slow
def test_the_content_does_not_depend_on_workers_and_more_samples_keep_the_first(
    command_line: CommandLine, tmp_path: Path
) -> None:
    path = tmp_path / "cw.samples"
    one = json.loads(command_line.out(*SMALL, "--samples", "8", "--workers", "1", "--json"))
    two = json.loads(command_line.out(*SMALL, "--samples", "8", "--workers", "2", "--out", str(path), "--json"))
    assert one["content_sha256"] == two["content_sha256"]
    assert (one["samples"], one["computed"], two["computed"]) == (8, 8, 8)
    assert sum(ends["paths"] for ends in one["outcomes"]) == 8
    for node in one["formations"]:
        moves = [move for move in one["moves"] if move["from"] == node["formation"]]
        assert sum(move["probability"] for move in moves) == pytest.approx(1.0)
    lines = path.read_bytes()
    # A run that was killed while it wrote the fifth sample goes on with four, one of nine keeps all.
    path.write_bytes(b"".join(lines.splitlines(keepends=True)[:5]) + b'{"sha256"')
    resumed = json.loads(command_line.out(*SMALL, "--samples", "8", "--workers", "1", "--out", str(path), "--json"))
    assert (resumed["computed"], resumed["content_sha256"]) == (4, one["content_sha256"])
    more = json.loads(command_line.out(*SMALL, "--samples", "9", "--workers", "1", "--out", str(path), "--json"))
    assert (more["computed"], more["input_sha256"]) == (1, one["input_sha256"])
    assert more["content_sha256"] != one["content_sha256"]
    fewer = command_line.out(*SMALL, "--samples", "8", "--workers", "1", "--out", str(path))
    assert f"content {one['content_sha256'][:12]}: 0 samples computed" in fewer
    code, _, err = command_line.here(*SMALL, "--point-limit", "900", "--out", str(path))
    assert code == ExitCode.USAGE
    assert "valid: samples of the same inputs and code" in err


@pytest.mark.slow
def test_an_observation_is_located_in_the_unit_that_is_shown(command_line: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "cw.samples"
    common = (*SMALL, "--samples", "4", "--workers", "1", "--out", str(path))
    inches = json.loads(command_line.out(*common, "--watch", "force=10+-0.1 torque=0.07+-0.01", "--json"))["watch"]
    millimetres = json.loads(
        command_line.out(*common, "--watch", "force=10+-0.1 torque=1.778+-0.254", "--unit", "mm", "--json")
    )["watch"]
    assert 0 < inches["matching"] < inches["points"]
    assert millimetres["matching"] == pytest.approx(inches["matching"], abs=1)
    assert sum(one["share"] for one in inches["remaining"]) == pytest.approx(1.0)
    shown = command_line.out(*common, "--watch", "torque=9+-1")
    assert f"observed: 0 of {inches['points']} points" in shown


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--samples", "0"), "--samples"),
        (("--tilt-sd", "11"), "tilt_sd is 11.0; valid: 0 to 10 deg"),
        (("--tilt-mean", "3"), "tilt_mean is '3'; valid: ROLL,PITCH in degrees"),
        (("--tilt-mean", "3,x"), "tilt_mean is '3,x'; valid: ROLL,PITCH in degrees"),
        (("--mu", "0.2:"), "mu is '0.2:'; valid: a number or LOW:HIGH"),
        (("--mu", "0.3:0.1"), "mu is '0.3:0.1'; valid: the lower friction first"),
        (("--watch", "force=1"), "watch is 'force=1'; valid: force=X,Y,Z+-N"),
        (("--point-limit", "5"), "point_limit is 5; valid: 10 to 2500"),
    ],
)
def test_a_bad_value_ends_with_2_and_one_line(
    command_line: CommandLine, arguments: tuple[str, ...], message: str
) -> None:
    code, out, err = command_line.here("chances", *arguments)
    assert (code, out) == (ExitCode.USAGE, "")
    assert message in err
    assert len(err.splitlines()) == 1
