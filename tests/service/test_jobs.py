from __future__ import annotations

import json
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import pytest
from fastapi.testclient import TestClient
from jsonschema import Draft202012Validator
from sqlalchemy import Engine

from harness.databases import Databases
from service.jobs.schemas import EventDocument, JobDocument, JobPage
from tests.jobs.jobs import GRID, INPUTS, opened, work_off
from tests.service.conftest import client_of
from tests.service.test_problems import problem
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.jobs.names import EventKind
from threadstate.jobs.work import publish_job, requeue_job
from threadstate.jobs.workers import join
from threadstate.library.engine import writing
from threadstate.mesh.options import MeshOptions

pytestmark = pytest.mark.sqlite_alone

JOBS = "/v1/jobs"
LISTENERS = 24
SMALL = {"grid": {"tilt_max": 1, "tilt_step": 1, "phase_step": 180}}
"""The grid of ``tests.jobs.jobs``."""


@dataclass(frozen=True)
class Desk:
    """A service over an empty database, a key for it, and the database as a worker sees it."""

    client: TestClient
    headers: dict[str, str]
    engine: Engine

    def ask(self, body: object = SMALL) -> Any:
        return self.client.post(JOBS, json=body, headers=self.headers)

    def document(self, job_id: int) -> Any:
        return self.client.get(f"{JOBS}/{job_id}").json()

    def work_off(self, job_id: int, *, publish: bool = True) -> None:
        worker = join(self.engine, "one")
        library_id = opened(self.engine, job_id)
        work_off(self.engine, worker, job_id, library_id)
        if publish:
            assert publish_job(self.engine, worker, job_id, library_id, GRID)


@pytest.fixture
def desk(databases: Databases) -> Iterator[Desk]:
    with databases.lent() as database, writing(database) as engine, client_of(database) as client:
        key = create_key(engine, "designer", Scope.WRITE)
        yield Desk(client, {"Authorization": f"Bearer {key}"}, engine)


def _events(text: str) -> list[tuple[int, str, EventDocument]]:
    """Number, name and data of every event of a stream."""
    found = []
    for block in text.split("\n\n")[:-1]:
        number, name, data = block.splitlines()
        document = EventDocument.model_validate_json(data.removeprefix("data: "))
        found.append((int(number.removeprefix("id: ")), name.removeprefix("event: "), document))
    return found


def test_a_library_that_is_asked_for_is_one_job(desk: Desk) -> None:
    response = desk.ask()
    assert response.status_code == 202
    document = response.json()
    assert JobDocument.model_validate(document).model_dump(mode="json") == document
    assert response.headers["Location"] == f"{JOBS}/{document['id']}"
    assert document["input_sha256"] == INPUTS.sha256
    assert (document["state"], document["chunks"], document["committed"]) == ("queued", 9, 0)
    assert desk.client.get(response.headers["Location"]).json() == document
    with ThreadPoolExecutor(4) as pool:
        again = list(pool.map(lambda _: desk.ask(), range(8)))
    assert {(one.status_code, one.json()["id"]) for one in again} == {(202, document["id"])}


def test_defaults_are_those_of_a_rebuild(desk: Desk) -> None:
    document = desk.ask({}).json()
    assert document["designation"] == "1/4-20 UNC"
    assert document["method"] == "exact"
    assert document["grid"] == {"tilt_max": 4.0, "tilt_step": 1.0, "phase_step": 1.0, "orientations": 81}
    by_mesh = desk.ask({**SMALL, "method": "mesh", "mesh": {"preset": "coarse"}}).json()
    assert by_mesh["options"]["chord_height"] == 0.01
    assert by_mesh["options"]["final_step"] == MeshOptions().final_step
    other = desk.ask({**SMALL, "tolerances": {"tie_tolerance": 3e-11}}).json()
    assert other["options"]["tie_tolerance"] == 3e-11
    assert len({document["id"], by_mesh["id"], other["id"]}) == 3


def test_a_job_that_is_done_names_its_library(desk: Desk) -> None:
    job_id = desk.ask().json()["id"]
    desk.work_off(job_id)
    done = desk.ask()
    assert done.status_code == 200
    document = done.json()
    assert (document["state"], document["committed"], document["at_work"]) == ("done", 9, 0)
    library = desk.client.get(f"/v1/libraries/{document['library']}").json()
    assert library["input_sha256"] == document["input_sha256"]
    found = problem(desk.client.delete(f"{JOBS}/{job_id}", headers=desk.headers), 409)
    assert found.type == "urn:threadstate:problem:job-ended"


def test_a_cancelled_job_begins_again_when_it_is_asked_for(desk: Desk) -> None:
    job_id = desk.ask().json()["id"]
    desk.work_off(job_id, publish=False)
    for _ in range(2):
        response = desk.client.delete(f"{JOBS}/{job_id}", headers=desk.headers)
        assert (response.status_code, response.json()["state"]) == (200, "cancelled")
    assert desk.client.get("/v1/libraries").json() == {"libraries": []}
    assert desk.ask().json()["state"] == "queued"
    desk.work_off(job_id)
    assert desk.document(job_id)["state"] == "done"


def test_a_job_that_failed_says_why(desk: Desk) -> None:
    job_id = desk.ask().json()["id"]
    worker = join(desk.engine, "one")
    while desk.document(job_id)["state"] == "queued":
        opened(desk.engine, job_id)
        requeue_job(desk.engine, worker, job_id, "a computing process died")
    document = desk.document(job_id)
    assert (document["state"], document["reason"]) == ("failed", "a computing process died")
    assert document["ended_at"] is not None


