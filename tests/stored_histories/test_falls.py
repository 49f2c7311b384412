"""Histories of an older threadstate, which had no falls, are completed to what is computed now."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from sqlalchemy import Engine, delete, select, update

from harness.databases import Databases
from tests.stored_histories.history_library import SMALL_GRID as GRID
from tests.stored_histories.history_library import store_histories
from threadstate.errors import SchemaError
from threadstate.history.model import SolvedHistory
from threadstate.library.engine import writer_engine
from threadstate.library.history_tables import descent, steepest_fall
from threadstate.library.read import LibraryRecord, library_by_id
from threadstate.library.tables import chunk, library
from threadstate.stored_histories.falls import add_falls, orientations_without_falls
from threadstate.stored_histories.mapping import stored_histories
from worker.migrate import migrate

LIBRARY = 1


@pytest.fixture
def older(
    databases: Databases, small_histories: list[SolvedHistory]
) -> Iterator[tuple[Engine, LibraryRecord, list[str]]]:
    """A library that lost its falls and the hashes of chunks that had them; what it was before."""
    url = databases.migrated()
    store_histories(url, GRID, small_histories)
    engine = writer_engine(url)
    hashes = select(chunk.c.content_sha256).order_by(chunk.c.orientation)
    with engine.begin() as connection:
        record = library_by_id(connection, LIBRARY)
        chunks = list(connection.scalars(hashes))
        connection.execute(delete(steepest_fall))
        connection.execute(delete(descent))
        connection.execute(update(chunk).values(content_sha256="0" * 64))
        connection.execute(update(library).values(content_sha256="0" * 64))
    yield engine, record, chunks
    engine.dispose()


@pytest.mark.slow
def test_completed_histories_are_those_computed_now(older: tuple[Engine, LibraryRecord, list[str]]) -> None:
    engine, record, chunks = older
    with engine.connect() as connection, pytest.raises(SchemaError, match="threadstate migrate"):
        stored_histories(connection, LIBRARY, GRID)
    incomplete = orientations_without_falls(engine)
    assert incomplete == [(LIBRARY, index) for index in range(GRID.orientation_count)]
    # Two at once, both stopped after two, and gone on with.
    passed, beside = add_falls(engine, incomplete), add_falls(engine, incomplete)
    for one in incomplete[:2]:
        assert (next(passed), next(beside)) == (one, one)
    assert orientations_without_falls(engine) == incomplete[2:]
    migration = migrate(engine)
    assert (migration.before, migration.completed) == (migration.after, GRID.orientation_count - 2)
    with engine.connect() as connection:
        assert library_by_id(connection, LIBRARY) == record
        assert list(connection.scalars(select(chunk.c.content_sha256).order_by(chunk.c.orientation))) == chunks
        assert stored_histories(connection, LIBRARY, GRID) is not None
    assert migrate(engine).completed == 0
