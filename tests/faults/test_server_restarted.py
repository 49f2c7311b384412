"""PostgreSQL goes away and comes back while the service answers and while a rebuild and workers are at it."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest
from sqlalchemy import Engine, Table, func, select

from harness.databases import PostgresqlDatabases
from harness.postgresql_server import PostgresqlServer, running_server
from tests.faults.conftest import GRID, GRID_OPTIONS, INPUTS, Unwatched, published
from tests.service.conftest import client_of
from tests.service.test_problems import problem
from tests.worker.conftest import COMMAND
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.jobs.names import JobState
from threadstate.jobs.queue import job_by_id, submit_job
from threadstate.library.engine import writing
from threadstate.library.tables import chunk, state
from threadstate.settings import DATABASE, LEASE_S
from worker.rebuild import rebuild

pytestmark = pytest.mark.slow

RESTARTS = 2
TIMEOUT_S = 300.0
FAILS = "the database failed, retrying"
UNAVAILABLE = "urn:threadstate:problem:database-unavailable"


@pytest.fixture(scope="module")
def server() -> Iterator[PostgresqlServer]:
    """A server of these tests' own."""
    with running_server() as server:
        yield server


@pytest.fixture(scope="module")
def databases_of_server(server: PostgresqlServer) -> PostgresqlDatabases:
    """Makes databases of that server."""
    return PostgresqlDatabases(server)


@pytest.fixture
def database(databases_of_server: PostgresqlDatabases) -> str:
    """A migrated database of that server."""
    return databases_of_server.migrated()


def test_the_service_says_so_and_recovers(server: PostgresqlServer, database: str) -> None:
    with writing(database) as engine:
        rebuild(engine, INPUTS, 1, Unwatched())
        key = create_key(engine, "one", Scope.WRITE)
    headers = {"Authorization": f"Bearer {key}"}
    reads = (
        "/v1/libraries",
        "/v1/libraries/latest/states/3/3/30",
        "/v1/libraries/latest/histories/0/3",
        "/v1/jobs",
        "/readyz",
    )
    with client_of(database, cache_mb=0) as client:
        for _ in range(RESTARTS):
            assert [client.get(path).status_code for path in reads] == [200] * len(reads)
            assert client.post("/v1/jobs", headers=headers, json={}).status_code == 202
            server.stop()
            for method, path in (*(("GET", path) for path in reads), ("POST", "/v1/jobs"), ("DELETE", "/v1/jobs/1")):
                answer = client.request(method, path, headers=headers)
                found = problem(answer, 503)
                assert found.type == UNAVAILABLE
                assert int(answer.headers["Retry-After"]) > 0
                assert "host" not in answer.text, "where the database is, is nobody's business"
            assert client.get("/healthz").status_code == 200
            server.start()
        assert [client.get(path).status_code for path in reads] == [200] * len(reads)


def test_workers_end_a_job_whole_after_restarts(
    server: PostgresqlServer,
    database: str,
    environment_of_commands: Mapping[str, str],
    expected_content: str,
    tmp_path: Path,
) -> None:
    environment = {**environment_of_commands, DATABASE: database, LEASE_S: "2"}
    said = tmp_path / "said"
    told = 0
    with writing(database) as engine:
        job = submit_job(engine, INPUTS)
        command = [*COMMAND, "worker", "--workers", "1", "--until-idle"]
        with said.open("ab") as stderr:
            workers = [subprocess.Popen(command, env=environment, stderr=stderr) for _ in range(2)]
        try:
            for least in range(1, RESTARTS + 1):
                _wait_for(lambda least=least: _count(engine, chunk) >= 2 * least)  # type: ignore[misc]
                server.stop()
                _wait_for(lambda told=told: said.read_text().count(FAILS) > told)  # type: ignore[misc]
                told = said.read_text().count(FAILS)
                server.start()
            assert [worker.wait(TIMEOUT_S) for worker in workers] == [0, 0], said.read_text()
        finally:
            for worker in workers:
                worker.kill()
                worker.wait()
        assert published(engine) == [expected_content]
        assert (_count(engine, chunk), _count(engine, state)) == (GRID.orientation_count, GRID.pose_count)
        with engine.connect() as connection:
            assert job_by_id(connection, job.id).state is JobState.DONE


def test_a_rebuild_says_so_and_goes_on(
    server: PostgresqlServer, database: str, environment_of_commands: Mapping[str, str], expected_content: str
) -> None:
    command = [*COMMAND, "rebuild", *GRID_OPTIONS, "--workers", "1"]
    environment = {**environment_of_commands, DATABASE: database}
    with writing(database) as engine:
        with subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True) as process:
            _wait_for(lambda: _count(engine, chunk) > 0)
            server.stop()
            _, err = process.communicate(timeout=TIMEOUT_S)
        server.start()
        assert process.returncode == 1, err
        assert len([line for line in err.splitlines() if line.startswith("threadstate: ")]) == 1
        assert "Traceback" not in err
        assert published(engine) == []
        # The server of the tests commits asynchronously: with it go the last chunks that it took for committed.
        assert _count(engine, chunk) < GRID.orientation_count
        assert rebuild(engine, INPUTS, 1, Unwatched()).content_sha256 == expected_content


def _count(engine: Engine, table: Table) -> int:
    with engine.connect() as connection:
        return connection.scalar(select(func.count()).select_from(table)) or 0


def _wait_for(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + TIMEOUT_S
    while not condition():
        assert time.monotonic() < end, "in vain"
        time.sleep(0.01)
