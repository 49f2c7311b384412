"""The state of one pose, read from all its tables by one statement."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from operator import itemgetter
from typing import Any

from sqlalchemy import (
    Column,
    ColumnElement,
    CompoundSelect,
    Connection,
    Double,
    Integer,
    Select,
    String,
    Table,
    bindparam,
    cast,
    literal_column,
    null,
    select,
    union_all,
)

from threadstate.errors import NotFoundError, UndecidedPoseError
from threadstate.library.rows import Row, states_from_rows
from threadstate.library.tables import contact, stage_pose, state, state_flag, undecided
from threadstate.numbers import number_text
from threadstate.state.model import ContactState

_TABLES = (state, stage_pose, contact, state_flag)
_NUMBERS = ("0", "1", "2", "3")


def state_of_pose(
    connection: Connection, library_id: int, roll_deg: float, pitch_deg: float, phase_deg: float
) -> ContactState:
    """The state of a pose of the grid, angles in degrees; lengths in the library's unit.

    Raises:
        UndecidedPoseError: the library's solver method could not decide the pose.
        NotFoundError: the grid does not contain the pose.
    """
    pose = {"library": library_id, "roll": roll_deg, "pitch": pitch_deg, "phase": phase_deg}
    found = state_of_rows(connection.execute(STATE_OF_POSE, pose))
    if found is not None:
        return found
    roll, pitch, phase = map(number_text, (roll_deg, pitch_deg, phase_deg))
    place = f"library {library_id} has no state at roll {roll}, pitch {pitch}, phase {phase} deg"
    reason = connection.scalar(_at_pose(undecided, undecided.c.reason), pose)
    if reason is not None:
        raise UndecidedPoseError(f"{place}: {reason}")
    raise NotFoundError(place)


def state_of_rows(rows: Iterable[Sequence[Any]]) -> ContactState | None:
    """The state whose rows ``STATE_OF_POSE`` has given; None where there are none."""
    parts: tuple[list[Row], ...] = ([], [], [], [])
    for row in rows:
        number = row[0]
        parts[number].append(_CELLS[number](row))
    states, poses, contacts, flags = parts
    if not states:
        return None
    for part in (poses, contacts, flags):
        # Ordinal, and place within the state: the order of each table's key.
        part.sort(key=itemgetter(0, 1))
    return states_from_rows(states, poses, contacts, flags)[0]


def _at_pose(table: Table, column: Column[Any]) -> Select[Any]:
    """The value of a column of ``table`` at the pose of the parameters."""
    names = ("roll", "pitch", "phase")
    return select(column).where(
        table.c.library_id == bindparam("library"), *(table.c[f"{name}_deg"] == bindparam(name) for name in names)
    )


def _statement() -> tuple[CompoundSelect[Any], tuple[Callable[[Sequence[Any]], Row], ...]]:
    """The statement for all rows of the state at a pose, and a getter of each table's cells in such a row.

    A row begins with the index of its table in ``_TABLES``; slots of every type follow, as many as the table with the
    most columns of that type needs.
    """
    columns = [[column for column in table.c if column.name != "library_id"] for table in _TABLES]
    most = {
        kind: max(sum(isinstance(column.type, kind) for column in of_table) for of_table in columns)
        for kind in (Integer, String, Double)
    }
    ordinal = _at_pose(state, state.c.ordinal).scalar_subquery()
    selects, cells_of = [], []
    for number, table, of_table in zip(_NUMBERS, _TABLES, columns, strict=True):
        cells: list[ColumnElement[Any]] = [literal_column(number, Integer)]
        for kind, count in most.items():
            of_kind = [column for column in of_table if isinstance(column.type, kind)]
            cells += [*of_kind, *[cast(null(), kind)] * (count - len(of_kind))]
        places = {cell.name: place for place, cell in enumerate(cells) if isinstance(cell, Column)}
        cells_of.append(itemgetter(*(places[column.name] for column in of_table)))
        selects.append(select(*cells).where(table.c.library_id == bindparam("library"), table.c.ordinal == ordinal))
    return union_all(*selects), tuple(cells_of)


STATE_OF_POSE, _CELLS = _statement()
"""The statement and its parameters: ``library``, ``roll``, ``pitch`` and ``phase`` (degrees)."""
