"""Success maps, by HTTP: requested as jobs, read while they grow and once they are published."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import pytest
from fastapi.testclient import TestClient
from pydantic import TypeAdapter
from sqlalchemy import Engine

from harness.databases import Databases
from service.jobs.schemas import JobDocument
from service.success.schemas import GrowingMap, SuccessMapDetail, SuccessMapList, SuccessOrientationPage
from tests.jobs.jobs import GRID, SUCCESS_INPUTS, made_up_orientation
from tests.service.conftest import client_of, store_library
from tests.service.made_up_states import made_up_states
from tests.service.success_map import store_success_map
from tests.service.test_problems import problem
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.device.document import device_from_document
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.jobs.names import JobKind
from threadstate.jobs.stores import STORES
from threadstate.jobs.work import complete_chunk, lease_chunks, open_job, publish_job
from threadstate.jobs.workers import join
from threadstate.library.engine import writing
from threadstate.library.grid import Grid
from threadstate.success.document import map_sha256
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import OrientationMap
from threadstate.success.summary_document import SummarisedOrientationDocument, summarised_document
from threadstate.success.write import write_orientation
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc
from threadstate.units import MILLIMETRES_PER_INCH

pytestmark = pytest.mark.sqlite_alone

MAPS, JOBS, SETTLED = "/v1/success-maps", "/v1/jobs", "/v1/settled"
DEVICE = device_from_document({"unit": "in", "k_tilt": 60.0, "k_twist": 20.0})
SMALL: dict[str, Any] = {"grid": {"tilt_max": 1, "tilt_step": 1, "phase_step": 180}, "mu": [0, 0.2]}
"""What asks for the map of ``tests.jobs.jobs``."""


@dataclass(frozen=True)
class Desk:
    """A service over a database with maps 1 and 2, a key for it, and the database as a worker sees it."""

    client: TestClient
    headers: dict[str, str]
    engine: Engine
    orientations: list[OrientationMap]

    def ask(self, body: object = SMALL, path: str = MAPS) -> Any:
        return self.client.post(path, json=body, headers=self.headers)

    def get(self, path: str) -> Any:
        response = self.client.get(path)
        assert response.status_code == 200, response.text
        return response.json()


@pytest.fixture(scope="module")
def desk(sqlite_databases: Databases) -> Iterator[Desk]:
    database = sqlite_databases.migrated()
    store_success_map(database, replace(SUCCESS_INPUTS, device=DEVICE, strategy=Strategy.CW, frictions=(0.0,)))
    orientations = store_success_map(database, replace(SUCCESS_INPUTS, phase_tolerance_deg=30.0))
    with writing(database) as engine, client_of(database) as client:
        key = create_key(engine, "designer", Scope.WRITE)
        yield Desk(client, {"Authorization": f"Bearer {key}"}, engine, orientations)


def test_published_maps_are_listed_with_what_they_were_computed_from(desk: Desk) -> None:
    answer = desk.get(MAPS)
    assert SuccessMapList.model_validate(answer).model_dump(mode="json") == answer
    latest, first = answer["success_maps"][-2:]
    assert (first["id"], first["strategy"], first["mu"]) == (1, "cw", [0.0])
    assert device_from_document({k: v for k, v in first["device"].items() if v is not None}) == DEVICE
    assert (latest["phase_tolerance"], latest["mu_tolerance"], latest["point_limit"]) == (30.0, 0.01, 1000)
    assert latest["content_sha256"] == map_sha256(desk.orientations)
    assert latest["grid"] == {"tilt_max": 1.0, "tilt_step": 1.0, "phase_step": 180.0, "orientations": 9}


def test_maps_of_the_pair_of_a_library_alone_are_listed(sqlite_databases: Databases) -> None:
    database = sqlite_databases.migrated()
    of_default = store_library(database, quarter_twenty_unc(), GRID, made_up_states).id
    of_other = store_library(database, pair_by_designation("M6-6g/6H"), GRID, made_up_states).id
    store_success_map(database)
    with client_of(database) as client:
        assert [one["id"] for one in client.get(f"{MAPS}?library={of_default}").json()["success_maps"]] == [1]
        assert client.get(f"{MAPS}?library={of_other}").json() == {"success_maps": []}
        assert "library 9 is not published" in (problem(client.get(f"{MAPS}?library=9"), 404).detail or "")


def test_a_map_has_its_totals(desk: Desk) -> None:
    detail = desk.get(f"{MAPS}/2")
    assert SuccessMapDetail.model_validate(detail).model_dump(mode="json") == detail
    without, with_friction = detail["summary"]
    assert (without["mu"], without["engaged"], without["around_level"], without["area"]) == (0.0, 9, 9, 9.0)
    assert without["outcomes"] == {"engaged": 18}
    assert (with_friction["engaged"], with_friction["outcomes"]) == (0, {"no_snap": 18})


def test_orientations_come_in_pages_and_alone(desk: Desk) -> None:
    expected = [summarised_document(one, GRID, (0.0, 0.2)) for one in desk.orientations]
    path, found = f"{MAPS}/2/orientations?limit=4", []
    while path:
        page = desk.get(path)
        assert SuccessOrientationPage.model_validate(page).model_dump(mode="json") == page
        assert page["success_map"] == 2
        found += page["orientations"]
        path = page["next"]
    assert found == expected
    one = desk.get(f"{MAPS}/2/orientations/-1/1")
    assert one == next(each for each in expected if (each["roll"], each["pitch"]) == (-1.0, 1.0))
    assert (
        TypeAdapter(SummarisedOrientationDocument).dump_python(
            TypeAdapter(SummarisedOrientationDocument).validate_python(one), mode="json"
        )
        == one
    )
    assert (one["critical"]["outcome"], one["critical"]["phase"]) == ("no_snap", 0.0)


def test_lengths_come_in_the_unit_that_is_asked_for(desk: Desk) -> None:
    inches, millimetres = (desk.get(f"{MAPS}/2/orientations/0/0?unit={unit}") for unit in ("in", "mm"))
    for before, after in zip(inches["cells"], millimetres["cells"], strict=True):
        assert after["torque"] == pytest.approx(before["torque"] * MILLIMETRES_PER_INCH, rel=1e-15)
        assert after["shift"] == pytest.approx(before["shift"] * MILLIMETRES_PER_INCH, rel=1e-15)
        assert (after["tilt"], after["end"]) == (before["tilt"], before["end"])
    assert millimetres["summary"][0]["torque"] == max(
        cell["torque"] for cell in millimetres["cells"] if cell["outcome"] == "engaged"
    )


def test_a_map_that_is_asked_for_is_one_job_and_grows(desk: Desk) -> None:
    response = desk.ask()
    assert response.status_code == 202, response.text
    document = response.json()
    assert JobDocument.model_validate(document).model_dump(mode="json") == document
    assert desk.ask().json()["id"] == document["id"]
    assert response.headers["Location"] == f"{JOBS}/{document['id']}"
    assert document["kind"] == "success"
    assert {document[name] for name in ("method", "library", "result")} == {None}
    assert document["input_sha256"] == SUCCESS_INPUTS.sha256
    assert document["options"]["mu"] == [0.0, 0.2]
    growing = f"{JOBS}/{document['id']}/success-map"
    assert desk.get(growing)["orientations"] == []
    worker, store = join(desk.engine, "one"), STORES[JobKind.SUCCESS]
    store_id = store.open(desk.engine, SUCCESS_INPUTS)
    open_job(desk.engine, document["id"], store_id)
    for count in range(GRID.orientation_count):
        (index,) = lease_chunks(desk.engine, worker, document["id"], 1)
        write_orientation(desk.engine, store_id, made_up_orientation(SUCCESS_INPUTS, index))
        complete_chunk(desk.engine, worker, document["id"], index)
        answer = desk.get(growing)
        assert (len(answer["orientations"]), answer["chunks"]) == (count + 1, 9)
        assert answer["summary"][0]["orientations"] == count + 1
    assert GrowingMap.model_validate(answer).model_dump(mode="json") == answer
    assert publish_job(desk.engine, worker, document["id"], store_id, GRID)
    done = desk.get(f"{JOBS}/{document['id']}")
    assert (done["state"], done["result"]) == ("done", f"{MAPS}/{store_id}")
    assert desk.get(done["result"])["input_sha256"] == SUCCESS_INPUTS.sha256
    assert desk.ask().status_code == 200


def test_what_is_left_out_is_as_of_the_command(desk: Desk) -> None:
    document = desk.ask({}).json()
    expected = SuccessInputs(
        quarter_twenty_unc(), default_device(), Strategy.CCW_THEN_CW, Grid(4.0, 1.0, 30.0), (0.1, 0.2, 0.3)
    )
    assert document["input_sha256"] == expected.sha256
    desk.client.delete(f"{JOBS}/{document['id']}", headers=desk.headers)


def test_a_library_of_settled_states_is_asked_for(desk: Desk) -> None:
    response = desk.ask({"device": {"unit": "mm"}, "grid": {"phase_step": 120}}, SETTLED)
    document = response.json()
    assert (response.status_code, document["kind"], document["chunks"]) == (202, "settled", 81)
    assert document["options"] == {}
    assert document["device"]["push"] == 10.0
    assert problem(desk.client.get(f"{JOBS}/{document['id']}/success-map"), 404).detail.endswith(
        "computes a library of settled states, not a success map"
    )
    desk.client.delete(f"{JOBS}/{document['id']}", headers=desk.headers)


@pytest.mark.parametrize(
    ("body", "named"),
    [
        ({"mu": []}, "mu"),
        ({"mu": [0.2, 0.1]}, "ascend"),
        ({"mu": [1.5]}, "0 to 1"),
        ({"device": {"unit": "mm", "push": -1}}, "body device push"),
        ({"grid": {"phase_step": 7}}, "phase_step"),
        ({"point_limit": 5}, "10 to 2500"),
        ({"designation": "M6", "library": 1}, "not both"),
        ({"strategy": "sideways"}, "strategy"),
        ({"colour": "red"}, "colour"),
    ],
)
def test_what_is_not_valid_is_named(desk: Desk, body: dict[str, Any], named: str) -> None:
    response = desk.ask(body)
    assert 400 <= response.status_code < 423, response.text
    assert named in response.text


def test_asking_needs_a_key_for_writing(desk: Desk) -> None:
    for path in (MAPS, SETTLED):
        assert desk.client.post(path, json={}).status_code == 401


def test_what_does_not_exist_is_named(desk: Desk) -> None:
    assert "published are: " in problem(desk.client.get(f"{MAPS}/99"), 404).detail
    assert "its grid" in problem(desk.client.get(f"{MAPS}/2/orientations/3/0"), 404).detail
    assert desk.client.get(f"{JOBS}/99/success-map").status_code == 404
