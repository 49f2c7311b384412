"""Failures: what is failures again, what is raised, and that a key is in none of it."""

from __future__ import annotations

import json
import pickle
import re
import time
import traceback
from collections.abc import Callable, Sequence
from datetime import UTC, datetime, timedelta
from email.utils import format_datetime
from pathlib import Path
from typing import Any

import anyio
import pytest

from tests.client.scripted_server import BREAK_OFF, SILENCE, ScriptedServer, answer, scripted_server
from threadstate.client import (
    AsyncClient,
    Client,
    ClientError,
    ConflictError,
    ConnectionFailedError,
    ForbiddenError,
    InvalidRequestError,
    NotFoundError,
    ProblemError,
    ServerError,
    ServiceUnavailableError,
    TimedOutError,
    TooManyRequestsError,
    UnauthorizedError,
    UndecidedPoseError,
    UnexpectedAnswerError,
    UnresolvedPoseError,
    retrying,
)
from threadstate.client.models.service import Health
from threadstate.client.retrying import LONGEST_PAUSE_S, Retrying, backoff_s, retry_after_s
from threadstate.errors import InvalidValueError

KEY = "ts_0123_thisisasecret"
OK = answer(200, '{"status":"ok"}')
JOB = {
    "id": 3,
    "kind": "library",
    "state": "queued",
    "reason": None,
    "designation": "1/4-20 UNC",
    "method": "exact",
    "device": None,
    "grid": {"tilt_max": 1, "tilt_step": 1, "phase_step": 90, "orientations": 9},
    "options": {},
    "input_sha256": "0",
    "code_version": "0",
    "chunks": 9,
    "committed": 0,
    "at_work": 0,
    "library": None,
    "result": None,
    "asked_at": "2026-01-01T00:00:00Z",
    "ended_at": None,
}


