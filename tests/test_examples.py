"""Every script in examples/ is run as a user runs it, against a real service over a real library."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from tests.archive.history_library import SMALL_GRID, store_histories
from tests.databases import Databases
from tests.jobs.jobs import GRID, opened, work_off
from tests.service.running import running_service
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.client import Client
from threadstate.history.model import History
from threadstate.jobs.work import publish_job
from threadstate.jobs.workers import join
from threadstate.library.engine import writing

RUNS: dict[str, tuple[list[list[str]], list[str]]] = {
    "feel_before_the_window": (
        [["0", "-3"]],
        [r"^roll 0, pitch -3 deg; lengths in in$", r"^ *\d+\.\d\d%  \d+ others$", r"a snap of 0\.0\d+ at"],
    ),
    "windows_table": (
        [[], ["mm"]],
        [r"^roll  pitch  width \(deg\)  drop \((in|mm)\)", r"^ +0 +-3 +\d+\.\d{3} +0\.\d{6}"],
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
    "solve_own_poses": ([["1", "50"]], [r"^ *\d+\.\d\d%  stable_three_point$", r"^the largest turn .* pitch -?\d"]),
}
"""Of each script the arguments that it is run with, and what its output says every time."""


@pytest.fixture(scope="module")
def served(sqlite_databases: Databases, small_histories: list[History]) -> Iterator[Mapping[str, str]]:
    """The environment of scripts that find a service over the small library with histories."""
    database = sqlite_databases.migrated()
    store_histories(database, SMALL_GRID, small_histories)
    with running_service(database) as address:
        yield _environment(address)


def _environment(address: str, **more: str) -> dict[str, str]:
    return {**os.environ, "THREADSTATE_SERVICE": address, "PYTHONPATH": str(Path(__file__).parent.parent), **more}


def _output(script: Path, arguments: list[str], environment: Mapping[str, str]) -> str:
    run = subprocess.run(
        [sys.executable, str(script), *arguments], env=environment, check=False, capture_output=True, text=True
    )
    assert run.returncode == 0, run.stderr
    return run.stdout


@pytest.mark.parametrize("name", RUNS)
def test_it_runs_and_says_something(served: Mapping[str, str], repository_root: Path, name: str) -> None:
    runs, said = RUNS[name]
    for arguments in runs:
        output = _output(repository_root / "examples" / f"{name}.py", arguments, served)
        for line in said:
            assert re.search(line, output, re.M), output


def test_a_library_is_asked_for_and_waited_for(sqlite_databases: Databases, repository_root: Path) -> None:
    database = sqlite_databases.migrated()
    with writing(database) as engine, running_service(database) as address:
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
        assert len(path.read_text().splitlines()) <= 45, path.name


def test_the_lines_in_the_readme_run(served: Mapping[str, str], repository_root: Path, tmp_path: Path) -> None:
    (lines,) = re.findall(r"```python\n(.*?)```", (repository_root / "README.md").read_text(), re.S)
    script = tmp_path / "readme.py"
    script.write_text(lines.replace("http://127.0.0.1:8000", served["THREADSTATE_SERVICE"]))
    subprocess.run([sys.executable, str(script)], cwd=tmp_path, env=served, check=True)
    assert (tmp_path / "states.parquet").read_bytes().startswith(b"PAR1")
