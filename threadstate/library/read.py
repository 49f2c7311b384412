"""Reading published libraries; unpublished ones are never returned."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import ColumnElement, Connection, RowMapping, Table, func, select

from threadstate.errors import NotFoundError
from threadstate.library.grid import Grid
from threadstate.library.rows import Row, states_from_rows
from threadstate.library.solver_method import SolverMethod
from threadstate.library.tables import contact, library, stage_pose, state, state_flag, undecided
from threadstate.numbers import number_text
from threadstate.state.model import ContactState, Flag, StateClass, UndecidedPose
from threadstate.units import LengthUnit

LARGEST_ID = 2**31 - 1
"""The largest value of an integer column on both databases."""


@dataclass(frozen=True)
class LibraryRecord:
    """A published library: its inputs and its counts. ``pair`` and ``options`` are JSON.

    ``state_count`` is the number of states; ``undecided_count`` more poses of the grid could not be decided.
    ``is_pinned`` is whether ``latest`` means this library although others were published later.
    """

    id: int
    designation: str
    length_unit: LengthUnit
    input_sha256: str
    content_sha256: str
    pair: str
    method: SolverMethod
    options: str
    code_version: str
    grid: Grid
    state_count: int
    undecided_count: int
    created_at: datetime
    published_at: datetime
    is_pinned: bool


@dataclass(frozen=True)
class Counts:
    """The number of states of each class and with each flag; every class and flag is included."""

    of_class: tuple[tuple[StateClass, int], ...]
    of_flag: tuple[tuple[Flag, int], ...]


def published_libraries(connection: Connection) -> list[LibraryRecord]:
    """All published libraries, the latest first."""
    query = (
        select(library)
        .where(library.c.published_at.is_not(None))
        .order_by(library.c.published_at.desc(), library.c.id.desc())
    )
    return [_record(row) for row in connection.execute(query).mappings()]


def library_by_id(connection: Connection, library_id: int) -> LibraryRecord:
    """The published library of that id.

    Raises:
        NotFoundError: no library of that id is published.
    """
    row = _published(connection, library.c.id == library_id) if library_id <= LARGEST_ID else None
    if row is None:
        raise NotFoundError(f"library {library_id} is not published here")
    return _record(row)


def library_by_input(connection: Connection, input_sha256: str) -> LibraryRecord | None:
    """The published library of these inputs; None if there is none."""
    row = _published(connection, library.c.input_sha256 == input_sha256)
    return None if row is None else _record(row)


def latest_library(
    connection: Connection, designation: str | None = None, method: SolverMethod | None = SolverMethod.EXACT
) -> LibraryRecord:
    """The pinned library, or else the one published last: of all or of one designation, by a solver method or (None) by
    any.

    Raises:
        NotFoundError: none is published.
    """
    which = [] if method is None else [library.c.method == method.value]
    if designation is not None:
        which.append(library.c.designation == designation)
    row = _published(connection, library.c.pinned_at.is_not(None), *which) or _published(connection, *which)
    if row is None:
        of = "" if designation is None else f" of {designation!r}"
        chosen = f" --method {method.value}" if method is SolverMethod.MESH else ""
        raise NotFoundError(f"no library{of} is published yet; run `threadstate rebuild{chosen}`")
    return _record(row)


def states_at(connection: Connection, library_id: int, ordinals: Sequence[int]) -> list[ContactState]:
    """The states with these ordinals, in this order; at most some hundreds.

    Raises:
        NotFoundError: a state does not exist.
    """
    states = _states(connection, library_id, lambda table: table.c.ordinal.in_(ordinals))
    if missing := [ordinal for ordinal in ordinals if ordinal not in states]:
        raise NotFoundError(f"library {library_id} has no state {missing[0]}")
    return [states[ordinal] for ordinal in ordinals]


def states_between(connection: Connection, library_id: int, first: int, last: int) -> list[ContactState]:
    """The states with ordinals ``first`` to ``last``, both included, in order; an orientation is such a range."""
    states = _states(connection, library_id, lambda table: table.c.ordinal.between(first, last))
    return list(states.values())


def rests(state_class: StateClass, embedment_margin: float | None) -> bool:
    """Whether the bolt rests in the last pose of a state (method, section 8).

    Only a stable or quasi-stable state rests whose embedment is within tolerance. The last pose of any other is where
    the procedure ended: the bolt goes on from there, or its solid is in the nut's. ``embedment_margin`` is the distance
    of the embedment from the tolerance; None: flush.
    """
    return state_class is not StateClass.UNSTABLE_TWO_POINT and (embedment_margin is None or embedment_margin >= 0.0)


def heights_between(connection: Connection, library_id: int, first: int, last: int) -> dict[int, tuple[float, float]]:
    """Heights of the bolt's origin at first contact and where it rests, of states with ordinals in that range.

    By ordinal, ``first`` and ``last`` included; in the library's unit, NaN where the bolt does not rest.
    """
    query = (
        select(state.c.ordinal, state.c.state_class, state.c.embedment_margin, stage_pose.c.tz)
        .join(stage_pose, (stage_pose.c.library_id == state.c.library_id) & (stage_pose.c.ordinal == state.c.ordinal))
        .where(state.c.library_id == library_id, state.c.ordinal.between(first, last))
        .order_by(state.c.ordinal, stage_pose.c.stage)
    )
    found: dict[int, tuple[float, float]] = {}
    for ordinal, state_class, embedment_margin, height in connection.execute(query):
        at_first = found[ordinal][0] if ordinal in found else height
        found[ordinal] = at_first, height if rests(StateClass(state_class), embedment_margin) else math.nan
    return found


def undecided_between(
    connection: Connection, library_id: int, first: int, last: int, limit: int | None = None
) -> list[tuple[int, UndecidedPose]]:
    """The undecided poses with ordinals ``first`` to ``last``, both included, with these and in order."""
    rows = _rows(connection, undecided, library_id, undecided.c.ordinal.between(first, last), limit)
    return [(ordinal, UndecidedPose(*values)) for ordinal, *values in rows]


def undecided_reasons(connection: Connection, library_id: int) -> list[tuple[str, int]]:
    """The reasons of undecided poses and their numbers, the most frequent first."""
    rows = _grouped(connection, undecided, "reason", library_id)
    return sorted(((row[0], row[1]) for row in rows), key=lambda row: (-row[1], row[0]))


def not_on_the_grid(library: LibraryRecord, roll_deg: float, pitch_deg: float) -> NotFoundError:
    """The error for an orientation (degrees) that a library's grid does not contain."""
    roll, pitch = number_text(roll_deg), number_text(pitch_deg)
    most, step = number_text(library.grid.tilt_max_deg), number_text(library.grid.tilt_step_deg)
    return NotFoundError(
        f"library {library.id} has no orientation of roll {roll}, pitch {pitch} deg; its grid: -{most} to {most} deg "
        f"in steps of {step}. Any other within 10 deg is computed from its pair: `threadstate windows` and `history`, "
        f"/v1/histories/{roll}/{pitch}/falls?library={library.id}"
    )


