"""Every number of an address, and of a message that names what was asked for, is the one that was asked for."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from fastapi.testclient import TestClient

from harness.databases import Databases
from tests.service.conftest import StoredLibrary, client_of, store_library
from tests.service.made_up_states import made_up_states
from tests.service.test_problems import problem
from threadstate.client.calls.network import windows
from threadstate.client.calls.states import state
from threadstate.library.grid import Grid
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.sqlite_alone

STEP = 2.8125
"""128 phases, most of them with four decimals."""


@pytest.fixture(scope="module")
def fine(databases: Databases) -> StoredLibrary:
    return store_library(databases.migrated(), quarter_twenty_unc(), Grid(0.0, 1.0, STEP), made_up_states)


@pytest.fixture(scope="module")
def fine_client(fine: StoredLibrary) -> Iterator[TestClient]:
    with client_of(fine.database) as client:
        yield client


def test_a_state_has_the_address_at_which_it_is(fine: StoredLibrary, fine_client: TestClient) -> None:
    for phase in fine.grid.phases_deg:
        response = fine_client.get(f"/v1/libraries/latest/states/0/0/{phase!r}")
        again = fine_client.get(response.headers["Content-Location"])
        assert (again.status_code, again.content) == (200, response.content), response.headers["Content-Location"]


def test_an_address_may_be_written_in_other_ways(fine: StoredLibrary, fine_client: TestClient) -> None:
    response = fine_client.get("/v1/libraries/latest/states/-0/0.00/120.9375")
    assert response.headers["Content-Location"] == f"/v1/libraries/{fine.id}/states/0/0/120.9375"


def test_what_is_not_found_is_named_as_it_was_asked_for(fine_client: TestClient) -> None:
    detail = problem(fine_client.get("/v1/libraries/latest/states/0/0/120.93751"), 404).detail
    assert "roll 0, pitch 0, phase 120.93751 deg" in detail
    detail = problem(fine_client.get("/v1/libraries/latest/histories/0.0000001/0"), 404).detail
    assert "roll 1e-07, pitch 0 deg" in detail
    assert "/v1/histories/1e-07/0/falls?" in detail


def test_a_client_asks_for_the_very_numbers() -> None:
    assert state(-1.0, 0.0125, np.float64(123.0125)).path == "/v1/libraries/latest/states/-1/0.0125/123.0125"
    assert windows(least=1e-7).parameters == {"least": "1e-07"}
