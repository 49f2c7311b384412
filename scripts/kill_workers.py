"""Kills workers of jobs by SIGKILL, again and again, and checks what is left: ``make kills``.

Two workers are at one job after another; at random moments one is killed and another one started. After every death and
at the end of each job it is checked that no library is visible that is not whole, and that a whole one is the one that
``rebuild`` computes, with each state once.
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from sqlalchemy import Engine, delete, func, select

from harness.databases import Databases, PostgresqlDatabases, SqliteDatabases
from harness.postgresql_server import running_server
from threadstate.jobs.model import JobRecord
from threadstate.jobs.names import EventKind, JobState
from threadstate.jobs.queue import events_after, job_by_id, submit_job
from threadstate.jobs.tables import job, job_chunk, job_worker
from threadstate.library.engine import writing
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import published_libraries
from threadstate.library.tables import chunk, library, state
from threadstate.settings import DATABASE, LEASE_S
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.rebuild import rebuild

GRID = Grid(tilt_max_deg=2.0, tilt_step_deg=1.0, phase_step_deg=15.0)
INPUTS = LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions())
WORKERS = 2
LEASE = "1"
LONGEST_PAUSE_S = 8.0
COMMAND = (sys.executable, "-c", "from worker.cli import main; main()", "worker", "--workers", "1")


@dataclass(frozen=True)
class Tally:
    """What happened: workers killed, of these with chunks in hand; jobs that were done."""

    kills: int
    in_hand: int
    jobs: int


class _Unwatched:
    def begin(self, committed: int, total: int) -> None: ...

    def ready(self) -> None: ...

    def advance(self, poses: int) -> None: ...


def kill_workers(databases: Databases, kills: int, seed: int) -> Tally:
    """Kill that many workers on a new database.

    Raises:
        AssertionError: something is lost, doubled or visible too early.
    """
    moments = random.Random(seed)
    with writing(databases.migrated()) as engine:
        expected = rebuild(engine, INPUTS, WORKERS, _Unwatched()).content_sha256
    database = databases.migrated()
    done = killed = in_hand = 0
    with writing(database) as engine, _workers(database) as workers:
        current = submit_job(engine, INPUTS)
        while killed < kills or current.state is not JobState.DONE:
            time.sleep(moments.uniform(0.0, LONGEST_PAUSE_S) if killed < kills else 0.2)
            current = _job(engine, current.id)
            _check(engine, current, expected)
            if current.state is JobState.DONE:
                done += 1
                if killed < kills:
                    _forget(engine)
                    current = submit_job(engine, INPUTS)
            if killed < kills:
                victim = moments.randrange(WORKERS)
                in_hand += _holds_chunks(engine, workers[victim].pid)
                os.kill(workers[victim].pid, signal.SIGKILL)
                workers[victim].wait()
                killed += 1
                workers[victim] = _start(database)
    return Tally(killed, in_hand, done)


def _check(engine: Engine, current: JobRecord, expected: str) -> None:
    with engine.connect() as connection:
        published = [one.content_sha256 for one in published_libraries(connection)]
        chunks = connection.scalar(select(func.count()).select_from(chunk))
        states = connection.scalar(select(func.count()).select_from(state))
        events = events_after(connection, current.id, 0)
    assert current.state is not JobState.FAILED, current.reason
    if current.state is not JobState.DONE:
        # Read after the job's state: it may have been done meanwhile.
        assert published in ([], [expected]), published
        return
    assert published == [expected]
    assert (chunks, states) == (GRID.orientation_count, GRID.pose_count)
    progress = [event.done_count for event in events if event.kind is EventKind.PROGRESS]
    assert progress == sorted(set(progress)), progress
    assert [event.kind for event in events].count(EventKind.PUBLISHED) == 1


def _holds_chunks(engine: Engine, pid: int) -> bool:
    held = select(job_chunk.c.orientation).join(job_worker).where(job_worker.c.name.endswith(f":{pid}")).limit(1)
    with engine.connect() as connection:
        return connection.scalar(held) is not None


def _forget(engine: Engine) -> None:
    with engine.begin() as connection:
        connection.execute(delete(library))
        connection.execute(delete(job))


def _job(engine: Engine, job_id: int) -> JobRecord:
    with engine.connect() as connection:
        return job_by_id(connection, job_id)


@contextmanager
def _workers(database: str) -> Iterator[list[subprocess.Popen[bytes]]]:
    workers = [_start(database) for _ in range(WORKERS)]
    try:
        yield workers
    finally:
        for worker in workers:
            worker.terminate()
            worker.wait()


def _start(database: str) -> subprocess.Popen[bytes]:
    environment = {**os.environ, DATABASE: database, LEASE_S: LEASE}
    return subprocess.Popen(COMMAND, env=environment, stderr=subprocess.DEVNULL)


def main() -> None:
    """Kill workers on both kinds of database, and say how many."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=50, help="on each kind of database")
    parser.add_argument("--seed", type=int, default=20060128)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, running_server() as server:
        kinds: tuple[Databases, ...] = (SqliteDatabases(Path(folder)), PostgresqlDatabases(server))
        for databases in kinds:
            tally = kill_workers(databases, arguments.kills, arguments.seed)
            sys.stdout.write(
                f"{type(databases).__name__}: {tally.kills} workers killed, {tally.in_hand} of them with chunks in "
                f"hand; {tally.jobs} libraries published, each whole and the same: no chunk lost or doubled, none seen "
                "too early\n"
            )
            sys.stdout.flush()


if __name__ == "__main__":
    main()
