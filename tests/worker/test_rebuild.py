from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from sqlalchemy import select

from tests.prepared import use_prepared_chunks
from tests.stored_histories.history_library import histories_of_grid, rows_of
from tests.worker.conftest import GRID, ONE_ORIENTATION, SMALL_GRID, CommandLine
from threadstate.errors import NotFoundError
from threadstate.library.engine import reader_engine
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import latest_library, states_between
from threadstate.library.rows import HistoryRows
from threadstate.library.schema import stored_revision
from threadstate.library.tables import chunk
from threadstate.state.solve import SolveOptions, solve_poses
from threadstate.stored_histories.mapping import formations, orientation_history, stored_histories
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.processes import ComputeError, computing_processes

pytestmark = pytest.mark.slow

TIMEOUT_S = 60.0


@pytest.fixture(scope="module")
def expected_histories() -> list[HistoryRows]:
    """The rows of the histories of the small library, computed in this process."""
    return [rows_of(history) for history in histories_of_grid(GRID)]


def _committed(database: str) -> int:
    """How many chunks are committed; 0 where there is no schema yet."""
    engine = reader_engine(database)
    try:
        if stored_revision(engine) is None:
            return 0
        with engine.connect() as connection:
            return len(connection.execute(select(chunk.c.orientation)).all())
    finally:
        engine.dispose()


def _is_published(database: str) -> bool:
    engine = reader_engine(database)
    try:
        if stored_revision(engine) is None:
            return False
        with engine.connect() as connection:
            latest_library(connection)
    except NotFoundError:
        return False
    else:
        return True
    finally:
        engine.dispose()


def _alive_in_group(group: int) -> list[int]:
    """The living processes of a process group; what is dead and only waits to be collected does not count."""
    alive = []
    for entry in Path("/proc").iterdir():
        try:
            state, _, process_group = (entry / "stat").read_text().rpartition(")")[2].split()[:3]
        except (OSError, ValueError):
            continue
        if int(process_group) == group and state not in "ZX":
            alive.append(int(entry.name))
    return alive


def _wait_for(condition: Callable[[], bool]) -> bool:
    """Whether the condition came true while there was patience."""
    end = time.monotonic() + TIMEOUT_S
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.02)
    return False


def _kill(process: subprocess.Popen[str]) -> None:
    """SIGKILL for the parent alone; its children have to notice by themselves."""
    process.kill()
    process.communicate()
    assert _wait_for(lambda: not _alive_in_group(process.pid)), "computing processes were left behind"


@pytest.mark.sqlite_alone
def test_the_content_does_not_depend_on_the_number_of_workers(command_line: CommandLine, expected_content: str) -> None:
    # By one worker: test_two_rebuilds_at_once_make_one_library.
    result = json.loads(command_line.out("rebuild", *SMALL_GRID, "--workers", "3", "--json"))
    assert result["content_sha256"] == expected_content
    assert result["computed"] == result["states"] == GRID.pose_count
    assert not result["was_published"]


def test_what_is_stored_is_what_the_solver_says(
    command_line: CommandLine,
    monkeypatch: pytest.MonkeyPatch,
    expected_content: str,
    expected_histories: list[HistoryRows],
) -> None:
    use_prepared_chunks(monkeypatch)
    command_line.out("rebuild", *SMALL_GRID)
    engine = reader_engine(command_line.database)
    with engine.connect() as connection:
        library = latest_library(connection)
        chunks = [
            states_between(connection, library.id, GRID.first_ordinal(index), GRID.first_ordinal(index + 1) - 1)
            for index in range(GRID.orientation_count)
        ]
        histories = stored_histories(connection, library.id, GRID)
    engine.dispose()
    assert library.content_sha256 == expected_content
    pair = quarter_twenty_unc()
    assert chunks == [solve_poses(pair, GRID.poses(index)) for index in range(GRID.orientation_count)]
    assert histories is not None
    assert histories.orientations == tuple(
        orientation_history(index, rows, formations(rows.formations)) for index, rows in enumerate(expected_histories)
    )
    assert library.input_sha256 == LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions()).sha256


