"""A service prepares itself: at start what solves nothing, then at leisure what does."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from harness.databases import Databases
from service.network.cache import NetworkCache
from tests.service_app import service_app
from tests.stored_histories.history_library import SMALL_GRID, store_histories
from threadstate.history.model import SolvedHistory
from threadstate.library.read import latest_library
from threadstate.settings import DATA_DIR, DATABASE, read_settings

LONGEST_S = 120.0


@pytest.mark.sqlite_alone
def test_a_service_is_prepared_and_then_in_full(
    databases: Databases, small_histories: list[SolvedHistory], tmp_path: Path
) -> None:
    database = databases.migrated()
    store_histories(database, SMALL_GRID, small_histories)
    app = service_app(read_settings({DATABASE: database, DATA_DIR: str(tmp_path)}), serving=True)
    with TestClient(app) as client:
        _wait_for(client, "threadstate_prepared 1.0")
        _wait_for(client, "threadstate_prepared_in_full 1.0")
        store: NetworkCache = app.state.networks
        with app.state.engine.connect() as connection:
            library = latest_library(connection)
            network = store.get(connection, library)
        assert sorted(network.curves) == list(range(SMALL_GRID.orientation_count))


@pytest.mark.sqlite_alone
def test_without_a_library_there_is_nothing_to_prepare(databases: Databases, tmp_path: Path) -> None:
    settings = read_settings({DATABASE: databases.migrated(), DATA_DIR: str(tmp_path)})
    with TestClient(service_app(settings, serving=True)) as client:
        _wait_for(client, "threadstate_prepared_in_full 1.0")


def _wait_for(client: TestClient, line: str) -> None:
    until = time.monotonic() + LONGEST_S
    while line not in client.get("/metrics").text:
        assert time.monotonic() < until, f"{line} never"
        time.sleep(0.05)


@pytest.mark.sqlite_alone
def test_what_fails_in_the_background_is_logged(
    databases: Databases, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    async def failing(*_: object) -> None:
        raise RuntimeError("a fault of the preparation")

    monkeypatch.setattr("service.warming.Warming.run", failing)
    settings = read_settings({DATABASE: databases.migrated(), DATA_DIR: str(tmp_path)})
    with TestClient(service_app(settings, serving=True)) as client:
        assert client.get("/healthz").status_code == 200
        assert "a fault of the preparation" in caplog.text
