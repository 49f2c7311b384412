"""Every operation that is not safe, found in the description: without a key for writing nothing changes."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import Engine, select

from harness.databases import Databases
from tests.service.conftest import client_of
from tests.service.test_hostile_requests import address, described
from tests.service.test_problems import problem
from threadstate.access.keys import create_key, revoke_key
from threadstate.access.scope import Scope
from threadstate.jobs.queue import submit_job
from threadstate.library.engine import writing
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.state.options import SolveOptions
from threadstate.tables import metadata
from threadstate.thread.catalogue import quarter_twenty_unc

SAFE = {"GET", "HEAD", "OPTIONS"}
COMPUTES = {("POST", path) for path in ("/v1/solve", "/v1/statics", "/v1/settle", "/v1/assemblies", "/v1/outcomes")}
"""Not safe by their method, but they store nothing: questions too long for an address."""
INPUTS = LibraryInputs(quarter_twenty_unc(), Grid(0.0, 1.0, 180.0), SolveOptions())


@pytest.fixture
def engine(databases: Databases) -> Iterator[Engine]:
    """An engine of a database with a job that can be cancelled."""
    with databases.lent() as database, writing(database) as engine:
        submit_job(engine, INPUTS)
        yield engine


@pytest.fixture
def client(engine: Engine) -> Iterator[TestClient]:
    with client_of(engine.url.render_as_string(hide_password=False)) as client:
        yield client


def _content(engine: Engine) -> dict[str, list[tuple[object, ...]]]:
    """Every row of every table."""
    with engine.connect() as connection:
        return {
            table.name: sorted((tuple(row) for row in connection.execute(select(table))), key=repr)
            for table in metadata.sorted_tables
        }


def test_nothing_changes_without_a_key_for_writing(client: TestClient, engine: Engine) -> None:
    read, revoked = create_key(engine, "read", Scope.READ), create_key(engine, "revoked", Scope.WRITE)
    write = create_key(engine, "write", Scope.WRITE)
    revoke_key(engine, revoked.split("_")[1])
    shown = [
        (None, 401),
        ("Bearer", 401),
        (f"Bearer {revoked}", 401),
        (f"Bearer {write[:-1]}", 401),
        (f"Bearer {write[:-1]}{'A' if write[-1] != 'A' else 'B'}", 401),
        (f"Basic {write}", 401),
        (f"Bearer {read}", 403),
    ]
    before = _content(engine)
    writes = {(method, path) for path, method, _ in described(client) if method not in SAFE} - COMPUTES
    assert {("POST", "/v1/jobs"), ("POST", "/v1/settled"), ("POST", "/v1/success-maps")} <= writes
    assert ("DELETE", "/v1/jobs/{id}") in writes
    for method, path in sorted(writes):
        for authorization, status in shown:
            headers = {} if authorization is None else {"Authorization": authorization}
            # What is asked for is looked at only once one may ask: a body that is none makes no difference.
            for body in ({"content": b"{"}, {"json": {"grid": {"phase_step": 60}}}):
                answer = client.request(method, address(path), headers=headers, **body)
                found = problem(answer, status)
                assert write not in answer.text, found
        problem(client.request(method, f"{address(path)}?key={write}"), 400)
    assert _content(engine) == before
    for method, path in sorted(writes):
        asked = client.request(method, address(path), headers={"Authorization": f"Bearer {write}"}, json={})
        assert asked.status_code in (200, 202)
    assert _content(engine) != before


@pytest.mark.slow
def test_what_is_safe_or_computes_changes_nothing(client: TestClient, engine: Engine) -> None:
    before = _content(engine)
    for path, method, _ in described(client):
        if method in SAFE or (method, path) in COMPUTES:
            body = {"poses": [{"roll": 1, "pitch": 2, "phase": 3}]} if method == "POST" else None
            if not path.endswith("/events"):
                client.request(method, address(path, roll="1"), json=body)
    assert _content(engine) == before
