from __future__ import annotations

import asyncio
import threading
import time

import httpx2
import pytest
from fastapi.testclient import TestClient

from service.limits import QUEUED_PER_PLACE
from tests.service.conftest import StoredLibrary
from tests.service.test_problems import problem
from tests.service_app import service_app
from threadstate.settings import CONCURRENCY, DATABASE, STREAMS, TIME_LIMIT_S, read_settings

pytestmark = pytest.mark.sqlite_alone

SOLVE = {"poses": [{"roll": 1, "pitch": 2, "phase": 3}]}


def _slow(seconds: float, monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Make solving slow; the list gets the time of each beginning."""
    begun = list[float]()

    def slow(*_: object) -> tuple[()]:
        begun.append(time.monotonic())
        time.sleep(seconds)
        return ()

    monkeypatch.setattr("service.solve.solve_poses", slow)
    return begun


def _at_once(settings: dict[str, str], count: int, answered: threading.Event | None = None) -> list[httpx2.Response]:
    """The answers to that many requests that are sent at once; ``answered`` is set when all are there."""

    app = service_app(read_settings(settings))
    app.openapi()

    async def ask() -> list[httpx2.Response]:
        transport = httpx2.ASGITransport(app)
        async with httpx2.AsyncClient(transport=transport, base_url="http://service") as client:
            answers = await asyncio.gather(*(client.post("/v1/solve", json=SOLVE) for _ in range(count)))
        if answered is not None:
            answered.set()
        return answers

    return asyncio.run(ask())


@pytest.mark.slow
def test_more_than_can_wait_are_refused(made_up: StoredLibrary, monkeypatch: pytest.MonkeyPatch) -> None:
    begun = _slow(0.3, monkeypatch)
    places = 2
    waiting = places * QUEUED_PER_PLACE
    answers = _at_once({DATABASE: made_up.database, CONCURRENCY: str(places)}, waiting + 7)
    refused = [answer for answer in answers if answer.status_code == 429]
    assert 7 - places <= len(refused) <= 7
    assert len(begun) == len(answers) - len(refused)
    for answer in refused:
        assert problem(answer, 429).type.endswith(":too-many-requests")
        assert answer.headers["Retry-After"] == "1"
        assert answer.headers["X-Content-Type-Options"] == "nosniff"
    for one, two in zip(begun, begun[places:], strict=False):
        assert two - one > 0.25, "more than there are places computed at once"


@pytest.mark.slow
def test_request_over_its_time_is_given_up_and_keeps_its_place(
    made_up: StoredLibrary, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun = list[float]()
    answered = threading.Event()

    def slow(*_: object) -> tuple[()]:
        begun.append(time.monotonic())
        answered.wait(60)
        return ()

    monkeypatch.setattr("service.solve.solve_poses", slow)
    answers = _at_once({DATABASE: made_up.database, CONCURRENCY: "1", TIME_LIMIT_S: "3"}, 2, answered)
    for answer in answers:
        assert problem(answer, 503).type.endswith(":out-of-time")
        assert answer.headers["Retry-After"] == "1"
    assert begun, "neither was begun"
    assert len(begun) == 1, "one that still waited for a place was begun"


def test_health_is_answered_when_all_places_are_taken(made_up: StoredLibrary) -> None:
    with TestClient(service_app(read_settings({DATABASE: made_up.database}))) as client:
        (limits,) = (one for one in client.app.user_middleware if one.cls.__name__ == "LimitsMiddleware")  # type: ignore[attr-defined]
        admission = limits.kwargs["admission"]
        admission.queued = 10**6
        assert client.get("/v1/jobs").status_code == 429
        for path in ("/healthz", "/readyz", "/metrics", "/"):
            assert client.get(path).status_code == 200
        admission.queued = 0
        assert client.get("/v1/jobs").status_code == 200


def test_streams_have_a_limit_of_their_own(made_up: StoredLibrary) -> None:
    settings = {DATABASE: made_up.database, STREAMS: "0"}
    with TestClient(service_app(read_settings(settings))) as client:
        assert problem(client.get("/v1/jobs/1/events"), 429).type.endswith(":too-many-streams")
        assert client.get("/v1/jobs").status_code == 200
