"""No request waits for the compiler: what solves is refused until the kernels are there, and says so."""

from __future__ import annotations

import gc
import logging
import os
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import httpx2
import pytest
from fastapi.testclient import TestClient

from tests.service.conftest import StoredLibrary
from tests.service.test_problems import problem
from tests.service_app import service_app
from threadstate.client.errors import ServiceUnavailableError, problem_error
from threadstate.client.models.service import Problem
from threadstate.client.options import DEFAULT_RETRIES
from threadstate.client.retrying import Retrying, retry_after_s
from threadstate.settings import DATA_DIR, DATABASE, read_settings

pytestmark = pytest.mark.sqlite_alone

SOLVE = {"poses": [{"roll": 4, "pitch": 0, "phase": 185}]}
SOLVING = [
    "/v1/histories/1/1/intervals",
    "/v1/histories/1/1/heights",
    "/v1/histories/1/1/falls",
    "/v1/libraries/1/histories/1/1/heights",
    "/v1/histories/1/1/held",
    "/v1/states/1/1/1/jamming",
    "/v1/libraries/1/transitions",
    "/v1/libraries/1/histories/1/1/held",
    "/v1/libraries/1/network/loaded",
    "/v1/libraries/1/network/paths?from=0123456789&mu=0.1",
    "/v1/libraries/1/network/locate?verdict=can_stay&mu=0.1",
    "/v1/libraries/1/states/0/0/30/statics",
    "/v1/libraries/1/states/0/0/30/jamming",
]
COMPILING = """
import pathlib, sys, time
while not pathlib.Path(sys.argv[1]).exists():
    time.sleep(0.01)
sys.exit(int(sys.argv[2]))
"""
"""In place of the compiler: ends with a code when a file is there."""
LONGEST_S = 60.0


