"""No room left, for SQLite: a page too many for the file, and a file that the system lets grow no further.

The first is what SQLite says of a full disk (SQLITE_FULL), at the moment when a page is needed; the second is a write
that fails (EFBIG, as a quota's EDQUOT would), in the middle of the log, of processes that know nothing of it.
"""

from __future__ import annotations

import resource
import subprocess
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import Any

import pytest
from sqlalchemy import Engine, event, func, select
from sqlalchemy.exc import OperationalError

from harness.databases import SqliteDatabases
from tests.faults.conftest import GRID, GRID_OPTIONS, INPUTS, SERVING, Unwatched, published
from tests.service.conftest import client_of
from tests.service.test_problems import problem
from tests.worker.conftest import COMMAND
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.jobs.names import JobState
from threadstate.jobs.queue import job_by_id, submit_job
from threadstate.library.copying import copy_library
from threadstate.library.engine import writing
from threadstate.library.tables import chunk, library, state
from threadstate.settings import DATABASE
from worker.jobs.serve import serve_jobs
from worker.rebuild import rebuild

pytestmark = pytest.mark.slow

FREE_PAGES = (8, 20, 45)
"""Room for no chunk, for one, for some; nine need about 80."""
MANY_PAGES = 1_000_000
FREE_BYTES = (20_000, 150_000, 400_000)


@contextmanager
def nearly_full(database: str, free_pages: int) -> Iterator[Engine]:
    """An engine whose file has room for that many more pages, until :func:`make_room`."""
    with writing(database) as engine:
        event.listen(engine, "connect", lambda connection, _record: limit_pages(connection, free_pages))
        yield engine


def make_room(engine: Engine) -> None:
    """Let every connection that the engine will make grow the file again."""
    event.listen(engine, "connect", lambda connection, _record: limit_pages(connection, MANY_PAGES))
    engine.dispose()


def limit_pages(connection: Any, free_pages: int) -> None:
    """Let a file grow by that many pages."""
    (used,) = connection.execute("PRAGMA page_count").fetchone()
    connection.execute(f"PRAGMA max_page_count = {used + free_pages}")


def check_nothing_is_half_there(database: str) -> int:
    """No library is seen, every chunk that is there is whole.

    Returns:
        How many there are.
    """
    with writing(database) as engine:
        assert published(engine) == []
        with engine.connect() as connection:
            assert connection.exec_driver_sql("PRAGMA integrity_check").scalar() == "ok"
            assert connection.exec_driver_sql("PRAGMA foreign_key_check").all() == []
            chunks = connection.scalar(select(func.count()).select_from(chunk)) or 0
            states = connection.scalar(select(func.count()).select_from(state))
    assert states == chunks * GRID.phase_count
    return chunks


@pytest.mark.parametrize("free_pages", FREE_PAGES)
def test_a_rebuild_goes_on_when_there_is_room_again(
    sqlite_database: str, expected_content: str, free_pages: int
) -> None:
    with nearly_full(sqlite_database, free_pages) as engine, pytest.raises(OperationalError, match="disk is full"):
        rebuild(engine, INPUTS, 1, Unwatched())
    done = check_nothing_is_half_there(sqlite_database)
    assert done < GRID.orientation_count
    with writing(sqlite_database) as engine:
        went_on = rebuild(engine, INPUTS, 1, Unwatched())
    assert went_on.content_sha256 == expected_content
    assert went_on.computed == (GRID.orientation_count - done) * GRID.phase_count


def test_a_worker_waits_until_there_is_room_again(
    sqlite_database: str, expected_content: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("worker.jobs.serve.RETRY_S", 0.2)
    with writing(sqlite_database) as engine:
        job = submit_job(engine, INPUTS)
    with nearly_full(sqlite_database, FREE_PAGES[1]) as engine:
        worker = Thread(target=serve_jobs, args=(engine, SERVING), kwargs={"until_idle": True}, daemon=True)
        worker.start()
        said = ""
        while said.count("retrying: database or disk is full") < 3:
            worker.join(0.2)
            said += capsys.readouterr().err
            assert worker.is_alive()
        check_nothing_is_half_there(sqlite_database)
        make_room(engine)
        worker.join(120)
        assert not worker.is_alive()
        assert published(engine) == [expected_content]
        with engine.connect() as connection:
            assert job_by_id(connection, job.id).state is JobState.DONE


@pytest.mark.parametrize("free_pages", FREE_PAGES)
def test_a_copy_goes_on_when_there_is_room_again(
    sqlite_databases: SqliteDatabases, expected_content: str, free_pages: int
) -> None:
    source, target = sqlite_databases.migrated(), sqlite_databases.migrated()
    with writing(source) as here:
        library_id = rebuild(here, INPUTS, 1, Unwatched()).library_id
        with nearly_full(target, free_pages) as there, pytest.raises(OperationalError, match="disk is full"):
            copy_library(here, there, library_id)
        check_nothing_is_half_there(target)
        with writing(target) as there:
            assert copy_library(here, there, library_id).content_sha256 == expected_content
            assert published(there) == [expected_content]


def limited(free_bytes: int) -> Callable[[], None]:
    """What a process does before anything else: no file of its may be longer than that."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (free_bytes, free_bytes))


@pytest.mark.parametrize("free_bytes", FREE_BYTES)
def test_commands_say_it_in_a_line_and_end_with_1(
    sqlite_database: str, environment_of_commands: Mapping[str, str], expected_content: str, free_bytes: int
) -> None:
    path = Path(sqlite_database.removeprefix("sqlite:///"))
    command = [*COMMAND, "rebuild", *GRID_OPTIONS, "--workers", "1"]
    environment = {**environment_of_commands, DATABASE: sqlite_database}
    ended = subprocess.run(
        command,
        env=environment,
        capture_output=True,
        text=True,
        preexec_fn=limited(path.stat().st_size + free_bytes),
        timeout=300,
    )
    assert ended.returncode == 1, ended.stderr
    (line,) = [line for line in ended.stderr.splitlines() if line.startswith("threadstate: ")]
    assert line in (
        "threadstate: OperationalError: disk I/O error",
        "threadstate: OperationalError: database or disk is full",
    )
    assert "Traceback" not in ended.stderr
    check_nothing_is_half_there(sqlite_database)
    with writing(sqlite_database) as engine:
        assert rebuild(engine, INPUTS, 1, Unwatched()).content_sha256 == expected_content


def test_asking_for_a_job_is_refused_until_there_is_room(sqlite_database: str) -> None:
    with writing(sqlite_database) as engine:
        key = create_key(engine, "one", Scope.WRITE)
    headers = {"Authorization": f"Bearer {key}"}
    with client_of(sqlite_database) as client:
        control = client.app.state.control.get()  # type: ignore[attr-defined]
        event.listen(control, "connect", lambda connection, _record: limit_pages(connection, 0))
        full, asked = None, 0
        while full is None:
            answer = client.post(
                "/v1/jobs", headers=headers, json={"grid": {"tilt_max": asked / 100, "tilt_step": 0.01}}
            )
            full = None if answer.status_code == 202 else answer
            asked += 1
            assert asked < 500
        found = problem(full, 503)
        assert found.type == "urn:threadstate:problem:database-unavailable"
        assert "no room is left" in found.detail
        assert int(full.headers["Retry-After"]) > 0
        assert client.get("/v1/jobs").status_code == 200
        with control.connect() as connection:
            connection.exec_driver_sql(f"PRAGMA max_page_count = {MANY_PAGES}")
            assert connection.scalar(select(func.count()).select_from(library)) == 0
        assert client.post("/v1/jobs", headers=headers, json={}).status_code == 202