@pytest.mark.sqlite_alone
def test_rebuilding_the_same_is_nothing_to_do(command_line: CommandLine) -> None:
    first = json.loads(command_line.out("rebuild", *ONE_ORIENTATION, "--json"))
    path = Path(command_line.database.removeprefix("sqlite:///"))
    content = path.read_bytes()
    second = json.loads(command_line.out("rebuild", *ONE_ORIENTATION, "--json"))
    assert second["was_published"]
    assert second["computed"] == 0
    assert (second["library"], second["content_sha256"]) == (first["library"], first["content_sha256"])
    assert "published already; nothing to do" in command_line.out("rebuild", *ONE_ORIENTATION)
    assert path.read_bytes() == content


@pytest.mark.sqlite_alone
def test_another_grid_makes_another_library(command_line: CommandLine) -> None:
    first = json.loads(command_line.out("rebuild", *ONE_ORIENTATION, "--json"))
    second = json.loads(command_line.out("rebuild", "--tilt-max", "0", "--phase-step", "90", "--json"))
    assert second["library"] != first["library"]
    assert second["states"] == 4
    assert json.loads(command_line.out("summary", "--json"))["library"] == second["library"]


@pytest.mark.sqlite_alone
def test_killed_at_any_moment_and_commit_it_goes_on_to_the_same_bits(
    command_line: CommandLine, expected_content: str
) -> None:
    database = command_line.database
    moments = random.Random(20060116)
    for _ in range(3):
        with command_line.start("rebuild", *SMALL_GRID, "--workers", "2") as process:
            time.sleep(moments.uniform(0.0, 1.5))
            _kill(process)
        kept = _committed(database)
        assert not _is_published(database) or kept == GRID.orientation_count
    for committed in (1, 5, 8):
        with command_line.start("rebuild", *SMALL_GRID, "--workers", "2") as process:
            assert _wait_for(lambda wanted=committed: _committed(database) >= wanted)  # type: ignore[misc]
            _kill(process)
        kept = _committed(database)
        assert kept >= committed
    result = json.loads(command_line.out("rebuild", *SMALL_GRID, "--json"))
    assert result["content_sha256"] == expected_content
    assert result["was_published"] or result["computed"] == GRID.pose_count - kept * GRID.phase_count
    engine = reader_engine(database)
    with engine.connect() as connection:
        states = states_between(connection, result["library"], 0, GRID.pose_count - 1)
        ordinals = [state.phase_deg for state in states]
    engine.dispose()
    assert len(ordinals) == GRID.pose_count


@pytest.mark.sqlite_alone
def test_two_rebuilds_at_once_make_one_library(command_line: CommandLine, expected_content: str) -> None:
    command_line.here("migrate")
    with (
        command_line.start("rebuild", *SMALL_GRID, "--workers", "1", "--json") as one,
        command_line.start("rebuild", *SMALL_GRID, "--workers", "1", "--json") as other,
    ):
        results = [json.loads(process.communicate(timeout=TIMEOUT_S)[0]) for process in (one, other)]
    assert {result["content_sha256"] for result in results} == {expected_content}
    assert results[0]["library"] == results[1]["library"]
    assert sum(result["computed"] for result in results) == GRID.pose_count


@pytest.mark.sqlite_alone
def test_interrupted_it_says_so_and_leaves_no_process(command_line: CommandLine) -> None:
    with command_line.start("rebuild", *SMALL_GRID, "--phase-step", "0.5", "--workers", "2") as process:
        assert _wait_for(lambda: _committed(command_line.database) >= 1)
        os.killpg(process.pid, signal.SIGINT)
        _, err = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 130
    assert err.splitlines()[-1] == "threadstate: interrupted"
    assert _wait_for(lambda: not _alive_in_group(process.pid))


def test_the_death_of_a_computing_process_is_an_error() -> None:
    inputs = LibraryInputs(quarter_twenty_unc(), Grid(4.0, 1.0, 1.0), SolveOptions())
    with computing_processes(inputs, 2) as processes:
        chunks = processes.chunks(range(81), lambda: None)
        next(chunks)
        os.kill(processes.process_ids[0], signal.SIGKILL)
        with pytest.raises(ComputeError, match="died \\(exit code -9\\)"):
            list(chunks)


def test_a_computing_process_that_fails_says_why() -> None:
    inputs = LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions())
    with computing_processes(inputs, 1) as processes, pytest.raises(ComputeError, match="failed: IndexError"):
        list(processes.chunks([GRID.orientation_count], lambda: None))