@pytest.fixture(params=[0, 1], ids=["compiled", "failed"])
def compiling(
    made_up: StoredLibrary, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> Iterator[TestClient]:
    """A client of a service whose kernels are compiled until the file ``compiled`` is there."""
    command = (sys.executable, "-c", COMPILING, str(tmp_path / "compiled"), str(request.param))
    monkeypatch.setattr("service.kernels.COMPILE", command)
    monkeypatch.setattr("service.kernels.kernels_are_compiled", lambda: False)
    settings = read_settings({DATABASE: made_up.database, DATA_DIR: str(tmp_path)})
    with TestClient(service_app(settings, serving=True)) as client:
        yield client


def _wait_until_ready(client: TestClient) -> None:
    until = time.monotonic() + LONGEST_S
    while client.get("/readyz").json()["kernels"] != "ready":
        assert time.monotonic() < until
        time.sleep(0.05)


def test_what_solves_is_refused_while_kernels_are_compiled(
    compiling: TestClient, tmp_path: Path, caplog: pytest.LogCaptureFixture, request: pytest.FixtureRequest
) -> None:
    assert compiling.get("/readyz").json()["kernels"] == "compiling"
    loaded = compiling.post("/v1/statics", json={**SOLVE, "loads": [{}]})
    held = compiling.post("/v1/settle", json=SOLVE)
    for response in (compiling.post("/v1/solve", json=SOLVE), loaded, held, *(compiling.get(path) for path in SOLVING)):
        refused = problem(response, 503)
        assert refused.type.endswith(":kernels-compiling")
        assert "are being compiled" in refused.detail
        assert response.headers["Retry-After"] == "30"
    for path in ("/v1/libraries/1/states/0/0/30", "/v1/libraries/1/histories/0/0", "/v1/jobs", "/v1/threads", "/"):
        assert compiling.get(path).status_code == 200, path
    caplog.set_level(logging.ERROR)
    (tmp_path / "compiled").touch()
    _wait_until_ready(compiling)
    assert compiling.post("/v1/solve", json=SOLVE).status_code == 200
    failed = "failed" in request.node.name
    assert ("ended with code 1" in caplog.text) is failed


@pytest.mark.parametrize("code", [0, 1], ids=["compiled", "failed"])
def test_kernels_of_turning_are_compiled_when_they_are_asked_for(
    made_up: StoredLibrary, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: int
) -> None:
    begun, compiled = tmp_path / "begun", tmp_path / "compiled"
    script = f"import pathlib; pathlib.Path({str(begun)!r}).touch()\n{COMPILING}"
    monkeypatch.setattr("service.kernels.COMPILE_ALL", (sys.executable, "-c", script, str(compiled), str(code)))
    monkeypatch.setattr("service.kernels.turning_is_compiled", lambda: False)
    body = {"pose": {"roll": 1, "pitch": -2, "phase": 10}, "strategy": "cw"}
    settings = read_settings({DATABASE: made_up.database, DATA_DIR: str(tmp_path)})
    with TestClient(service_app(settings, serving=True)) as client:
        _wait_until_ready(client)
        assert client.post("/v1/solve", json=SOLVE).status_code == 200
        assert not begun.exists()
        refused = problem(client.post("/v1/assemblies", json=body), 503)
        assert refused.type.endswith(":kernels-compiling")
        until = time.monotonic() + LONGEST_S
        while not begun.exists():
            assert time.monotonic() < until
            time.sleep(0.01)
        problem(client.post("/v1/assemblies", json=body), 503)
        compiled.touch()
        while (response := client.post("/v1/assemblies", json=body)).status_code != 200:
            assert time.monotonic() < until
            time.sleep(0.05)
    assert response.json()["outcome"] == "engaged"


def test_a_client_tries_again_for_as_long_as_it_takes(compiling: TestClient) -> None:
    response = compiling.post("/v1/solve", json=SOLVE)
    error = _error(response)
    pauses = [Retrying(DEFAULT_RETRIES).pause_s(error, tried, repeatable=True) for tried in range(21)]
    assert pauses == [30.0] * 20 + [None]
    assert Retrying(0).pause_s(error, 0, repeatable=True) is None
    assert Retrying(DEFAULT_RETRIES).pause_s(error, 0, repeatable=False) is None
    assert Retrying(30).pause_s(error, 25, repeatable=True) == 30.0


def _error(response: httpx2.Response) -> ServiceUnavailableError:
    after = retry_after_s(response.headers["Retry-After"])
    error = problem_error("POST /v1/solve", Problem.model_validate_json(response.content), after)
    assert isinstance(error, ServiceUnavailableError)
    return error


def test_kernels_that_are_compiled_are_ready_at_once(made_up: StoredLibrary, tmp_path: Path) -> None:
    settings = read_settings({DATABASE: made_up.database, DATA_DIR: str(tmp_path)})
    with TestClient(service_app(settings, serving=True)) as client:
        assert client.get("/readyz").json()["kernels"] == "ready"
        assert client.post("/v1/solve", json=SOLVE).status_code == 200


def test_a_service_that_ends_ends_the_compiler(
    made_up: StoredLibrary, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun = tmp_path / "begun"
    script = "import os, pathlib, sys, time; pathlib.Path(sys.argv[1]).write_text(str(os.getpid())); time.sleep(600)"
    monkeypatch.setattr("service.kernels.COMPILE", (sys.executable, "-c", script, str(begun)))
    monkeypatch.setattr("service.kernels.kernels_are_compiled", lambda: False)
    settings = read_settings({DATABASE: made_up.database, DATA_DIR: str(tmp_path)})
    with TestClient(service_app(settings, serving=True)):
        until = time.monotonic() + LONGEST_S
        while not (begun.exists() and begun.read_text()):
            assert time.monotonic() < until
            time.sleep(0.01)
    with pytest.raises(ProcessLookupError):
        os.kill(int(begun.read_text()), 0)
    # A process that was not waited for warns here, which fails the test.
    gc.collect()


def test_kernels_of_turning_are_loaded_after_those_that_serving_needs(
    made_up: StoredLibrary, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """No request waits for that; where they cannot be, the first path tries again."""
    begun, goes_on = threading.Event(), threading.Event()

    def load() -> None:
        begun.set()
        assert goes_on.wait(LONGEST_S)
        raise RuntimeError("no such kernel")

    monkeypatch.setattr("service.kernels.load_turning", load)
    caplog.set_level(logging.ERROR)
    settings = read_settings({DATABASE: made_up.database, DATA_DIR: str(tmp_path)})
    with TestClient(service_app(settings, serving=True)) as client:
        assert begun.wait(LONGEST_S)
        assert client.get("/readyz").json()["kernels"] == "ready"
        assert client.post("/v1/solve", json=SOLVE).status_code == 200
        goes_on.set()
        until = time.monotonic() + LONGEST_S
        while "the first path tries again" not in caplog.text:
            assert time.monotonic() < until
            time.sleep(0.01)
