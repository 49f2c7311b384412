from __future__ import annotations

import sys
from typing import Any

import pytest
from fastapi.testclient import TestClient

from service.app import LARGEST_BODY_BYTES, create_app
from service.problems import KINDS, Problem
from service.valid_ranges import valid_range
from tests.service.conftest import StoredLibrary, client_of
from threadstate.library.schema import SCHEMA_REVISION
from threadstate.settings import read_settings

pytestmark = pytest.mark.sqlite_alone

STATES = "/v1/libraries/latest/states"


def problem(response: Any, status: int) -> Problem:
    """The problem that a response holds, its shape checked."""
    assert response.status_code == status, response.text
    assert response.headers["Content-Type"] == "application/problem+json"
    assert response.headers["Cache-Control"] == "no-store"
    document = Problem.model_validate(response.json())
    assert document.status == status
    return document


@pytest.mark.parametrize(
    "path", ["/v1/libraries", "/v1/libraries/1", STATES, f"{STATES}/0/0/0", "/healthz", "/readyz", "/docs", "/"]
)
def test_unknown_parameter_is_named_and_the_valid_ones_listed(client: TestClient, path: str) -> None:
    found = problem(client.get(path, params={"colour": "red"}), 400)
    assert found.type == "urn:threadstate:problem:unknown-parameter"
    (error,) = found.errors
    assert error.location == "query colour"
    assert error.value == "red"
    assert ("unit" in error.valid) == path.startswith("/v1")


def test_valid_parameters_of_the_states_are_all_listed(client: TestClient) -> None:
    (error,) = problem(client.get(STATES, params={"Roll": "1"}), 400).errors
    assert set(error.valid.split(", ")) == {
        *("roll", "pitch", "phase", "phase_min", "phase_max", "class", "bolt_region", "nut_region", "flag"),
        *("support_margin_min", "support_margin_max", "mu_hold_min", "mu_hold_max", "mu_wedge_min", "mu_wedge_max"),
        *("fields", "sort", "limit", "cursor", "unit"),
    }


def test_parameter_given_twice_is_refused(client: TestClient) -> None:
    (error,) = problem(client.get(f"{STATES}?roll=1&roll=0"), 400).errors
    assert error.location == "query roll"


def test_unknown_parameter_of_post_is_refused(client: TestClient) -> None:
    body = {"poses": [{"roll": 0, "pitch": 0, "phase": 0}]}
    problem(client.post("/v1/solve", params={"limit": "1"}, json=body), 400)


def test_unknown_path_and_method(client: TestClient) -> None:
    assert problem(client.get("/nowhere"), 404).type == "about:blank"
    response = client.delete("/v1/libraries")
    assert problem(response, 405).title == "Method Not Allowed"
    assert "GET" in response.headers["Allow"]


def test_path_out_of_range_is_refused(client: TestClient) -> None:
    for pose in ("11/0/0", "0/nan/0", "0/0/360", "0/0/-1", "a/0/0", f"{'9' * 500}/0/0", "0/0/1e999", "%00/0/0"):
        assert problem(client.get(f"{STATES}/{pose}"), 400).errors


def test_echo_of_a_long_value_is_short(client: TestClient) -> None:
    assert len(client.get(STATES, params={"x" * 10_000: "y" * 10_000}).content) < 2000


def test_without_a_database_the_process_lives_and_is_not_ready(missing_database: str) -> None:
    cure = "`threadstate rebuild` makes it" if missing_database.startswith("sqlite") else "run `threadstate migrate`"
    with client_of(missing_database) as client:
        assert client.get("/healthz").json() == {"status": "ok"}
        assert cure in problem(client.get("/readyz"), 503).detail
        for path in ("/v1/libraries", "/v1/libraries/latest", STATES):
            assert "threadstate migrate" in problem(client.get(path), 503).detail


def test_without_a_library_it_is_not_ready(empty_database: str) -> None:
    with client_of(empty_database) as client:
        assert "threadstate rebuild" in problem(client.get("/readyz"), 503).detail
        assert "threadstate rebuild" in problem(client.get("/v1/libraries/latest"), 404).detail
        assert client.get("/v1/libraries").json() == {"libraries": []}


def test_with_a_library_it_is_ready(client: TestClient, made_up: StoredLibrary) -> None:
    assert client.get("/readyz").json() == {
        "status": "ready",
        "schema_revision": SCHEMA_REVISION,
        "library": made_up.id,
        "kernels": "ready",
    }


def test_failure_of_the_server_tells_nothing_of_itself(made_up: StoredLibrary) -> None:
    app = create_app(read_settings({"THREADSTATE_DATABASE": made_up.database}))

    @app.get("/failing")
    def failing() -> None:
        raise RuntimeError("a secret")

    with TestClient(app, raise_server_exceptions=False) as client:
        response = client.get("/failing")
    assert problem(response, 500).type == "urn:threadstate:problem:internal"
    assert "secret" not in response.text


def test_body_too_large_is_refused(client: TestClient) -> None:
    kilobytes = [b" " * 1024] * (LARGEST_BODY_BYTES // 1024 + 1)
    headers = {"Content-Type": "application/json"}
    problem(client.post("/v1/solve", content=b"".join(kilobytes), headers=headers), 413)
    problem(client.post("/v1/solve", content=iter(kilobytes), headers=headers), 413)


def test_kinds_have_names_of_their_own() -> None:
    assert len({kind.name for kind in KINDS}) == len(KINDS)


@pytest.mark.parametrize(
    ("body", "location", "valid"),
    [
        ({"mu": 3}, "body mu", "from 0 to 1"),
        ({"mu": -1}, "body mu", "from 0 to 1"),
        ({"longest_step": 0}, "body longest_step", "from 0.25 to 2"),
        ({"pose": {"roll": 1, "pitch": 1, "phase": 1e9}}, "body pose phase", "from -36000 to 36000"),
    ],
)
def test_a_number_out_of_range_is_told_both_bounds(
    client: TestClient, body: dict[str, Any], location: str, valid: str
) -> None:
    asked = {"pose": {"roll": 1, "pitch": 1, "phase": 1}, **body}
    (error,) = problem(client.post("/v1/assemblies", json=asked), 400).errors
    assert (error.location, error.valid) == (location, valid)


@pytest.mark.parametrize(
    ("schema", "location", "valid"),
    [
        ({"anyOf": [{"type": "string"}, {"exclusiveMinimum": 0}]}, (), "greater than 0"),
        ({"exclusiveMinimum": 0, "maximum": 2.5}, (), "greater than 0 and less than or equal to 2.5"),
        ({"$ref": "#/components/schemas/Row"}, (1,), "from 3 to 4"),
        ({"$ref": "#/components/schemas/Row"}, (7,), "from 1 to 2"),
        ({"properties": {"x": {"minimum": 0, "maximum": 9}}}, ("x", "constrained-float"), "from 0 to 9"),
        ({"minimum": 0, "maximum": sys.float_info.max}, (), "greater than or equal to 0"),
        ({"type": "number"}, (), None),
    ],
)
def test_ranges_are_those_of_the_described_schemas(
    schema: dict[str, Any], location: tuple[Any, ...], valid: str | None
) -> None:
    row = {"prefixItems": [{}, {"minimum": 3, "maximum": 4}], "items": {"minimum": 1, "maximum": 2}}
    content = {"application/json": {"schema": schema}}
    description = {
        "paths": {"/v1/x": {"post": {"requestBody": {"content": content}}}},
        "components": {"schemas": {"Row": row}},
    }
    assert valid_range(description, "/v1/x", "POST", ("body", *location)) == valid
