"""How paths end, by HTTP."""

from __future__ import annotations

from typing import Any

import pytest
from fastapi.testclient import TestClient

from service.assemblies.outcomes import LARGEST_POSE_COUNT, OutcomesAnswer
from tests.service.test_problems import problem
from threadstate.device.document import device_from_document
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.success.bounded import bounded_cell
from threadstate.success.document import cell_document
from threadstate.success.orientation_paths import OrientationPaths
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.units import MILLIMETRES_PER_INCH

pytestmark = pytest.mark.sqlite_alone

PATH = "/v1/outcomes"
POSES = ((1.0, -2.0, 10.0), (3.0, 3.0, 90.0))
DEVICE = {"unit": "mm", "k_tilt": 250.0}


def body(**others: object) -> dict[str, Any]:
    """The body that asks for the poses."""
    poses = [dict(zip(("roll", "pitch", "phase"), pose, strict=True)) for pose in POSES]
    return {"poses": poses, "strategy": "cw", "device": DEVICE, **others}


def test_outcomes_are_the_cells_of_a_map(client: TestClient) -> None:
    response = client.post(PATH, json=body())
    assert response.status_code == 200, response.text
    answer = response.json()
    assert OutcomesAnswer.model_validate(answer).model_dump(mode="json") == answer
    assert response.headers["Cache-Control"] == "no-store"
    device = device_from_document(DEVICE)
    for pose, found in zip(POSES, answer["outcomes"], strict=True):
        cell = bounded_cell(quarter_twenty_unc(), device, Strategy.CW, pose, 0.0, 1000)
        assert found == {"roll": pose[0], "pitch": pose[1], **cell_document(cell)}


def test_paths_of_one_orientation_go_on_as_those_before_them(client: TestClient) -> None:
    poses = [(3.0, -3.0, 90.0), (3.0, -2.0, 120.0), (3.0, -3.0, 120.0)]
    asked = [dict(zip(("roll", "pitch", "phase"), pose, strict=True)) for pose in poses]
    answer = client.post(PATH, json={"poses": asked, "strategy": "cw", "mu": 0.2}).json()
    of = (quarter_twenty_unc(), default_device(), Strategy.CW)
    paths = {
        tilt: OrientationPaths(*of, *tilt, 1000, has_several)
        for tilt, has_several in (((3.0, -3.0), True), ((3.0, -2.0), False))
    }
    for pose, found in zip(poses, answer["outcomes"], strict=True):
        cell = paths[pose[:2]].cell(pose[2], 0.2)
        assert found == {"roll": pose[0], "pitch": pose[1], **cell_document(cell)}
    alone = client.post(PATH, json={"poses": asked[2:], "strategy": "cw", "mu": 0.2}).json()["outcomes"][0]
    assert alone["outcome"] == answer["outcomes"][2]["outcome"] == "idle"
    # To the last digit they are not the same: it took over the other's points.
    assert alone["shift"] != answer["outcomes"][2]["shift"]


def test_lengths_and_torques_come_in_the_unit_that_is_asked_for(client: TestClient) -> None:
    inches, millimetres = (client.post(f"{PATH}?unit={unit}", json=body()).json() for unit in ("in", "mm"))
    assert millimetres["unit"] == "mm"
    for before, after in zip(inches["outcomes"], millimetres["outcomes"], strict=True):
        assert after["torque"] == pytest.approx(before["torque"] * MILLIMETRES_PER_INCH, rel=1e-15)
        assert after["shift"] == pytest.approx(before["shift"] * MILLIMETRES_PER_INCH, rel=1e-15)
        assert after["tilt"] == before["tilt"]


def test_a_path_beyond_the_limit_is_undecided_and_says_so(client: TestClient) -> None:
    (found, _) = client.post(PATH, json=body(point_limit=10)).json()["outcomes"]
    assert (found["outcome"], found["bounded"], found["torque"]) == ("undecided", True, None)


def test_paths_that_take_longer_than_their_time_are_undecided(client: TestClient) -> None:
    """The first path takes a thousand times the time, the second one has none left."""
    outcomes = client.post(PATH, json=body(time_limit=1e-4)).json()["outcomes"]
    assert [(one["outcome"], one["bounded"], one["torque"]) for one in outcomes] == [("undecided", True, None)] * 2
    assert client.post(PATH, json=body(time_limit=600.0)).json() == client.post(PATH, json=body()).json()


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"poses": []}, "poses"),
        ({"poses": [{"roll": 0, "pitch": 0, "phase": 0}] * (LARGEST_POSE_COUNT + 1)}, "poses"),
        ({"poses": [{"roll": 11, "pitch": 0, "phase": 0}]}, "roll"),
        ({"mu": 1.5}, "mu"),
        ({"point_limit": 5}, "point_limit"),
        ({"time_limit": 0}, "time_limit"),
        ({"time_limit": 3601}, "time_limit"),
        ({"device": {"unit": "mm", "push": -1}}, "body device push"),
        ({"turns": 2}, "turns"),
    ],
)
def test_what_is_not_valid_is_named(client: TestClient, changed: dict[str, Any], named: str) -> None:
    assert named in str(problem(client.post(PATH, json=body(**changed)), 400))
