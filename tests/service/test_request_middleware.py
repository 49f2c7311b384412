from __future__ import annotations

import json
import logging
import re
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

import pytest
import structlog
from fastapi.testclient import TestClient
from structlog.testing import capture_logs

from service.logs import configure_logs
from service.request_scope import current_request_id
from tests.service.conftest import StoredLibrary
from tests.service.test_problems import problem
from tests.service_app import service_app
from threadstate.errors import InvalidValueError
from threadstate.settings import CORS_ORIGINS, DATABASE, LogForm, LogLevel, read_settings

pytestmark = pytest.mark.sqlite_alone

ORIGIN = "https://example.com"


def _logging_client(library: StoredLibrary) -> TestClient:
    settings = read_settings({DATABASE: library.database})
    return TestClient(service_app(settings, serving=True), raise_server_exceptions=False)


def test_request_has_the_number_that_it_asks_for(client: TestClient) -> None:
    for asked in ("7", "a" * 40, "0190c4f7-6f4c-7b8e-8d9f-1c2d3e4f5a6b", "1:2.3"):
        assert client.get("/healthz", headers={"X-Request-ID": asked}).headers["X-Request-ID"] == asked


@pytest.mark.parametrize("asked", ["", "a" * 41, "a b", "ts_0123", "ä", '"', "a\tb"])
def test_number_that_is_not_well_formed_is_replaced(client: TestClient, asked: str) -> None:
    given = client.get("/healthz", headers=[(b"X-Request-ID", asked.encode())]).headers["X-Request-ID"]
    assert re.fullmatch("[0-9a-f]{16}", given)


def test_problem_names_its_request(client: TestClient) -> None:
    answer = client.get("/v1/libraries/999", headers={"X-Request-ID": "mine"})
    assert problem(answer, 404).instance == "urn:threadstate:request:mine"


def test_every_request_has_a_line(made_up: StoredLibrary) -> None:
    asked = [
        ("GET", "/v1/libraries/latest/states/1/-1/30", 200, "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}"),
        ("GET", "/v1/libraries/latest/states/1/-1/30", 200, "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}"),
        ("GET", "/v1/libraries/latest/states/1/-1/31", 404, "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}"),
        ("HEAD", "/v1/libraries", 200, "/v1/libraries"),
        ("POST", "/v1/jobs", 401, "/v1/jobs"),
        ("GET", "/nowhere", 404, "unmatched"),
        ("PURGE", "/healthz", 405, "unmatched"),
    ]
    with _logging_client(made_up) as client, capture_logs() as lines:
        sizes = [len(client.request(method, path).content) for method, path, _, _ in asked]
    assert [(line["status"], line["route"]) for line in lines] == [(status, route) for _, _, status, route in asked]
    assert [line["method"] for line in lines] == [*(method for method, *_ in asked[:-1]), "other"]
    assert all(line["duration_ms"] > 0.0 and line["client"] for line in lines)
    assert [line["bytes"] > 0 for line in lines] == [size > 0 for size in sizes]


