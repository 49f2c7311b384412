"""Clocks that are set: every look at the wall clock is a day earlier than the one before, and nothing comes of it."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta, tzinfo
from pathlib import Path

import pytest
from sqlalchemy import Engine

from harness.databases import Databases
from tests.jobs.jobs import GRID, INPUTS, events, opened, published_count, read_job, work_off
from tests.library.states import plain_state
from threadstate.jobs.names import EventKind, JobState
from threadstate.jobs.queue import submit_job
from threadstate.jobs.work import lease_chunks, publish_job
from threadstate.jobs.workers import LostLeaseError, beats, join, remove_dead_worker
from threadstate.library.engine import writing
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import latest_library
from threadstate.library.rows import chunk_rows
from threadstate.library.write import open_library, publish, write_chunk
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.jobs.heartbeat import SilenceDetector

TELL_TIME = {
    "threadstate/jobs/queue.py",
    "threadstate/library/write.py",
    "threadstate/settled/write.py",
    "threadstate/success/write.py",
    "threadstate/access/keys.py",
    "threadstate/client/retrying.py",
    "service/logs.py",
    "service/metrics.py",
    "threadstate/_numba_cache.py",
}
"""Files that write down when something happened, or show its age; some servers tell a client until when to wait.

Compiled kernels that nobody has used for a month are removed: too early at worst, and they are compiled again.
"""
WALL_CLOCKS = {"now", "utcnow", "today", "time", "time_ns", "localtime", "gmtime", "current_timestamp", "fromtimestamp"}
INSTANTS = {"at", "asked_at", "ended_at", "created_at", "revoked_at"}


class SetBack(datetime):
    """A wall clock that is set back by a day before each look."""

    looks = 0

    @classmethod
    def now(cls, tz: tzinfo | None = None) -> datetime:  # type: ignore[override]
        cls.looks += 1
        return datetime(2026, 1, 28, tzinfo=tz or UTC) - timedelta(days=cls.looks)


@pytest.fixture
def engine(databases: Databases, monkeypatch: pytest.MonkeyPatch) -> Iterator[Engine]:
    """An engine in a world whose clock goes back."""
    for module in ("threadstate.jobs.queue", "threadstate.jobs.queue", "threadstate.library.write"):
        monkeypatch.setattr(f"{module}.datetime", SetBack)
    with databases.lent() as database, writing(database) as engine:
        yield engine


def test_a_job_goes_its_way(engine: Engine) -> None:
    job = submit_job(engine, INPUTS)
    library_id = opened(engine, job.id)
    silent, other = join(engine, "silent"), join(engine, "other")
    lease_chunks(engine, silent, job.id, 3)
    assert remove_dead_worker(engine, silent, beats(engine)[silent])
    assert work_off(engine, other, job.id, library_id) == GRID.orientation_count
    with pytest.raises(LostLeaseError):
        publish_job(engine, silent, job.id, library_id, GRID)
    assert publish_job(engine, other, job.id, library_id, GRID)
    done = read_job(engine, job.id)
    assert (done.state, published_count(engine)) == (JobState.DONE, 1)
    assert done.ended_at is not None
    assert done.ended_at < done.asked_at, "the clock was set back, and that is all there is to see of it"
    told = events(engine, job.id)
    assert [event.number for event in told] == list(range(1, len(told) + 1))
    assert (told[0].kind, told[-1].kind) == (EventKind.QUEUED, EventKind.PUBLISHED)


def test_what_is_published_last_is_the_latest(engine: Engine) -> None:
    for phase_step in (180.0, 120.0, 90.0):
        grid = Grid(0.0, 1.0, phase_step)
        inputs = LibraryInputs(quarter_twenty_unc(), grid, SolveOptions())
        library_id = open_library(engine, inputs)
        states = [plain_state(*pose) for pose in grid.poses(0)]
        write_chunk(engine, library_id, chunk_rows(grid.orientation(0), 0, states))
        publish(engine, library_id, grid)
        with engine.connect() as connection:
            assert latest_library(connection).id == library_id


def test_nobody_is_taken_for_dead_by_a_clock_that_is_set(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail() -> float:
        raise AssertionError("the wall clock was read")

    steady = iter(range(100))
    watch = SilenceDetector(1.5, clock=lambda: 0.5 * next(steady))
    monkeypatch.setattr("time.time", fail)
    monkeypatch.setattr("time.time_ns", fail)
    assert [watch.silent({"one": 1}) for _ in range(4)] == [[], [], [], []]
    assert watch.silent({"one": 1}) == [("one", 1)]


def test_the_wall_clock_is_written_down_and_never_decides(repository_root: Path) -> None:
    telling = set()
    for room in ("threadstate", "worker", "service"):
        for path in (repository_root / room).rglob("*.py"):
            name = path.relative_to(repository_root).as_posix()
            tree = ast.parse(path.read_text())
            if any(_reads_wall_clock(node) for node in ast.walk(tree)):
                telling.add(name)
            if name.startswith(("threadstate/jobs", "worker/jobs", "threadstate/access")):
                compared = [
                    node.lineno for node in ast.walk(tree) if isinstance(node, ast.Compare) and _has_instant(node)
                ]
                assert compared == [], f"{name} compares instants"
    assert telling == TELL_TIME


def _reads_wall_clock(node: ast.AST) -> bool:
    return (
        isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and node.func.attr in WALL_CLOCKS
        and isinstance(node.func.value, ast.Name)
        and node.func.value.id in ("time", "datetime", "date", "func")
    )


def _has_instant(node: ast.Compare) -> bool:
    against_nothing = all(isinstance(one, ast.Constant) and one.value is None for one in node.comparators)
    return not against_nothing and any(
        (isinstance(inner, ast.Attribute) and inner.attr in INSTANTS)
        or (isinstance(inner, ast.Name) and inner.id == "now")
        for inner in ast.walk(node)
    )
