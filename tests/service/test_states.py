from __future__ import annotations

import base64
import json
import math
from typing import Any

import pytest
from fastapi.testclient import TestClient
from hypothesis import given
from hypothesis import strategies as st

from service.states.parameters import FIELDS
from service.states.query import SORTS, Sort
from tests.service.conftest import StoredLibrary
from threadstate.state.document import state_document
from threadstate.state.model import ContactState, Flag, StateClass
from threadstate.statics.stored import NAMES as STATICS
from threadstate.statics.stored import StoredStatics
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS

pytestmark = pytest.mark.sqlite_alone

STATES = "/v1/libraries/latest/states"

angles = st.sampled_from((-1, 0, 1))
phases = st.integers(0, 11).map(lambda i: i * 30)
filters = st.fixed_dictionaries(
    {},
    optional={
        "roll": angles,
        "pitch": angles,
        "phase": phases,
        "phase_min": phases.filter(lambda phase: phase <= 180),
        "phase_max": phases.filter(lambda phase: phase >= 180),
        "class": st.sampled_from([name.value for name in StateClass]),
        "bolt_region": st.sampled_from([name.value for name in BOLT_REGIONS]),
        "nut_region": st.sampled_from([name.value for name in NUT_REGIONS]),
        "flag": st.sampled_from([name.value for name in Flag]),
        "support_margin_min": st.sampled_from([-0.25, 0.0, 0.1]),
        "support_margin_max": st.sampled_from([0.1, 0.2]),
        "mu_hold_min": st.sampled_from([0.0, 0.25]),
        "mu_hold_max": st.sampled_from([0.25, 0.4]),
        "mu_wedge_min": st.sampled_from([0.0, 0.25]),
        "mu_wedge_max": st.sampled_from([0.25, 0.4]),
    },
)


def in_range(which: dict[str, Any], name: str, statics: StoredStatics | None) -> bool:
    """Whether a number of a state's statics lies in its range; a friction that does not exist is infinite."""
    least, greatest = which.get(f"{name}_min", -math.inf), which.get(f"{name}_max", math.inf)
    if statics is None:
        return (least, greatest) == (-math.inf, math.inf)
    value = getattr(statics, name)
    return bool(least <= (math.inf if value is None else value) <= greatest)


def matches(state: ContactState, statics: StoredStatics | None, which: dict[str, Any]) -> bool:
    """Whether a state fulfils a filter, said plainly."""
    document = state_document(state)
    return all(
        (
            which.get("roll", state.roll_deg) == state.roll_deg,
            which.get("pitch", state.pitch_deg) == state.pitch_deg,
            which.get("phase", state.phase_deg) == state.phase_deg,
            which.get("phase_min", 0) <= state.phase_deg <= which.get("phase_max", 360),
            which.get("class", document["class"]) == document["class"],
            "bolt_region" not in which or which["bolt_region"] in [one["bolt_region"] for one in document["contacts"]],
            "nut_region" not in which or which["nut_region"] in [one["nut_region"] for one in document["contacts"]],
            "flag" not in which or which["flag"] in document["flags"],
            *(in_range(which, name, statics) for name in STATICS),
        )
    )


def sort_value(state: ContactState, statics: StoredStatics | None, key: str) -> tuple[bool, float | str]:
    """What a state is sorted by before its pose; what is absent comes first."""
    value = {
        "roll": 0.0,
        "pitch": state.pitch_deg,
        "phase": state.phase_deg,
        "class": state.state_class.value,
        "lambda": state.lambda_deg,
        "mu": state.mu_deg,
        "drop": state.drop,
        "embedment": state.embedment,
        "pivot_offset": state.pivot_offset,
        **{name: getattr(statics, name, None) for name in STATICS},
    }[key]
    return value is not None, 0.0 if value is None else value


def expected(library: StoredLibrary, which: dict[str, Any], sort: Sort) -> list[int]:
    """The ordinals of the states under a filter in an order, found by Python's own sorting."""
    states, statics = library.states, library.statics
    ascending = sorted(
        (ordinal for ordinal, state in enumerate(states) if matches(state, statics[ordinal], which)),
        key=lambda ordinal: sort_value(states[ordinal], statics[ordinal], sort.key),
    )
    return ascending[::-1] if sort.descending else ascending


def walk(client: TestClient, query: dict[str, Any]) -> list[dict[str, Any]]:
    """All states of all pages."""
    found: list[dict[str, Any]] = []
    response = client.get(STATES, params=query)
    while True:
        assert response.status_code == 200, response.text
        page = response.json()
        assert len(page["states"]) <= query["limit"]
        found += page["states"]
        if page["next"] is None:
            assert "Link" not in response.headers
            return found
        assert response.headers["Link"] == f'<{page["next"]}>; rel="next"'
        assert len(page["states"]) == query["limit"]
        response = client.get(page["next"])


@pytest.mark.slow
@given(which=filters, sort=st.sampled_from(list(SORTS)), limit=st.integers(1, 40))
def test_pages_have_each_state_once_and_in_order(
    client: TestClient, made_up: StoredLibrary, which: dict[str, Any], sort: str, limit: int
) -> None:
    found = walk(client, {**which, "sort": sort, "limit": limit})
    documents = made_up.documents()
    assert found == [documents[ordinal] for ordinal in expected(made_up, which, SORTS[sort])]


