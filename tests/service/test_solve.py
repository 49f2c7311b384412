from __future__ import annotations

from typing import Any

import pytest
from fastapi.testclient import TestClient

from service.solve import LARGEST_POSE_COUNT
from tests.service.conftest import StoredLibrary
from tests.service.own_library import OWN_OPTIONS, OWN_PAIR
from threadstate.errors import UnresolvedPoseError
from threadstate.state.document import state_document
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import RootForm, pair_by_designation, quarter_twenty_unc
from threadstate.thread.pair import Pair
from threadstate.thread.standards.sizes import UNIFIED_SOURCE, WHITWORTH_SOURCE
from threadstate.units import MILLIMETRES_PER_INCH

pytestmark = pytest.mark.sqlite_alone

POSES = ((2.5, -1.25, 77.7), (4.0, 0.0, 185.0), (-4.0, 0.0, 131.0), (0.0, 0.0, 0.0), (1.0, -2.0, -350.0))


def body(*poses: tuple[float, float, float], **others: object) -> dict[str, Any]:
    """The body that asks for these poses."""
    return {"poses": [dict(zip(("roll", "pitch", "phase"), pose, strict=True)) for pose in poses], **others}


def test_answer_is_the_exact_solvers(client: TestClient) -> None:
    response = client.post("/v1/solve", json=body(*POSES))
    assert response.status_code == 200, response.text
    assert response.headers["Cache-Control"] == "no-store"
    assert response.json() == {
        "designation": "1/4-20 UNC",
        "source": UNIFIED_SOURCE,
        "library": None,
        "unit": "in",
        "states": [state_document(state) for state in solve_poses(quarter_twenty_unc(), POSES)],
    }


def test_every_answer_says_on_what_its_dimensions_rest(own_client: TestClient, client: TestClient) -> None:
    for path in ("/v1/libraries/latest", "/v1/states/1/0/30/jamming?library=latest"):
        assert own_client.get(path).json()["source"] is None, path
    assert client.get("/v1/libraries/latest?unit=mm").json()["source"] == UNIFIED_SOURCE
    whitworth = {"designation": "1/4-20 BSW"}
    for answer in (
        client.post("/v1/solve", json=body(POSES[0], **whitworth)),
        client.post("/v1/statics", json=body(POSES[1], loads=[{}], **whitworth)),
        client.get("/v1/states/4/0/185/jamming", params=whitworth),
        client.get("/v1/histories/4/0/falls", params=whitworth),
    ):
        assert (answer.json()["designation"], answer.json()["source"]) == ("1/4-20 BSW-medium/normal", WHITWORTH_SOURCE)


def test_stored_states_are_what_solving_gives(solved_client: TestClient, solved: StoredLibrary) -> None:
    poses = [(state.roll_deg, state.pitch_deg, state.phase_deg) for state in solved.states]
    on_demand = solved_client.post("/v1/solve", json=body(*poses)).json()["states"]
    stored = solved_client.get("/v1/libraries/latest/states", params={"limit": 1000}).json()["states"]
    assert [{name: value for name, value in state.items() if name != "statics"} for state in stored] == on_demand


def test_lengths_are_in_the_unit_asked_for(client: TestClient) -> None:
    response = client.post("/v1/solve", params={"unit": "mm"}, json=body(POSES[1]))
    expected = state_document(solve_poses(quarter_twenty_unc(), POSES[1:2])[0], MILLIMETRES_PER_INCH)
    assert (response.json()["unit"], response.json()["states"]) == ("mm", [expected])
    assert response.headers["Length-Unit"] == "mm"


def test_thread_is_chosen_by_its_designation(client: TestClient) -> None:
    pair = quarter_twenty_unc(RootForm.NEWER)
    response = client.post("/v1/solve", json=body(POSES[0], designation=pair.designation))
    assert response.json()["designation"] == pair.designation
    assert response.json()["states"] == [state_document(state) for state in solve_poses(pair, POSES[:1])]


def test_a_librarys_own_pair_and_tolerances_are_solved(own_client: TestClient) -> None:
    expected = [state_document(state) for state in solve_poses(OWN_PAIR, POSES, OWN_OPTIONS)]
    assert expected != [state_document(state) for state in solve_poses(OWN_PAIR, POSES)]
    for name in (1, "latest", "m6x1", OWN_PAIR.designation):
        answer = own_client.post("/v1/solve", json=body(*POSES, library=name)).json()
        assert answer == {"designation": "M6x1", "source": None, "library": 1, "unit": "mm", "states": expected}, name


def test_the_known_thread_stays_where_no_library_is_named(own_client: TestClient) -> None:
    answer = own_client.post("/v1/solve", json=body(POSES[0])).json()
    assert (answer["designation"], answer["library"]) == ("1/4-20 UNC", None)