@pytest.fixture(autouse=True)
def _no_pauses(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(retrying, "FIRST_PAUSE_S", 0.001)


def _problem(status: int, name: str = "x", **headers: str) -> bytes:
    body = {"type": f"urn:threadstate:problem:{name}", "title": "A title", "status": status, "detail": "a detail"}
    return answer(status, json.dumps(body), "application/problem+json", **headers)


def _asked(script: Sequence[bytes], ask: Callable[[Client], Any], **options: Any) -> tuple[Any, ScriptedServer]:
    """What a request comes to, an error too, and the server that was asked."""
    with scripted_server(script) as server, Client(server.address, **options) as client:
        try:
            return ask(client), server
        except ClientError as error:
            return error, server


@pytest.mark.parametrize(
    ("status", "name", "kind"),
    [
        (400, "invalid-value", InvalidRequestError),
        (401, "key-refused", UnauthorizedError),
        (403, "scope-refused", ForbiddenError),
        (404, "not-found", NotFoundError),
        (404, "undecided-pose", UndecidedPoseError),
        (409, "job-ended", ConflictError),
        (413, "x", InvalidRequestError),
        (418, "x", ProblemError),
        (422, "unresolved-pose", UnresolvedPoseError),
        (429, "x", TooManyRequestsError),
        (500, "internal", ServerError),
        (501, "not-installed", ServerError),
        (503, "not-migrated", ServiceUnavailableError),
    ],
)
def test_each_problem_has_its_error(status: int, name: str, kind: type[ProblemError]) -> None:
    error, server = _asked([_problem(status, name)], lambda client: client.libraries(), retries=0)
    assert type(error) is kind
    assert (error.status, error.name, error.title, error.detail) == (status, name, "A title", "a detail")
    assert str(error) == f"GET /v1/libraries: {status} A title: a detail"
    assert len(server.heads) == 1


@pytest.mark.parametrize("failure", [BREAK_OFF, _problem(429), _problem(503), _problem(429, Retry_After="0")])
def test_what_may_pass_is_tried_again_and_again(failure: bytes) -> None:
    found, server = _asked([failure, failure, OK], lambda client: client.health(), retries=2)
    assert found == Health(status="ok")
    assert len(server.heads) == 3
    error, server = _asked([failure], lambda client: client.health(), retries=2)
    assert isinstance(error, ConnectionFailedError | TooManyRequestsError | ServiceUnavailableError)
    assert len(server.heads) == 3


@pytest.mark.parametrize("failure", [_problem(400), _problem(404), _problem(500), answer(200, "{}"), answer(302)])
def test_nothing_else_is(failure: bytes) -> None:
    error, server = _asked([failure, OK], lambda client: client.health())
    assert isinstance(error, ProblemError | UnexpectedAnswerError)
    assert len(server.heads) == 1


def test_the_asynchronous_client_tries_again_as_well() -> None:
    async def ask(address: str) -> Health:
        async with AsyncClient(address, retries=2) as client:
            return await client.health()

    with scripted_server([BREAK_OFF, _problem(503), OK]) as server:
        assert anyio.run(ask, server.address) == Health(status="ok")
    with scripted_server([_problem(503)]) as server, pytest.raises(ServiceUnavailableError):
        anyio.run(ask, server.address)
    assert len(server.heads) == 3


def test_what_was_not_answered_in_time_is_not_asked_again() -> None:
    error, server = _asked([SILENCE], lambda client: client.health(), timeout_s=0.2)
    assert isinstance(error, TimedOutError)
    assert error.reached
    assert len(server.heads) == 1


def test_a_job_may_be_asked_for_again() -> None:
    job, server = _asked([BREAK_OFF, answer(202, json.dumps(JOB))], lambda client: client.ask(), key=KEY)
    assert job.id == 3
    assert len(server.heads) == 2


def test_only_what_is_repeatable_is_repeated() -> None:
    policy = Retrying(3)
    broken = ConnectionFailedError("x", reached=True)
    never_made = ConnectionFailedError("x", reached=False)
    assert policy.pause_s(broken, 0, repeatable=False) is None
    assert policy.pause_s(broken, 0, repeatable=True) is not None
    assert policy.pause_s(never_made, 2, repeatable=False) is not None
    assert policy.pause_s(never_made, 3, repeatable=True) is None


def test_the_service_says_how_long_to_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    pauses: list[float] = []
    monkeypatch.setattr(time, "sleep", pauses.append)
    found, _ = _asked([_problem(429, Retry_After="7"), OK], lambda client: client.health())
    assert (found, pauses) == (Health(status="ok"), [7.0])
    error, server = _asked([_problem(503, Retry_After="3600"), OK], lambda client: client.health())
    assert isinstance(error, ServiceUnavailableError)
    assert (error.retry_after_s, len(server.heads)) == (3600.0, 1)
    soon = datetime.now(UTC) + timedelta(seconds=60)
    assert retry_after_s(format_datetime(soon, usegmt=True)) == pytest.approx(60.0, abs=5.0)
    for unreadable in (None, "", "soon", "-1", "1.5", "٣"):
        assert retry_after_s(unreadable) is None


def test_pauses_double_up_to_a_limit() -> None:
    assert all(0.0 < backoff_s(failures) <= LONGEST_PAUSE_S for failures in range(2000))
    assert backoff_s(2000) > 0.4 * LONGEST_PAUSE_S


@pytest.mark.parametrize("body", ["", "nothing", "[]", '{"library":1,"unit":"furlong","states":[],"next":null}'])
def test_an_answer_of_something_else_is_none(body: str) -> None:
    error, _ = _asked([answer(200, body)], lambda client: list(client.states()))
    assert isinstance(error, UnexpectedAnswerError)
    assert "/v1/libraries/latest/states" in str(error)


def test_a_page_of_html_is_told_as_what_it_is() -> None:
    error, _ = _asked([answer(502, "<h1>Bad\nGateway</h1>", "text/html")], lambda client: client.libraries())
    assert isinstance(error, ServerError)
    assert (error.status, error.type, error.detail) == (502, "about:blank", "<h1>Bad Gateway</h1>")


@pytest.mark.parametrize("link", ["//elsewhere/v1", "http://elsewhere/v1", "v1"])
def test_a_link_to_another_host_is_not_followed(link: str) -> None:
    page = {"library": 1, "undecided": [], "next": link}
    error, server = _asked([answer(200, json.dumps(page))], lambda client: list(client.undecided()), key=KEY)
    assert isinstance(error, UnexpectedAnswerError)
    assert len(server.heads) == 1


def test_a_key_is_shown_to_the_service_and_to_nobody_else() -> None:
    with scripted_server([OK]) as elsewhere:
        error, server = _asked(
            [answer(307, Location=f"{elsewhere.address}/healthz")], lambda client: client.health(), key=KEY
        )
        assert isinstance(error, UnexpectedAnswerError)
        assert re.search(rf"^authorization: Bearer {KEY}\r$", server.heads[0], re.M | re.I)
    assert elsewhere.heads == []


def test_a_key_comes_from_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("THREADSTATE_KEY", KEY)
    with scripted_server([OK]) as server:
        monkeypatch.setenv("THREADSTATE_SERVICE", server.address)
        with Client() as client:
            client.health()
    assert KEY in server.heads[0]


@pytest.mark.parametrize("script", [[BREAK_OFF], [_problem(401)], [answer(200, "x")], [SILENCE]])
def test_a_key_is_in_no_error(script: Sequence[bytes]) -> None:
    with scripted_server(script) as server, Client(server.address, key=KEY, retries=0, timeout_s=0.2) as client:
        assert KEY not in repr(client) + str(vars(client))
        assert "with a key" in repr(client)
        with pytest.raises(ClientError) as caught:
            client.health()
        error = caught.value
        told = "".join(traceback.format_exception(error)) + repr(error) + str(vars(error))
        assert KEY not in told
        assert error.__context__ is None or error.__suppress_context__


@pytest.mark.parametrize("key", ["two words", "line\nbreak", "ключ"])
def test_what_cannot_be_a_key_is_refused_without_being_shown(key: str) -> None:
    with pytest.raises(InvalidValueError, match="key") as caught:
        Client(key=key)
    assert key not in str(caught.value)


@pytest.mark.parametrize(
    "address", ["ftp://host", "host", "http://", "http://host?x=1", "http://user:secret@host", "http://host:port"]
)
def test_an_address_is_one_of_http(address: str) -> None:
    with pytest.raises(InvalidValueError, match="address") as caught:
        Client(address)
    assert "secret" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "value"), [("retries", -1), ("retries", 101), ("timeout_s", 0.0), ("timeout_s", float("nan"))]
)
def test_options_have_a_range(name: str, value: float) -> None:
    with pytest.raises(InvalidValueError, match=name):
        Client(**{name: value})  # type: ignore[arg-type]


