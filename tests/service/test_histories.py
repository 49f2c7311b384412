from __future__ import annotations

import csv
import io
from typing import Any

import pytest
from fastapi.testclient import TestClient

from tests.service.conftest import StoredLibrary
from threadstate.state.document import state_document
from threadstate.statics.stored import NAMES as STATICS
from threadstate.statics.stored import cells

pytestmark = pytest.mark.sqlite_alone

HISTORY = "/v1/libraries/latest/histories/1/-1"


def flat(state: dict[str, Any]) -> dict[str, Any]:
    """A state's document as one row of named cells, said plainly."""
    row: dict[str, Any] = {"phase": state["phase"], "class": state["class"], "flags": " ".join(state["flags"])}
    row["lambda"], row["mu"] = state["turns"]
    for name in ("drop", "embedment", "pivot_offset"):
        row[name] = state[name]
        row[f"margin_{name}"] = state["margins"][name]
    for stage, pose in enumerate(state["poses"], 1):
        for i in range(3):
            row[f"pose_{stage}_t{'xyz'[i]}"] = pose["translation"][i]
            for j in range(3):
                row[f"pose_{stage}_r{i + 1}{j + 1}"] = pose["rotation"][i][j]
    for number, contact in enumerate(state["contacts"], 1):
        for name, value in contact.items():
            if isinstance(value, list):
                for i in range(3):
                    row[f"contact_{number}_{name}_{'xyz'[i]}"] = value[i]
            else:
                row[f"contact_{number}_{name}"] = value
    return row


def test_history_has_all_phases_in_order(client: TestClient, made_up: StoredLibrary) -> None:
    for roll in made_up.grid.tilts_deg:
        for pitch in made_up.grid.tilts_deg:
            history = client.get(f"/v1/libraries/latest/histories/{roll}/{pitch}").json()
            assert [state["phase"] for state in history["states"]] == list(made_up.grid.phases_deg)
            assert history["states"] == [
                state_document(state) for state in made_up.states if (state.roll_deg, state.pitch_deg) == (roll, pitch)
            ]


@pytest.mark.parametrize("unit", ["in", "mm"])
def test_three_formats_agree(client: TestClient, made_up: StoredLibrary, unit: str) -> None:
    rows, columns, text = (
        client.get(HISTORY, params={"unit": unit, "format": name}) for name in ("rows", "columns", "csv")
    )
    table = columns.json()["columns"]
    names = list(table)
    first = made_up.grid.first_ordinal(made_up.grid.orientation_index(1.0, -1.0) or 0)
    expected = [
        flat(state) | dict(zip(STATICS, cells(made_up.statics[ordinal]), strict=True))
        for ordinal, state in enumerate(rows.json()["states"], first)
    ]
    assert set(names) == {name for row in expected for name in row}
    for i, row in enumerate(expected):
        assert {name: table[name][i] for name in names} == {name: row.get(name) for name in names}
    reader = csv.reader(io.StringIO(text.text))
    assert next(reader) == names
    for row, texts in zip(expected, reader, strict=True):
        assert texts == ["" if row.get(name) is None else str(row[name]) for name in names]
    assert (columns.json()["unit"], text.headers["Length-Unit"]) == (unit, unit)


@pytest.mark.parametrize(
    ("accept", "media_type"),
    [
        ("text/csv", "text/csv"),
        ("text/csv, application/json;q=0.5", "text/csv"),
        ("application/json, text/csv;q=0.5", "application/json"),
        ("*/*", "application/json"),
        ("image/png", "application/json"),
    ],
)
def test_accept_header_chooses_the_format(client: TestClient, accept: str, media_type: str) -> None:
    response = client.get(HISTORY, headers={"Accept": accept})
    assert response.headers["Content-Type"].partition(";")[0] == media_type
    assert response.headers["Vary"] == "Accept, Accept-Encoding"


def test_format_wins_over_the_accept_header(client: TestClient) -> None:
    response = client.get(HISTORY, params={"format": "columns"}, headers={"Accept": "text/csv"})
    assert "columns" in response.json()


def test_orientation_off_the_grid_is_not_found(client: TestClient) -> None:
    response = client.get("/v1/libraries/latest/histories/0.5/0")
    assert response.status_code == 404
    assert "-1 to 1 deg in steps of 1" in response.json()["detail"]
