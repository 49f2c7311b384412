"""What the page says where there is nothing to explore."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from selenium import webdriver
from selenium.webdriver.common.keys import Keys

from harness.browser import Explorer
from harness.databases import Databases
from tests.explorer.conftest import GRID
from tests.explorer.test_accessibility import AXE, violations
from tests.service_thread import service_thread
from tests.stored_histories.history_library import histories_of_grid, rows_of, store_histories
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.jobs.queue import submit_job
from threadstate.library.engine import writer_engine, writing
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import chunk_rows
from threadstate.library.write import open_library, publish, write_chunk
from threadstate.settings import READ_KEYS
from threadstate.state.solve import SolveOptions, solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow


def kind_of(explorer: Explorer) -> str:
    return str(explorer.run("return document.querySelector('#message:not([hidden])')?.dataset.kind ?? ''"))


def test_page_tells_of_no_library_then_of_its_progress_and_goes_on(
    chromium: webdriver.Chrome, sqlite_databases: Databases
) -> None:
    database = sqlite_databases.migrated()
    with service_thread(database) as address:
        explorer = Explorer(chromium, address)
        explorer.open()
        explorer.wait(lambda: kind_of(explorer) == "empty", "the page does not say that there is no library")
        assert "threadstate rebuild" in explorer.text("#message")
        for done in build(database):
            if done == 4:
                explorer.wait_for_text("#message", "4 of 9 orientations")
                assert kind_of(explorer) == "building"
        explorer.one("#map .cell")
        assert kind_of(explorer) == ""


def test_page_tells_of_a_job_that_waits_for_a_worker(chromium: webdriver.Chrome, sqlite_databases: Databases) -> None:
    database = sqlite_databases.migrated()
    with writing(database) as engine:
        submit_job(engine, LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions()))
    with service_thread(database) as address:
        explorer = Explorer(chromium, address)
        explorer.open()
        explorer.wait_for_text("#message", "1/4-20 UNC: waits for a worker")
        assert kind_of(explorer) == "building"


def test_page_asks_for_a_key_and_keeps_it_to_itself(chromium: webdriver.Chrome, sqlite_databases: Databases) -> None:
    database = sqlite_databases.migrated()
    store_histories(database, GRID, histories_of_grid(GRID))
    with writing(database) as engine:
        key = create_key(engine, "page", Scope.READ)
    with service_thread(database, settings={READ_KEYS: "required"}) as address:
        explorer = Explorer(chromium, address)
        explorer.open("/#roll=4&pitch=4&phase=20")
        explorer.wait(lambda: kind_of(explorer) == "key", "the page does not ask for a key")
        assert explorer.chromium.switch_to.active_element.get_attribute("id") == "key"
        explorer.one("#key").send_keys("ts_wrong", Keys.ENTER)
        explorer.wait_for_text("#message", "This key is refused")
        assert explorer.run("return sessionStorage.length") == 0
        explorer.one("#key").send_keys(key, Keys.ENTER)
        explorer.wait_for_text("#state", "roll 4 deg, pitch 4 deg, phase 20 deg")
        explorer.one("#scene canvas")
        assert kind_of(explorer) == ""
        asked = explorer.addresses_asked()
        assert asked and not [one for one in [*asked, explorer.chromium.current_url] if key in one]
        assert explorer.run("return [localStorage.length, document.cookie]") == [0, ""]
        assert explorer.run("return Object.values(sessionStorage)") == [key]
        explorer.chromium.refresh()
        explorer.wait_for_text("#state", "roll 4 deg, pitch 4 deg, phase 20 deg")
        explorer.click("#forget-key")
        explorer.wait(lambda: kind_of(explorer) == "key", "the key is not forgotten")


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_nothing_serious_where_there_is_nothing_to_explore(
    chromium: webdriver.Chrome, sqlite_databases: Databases, repository_root: Path, theme: str
) -> None:
    database = sqlite_databases.migrated()
    with service_thread(database, settings={READ_KEYS: "required"}) as closed, service_thread(database) as empty:
        for address, kind in ((closed, "key"), (empty, "empty")):
            explorer = Explorer(chromium, address)
            explorer.open(f"/#theme={theme}")
            explorer.one(f"#message[data-kind={kind}]:not([hidden])")
            assert violations(explorer, (repository_root / AXE).read_text()) == []


def build(database: str) -> Iterator[int]:
    """Compute a library and publish it; how many orientations are stored, after each."""
    pair = quarter_twenty_unc()
    engine = writer_engine(database)
    library = open_library(engine, LibraryInputs(pair, GRID, SolveOptions()))
    histories = histories_of_grid(GRID)
    for index in range(GRID.orientation_count):
        rows = chunk_rows(GRID.orientation(index), GRID.first_ordinal(index), solve_poses(pair, GRID.poses(index)))
        write_chunk(engine, library, rows, rows_of(histories[index]))
        yield index + 1
    publish(engine, library, GRID)
    engine.dispose()


def test_page_tells_of_a_lost_service_and_finds_it_again(chromium: webdriver.Chrome, library_database: str) -> None:
    with service_thread(library_database) as address:
        explorer = Explorer(chromium, address)
        explorer.open("/#roll=4&pitch=4&phase=20")
        explorer.wait_for_text("#state", "roll 4 deg, pitch 4 deg, phase 20 deg")
    explorer.choose("#phase", "33")
    explorer.wait(lambda: kind_of(explorer) == "lost", "the page does not say that the service is lost")
    with service_thread(library_database, port=int(address.rpartition(":")[2])):
        explorer.wait_for_text("#state", "roll 4 deg, pitch 4 deg, phase 33 deg")
        explorer.wait(lambda: kind_of(explorer) == "", "the page does not continue")


def test_an_unknown_address_has_a_friendly_page(explorer: Explorer) -> None:
    explorer.open("/nowhere")
    assert "There is no page at this address" in explorer.text("main")
    explorer.complaints()
    explorer.chromium.find_element("link text", "the explorer").click()
    explorer.one("#map .cell")


def test_an_unknown_library_leads_back(explorer: Explorer) -> None:
    explorer.open("/#library=999")
    explorer.wait(lambda: kind_of(explorer) == "unknown", "the page does not say that there is no such library")
    explorer.complaints()
    explorer.chromium.find_element("link text", "the latest one").click()
    explorer.one("#map .cell")
