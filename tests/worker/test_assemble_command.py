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
        (("--longest-step", "0.1"), "longest_step is 0.1; valid: 0.25 to 2 deg"),
        (("--longest-step", "long"), "long"),
        (("--longest-step", "0.25", "--confirm"), "longest_step is 0.25; valid: 0.5 to 2 deg with `confirm`"),
    ],
)
def test_bad_input_is_a_clear_error(command_line: CommandLine, arguments: tuple[str, ...], words: str) -> None:
    code, out, err = command_line.here("assemble", *POSE, *arguments)
    assert (code, out) == (2, "")
    assert words in err


def test_a_confirmed_path_says_whether_half_the_step_changes_it(command_line: CommandLine) -> None:
    """With half of 0.5 deg a contact of this path is replaced by another one for a moment."""
    pose = ("--roll", "-2.2228707478823733", "--pitch", "-0.16150614490357995", "--phase", "129.314909475504")
    asked = ("assemble", *pose, "--mu", "0.2", "--strategy", "cw", "--longest-step", "0.5", "--json")
    alone, confirmed = (json.loads(command_line.here(*asked, *more)[1]) for more in ((), ("--confirm",)))
    assert confirmed.pop("flags") == [*alone.pop("flags"), "step_dependent"]
    assert confirmed == alone


def test_shorter_steps_have_more_points_and_the_same_end(command_line: CommandLine) -> None:
    found = [
        json.loads(command_line.here("assemble", *POSE, "--strategy", "cw", *step, "--json")[1])
        for step in ((), ("--longest-step", "2"), ("--longest-step", "0.5"))
    ]
    assert found[0] == found[1]
    assert len(found[2]["path"]["phase"]) > 2 * len(found[0]["path"]["phase"])
    assert found[2]["outcome"] == found[0]["outcome"]
    ends = [one["path"]["pose"][-1]["translation"] for one in found]
    assert ends[2] == pytest.approx(ends[0], abs=1e-6)
