"""Where held bolts come to rest, by HTTP."""

from __future__ import annotations

import json
import time
from pathlib import Path
from threading import Event
from typing import Any

import pytest
from fastapi.testclient import TestClient

from service.libraries.requested import SolvedPair
from service.settle.endpoints import BATCH, SettleAnswer
from tests.service.conftest import StoredLibrary
from tests.service.own_library import OWN_OPTIONS, OWN_PAIR
from tests.service.test_problems import problem
from tests.service_app import service_app
from threadstate.device.document import device_from_document, settled_document
from threadstate.device.model import LARGEST_NUMBER, Device, SettledState
from threadstate.device.settle import settle_poses
from threadstate.settings import DATABASE, TIME_LIMIT_S, read_settings
from threadstate.thread.pair import Pair
from threadstate.thread.standards.sizes import UNIFIED_SOURCE
from threadstate.units import LengthUnit
from worker.cli import run_command_line

pytestmark = pytest.mark.sqlite_alone

POST = "/v1/settle"
LONGEST_S = 60.0
POSE = (0.0, 3.0, 250.0)
DEVICE = {"unit": "mm", "k_tilt": 250, "k_twist": 900.5, "centre": -2, "push": 4, "about": "bolt"}


def body(*poses: tuple[float, float, float], **others: object) -> dict[str, Any]:
    """The body that asks for these poses."""
    return {"poses": [dict(zip(("roll", "pitch", "phase"), pose, strict=True)) for pose in poses], **others}


