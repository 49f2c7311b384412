"""Which states of a library come next under a filter and an order; every statement walks an index.

The absent values of a nullable sort key form a segment of their own before (ascending) or after (descending) the
others: in each segment the place to go on from is then a comparison of (value, ordinal), which an index can seek.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Column, ColumnElement, Connection, Select, Table, and_, or_, select, tuple_

from service.states.query import Place, Range, Sort, StateFilter
from threadstate.library.tables import contact, state, state_flag
from threadstate.state.quantities import QUANTITIES
from threadstate.statics.stored import NAMES as STATICS

_COLUMN: dict[str, Column[Any]] = {
    "roll": state.c.ordinal,
    "pitch": state.c.pitch_deg,
    "phase": state.c.phase_deg,
    "class": state.c.state_class,
    **{quantity.name: state.c[quantity.attribute] for quantity in QUANTITIES if quantity.sortable},
    **{name: state.c[name] for name in STATICS},
}


@dataclass(frozen=True)
class PlacesPage:
    """The places of one page, and whether others follow."""

    places: tuple[Place, ...]
    more: bool


def places(
    connection: Connection, library_id: int, which: StateFilter, sort: Sort, after: Place | None, limit: int
) -> PlacesPage:
    """The first ``limit`` places after ``after`` (None: from the beginning)."""
    found: list[Place] = []
    for statement in place_statements(library_id, which, sort, after):
        rows = connection.execute(statement.limit(limit + 1 - len(found)))
        found += [Place(None if sort.key == "roll" else row[0], row[1]) for row in rows]
        if len(found) > limit:
            return PlacesPage(tuple(found[:limit]), more=True)
    return PlacesPage(tuple(found), more=False)


def place_statements(library_id: int, which: StateFilter, sort: Sort, after: Place | None) -> Iterator[Select[Any]]:
    """The statements whose rows, (value, ordinal), one statement after the other are the places after ``after``."""
    column = _COLUMN[sort.key]
    segments = [False] if not column.nullable else [False, True] if sort.descending else [True, False]
    if after is not None and column.nullable:
        segments = segments[segments.index(after.value is None) :]
    for i, absent in enumerate(segments):
        yield _segment(library_id, which, sort, after if i == 0 else None, absent=absent)


def _segment(library_id: int, which: StateFilter, sort: Sort, after: Place | None, *, absent: bool) -> Select[Any]:
    column, ordinal = _COLUMN[sort.key], state.c.ordinal
    conditions = [state.c.library_id == library_id, *_conditions(library_id, which)]
    if absent:
        conditions.append(column.is_(None))
    elif column.nullable:
        conditions.append(column.is_not(None))
    keys: list[ColumnElement[Any]]
    here: Any
    there: Any
    if absent or (column is ordinal and which.roll_deg is None):
        keys, here, there = [ordinal], ordinal, after and after.ordinal
    elif column is not ordinal:
        keys, here, there = [column, ordinal], tuple_(column, ordinal), after and (after.value, after.ordinal)
    else:
        # The same order by the index that has the roll; "+ 0" keeps SQLite from seeking by the ordinal instead.
        keys = [state.c.roll_deg, state.c.pitch_deg, state.c.phase_deg]
        here, there = ordinal + 0, after and after.ordinal
    if after is not None:
        conditions.append(here < there if sort.descending else here > there)
    order = [key.desc() if sort.descending else key.asc() for key in keys]
    return select(column, ordinal).where(*conditions).order_by(*order)


def _conditions(library_id: int, which: StateFilter) -> Iterator[ColumnElement[bool]]:
    if which.roll_deg is not None:
        yield state.c.roll_deg == which.roll_deg
    if which.pitch_deg is not None:
        yield state.c.pitch_deg == which.pitch_deg
    if which.phase_deg is not None:
        yield state.c.phase_deg == which.phase_deg
    if which.phase_min_deg is not None:
        yield state.c.phase_deg >= which.phase_min_deg
    if which.phase_max_deg is not None:
        yield state.c.phase_deg <= which.phase_max_deg
    if which.state_class is not None:
        yield state.c.state_class == which.state_class.value
    if which.bolt_region is not None:
        yield _among(library_id, contact, contact.c.bolt_region == which.bolt_region.value)
    if which.nut_region is not None:
        yield _among(library_id, contact, contact.c.nut_region == which.nut_region.value)
    if which.flag is not None:
        yield _among(library_id, state_flag, state_flag.c.flag == which.flag.value)
    for name in STATICS:
        yield from _in_range(state.c[name], getattr(which, name))


def _in_range(column: Column[Any], values: Range) -> Iterator[ColumnElement[bool]]:
    """A friction that is not known to exist counts as infinite."""
    if values.least is not None:
        known = column >= values.least
        yield (
            known
            if column is state.c.support_margin
            else or_(known, and_(column.is_(None), state.c.support_margin.is_not(None)))
        )
    if values.greatest is not None:
        yield column <= values.greatest


def _among(library_id: int, table: Table, condition: ColumnElement[bool]) -> ColumnElement[bool]:
    ordinals = select(table.c.ordinal).where(table.c.library_id == library_id, condition)
    return state.c.ordinal.in_(ordinals)
