from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from harness.databases import Databases
from tests.service.conftest import client_of
from tests.service.test_problems import problem
from threadstate.thread.standards.designation import StandardThread, found_threads
from worker.cli import run_command_line

pytestmark = pytest.mark.sqlite_alone

THREADS = "/v1/threads"


@pytest.fixture(scope="module")
def client(databases: Databases) -> Iterator[TestClient]:
    """A client of a service whose database does not exist."""
    with client_of(databases.new()) as client:
        yield client


@pytest.mark.parametrize(
    ("search", "found"),
    [
        (None, 501),
        ("m6X1 - 6g / 6h", ["M6x1-6g/6H"]),
        ("1/4-20 unc-3a", ["1/4-20 UNC-3A/3B"]),
        ("M8x1-4g6g/5H lh", ["M8x1-4g6g/5H LH"]),
        ("acme 1/2-10", ["1/2-10 ACME-2G", "1/2-10 STUB ACME-2G"]),
        ("UNEF", 25),
    ],
)
def test_an_answer_is_what_the_command_prints(
    client: TestClient, capsys: pytest.CaptureFixture[str], search: str | None, found: int | list[str]
) -> None:
    response = client.get(THREADS, params={} if search is None else {"search": search})
    assert run_command_line(["threads", "--json", *([] if search is None else ["--search", search])]) == 0
    assert response.text == capsys.readouterr().out.removesuffix("\n")
    designations = [one["designation"] for one in response.json()["threads"]]
    assert found in (designations, len(designations))


@pytest.mark.parametrize(
    ("search", "location", "valid"),
    [
        ("M7x9", "designation", "M6x1-6g/6H"),
        (" ", "designation", "M6x1-6g/6H"),
        ("M6-6k", "tolerance class", "e, f, g or h"),
        ("M6-6g/6K", "tolerance class", "G or H"),
        ("1/4-20 UNC-4A", "tolerance class", "1A, 2A or 3A"),
        ("1/4-16 STUB ACME-3G", "tolerance class", "2G of Stub Acme"),
        ("", "query search", "at least 1 character"),
        ("M" * 101, "query search", "at most 100 characters"),
    ],
)
def test_what_finds_nothing_and_what_a_form_does_not_have_is_refused(
    client: TestClient, search: str, location: str, valid: str
) -> None:
    found = problem(client.get(THREADS, params={"search": search}), 400)
    assert found.type == "urn:threadstate:problem:invalid-value"
    (error,) = found.errors
    assert error.location == location
    assert valid in error.valid


def test_an_unknown_parameter_is_refused(client: TestClient) -> None:
    found = problem(client.get(THREADS, params={"unit": "mm"}), 400)
    assert found.type == "urn:threadstate:problem:unknown-parameter"
    assert [error.valid for error in found.errors] == ["search"]


def test_an_answer_is_made_once(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def noted(search: str | None) -> list[StandardThread]:
        asked.append(search)
        return found_threads(search)

    monkeypatch.setattr("service.threads.found_threads", noted)
    for _ in range(2):
        assert client.get(THREADS, params={"search": "m10x1.25"}).status_code == 200
    assert asked == ["m10x1.25"]


PICTURE = f"{THREADS}/profiles.svg"


def test_the_picture_of_a_pair_is_what_the_command_draws(client: TestClient, tmp_path: Path) -> None:
    response = client.get(PICTURE, params={"designation": "m6 at minimum material", "unit": "in"})
    assert response.status_code == 200, response.text
    assert response.headers["Content-Type"] == "image/svg+xml"
    assert response.headers["Length-Unit"] == "in"
    path = tmp_path / "profiles.svg"
    pair = ["--pair", "M6x1-6g/6H at minimum material"]
    assert run_command_line(["profiles", *pair, "--unit", "in", "--plot", str(path)]) == 0
    assert response.text == path.read_text()
    again = client.get(response.url, headers={"If-None-Match": response.headers["ETag"]})
    assert (again.status_code, again.content) == (304, b"")


def test_the_picture_of_a_librarys_own_pair_names_no_standard(own_client: TestClient) -> None:
    text = own_client.get(PICTURE, params={"library": "latest"}).text
    assert "<title>Thread profiles: M6x1</title>" in text
    assert "ISO" not in text


@pytest.mark.parametrize(
    ("query", "location"),
    [
        ("designation=M7x9", "designation"),
        ("designation=M6&library=1", "library"),
        ("pair=M6", "query pair"),
        ("designation=M6&designation=M8", "query designation"),
    ],
)
def test_a_picture_of_no_known_pair_is_refused(client: TestClient, query: str, location: str) -> None:
    (error,) = problem(client.get(f"{PICTURE}?{query}"), 400).errors
    assert error.location == location
