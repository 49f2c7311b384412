"""``threadstate statics``."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.worker.conftest import CommandLine

pytestmark = [pytest.mark.slow, pytest.mark.sqlite_alone]

POSE = ("--roll", "1", "--pitch", "-2", "--phase", "10")


def test_a_pose_is_one_object(command_line: CommandLine) -> None:
    code, out, err = command_line.here("statics", *POSE, "--mu", "1.5", "--force", "0.1,0,-10", "--json")
    assert (code, err) == (0, "")
    found = json.loads(out)
    assert list(found) == [
        *("roll", "pitch", "phase", "load", "mu", "penetrating", "supported", "support_margin", "mu_hold", "mu_wedge"),
        *("turn_effort_ccw", "turn_effort_cw", "forces", "verdict", "source"),
    ]
    assert found["load"]["force"] == [0.1, 0.0, -10.0]
    assert found["load"]["frame"] == "nut"
    assert (found["mu"], found["verdict"], found["supported"]) == (1.5, "can_stay", False)
    assert [force["contact"] for force in found["forces"]] == [1, 2, 3]


def test_lengths_are_in_the_unit_that_is_asked_for(command_line: CommandLine) -> None:
    load = ("--force", "0,0,-10", "--point", "1,2,3", "--unit", "mm")
    found = json.loads(command_line.here("statics", *POSE, *load, "--moment", "2.54,0,0", "--json")[1])
    inches = ("--force", "0,0,-10", "--point", ",".join(str(x / 25.4) for x in (1, 2, 3)), "--moment", "0.1,0,0")
    same = json.loads(command_line.here("statics", *POSE, *inches, "--json")[1])
    assert np.allclose(found["load"]["point"], [1.0, 2.0, 3.0])
    assert np.allclose(found["load"]["moment"], [2.54, 0.0, 0.0])
    assert found["mu_hold"] == pytest.approx(same["mu_hold"], rel=1e-9)
    assert found["support_margin"] == pytest.approx(same["support_margin"], rel=1e-9)


def test_poses_of_a_file_are_one_object_a_line(command_line: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "poses.csv"
    path.write_text("roll,pitch,phase\n4,0,185\n1,-2,10\n0,0,0\n")
    lines = command_line.here("statics", "--poses", str(path), "--json")[1].splitlines()
    found = [json.loads(line) for line in lines]
    assert [one["roll"] for one in found] == [4.0, 1.0, 0.0]
    flush = found[0]
    assert (flush["mu_hold"], flush["mu_wedge"], flush["verdict"], flush["forces"]) == (None, None, "moves", [])


def test_more_is_added_on_request_alone(command_line: CommandLine) -> None:
    asked = ("--mu", "1.5", "--include", "modes,reaction,forces_range", "--json")
    found = json.loads(command_line.here("statics", *POSE, *asked)[1])
    assert list(found)[-5:] == ["reaction", "forces_range", "internal_dimension", "modes", "source"]
    assert (found["reaction"]["size"], found["internal_dimension"]) == (0.0, 3)
    for force, limits in zip(found["forces"], found["forces_range"], strict=True):
        assert limits["normal_min"] <= force["normal"] + 1e-6 <= limits["normal_max"] + 2e-6
    assert [(mode["contacts"], mode["status"]) for mode in found["modes"]] == [
        (["sticks", "sticks", "sticks"], "consistent"),
        (["opens", "sticks", "sticks"], "consistent"),
    ]
    asked = ("--mu", "1", "--include", "reaction,modes", "--json")
    inches, millimetres = (
        json.loads(command_line.here("statics", *POSE, *asked, "--unit", unit)[1]) for unit in ("in", "mm")
    )
    assert 0.0 < inches["reaction"]["least_size"] <= inches["reaction"]["size"] == millimetres["reaction"]["size"]
    assert np.allclose(np.multiply(25.4, inches["reaction"]["moment"]), millimetres["reaction"]["moment"])
    (moving,), (same,) = inches["modes"], millimetres["modes"]
    assert np.allclose(moving["twist"]["linear"], same["twist"]["linear"])
    assert np.allclose(np.divide(moving["twist"]["angular"], 25.4), same["twist"]["angular"])
    assert np.allclose(np.multiply(25.4, moving["twist"]["point"]), same["twist"]["point"])
    flush = ("--roll", "4", "--pitch", "0", "--phase", "185", "--include", "forces_range,modes", "--json")
    found = json.loads(command_line.here("statics", *flush)[1])
    assert (found["forces_range"], found["internal_dimension"], found["modes"]) == ([], None, None)


def test_without_json_it_is_a_table(command_line: CommandLine) -> None:
    code, out, _ = command_line.here("statics", *POSE, "--mu", "1.5")
    assert code == 0
    assert "holds from mu" in out
    assert "contact 3 (N)" in out
    out = command_line.here("statics", *POSE, "--mu", "2", "--include", "reaction,forces_range,modes")[1]
    for text in ("reaction, size (N)", "3 dimensions", "to no limit", "opens, sticks, sticks, turns"):
        assert text in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--mu", "-0.1"), "mu is -0.1; valid: a finite number >= 0"),
        (("--mu", "nan"), "mu"),
        (("--force", "0,0,0"), "force is (0.0, 0.0, 0.0); valid: a force or a moment that is not zero"),
        (("--force", "1,2"), "--force is '1,2'; valid: three numbers, separated by commas"),
        (("--include", "reaction,mode"), "include is 'mode'; valid: reaction, forces_range, modes"),
        (("--point", "1,x,2"), "--point is '1,x,2'"),
        (("--moment", "inf,0,0"), "moment"),
    ],
)
def test_bad_input_is_named(command_line: CommandLine, arguments: tuple[str, ...], message: str) -> None:
    code, out, err = command_line.here("statics", *POSE, *arguments)
    assert (code, out) == (2, "")
    assert message in err
