"""What nobody means well by: it is refused with a problem document, or answered; the server never fails on it."""

from __future__ import annotations

import itertools
import json
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any
from urllib.parse import quote

import pytest
from fastapi.testclient import TestClient

from harness.databases import Databases
from service.app import LARGEST_BODY_BYTES
from tests.service.conftest import client_of
from tests.service.test_fuzz import check
from tests.service.test_problems import problem
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.library.engine import writing

pytestmark = [pytest.mark.sqlite_alone, pytest.mark.slow]

STATES = "/v1/libraries/latest/states"
JSON = {"Content-Type": "application/json"}
METHODS = ("GET", "HEAD", "OPTIONS", "TRACE", "PUT", "PATCH", "POST", "DELETE", "BREW")

ODD_IN_ADDRESSES = (
    *(
        "",
        "%00",
        "a%00b",
        "%FF%FE",
        "%ED%A0%80",
        "%",
        "%250",
        "%0d%0aX-Y:%20z",
        "..",
        "%2e%2e%2fetc%2fpasswd",
        "%2F%2F",
    ),
    *("nan", "-Infinity", "1e400", "-0.0", "1_0", "%D9%A3", "9" * 400, "2147483648", "9223372036854775808", "-1", "+1"),
    *("'%20OR%201=1--", "%25", ",", ":::", "%5B%5D", "x" * 3000),
)
SHARE = 4
"""Of the odd values, one in so many is asked of a parameter again."""
ANGLES = ("1_0", "-1", "+1")
"""Of these, what is an angle that a whole history can be solved for, each time anew."""
ODD_HEADERS: tuple[dict[str, str], ...] = (
    {"Range": "bytes=0-10"},
    {"Range": "bytes=9999999999999999999-"},
    {"Range": "lines=1-2"},
    {"If-Range": '"x"', "Range": "bytes=0-0"},
    {"Accept": ""},
    {"Accept": "text/csv;q=nan, */*;q=-1, ;;;,,"},
    {"Accept": "image/png"},
    {"Accept": "a" * 8000},
    {"Accept-Encoding": "gzip;q=x, br, ;q=, *;q=0.0.0"},
    {"Accept-Language": "\xff"},
    {"If-None-Match": ',,W/,"'},
    {"If-None-Match": '"' * 4000},
    {"If-Modified-Since": "yesterday"},
    {"Last-Event-ID": "-1"},
    {"Last-Event-ID": "9" * 400},
    {"Last-Event-ID": "\xb2"},
    {"Authorization": ""},
    {"Authorization": "Bearer"},
    {"Authorization": "Bearer " + "\xff" * 40},
    {"Authorization": "Bearer ts_" + "0" * 9000},
    {"Authorization": "Digest username=x"},
    {"Content-Type": "application/json; charset=utf-16"},
    {"Content-Encoding": "gzip"},
    {"Cookie": "\xff=\xfe;;=;" * 20},
    {"Origin": "null"},
    {"Host": "somebody.else"},
    {"X-Forwarded-Host": "somebody.else", "X-Forwarded-Proto": "javascript", "Forwarded": "host=x"},
    {"X-HTTP-Method-Override": "DELETE"},
    {"Transfer-Encoding": "chunked, chunked"},
)
NO_JSON = (
    b"",
    b"{",
    b"nul",
    b"\xff\xfe{\x00}\x00",
    b"\xef\xbb\xbf{}",
    b'{"a": 1} {}',
    b'{"a":\x00}',
    b'{"roll": \xff}',
    b"[" * 10_000,
    b"[" * 10_000 + b"]" * 10_000,
    b'{"poses":' * 10_000 + b"1" + b"}" * 10_000,
    b'{"poses": [{"roll": NaN, "pitch": 0, "phase": 0}]}',
    b'{"poses": [{"roll": -Infinity, "pitch": 0, "phase": 0}]}',
    b'{"poses": [{"roll": 1e400, "pitch": 0, "phase": 0}]}',
    b'{"poses": [{"roll": %s, "pitch": 0, "phase": 0}]}' % (b"9" * 5000),
    b'{"poses": [], "poses": [{"roll": 0, "pitch": 0, "phase": 0}]}',
    b'{"poses": [{"roll": 9, "roll": 0, "pitch": 0, "phase": 0}]}',
    b'{"grid": {"phase_step": 5, "phase_step": 5}}',
    b'{"designation": "\\u0000"}',
    b'{"designation": "\\ud800"}',
    b'{"designation": "1/4-20 UNC\\u0000", "poses": [{"roll": 0, "pitch": 0, "phase": 0}]}',
    b'{"grid": {"tilt_max": 10, "tilt_step": 0.01, "phase_step": 0.01}}',
    b'{"grid": {"tilt_step": 1e-320}}',
    b'{"tolerances": {"tie_tolerance": 1e308}}',
    b'{"mesh": {"__class__": "x"}}',
)


