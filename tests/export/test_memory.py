"""How much memory an export takes, in a process of its own."""

from __future__ import annotations

import subprocess
import sys

import pytest

from harness.databases import Databases
from tests.service.conftest import store_library
from tests.service.made_up_states import made_up_states
from threadstate.export.names import FileFormat
from threadstate.library.grid import Grid
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

ALLOWED = {FileFormat.PARQUET: 8e6, FileFormat.CSV: 10e6, FileFormat.NDJSON: 12e6}
"""Bytes: a tenth to a third more than writing takes; less than it takes to hold the file, or the documents, whole."""

PROGRAM = """
import sys, tracemalloc
from threadstate.export import parquet
from threadstate.export.file import file_parts
from threadstate.export.names import FileFormat, TableName
from threadstate.library.engine import reading
from threadstate.library.read import latest_library

parquet.ROWS_IN_A_GROUP = 1024
with reading(sys.argv[1]) as engine:
    with engine.connect() as connection:
        library = latest_library(connection)
    export = lambda: file_parts(engine, library, TableName.STATES, FileFormat(sys.argv[2]), library.length_unit)
    next(export())
    tracemalloc.start()
    written = sum(len(part) for part in export())
    print(written, tracemalloc.get_traced_memory()[1])
"""


@pytest.fixture(scope="module")
def big_database(sqlite_databases: Databases) -> str:
    """A library of 5,400 made-up states."""
    database = sqlite_databases.migrated()
    store_library(database, quarter_twenty_unc(), Grid(1.0, 1.0, 0.6), made_up_states)
    return database


@pytest.mark.parametrize("file_format", FileFormat)
def test_memory_does_not_grow_with_the_library(big_database: str, file_format: FileFormat) -> None:
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM, big_database, file_format], check=True, capture_output=True, text=True
    )
    written, peak = map(int, run.stdout.split())
    assert peak < ALLOWED[file_format]
    assert peak + written > ALLOWED[file_format], "a file that is held as a whole would pass"
