"""Libraries of settled states, by HTTP."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import pytest
from fastapi.testclient import TestClient
from pydantic import TypeAdapter
from sqlalchemy import Connection

from harness.databases import Databases
from service.settled.endpoints import SettledLibraryDetail, SettledLibraryList, SettledPage
from tests.service.conftest import client_of
from tests.service.settled_library import PAIR, store_settled
from tests.service.test_problems import problem
from tests.service.test_query_plans import plan
from threadstate.device.document import SettledDocument, device_from_document, settled_document
from threadstate.device.model import Outcome, SettledFlag, SettledState
from threadstate.library.engine import reading, writing
from threadstate.library.grid import Grid
from threadstate.settled.inputs import SettledInputs
from threadstate.settled.read import SettledFilter, ordinals_statement
from threadstate.settled.write import open_settled
from threadstate.units import MILLIMETRES_PER_INCH, LengthUnit

pytestmark = pytest.mark.sqlite_alone

GRID = Grid(4.0, 4.0, 90.0)
DEVICES = (device_from_document({"unit": "mm"}), device_from_document({"unit": "in", "k_tilt": 60.0, "k_twist": 20.0}))
PATH = "/v1/settled"


@dataclass(frozen=True)
class Stored:
    """A database with a library of settled states of each device, and the states of the latest in order."""

    database: str
    states: list[SettledState]


@pytest.fixture(scope="module")
def stored(sqlite_databases: Databases) -> Stored:
    """Libraries 1 and 2 of 36 settled states each."""
    database = sqlite_databases.migrated()
    states = [store_settled(database, GRID, device) for device in DEVICES]
    with writing(database) as engine:
        open_settled(engine, SettledInputs(PAIR, Grid(1.0, 1.0, 90.0), DEVICES[0]))
    return Stored(database, states[-1])


@pytest.fixture(scope="module")
def settled_client(stored: Stored) -> Iterator[TestClient]:
    """A client of a service over that database."""
    with client_of(stored.database) as client:
        yield client


@pytest.fixture
def settled_connection(stored: Stored) -> Iterator[Connection]:
    """A connection that reads that database."""
    with reading(stored.database) as engine, engine.connect() as connection:
        yield connection


def test_published_libraries_are_listed_with_their_devices(settled_client: TestClient) -> None:
    answer = settled_client.get(PATH).json()
    assert SettledLibraryList.model_validate(answer).model_dump(mode="json") == answer
    assert [one["id"] for one in answer["settled"]] == [2, 1]
    devices = [
        device_from_document({k: v for k, v in one["device"].items() if v is not None}) for one in answer["settled"]
    ]
    assert devices == list(reversed(DEVICES))
    assert {one["designation"] for one in answer["settled"]} == {"1/4-20 UNC"}
    assert {one["state_count"] for one in answer["settled"]} == {GRID.pose_count}


def test_a_library_has_the_counts_of_its_states(settled_client: TestClient, stored: Stored) -> None:
    response = settled_client.get(f"{PATH}/latest")
    detail = response.json()
    assert response.headers["Content-Location"] == f"{PATH}/2"
    assert SettledLibraryDetail.model_validate(detail).model_dump(mode="json") == detail
    assert detail["counts"]["outcomes"] == {
        name.value: sum(state.outcome is name for state in stored.states) for name in Outcome
    }
    contacts = [len(state.contacts) for state in stored.states]
    assert detail["counts"]["contacts"] == {str(number): contacts.count(number) for number in sorted({*contacts})}
    assert settled_client.get(f"{PATH}/1").json()["id"] == 1


@pytest.mark.parametrize("unit", [None, "mm"])
def test_the_settled_state_of_a_stored_pose_is_what_is_computed(
    settled_client: TestClient, stored: Stored, unit: str | None
) -> None:
    shape = TypeAdapter(SettledDocument)
    for state in stored.states[::7]:
        path = f"{PATH}/latest/states/{state.roll_deg:g}/{state.pitch_deg:g}/{state.phase_deg:g}"
        response = settled_client.get(path, params={} if unit is None else {"unit": unit})
        factor = 1.0 if unit is None else MILLIMETRES_PER_INCH
        assert response.json() == settled_document(state, LengthUnit(unit or "in"), factor)
        assert shape.dump_python(shape.validate_python(response.json()), mode="json") == response.json()
        assert response.headers["Content-Location"] == path.replace("latest", "2")
        assert response.headers["Length-Unit"] == (unit or "in")
        again = settled_client.get(response.request.url.path, params={} if unit is None else {"unit": unit})
        assert again.headers["ETag"] == response.headers["ETag"]


def test_pages_have_each_state_once_and_in_order(settled_client: TestClient, stored: Stored) -> None:
    found: list[object] = []
    address: str | None = f"{PATH}/latest/states?limit=7&unit=in"
    while address is not None:
        response = settled_client.get(address)
        page = response.json()
        assert SettledPage.model_validate(page).model_dump(mode="json") == page
        assert (page["settled_library"], page["unit"]) == (2, "in")
        found += page["states"]
        assert (f'<{page["next"]}>; rel="next"' == response.headers.get("Link")) == (page["next"] is not None)
        address = page["next"]
    assert found == [settled_document(state, LengthUnit.INCH) for state in stored.states]


@pytest.mark.parametrize(
    "query",
    [
        {"roll": 4, "phase_min": 90, "phase_max": 180},
        {"pitch": -4, "outcome": "settled"},
        {"flag": "flush"},
        {"contacts": 2, "falls": 0},
        {"phase": 270},
        {"outcome": "slipped"},
    ],
    ids=str,
)
def test_filters_hold_at_once(settled_client: TestClient, stored: Stored, query: dict[str, Any]) -> None:
    def kept(state: SettledState) -> bool:
        found = {
            "roll": state.roll_deg,
            "pitch": state.pitch_deg,
            "phase": state.phase_deg,
            "outcome": state.outcome.value,
            "contacts": len(state.contacts),
            "falls": len(state.falls),
        }
        if not query.get("phase_min", 0) <= state.phase_deg <= query.get("phase_max", 360):
            return False
        return all(
            value in state.flags if name == "flag" else name not in found or found[name] == value
            for name, value in query.items()
        )

    answer = settled_client.get(f"{PATH}/2/states", params={**query, "limit": 1000}).json()
    assert answer["states"] == [settled_document(state, LengthUnit.INCH) for state in stored.states if kept(state)]


@pytest.mark.parametrize(
    ("address", "status", "named"),
    [
        (f"{PATH}/3", 404, "no library '3' of settled states is published; published are: 2, 1"),
        (f"{PATH}/m6", 404, "published are: 2, 1"),
        (f"{PATH}/latest/states/4/4/1", 404, "has none at roll 4, pitch 4, phase 1 deg; its grid: +-4 by 4"),
        (f"{PATH}/latest/states/11/4/0", 400, "roll"),
        (f"{PATH}/latest/states?outcome=engaged", 400, "'settled', 'slipped' or 'undecided'"),
        (f"{PATH}/latest/states?contacts=-1", 400, "contacts"),
        (f"{PATH}/latest/states?phase_min=9&phase_max=8", 400, "phase_min"),
        (f"{PATH}/latest/states?device=1", 400, "roll, pitch, phase"),
        (f"{PATH}?unit=mm", 400, "none here"),
    ],
)
def test_what_is_not_there_or_not_valid_is_named(
    settled_client: TestClient, address: str, status: int, named: str
) -> None:
    found = problem(settled_client.get(address), status)
    assert named in found.detail


def test_an_answer_is_cached_by_its_etag(settled_client: TestClient) -> None:
    for path in (PATH, f"{PATH}/1", f"{PATH}/1/states", f"{PATH}/1/states/4/4/90"):
        etag = settled_client.get(path).headers["ETag"]
        assert settled_client.get(path, headers={"If-None-Match": etag}).status_code == 304, path


def test_without_a_library_the_list_is_empty(client: TestClient) -> None:
    assert client.get(PATH).json() == {"settled": []}
    assert "none yet" in problem(client.get(f"{PATH}/latest"), 404).detail


INDEX = "SEARCH settled_state USING COVERING INDEX ix_settled_state_library_id"


@pytest.mark.parametrize("after", [-1, 17])
@pytest.mark.parametrize(
    ("which", "index"),
    [
        (SettledFilter(), "SEARCH settled_state USING PRIMARY KEY (library_id=? AND ordinal>?)"),
        (SettledFilter(pitch_deg=4.0), f"{INDEX}_pitch_deg_ordinal"),
        (SettledFilter(phase_deg=90.0), f"{INDEX}_phase_deg_ordinal"),
        (SettledFilter(outcome=Outcome.UNDECIDED), f"{INDEX}_outcome_ordinal"),
        (SettledFilter(contacts=2), f"{INDEX}_contact_count_ordinal"),
        (SettledFilter(falls=1), f"{INDEX}_fall_count_ordinal"),
        (SettledFilter(flag=SettledFlag.FLUSH), "SEARCH settled_flag USING COVERING INDEX"),
    ],
    ids=str,
)
def test_a_filter_uses_its_index(settled_connection: Connection, which: SettledFilter, after: int, index: str) -> None:
    steps = plan(settled_connection, ordinals_statement(2, which, after))
    assert any(step.startswith(index) for step in steps), steps
    assert not any("SCAN" in step or "ORDER BY" in step for step in steps), steps
