"""``threadstate jamming``."""

from __future__ import annotations

import json
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.worker.conftest import CommandLine

pytestmark = [pytest.mark.slow, pytest.mark.sqlite_alone]

POSE = ("--roll", "1", "--pitch", "-2", "--phase", "10")


def test_a_diagram_is_one_object_and_a_picture(command_line: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "jamming.svg"
    code, out, err = command_line.here("jamming", *POSE, "--mu", "0.5", "--json", "--plot", str(path))
    assert (code, err) == (0, "")
    found = json.loads(out)
    assert list(found) == [
        *("roll", "pitch", "phase", "mu", "axes", "load", "load_at", "contacts", "kind", "dimension", "vertices"),
        *("pieces", "rays", "window", "gap", "hull_gap", "wedged", "penetrating", "source"),
    ]
    assert (found["axes"], found["kind"], found["load_at"]) == (["fx", "my"], "bounded", [0.0, 0.0])
    firsts = [piece["first"] for piece in found["pieces"]]
    assert [piece["last"] for piece in found["pieces"]] == firsts[1:] + firsts[:1]
    assert found["contacts"] == [1, 2, 3]
    assert ElementTree.parse(path).getroot().get("class") == "jamming"


def test_the_diagram_has_no_unit(command_line: CommandLine) -> None:
    given = ("--axes", "my,fx", "--force", "0,0.05,-5", "--json")
    in_mm = json.loads(command_line.here("jamming", *POSE, *given, "--unit", "mm", "--point", "0.254,0,2.54")[1])
    inches = json.loads(command_line.here("jamming", *POSE, *given, "--point", "0.01,0,0.1")[1])
    assert in_mm["load"]["point"] == pytest.approx([0.254, 0.0, 2.54])
    assert in_mm["kind"] == inches["kind"] == "bounded"
    for axis in (0, 1):
        reach = [np.array(found["vertices"])[:, axis].max() for found in (in_mm, inches)]
        assert reach[0] == pytest.approx(reach[1], abs=in_mm["gap"] + inches["gap"])


def test_without_json_it_is_a_table(command_line: CommandLine) -> None:
    code, out, _ = command_line.here("jamming", *POSE, "--mu", "0.5")
    assert code == 0
    assert "bounded (the solids overlap)" in out
    assert "contacts 1, 2 stick; contact 3 lifts off" in out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--mu", "-1"), "mu is -1.0"),
        (("--axes", "fx"), "two different ones of fx, fy, mx, my, mz"),
        (("--contacts", "0"), "contact is 0; valid: 1 to 3"),
        (("--contacts", "one"), "whole numbers, separated by commas"),
        (("--window", "3"), "two numbers, separated by a comma"),
        (("--force", "0,0,1"), "a push: z below 0"),
        (("--plot", "jamming.png"), "a name that ends in .svg"),
    ],
)
def test_what_is_not_valid_is_named(command_line: CommandLine, options: tuple[str, ...], message: str) -> None:
    code, _, err = command_line.here("jamming", *POSE, *options)
    assert code == 2
    assert message in err
