from __future__ import annotations

from collections import Counter

import pytest
from fastapi.testclient import TestClient

from harness.databases import Databases
from tests.service.conftest import StoredLibrary, client_of, store_library
from tests.service.made_up_states import made_up_states
from threadstate.library.engine import writer_engine
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.write import open_library
from threadstate.state.solve import SolveOptions
from threadstate.thread.catalogue import RootForm, quarter_twenty_unc

pytestmark = pytest.mark.sqlite_alone


@pytest.mark.parametrize("name", ["latest", "1", "1-4-20-unc", "1%2F4-20%20UNC", "1%2f4-20+UNC".replace("+", "%20")])
def test_every_name_of_a_library_finds_it(client: TestClient, made_up: StoredLibrary, name: str) -> None:
    for below in ("", "/states", "/states/1/0/30", "/histories/0/1"):
        response = client.get(f"/v1/libraries/{name}{below}")
        assert response.status_code == 200, response.text
        assert response.content == client.get(f"/v1/libraries/{made_up.id}{below}").content


@pytest.mark.parametrize("name", ["2", "9" * 18, "9" * 19, "0", "m6", "%00", "%F0%9F%94%A9", "1%252F4", "x" * 100])
def test_unknown_library_is_not_found(client: TestClient, name: str) -> None:
    response = client.get(f"/v1/libraries/{name}")
    assert response.status_code == 404
    assert response.headers["Content-Type"] == "application/problem+json"


def test_unknown_thread_is_told_the_known_ones(client: TestClient) -> None:
    assert "1-4-20-unc" in client.get("/v1/libraries/m6").json()["detail"]


def test_name_too_long_is_refused(client: TestClient) -> None:
    assert client.get(f"/v1/libraries/{'x' * 101}").status_code == 400


def test_library_says_what_it_is_and_counts_its_states(client: TestClient, made_up: StoredLibrary) -> None:
    document = client.get("/v1/libraries/latest").json()
    assert document["designation"] == made_up.pair.designation
    assert document["state_count"] == len(made_up.states)
    assert document["grid"] == {"tilt_max": 1.0, "tilt_step": 1.0, "phase_step": 30.0, "orientations": 9}
    assert document["counts"]["classes"] == Counter(state.state_class.value for state in made_up.states)
    assert document["counts"]["flags"] == Counter(flag.value for state in made_up.states for flag in state.flags)


def test_list_has_published_libraries_alone_and_the_latest_first(databases: Databases) -> None:
    database = databases.migrated()
    grid = Grid(0.0, 1.0, 180.0)
    first = store_library(database, quarter_twenty_unc(), grid, made_up_states)
    second = store_library(database, quarter_twenty_unc(RootForm.NEWER), grid, made_up_states)
    engine = writer_engine(database)
    unfinished = open_library(engine, LibraryInputs(quarter_twenty_unc(), Grid(0.0, 1.0, 90.0), SolveOptions()))
    engine.dispose()
    with client_of(database) as client:
        listed = client.get("/v1/libraries").json()["libraries"]
        assert [one["id"] for one in listed] == [second.id, first.id]
        assert client.get("/v1/libraries/latest").json()["id"] == second.id
        assert client.get("/v1/libraries/1-4-20-unc").json()["id"] == first.id
        assert client.get(f"/v1/libraries/{unfinished}").status_code == 404


def test_a_pair_without_a_chamfer_does_not_name_it(client: TestClient) -> None:
    detail = client.get("/v1/libraries/latest").json()
    (listed, *_) = client.get("/v1/libraries").json()["libraries"]
    keys = ["designation", "unit", "nominal_diameter", "thread_pitch", "form", "fit", "starts", "hand"]
    assert list(detail["pair"]) == list(listed["pair"]) == keys