def test_nobody_there_is_a_failed_connection() -> None:
    with scripted_server([OK]) as server:
        pass
    with (
        Client(server.address, retries=1) as client,
        pytest.raises(ConnectionFailedError) as caught,
    ):
        client.health()
    assert not caught.value.reached
    assert str(caught.value).startswith(f"no service answers at {server.address} (")
    assert "`threadstate serve`" in str(caught.value)


def test_a_download_that_breaks_off_leaves_what_was_there(tmp_path: Path) -> None:
    out = tmp_path / "states.csv"
    out.write_text("as before")
    half = b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n4\r\nroll\r\n"
    whole = b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n4\r\nroll\r\n0\r\n\r\n"
    error, server = _asked([half], lambda client: client.export("states", out), retries=1)
    assert isinstance(error, ConnectionFailedError)
    assert len(server.heads) == 2
    assert [(one.name, one.read_text()) for one in tmp_path.iterdir()] == [("states.csv", "as before")]
    found, _ = _asked([half, whole], lambda client: client.export("states", out), retries=1)
    assert found == out
    assert out.read_text() == "roll"


def test_asynchronous_downloads_are_whole_or_not_at_all(tmp_path: Path) -> None:
    out = tmp_path / "states.csv"

    async def ask(address: str) -> Path:
        async with AsyncClient(address, retries=1) as client:
            return await client.export("states", out)

    half = b"HTTP/1.1 200 OK\r\nContent-Length: 9\r\n\r\nroll"
    with scripted_server([half]) as server, pytest.raises(ConnectionFailedError):
        anyio.run(ask, server.address)
    assert list(tmp_path.iterdir()) == []
    with scripted_server([half, answer(200, "roll")]) as server:
        assert anyio.run(ask, server.address).read_text() == "roll"


def test_errors_can_be_sent_to_other_processes() -> None:
    error, _ = _asked([_problem(404)], lambda client: client.health())
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), again.status, str(again)) == (NotFoundError, 404, str(error))
