from __future__ import annotations

from collections.abc import Iterator, Sequence

import pytest
from fastapi.testclient import TestClient

from harness.databases import Databases
from service.undecided import UndecidedPage
from tests.service.conftest import StoredLibrary, client_of, store_library
from tests.service.made_up_states import made_up_states
from threadstate.library.grid import Grid
from threadstate.mesh.options import MeshOptions
from threadstate.state.model import Answer, UndecidedPose
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.sqlite_alone

LISTED = "/v1/libraries/latest-mesh/undecided"


def _answers(poses: Sequence[tuple[float, float, float]]) -> list[Answer]:
    """Made-up states; phase 30 and all of roll 1, pitch 0 are undecided."""
    return [
        UndecidedPose(*pose, f"no reason at {pose[2]:g}") if pose[2] == 30.0 or pose[:2] == (1.0, 0.0) else state
        for pose, state in zip(poses, made_up_states(poses), strict=True)
    ]


@pytest.fixture(scope="module")
def with_undecided(databases: Databases) -> StoredLibrary:
    return store_library(databases.migrated(), quarter_twenty_unc(), Grid(1.0, 1.0, 30.0), _answers, MeshOptions())


@pytest.fixture
def by_mesh(with_undecided: StoredLibrary) -> Iterator[TestClient]:
    with client_of(with_undecided.database) as client:
        yield client


def test_the_pages_of_undecided_poses_hold_each_once(by_mesh: TestClient) -> None:
    whole = by_mesh.get(LISTED).json()
    assert UndecidedPage.model_validate(whole).model_dump(mode="json") == whole
    assert len(whole["undecided"]) == 8 + 12
    assert whole["next"] is None
    walked, path = [], f"{LISTED}?limit=7"
    while path:
        response = by_mesh.get(path)
        page = response.json()
        assert response.headers.get("Link") == (page["next"] and f'<{page["next"]}>; rel="next"')
        walked += page["undecided"]
        path = page["next"]
    assert walked == whole["undecided"]
    assert walked[0] == {"roll": -1.0, "pitch": -1.0, "phase": 30.0, "reason": "no reason at 30"}


def test_an_undecided_pose_is_a_problem_that_says_why(by_mesh: TestClient) -> None:
    response = by_mesh.get("/v1/libraries/latest-mesh/states/1/0/60")
    assert response.status_code == 404
    assert response.json()["type"] == "urn:threadstate:problem:undecided-pose"
    assert response.json()["detail"].endswith("phase 60 deg: no reason at 60")
    assert by_mesh.get("/v1/libraries/latest-mesh/states/1/1/60").status_code == 200


def test_a_history_names_the_phases_without_a_state(by_mesh: TestClient) -> None:
    path = "/v1/libraries/latest-mesh/histories/0/0"
    rows, columns = by_mesh.get(path).json(), by_mesh.get(f"{path}?format=columns").json()
    assert rows["undecided"] == columns["undecided"] == [{"phase": 30.0, "reason": "no reason at 30"}]
    assert len(rows["states"]) == len(columns["columns"]["phase"]) == 11
    empty = by_mesh.get("/v1/libraries/latest-mesh/histories/1/0").json()
    assert (len(empty["states"]), len(empty["undecided"])) == (0, 12)
    assert len(by_mesh.get("/v1/libraries/latest-mesh/histories/1/0?format=csv").text.splitlines()) == 1


def test_a_library_by_meshes_says_so_and_is_not_the_latest(by_mesh: TestClient, with_undecided: StoredLibrary) -> None:
    detail = by_mesh.get("/v1/libraries/latest-mesh").json()
    assert (detail["id"], detail["method"]) == (with_undecided.id, "mesh")
    assert (detail["state_count"], detail["undecided_count"]) == (88, 20)
    assert sum(detail["counts"]["classes"].values()) == 88
    assert detail["options"]["descent"] == "safe"
    for name in ("latest", "1-4-20-unc"):
        assert by_mesh.get(f"/v1/libraries/{name}").status_code == 404
    assert by_mesh.get("/readyz").status_code == 200


def test_an_exact_library_has_no_undecided_poses(client: TestClient) -> None:
    assert client.get("/v1/libraries/latest/undecided").json()["undecided"] == []
    assert client.get("/v1/libraries/latest").json()["undecided_count"] == 0
    assert client.get(LISTED).status_code == 404
