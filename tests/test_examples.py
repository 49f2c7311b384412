"""Every script in examples/ is run as a user runs it, against a real service over a real library.

What a script prints of its own, without an answer of the service, is looked at within the test's process.
"""

from __future__ import annotations

import json
import os
import re
import runpy
import subprocess
import sys
import threading
import time
import urllib.request
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from harness.databases import Databases
from tests.falls_page import falls_shown
from tests.jobs.jobs import GRID, opened, work_off
from tests.service_thread import service_thread
from tests.stored_histories.history_library import SMALL_GRID, store_histories
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.client import Client
from threadstate.history.model import SolvedHistory
from threadstate.jobs.work import publish_job
from threadstate.jobs.workers import join
from threadstate.library.engine import writing

pytestmark = pytest.mark.slow

RUNS: dict[str, tuple[list[list[str]], list[str]]] = {
    "feel_before_the_window": (
        [["0", "-3"], ["0", "-3", "--library", "1/4-20 UNC"]],
        [
            r"^roll 0, pitch -3 deg; lengths in in$",
            r"^ *\d+\.\d\d%  \d+ others$",
            r"^snap: falls by 0\.0\d+ from phase \d+\.\d{3} to \d+\.\d{3} deg, 0\.0\d+ of it at once",
            r"^window: can go on down from phase",
        ],
    ),
    "windows_table": (
        [[], ["mm"]],
        [
            r"^lengths in (in|mm), angles in deg$",
            r"^ +0 +-3 +357\.\d{3} +357\.\d{3} +0\.\d{6}",
            r"^ +0 +3 +no snap +0\.",
        ],
    ),
    "where_am_i": (
        [["1:crest:surface:edge-surface", "2:*:*:flush"], ["1:crest"]],
        [
            r"^\d+\.\d{3}% of all phases remain, at \d orientations$",
            r"^roll .*: (\d+\.\d{3} deg, \d+ transitions|no window)",
        ],
    ),
    "shortest_turn": (
        [[], ["3"]],
        [r"^after \d+ of \d+ formations a window comes", r"^from the farthest:$", r"^ +0\.000 deg  \w{10}  \S"],
    ),
    "library_summary": (
        [[]],
        [r"^library 1: 1/4-20 UNC, 18 states, lengths in in$", r"^crest +surface +\d+ +\d+\.\d%"],
    ),
    "does_it_engage": (
        [["0", "-4", "300"]],
        [
            r"^phase +357\.668 deg: snap, down by 0\.1696 mm$",
            r"^engaged: \d+ equilibria$",
            r"^the hand gives way by up to 3\.86 deg",
        ],
    ),
    "solve_own_poses": ([["1", "50"]], [r"^ *\d+\.\d\d%  stable_three_point$", r"^the largest turn .* pitch -?\d"]),
}
"""Of each script the arguments that it is run with, and what its output says every time."""


NOBODY = "http://127.0.0.1:1"
SERVICE = "THREADSTATE_SERVICE"


@pytest.fixture(scope="module")
def served(sqlite_databases: Databases, small_histories: list[SolvedHistory]) -> Iterator[Mapping[str, str]]:
    """The environment of scripts that find a service over the small library with histories."""
    database = sqlite_databases.migrated()
    store_histories(database, SMALL_GRID, small_histories)
    with service_thread(database) as address:
        yield _environment(address)


def _environment(address: str, **more: str) -> dict[str, str]:
    return {**os.environ, SERVICE: address, "PYTHONPATH": str(Path(__file__).parent.parent), **more}


