"""Every statement behind the list of states seeks in an index; none reads a whole table."""

from __future__ import annotations

import pytest
from sqlalchemy import Connection, Select

from service.states.query import SORTS, Place, StateFilter
from service.states.repository import place_statements
from tests.service.conftest import StoredLibrary
from threadstate.state.model import Flag, StateClass
from threadstate.thread.regions import Region

pytestmark = pytest.mark.sqlite_alone

STATE = "SEARCH state USING PRIMARY KEY (library_id=?"
POSE = "SEARCH state USING INDEX sqlite_autoindex_state_2 (library_id=? AND roll_deg=?"
PITCH = "SEARCH state USING COVERING INDEX ix_state_library_id_pitch_deg_ordinal (library_id=? AND pitch_deg=?"
PHASE = "SEARCH state USING COVERING INDEX ix_state_library_id_phase_deg_ordinal (library_id=? AND phase_deg"
CLASS = "SEARCH state USING COVERING INDEX ix_state_library_id_state_class_ordinal (library_id=? AND state_class=?"
BOLT = "SEARCH contact USING COVERING INDEX ix_contact_library_id_bolt_region_ordinal (library_id=? AND bolt_region=?"
NUT = "SEARCH contact USING COVERING INDEX ix_contact_library_id_nut_region_ordinal (library_id=? AND nut_region=?"
FLAG = "SEARCH state_flag USING COVERING INDEX sqlite_autoindex_state_flag_2 (library_id=? AND flag=?"

INDEXED_COLUMN = {
    "pitch": "pitch_deg",
    "phase": "phase_deg",
    "class": "state_class",
    "lambda": "lambda_deg",
    "mu": "mu_deg",
    "drop": "drop",
    "embedment": "embedment",
    "pivot_offset": "pivot_offset",
    "support_margin": "support_margin",
    "mu_hold": "mu_hold",
    "mu_wedge": "mu_wedge",
}


def plan(connection: Connection, statement: Select[object]) -> list[str]:
    """SQLite's plan of a statement, line by line."""
    compiled = statement.limit(101).compile(dialect=connection.dialect, compile_kwargs={"render_postcompile": True})
    parameters = tuple(compiled.params[name] for name in compiled.positiontup or ())
    return [row[3] for row in connection.exec_driver_sql(f"EXPLAIN QUERY PLAN {compiled}", parameters)]


@pytest.mark.parametrize("after", [None, Place(None, 50)])
@pytest.mark.parametrize("sort", ["roll", "-roll"])
@pytest.mark.parametrize(
    ("which", "index"),
    [
        (StateFilter(), STATE),
        (StateFilter(roll_deg=1.0), POSE),
        (StateFilter(roll_deg=1.0, pitch_deg=1.0), f"{POSE} AND pitch_deg=?"),
        (StateFilter(pitch_deg=1.0), PITCH),
        (StateFilter(phase_deg=30.0), PHASE),
        (StateFilter(state_class=StateClass.STABLE_THREE_POINT), CLASS),
        (StateFilter(bolt_region=Region.BASE), BOLT),
        (StateFilter(nut_region=Region.SURFACE), NUT),
        (StateFilter(flag=Flag.TIE), FLAG),
    ],
)
def test_filter_in_the_default_order_uses_its_index(
    connection: Connection, made_up: StoredLibrary, which: StateFilter, sort: str, after: Place | None, index: str
) -> None:
    (statement,) = place_statements(made_up.id, which, SORTS[sort], after)
    steps = plan(connection, statement)
    assert any(step.startswith(index) for step in steps), steps
    assert not any("SCAN" in step or "ORDER BY" in step for step in steps), steps


@pytest.mark.parametrize("which", [StateFilter(phase_min_deg=330.0), StateFilter(None, None, None, 30.0, 60.0)])
def test_phase_range_uses_the_index_of_the_phase(
    connection: Connection, made_up: StoredLibrary, which: StateFilter
) -> None:
    for name in ("phase", "-phase"):
        (statement,) = place_statements(made_up.id, which, SORTS[name], None)
        (step,) = plan(connection, statement)
        assert step.startswith(PHASE)


def test_pose_is_sought_as_a_whole(connection: Connection, made_up: StoredLibrary) -> None:
    (statement,) = place_statements(made_up.id, StateFilter(1.0, 1.0, 30.0), SORTS["roll"], None)
    (step,) = plan(connection, statement)
    assert step.startswith(f"{POSE} AND pitch_deg=? AND phase_deg=?")


@pytest.mark.parametrize("after", [None, Place(None, 50), Place(0.5, 50)])
@pytest.mark.parametrize("name", [name for name, sort in SORTS.items() if sort.key != "roll"])
def test_sort_walks_the_index_of_its_key(
    connection: Connection, made_up: StoredLibrary, name: str, after: Place | None
) -> None:
    index = f"SEARCH state USING COVERING INDEX ix_state_library_id_{INDEXED_COLUMN[SORTS[name].key]}_ordinal "
    for statement in place_statements(made_up.id, StateFilter(), SORTS[name], after):
        (step,) = plan(connection, statement)
        assert step.startswith(index)