@pytest.mark.slow
@pytest.mark.parametrize("sort", SORTS)
def test_pages_of_one_state_walk_through_all(client: TestClient, made_up: StoredLibrary, sort: str) -> None:
    # A third of the states: every absence and many ties are among them.
    found = walk(client, {"roll": 0, "sort": sort, "limit": 1, "fields": "roll,pitch,phase"})
    poses = [{"roll": one.roll_deg, "pitch": one.pitch_deg, "phase": one.phase_deg} for one in made_up.states]
    assert found == [poses[ordinal] for ordinal in expected(made_up, {"roll": 0}, SORTS[sort])]
    assert len(found) == len(made_up.states) / 3


def test_default_order_is_that_of_the_pose(client: TestClient, made_up: StoredLibrary) -> None:
    found = client.get(STATES, params={"limit": 1000}).json()["states"]
    assert found == made_up.documents()


def test_next_page_stays_with_its_library(client: TestClient, made_up: StoredLibrary) -> None:
    assert client.get(STATES, params={"limit": 1}).json()["next"].startswith(f"/v1/libraries/{made_up.id}/states?")


@given(names=st.lists(st.sampled_from(FIELDS), min_size=1, unique=True))
def test_fields_are_those_asked_for_in_the_documents_order(client: TestClient, names: list[str]) -> None:
    (state,) = client.get(STATES, params={"limit": 1, "fields": ",".join(names)}).json()["states"]
    (whole,) = client.get(STATES, params={"limit": 1}).json()["states"]
    assert list(state) == [name for name in FIELDS if name in names]
    assert state == {name: whole[name] for name in names}


def test_state_of_every_pose_is_found(client: TestClient, made_up: StoredLibrary) -> None:
    for state in made_up.states:
        response = client.get(f"{STATES}/{state.roll_deg:g}/{state.pitch_deg:g}/{state.phase_deg:g}")
        assert response.json() == state_document(state)
        assert response.headers["Content-Location"] == response.request.url.path.replace("latest", str(made_up.id))


def test_pose_off_the_grid_is_not_found(client: TestClient) -> None:
    response = client.get(f"{STATES}/0.5/0/0")
    assert response.status_code == 404
    assert "roll 0.5" in response.json()["detail"]


def cursor_of(content: object) -> str:
    return base64.urlsafe_b64encode(json.dumps(content).encode()).decode().rstrip("=")


def digest_of_default_query(client: TestClient) -> str:
    cursor = client.get(STATES, params={"limit": 1}).json()["next"].partition("cursor=")[2]
    digest: str = json.loads(base64.urlsafe_b64decode(cursor + "=="))[0]
    return digest


@pytest.mark.parametrize(
    "content",
    [
        [True, 1],
        [None, -1],
        [None, 2**70],
        [None, 1.5],
        [None, True],
        ["x" * 100, 1],
        [float("nan"), 1],
        [float("inf"), 1],
        [[], 1],
        [None],
    ],
)
def test_forged_cursor_is_refused(client: TestClient, content: list[object]) -> None:
    digest = digest_of_default_query(client)
    assert client.get(STATES, params={"cursor": cursor_of([digest, None, 1])}).status_code == 200
    assert client.get(STATES, params={"cursor": cursor_of([digest, *content])}).status_code == 400


@pytest.mark.parametrize("cursor", ["x", "!", "=", "%00", "ä", "bnVsbA", "W10", "e30", cursor_of([["a"] * 20])])
def test_what_is_no_cursor_is_refused(client: TestClient, cursor: str) -> None:
    response = client.get(STATES, params={"cursor": cursor})
    assert response.status_code == 400
    assert "next" in response.json()["detail"]


@pytest.mark.parametrize("change", [{"sort": "drop"}, {"roll": 0}, {"flag": "tie"}])
def test_cursor_is_for_its_own_query(client: TestClient, change: dict[str, str]) -> None:
    cursor = client.get(STATES, params={"limit": 1}).json()["next"].partition("cursor=")[2]
    assert client.get(STATES, params={"cursor": cursor}).status_code == 200
    assert client.get(STATES, params={"cursor": cursor, **change}).status_code == 400


@pytest.mark.parametrize(
    ("query", "named"),
    [
        ({"roll": "11"}, "roll"),
        ({"roll": "nan"}, "roll"),
        ({"pitch": "-inf"}, "pitch"),
        ({"phase": "360"}, "phase"),
        ({"phase": "1e999"}, "phase"),
        ({"phase_min": "200", "phase_max": "100"}, "phase_max"),
        ({"class": "stable"}, "stable_three_point"),
        ({"bolt_region": "surface"}, "base"),
        ({"nut_region": "base"}, "surface"),
        ({"flag": ""}, "balanced"),
        ({"fields": "roll,colour"}, "colour"),
        ({"sort": "+drop"}, "pivot_offset"),
        ({"limit": "0"}, "limit"),
        ({"limit": "1001"}, "limit"),
        ({"limit": "9" * 5000}, "limit"),
        ({"cursor": "A" * 300}, "cursor"),
    ],
)
def test_value_out_of_range_is_refused_by_name(client: TestClient, query: dict[str, str], named: str) -> None:
    response = client.get(STATES, params=query)
    assert response.status_code == 400
    assert response.headers["Content-Type"] == "application/problem+json"
    assert named in response.json()["detail"]