def described(client: TestClient) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Path, method and description of every operation."""
    for path, methods in client.get("/openapi.json").json()["paths"].items():
        for method, operation in methods.items():
            yield path, method.upper(), operation


def address(path: str, **values: str) -> str:
    """A path with values in place of its parameters, as they are."""
    known = {
        "id": "1",
        "roll": "0",
        "pitch": "0",
        "phase": "0",
        "key": "0000000000",
        "part": "bolt",
        "table": "states",
        "format": "ndjson",
    }
    return path.format(**{**known, **values})


def test_no_odd_value_of_any_parameter_fails(client: TestClient) -> None:
    met: Counter[str] = Counter()
    asked = 0
    for path, method, operation in described(client):
        for parameter in operation.get("parameters", ()):
            name = parameter["name"]
            kind = json.dumps([name, parameter["in"], parameter["schema"]])
            # A parameter of many paths is read by the same code: all values at the first of them, some at each other.
            values = ODD_IN_ADDRESSES[met[kind] % SHARE :: SHARE] if met[kind] else ODD_IN_ADDRESSES
            met[kind] += 1
            for odd in values:
                if odd in ANGLES and path.startswith("/v1/histories"):
                    continue
                if parameter["in"] == "path":
                    check(client.request(method, address(path, **{name: odd})))
                elif parameter["in"] == "query":
                    check(client.request(method, f"{address(path)}?{quote(name)}={odd}"))
                asked += 1
    assert len(met) > 40
    assert asked > 1000


def test_no_method_and_no_header_fails(client: TestClient) -> None:
    paths = sorted({path for path, _, _ in described(client)} | {"/", "/docs", "/openapi.json", "/nowhere", "/v1"})
    asked = [
        *itertools.product(paths, METHODS, ({},)),
        *itertools.product(("/v1/jobs", "/v1/jobs/{id}/events", "/v1/libraries/{id}/states"), METHODS[:2], ODD_HEADERS),
        *itertools.product(("/v1/libraries/{id}/meshes/{part}", "/", "/nowhere", "/v1/solve"), ("GET",), ODD_HEADERS),
    ]
    for path, method, headers in asked:
        if method == "GET" and path.startswith("/v1/histories"):
            continue
        response = client.request(method, address(path), headers=[(k, v.encode("latin-1")) for k, v in headers.items()])
        assert response.status_code < 500, (method, path, headers)
        assert response.status_code != 206
        if response.status_code >= 400:
            assert response.headers["Content-Type"] == "application/problem+json", (method, path, headers)
        if response.status_code == 405:
            assert method not in response.headers["Allow"].split(", ")


def test_methods_that_a_path_has_are_named(client: TestClient) -> None:
    for method, path, allowed in (
        ("OPTIONS", "/v1/jobs", "GET, HEAD, POST"),
        ("PUT", "/v1/jobs/1", "DELETE, GET, HEAD"),
        ("GET", "/v1/solve", "POST"),
        ("TRACE", "/", "GET, HEAD"),
    ):
        response = client.request(method, path)
        problem(response, 405)
        assert response.headers["Allow"] == allowed


@pytest.mark.parametrize("media_type", ["application/json", "application/json; charset=latin-1", "text/json", "", "*"])
def test_no_body_that_is_none_passes(databases: Databases, media_type: str) -> None:
    with databases.lent() as database, client_of(database) as client:
        with writing(database) as engine:
            key = create_key(engine, "hostile", Scope.WRITE)
        headers = {"Authorization": f"Bearer {key}", "Content-Type": media_type}
        for path, content in itertools.product(("/v1/solve", "/v1/jobs"), NO_JSON):
            problem(client.post(path, content=content, headers=headers), 400)
        assert client.get("/v1/jobs").json()["jobs"] == []


def test_why_a_body_is_no_json_is_said(client: TestClient) -> None:
    for content, reason in (
        (b'{"poses": [], "poses": []}', "'poses' is there twice"),
        (b'{"poses": [NaN]}', "NaN is no number"),
        (b"\xff", "not UTF-8"),
        (b"[" * 10_000, "nested too deeply"),
        (b'{"poses"}', "delimiter"),
    ):
        (error,) = problem(client.post("/v1/solve", content=content, headers=JSON), 400).errors
        assert reason in error.valid
        assert error.location.startswith("body")


def test_a_body_beyond_the_limit_is_refused_whatever_it_is(client: TestClient) -> None:
    for content in (b"[" * (LARGEST_BODY_BYTES + 1), b" " * (10 * LARGEST_BODY_BYTES)):
        problem(client.post("/v1/solve", content=content, headers=JSON), 413)


def test_overlong_queries_are_answered(client: TestClient) -> None:
    problem(client.get(f"{STATES}?{'&'.join(f'a{i}=1' for i in range(5000))}"), 400)
    problem(client.get(f"{STATES}?roll={'1' * 60_000}"), 400)
    problem(client.get(f"{STATES}?{'roll=1&' * 5000}"), 400)
    problem(client.get(f"{STATES}?fields={'roll,' * 5000}"), 400)
    problem(client.get(f"/{'v1/' * 5000}"), 404)


def test_only_the_very_cursor_of_a_query_passes(client: TestClient, solved_client: TestClient) -> None:
    cursor = _cursor(client, "limit=7")
    assert client.get(f"{STATES}?limit=7&cursor={cursor}").status_code == 200
    for other in (_cursor(solved_client, "limit=7&sort=mu"), _cursor(client, "limit=7&sort=phase"), *_garbled(cursor)):
        response = client.get(f"{STATES}?limit=7&cursor={quote(other, safe='')}")
        (error,) = problem(response, 400).errors
        assert error.location in ("cursor", "query cursor")


def _cursor(client: TestClient, query: str) -> str:
    response = client.get(f"{STATES}?{query}").json()["next"]
    cursor: str = response.partition("cursor=")[2].partition("&")[0]
    return cursor


def _garbled(cursor: str) -> Sequence[str]:
    cut = [cursor[:length] for length in range(1, len(cursor) - 3)]
    turned = [cursor[:i] + ("A" if cursor[i] != "A" else "B") + cursor[i + 1 :] for i in range(24)]
    return [
        *cut,
        *turned,
        cursor + cursor,
        cursor[::-1],
        "A" * 256,
        "A" * 257,
        "W10",
        "W1tbXV0",
        "bnVsbA",
        "\x00",
        "=" * 8,
    ]
