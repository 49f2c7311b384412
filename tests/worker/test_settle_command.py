"""``threadstate settle``."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.worker.conftest import CommandLine

pytestmark = [pytest.mark.slow, pytest.mark.sqlite_alone]

POSE = ("--roll", "0", "--pitch", "3", "--phase", "250")


def test_a_pose_is_one_object(command_line: CommandLine) -> None:
    code, out, err = command_line.here("settle", *POSE, "--json")
    assert (code, err) == (0, "")
    found = json.loads(out)
    assert list(found) == [
        *("roll", "pitch", "phase", "unit", "outcome", "pose", "deviation", "contacts", "elastic_energy", "falls"),
        *("flags", "margins"),
    ]
    assert (found["roll"], found["pitch"], found["phase"], found["unit"]) == (0.0, 3.0, 250.0, "in")
    assert (found["outcome"], found["flags"], found["falls"]) == ("settled", [], [])
    assert list(found["deviation"]) == ["shift", "rotation"]
    assert [list(contact) for contact in found["contacts"]] == [["point", "normal", "features", "force"]] * 2
    force = np.sum([contact["force"] for contact in found["contacts"]], axis=0)
    assert np.allclose(force, [*(508.0 * x for x in found["deviation"]["shift"][:2]), 10.0], atol=1e-8)


def test_lengths_are_in_the_unit_that_is_asked_for(command_line: CommandLine) -> None:
    inch, metric = (
        json.loads(command_line.here("settle", *POSE, "--unit", unit, "--json")[1]) for unit in ("in", "mm")
    )
    assert np.allclose(metric["pose"]["translation"], np.multiply(inch["pose"]["translation"], 25.4))
    assert metric["elastic_energy"] == pytest.approx(25.4 * inch["elastic_energy"])
    assert metric["deviation"]["rotation"] == inch["deviation"]["rotation"]
    assert metric["contacts"][0]["force"] == inch["contacts"][0]["force"]


def test_poses_of_a_file_are_one_object_a_line(command_line: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "poses.csv"
    path.write_text("roll,pitch,phase\n4,-3,185\n1,0.5,120\n0,0,0.5\n")
    lines = command_line.here("settle", "--poses", str(path), "--json")[1].splitlines()
    found = [json.loads(line) for line in lines]
    assert [(one["outcome"], one["flags"]) for one in found] == [
        ("settled", []),
        ("settled", ["flush"]),
        ("settled", []),
    ]


def test_the_device_is_read_from_a_file(command_line: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "device.toml"
    path.write_text('unit = "mm"\nk_tilt = 1e6\nk_lateral = 1e6\npush = 2\n')
    found = json.loads(command_line.here("settle", *POSE, "--device", str(path), "--json")[1])
    assert found["contacts"][0]["force"][2] == pytest.approx(2.0, rel=1e-2)
    assert np.abs(found["deviation"]["rotation"]).max() < 1e-3


def test_without_json_it_is_a_table(command_line: CommandLine) -> None:
    code, out, _ = command_line.here("settle", *POSE, "--unit", "mm")
    assert code == 0
    assert "outcome" in out
    assert "elastic energy (N mm)" in out


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("k_tilt = 3\n", "unit"),
        ('unit = "mm"\npush = -1\n', "push is -1.0"),
        ('unit = "mm"\nspring = 1\n', "one of the keys"),
        ("unit = \n", "TOML"),
    ],
)
def test_a_bad_device_is_a_clear_error(command_line: CommandLine, tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "device.toml"
    path.write_text(text)
    code, out, err = command_line.here("settle", *POSE, "--device", str(path))
    assert (code, out) == (2, "")
    assert str(path) in err
    assert words in err


def test_a_bad_friction_and_a_missing_file_are_refused(command_line: CommandLine) -> None:
    code, _, err = command_line.here("settle", *POSE, "--mu", "-0.1")
    assert code == 2
    assert "mu is -0.1; valid: 0 to 1" in err
    assert command_line.here("settle", *POSE, "--device", "nothing.toml")[0] == 2
