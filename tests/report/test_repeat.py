"""The files and the command that a report shows give its inputs back."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path

import pytest

from tests.report.example import INPUTS, orientations
from tests.report.test_contents import NO_PATH, POSE, report_of
from threadstate.device.model import About, Device, default_device, diagonal_device
from threadstate.report import repeat
from threadstate.report.contents import made_report
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.pair import Pair
from threadstate.units import LengthUnit
from worker.commands.settle import read_device
from worker.pairs.selection import pair_of_file

OWN = replace(pair_by_designation("M6"), designation='my "M6" \\ é \x7f \t 1')
_ROWS = [[3.0 if i == j else 0.1 if i + j == 3 else 0.0 for j in range(6)] for i in range(6)]
"""With a coupling of turn and shift; the twist is rigid."""
MATRIX = Device(
    tuple(tuple(0.0 if 2 in (i, j) else value for j, value in enumerate(row)) for i, row in enumerate(_ROWS)),
    centre=-1e-7,
    push=7.5,
    unit=LengthUnit.INCH,
    about=About.BOLT,
)
SOFT = diagonal_device(
    k_lateral=3.0, k_axial=0.25, k_tilt=50.5, k_twist=12.0, centre=10.0, push=4.0, unit=LengthUnit.MILLIMETRE
)


@pytest.mark.parametrize("device", [default_device(), SOFT, MATRIX])
def test_the_file_of_a_device_is_that_device(device: Device, tmp_path: Path) -> None:
    path = tmp_path / "device.toml"
    path.write_text(repeat.device_toml(device), encoding="utf-8")
    assert read_device(path) == device
    assert repeat.is_default(device) == (device == default_device())


@pytest.mark.parametrize("pair", [OWN, replace(pair_by_designation("1/4-20 UNC-3A/3B"), designation="own", starts=2)])
def test_the_file_of_a_pair_is_that_pair(pair: Pair, tmp_path: Path) -> None:
    inputs = replace(INPUTS, pair=pair)
    made = replace(report_of(orientations()), inputs=inputs)
    path = tmp_path / "pair.toml"
    path.write_text(repeat.pair_toml(made), encoding="utf-8")
    assert pair_of_file(path) == pair
    assert not repeat.is_in_catalogue(pair)
    assert "--pair pair.toml" in repeat.command(made)


def test_the_command_names_a_known_pair_and_a_pose_that_was_asked_for() -> None:
    title = """it's "odd" $HOME; <b>"""
    made = replace(report_of(orientations()), title=title)
    words = shlex.split(repeat.command(made).replace("\\\n", " "))
    options = dict(zip(words[2::2], words[3::2], strict=True))
    assert words[:2] == ["threadstate", "report"]
    assert options["--title"] == title
    assert options["--pair"] == "1/4-20 UNC"
    assert options["--mu"] == "0,0.1,0.2"
    assert (options["--phases"], options["--tilt-max"], options["--tilt-step"]) == ("2", "2", "1")
    assert (options["--roll"], options["--path-mu"]) == ("0", "0")
    assert "--device" not in options
    default = made_report(
        INPUTS,
        orientations(),
        replace(POSE, is_default=True),
        NO_PATH,
        unit=LengthUnit.INCH,
        title="",
        date=made.date,
        libraries=(),
    )
    assert "--roll" not in repeat.command(default)
    assert "--device device.toml" in repeat.command(replace(made, inputs=replace(INPUTS, device=SOFT)))
