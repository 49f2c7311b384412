from __future__ import annotations

import csv
import io
import json
import sys

import pytest
from fastapi.testclient import TestClient

from tests.service.conftest import StoredLibrary
from tests.service.test_problems import problem
from threadstate.export.names import FileFormat, TableName
from threadstate.state.document import state_document

pytestmark = pytest.mark.sqlite_alone

EXPORT = "/v1/libraries/latest/export"


@pytest.mark.parametrize("file_format", FileFormat)
@pytest.mark.parametrize("table", TableName)
def test_a_file_has_a_name_a_tag_and_a_type(client: TestClient, table: TableName, file_format: FileFormat) -> None:
    response = client.get(f"{EXPORT}/{table}.{file_format}")
    assert response.status_code == 200
    assert response.headers["Content-Type"] == file_format.media_type
    assert response.headers["Content-Disposition"] == f'attachment; filename="library-1-{table}.{file_format}"'
    assert response.headers["Content-Location"] == f"/v1/libraries/1/export/{table}.{file_format}"
    assert response.headers["Length-Unit"] == "in"
    assert response.headers["Cache-Control"] == "public, no-cache"
    tag = response.headers["ETag"]
    same = client.get(f"{EXPORT}/{table}.{file_format}", headers={"If-None-Match": f'"other", {tag}'})
    assert (same.status_code, same.content, same.headers["ETag"]) == (304, b"", tag)
    head = client.head(f"{EXPORT}/{table}.{file_format}")
    assert (head.status_code, head.content, head.headers["ETag"]) == (200, b"", tag)
    assert "Content-Length" not in head.headers
    in_mm = client.get(f"{EXPORT}/{table}.{file_format}?unit=mm")
    assert in_mm.headers["Length-Unit"] == "mm"
    assert in_mm.headers["ETag"] != tag


def test_the_content_is_the_library(client: TestClient, made_up: StoredLibrary) -> None:
    lines = client.get(f"{EXPORT}/states.ndjson").text.splitlines()
    rows = list(csv.DictReader(io.StringIO(client.get(f"{EXPORT}/states.csv").text)))
    assert len(lines) == len(rows) == len(made_up.states)
    for line, row, state in zip(lines, rows, made_up.states, strict=True):
        document = state_document(state)
        assert json.loads(line)["contact_1_point_y"] == document["contacts"][0]["point"][1]
        assert float(row["contact_1_point_y"]) == document["contacts"][0]["point"][1]


def test_columns_go_by_the_names_that_histories_have(client: TestClient) -> None:
    history = client.get("/v1/libraries/latest/histories/1/0?format=csv").text.splitlines()[0].split(",")
    states = client.get(f"{EXPORT}/states.csv").text.splitlines()[0].split(",")
    assert set(history) <= set(states)


@pytest.mark.parametrize("name", ["states.xlsx", "poses.csv", "states.", ".csv", "states.csv.gz"])
def test_what_there_is_not_is_refused(client: TestClient, name: str) -> None:
    assert client.get(f"{EXPORT}/{name}").status_code in (400, 404)
    problem(client.get(f"{EXPORT}/states.csv?format=csv"), 400)
    problem(client.get("/v1/libraries/99/export/states.csv"), 404)


def test_without_pyarrow_parquet_is_a_problem(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    found = problem(client.get(f"{EXPORT}/states.parquet"), 501)
    assert found.type == "urn:threadstate:problem:not-installed"
    assert "'.[parquet]'" in found.detail
