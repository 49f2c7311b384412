"""A library's rows in order, a batch at a time; each batch is read in its own transaction.

Readers in between see no lock, and the database may change: a published library does not change. One that is removed
meanwhile is noticed, as the library is checked after the last batch.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Generic, TypeVar

from sqlalchemy import Connection, Engine, Table, and_, func, select

from threadstate.errors import NotFoundError
from threadstate.export.column import Cell, Column, row_of
from threadstate.export.intervals import LEAST_LABELS, IntervalRow, Labels, interval_columns
from threadstate.export.names import TableName
from threadstate.export.states import LEAST_CONTACTS, UNDECIDED_COLUMNS, state_columns
from threadstate.library.history_tables import formation, formation_contact, history_boundary, history_interval
from threadstate.library.read import LibraryRecord, library_by_id, undecided_between
from threadstate.library.statics import library_states_between
from threadstate.library.tables import contact
from threadstate.state.model import UndecidedPose
from threadstate.statics.stored import LibraryStateDocument, library_state_document

STATES_AT_ONCE = 512
ORIENTATIONS_AT_ONCE = 16
"""An orientation has some forty intervals."""

Source = TypeVar("Source")
Rows = list[tuple[Cell, ...]]


@dataclass(frozen=True)
class ExportedTable(Generic[Source]):
    """A table as columns, and its rows in batches.

    Attributes:
        columns: in order; which there are depends on the library, as its contacts lie side by side.
        batches: rows; can be walked once.
    """

    columns: tuple[Column[Source], ...]
    batches: Iterator[Rows]


def exported_table(
    engine: Engine, library: LibraryRecord, table: TableName, factor: float
) -> ExportedTable[LibraryStateDocument] | ExportedTable[IntervalRow] | ExportedTable[UndecidedPose]:
    """A table of a published library, its lengths multiplied by ``factor``.

    Iterating over the batches raises NotFoundError where the library is removed meanwhile.
    """
    match table:
        case TableName.STATES:
            columns = state_columns(max(LEAST_CONTACTS, _most_contacts(engine, contact, library.id)))
            return ExportedTable(columns, _state_batches(engine, library, columns, factor))
        case TableName.INTERVALS:
            labels = interval_columns(max(LEAST_LABELS, _most_contacts(engine, formation_contact, library.id)))
            return ExportedTable(labels, _interval_batches(engine, library, labels, factor))
        case TableName.UNDECIDED:
            return ExportedTable(UNDECIDED_COLUMNS, _undecided_batches(engine, library))


def _most_contacts(engine: Engine, table: Table, library_id: int) -> int:
    query = select(func.max(table.c.position)).where(table.c.library_id == library_id)
    with engine.connect() as connection:
        last: int | None = connection.execute(query).scalar()
    return 0 if last is None else last + 1


def _state_batches(
    engine: Engine, library: LibraryRecord, columns: tuple[Column[LibraryStateDocument], ...], factor: float
) -> Iterator[Rows]:
    for first in range(0, library.grid.pose_count, STATES_AT_ONCE):
        with engine.connect() as connection:
            states = library_states_between(connection, library.id, first, first + STATES_AT_ONCE - 1)
        yield [row_of(columns, library_state_document(state, statics, factor)) for state, statics in states]
    _check_still_there(engine, library)


def _undecided_batches(engine: Engine, library: LibraryRecord) -> Iterator[Rows]:
    after, found = -1, True
    while found:
        with engine.connect() as connection:
            poses = undecided_between(connection, library.id, after + 1, library.grid.pose_count, STATES_AT_ONCE)
        found = bool(poses)
        if found:
            after = poses[-1][0]
            yield [row_of(UNDECIDED_COLUMNS, pose) for _, pose in poses]
    _check_still_there(engine, library)


def _interval_batches(
    engine: Engine, library: LibraryRecord, columns: tuple[Column[IntervalRow], ...], factor: float
) -> Iterator[Rows]:
    with engine.connect() as connection:
        labels = _labels(connection, library.id)
    for first in range(0, library.grid.orientation_count, ORIENTATIONS_AT_ONCE):
        with engine.connect() as connection:
            rows = _intervals(connection, library, first, first + ORIENTATIONS_AT_ONCE - 1, labels, factor)
        yield [row_of(columns, row) for row in rows]
    _check_still_there(engine, library)


def _check_still_there(engine: Engine, library: LibraryRecord) -> None:
    with engine.connect() as connection:
        if library_by_id(connection, library.id) != library:
            raise NotFoundError(f"library {library.id} has been replaced by another one while it was read")


def _labels(connection: Connection, library_id: int) -> dict[str, tuple[Labels, ...]]:
    """The contacts of every formation of a library, by its key."""
    query = (
        select(*list(formation_contact.c)[1:])
        .where(formation_contact.c.library_id == library_id)
        .order_by(*formation_contact.primary_key.columns)
    )
    found: defaultdict[str, list[Labels]] = defaultdict(list)
    for key, _, *labels in connection.execute(query):
        found[key].append(Labels(*labels))
    return {key: tuple(labels) for key, labels in found.items()}


def _intervals(
    connection: Connection,
    library: LibraryRecord,
    first: int,
    last: int,
    labels: dict[str, tuple[Labels, ...]],
    factor: float,
) -> list[IntervalRow]:
    """The intervals of the orientations ``first`` to ``last``, both included, in order."""
    at, begins = history_interval.c, history_boundary.c
    same_place = [begins[name] == at[name] for name in ("library_id", "orientation", "position")]
    query = (
        select(history_interval, history_boundary, formation.c.state_class)
        .join(history_boundary, and_(*same_place), isouter=True)
        .join(formation, and_(formation.c.library_id == at.library_id, formation.c.formation == at.formation))
        .where(at.library_id == library.id, at.orientation.between(first, last))
        .order_by(at.orientation, at.position)
    )

    def scaled(value: float | None) -> float | None:
        return None if value is None else value * factor + 0.0

    tilts_deg = library.grid.tilts_deg
    found = []
    for row in connection.execute(query).mappings():
        i_roll, i_pitch = divmod(row[at.orientation], len(tilts_deg))
        found.append(
            IntervalRow(
                roll_deg=tilts_deg[i_roll] + 0.0,
                pitch_deg=tilts_deg[i_pitch] + 0.0,
                position=row[at.position],
                start_deg=row[at.start_deg],
                end_deg=row[at.end_deg],
                in_window=row[at.in_window],
                flags=row[at.flags],
                margin=scaled(row[at.margin]),
                first_height=scaled(row[at.first_height]),
                last_height=scaled(row[at.last_height]),
                formation=row[at.formation],
                state_class=row[formation.c.state_class],
                contacts=labels.get(row[at.formation], ()),
                low_deg=row[begins.low_deg],
                high_deg=row[begins.high_deg],
                flags_between=row[begins.flags_between],
                first_height_before=scaled(row[begins.first_height_before]),
                first_height_after=scaled(row[begins.first_height_after]),
                last_height_before=scaled(row[begins.last_height_before]),
                last_height_after=scaled(row[begins.last_height_after]),
            )
        )
    return found
