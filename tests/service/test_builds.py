from __future__ import annotations

import pytest
from fastapi.testclient import TestClient

from harness.databases import Databases
from tests.service.conftest import StoredLibrary, client_of
from tests.service.made_up_states import made_up_states
from threadstate.library.engine import writer_engine
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import chunk_rows
from threadstate.library.write import open_library, publish, write_chunk
from threadstate.state.solve import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.sqlite_alone

GRID = Grid(1.0, 1.0, 90.0)


def test_a_library_is_told_of_while_it_is_computed(databases: Databases) -> None:
    database = databases.migrated()
    engine = writer_engine(database)
    with client_of(database) as client:
        assert client.get("/v1/building").json() == {"building": []}
        library = open_library(engine, LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions()))
        for index in range(GRID.orientation_count):
            (one,) = client.get("/v1/building").json()["building"]
            assert (one["designation"], one["method"]) == ("1/4-20 UNC", "exact")
            assert (one["done"], one["orientations"]) == (index, 9)
            states = made_up_states(GRID.poses(index))
            write_chunk(engine, library, chunk_rows(GRID.orientation(index), GRID.first_ordinal(index), states))
        publish(engine, library, GRID)
        response = client.get("/v1/building")
        assert (response.json(), response.headers["Cache-Control"]) == ({"building": []}, "no-store")
    engine.dispose()


def test_a_published_library_is_not_being_computed(client: TestClient, made_up: StoredLibrary) -> None:
    assert client.get("/v1/libraries/latest").json()["id"] == made_up.id
    assert client.get("/v1/building").json() == {"building": []}
