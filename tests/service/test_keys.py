from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from typing import IO

import httpx2
import pytest
from fastapi.testclient import TestClient
from sqlalchemy import Engine

from harness.databases import Databases
from tests.jobs.jobs import published_count
from tests.service.test_problems import problem
from tests.service_app import service_app
from threadstate.access.keys import create_key, revoke_key
from threadstate.access.scope import Scope
from threadstate.library.engine import writing
from threadstate.settings import DATABASE, READ_KEYS, read_settings

pytestmark = pytest.mark.sqlite_alone

JOBS = "/v1/jobs"
WRITES = (("POST", JOBS), ("DELETE", f"{JOBS}/1"))
REFUSED = "urn:threadstate:problem:key-refused"


@pytest.fixture
def database(databases: Databases) -> Iterator[str]:
    with databases.lent() as database:
        yield database


@pytest.fixture
def engine(database: str) -> Iterator[Engine]:
    with writing(database) as engine:
        yield engine


def _client(database: str, reading: str) -> TestClient:
    return TestClient(service_app(read_settings({DATABASE: database, READ_KEYS: reading})))


def _bearer(key: str) -> dict[str, str]:
    return {"Authorization": f"Bearer {key}"}


@pytest.mark.parametrize("reading", ["open", "required"])
def test_nothing_is_written_without_a_key_for_it(database: str, engine: Engine, reading: str) -> None:
    write, read = create_key(engine, "one", Scope.WRITE), create_key(engine, "other", Scope.READ)
    with _client(database, reading) as client:
        for method, path in WRITES:
            for wrong in (
                {},
                {"Authorization": write},
                {"Authorization": f"Basic {write}"},
                _bearer(""),
                _bearer(write[:-1]),
                _bearer(f"{write}x"),
                {"Cookie": f"key={write}"},
            ):
                response = client.request(method, path, json={}, headers=wrong)
                assert problem(response, 401).type == REFUSED
                assert response.headers["WWW-Authenticate"] == "Bearer"
                assert write not in response.text
            assert problem(client.request(method, path, json={}, headers=_bearer(read)), 403)
            problem(client.request(method, f"{path}?key={write}", json={}), 401 if reading == "required" else 400)
        assert client.get(JOBS, headers=_bearer(read)).json()["jobs"] == []
        assert client.post(JOBS, json={}, headers=_bearer(write)).status_code == 202
        revoke_key(engine, write.split("_")[1])
        assert problem(client.delete(f"{JOBS}/1", headers=_bearer(write)), 401)
        assert client.get(f"{JOBS}/1", headers=_bearer(read)).json()["state"] == "queued"
    assert published_count(engine) == 0


def test_reading_is_open_unless_it_is_closed(database: str, engine: Engine) -> None:
    key = create_key(engine, "one", Scope.READ)
    with _client(database, "open") as open_client, _client(database, "required") as closed_client:
        for path in ("/v1/libraries", "/v1/threads", JOBS, f"{JOBS}/1", "/v1/libraries/latest"):
            assert open_client.get(path).status_code in (200, 404)
            assert problem(closed_client.get(path), 401).type == REFUSED
            assert closed_client.get(path, headers=_bearer(key)).status_code in (200, 404)
        poses = {"poses": [{"roll": 1, "pitch": 2, "phase": 3}]}
        assert problem(closed_client.post("/v1/solve", json=poses), 401)
        assert closed_client.post("/v1/solve", json=poses, headers=_bearer(key)).status_code == 200
        for path in ("/healthz", "/docs", "/openapi.json"):
            assert closed_client.get(path).status_code == 200
        assert problem(closed_client.get("/readyz"), 503)
        assert open_client.get("/v1/libraries").headers["Cache-Control"] == "public, no-cache"
        closed = closed_client.get("/v1/libraries", headers=_bearer(key))
        assert closed.headers["Cache-Control"] == "private, no-cache"


def test_asking_does_not_make_a_database(databases: Databases) -> None:
    database = databases.new()
    with _client(database, "open") as client:
        for method, path in WRITES:
            assert client.request(method, path, json={}, headers=_bearer("x")).status_code == 503
    assert not os.path.exists(database.removeprefix("sqlite:///"))  # noqa: PTH110


def _until_running(lines: IO[str]) -> list[str]:
    """What a server says until it runs."""
    said = []
    for line in lines:
        said.append(line)
        if "running on http" in line:
            return said
    raise AssertionError("".join(said))


@pytest.mark.slow
def test_a_key_is_in_no_log(database: str, engine: Engine) -> None:
    key = create_key(engine, "one", Scope.WRITE)
    command = [sys.executable, "-m", "uvicorn", "--factory", "service.app:create_app", "--port", "0"]
    environment = {**os.environ, DATABASE: database}
    with subprocess.Popen(
        [*command, "--log-level", "trace"],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    ) as process:
        assert process.stdout is not None
        try:
            logged = _until_running(process.stdout)
            address = logged[-1].rpartition("running on ")[2].split()[0]
            with httpx2.Client(base_url=address) as client:
                assert client.post(JOBS, json={}, headers=_bearer(key)).status_code == 202
                assert client.post(JOBS, json={}, headers=_bearer(key[:-1])).status_code == 401
                assert client.get(f"{JOBS}/1", headers=_bearer(key)).status_code == 200
        finally:
            process.terminate()
        logged += process.stdout
    text = "".join(logged)
    assert f"POST {JOBS}" in text
    assert key.split("_", 2)[2][:-1] not in text
