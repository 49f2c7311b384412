"""Jobs through the client, on a real service and, where it fails, on one that says what a test wants."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from dataclasses import dataclass

import anyio
import pytest
from sqlalchemy import Engine

from harness.databases import Databases
from tests.client.scripted_server import BREAK_OFF, answer, scripted_server
from tests.client.test_failures import JOB, KEY
from tests.jobs.jobs import GRID, opened, work_off
from tests.service_thread import service_thread
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.client import (
    AsyncClient,
    Client,
    ConflictError,
    JobCancelledError,
    JobFailedError,
    Progress,
    UnauthorizedError,
    UnexpectedAnswerError,
    WaitTimedOutError,
    retrying,
)
from threadstate.client._sync import job
from threadstate.client.models.jobs import JobDocument
from threadstate.jobs.names import EventKind, JobState
from threadstate.jobs.work import publish_job, requeue_job
from threadstate.jobs.workers import join
from threadstate.library.engine import writing

pytestmark = pytest.mark.slow

SMALL = {"tilt_max": 1, "tilt_step": 1, "phase_step": 180}
"""The grid of ``tests.jobs.jobs``."""
STREAM = "text/event-stream"


@dataclass(frozen=True)
class Desk:
    """A service over an empty database, a key for it, and the database as a worker sees it."""

    address: str
    key: str
    engine: Engine

    def work_off(self, job_id: int) -> None:
        worker = join(self.engine, "one")
        library_id = opened(self.engine, job_id)
        work_off(self.engine, worker, job_id, library_id)
        assert publish_job(self.engine, worker, job_id, library_id, GRID)


@pytest.fixture
def desk(sqlite_databases: Databases) -> Iterator[Desk]:
    database = sqlite_databases.migrated()
    with writing(database) as engine, service_thread(database) as address:
        yield Desk(address, create_key(engine, "designer", Scope.WRITE), engine)


@pytest.fixture(autouse=True)
def _short_pauses(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(retrying, "FIRST_PAUSE_S", 0.001)
    monkeypatch.setattr(job, "POLL_S", 0.001)


def test_a_job_is_asked_for_waited_for_and_told_of(desk: Desk) -> None:
    told: list[Progress] = []
    with Client(desk.address, key=desk.key) as client:
        asked = client.ask(grid=SMALL)
        assert repr(asked) == "Job(1, queued)"
        assert client.ask(grid=SMALL).id == asked.id
        worker = threading.Thread(target=desk.work_off, args=(asked.id,))
        worker.start()
        done = asked.wait(told.append, timeout_s=120.0)
        worker.join()
        assert (done.state, done.committed, asked.document) == (JobState.DONE, 9, done)
        assert client.library(done.library or 0).input_sha256 == done.input_sha256
        assert [one.committed for one in told] == list(range(10))
        assert told[-1] == Progress(asked.id, 9, 9)
        assert [one.id for one in client.jobs()] == [asked.id]
        events = list(asked.events())
        assert [one.kind for one in events] == ["queued", "started", *["progress"] * 9, "published"]
        assert list(asked.events(after=10)) == events[10:]
        assert list(asked.events(after=12)) == []
        assert asked.wait() == done
        with pytest.raises(ConflictError):
            asked.cancel()


def test_an_asynchronous_client_waits_as_well(desk: Desk) -> None:
    told: list[Progress] = []

    async def ask() -> JobDocument:
        async with AsyncClient(desk.address, key=desk.key) as client:
            asked = await client.ask(grid=SMALL)
            async with anyio.create_task_group() as tasks:
                tasks.start_soon(anyio.to_thread.run_sync, desk.work_off, asked.id)
                done = await asked.wait(told.append, timeout_s=120.0)
            kinds = [event.kind async for event in asked.events(after=11)]
            assert kinds == [EventKind.PUBLISHED]
            assert (await asked.refresh(), repr(await client.job(asked.id))) == (done, "AsyncJob(1, done)")
            return done

    assert anyio.run(ask).state is JobState.DONE
    assert told[-1].share == 1.0


def test_a_job_that_ends_otherwise_is_an_error(desk: Desk) -> None:
    with Client(desk.address, key=desk.key) as client:
        asked = client.ask(grid=SMALL)
        with pytest.raises(WaitTimedOutError, match=r"job 1 did not end within 0\.2 s"):
            asked.wait(timeout_s=0.2)
        assert asked.cancel().state is JobState.CANCELLED
        with pytest.raises(JobCancelledError) as cancelled:
            asked.wait()
        assert cancelled.value.job.id == asked.id
        asked = client.ask(grid=SMALL)
        worker = join(desk.engine, "one")
        while asked.refresh().state is not JobState.FAILED:
            opened(desk.engine, asked.id)
            requeue_job(desk.engine, worker, asked.id, "a computing process died")
        with pytest.raises(JobFailedError, match="job 1 failed: a computing process died"):
            asked.wait()


def test_no_key_is_no_job(desk: Desk) -> None:
    with Client(desk.address) as client, pytest.raises(UnauthorizedError):
        client.ask(grid=SMALL)


def _event(number: int, kind: str, committed: int) -> str:
    data = {"job": 3, "kind": kind, "at": JOB["asked_at"], "committed": committed, "chunks": 9, "reason": None}
    return f"id: {number}\nevent: {kind}\ndata: {json.dumps(data)}\n\n"


def _job(**changed: object) -> bytes:
    return answer(200, json.dumps(JOB | changed))


def _broken_stream(*events: str) -> bytes:
    """A stream that breaks off within an event."""
    head = f"HTTP/1.1 200 OK\r\nContent-Type: {STREAM}\r\nContent-Length: 100000\r\n\r\n"
    return (head + "".join(events) + "id: 99\nevent: prog").encode()


def test_a_stream_that_breaks_goes_on_where_it_was() -> None:
    script = [
        _job(),
        _broken_stream(_event(1, "queued", 0), _event(2, "started", 0)),
        BREAK_OFF,
        answer(200, _event(3, "progress", 1), STREAM),
        answer(200, _event(4, "published", 9), STREAM),
        b"HTTP/1.1 204 No Content\r\n\r\n",
    ]
    with scripted_server(script) as server, Client(server.address, key=KEY) as client:
        kinds = [event.kind for event in client.job(3).events()]
    assert kinds == ["queued", "started", "progress", "published"]
    known = [
        next((line.split()[1] for line in head.splitlines() if line.lower().startswith("last-event-id")), None)
        for head in server.heads[1:]
    ]
    assert known == [None, "2", "2", "3", "4"]


def test_where_no_stream_comes_through_the_job_is_looked_at() -> None:
    told: list[int] = []
    script = [
        _job(),
        answer(200, "<html>", "text/html"),
        answer(200, "<html>", "text/html"),
        _job(state="running", committed=4),
        _job(state="done", committed=9, library=2),
    ]
    with scripted_server(script) as server, Client(server.address, retries=1) as client:
        done = client.job(3).wait(lambda progress: told.append(progress.committed))
    assert (done.library, told) == (2, [4, 9])


def test_asynchronously_too() -> None:
    told: list[int] = []

    async def wait(address: str) -> JobDocument:
        async with AsyncClient(address, retries=0) as client:
            return await (await client.job(3)).wait(lambda progress: told.append(progress.committed))

    script = [_job(), answer(200, "<html>", "text/html"), _job(state="done", committed=9, library=2)]
    with scripted_server(script) as server:
        assert anyio.run(wait, server.address).library == 2
    assert told == [9]


def test_a_stream_of_something_else_is_noticed() -> None:
    script = [_job(), answer(200, "id: 1\ndata: nothing\n\n", STREAM)]
    with (
        scripted_server(script) as server,
        Client(server.address) as client,
        pytest.raises(UnexpectedAnswerError, match="nothing"),
    ):
        list(client.job(3).events())
