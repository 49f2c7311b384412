"""``threadstate report``."""

from __future__ import annotations

import datetime
import shlex
from dataclasses import replace
from pathlib import Path

import pytest

from tests.report.example import Page, number_of
from tests.worker.conftest import CommandLine
from tests.worker.test_success_command import INPUTS
from threadstate.library.grid import Grid
from threadstate.success.map_file import growing_map, inputs_of_map, read_map
from threadstate.success.summary import orientation_summary
from worker.success.run import computed_map_with_progress

pytestmark = [pytest.mark.slow, pytest.mark.sqlite_alone]

MAP = replace(INPUTS, grid=Grid(4.0, 4.0, 180.0))
DATE = ("--date", "2026-01-31")
LEVEL = ("--strategy", "cw", "--mu", "0", "--phases", "1", "--phase-tolerance", "360", "--tilt-max", "0")


@pytest.fixture(scope="module")
def whole_map(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of a map of 9 orientations and 2 phases, without friction."""
    path = tmp_path_factory.mktemp("report") / "whole.map"
    computed_map_with_progress(MAP, 2, path)
    return path


def test_a_map_is_all_that_a_report_needs(command_line: CommandLine, whole_map: Path, tmp_path: Path) -> None:
    out, before = tmp_path / "report.html", whole_map.read_bytes()
    out.write_text("an older page")
    said = command_line.out("report", "--out", str(out), "--map", str(whole_map), *DATE, "--title", "Wrist <B>")
    assert said == f"{out}: 9 orientations, map {computed_map_with_progress(MAP, 1, whole_map).content_sha256[:12]}\n"
    assert whole_map.read_bytes() == before
    page = Page(out.read_text(encoding="utf-8"))
    assert page.title == "Wrist <B>"
    stored = read_map(whole_map, MAP)
    engaged = [orientation_summary(one, MAP.grid, 0.0).engaged for one in stored]
    assert 0 < sum(engaged) < 18
    rows = page.table("Every orientation of the map").rows
    assert [(number_of(row[0]), number_of(row[1])) for row in rows] == [(one.roll_deg, one.pitch_deg) for one in stored]
    assert [row[5] for row in rows] == [f"{count} of 2" for count in engaged]
    assert dict(page.table("What the numbers hang on").rows)["input hash of the map"] == MAP.sha256
    assert list(tmp_path.iterdir()) == [out]


def test_the_command_on_the_page_writes_it_again(
    command_line: CommandLine, whole_map: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "device.map").write_bytes(whole_map.read_bytes())
    for pose in ((), ("--roll", "1", "--pitch", "-2", "--phase", "10", "--path-mu", "0", "--unit", "mm")):
        command_line.out("report", "--out", "first.html", "--map", "device.map", *DATE, "--title", "it's one", *pose)
        first = (tmp_path / "first.html").read_bytes()
        page = Page(first.decode())
        program, *arguments = shlex.split(page.code[0].replace("\\\n", " "))
        assert program == "threadstate"
        command_line.out(*arguments)
        assert (tmp_path / "report.html").read_bytes() == first
        assert any("This path was asked for." in text for text in page.paragraphs) == bool(pose)


def test_a_map_that_is_gone_on_with_gives_the_same_page(
    command_line: CommandLine, whole_map: Path, tmp_path: Path
) -> None:
    part = tmp_path / "part.map"
    lines = whole_map.read_bytes().splitlines(keepends=True)
    part.write_bytes(b"".join(lines[:-2]) + lines[-2][:50])
    pages = []
    for name, path in (("whole", whole_map), ("part", part)):
        out = tmp_path / f"{name}.html"
        command_line.out("report", "--out", str(out), "--map", str(path), *DATE, "--workers", "1")
        pages.append(out.read_bytes())
    assert pages[0] == pages[1]
    assert read_map(part, MAP) == read_map(whole_map, MAP)


def test_without_a_file_the_map_is_computed(command_line: CommandLine, tmp_path: Path) -> None:
    pages = []
    for name, map_options in (("none", ()), ("new", ("--map", str(tmp_path / "new.map")))):
        out = tmp_path / f"{name}.html"
        command_line.out("report", "--out", str(out), *LEVEL, *DATE, *map_options)
        pages.append(out.read_bytes())
    assert pages[0] == pages[1]
    made = inputs_of_map(tmp_path / "new.map")
    assert made == replace(INPUTS, grid=Grid(0.0, 1.0, 360.0))
    command_line.out("report", "--out", str(tmp_path / "today.html"), "--map", str(tmp_path / "new.map"))
    today = Page((tmp_path / "today.html").read_text(encoding="utf-8"))
    date = datetime.date.fromisoformat(dict(today.table("What the numbers hang on").rows)["date"])
    assert abs(date - datetime.datetime.now(datetime.UTC).date()) <= datetime.timedelta(days=1)
    assert today.title == "Assembly of 1/4-20 UNC"


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (("--out", "nowhere/report.html"), "--out is 'nowhere/report.html'; valid: a file in a folder that exists"),
        (("--out", "report.txt"), "valid: a file whose name ends in .html"),
        (("--out", "folder.html"), "valid: a file whose name ends in .html"),
        (("--map", "report.html"), "valid: another file than --out"),
        (("--map", "notes.map"), "map file is 'notes.map'; valid: a success map"),
        (("--map", "folder.html"), "map file is 'folder.html'; valid: a file that can be read"),
        (("--map", "cw.map", "--strategy", "ccw_then_cw"), "a map of the same inputs and code"),
        (("--map", "cw.map", "--phases", "4"), "a map of the same inputs and code"),
        (("--map", "cw.map", "--mu", "0.1"), "a map of the same inputs and code"),
        (("--map", "cw.map", "--pair", "M6"), "a map of the same inputs and code"),
        (("--map", "older.map"), "a map of the same inputs and code"),
        (("--roll", "1"), "--pitch is None; valid: an angle in degrees beside those of the others"),
        (("--roll", "1", "--pitch", "2"), "--phase is None"),
        (("--path-mu", "0.1"), "--path-mu is 0.1; valid: a friction beside --roll, --pitch and --phase"),
        (("--roll", "11", "--pitch", "2", "--phase", "0"), "roll is 11.0"),
        (("--roll", "1", "--pitch", "2", "--phase", "0", "--path-mu", "2"), "mu is 2.0"),
        (("--date", "31.1.2026"), "--date is '31.1.2026'; valid: a day as 2026-01-31"),
        (("--title", "\udcff"), "--title is '\\udcff'; valid: text in UTF-8"),
        (("--mu", "0.2,0.1"), "valid: frictions that ascend"),
        (("--phases", "7"), "phases is 7"),
        (("--pair", "M6 with sharp corners"), "bolt_root_fillet is 0.0; valid: at least 0.01"),
        (("--device", "nothing.toml"), "nothing.toml"),
    ],
)
def test_what_is_not_valid_is_a_clear_error_and_writes_nothing(
    command_line: CommandLine,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    options: tuple[str, ...],
    named: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.html").mkdir()
    (tmp_path / "notes.map").write_text("# Notes\n")
    with growing_map(tmp_path / "cw.map", MAP):
        header = (tmp_path / "cw.map").read_text()
    (tmp_path / "older.map").write_text(header.replace(MAP.sha256, "0" * 64))
    before = {path.name for path in tmp_path.iterdir()}
    out = () if "--out" in options else ("--out", "report.html")
    code, said, err = command_line.here("report", *out, *options)
    assert (code, said) == (2, "")
    assert named in err
    assert {path.name for path in tmp_path.iterdir()} == before


def test_a_page_is_required(command_line: CommandLine) -> None:
    code, _, err = command_line.here("report", "--tilt-max", "0")
    assert code == 2
    assert "--out" in err
