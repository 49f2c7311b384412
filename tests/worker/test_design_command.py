"""``threadstate design``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.worker.conftest import CommandLine
from threadstate.device.document import device_from_document
from threadstate.device.strategy import Strategy
from threadstate.success.bounded import bounded_cell
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = [pytest.mark.slow, pytest.mark.sqlite_alone]

COMMAND = (
    *("design", "--tilt-max", "2", "--tilt-step", "2", "--mu", "0", "--strategy", "cw", "--evaluations", "3"),
    *("--finalists", "1", "--vary", "k_tilt=200:600", "--max-tilt", "3", "--max-torque", "254", "--workers", "2"),
)


def test_devices_are_tried_and_what_is_said_of_them_is_what_paths_do(command_line: CommandLine, tmp_path: Path) -> None:
    maps = ("--maps", str(tmp_path / "maps"))
    found = json.loads(command_line.out(*COMMAND, *maps, "--json"))
    tried = [one["values"]["k_tilt"] for one in found["tried"]]
    assert (tried[:2], len(set(tried))) == ([500.0, 400.0], 3)
    assert found["base"]["values"] == {}
    assert found["base"]["device"]["k_tilt"] == 500.0
    assert (found["mu"], found["strategy"]) == ([0.0], "cw")
    # The default device has millimetres, the pair inches.
    assert found["limits"] == {"tilt": 3.0, "shift": None, "torque": pytest.approx(10.0)}
    best = found["finalists"][0]
    device = device_from_document({name: value for name, value in best["device"].items() if value is not None})
    poses = [(roll, pitch, 0.0) for roll in (-2.0, 0.0, 2.0) for pitch in (-2.0, 0.0, 2.0)]
    cells = [bounded_cell(quarter_twenty_unc(), device, Strategy.CW, pose, 0.0, 1000) for pose in poses]
    within = [cell for cell in cells if cell.engages and (cell.tilt_deg or 0.0) <= 3.0]
    assert best["engaged"] == [len(within)]
    assert best["tilt"] == max(cell.tilt_deg or 0.0 for cell in within)
    (tolerance,) = found["tolerances"]
    assert tolerance["low"] <= tolerance["value"] <= tolerance["high"]
    kept = {path.name: path.read_bytes() for path in (tmp_path / "maps").iterdir()}
    again = json.loads(command_line.out(*COMMAND, *maps, "--json"))
    assert {**again, "elapsed_s": 0} == {**found, "elapsed_s": 0}
    assert {path.name: path.read_bytes() for path in (tmp_path / "maps").iterdir()} == kept
    table = command_line.out(*COMMAND, *maps)
    assert "3 devices tried" in table
    assert "as given" in table


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (("--vary", "mass=1:2"), "vary is 'mass'"),
        (("--vary", "k_tilt"), "NAME=LOW:HIGH"),
        (("--vary", "k_tilt=2:1"), "vary k_tilt is '2:1'"),
        (("--vary", "push=1:2", "--vary", "push=1:3"), "each once"),
        (("--max-tilt", "0"), "max_tilt is 0"),
        (("--max-shift", "-1"), "max_shift is -1"),
        (("--max-torque", "0"), "max_torque is 0"),
        (("--mu", "0.2,0.1"), "ascend"),
        (("--vary", "push=-5:5"), "push is"),
        (("--vary", "ccw_turn=300:500"), "ccw_turn is"),
        (("--pair", "M6 with chamfer"), "chamfer"),
    ],
)
def test_what_is_not_valid_is_named(
    command_line: CommandLine, tmp_path: Path, options: tuple[str, ...], named: str
) -> None:
    code, out, err = command_line.here("design", "--tilt-max", "0", "--maps", str(tmp_path), *options)
    assert (code, out) == (2, "")
    assert named in err