def counts(connection: Connection, library_id: int) -> Counts:
    """The number of states of each class and with each flag."""
    classes = {row[0]: row[1] for row in _grouped(connection, state, "state_class", library_id)}
    flags = {row[0]: row[1] for row in _grouped(connection, state_flag, "flag", library_id)}
    return Counts(
        of_class=tuple((name, classes.get(name.value, 0)) for name in StateClass),
        of_flag=tuple((name, flags.get(name.value, 0)) for name in Flag),
    )


def _grouped(connection: Connection, table: Table, column: str, library_id: int) -> list[Row]:
    query = select(table.c[column], func.count()).where(table.c.library_id == library_id).group_by(table.c[column])
    return [tuple(row) for row in connection.execute(query)]


def _published(connection: Connection, *which: ColumnElement[bool]) -> RowMapping | None:
    query = (
        select(library)
        .where(library.c.published_at.is_not(None), *which)
        .order_by(library.c.published_at.desc(), library.c.id.desc())
        .limit(1)
    )
    return connection.execute(query).mappings().first()


def _states(
    connection: Connection, library_id: int, which: Callable[[Table], ColumnElement[bool]]
) -> dict[int, ContactState]:
    states, poses, contacts, flags = (
        _rows(connection, table, library_id, which(table)) for table in (state, stage_pose, contact, state_flag)
    )
    ordinals = [row[0] for row in states]
    return dict(zip(ordinals, states_from_rows(states, poses, contacts, flags), strict=True))


def _rows(
    connection: Connection, table: Table, library_id: int, which: ColumnElement[bool], limit: int | None = None
) -> list[Row]:
    columns = [column for column in table.c if column.name != "library_id"]
    query = (
        select(*columns)
        .where(table.c.library_id == library_id, which)
        .order_by(*(column for column in table.primary_key.columns if column.name != "library_id"))
        .limit(limit)
    )
    return [tuple(row) for row in connection.execute(query)]


def _record(row: RowMapping) -> LibraryRecord:
    return LibraryRecord(
        id=row["id"],
        designation=row["designation"],
        length_unit=LengthUnit(row["length_unit"]),
        input_sha256=row["input_sha256"],
        content_sha256=row["content_sha256"],
        pair=row["pair"],
        method=SolverMethod(row["method"]),
        options=row["options"],
        code_version=row["code_version"],
        grid=Grid(row["tilt_max_deg"], row["tilt_step_deg"], row["phase_step_deg"]),
        state_count=row["state_count"] - row["undecided_count"],
        undecided_count=row["undecided_count"],
        created_at=row["created_at"],
        published_at=row["published_at"],
        is_pinned=row["pinned_at"] is not None,
    )
