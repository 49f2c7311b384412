"""Reading published libraries of settled states; unpublished ones are never returned."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, Connection, RowMapping, Select, Table, func, select

from threadstate.device.model import Device, Outcome, SettledFlag, SettledState
from threadstate.errors import NotFoundError
from threadstate.library.grid import Grid
from threadstate.library.published import named_row, published_rows
from threadstate.library.settled_tables import (
    settled_contact,
    settled_fall,
    settled_flag,
    settled_library,
    settled_state,
)
from threadstate.numbers import number_text
from threadstate.settled.inputs import device_of
from threadstate.settled.rows import Row, states_from_rows
from threadstate.units import LengthUnit


@dataclass(frozen=True)
class SettledLibrary:
    """A published library of settled states: its inputs and its hashes. ``pair`` is JSON."""

    id: int
    designation: str
    length_unit: LengthUnit
    input_sha256: str
    content_sha256: str
    pair: str
    device: Device
    code_version: str
    grid: Grid
    created_at: datetime
    published_at: datetime


@dataclass(frozen=True)
class SettledCounts:
    """How many states have each outcome, each flag, how many contacts and how many falls.

    Every outcome and flag is included; of contacts and falls the numbers that occur, ascending.
    """

    of_outcome: tuple[tuple[Outcome, int], ...]
    of_flag: tuple[tuple[SettledFlag, int], ...]
    of_contacts: tuple[tuple[int, int], ...]
    of_falls: tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class SettledFilter:
    """Conditions that all hold for a settled state; None stands for any. Angles in degrees.

    ``contacts`` and ``falls`` are how many it has.
    """

    roll_deg: float | None = None
    pitch_deg: float | None = None
    phase_deg: float | None = None
    phase_min_deg: float | None = None
    phase_max_deg: float | None = None
    outcome: Outcome | None = None
    flag: SettledFlag | None = None
    contacts: int | None = None
    falls: int | None = None


def settled_libraries(connection: Connection) -> list[SettledLibrary]:
    """All published libraries of settled states, the latest first."""
    return [_record(row) for row in published_rows(connection, settled_library)]


def settled_library_by_input(connection: Connection, input_sha256: str) -> SettledLibrary | None:
    """The published library of these inputs; None if there is none."""
    rows = published_rows(connection, settled_library, settled_library.c.input_sha256 == input_sha256)
    return _record(rows[0]) if rows else None


def named_settled_library(connection: Connection, name: str) -> SettledLibrary:
    """The published library of a name: ``latest``, the one published last, or a number.

    Raises:
        NotFoundError: it does not exist; the message says which do.
    """
    missing = f"no library {name!r} of settled states is published"
    return _record(named_row(connection, settled_library, name, missing, "`threadstate rebuild-settled` makes one"))


def settled_counts(connection: Connection, library_id: int) -> SettledCounts:
    """How many states of a library have each outcome, flag, number of contacts and number of falls."""
    outcomes, contacts, falls = (
        _grouped(connection, settled_state, name, library_id) for name in ("outcome", "contact_count", "fall_count")
    )
    flags = _grouped(connection, settled_flag, "flag", library_id)
    return SettledCounts(
        tuple((name, outcomes.get(name.value, 0)) for name in Outcome),
        tuple((name, flags.get(name.value, 0)) for name in SettledFlag),
        tuple(sorted(contacts.items())),
        tuple(sorted(falls.items())),
    )


def settled_state_of_pose(
    connection: Connection, library: SettledLibrary, roll_deg: float, pitch_deg: float, phase_deg: float
) -> SettledState:
    """The settled state of a pose of the grid, angles in degrees; lengths in the library's unit.

    Raises:
        NotFoundError: the grid does not contain the pose.
    """
    pose = SettledFilter(roll_deg, pitch_deg, phase_deg)
    ordinals = settled_ordinals(connection, library.id, pose, -1, 1)
    if not ordinals:
        roll, pitch, phase = map(number_text, (roll_deg, pitch_deg, phase_deg))
        raise NotFoundError(
            f"library {library.id} of settled states has none at roll {roll}, pitch {pitch}, phase {phase} deg; "
            f"its grid: {library.grid}"
        )
    return settled_states_at(connection, library.id, ordinals)[0]


def settled_ordinals(
    connection: Connection, library_id: int, which: SettledFilter, after: int, limit: int
) -> list[int]:
    """The first ``limit`` ordinals above ``after`` of the states for which a filter holds, ascending."""
    return list(connection.scalars(ordinals_statement(library_id, which, after).limit(limit)))


def ordinals_statement(library_id: int, which: SettledFilter, after: int) -> Select[Any]:
    """The statement for the ordinals above ``after`` of the states for which a filter holds, ascending."""
    column = settled_state.c
    conditions = [column.library_id == library_id, column.ordinal > after, *_conditions(library_id, which)]
    return select(column.ordinal).where(*conditions).order_by(column.ordinal)


def settled_states_at(connection: Connection, library_id: int, ordinals: Sequence[int]) -> list[SettledState]:
    """The states with these ordinals, which ascend and are there; at most a thousand."""
    return _states(connection, library_id, lambda table: table.c.ordinal.in_(ordinals))


def settled_states_between(connection: Connection, library_id: int, first: int, last: int) -> list[SettledState]:
    """The states with ordinals ``first`` to ``last``, both included, in order; an orientation is such a range."""
    return _states(connection, library_id, lambda table: table.c.ordinal.between(first, last))


def _conditions(library_id: int, which: SettledFilter) -> Iterator[ColumnElement[bool]]:
    column = settled_state.c
    equal = (
        (column.roll_deg, which.roll_deg),
        (column.pitch_deg, which.pitch_deg),
        (column.phase_deg, which.phase_deg),
        (column.outcome, None if which.outcome is None else which.outcome.value),
        (column.contact_count, which.contacts),
        (column.fall_count, which.falls),
    )
    yield from (one == value for one, value in equal if value is not None)
    if which.phase_min_deg is not None:
        yield column.phase_deg >= which.phase_min_deg
    if which.phase_max_deg is not None:
        yield column.phase_deg <= which.phase_max_deg
    if which.flag is not None:
        flags = settled_flag.c
        flagged = select(flags.ordinal).where(flags.library_id == library_id, flags.flag == which.flag.value)
        yield column.ordinal.in_(flagged)


def _record(row: RowMapping) -> SettledLibrary:
    return SettledLibrary(
        id=row["id"],
        designation=row["designation"],
        length_unit=LengthUnit(row["length_unit"]),
        input_sha256=row["input_sha256"],
        content_sha256=row["content_sha256"],
        pair=row["pair"],
        device=device_of(row["device"]),
        code_version=row["code_version"],
        grid=Grid(row["tilt_max_deg"], row["tilt_step_deg"], row["phase_step_deg"]),
        created_at=row["created_at"],
        published_at=row["published_at"],
    )


def _grouped(connection: Connection, table: Table, column: str, library_id: int) -> dict[Any, int]:
    query = select(table.c[column], func.count()).where(table.c.library_id == library_id).group_by(table.c[column])
    return {row[0]: row[1] for row in connection.execute(query)}


def _states(
    connection: Connection, library_id: int, which: Callable[[Table], ColumnElement[bool]]
) -> list[SettledState]:
    states, contacts, falls, flags = (
        _rows(connection, table, library_id, which(table))
        for table in (settled_state, settled_contact, settled_fall, settled_flag)
    )
    return states_from_rows(states, contacts, falls, flags)


def _rows(connection: Connection, table: Table, library_id: int, which: ColumnElement[bool]) -> list[Row]:
    columns = [column for column in table.c if column.name != "library_id"]
    order = [column for column in table.primary_key.columns if column.name != "library_id"]
    query = select(*columns).where(table.c.library_id == library_id, which).order_by(*order)
    return [tuple(row) for row in connection.execute(query)]