@pytest.mark.parametrize("unit", ["in", "mm"])
@pytest.mark.parametrize("device", [None, DEVICE], ids=["default", "device"])
def test_poses_are_answered_as_on_the_command_line(
    client: TestClient, capsys: pytest.CaptureFixture[str], tmp_path: Path, device: dict[str, object] | None, unit: str
) -> None:
    poses = [POSE, (1.0, 0.5, 120.0), (0.0, 0.0, 0.5)]
    others = {} if device is None else {"device": device}
    response = client.post(POST, params={"unit": unit}, json=body(*poses, **others))
    assert response.status_code == 200, response.text
    answer = response.json()
    file, held = tmp_path / "poses.csv", tmp_path / "device.json"
    file.write_text("roll,pitch,phase\n" + "".join(",".join(map(str, pose)) + "\n" for pose in poses))
    held.write_text(json.dumps(device or {"unit": "mm"}))
    capsys.readouterr()
    assert run_command_line(["settle", f"--poses={file}", f"--device={held}", f"--unit={unit}", "--json"]) == 0
    assert answer["states"] == [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [state["outcome"] for state in answer["states"]] == ["settled"] * 3
    of_pair = {"designation": "1/4-20 UNC", "source": UNIFIED_SOURCE, "library": None, "unit": unit}
    assert {name: answer[name] for name in of_pair} == of_pair
    assert (response.headers["Length-Unit"], response.headers["Cache-Control"]) == (unit, "no-store")
    assert SettleAnswer.model_validate(answer).model_dump(mode="json") == answer


def test_a_librarys_pair_is_taken(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = SolvedPair(OWN_PAIR, OWN_OPTIONS, 7)
    monkeypatch.setattr("service.settle.endpoints.solved_pair", lambda _request, *_: asked)
    pose = (2.5, -1.25, 77.7)
    answer = client.post(POST, json=body(pose, library=7, device={"unit": "in", "push": 3})).json()
    (state,) = settle_poses(OWN_PAIR, [pose], device_from_document({"unit": "in", "push": 3}))
    assert answer["states"] == [settled_document(state, LengthUnit.MILLIMETRE)]
    assert (answer["designation"], answer["source"], answer["library"], answer["unit"]) == ("M6x1", None, 7, "mm")


def test_more_poses_than_a_batch_come_in_their_order(client: TestClient) -> None:
    poses = [(0.1 * i, 3.0, 250.0 - i) for i in range(BATCH + 3)]
    answer = client.post(POST, json=body(*poses)).json()["states"]
    assert [(one["roll"], one["pitch"], one["phase"]) for one in answer] == poses
    assert client.post(POST, json=body(poses[-1])).json()["states"] == answer[-1:]


@pytest.mark.slow
def test_a_request_that_is_out_of_time_settles_no_further_poses(
    made_up: StoredLibrary, monkeypatch: pytest.MonkeyPatch
) -> None:
    answered = Event()
    batches: list[int] = []

    def waiting(pair: Pair, poses: list[tuple[float, float, float]], device: Device | None) -> list[SettledState]:
        batches.append(len(poses))
        answered.wait(LONGEST_S)
        return settle_poses(pair, poses, device)

    monkeypatch.setattr("service.settle.endpoints.settle_poses", waiting)
    with TestClient(service_app(read_settings({DATABASE: made_up.database, TIME_LIMIT_S: "1"}))) as client:
        refused = problem(client.post(POST, json=body(*[POSE] * (20 * BATCH))), 503)
        assert refused.type.endswith(":out-of-time")
        answered.set()
        (limits,) = (one for one in client.app.user_middleware if one.cls.__name__ == "LimitsMiddleware")  # type: ignore[attr-defined]
        until = time.monotonic() + LONGEST_S
        while limits.kwargs["admission"].computing:
            assert time.monotonic() < until
            time.sleep(0.01)
    assert len(batches) <= 1


@pytest.mark.parametrize(
    ("device", "named", "valid"),
    [
        ({}, "body device unit", "Field required"),
        ({"unit": "cm"}, "body device unit", "'in' or 'mm'"),
        ({"unit": "mm", "spring": 1}, "body device spring", "not permitted"),
        ({"unit": "mm", "push": 0}, "body device push", "a force > 0"),
        ({"unit": "mm", "push": "10"}, "body device push", "valid number"),
        ({"unit": "mm", "k_tilt": -1}, "body device k_tilt", "a stiffness >= 0"),
        ({"unit": "mm", "k_lateral": 1.1 * LARGEST_NUMBER}, "body device k_lateral", "up to 1000000000000"),
        ({"unit": "mm", "centre": True}, "body device centre", "valid number"),
        ({"unit": "mm", "about": "screw"}, "body device about", "'nut' or 'bolt'"),
        ({"unit": "mm", "stiffness": [[1]]}, "body device stiffness", "6 rows of 6 numbers"),
        ({"unit": "mm", "stiffness": [[1] * 6] * 6, "k_tilt": 1}, "body device k_tilt", "left out beside stiffness"),
        ([], "body device", "dictionary"),
    ],
)
def test_a_bad_device_is_named_with_its_range(client: TestClient, device: object, named: str, valid: str) -> None:
    (error, *_) = problem(client.post(POST, json=body(POSE, device=device)), 400).errors
    assert error.location == named
    assert valid in error.valid


@pytest.mark.parametrize(
    ("others", "named"),
    [
        ({"poses": []}, "body poses"),
        ({"poses": [{"roll": 11, "pitch": 0, "phase": 0}]}, "body poses 0 roll"),
        ({"poses": [{"roll": 1, "pitch": 0}]}, "body poses 0 phase"),
        ({"poses": [{"roll": 1, "pitch": 0, "phase": 0}] * 1001}, "body poses"),
        ({"mu": 0.1}, "body mu"),
        ({"unit": "mm"}, "body unit"),
        ({"library": 1, "designation": "1/4-20 UNC"}, "library"),
        ({"designation": "M7"}, "designation"),
        ({"designation": "M6 with sharp corners"}, "bolt_root_fillet"),
        ({"designation": "M6 with chamfer"}, "chamfer"),
    ],
)
def test_a_bad_body_is_refused_by_name(client: TestClient, others: dict[str, object], named: str) -> None:
    (error, *_) = problem(client.post(POST, json={**body(POSE), **others}), 400).errors
    assert error.location == named


@pytest.mark.parametrize("number", ["NaN", "Infinity", "1e400"])
def test_what_is_no_finite_number_is_refused(client: TestClient, number: str) -> None:
    content = json.dumps(body(POSE, device={"unit": "mm", "push": 1})).replace('"push": 1', f'"push": {number}')
    assert number in content
    problem(client.post(POST, content=content, headers={"Content-Type": "application/json"}), 400)
