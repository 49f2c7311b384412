from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings
from xdist.scheduler import LoadFileScheduling

from harness.databases import KINDS, POSTGRESQL, SQLITE, Databases, PostgresqlDatabases, SqliteDatabases
from harness.postgresql_server import PostgresqlServer, running_server
from tests.shared import FOLDER
from tests.stored_histories.history_library import SMALL_GRID, histories_of_grid
from threadstate.history.model import SolvedHistory

settings.register_profile("repeatable", derandomize=True, deadline=None, max_examples=50)
settings.load_profile("repeatable")

TAKE_LONGEST = (
    "explorer",
    "worker",
    "test_benchmarks.py",
    "studies",
    "test_examples.py",
    "docs",
    "test_chart_study.py",
    "test_paper_study.py",
    "faults",
    "service",
    "mesh",
    "library",
    "contact",
    "statics",
    "client",
)
"""Folders and files of tests, those first that are begun first, so that no lane is left alone with them at the end."""
ONE_BROWSER = "tests/explorer/"
"""What one process of a run tests, with one Chromium, service and library."""

WHOLLY_SLOW = re.compile(r"^pytestmark = .*\bpytest\.mark\.slow\b", re.M)


def pytest_configure(config: pytest.Config) -> None:
    """Make the folder of what the processes of a run share; those of pytest-xdist inherit it."""
    if FOLDER not in os.environ:
        folder = tempfile.TemporaryDirectory(prefix="threadstate-tests-")
        os.environ[FOLDER] = folder.name
        config.add_cleanup(folder.cleanup)

        def forget_folder() -> None:
            os.environ.pop(FOLDER, None)

        config.add_cleanup(forget_folder)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Where each file goes to one process, let the files that need the browser go to one together."""
    if config.getoption("dist") != "loadfile":
        return None
    scheduler = LoadFileScheduling(config, log)
    file_of = scheduler._split_scope
    scheduler._split_scope = lambda name: ONE_BROWSER if name.startswith(ONE_BROWSER) else file_of(name)
    return scheduler


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Where slow tests are left out, do not even import files that have no others."""
    if config.option.markexpr == "not slow" and collection_path.suffix == ".py":
        return WHOLLY_SLOW.search(collection_path.read_text()) is not None or None
    return None


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with what takes longest; a file's tests stay together and in order."""
    tests = Path(__file__).parent

    def turn(item: pytest.Item) -> int:
        first = item.path.relative_to(tests).parts[0]
        return TAKE_LONGEST.index(first) if first in TAKE_LONGEST else len(TAKE_LONGEST)

    items.sort(key=turn)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """A test on databases runs on each kind, unless it is marked as one of one kind alone; PostgreSQL is slow."""
    if "databases" in metafunc.fixturenames:
        marked = {mark.name for mark in metafunc.definition.iter_markers()}
        kinds = [kind for kind in KINDS if not marked & {f"{other}_alone" for other in KINDS if other != kind}]
        slow = {SQLITE: (), POSTGRESQL: (pytest.mark.slow,)}
        chosen = [pytest.param(kind, marks=slow[kind]) for kind in kinds]
        metafunc.parametrize("databases", chosen, indirect=True, scope="session")


@pytest.fixture(scope="session")
def repository_root() -> Path:
    """The root of the source tree."""
    return Path(__file__).parent.parent


@pytest.fixture(scope="session")
def postgresql_server() -> Iterator[PostgresqlServer]:
    """A PostgreSQL server, which all tests share."""
    with running_server() as server:
        yield server


@pytest.fixture(scope="session")
def small_histories() -> list[SolvedHistory]:
    """The histories of the small grid."""
    return histories_of_grid(SMALL_GRID)


@pytest.fixture(scope="session")
def sqlite_databases(tmp_path_factory: pytest.TempPathFactory) -> Databases:
    """Makes SQLite files."""
    return SqliteDatabases(tmp_path_factory.mktemp("databases"))


@pytest.fixture(scope="session")
def postgresql_databases(postgresql_server: PostgresqlServer) -> Databases:
    """Makes databases of the PostgreSQL server."""
    return PostgresqlDatabases(postgresql_server)


@pytest.fixture(scope="session")
def databases(request: pytest.FixtureRequest) -> Databases:
    """Makes databases of the kind that the test is at."""
    made: Databases = request.getfixturevalue(f"{request.param}_databases")
    return made
