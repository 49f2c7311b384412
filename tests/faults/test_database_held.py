"""Another process holds a SQLite file for longer than one waits: writers go on later, readers are answered at once."""

from __future__ import annotations

from threading import Thread

import pytest
from sqlalchemy.exc import OperationalError

from harness.databases import SqliteDatabases
from tests.faults.conftest import INPUTS, SERVING, Unwatched, holding, published
from tests.service.conftest import client_of
from tests.service.test_problems import problem
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.jobs.queue import submit_job
from threadstate.library.copying import copy_library
from threadstate.library.engine import writing
from worker.jobs.serve import serve_jobs
from worker.rebuild import rebuild

pytestmark = pytest.mark.slow


@pytest.fixture(autouse=True)
def _impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("threadstate.library.engine.BUSY_TIMEOUT_S", 0.2)
    monkeypatch.setattr("service.database.LOCK_TIMEOUT_S", 0.2)
    monkeypatch.setattr("worker.jobs.serve.RETRY_S", 0.1)


def test_a_rebuild_ends_and_goes_on_later(sqlite_database: str, expected_content: str) -> None:
    with writing(sqlite_database) as engine:
        with holding(sqlite_database), pytest.raises(OperationalError, match="database is locked"):
            rebuild(engine, INPUTS, 1, Unwatched())
        assert published(engine) == []
        assert rebuild(engine, INPUTS, 1, Unwatched()).content_sha256 == expected_content


def test_a_copy_ends_and_goes_on_later(sqlite_databases: SqliteDatabases, expected_content: str) -> None:
    source, target = sqlite_databases.migrated(), sqlite_databases.migrated()
    with writing(source) as here, writing(target) as there:
        library_id = rebuild(here, INPUTS, 1, Unwatched()).library_id
        with holding(target), pytest.raises(OperationalError, match="database is locked"):
            copy_library(here, there, library_id)
        assert copy_library(here, there, library_id).content_sha256 == expected_content


def test_a_worker_waits_and_goes_on(
    sqlite_database: str, expected_content: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with writing(sqlite_database) as engine:
        submit_job(engine, INPUTS)
        with holding(sqlite_database):
            worker = Thread(target=serve_jobs, args=(engine, SERVING), kwargs={"until_idle": True}, daemon=True)
            worker.start()
            said = ""
            while said.count("the database failed, retrying: database is locked") < 3:
                worker.join(0.1)
                said += capsys.readouterr().err
                assert worker.is_alive()
        worker.join(120)
        assert not worker.is_alive()
        assert published(engine) == [expected_content]


def test_asking_for_a_job_is_refused_for_now_and_reading_is_answered(sqlite_database: str) -> None:
    with writing(sqlite_database) as engine:
        key = create_key(engine, "one", Scope.WRITE)
        submit_job(engine, INPUTS)
    headers = {"Authorization": f"Bearer {key}"}
    with client_of(sqlite_database) as client:
        with holding(sqlite_database):
            for method, path in (("POST", "/v1/jobs"), ("DELETE", "/v1/jobs/1")):
                answer = client.request(method, path, headers=headers, json={})
                found = problem(answer, 503)
                assert found.type == "urn:threadstate:problem:database-unavailable"
                assert "another process holds the database" in found.detail
                assert int(answer.headers["Retry-After"]) > 0
            assert client.get("/v1/jobs/1").json()["state"] == "queued"
            assert client.get("/v1/libraries").json() == {"libraries": []}
        assert client.delete("/v1/jobs/1", headers=headers).status_code == 200
        assert client.post("/v1/jobs", headers=headers, json={}).status_code == 202
