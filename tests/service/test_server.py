"""The service as ``threadstate serve`` runs it: how it starts, what it logs, and how it ends."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

import httpx2
import pytest
from sqlalchemy import text

from harness.databases import Databases
from scripts.hand_over import hand_over
from service.server import DRAIN_S, FIRST_REQUEST_S
from tests.service.conftest import StoredLibrary
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.jobs.queue import submit_job
from threadstate.library.engine import writing
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.settings import DATABASE, GRACE_S, LOG_LEVEL, PORT
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = [pytest.mark.sqlite_alone, pytest.mark.slow]


@contextmanager
def serving(database: str, **settings: str) -> Iterator[tuple[subprocess.Popen[str], str, list[str]]]:
    """A running service, its address, and what it has said on stderr until it listened."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    environment = {**os.environ, DATABASE: database, PORT: str(port), **settings}
    command = [sys.executable, "-m", "service"]
    with subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        said: list[str] = []
        try:
            for line in process.stderr:
                said.append(line)
                if "running on http" in line:
                    break
            else:
                raise AssertionError("".join(said))
            yield process, json.loads(said[-1])["event"].removeprefix("running on "), said
        finally:
            process.kill()


def ended(process: subprocess.Popen[str]) -> list[str]:
    """What a process that was told to end has still said; it ended well."""
    _, said = process.communicate(timeout=60.0)
    assert process.returncode == 0, said
    return said.splitlines()


def test_end_under_load_fails_no_request(made_up: StoredLibrary) -> None:
    tally = hand_over(made_up.database, times=1, apart_s=0.5)
    assert tally.failed == []
    assert tally.answered > 100
    assert tally.sent_again < tally.answered


def test_request_in_flight_is_answered_and_the_connection_closed(made_up: StoredLibrary) -> None:
    with serving(made_up.database) as (process, address, _), httpx2.Client(base_url=address) as client:
        assert "Connection" not in client.get("/healthz").headers
        process.send_signal(signal.SIGTERM)
        time.sleep(0.3)
        ready = client.get("/readyz")
        assert (ready.status_code, ready.json()["type"]) == (503, "urn:threadstate:problem:draining")
        assert ready.headers["Connection"] == "close"
        answer = client.get("/v1/libraries/latest/histories/0/0")
        assert (answer.status_code, answer.headers["Connection"]) == (200, "close")
        ended(process)


def test_request_on_a_connection_opened_before_the_last_is_accepted_is_answered(made_up: StoredLibrary) -> None:
    with serving(made_up.database) as (process, address, _):
        port = int(address.rsplit(":", 1)[1])
        process.send_signal(signal.SIGTERM)
        time.sleep(DRAIN_S - 0.2)
        with socket.create_connection(("127.0.0.1", port), timeout=20.0) as connection:
            time.sleep(0.2 + FIRST_REQUEST_S / 2)
            connection.sendall(b"GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n")
            answer = b"".join(iter(lambda: connection.recv(4096), b""))
        assert answer.startswith(b"HTTP/1.1 200 ")
        assert b"\r\nconnection: close\r\n" in answer.lower()
        ended(process)


def test_connection_that_sends_nothing_does_not_keep_the_process(made_up: StoredLibrary) -> None:
    with serving(made_up.database, **{GRACE_S: "30"}) as (process, address, _):
        port = int(address.rsplit(":", 1)[1])
        with socket.create_connection(("127.0.0.1", port), timeout=20.0) as connection:
            process.send_signal(signal.SIGTERM)
            assert connection.recv(1) == b""
        ended(process)


def test_streams_end_when_the_process_does(databases: Databases) -> None:
    database = databases.migrated()
    with writing(database) as engine:
        job = submit_job(engine, LibraryInputs(quarter_twenty_unc(), Grid(1.0, 1.0, 90.0), SolveOptions()))
    with serving(database, **{GRACE_S: "30"}) as (process, address, _):
        with httpx2.stream("GET", f"{address}/v1/jobs/{job.id}/events", timeout=20.0) as answer:
            lines = answer.iter_lines()
            assert next(lines) == "id: 1"
            process.send_signal(signal.SIGTERM)
            assert any(line.startswith("data: ") for line in lines)
        ended(process)


def test_no_key_is_in_the_log(databases: Databases) -> None:
    database = databases.migrated()
    with writing(database) as engine:
        key = create_key(engine, "one", Scope.WRITE)
    secret = key.split("_", 2)[2]
    with serving(database, **{LOG_LEVEL: "debug"}) as (process, address, said):
        with httpx2.Client(base_url=address) as client:
            for headers in (
                {"Authorization": f"Bearer {key}"},
                {"Authorization": f"Bearer  {key}"},
                {"Authorization": f"Basic {key}"},
                {"Authorization": key},
                {"Authorization": f'Bearer "{key}", x'},
                {"X-Request-ID": key},
                {"X-Request-ID": secret},
                {"User-Agent": key, "Referer": f"http://x/?key={key}", "Origin": key},
            ):
                client.post("/v1/jobs", json={}, headers=headers)
            for path in (f"/v1/jobs?key={key}", f"/{key}", f"/v1/libraries/{key}", f"/v1/jobs/{key}?{key}"):
                assert client.get(path).status_code in (400, 404)
            client.request("POST", "/v1/solve", content=f"{key}{{")
        process.send_signal(signal.SIGTERM)
        said += ended(process)
    requests = [line for line in said if json.loads(line)["event"] == "request"]
    assert len(requests) == 13
    assert not [line for line in said if secret[:20] in line]


def test_schema_of_another_revision_ends_the_start_and_names_what_mends_it(databases: Databases) -> None:
    database = databases.migrated()
    with writing(database) as engine, engine.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '0001'"))
    environment = {**os.environ, DATABASE: database}
    for command in (
        ("-c", "from worker.cli import main; main()", "serve"),
        ("-c", "from worker.cli import main; main()", "worker", "--until-idle"),
        ("-m", "service"),
    ):
        run = subprocess.run([sys.executable, *command], env=environment, check=False, capture_output=True, text=True)
        assert run.returncode == 3
        (line,) = run.stderr.splitlines()
        assert "is at schema revision 0001" in line
        assert line.endswith("run `threadstate migrate`")


def test_address_that_is_taken_ends_the_start(made_up: StoredLibrary) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        environment = {**os.environ, DATABASE: made_up.database, PORT: str(taken.getsockname()[1])}
        run = subprocess.run(
            [sys.executable, "-m", "service"], env=environment, check=False, capture_output=True, text=True
        )
    assert run.returncode == 1
    assert "Address already in use" in run.stderr.splitlines()[-1]
