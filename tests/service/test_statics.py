"""What loads do to states, by HTTP: of a library's states, and of any poses."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from pydantic import TypeAdapter

from service.libraries.requested import SolvedPair
from service.statics.endpoints import MOST_COMBINATIONS, MOST_WITH_MODES
from tests.service.own_library import OWN_OPTIONS, OWN_PAIR
from tests.service.test_problems import problem
from threadstate.errors import UnresolvedPoseError
from threadstate.state.solve import solve_pose
from threadstate.statics.document import RequestedStaticsDocument, statics_document
from threadstate.statics.load import LARGEST_NUMBER, Load
from threadstate.statics.solve import statics_of
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.standards.sizes import UNIFIED_SOURCE
from worker.cli import run_command_line

pytestmark = pytest.mark.sqlite_alone

POST = "/v1/statics"
THREE, PATCH, PENETRATING = (-4.0, -4.0, 180.0), (0.0, -4.0, 180.0), (-4.0, -4.0, 0.0)
LOAD = {"force": "0.1,0,-10", "moment": "0,0.5,0", "point": "0,0,0.1", "mu": "1.5"}
"""As query parameters."""
DEFAULT_SOURCE = {"source": UNIFIED_SOURCE}
"""Of the default pair; the document of a library has it, not every answer below it."""


def path(pose: tuple[float, float, float], library: str = "latest") -> str:
    """Where the statics of a stored state are."""
    return f"/v1/libraries/{library}/states/{pose[0]:g}/{pose[1]:g}/{pose[2]:g}/statics"


def given(parameters: dict[str, str]) -> dict[str, object]:
    """The same load as a part of a body."""
    return {name: json.loads(text if name == "mu" else f"[{text}]") for name, text in parameters.items()}


def body(*poses: tuple[float, float, float], loads: list[dict[str, object]], **others: object) -> dict[str, Any]:
    """The body that asks for these poses under these loads."""
    named = [dict(zip(("roll", "pitch", "phase"), pose, strict=True)) for pose in poses]
    return {"poses": named, "loads": loads, **others}


@pytest.mark.parametrize("pose", [THREE, PATCH, PENETRATING])
@pytest.mark.parametrize("parameters", [{}, LOAD, {**LOAD, "unit": "mm"}], ids=["push", "load", "mm"])
def test_a_stored_state_is_answered_as_on_the_command_line(
    solved_client: TestClient,
    capsys: pytest.CaptureFixture[str],
    pose: tuple[float, float, float],
    parameters: dict[str, str],
) -> None:
    response = solved_client.get(path(pose), params=parameters)
    assert response.status_code == 200, response.text
    options = [f"--{name}={value}" for name, value in parameters.items()]
    angles = [f"--{name}={angle}" for name, angle in zip(("roll", "pitch", "phase"), pose, strict=True)]
    capsys.readouterr()
    assert run_command_line(["statics", *angles, *options, "--json"]) == 0
    assert {**response.json(), **DEFAULT_SOURCE} == json.loads(capsys.readouterr().out)
    shape = TypeAdapter(RequestedStaticsDocument)
    assert shape.dump_python(shape.validate_python(response.json()), mode="json") == response.json()


@pytest.mark.parametrize("pose", [THREE, PATCH])
def test_what_is_requested_beside_is_added(
    solved_client: TestClient, capsys: pytest.CaptureFixture[str], pose: tuple[float, float, float]
) -> None:
    names = "reaction, forces_range,modes,wrenches"
    parameters = {"mu": "0.1", "include": names, "unit": "mm"}
    response = solved_client.get(path(pose), params=parameters)
    assert response.status_code == 200, response.text
    angles = [f"--{name}={angle}" for name, angle in zip(("roll", "pitch", "phase"), pose, strict=True)]
    capsys.readouterr()
    assert run_command_line(["statics", *angles, "--mu=0.1", "--unit=mm", f"--include={names}", "--json"]) == 0
    assert {**response.json(), **DEFAULT_SOURCE} == json.loads(capsys.readouterr().out)
    assert (response.json()["modes"] is None) == (pose == PATCH)
    asked = body(pose, loads=[{"mu": 0.1}], library=1, include=["modes", "reaction", "wrenches", "forces_range"])
    assert solved_client.post(POST, params={"unit": "mm"}, json=asked).json()["statics"] == [response.json()]
    assert "reaction" not in solved_client.get(path(pose)).json()


def test_what_cannot_be_requested_is_refused(solved_client: TestClient) -> None:
    (error,) = problem(solved_client.get(path(THREE), params={"include": "reaction,efforts"}), 400).errors
    assert (error.location, error.value, error.valid) == (
        "include",
        "efforts",
        "reaction, forces_range, modes, wrenches",
    )
    (error,) = problem(solved_client.post(POST, json=body(THREE, loads=[{}], include=["efforts"])), 400).errors
    assert error.location == "body include 0"
    many = body(THREE, loads=[{}] * (MOST_WITH_MODES + 1), include=["modes"])
    (error,) = problem(solved_client.post(POST, json=many), 400).errors
    assert (error.location, error.valid) == ("body poses times loads", "at most 10")


@pytest.mark.parametrize("parameters", [{}, {**LOAD, "axes": "mx, my", "unit": "mm", "tolerance": "1e-3"}])
def test_a_jamming_diagram_is_that_of_the_command_line(
    solved_client: TestClient, capsys: pytest.CaptureFixture[str], tmp_path: Path, parameters: dict[str, str]
) -> None:
    address = path(THREE).replace("/statics", "/jamming")
    response = solved_client.get(address, params=parameters)
    assert response.status_code == 200, response.text
    picture = solved_client.get(address, params={**parameters, "format": "svg"})
    assert picture.headers["Content-Type"] == "image/svg+xml"
    options = [f"--{name}={value}" for name, value in parameters.items()]
    angles = [f"--{name}={angle}" for name, angle in zip(("roll", "pitch", "phase"), THREE, strict=True)]
    capsys.readouterr()
    drawn = tmp_path / "jamming.svg"
    assert run_command_line(["jamming", *angles, *options, f"--plot={drawn}", "--json"]) == 0
    assert {**response.json(), **DEFAULT_SOURCE} == json.loads(capsys.readouterr().out)
    assert drawn.read_text() == picture.text
    assert response.headers["Content-Location"] == path(THREE, "1").replace("/statics", "/jamming")


def test_any_pose_has_the_diagram_of_a_stored_one(solved_client: TestClient) -> None:
    stored = path(THREE).replace("/statics", "/jamming")
    computed = stored.removeprefix("/v1/libraries/latest").join(("/v1", ""))
    asked = solved_client.get(computed, params={"library": "latest"})
    of_pair = {"designation": "1/4-20 UNC", "library": 1, **DEFAULT_SOURCE}
    assert asked.json() == {**solved_client.get(stored).json(), **of_pair}
    assert asked.headers["Cache-Control"] == "no-store"
    picture = solved_client.get(computed, params={"library": "latest", "format": "svg"})
    assert picture.text == solved_client.get(stored, params={"format": "svg"}).text


@pytest.mark.parametrize(
    ("parameters", "named", "valid"),
    [
        ({"axes": "fx,fx"}, "axes", "two different ones of fx, fy, mx, my, mz"),
        ({"contacts": "1,4"}, "contact", "1 to 3"),
        ({"contacts": "1;2"}, "contacts", "whole numbers"),
        ({"window": "1"}, "window", "two numbers"),
        ({"window": "0,1"}, "window", "above 0"),
        ({"tolerance": "1"}, "query tolerance", "from 1e-08 to 0.1"),
        ({"force": "0,0,1"}, "force", "z below 0"),
        ({"format": "png"}, "query format", "'json' or 'svg'"),
    ],
)
def test_a_bad_parameter_of_a_diagram_is_named(
    solved_client: TestClient, parameters: dict[str, str], named: str, valid: str
) -> None:
    (error,) = problem(solved_client.get(path(THREE).replace("/statics", "/jamming"), params=parameters), 400).errors
    assert error.location == named
    assert valid in error.valid


def test_a_patch_bears_a_push_over_it_and_an_overlap_is_flagged(solved_client: TestClient) -> None:
    three, patch, penetrating = (solved_client.get(path(pose)).json() for pose in (THREE, PATCH, PENETRATING))
    assert [one["penetrating"] for one in (three, patch, penetrating)] == [False, False, True]
    assert (patch["supported"], patch["mu_hold"], patch["verdict"], patch["forces"]) == (False, None, "moves", [])
    over = solved_client.get(path(PATCH), params={"point": "0,0.076,0"}).json()
    assert (over["supported"], over["mu_hold"], over["verdict"]) == (True, 0.0, "can_stay")
    assert sum(force["normal"] for force in over["forces"]) == pytest.approx(1.0)


def test_an_answer_can_be_cached_and_names_its_library_and_unit(solved_client: TestClient) -> None:
    first = solved_client.get(path(THREE), params=LOAD)
    assert first.headers["Content-Location"] == path(THREE, "1")
    assert first.headers["Length-Unit"] == "in"
    again = solved_client.get(path(THREE), params=LOAD, headers={"If-None-Match": first.headers["ETag"]})
    assert (again.status_code, again.content) == (304, b"")
    other = solved_client.get(path(THREE), params={**LOAD, "mu": "1.4"})
    assert other.json() != first.json()


def test_stored_states_and_poses_have_the_same_statics(solved_client: TestClient) -> None:
    loads = [LOAD, {"force": "1,0,0"}, {}]
    asked = body(THREE, PATCH, PENETRATING, loads=[given(one) for one in loads], library=1)
    for unit in ("in", "mm"):
        answer = solved_client.post(POST, params={"unit": unit}, json=asked).json()
        stored = [
            solved_client.get(path(pose), params={**load, "unit": unit}).json()
            for pose in (THREE, PATCH, PENETRATING)
            for load in loads
        ]
        assert answer == {"designation": "1/4-20 UNC", "library": 1, "unit": unit, "statics": stored, **DEFAULT_SOURCE}


def test_poses_between_those_of_a_grid_are_solved_with_a_librarys_pair(
    client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = SolvedPair(OWN_PAIR, OWN_OPTIONS, 7)
    monkeypatch.setattr("service.statics.endpoints.solved_pair", lambda _request, *_: asked)
    pose = (3.5, -1.25, 77.7)
    response = client.post(POST, json=body(pose, loads=[{"force": [0, 0, -5], "mu": 0.3}], library=7))
    state = solve_pose(OWN_PAIR, *pose, options=OWN_OPTIONS)
    expected = statics_document(statics_of(OWN_PAIR, state, Load(force=(0.0, 0.0, -5.0)), 0.3))
    assert response.json() == {"designation": "M6x1", "source": None, "library": 7, "unit": "mm", "statics": [expected]}
    assert response.headers["Length-Unit"] == "mm"
    assert response.headers["Cache-Control"] == "no-store"


@pytest.mark.parametrize(
    ("parameters", "named", "valid"),
    [
        ({"mu": "-0.1"}, "query mu", "greater than or equal to 0"),
        ({"mu": "nan"}, "query mu", "valid number"),
        ({"mu": "inf"}, "query mu", "valid number"),
        ({"mu": "1e400"}, "query mu", "valid number"),
        ({"mu": "0.1,0.2"}, "query mu", "valid number"),
        ({"force": "0,0,0"}, "force", "not zero"),
        ({"force": "0,0,-1e-13"}, "force", "at least 1e-12"),
        ({"force": "0,0,-2e12"}, "force", "from -1000000000000.0 to 1000000000000.0"),
        ({"force": "0,0,nan"}, "force", "three numbers, separated by commas"),
        ({"point": "1,2"}, "point", "three numbers, separated by commas"),
        ({"moment": "1,2,3,4"}, "moment", "three numbers, separated by commas"),
        ({"moment": ""}, "query moment", "at least 1 character"),
        ({"unit": "cm"}, "query unit", "'in' or 'mm'"),
        ({"friction": "0.1"}, "query friction", "mu, unit, force, moment, point, include"),
    ],
)
def test_a_bad_parameter_is_named_with_its_range(
    solved_client: TestClient, parameters: dict[str, str], named: str, valid: str
) -> None:
    (error,) = problem(solved_client.get(path(THREE), params=parameters), 400).errors
    assert error.location == named
    assert valid in error.valid


@pytest.mark.parametrize(
    ("load", "named"),
    [
        ({"mu": -0.1}, "body loads 1 mu"),
        ({"mu": "0.1"}, "body loads 1 mu"),
        ({"mu": None}, "body loads 1 mu"),
        ({"force": [0, 0, 0]}, "body loads 1 force"),
        ({"force": [0, 0]}, "body loads 1 force"),
        ({"force": "0,0,-1"}, "body loads 1 force"),
        ({"point": [0, 0, LARGEST_NUMBER * 1.1]}, "body loads 1 point 2"),
        ({"moment": [0, 0, True]}, "body loads 1 moment 2"),
        ({"friction": 0.1}, "body loads 1 friction"),
        ([], "body loads 1"),
    ],
)
def test_a_bad_load_of_a_body_is_named(client: TestClient, load: dict[str, object], named: str) -> None:
    (error,) = problem(client.post(POST, json=body(THREE, loads=[{}, load])), 400).errors
    assert error.location == named


@pytest.mark.parametrize("text", ["NaN", "Infinity", "1e400"])
def test_what_is_no_finite_number_is_refused_in_a_body(client: TestClient, text: str) -> None:
    content = json.dumps(body(THREE, loads=[{"mu": 0}])).replace('"mu": 0', f'"mu": {text}')
    assert text in content
    problem(client.post(POST, content=content, headers={"Content-Type": "application/json"}), 400)


def test_a_thousand_combinations_are_answered_and_more_are_refused(client: TestClient) -> None:
    poses = [(0.05 * i - 1.0, 1.0 - 0.07 * i, 9.0 * i) for i in range(40)]
    loads: list[dict[str, object]] = [{"mu": 0.01 * i} for i in range(MOST_COMBINATIONS // 40)]
    answer = client.post(POST, json=body(*poses, loads=loads)).json()["statics"]
    found = [((one["roll"], one["pitch"], one["phase"]), one["mu"]) for one in answer]
    assert found == [(pose, load["mu"]) for pose in poses for load in loads]
    (error,) = problem(client.post(POST, json=body(*poses, loads=[*loads, {}])), 400).errors
    assert (error.location, error.value, error.valid) == ("body poses times loads", "1040", "at most 1000")
    (error,) = problem(client.post(POST, json=body(THREE, loads=[{}] * (MOST_COMBINATIONS + 1))), 400).errors
    assert error.location == "body loads"


@pytest.mark.parametrize(
    ("others", "named"),
    [
        ({"loads": []}, "body loads"),
        ({"poses": []}, "body poses"),
        ({"yaw": 1}, "body yaw"),
        ({"unit": "mm"}, "body unit"),
        ({"library": 1, "designation": "1/4-20 UNC"}, "library"),
        ({"designation": "M7"}, "designation"),
    ],
)
def test_a_bad_body_is_refused_by_name(client: TestClient, others: dict[str, object], named: str) -> None:
    (error,) = problem(client.post(POST, json={**body(THREE, loads=[{}]), **others}), 400).errors
    assert error.location == named


def test_a_body_needs_loads(client: TestClient) -> None:
    asked = body(THREE, loads=[])
    del asked["loads"]
    (error,) = problem(client.post(POST, json=asked), 400).errors
    assert error.location == "body loads"


def test_every_digit_of_a_thousand_loads_is_read(client: TestClient) -> None:
    third = [-1.2345678901234567e-100] * 3
    load: dict[str, object] = {"force": [-1.2345678901234567e-10] * 3, "moment": third, "point": third, "mu": third[0]}
    (error, *_) = problem(client.post(POST, json=body(THREE, loads=[load] * MOST_COMBINATIONS)), 400).errors
    assert error.location == "body loads 0 mu"


def test_a_pose_that_is_not_stored_is_not_found(solved_client: TestClient) -> None:
    for pose in ((1.0, 0.0, 0.0), (4.0, 4.0, 1.0)):
        assert problem(solved_client.get(path(pose)), 404).type.endswith(":not-found")
    assert problem(solved_client.get(path(THREE, "99")), 404).type.endswith(":not-found")


def test_a_pose_without_certain_normals_is_named(solved_client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    def uncertain(*_: object) -> None:
        raise UnresolvedPoseError(*THREE, "the edges of contact 2 are parallel")

    monkeypatch.setattr("threadstate.statics.scene.touching", uncertain)
    not_cached = {"mu": "0.777"}
    for response in (
        solved_client.get(path(THREE), params=not_cached),
        solved_client.post(POST, json=body(THREE, loads=[{}])),
    ):
        found = problem(response, 422)
        assert found.type.endswith(":unresolved-pose")
        assert "roll -4.0, pitch -4.0, phase 180.0 deg: the edges of contact 2 are parallel" in found.detail


def test_the_largest_and_least_loads_have_finite_statics(solved_client: TestClient) -> None:
    most = LARGEST_NUMBER
    loads: list[dict[str, object]] = [
        {"force": [most, -most, most], "moment": [most, most, -most], "point": [most, -most, most], "mu": 1e300},
        {"force": [0, 0, -most], "point": [most, most, most], "mu": 0},
        {"force": [0, 0, -1e-12], "moment": [1e-300, 0, 0], "mu": 1e-300},
        {"force": [0, 0, 0], "moment": [0, 0, 1e-12]},
        {"force": [1e-300, 0, 0], "moment": [most, 0, 0]},
    ]
    response = solved_client.post(POST, json=body(THREE, PATCH, (0.0, 0.0, 0.0), loads=loads))
    assert response.status_code == 200, response.text
    assert {one["verdict"] for one in response.json()["statics"]} <= {"moves", "can_stay", "can_wedge", "undecided"}


def test_a_pair_is_chosen_by_its_designation(client: TestClient) -> None:
    pair = quarter_twenty_unc()
    answer = client.post(POST, json=body(THREE, loads=[{}], designation=pair.designation)).json()
    assert (answer["designation"], answer["library"]) == (pair.designation, None)
