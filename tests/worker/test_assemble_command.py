"""``threadstate assemble``."""

from __future__ import annotations

import json

import pytest

from tests.worker.conftest import CommandLine

pytestmark = [pytest.mark.slow, pytest.mark.sqlite_alone]

POSE = ("--roll", "0", "--pitch", "-4", "--phase", "300")


def test_a_pose_is_one_object(command_line: CommandLine) -> None:
    code, out, err = command_line.here("assemble", *POSE, "--unit", "mm", "--json")
    assert (code, err) == (0, "")
    found = json.loads(out)
    assert list(found) == [
        *("roll", "pitch", "phase", "unit", "strategy", "mu", "outcome", "flags", "start", "events", "path"),
        *("energy", "margins", "travel"),
    ]
    assert (found["unit"], found["strategy"], found["outcome"]) == ("mm", "ccw_then_cw", "engaged")
    assert found["start"]["outcome"] == "settled"
    assert len({len(column) for column in found["path"].values()}) == 1
    assert found["path"]["phase"][0] == 300.0
    assert [event["kind"] for event in found["events"]].count("snap") == 1
    # Engaged: deeper than half a pitch of 1.27 mm.
    assert found["path"]["pose"][-1]["translation"][2] < -0.63


def test_without_json_it_is_a_table(command_line: CommandLine) -> None:
    code, out, _ = command_line.here("assemble", *POSE, "--strategy", "cw")
    assert code == 0
    assert "outcome" in out
    assert "energy, balance (N in)" in out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--strategy", "sideways"), "ccw_then_cw"),
        (("--mu", "-0.1"), "mu is -0.1"),
        (("--device", "nothing.toml"), "nothing.toml"),
    ],
)
def test_bad_input_is_a_clear_error(command_line: CommandLine, arguments: tuple[str, ...], words: str) -> None:
    code, out, err = command_line.here("assemble", *POSE, *arguments)
    assert (code, out) == (2, "")
    assert words in err
