"""Workers as processes of their own: together, killed, asleep, and told to stop.

``scripts/kill_workers.py`` kills more of them.
"""

from __future__ import annotations

import os
import random
import signal
import sqlite3
import subprocess
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import Engine, select

from harness.databases import Databases
from tests.faults.conftest import Unwatched
from tests.worker.conftest import GRID, SHORT_TURNS, CommandLine, CommandProcess
from threadstate.jobs.model import JobRecord
from threadstate.jobs.names import EventKind, JobState
from threadstate.jobs.queue import cancel, events_after, job_by_id, submit_job
from threadstate.jobs.workers import beats
from threadstate.library.engine import writing
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import library_by_id, published_libraries
from threadstate.library.tables import chunk, state
from threadstate.settings import HEARTBEAT_FILE, LEASE_S
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.rebuild import rebuild

pytestmark = pytest.mark.slow

INPUTS = LibraryInputs(quarter_twenty_unc(), GRID, SHORT_TURNS)
LONG_INPUTS = LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions())
"""What is not finished before it is stopped."""
TIMEOUT_S = 120.0


class Jobs:
    """A database with jobs, and workers on it that take each other for dead after a second."""

    def __init__(self, engine: Engine, command_line: CommandLine) -> None:
        self.engine = engine
        self.command_line = command_line

    def start(self) -> CommandProcess:
        return self.command_line.start("worker", "--workers", "1", "--until-idle")

    def stop_between_writes(self, worker: CommandProcess) -> None:
        """SIGSTOP at a moment at which the worker does not hold SQLite's lock, with which nobody else could go on."""
        database = self.engine.url.database
        assert database is not None
        with closing(sqlite3.connect(database, timeout=0.0, isolation_level=None)) as connection:
            while True:
                os.kill(worker.pid, signal.SIGSTOP)
                os.waitpid(worker.pid, os.WUNTRACED)
                try:
                    connection.execute("BEGIN IMMEDIATE")
                except sqlite3.OperationalError:
                    os.kill(worker.pid, signal.SIGCONT)
                    time.sleep(0.01)
                else:
                    connection.execute("ROLLBACK")
                    return

    def job(self, job_id: int = 1) -> JobRecord:
        with self.engine.connect() as connection:
            return job_by_id(connection, job_id)

    def published(self) -> list[str]:
        with self.engine.connect() as connection:
            return [library.content_sha256 for library in published_libraries(connection)]

    def committed(self) -> int:
        with self.engine.connect() as connection:
            return len(connection.scalars(select(chunk.c.orientation)).all())


@pytest.fixture
def jobs(
    databases: Databases,
    environment: Mapping[str, str],
    capsys: pytest.CaptureFixture[str],
) -> Iterator[Jobs]:
    with databases.lent() as database, writing(database) as engine:
        yield Jobs(engine, CommandLine(database, {**environment, LEASE_S: "1"}, capsys))


