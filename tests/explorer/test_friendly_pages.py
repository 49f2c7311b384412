"""What the page says where there is nothing to explore."""

from __future__ import annotations

from collections.abc import Iterator

from selenium import webdriver

from tests.archive.history_library import histories_of_grid
from tests.databases import Databases
from tests.explorer.browser import Explorer
from tests.explorer.conftest import GRID
from tests.service.running import running_service
from threadstate.archive.rows import history_rows
from threadstate.history.window import windows_of
from threadstate.library.engine import writer_engine
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import chunk_rows
from threadstate.library.write import open_library, publish, write_chunk
from threadstate.state.solve import SolveOptions, solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc


def kind_of(explorer: Explorer) -> str:
    return str(explorer.run("return document.querySelector('#message:not([hidden])')?.dataset.kind ?? ''"))


def test_page_tells_of_no_library_then_of_its_progress_and_goes_on(
    chromium: webdriver.Chrome, sqlite_databases: Databases
) -> None:
    database = sqlite_databases.migrated()
    with running_service(database) as address:
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


def build(database: str) -> Iterator[int]:
    """Compute a library and publish it; how many orientations are stored, after each."""
    pair = quarter_twenty_unc()
    engine = writer_engine(database)
    library = open_library(engine, LibraryInputs(pair, GRID, SolveOptions()))
    histories = histories_of_grid(GRID)
    for index in range(GRID.orientation_count):
        rows = chunk_rows(GRID.orientation(index), GRID.first_ordinal(index), solve_poses(pair, GRID.poses(index)))
        write_chunk(engine, library, rows, history_rows(histories[index], windows_of(pair, histories[index])))
        yield index + 1
    publish(engine, library, GRID)
    engine.dispose()


def test_page_tells_of_a_lost_service_and_finds_it_again(chromium: webdriver.Chrome, library_database: str) -> None:
    with running_service(library_database) as address:
        explorer = Explorer(chromium, address)
        explorer.open("/#roll=4&pitch=4&phase=20")
        explorer.wait_for_text("#state", "roll 4 deg, pitch 4 deg, phase 20 deg")
    explorer.choose("#phase", "33")
    explorer.wait(lambda: kind_of(explorer) == "lost", "the page does not say that the service is lost")
    with running_service(library_database, port=int(address.rpartition(":")[2])):
        explorer.wait_for_text("#state", "roll 4 deg, pitch 4 deg, phase 33 deg")
        explorer.wait(lambda: kind_of(explorer) == "", "the page does not go on")


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