def test_fault_is_logged_numbered_and_marked(made_up: StoredLibrary, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("service.solve.solve_poses", fail)
    with _logging_client(made_up) as client, capture_logs() as lines:
        answer = client.post("/v1/solve", json={"poses": [{"roll": 1, "pitch": 2, "phase": 3}]})
    assert problem(answer, 500).instance == f"urn:threadstate:request:{answer.headers['X-Request-ID']}"
    assert answer.headers["X-Content-Type-Options"] == "nosniff"
    assert [(line["status"], line["log_level"]) for line in lines] == [(500, "error")]


@contextmanager
def _logging_to_stderr(form: LogForm) -> Iterator[None]:
    before = structlog.get_config()
    root = logging.getLogger()
    handlers, level = root.handlers[:], root.level
    token = current_request_id.set("mine")
    try:
        configure_logs(form, LogLevel.INFO)
        yield
    finally:
        current_request_id.reset(token)
        structlog.configure(**before)
        root.handlers, root.level = handlers, level


def test_lines_are_json_with_the_number_and_the_traceback(capfd: pytest.CaptureFixture[str]) -> None:
    began = datetime.now(UTC)
    with _logging_to_stderr(LogForm.JSON):
        structlog.get_logger().info("one", route="/x")
        structlog.get_logger().debug("none")
        try:
            raise ZeroDivisionError("x")
        except ZeroDivisionError:
            logging.getLogger("uvicorn.error").exception("two")
    one, two = (json.loads(line) for line in capfd.readouterr().err.splitlines())
    assert (one["event"], one["route"], one["request_id"], one["level"]) == ("one", "/x", "mine", "info")
    assert one["timestamp"].endswith("Z")
    assert began <= datetime.fromisoformat(one["timestamp"]) <= datetime.now(UTC)
    assert (two["event"], two["logger"], two["level"]) == ("two", "uvicorn.error", "error")
    assert "ZeroDivisionError: x" in two["exception"]


@pytest.mark.parametrize(("value", "written"), [("\ud800", "\ud800"), (1 << 70, 1 << 70), (1j, "1j")])
def test_line_is_written_whatever_is_in_it(capfd: pytest.CaptureFixture[str], value: object, written: object) -> None:
    with _logging_to_stderr(LogForm.JSON):
        structlog.get_logger().info("one", value=value)
    line = json.loads(capfd.readouterr().err)
    assert (line["event"], line["request_id"]) == ("one", "mine")
    assert line["value"] == written


def test_lines_for_people_have_the_same(capfd: pytest.CaptureFixture[str]) -> None:
    with _logging_to_stderr(LogForm.TEXT):
        structlog.get_logger().info("one", route="/x")
    line = capfd.readouterr().err
    assert re.match(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d+Z ", line)
    assert "one" in line
    assert "request_id=mine route=/x" in line


def test_metrics_count_requests_by_route(made_up: StoredLibrary) -> None:
    with TestClient(service_app(read_settings({DATABASE: made_up.database}))) as client:
        # States are read from the database every time, lists of orientations are cached.
        cached = ("latest/orientations", "latest/orientations")
        for path in ("latest/states/1/-1/30", "latest/states/1/-1/30", "latest/states/1/-1/31", "secret", *cached):
            client.get(f"/v1/libraries/{path}", headers={"Accept-Encoding": "identity"})
        answer = client.get("/metrics")
    text = answer.text
    assert answer.headers["Content-Type"].startswith("text/plain; version=0.0.4")
    route = 'method="GET",route="/v1/libraries/{id}/states/{roll}/{pitch}/{phase}"'
    assert f'threadstate_requests_total{{{route},status="2xx"}} 2.0' in text
    assert f'threadstate_requests_total{{{route},status="4xx"}} 1.0' in text
    assert "secret" not in text
    assert "threadstate_cache_hits_total 1.0" in text
    assert "threadstate_libraries 1.0" in text
    assert 'threadstate_jobs{state="queued"} 0.0' in text
    assert "threadstate_requests_in_flight 1.0" in text


def test_metrics_without_a_database_say_so(missing_database: str) -> None:
    with TestClient(service_app(read_settings({DATABASE: missing_database}))) as client:
        text = client.get("/metrics").text
    assert "threadstate_database_up 0.0" in text
    assert "threadstate_libraries" not in text


def test_every_metric_is_documented(made_up: StoredLibrary, repository_root: Path) -> None:
    with TestClient(service_app(read_settings({DATABASE: made_up.database}))) as client:
        found = set(re.findall(r"^# TYPE (\w+)", client.get("/metrics").text, re.M))
    text = (repository_root / "docs" / "operations.md").read_text()
    documented = set(re.findall(r"`(threadstate_\w+)`", text))
    assert documented == {name for name in found if not name.endswith("_created")}


def test_other_origins_are_answered_where_they_are_listed(made_up: StoredLibrary) -> None:
    preflight = {
        "Origin": ORIGIN,
        "Access-Control-Request-Method": "POST",
        "Access-Control-Request-Headers": "authorization",
    }
    settings = read_settings({DATABASE: made_up.database, CORS_ORIGINS: f"{ORIGIN}, http://127.0.0.1:1"})
    with TestClient(service_app(settings)) as client:
        answer = client.options("/v1/jobs", headers=preflight)
        assert answer.status_code == 200
        assert answer.headers["Access-Control-Allow-Origin"] == ORIGIN
        assert "DELETE" in answer.headers["Access-Control-Allow-Methods"]
        assert "Access-Control-Allow-Credentials" not in answer.headers
        for _ in range(2):
            got = client.get("/v1/libraries/latest", headers={"Origin": ORIGIN})
            assert got.headers["Access-Control-Allow-Origin"] == ORIGIN
            assert "Origin" in got.headers["Vary"]
            assert "ETag" in got.headers["Access-Control-Expose-Headers"]
        other = client.get("/v1/libraries/latest", headers={"Origin": "https://example.org"})
        assert "Access-Control-Allow-Origin" not in other.headers
        assert client.options("/v1/jobs", headers={**preflight, "Origin": "https://example.org"}).status_code == 400


def test_no_origin_is_allowed_by_default(client: TestClient) -> None:
    assert "Access-Control-Allow-Origin" not in client.get("/healthz", headers={"Origin": ORIGIN}).headers


@pytest.mark.parametrize(
    "origins", ["*", "example.com", "https://example.com/", f"{ORIGIN},*", "https://*.example.com"]
)
def test_what_is_no_origin_is_refused(origins: str) -> None:
    with pytest.raises(InvalidValueError, match=CORS_ORIGINS):
        read_settings({CORS_ORIGINS: origins, "HOME": "/h"})