def _output(script: Path, arguments: list[str], environment: Mapping[str, str]) -> str:
    command = [sys.executable, str(script), *arguments]
    run = subprocess.run(command, env=environment, check=False, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return run.stdout


@dataclass(frozen=True)
class Ended:
    """How a script ended that was run in this process."""

    code: int
    out: str
    err: str


RunHere = Callable[[str, list[str], Mapping[str, str]], Ended]


@pytest.fixture
def run_here(repository_root: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> RunHere:
    """Runs a script by its name with arguments and variables of the environment."""

    def run(name: str, arguments: list[str], environment: Mapping[str, str]) -> Ended:
        script = str(repository_root / "examples" / f"{name}.py")
        monkeypatch.setattr(sys, "argv", [script, *arguments])
        for variable, value in environment.items():
            monkeypatch.setenv(variable, value)
        code, said = 0, ""
        try:
            runpy.run_path(script, run_name="__main__")
        except SystemExit as end:
            # As Python itself does: whatever is no number is printed, and the code is 1.
            code, said = (end.code or 0, "") if isinstance(end.code, int | None) else (1, f"{end.code}\n")
        out, err = capsys.readouterr()
        return Ended(code, out, err + said)

    return run


@pytest.mark.parametrize("name", RUNS)
def test_it_runs_and_says_something(served: Mapping[str, str], repository_root: Path, name: str) -> None:
    runs, said = RUNS[name]
    for arguments in runs:
        output = _output(repository_root / "examples" / f"{name}.py", arguments, served)
        for line in said:
            assert re.search(line, output, re.M), output


@pytest.mark.parametrize("tilt", [(0, -3), (3, -3), (3, 3), (-4, -4), (4, 0)])
def test_the_fall_printed_is_that_of_the_page(
    served: Mapping[str, str], repository_root: Path, tilt: tuple[int, int]
) -> None:
    # The library holds tilts of 3 deg; of any other the history is computed.
    shown = falls_shown(repository_root)[tilt]
    script = repository_root / "examples" / "feel_before_the_window.py"
    output = _output(script, [str(angle) for angle in tilt], served)
    (said,) = re.findall(r"^(?:no )?snap: falls by .*$", output, re.M)
    numbers = [float(number) for number in re.findall(r"\d+\.\d+", said)]
    if not shown.snaps:
        assert said.startswith("no snap: ")
        assert numbers == pytest.approx([float(shown.steepest), float(shown.steepest_from)], abs=6e-4)
        assert numbers[0] == pytest.approx(float(shown.steepest), abs=2e-6)
        return
    jump = [float(shown.jump), float(shown.jump_at)] if shown.jump_at else []
    assert numbers[0] == pytest.approx(float(shown.fall), abs=2e-6)
    assert numbers[1:3] == pytest.approx([float(shown.snap_from), float(shown.snap_to) % 360.0], abs=6e-4)
    assert numbers[3:4] == pytest.approx(jump[:1], abs=2e-6)
    assert numbers[4:] == pytest.approx(jump[1:], abs=6e-4)


def test_the_falls_served_are_those_of_the_page(served: Mapping[str, str], repository_root: Path) -> None:
    with urllib.request.urlopen(f"{served[SERVICE]}/v1/libraries/latest/windows") as response:
        orientations = json.load(response)["orientations"]
    shown = falls_shown(repository_root)
    assert len(orientations) == SMALL_GRID.orientation_count
    for one in orientations:
        row = shown[int(one["roll"]), int(one["pitch"])]
        assert one["steepest"] == pytest.approx(float(row.steepest), abs=6e-7)
        assert (one["snap"] is None) == (not row.snaps)
        if one["snap"] is not None:
            assert one["snap"]["fall"] == pytest.approx(float(row.fall), abs=6e-7)
            assert one["snap"]["jump"] == pytest.approx(float(row.jump), abs=6e-7)
            assert one["snap"]["from"] == pytest.approx(float(row.snap_from), abs=2e-6)
            assert one["snap"]["to"] == pytest.approx(float(row.snap_to), abs=2e-6)
            assert (one["snap"]["jump_at"] is None) == (row.jump_at == "")


@pytest.mark.parametrize("name", [*RUNS, "rebuild_and_wait"])
def test_help_is_printed_without_a_service(run_here: RunHere, name: str) -> None:
    ended = run_here(name, ["--help"], {SERVICE: NOBODY})
    assert ended.code == 0
    assert ended.out.startswith(f"usage: {name}.py ")


@pytest.mark.parametrize("name", [*RUNS, "rebuild_and_wait"])
def test_without_a_service_a_line_says_what_to_do(run_here: RunHere, name: str) -> None:
    arguments = ["1:crest"] if name == "where_am_i" else []
    ended = run_here(name, arguments, {SERVICE: NOBODY, "THREADSTATE_KEY": "key"})
    assert ended.code == 1
    said = ended.err.splitlines()[-1]
    assert f"no service answers at {NOBODY} (" in said
    assert "`threadstate serve`" in said


@pytest.mark.parametrize(
    ("name", "arguments", "code", "said"),
    [
        ("feel_before_the_window", ["four", "0"], 2, "argument roll: invalid float value: 'four'"),
        ("feel_before_the_window", ["12", "0"], 1, "path roll is '12'"),
        ("feel_before_the_window", ["1", "nan"], 1, "path pitch is 'nan'"),
        ("feel_before_the_window", ["1", "1", "--library", "7"], 1, "library 7 is not published"),
        ("windows_table", ["cm"], 2, "argument unit: invalid choice: 'cm'"),
        ("where_am_i", ["crest"], 1, "contact is 'crest'"),
        ("does_it_engage", ["12"], 1, "body pose roll is '12.0'"),
        ("does_it_engage", ["--k-tilt", "-1"], 1, "body device k_tilt is '-1.0'"),
        ("solve_own_poses", ["nan"], 2, "the spread is 0 to 10 deg"),
        ("solve_own_poses", ["1", "1001"], 2, "the number of poses 1 to 1000"),
    ],
)
def test_what_is_refused_is_said_in_a_line(
    served: Mapping[str, str], run_here: RunHere, name: str, arguments: list[str], code: int, said: str
) -> None:
    ended = run_here(name, arguments, {SERVICE: served[SERVICE]})
    assert ended.code == code
    assert said in ended.err.splitlines()[-1]


def test_a_library_is_asked_for_and_waited_for(sqlite_databases: Databases, repository_root: Path) -> None:
    database = sqlite_databases.migrated()
    with writing(database) as engine, service_thread(database) as address:
        key = create_key(engine, "designer", Scope.WRITE)

        def work() -> None:
            with Client(address) as client:
                while not (jobs := list(client.jobs())):
                    time.sleep(0.05)
            worker = join(engine, "one")
            library_id = opened(engine, jobs[0].id)
            work_off(engine, worker, jobs[0].id, library_id)
            assert publish_job(engine, worker, jobs[0].id, library_id, GRID)

        worker = threading.Thread(target=work, daemon=True)
        worker.start()
        script = repository_root / "examples" / "rebuild_and_wait.py"
        output = _output(script, ["1", "180"], _environment(address, THREADSTATE_KEY=key))
        worker.join()
    assert "100%" in output
    assert "library 1: 18 states" in output


def test_every_script_is_run_and_shown(repository_root: Path) -> None:
    names = {path.stem for path in (repository_root / "examples").glob("*.py")}
    assert names == {*RUNS, "rebuild_and_wait"}
    page = (repository_root / "docs" / "examples.md").read_text()
    assert names == set(re.findall(r"^## \[(\w+)\.py\]\(\.\./examples/\1\.py\)$", page, re.M))


def test_scripts_are_short(repository_root: Path) -> None:
    for path in (repository_root / "examples").glob("*.py"):
        assert len(path.read_text().splitlines()) <= 65, path.name


def test_the_lines_on_the_page_run(served: Mapping[str, str], repository_root: Path, tmp_path: Path) -> None:
    (lines,) = re.findall(r"```python\n(.*?)```", (repository_root / "docs" / "examples.md").read_text(), re.S)
    script = tmp_path / "shortest.py"
    script.write_text(lines.replace("http://127.0.0.1:8000", served[SERVICE]))
    subprocess.run([sys.executable, str(script)], cwd=tmp_path, env=served, check=True)
    assert (tmp_path / "states.parquet").read_bytes().startswith(b"PAR1")