def _wait_for(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + TIMEOUT_S
    while not condition():
        assert time.monotonic() < end, "in vain"
        time.sleep(0.01)


def _end(*workers: subprocess.Popen[str]) -> None:
    """Wait until workers have ended by themselves, without an error."""
    for worker in workers:
        _, err = worker.communicate(timeout=TIMEOUT_S)
        assert worker.returncode == 0, err


def _check_whole(jobs: Jobs, expected_content: str) -> None:
    """The library is the one that ``rebuild`` computes; no chunk is lost or doubled."""
    assert jobs.published() == [expected_content]
    done = jobs.job()
    assert (done.state, done.done_count) == (JobState.DONE, GRID.orientation_count)
    with jobs.engine.connect() as connection:
        assert done.published_id is not None
        assert library_by_id(connection, done.published_id).state_count == GRID.pose_count
        assert len(connection.execute(select(state.c.ordinal)).all()) == GRID.pose_count
        told = events_after(connection, done.id, 0)
    assert [event.number for event in told] == list(range(1, done.event_count + 1))
    progress = [event.done_count for event in told if event.kind is EventKind.PROGRESS]
    assert progress == sorted(set(progress))
    assert [event.kind for event in told].count(EventKind.PUBLISHED) == 1


@pytest.mark.postgresql_alone
def test_two_workers_compute_what_a_rebuild_does(jobs: Jobs, content_with_short_turns: str) -> None:
    submit_job(jobs.engine, INPUTS)
    with jobs.start() as one, jobs.start() as other:
        _end(one, other)
    _check_whole(jobs, content_with_short_turns)
    assert beats(jobs.engine) == {}


@pytest.mark.postgresql_alone
def test_killed_workers_leave_their_chunks_to_others(jobs: Jobs, content_with_short_turns: str) -> None:
    moments = random.Random(20060128)
    submit_job(jobs.engine, INPUTS)
    for _ in range(2):
        with jobs.start() as killed:
            before = jobs.committed()
            _wait_for(lambda before=before: jobs.job().lease_count > 0 or jobs.committed() > before)  # type: ignore[misc]
            time.sleep(moments.uniform(0.0, 0.5))
            killed.kill()
            killed.communicate()
        assert jobs.published() == [] or jobs.job().state is JobState.DONE
    with jobs.start() as last:
        _end(last)
    _check_whole(jobs, content_with_short_turns)


@pytest.mark.sqlite_alone
def test_a_worker_that_was_asleep_begins_anew_and_nothing_is_doubled(jobs: Jobs, content_with_short_turns: str) -> None:
    submit_job(jobs.engine, INPUTS)
    with jobs.start() as asleep:
        _wait_for(lambda: jobs.job().lease_count > 0)
        jobs.stop_between_writes(asleep)
        (sleeping,) = beats(jobs.engine)
        with jobs.start() as other:
            _wait_for(lambda: sleeping not in beats(jobs.engine))
            os.kill(asleep.pid, signal.SIGCONT)
            _end(other, asleep)
    _check_whole(jobs, content_with_short_turns)


@pytest.mark.sqlite_alone
def test_told_to_stop_a_worker_leaves_at_once(jobs: Jobs) -> None:
    submit_job(jobs.engine, LONG_INPUTS)
    with jobs.start() as worker:
        _wait_for(lambda: jobs.committed() > 0)
        worker.terminate()
        _, err = worker.communicate(timeout=TIMEOUT_S)
    assert worker.returncode == 0, err
    assert err.splitlines()[-1] == "stopped"
    assert beats(jobs.engine) == {}
    assert jobs.job().lease_count == 0
    assert jobs.published() == []


@pytest.mark.sqlite_alone
def test_a_worker_touches_its_heartbeat_file_while_the_database_takes_its_beats(
    databases: Databases, environment: Mapping[str, str], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    file = tmp_path / "heartbeat"
    with databases.lent() as database:
        commands = CommandLine(database, {**environment, LEASE_S: "1", HEARTBEAT_FILE: str(file)}, capsys)
        with commands.start("worker") as worker:
            _wait_for(file.exists)
            first = file.stat().st_mtime_ns
            _wait_for(lambda: file.stat().st_mtime_ns > first)
            os.kill(worker.pid, signal.SIGSTOP)
            last = file.stat().st_mtime_ns
            time.sleep(0.5)
            assert file.stat().st_mtime_ns == last
            os.kill(worker.pid, signal.SIGCONT)
            worker.terminate()
            worker.communicate(timeout=TIMEOUT_S)


@pytest.mark.sqlite_alone
def test_a_cancelled_job_is_left_alone(jobs: Jobs) -> None:
    asked = submit_job(jobs.engine, LONG_INPUTS)
    with jobs.start() as worker:
        _wait_for(lambda: jobs.committed() > 0)
        cancel(jobs.engine, asked.id)
        _end(worker)
    assert jobs.job().state is JobState.CANCELLED
    assert jobs.published() == []


@pytest.mark.sqlite_alone
def test_a_job_and_a_rebuild_at_once_make_one_library(jobs: Jobs, content_with_short_turns: str) -> None:
    submit_job(jobs.engine, INPUTS)
    with jobs.start() as worker:
        rebuilt = rebuild(jobs.engine, INPUTS, 1, Unwatched())
        _end(worker)
    assert rebuilt.content_sha256 == content_with_short_turns
    _check_whole(jobs, content_with_short_turns)