def test_pages_of_jobs_hold_each_once_the_latest_first(desk: Desk) -> None:
    asked = [desk.ask({"grid": {"tilt_max": 0, "phase_step": 360 / n}}).json()["id"] for n in range(1, 6)]
    walked, path = [], f"{JOBS}?limit=2"
    while path:
        response = desk.client.get(path)
        page = response.json()
        assert JobPage.model_validate(page).model_dump(mode="json") == page
        assert response.headers.get("Link") == (page["next"] and f'<{page["next"]}>; rel="next"')
        walked += [one["id"] for one in page["jobs"]]
        path = page["next"]
    assert walked == asked[::-1]


def test_events_are_told_once_and_in_order(desk: Desk) -> None:
    job_id = desk.ask().json()["id"]
    desk.work_off(job_id)
    response = desk.client.get(f"{JOBS}/{job_id}/events")
    assert response.headers["Content-Type"].startswith("text/event-stream")
    assert response.headers["Cache-Control"] == "no-store"
    events = _events(response.text)
    assert [number for number, _, _ in events] == list(range(1, 13))
    assert [name for _, name, _ in events] == ["queued", "started", *["progress"] * 9, "published"]
    assert all(name == document.kind for _, name, document in events)
    assert [document.committed for _, _, document in events] == [0, 0, *range(1, 10), 9]


def test_a_client_that_comes_back_is_told_what_it_missed(desk: Desk) -> None:
    job_id = desk.ask().json()["id"]
    desk.work_off(job_id)
    path = f"{JOBS}/{job_id}/events"
    missed = _events(desk.client.get(path, headers={"Last-Event-ID": "10"}).text)
    assert [number for number, _, _ in missed] == [11, 12]
    for number in ("12", "13"):
        assert desk.client.get(path, headers={"Last-Event-ID": number}).status_code == 204
    for number in ("-1", "x", "9" * 30, ""):
        problem(desk.client.get(path, headers={"Last-Event-ID": number}), 400)


def test_events_are_told_as_they_happen(desk: Desk) -> None:
    """Streams are open while the job goes on, and hold no connection: there are more of them than connections."""
    job_id = desk.ask().json()["id"]

    def listen() -> list[str]:
        return [name for _, name, _ in _events(desk.client.get(f"{JOBS}/{job_id}/events").text)]

    with ThreadPoolExecutor(LISTENERS) as pool:
        heard = [pool.submit(listen) for _ in range(LISTENERS)]
        desk.work_off(job_id)
        assert {one.result(timeout=60)[-1] for one in heard} == {EventKind.PUBLISHED}


def test_head_of_events_has_an_end(desk: Desk) -> None:
    job_id = desk.ask().json()["id"]
    response = desk.client.head(f"{JOBS}/{job_id}/events")
    assert (response.status_code, response.content) == (200, b"")


@pytest.mark.parametrize("path", ["0", "-1", "x", "9" * 30, "99999999999999999999"])
def test_what_is_no_number_of_a_job_is_refused(desk: Desk, path: str) -> None:
    problem(desk.client.get(f"{JOBS}/{path}"), 400)
    problem(desk.client.delete(f"{JOBS}/{path}", headers=desk.headers), 400)


def test_a_job_that_is_not_there_is_not_found(desk: Desk) -> None:
    for path in (f"{JOBS}/1", f"{JOBS}/2147483647", f"{JOBS}/1/events"):
        problem(desk.client.get(path), 404)
    problem(desk.client.delete(f"{JOBS}/1", headers=desk.headers), 404)


@pytest.mark.parametrize(
    ("body", "named"),
    [
        ({"designation": "M7"}, "designation"),
        ({"designation": "M6 with chamfer"}, "chamfer"),
        ({"designation": "M6 with chamfer", "method": "mesh"}, "chamfer"),
        ({"grid": {"tilt_max": 11}}, "tilt_max"),
        ({"grid": {"tilt_max": "4"}}, "tilt_max"),
        ({"grid": {"phase_step": 7}}, "phase_step"),
        ({"grid": {"phase_step": 0.01, "tilt_step": 0.01}}, "pose count"),
        ({"grid": {"yaw": 1}}, "yaw"),
        ({"tolerances": {"tie_tolerance": 1.0}}, "tie_tolerance"),
        ({"method": "guess"}, "method"),
        ({"mesh": {"preset": "coarse"}}, "mesh"),
        ({"method": "mesh", "mesh": {"checked": 1}}, "checked"),
        ([], "body"),
    ],
)
def test_what_cannot_be_computed_is_refused_by_name(desk: Desk, body: object, named: str) -> None:
    found = problem(desk.ask(body), 400)
    assert any(named in error.location for error in found.errors), found
    assert desk.client.get(JOBS).json()["jobs"] == []


def test_examples_and_answers_have_the_documented_shape(desk: Desk) -> None:
    openapi = desk.client.get("/openapi.json").json()
    schema = {"$ref": "#/components/schemas/JobDocument", "components": openapi["components"]}
    (example,) = openapi["components"]["schemas"]["JobRequest"]["examples"]
    response = desk.ask(example)
    assert response.status_code == 202
    Draft202012Validator(schema).validate(json.loads(response.text))
    assert openapi["paths"][JOBS]["post"]["security"] == [{"key": []}]
    assert "security" not in openapi["paths"][JOBS]["get"]
