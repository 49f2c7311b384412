from __future__ import annotations

import json
from pathlib import Path

import pytest
import trimesh

from tests.worker.conftest import CommandLine
from threadstate.mesh.export import ENDINGS, mesh_report
from threadstate.mesh.presets import Preset
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Part
from worker.exit_codes import ExitCode

pytestmark = pytest.mark.sqlite_alone

PAIR = quarter_twenty_unc()


@pytest.mark.parametrize("part", Part)
@pytest.mark.parametrize("ending", [*ENDINGS, "STL"])
def test_a_written_file_is_the_solid(command_line: CommandLine, tmp_path: Path, ending: str, part: Part) -> None:
    path = tmp_path / f"part.{ending}"
    code, out, err = command_line.here("mesh", "--part", part, "--preset", "coarse", "--out", str(path), "--json")
    assert (code, err) == (ExitCode.OK, "")
    report = json.loads(out)
    assert report["bytes"] == path.stat().st_size
    assert report["format"] == ending.lower()
    mesh = trimesh.load_mesh(path)
    assert isinstance(mesh, trimesh.Trimesh)
    mesh.merge_vertices()
    assert mesh.is_watertight
    assert len(mesh.faces) == report["triangles"]
    assert mesh.volume == pytest.approx(report["volume"], rel=1e-5)
    low, high = (0.0, 0.05) if part is Part.BOLT else (-0.05, 0.0)
    assert mesh.bounds[:, 2] == pytest.approx([low, high], abs=1e-8)


def test_json_is_the_report(command_line: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "nut.ply"
    _, out, _ = command_line.here("mesh", "--part", "nut", "--out", str(path), "--json")
    report = json.loads(out)
    made = mesh_report(PAIR, Part.NUT, Preset.PAPER.tessellation)
    assert report["watertight"] is True
    assert (report["part"], report["pair"], report["unit"], report["file"]) == ("nut", "1/4-20 UNC", "in", str(path))
    assert (report["chord_height"], report["angle_control"]) == (pytest.approx(1e-4), 0.5)
    for name in ("vertices", "triangles", "volume", "chord_deviation", "edge_deviation"):
        assert report[name] == getattr(made, name)


def test_a_chord_of_ones_own(command_line: CommandLine, tmp_path: Path) -> None:
    arguments = ["mesh", "--part", "bolt", "--chord", "5e-5", "--angle-control", "1", "--json"]
    report = json.loads(command_line.here(*arguments, "--out", str(tmp_path / "bolt.stl"))[1])
    assert report["chord_height"] == pytest.approx(5e-5)
    assert report["angle_control"] == 1.0
    assert report["chord_deviation"] < 5e-5


def test_a_scene_that_leaves_out_what_cannot_touch(command_line: CommandLine, tmp_path: Path) -> None:
    arguments = ["mesh", "--part", "nut", "--preset", "paper", "--scene", "edges"]
    report = json.loads(command_line.here(*arguments, "--json", "--out", str(tmp_path / "nut.stl"))[1])
    assert (report["scene"], report["watertight"]) == ("edges", False)
    assert report["triangles"] < 11252 / 2
    out = command_line.here(*arguments, "--out", str(tmp_path / "nut.stl"))[1]
    assert "scene edges: open where nothing can touch" in out
    assert "volume" not in out


def test_without_json_the_report_is_prose(command_line: CommandLine, tmp_path: Path) -> None:
    code, out, _ = command_line.here("mesh", "--part", "bolt", "--out", str(tmp_path / "bolt.stl"))
    assert code == ExitCode.OK
    assert "11252 triangles" in out
    assert "watertight" in out
    assert "NOT" not in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--part", "washer", "--out", "x.stl"], "'washer' is not one of"),
        (["--part", "bolt"], "--out"),
        (["--out", "x.stl"], "--part"),
        (["--part", "bolt", "--out", "x.obj"], "ending of the file is 'x.obj'; valid: .stl, .ply, .glb"),
        (["--part", "bolt", "--out", "x"], "ending of the file is 'x'"),
        (["--part", "bolt", "--out", "x.stl", "--preset", "best"], "'best' is not one of"),
        (["--part", "bolt", "--out", "x.stl", "--chord", "0"], "chord_height is 0.0"),
        (["--part", "bolt", "--out", "x.stl", "--angle-control", "2"], "angle_control is 2.0; valid: 0 to 1"),
        (["--part", "bolt", "--out", "x.stl", "--scene", "none"], "'none' is not one of"),
        (["--part", "bolt", "--out", "x.stl", "--scene", "curves"], "--scene is 'curves'; valid: full, band, edges"),
        (["--part", "bolt", "--out", "x.stl", "--pair", "M7"], "designation is 'M7'"),
    ],
)
def test_a_bad_value_ends_with_2_and_writes_nothing(
    command_line: CommandLine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: list[str], message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, err = command_line.here("mesh", *arguments)
    assert (code, out) == (ExitCode.USAGE, "")
    assert message in err
    assert len(err.splitlines()) == 1
    assert list(tmp_path.glob("x*")) == []


def test_a_file_that_cannot_be_written_ends_with_1(command_line: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "no-such-folder" / "bolt.stl"
    code, out, err = command_line.here("mesh", "--part", "bolt", "--out", str(path))
    assert (code, out) == (ExitCode.FAILURE, "")
    assert f"cannot write '{path}': No such file or directory" in err
    assert len(err.splitlines()) == 1


def test_help_keeps_its_examples_a_line_each(command_line: CommandLine) -> None:
    lines = command_line.here("mesh", "--help")[1].splitlines()
    assert "    threadstate mesh --part bolt --out bolt.stl" in lines
