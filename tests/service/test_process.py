"""The service as a process of its own: what a server makes of an address, an in-process client does not show."""

from __future__ import annotations

from collections.abc import Iterator

import httpx2
import pytest

from harness.running_service import running_service
from tests.service.conftest import StoredLibrary

pytestmark = [pytest.mark.sqlite_alone, pytest.mark.slow]


@pytest.fixture(scope="module")
def address(made_up: StoredLibrary) -> Iterator[str]:
    """The address of a running service over the made-up library."""
    with running_service(made_up.database) as address:
        yield address


@pytest.mark.parametrize("name", ["latest", "1-4-20-unc", "1%2F4-20%20UNC"])
def test_every_name_of_a_library_finds_it(address: str, made_up: StoredLibrary, name: str) -> None:
    response = httpx2.get(f"{address}/v1/libraries/{name}/states/1/-1/30")
    assert response.status_code == 200, response.text
    assert response.headers["Content-Location"] == f"/v1/libraries/{made_up.id}/states/1/-1/30"


def test_link_to_the_next_page_can_be_followed(address: str) -> None:
    first = httpx2.get(f"{address}/v1/libraries/1%2F4-20%20UNC/states", params={"limit": 5})
    second = httpx2.get(address + first.links["next"]["url"])
    assert [state["phase"] for state in second.json()["states"]] == [150.0, 180.0, 210.0, 240.0, 270.0]


def test_head_and_conditional_get_have_no_content(address: str) -> None:
    path = f"{address}/v1/libraries/latest/histories/0/0"
    got, head = httpx2.get(path), httpx2.head(path)
    assert (head.content, head.headers["Content-Length"]) == (b"", got.headers["Content-Length"])
    assert int(got.headers["Content-Length"]) < len(got.content), "not compressed"
    again = httpx2.get(path, headers={"If-None-Match": head.headers["ETag"]})
    assert (again.status_code, again.content) == (304, b"")
