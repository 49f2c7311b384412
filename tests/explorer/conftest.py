from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import pytest
from selenium import webdriver

from harness.browser import Explorer, hosts_of, start_chromium
from harness.databases import Databases
from tests.jobs.jobs import SUCCESS_INPUTS
from tests.service.success_map import store_success_map
from tests.service_thread import service_thread
from tests.stored_histories.history_library import histories_of_grid, store_histories
from threadstate.device.document import device_from_document
from threadstate.library.grid import Grid

GRID = Grid(4.0, 4.0, 5.0)
"""Tilts of -4, 0 and 4 deg, phases by 5 deg."""
MATRIX_DEVICE = device_from_document(
    {"unit": "mm", "stiffness": [[20.0 + i if i == j else 0.0 for j in range(6)] for i in range(6)]}
)
"""A device that the page has no fields for."""


@pytest.fixture(scope="session")
def library_database(sqlite_databases: Databases) -> str:
    """A database with a real library and its histories, and success maps of made-up outcomes."""
    database = sqlite_databases.migrated()
    store_success_map(database)
    store_success_map(database, replace(SUCCESS_INPUTS, device=MATRIX_DEVICE))
    store_histories(database, GRID, histories_of_grid(GRID))
    return database


@pytest.fixture(scope="session")
def address(library_database: str) -> Iterator[str]:
    """The address of a running service over the real library."""
    with service_thread(library_database) as address:
        yield address


@pytest.fixture(scope="session")
def chromium() -> Iterator[webdriver.Chrome]:
    """A headless browser as wide as a laptop's screen, which spends no time on smooth edges of solids."""
    chromium = start_chromium(1280, 800, "--webgl-antialiasing-mode=none")
    yield chromium
    chromium.quit()


class OpenPage:
    """The page that tests share: the next one finds its view reset, or the page loaded again if a test has failed."""

    def __init__(self, chromium: webdriver.Chrome) -> None:
        self._chromium = chromium
        self._failed = 0

    @contextmanager
    def explorer(self, address: str, session: pytest.Session) -> Iterator[Explorer]:
        """The explorer of a service; nothing may be complained of and nobody else asked, whatever a test does."""
        explorer = Explorer(self._chromium, address)
        if session.testsfailed != self._failed:
            self._chromium.get("about:blank")
            self._failed = session.testsfailed
        explorer.reset()
        explorer.complaints()
        explorer.addresses_asked()
        yield explorer
        explorer.run("localStorage.clear()")
        assert explorer.complaints() == []
        assert hosts_of(explorer.addresses_asked()) <= {address.removeprefix("http://")}


@pytest.fixture(scope="session")
def open_page(chromium: webdriver.Chrome) -> OpenPage:
    """The one page of the browser."""
    return OpenPage(chromium)


@pytest.fixture
def explorer(open_page: OpenPage, address: str, request: pytest.FixtureRequest) -> Iterator[Explorer]:
    """The explorer over the real library."""
    with open_page.explorer(address, request.session) as explorer:
        yield explorer
