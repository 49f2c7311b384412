"""Whatever is asked, the answer is no failure of the server, and an error is a problem document."""

from __future__ import annotations

import json
from typing import Any
from urllib.parse import quote

import pytest
from fastapi.testclient import TestClient
from hypothesis import given, settings
from hypothesis import strategies as st

pytestmark = [pytest.mark.sqlite_alone, pytest.mark.slow]

NAMES = (
    *("roll", "pitch", "phase", "phase_min", "phase_max", "class", "bolt_region", "nut_region", "flag"),
    *("fields", "sort", "limit", "cursor", "unit", "format", "mu", "force", "moment", "point", "search"),
)
ODD = (
    "",
    "nan",
    "-inf",
    "1e400",
    "-0.0",
    "0x10",
    "9" * 400,
    "\x00",
    "%",
    "null",
    "latest",
    "1/4",
    "..",
    "٣",
    "1_0",
    "+1",
)

text = st.one_of(
    st.sampled_from(ODD),
    st.integers(-(10**30), 10**30).map(str),
    st.floats().map(repr),
    st.text(max_size=20),
)
segments = st.one_of(
    st.sampled_from(("v1", "libraries", "states", "histories", "jobs", "events", "1", "docs", "assets")), text
)
resources = st.one_of(
    st.lists(segments, max_size=7),
    st.tuples(st.just("v1"), st.just("libraries"), text, st.just("states")),
    st.tuples(*map(st.just, ("v1", "libraries", "latest", "states"))),
    st.tuples(*map(st.just, ("v1", "libraries", "latest", "states")), text, text, text),
    st.tuples(*map(st.just, ("v1", "libraries", "latest", "states", "0", "0", "30", "statics"))),
    st.tuples(*map(st.just, ("v1", "libraries", "1", "histories")), text, text),
    st.tuples(st.just("v1"), st.just("threads")),
    st.tuples(st.just("v1"), st.just("jobs"), text),
    st.tuples(st.just("v1"), st.just("jobs"), text, st.just("events")),
)
json_values = st.recursive(
    st.one_of(st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5)),
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=5), inner, max_size=4)),
    max_leaves=10,
)
odd_numbers = st.one_of(st.floats(), st.integers(-(10**400), 10**400), st.text(max_size=5), st.none())
odd_poses = st.dictionaries(st.sampled_from(("roll", "pitch", "phase", "yaw")), odd_numbers)
odd_loads = st.dictionaries(
    st.sampled_from(("force", "moment", "point", "mu")), st.one_of(odd_numbers, st.lists(odd_numbers, max_size=3))
)
odd_devices = st.dictionaries(
    st.sampled_from(("unit", "k_lateral", "k_tilt", "k_twist", "stiffness", "centre", "push", "about")),
    st.one_of(odd_numbers, st.sampled_from(("in", "mm", "rigid", "nut")), st.lists(st.lists(odd_numbers), max_size=6)),
)
bodies = st.one_of(
    json_values,
    st.fixed_dictionaries(
        {"poses": st.lists(odd_poses, max_size=3)},
        optional={
            "designation": st.text(max_size=9),
            "loads": st.lists(odd_loads, max_size=2),
            "device": odd_devices,
        },
    ),
)


def check(response: Any) -> None:
    """The answer is none of the server's failures, and an error is a problem document."""
    assert response.status_code < 500, response.text
    if response.status_code >= 400:
        assert response.headers["Content-Type"] == "application/problem+json"
        assert response.json()["status"] == response.status_code


@settings(max_examples=300)
@given(
    path=resources,
    query=st.lists(st.tuples(st.one_of(st.sampled_from(NAMES), text), text), max_size=3),
    etag=st.one_of(st.none(), text),
)
def test_no_get_fails(
    client: TestClient, path: tuple[str, ...], query: list[tuple[str, str]], etag: str | None
) -> None:
    # The client, not the service, refuses an address that begins with two slashes.
    address = "/" + "/".join(quote(segment, safe="") for segment in path).lstrip("/")
    query_string = "&".join(f"{quote(name, safe='')}={quote(value, safe='')}" for name, value in query)
    headers = {} if etag is None else {b"If-None-Match": etag.encode("latin-1", "replace").replace(b"\n", b"")}
    check(client.get(f"{address}?{query_string}", headers=headers, follow_redirects=False))


@given(raw=st.binary(max_size=40))
def test_no_bytes_in_a_query_fail(client: TestClient, raw: bytes) -> None:
    check(client.get("/v1/libraries/latest/states?sort=" + "".join(f"%{byte:02x}" for byte in raw)))


@settings(max_examples=300)
@given(path=st.sampled_from(("/v1/solve", "/v1/statics", "/v1/settle", "/v1/assemblies")), body=bodies)
def test_no_json_body_fails(client: TestClient, path: str, body: object) -> None:
    headers = {"Content-Type": "application/json"}
    check(client.post(path, content=json.dumps(body), headers=headers))


@given(content=st.binary(max_size=100), media_type=st.sampled_from(("application/json", "text/plain", "x", "")))
def test_no_bytes_as_a_body_fail(client: TestClient, content: bytes, media_type: str) -> None:
    check(client.post("/v1/solve", content=content, headers={"Content-Type": media_type}))


def test_nesting_and_digits_without_end_are_refused(client: TestClient) -> None:
    headers = {"Content-Type": "application/json"}
    for content in ("[" * 100_000, '{"poses":' * 20_000, '{"poses":[{"roll":' + "9" * 100_000 + "}]}", '"\\ud800"'):
        response = client.post("/v1/solve", content=content, headers=headers)
        assert response.status_code == 400, response.text
        check(response)
