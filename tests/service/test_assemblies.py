"""Paths of held bolts that are turned, by HTTP."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx2
import numpy as np
import pytest
from fastapi.testclient import TestClient
from prometheus_client.parser import text_string_to_metric_families

from service.assemblies.endpoints import ANSWER, PROBLEM, PROGRESS
from tests.service.conftest import StoredLibrary
from tests.service.test_problems import problem
from tests.service_thread import service_thread
from threadstate.device.assemble import assemble_pose
from threadstate.device.watch import PathStoppedError
from threadstate.settings import CONCURRENCY, TIME_LIMIT_S
from worker.cli import run_command_line

pytestmark = pytest.mark.sqlite_alone

POST = "/v1/assemblies"
EVENTS = {"Accept": "text/event-stream"}
ENGAGING = {"pose": {"roll": 1, "pitch": -2, "phase": 10}, "strategy": "cw"}
LONG = {"pose": {"roll": 4, "pitch": -4, "phase": 0}, "mu": 0.2, "longest_step": 0.25}
"""A path of many seconds on any machine."""
DEVICE = {"unit": "mm", "k_tilt": 250, "centre": -2, "push": 4}
LONGEST_S = 60.0


def events_of(lines: Iterator[str]) -> Iterator[tuple[str, Any]]:
    """The events of a stream, each when it is there: its kind, and its data."""
    kind = ""
    for line in lines:
        name, _, value = line.partition(": ")
        if name == "event":
            kind = value
        elif name == "data":
            yield kind, json.loads(value)


@pytest.fixture
def ends(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """How each path that is computed from now on ends."""
    found: list[str] = []

    def noted(*args: Any, **kwargs: Any) -> Any:
        try:
            path = assemble_pose(*args, **kwargs)
        except PathStoppedError:
            found.append("stopped")
            raise
        found.append("done")
        return path

    monkeypatch.setattr("service.assemblies.endpoints.assemble_pose", noted)
    return found


def wait_until(holds: Callable[[], bool]) -> None:
    """Wait until something holds."""
    until = time.monotonic() + LONGEST_S
    while not holds():
        assert time.monotonic() < until
        time.sleep(0.01)


def computing(address: str) -> float:
    """How many requests hold a place to compute, as the metrics have it."""
    families = text_string_to_metric_families(httpx2.get(f"{address}/metrics").text)
    return next(family.samples[0].value for family in families if family.name == "threadstate_computing")


@pytest.mark.parametrize(("unit", "device"), [("in", None), ("mm", DEVICE)])
def test_a_path_is_answered_as_on_the_command_line(
    client: TestClient, capsys: pytest.CaptureFixture[str], tmp_path: Path, device: dict[str, object] | None, unit: str
) -> None:
    body = ENGAGING if device is None else {**ENGAGING, "device": device}
    response = client.post(POST, params={"unit": unit}, json=body)
    assert response.status_code == 200, response.text
    held = tmp_path / "device.json"
    held.write_text(json.dumps(device or {"unit": "mm"}))
    capsys.readouterr()
    pose = ("--roll=1", "--pitch=-2", "--phase=10", "--strategy=cw")
    assert run_command_line(["assemble", *pose, f"--device={held}", f"--unit={unit}", "--json"]) == 0
    assert response.json() == json.loads(capsys.readouterr().out)
    assert (response.headers["Length-Unit"], response.headers["Cache-Control"]) == (unit, "no-store")


def test_the_longest_step_is_taken(client: TestClient) -> None:
    steps = [
        np.abs(np.diff(client.post(POST, json={**ENGAGING, **step}).json()["path"]["phase"])).max()
        for step in ({}, {"longest_step": 0.5})
    ]
    assert 0.5 < steps[0] <= 2.0 + 1e-9
    assert steps[1] == pytest.approx(0.5, abs=1e-9)


def test_a_confirmed_path_says_whether_half_the_step_changes_it(client: TestClient) -> None:
    """With half of 0.5 deg a contact of this path is replaced by another one for a moment."""
    body = {
        "pose": {"roll": -2.2228707478823733, "pitch": -0.16150614490357995, "phase": 129.314909475504},
        "mu": 0.2,
        "strategy": "cw",
        "longest_step": 0.5,
    }
    answer = client.post(POST, json={**body, "confirm": True}).json()
    with client.stream("POST", POST, json={**body, "confirm": True}, headers=EVENTS) as response:
        assert list(events_of(response.iter_lines()))[-1] == ("answer", answer)
    alone = client.post(POST, json=body).json()
    assert answer.pop("flags") == [*alone.pop("flags"), "step_dependent"]
    assert answer == alone


def test_friction_is_taken(client: TestClient) -> None:
    body = {"pose": {"roll": 0, "pitch": 0, "phase": 10}, "strategy": "cw", "mu": 0.1}
    answer = client.post(POST, json=body).json()
    assert (answer["mu"], answer["outcome"], answer["flags"]) == (0.1, "engaged", [])
    assert answer["energy"]["friction"] > 0.0


@pytest.mark.slow
@pytest.mark.parametrize("longer", [{"longest_step": 0.25}, {"mu": 0.2}])
def test_a_stream_has_the_progress_before_the_answer(made_up: StoredLibrary, longer: dict[str, float]) -> None:
    body = {"pose": {"roll": 0, "pitch": -4, "phase": 300}, "device": DEVICE, **longer}
    with service_thread(made_up.database) as address, httpx2.Client(base_url=address, timeout=LONGEST_S) as client:
        with client.stream("POST", POST, json=body, headers=EVENTS, params={"unit": "mm"}) as response:
            assert response.headers["Content-Type"].startswith("text/event-stream")
            assert (response.headers["Cache-Control"], response.headers["Length-Unit"]) == ("no-store", "mm")
            found = events_of(response.iter_lines())
            kind, first = next(found)
            assert kind == PROGRESS
            # The path goes on: its place is held.
            assert computing(address) == 1.0
            events = [(kind, first), *found]
        plain = client.post(POST, json=body, params={"unit": "mm"}).json()
    seen = [data for kind, data in events if kind == PROGRESS]
    assert [kind for kind, _ in events] == [PROGRESS] * len(seen) + [ANSWER]
    assert events[-1][1] == plain
    assert [event for data in seen for event in data["events"]] == plain["events"]
    legs = [data["leg"] for data in seen]
    assert legs == sorted(legs)
    assert legs[-1] == 2
    reached = [data["phase"] for data in seen if data["phase"] is not None]
    assert set(reached) <= set(plain["path"]["phase"])


def leave_a_stream(address: str) -> None:
    """Ask for the long path, and leave after the first event."""
    with httpx2.stream("POST", f"{address}{POST}", json=LONG, headers=EVENTS, timeout=LONGEST_S) as response:
        kind, _ = next(events_of(response.iter_lines()))
        assert kind == PROGRESS


def leave_without_a_stream(address: str) -> None:
    """Ask for the long path, and leave when it is computed."""
    with pytest.raises(httpx2.ReadTimeout):
        httpx2.post(f"{address}{POST}", json=LONG, timeout=httpx2.Timeout(LONGEST_S, read=2.0))


@pytest.mark.slow
@pytest.mark.parametrize("leave", [leave_a_stream, leave_without_a_stream])
def test_a_path_whose_client_is_gone_is_stopped_and_gives_its_place_back(
    made_up: StoredLibrary, ends: list[str], leave: Callable[[str], None]
) -> None:
    settings = {CONCURRENCY: "1", TIME_LIMIT_S: "600"}
    with service_thread(made_up.database, settings=settings) as address:
        leave(address)
        wait_until(lambda: computing(address) == 0.0)
        assert ends == ["stopped"]
        # The only place is free.
        assert httpx2.post(f"{address}{POST}", json=ENGAGING, timeout=LONGEST_S).json()["outcome"] == "engaged"


@pytest.mark.slow
def test_a_path_that_is_out_of_time_is_stopped(made_up: StoredLibrary, ends: list[str]) -> None:
    settings = {CONCURRENCY: "1", TIME_LIMIT_S: "1"}
    with (
        service_thread(made_up.database, settings=settings) as address,
        httpx2.Client(base_url=address, timeout=LONGEST_S) as client,
    ):
        refused = problem(client.post(POST, json=LONG), 503)
        assert refused.type.endswith(":out-of-time")
        wait_until(lambda: computing(address) == 0.0)
        with client.stream("POST", POST, json=LONG, headers=EVENTS) as response:
            *_, (kind, document) = events_of(response.iter_lines())
        wait_until(lambda: computing(address) == 0.0)
    assert kind == PROBLEM
    assert (document["type"], document["status"]) == (refused.type, 503)
    assert ends == ["stopped"] * 2


@pytest.mark.parametrize(
    ("others", "named"),
    [
        ({"pose": {"roll": 11, "pitch": 0, "phase": 0}}, "body pose roll"),
        ({"pose": {"roll": 1, "pitch": 0}}, "body pose phase"),
        ({"pose": {"roll": 1, "pitch": "0", "phase": 0}}, "body pose pitch"),
        ({"pose": {"roll": 1, "pitch": 0, "phase": 0, "yaw": 0}}, "body pose yaw"),
        ({"pose": [1, 2, 3]}, "body pose"),
        ({"poses": []}, "body poses"),
        ({"strategy": "sideways"}, "body strategy"),
        ({"mu": -0.1}, "body mu"),
        ({"mu": 1.1}, "body mu"),
        ({"mu": "0.1"}, "body mu"),
        ({"mu": None}, "body mu"),
        ({"longest_step": 0.2}, "body longest_step"),
        ({"longest_step": 2.5}, "body longest_step"),
        ({"longest_step": "1"}, "body longest_step"),
        ({"longest_step": 0.25, "confirm": True}, "longest_step"),
        ({"confirm": 1}, "body confirm"),
        ({"unit": "mm"}, "body unit"),
        ({"device": {"unit": "mm", "push": 0}}, "body device push"),
        ({"device": {}}, "body device unit"),
        ({"library": 1, "designation": "1/4-20 UNC"}, "library"),
        ({"library": True}, "body library constrained-int"),
        ({"designation": "M7"}, "designation"),
        ({"designation": "M6 with sharp corners"}, "bolt_root_fillet"),
        ({"designation": "M6 with chamfer"}, "chamfer"),
    ],
)
@pytest.mark.parametrize("headers", [EVENTS, {}], ids=["stream", "plain"])
def test_a_bad_body_is_refused_by_name(
    client: TestClient, others: dict[str, object], named: str, headers: dict[str, str]
) -> None:
    (error, *_) = problem(client.post(POST, json={**ENGAGING, **others}, headers=headers), 400).errors
    assert error.location == named


def test_what_else_is_not_valid_is_a_problem(client: TestClient) -> None:
    refused = problem(client.post(POST, json=ENGAGING, params={"mu": "0.1"}), 400)
    assert refused.type.endswith(":unknown-parameter")
    assert problem(client.post(POST, json=ENGAGING, params={"unit": "cm"}), 400).errors[0].location == "query unit"
    problem(client.post(POST, json={"strategy": "cw"}), 400)
    problem(client.post(POST, content=json.dumps(LONG).replace("0.2,", "NaN,")), 400)
    problem(client.post(POST, content=b" " * 600_000 + b"{}"), 413)
    problem(client.post(POST, json={**ENGAGING, "library": 99}), 404)
