"""PostgreSQL, too, can walk an index behind every order and filter; on a small table it need not choose to."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from sqlalchemy import Connection, Select

from harness.databases import Databases
from service.states.query import SORTS, Place, StateFilter
from service.states.repository import place_statements
from tests.service.conftest import store_library
from tests.service.made_up_states import made_up_states
from tests.service.test_query_plans import INDEXED_COLUMN
from threadstate.library.engine import reading, writing
from threadstate.library.grid import Grid
from threadstate.state.model import Flag, StateClass
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.regions import Region

pytestmark = pytest.mark.postgresql_alone

POSE = "uq_state_library_id_roll_deg_pitch_deg_phase_deg"


@pytest.fixture(scope="module")
def connection(databases: Databases) -> Iterator[Connection]:
    """A connection to a library on PostgreSQL that sorts and reads whole tables only where nothing else will do."""
    library = store_library(databases.migrated(), quarter_twenty_unc(), Grid(1.0, 1.0, 5.0), made_up_states)
    with writing(library.database) as engine, engine.begin() as connection:
        connection.exec_driver_sql("ANALYZE")
    with reading(library.database) as engine, engine.connect() as connection:
        for switch in ("enable_seqscan", "enable_sort", "enable_bitmapscan"):
            connection.exec_driver_sql(f"SET {switch} = off")
        yield connection


def plan(connection: Connection, statement: Select[object]) -> str:
    """PostgreSQL's plan of a statement."""
    compiled = statement.limit(101).compile(connection, compile_kwargs={"literal_binds": True})
    return "\n".join(row[0] for row in connection.exec_driver_sql(f"EXPLAIN {compiled}".replace("%", "%%")))


@pytest.mark.parametrize("begins", [True, False])
@pytest.mark.parametrize("name", [name for name, sort in SORTS.items() if sort.key in INDEXED_COLUMN])
def test_order_walks_the_index_of_its_key(connection: Connection, name: str, begins: bool) -> None:
    index = f"ix_state_library_id_{INDEXED_COLUMN[SORTS[name].key]}_ordinal"
    value = StateClass.STABLE_THREE_POINT.value if SORTS[name].key == "class" else 0.5
    for statement in place_statements(1, StateFilter(), SORTS[name], None if begins else Place(value, 50)):
        steps = plan(connection, statement)
        # The absent values are in the order of the primary key, too.
        assert index in steps or ("IS NULL" in steps and "pk_state" in steps), steps
        assert "Sort" not in steps, steps


@pytest.mark.parametrize(
    ("which", "index"),
    [
        (StateFilter(roll_deg=1.0, pitch_deg=1.0), POSE),
        (StateFilter(1.0, 1.0, 30.0), POSE),
        (StateFilter(pitch_deg=1.0), "ix_state_library_id_pitch_deg_ordinal"),
        (StateFilter(state_class=StateClass.STABLE_THREE_POINT), "ix_state_library_id_state_class_ordinal"),
        (StateFilter(bolt_region=Region.BASE), "contact"),
        (StateFilter(flag=Flag.TIE), "uq_state_flag_library_id_flag_ordinal"),
    ],
)
def test_filter_in_the_default_order_uses_its_index(connection: Connection, which: StateFilter, index: str) -> None:
    (statement,) = place_statements(1, which, SORTS["roll"], None)
    steps = plan(connection, statement)
    assert index in steps, steps
    assert "Seq Scan" not in steps, steps
