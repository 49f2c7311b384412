"""A library of an older threadstate, whose schema had no statics, is published still and completed by the migration."""

from __future__ import annotations

from pathlib import Path

from alembic import command
from alembic.config import Config
from sqlalchemy import text

import migrations
from harness.databases import Databases
from tests.prepared import prepared_chunk
from tests.stored_histories.history_library import PAIR
from tests.stored_histories.history_library import SMALL_GRID as GRID
from threadstate.library.copying import copy_library
from threadstate.library.engine import writing
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import library_by_id, states_between
from threadstate.library.statics import statics_between
from threadstate.library.write import open_library, publish, write_chunk
from threadstate.state.options import SolveOptions
from threadstate.statics.solve import statics_of
from threadstate.stored_histories.statics import orientations_without_statics
from worker.migrate import migrate

LAST = GRID.pose_count - 1


def test_statics_are_filled_in_and_the_library_stays_what_it_was(databases: Databases) -> None:
    with writing(databases.migrated()) as engine:
        library = open_library(engine, LibraryInputs(PAIR, GRID, SolveOptions()))
        for index in range(GRID.orientation_count):
            chunk = prepared_chunk(GRID, index)
            write_chunk(engine, library, chunk.rows, chunk.history)
        publish(engine, library, GRID)
        with engine.connect() as connection:
            record, computed = library_by_id(connection, library), statics_between(connection, library, 0, LAST)
        assert {one is None for one in computed.values()} == {False}
        config = Config()
        config.set_main_option("script_location", str(Path(migrations.__file__).parent))
        with engine.begin() as connection:
            config.attributes["connection"] = connection
            command.downgrade(config, "0008")
        assert migrate(engine).before == "0008"
        with engine.connect() as connection:
            assert library_by_id(connection, library) == record
            assert statics_between(connection, library, 0, LAST) == computed
        with engine.begin() as connection:
            connection.execute(text(f"UPDATE state SET support_margin = NULL WHERE ordinal >= {GRID.first_ordinal(5)}"))
        assert orientations_without_statics(engine) == [(library, i) for i in range(5, GRID.orientation_count)]
        migrate(engine)
        assert orientations_without_statics(engine) == []
        with engine.connect() as connection:
            assert statics_between(connection, library, 0, LAST) == computed


def test_stored_statics_are_those_of_each_state_and_are_copied_with_it(databases: Databases) -> None:
    with writing(databases.migrated()) as engine, writing(databases.migrated()) as target:
        library = open_library(engine, LibraryInputs(PAIR, GRID, SolveOptions()))
        for index in range(GRID.orientation_count):
            chunk = prepared_chunk(GRID, index)
            write_chunk(engine, library, chunk.rows, chunk.history)
        publish(engine, library, GRID)
        copy = copy_library(engine, target, library).library_id
        with target.connect() as connection:
            states, stored = states_between(connection, copy, 0, LAST), statics_between(connection, copy, 0, LAST)
    for state, found in zip(states, stored.values(), strict=True):
        alone = statics_of(PAIR, state)
        assert found is not None
        assert (found.support_margin, found.mu_hold, found.mu_wedge) == (
            alone.support_margin,
            alone.hold.value,
            alone.wedge.value,
        )