@pytest.mark.parametrize(
    ("others", "status", "named"),
    [
        ({"library": 99}, 404, "library 99 is not published here"),
        ({"library": "m5x0.8"}, 404, "m6x1"),
        ({"library": 1, "designation": "1/4-20 UNC"}, 400, "a designation or a library, not both"),
        ({"library": 0}, 400, "library"),
        ({"library": ""}, 400, "library"),
        ({"library": 1.5}, 400, "library"),
    ],
)
def test_a_library_that_is_not_there_is_refused(
    own_client: TestClient, others: dict[str, object], status: int, named: str
) -> None:
    response = own_client.post("/v1/solve", json=body(POSES[0], **others))
    assert response.status_code == status
    assert named in response.text


def test_unknown_thread_is_told_the_known_ones(client: TestClient) -> None:
    response = client.post("/v1/solve", json=body(POSES[0], designation="M7"))
    assert response.status_code == 400
    assert "1/4-20 UNC" in response.json()["detail"]


def test_a_chamfer_is_refused_by_name(client: TestClient) -> None:
    chamfered = {"designation": "M6 with chamfer"}
    for response in (
        client.post("/v1/solve", json=body(POSES[0], **chamfered)),
        client.post("/v1/statics", json=body(POSES[0], loads=[{}], **chamfered)),
        client.get("/v1/states/4/0/185/jamming", params=chamfered),
        client.get("/v1/histories/4/0/falls", params=chamfered),
    ):
        assert response.status_code == 400, response.text
        assert "chamfer is 'end diameter 4.6" in response.json()["detail"]
        assert "valid: none for the exact method" in response.json()["detail"]


@pytest.mark.parametrize("designation", ["m6 - 6G/6h at minimum", "1/4-16 Acme", "Tr8x1.5-7e/7H"])
def test_standard_threads_are_solved_however_they_are_written(client: TestClient, designation: str) -> None:
    pair = pair_by_designation(designation)
    answer = client.post("/v1/solve", json=body(POSES[0], designation=designation)).json()
    assert (answer["designation"], answer["unit"]) == (pair.designation, pair.unit.value)
    (state,) = answer["states"]
    (expected,) = solve_poses(pair, [POSES[0]])
    assert [contact["point"] for contact in state["contacts"]] == [list(one.point) for one in expected.contacts]


def test_a_thousand_poses_are_solved_and_one_more_is_refused(client: TestClient) -> None:
    poses = [(0.01 * i - 5.0, 5.0 - 0.007 * i, 0.36 * i) for i in range(LARGEST_POSE_COUNT + 1)]
    answer = client.post("/v1/solve", json=body(*poses[:-1])).json()
    assert [(one["roll"], one["pitch"], one["phase"]) for one in answer["states"]] == poses[:-1]
    assert client.post("/v1/solve", json=body(*poses)).status_code == 400


@pytest.mark.parametrize(
    ("content", "named"),
    [
        ('{"poses":[]}', "poses"),
        ("{}", "poses"),
        ("[]", "body"),
        ("", "body"),
        ('{"poses":[{"roll":0,"pitch":0}]}', "phase"),
        ('{"poses":[{"roll":0,"pitch":0,"phase":0,"yaw":0}]}', "yaw"),
        ('{"poses":[{"roll":10.01,"pitch":0,"phase":0}]}', "roll"),
        ('{"poses":[{"roll":0,"pitch":0,"phase":1e400}]}', "phase"),
        ('{"poses":[{"roll":"0","pitch":0,"phase":0}]}', "roll"),
        ('{"poses":[{"roll":true,"pitch":0,"phase":0}]}', "roll"),
        ('{"poses":[{"roll":0,"pitch":0,"phase":0}],"unit":"mm"}', "unit"),
        ('{"poses":[{"roll":0,"pitch":0,"phase":0}],"designation":""}', "designation"),
    ],
)
def test_body_out_of_range_is_refused_by_name(client: TestClient, content: str, named: str) -> None:
    response = client.post("/v1/solve", content=content, headers={"Content-Type": "application/json"})
    assert response.status_code == 400
    assert any(named in error["location"] for error in response.json()["errors"]), response.text


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity"])
def test_what_is_no_number_of_json_is_refused(client: TestClient, number: str) -> None:
    content = f'{{"poses":[{{"roll":0,"pitch":{number},"phase":0}}]}}'
    response = client.post("/v1/solve", content=content, headers={"Content-Type": "application/json"})
    assert response.status_code == 400
    assert f"{number} is no number of JSON" in response.json()["detail"]


def test_a_pose_that_cannot_be_decided_is_named(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    def undecided(_pair: Pair, poses: list[tuple[float, float, float]], _options: SolveOptions) -> list[ContactState]:
        raise UnresolvedPoseError(*poses[0])

    monkeypatch.setattr("service.solve.solve_poses", undecided)
    response = client.post("/v1/solve", json=body(POSES[0]))
    assert response.status_code == 422
    assert response.json()["type"] == "urn:threadstate:problem:unresolved-pose"
    assert "roll 2.5, pitch -1.25, phase 77.7 deg" in response.json()["detail"]
