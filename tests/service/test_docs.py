from __future__ import annotations

import json
import re
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient
from jsonschema import Draft202012Validator
from pydantic import TypeAdapter

from scripts.write_answers import turned_path
from service.app import create_app
from service.docs.endpoints import ASSETS, PACKAGE
from service.examples.responses import ASSEMBLY, SETTLED_POSE, STATICS
from service.explorer.endpoints import THIRD_PARTY
from service.histories.endpoints import HistoryColumns, HistoryRows
from service.libraries.endpoints import LibraryDetail, LibraryList
from service.page_files import JAVASCRIPT
from service.problems import KINDS
from service.solve import SolveAnswer
from service.states.endpoints import StatePage
from threadstate.state.document import StateDocument, state_document
from threadstate.state.solve import solve_pose
from threadstate.statics.rows import stored_statics
from threadstate.statics.stored import library_state_document
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.sqlite_alone

ELSEWHERE = re.compile(r"""(https?:)?//\w""")


@pytest.fixture(scope="module")
def openapi(client: TestClient) -> dict[str, Any]:
    """The OpenAPI document."""
    document: dict[str, Any] = client.get("/openapi.json").json()
    return document


def operations(openapi: dict[str, Any]) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Path, method and description of every operation."""
    for path, methods in openapi["paths"].items():
        for method, operation in methods.items():
            yield path, method, operation


def test_page_and_its_start_name_no_other_server(client: TestClient) -> None:
    for path in ("/docs", "/docs/assets/start.js"):
        assert not ELSEWHERE.search(client.get(path).text)


def test_every_file_of_the_page_is_served_from_here(client: TestClient) -> None:
    names = re.findall(r'(?:src|href)="([^"]+)"', client.get("/docs").text)
    names.remove("data:,")
    assert len(names) == 3
    assert set(names) <= {f"/docs/assets/{name}" for name in ASSETS}


def test_files_and_their_licences_are_served(client: TestClient) -> None:
    for name, asset in ASSETS.items():
        response = client.get(f"/docs/assets/{name}")
        assert response.status_code == 200
        assert response.headers["Content-Type"] == asset.media_type
        assert response.content == asset.content()
    assert "Apache License" in client.get("/docs/assets/LICENSE").text


def test_other_files_are_not_served(client: TestClient) -> None:
    for name in ("assets.py", "..%2Fassets.py", "%2Fetc%2Fpasswd", "index.html"):
        assert client.get(f"/docs/assets/{name}").status_code == 404


def test_files_that_are_no_python_are_in_a_built_wheel(tmp_path: Path, repository_root: Path) -> None:
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)],
        cwd=repository_root,
        check=True,
        capture_output=True,
    )
    (wheel,) = tmp_path.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    third_party = [f"{PACKAGE}/{asset.name}" for asset in ASSETS.values() if asset.third_party]
    third_party += [f"{package}/{name}" for package, name, _ in THIRD_PARTY.values()]
    assert {f"service/node_modules/{name}" for name in third_party} <= set(names)
    assert {"service/docs/start.js", "service/examples/state.json", "service/examples/solved_state.json"} <= set(names)
    page = repository_root / "service" / "explorer" / "page"
    assert {path.relative_to(repository_root).as_posix() for path in page.rglob("*.*")} <= set(names)


def test_no_third_party_javascript_is_committed(repository_root: Path) -> None:
    tracked = subprocess.run(["git", "ls-files"], cwd=repository_root, check=True, capture_output=True, text=True)
    third_party = {asset.name for asset in ASSETS.values() if asset.third_party} - {"LICENSE", "NOTICE"}
    third_party |= {Path(name).name for _, name, media_type in THIRD_PARTY.values() if media_type == JAVASCRIPT}
    assert not third_party & {Path(name).name for name in tracked.stdout.splitlines()}


@pytest.mark.parametrize(
    ("path", "schema"),
    [
        ("/v1/libraries", LibraryList),
        ("/v1/libraries/latest", LibraryDetail),
        ("/v1/libraries/latest/states?limit=1000", StatePage),
        ("/v1/libraries/latest/states/1/0/30", StateDocument),
        ("/v1/libraries/latest/histories/1/0", HistoryRows),
        ("/v1/libraries/latest/histories/1/0?format=columns", HistoryColumns),
    ],
)
def test_answers_have_the_documented_shape(client: TestClient, path: str, schema: type[object]) -> None:
    document = client.get(path).json()
    shape = TypeAdapter(schema)
    assert without_chamfer(shape.dump_python(shape.validate_python(document), mode="json", by_alias=True)) == document


def without_chamfer(value: object) -> object:
    """A document whose pairs do not name the chamfer that they do not have."""
    if isinstance(value, dict):
        return {key: without_chamfer(one) for key, one in value.items() if (key, one) != ("chamfer", None)}
    return [without_chamfer(one) for one in value] if isinstance(value, list) else value


def test_solved_states_have_the_documented_shape(client: TestClient) -> None:
    document = client.post("/v1/solve", json={"poses": [{"roll": 1, "pitch": 2, "phase": 3}]}).json()
    assert SolveAnswer.model_validate(document).model_dump(mode="json", by_alias=True) == document


def with_examples(node: object) -> Iterator[tuple[dict[str, Any], object]]:
    """Every schema below ``node`` that has examples, with each of them; a parameter's own are its schema's."""
    if isinstance(node, dict):
        schema = node.get("schema", node)
        examples = node.get("examples", [])
        for example in examples.values() if isinstance(examples, dict) else examples:
            yield schema, example["value"] if isinstance(examples, dict) else example
        if "example" in node:
            yield schema, node["example"]
        for value in node.values():
            yield from with_examples(value)
    elif isinstance(node, list):
        for value in node:
            yield from with_examples(value)


def test_every_example_is_valid(openapi: dict[str, Any]) -> None:
    found = list(with_examples(openapi))
    assert len(found) > 20
    for schema, example in found:
        Draft202012Validator({**schema, "components": openapi["components"]}).validate(example)


def states_within(answer: Any) -> list[Any]:
    """The whole states that an answer holds, however it wraps them."""
    return [answer] if "contacts" in answer else answer.get("states", [])


def test_answers_with_states_have_real_ones_as_examples(openapi: dict[str, Any]) -> None:
    for path in (
        "/v1/libraries/{id}/states",
        "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}",
        "/v1/libraries/{id}/histories/{roll}/{pitch}",
        "/v1/solve",
    ):
        ((_, _, operation),) = operations({"paths": {path: openapi["paths"][path]}})
        shown = [
            state
            for _, answer in with_examples(operation["responses"]["200"]["content"]["application/json"])
            for state in states_within(answer)
        ]
        assert shown, path
        for state in shown:
            pose = (state["roll"], state["pitch"], state["phase"])
            solved = solve_pose(quarter_twenty_unc(), *pose)
            (statics,) = stored_statics(quarter_twenty_unc(), [solved])
            whole = library_state_document(solved, statics)
            assert state == {name: value for name, value in whole.items() if name in state}
            assert state.keys() >= state_document(solved).keys()
            assert ("statics" in state) == (path == "/v1/libraries/{id}/states")


def nearly(document: Any) -> Any:
    """Equal to a document whose numbers differ in their last digits, as sums of NumPy do from machine to machine."""
    if isinstance(document, dict):
        return {name: nearly(value) for name, value in document.items()}
    if isinstance(document, list):
        return [nearly(value) for value in document]
    return pytest.approx(document, rel=1e-9, abs=1e-12) if isinstance(document, float) else document


@pytest.mark.parametrize(
    ("path", "schema", "name"),
    [
        ("/v1/solve", "SolveRequest", "solved"),
        ("/v1/statics", "StaticsRequest", "held"),
        ("/v1/settle", "SettleRequest", "settled"),
    ],
)
def test_example_of_a_request_is_answered_by_the_example(
    client: TestClient, openapi: dict[str, Any], path: str, schema: str, name: str
) -> None:
    ((_, request),) = with_examples(openapi["components"]["schemas"][schema])
    content = openapi["paths"][path]["post"]["responses"]["200"]["content"]["application/json"]
    assert nearly(content["examples"][name]["value"]) == client.post(path, json=request).json()


def test_every_operation_documents_its_problems_and_no_other_errors(openapi: dict[str, Any]) -> None:
    for path, method, operation in operations(openapi):
        assert operation["summary"], (path, method)
        assert "422" not in operation["responses"], (path, method)
        assert list(operation["responses"]["default"]["content"]) == ["application/problem+json"], (path, method)


def test_every_successful_answer_has_an_example_or_a_schema(openapi: dict[str, Any]) -> None:
    for path, method, operation in operations(openapi):
        for media_type, content in operation["responses"]["200"]["content"].items():
            assert content["schema"], (path, method, media_type)


def test_every_query_parameter_is_described_and_bounded(openapi: dict[str, Any]) -> None:
    bounds = {"maximum", "exclusiveMaximum", "maxLength", "enum", "$ref"}
    for path, _, operation in operations(openapi):
        for parameter in operation.get("parameters", ()):
            schema = parameter["schema"]
            variants = [one for one in schema.get("anyOf", [schema]) if one.get("type") != "null"]
            assert parameter["description"], (path, parameter["name"])
            for variant in variants:
                assert bounds & ({*variant, *schema}), (path, parameter["name"], variant)


def test_every_operation_is_in_the_documentation(openapi: dict[str, Any], repository_root: Path) -> None:
    text = (repository_root / "docs" / "api.md").read_text()
    for path, method, operation in operations(openapi):
        heading = f"`{method.upper()} {path}`"
        assert heading in text, heading
        section = text.partition(heading)[2].partition("\n## ")[0]
        for parameter in operation.get("parameters", ()):
            if parameter["in"] == "query":
                assert f"`{parameter['name']}`" in section, (heading, parameter["name"])


def test_every_path_and_problem_is_in_the_documentation(repository_root: Path) -> None:
    text = (repository_root / "docs" / "api.md").read_text()
    for path in ("/docs", "/openapi.json", "/healthz", "/readyz"):
        assert f"`GET {path}`" in text
    for kind in KINDS:
        assert f"`{kind.name}` | {kind.status.value} |" in text


def test_states_shown_in_the_documentation_are_real(repository_root: Path) -> None:
    query = r"curl 127\.0\.0\.1:8000/v1/libraries/latest/states/([^/\s]+)/([^/\s]+)/([^/\s]+)"
    shown = re.findall(
        query + r"\n```.*?```json\n(.*?)\n```", (repository_root / "docs" / "api.md").read_text(), re.DOTALL
    )
    assert len(shown) == 2
    for roll, pitch, phase, answer in shown:
        state = solve_pose(quarter_twenty_unc(), float(roll), float(pitch), float(phase))
        assert json.loads(answer) == state_document(state)


def test_statics_shown_in_the_documentation_are_those_of_the_example(repository_root: Path) -> None:
    """Which are computed: they answer the example of a request."""
    query = r"curl '127\.0\.0\.1:8000/v1/libraries/latest/states/(\S+)/statics\?mu=(\S+)&force=(\S+)'"
    text = (repository_root / "docs" / "api.md").read_text()
    ((pose, mu, force, answer),) = re.findall(query + r"\n```.*?```json\n(.*?)\n```", text, re.DOTALL)
    assert json.loads(answer) == STATICS
    assert [float(angle) for angle in pose.split("/")] == [STATICS["roll"], STATICS["pitch"], STATICS["phase"]]
    assert (float(mu), json.loads(f"[{force}]")) == (STATICS["mu"], STATICS["load"]["force"])


def test_the_settled_state_shown_in_the_documentation_is_that_of_the_example(repository_root: Path) -> None:
    text = (repository_root / "docs" / "api.md").read_text()
    ((body, answer),) = re.findall(
        r"curl 127\.0\.0\.1:8000/v1/settle --json '(\S.*?)'\n```.*?```json\n(.*?)\n```", text, re.DOTALL
    )
    assert json.loads(answer) == SETTLED_POSE
    ((_, request),) = with_examples(create_app().openapi()["components"]["schemas"]["SettleRequest"])
    assert json.loads(body) == request


def test_the_path_shown_in_the_documentation_is_that_of_the_example(
    openapi: dict[str, Any], repository_root: Path
) -> None:
    text = (repository_root / "docs" / "api.md").read_text()
    ((body, answer),) = re.findall(
        r"curl 127\.0\.0\.1:8000/v1/assemblies --json '(\S.*?)'\n```.*?```json\n(.*?)\n```", text, re.DOTALL
    )
    assert json.loads(answer) == ASSEMBLY
    ((_, request),) = with_examples(openapi["components"]["schemas"]["AssemblyRequest"])
    assert json.loads(body) == request


@pytest.mark.slow
def test_the_example_of_a_path_answers_the_example_of_a_request(client: TestClient, openapi: dict[str, Any]) -> None:
    assert nearly(ASSEMBLY) == json.loads(json.dumps(turned_path()))
    ((_, request),) = with_examples(openapi["components"]["schemas"]["AssemblyRequest"])
    answer = client.post("/v1/assemblies", json=request).json()
    ends = {name: [column[0], column[-1]] for name, column in answer["path"].items()}
    assert nearly(ASSEMBLY) == {**answer, "path": ends}
