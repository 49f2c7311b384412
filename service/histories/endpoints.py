"""``/v1/libraries/{id}/histories/{roll}/{pitch}``: the states of an orientation at all phases, in order."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response
from pydantic import BaseModel, Field

from service.cache.stored import history_rows_json, undecided_phases
from service.content_negotiation import header_value, prefers_csv
from service.database import ReadConnection
from service.libraries.requested import IdentifiedLibrary
from service.quantities import UNIT_HEADER, PitchPath, RollPath, UnitQuery
from service.representation import CSV, JSON, NOT_MODIFIED, VARY_ACCEPT, json_response, representation
from service.undecided import UndecidedPhase
from threadstate.export.column import Cell
from threadstate.export.states import STAGES, state_columns
from threadstate.library.read import not_on_the_grid
from threadstate.library.statics import library_states_between
from threadstate.state.document import StateDocument, state_document
from threadstate.statics.stored import LibraryStateDocument, library_state_document
from threadstate.units import LengthUnit, conversion_factor

Columns = Mapping[str, tuple[Cell, ...]]


def history_columns(states: Sequence[LibraryStateDocument]) -> Columns:
    """The states of an orientation as the columns that an export has of them, None where a state lacks one.

    Left out are roll and pitch, the number of contacts, and the stages and contacts that no state has.
    """
    stages = max((len(state["poses"]) for state in states), default=0)
    contacts = max((len(state["contacts"]) for state in states), default=0)
    unreached = tuple(f"pose_{stage}_" for stage in STAGES if stage > stages)
    return {
        column.name: tuple(column.cell(state) for state in states)
        for column in state_columns(contacts)
        if column.name not in ("roll", "pitch", "contacts") and not column.name.startswith(unreached)
    }


def csv_table(columns: Columns) -> bytes:
    """The columns as CSV with a header, in UTF-8; a cell that is None is empty."""
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(columns)
    writer.writerows(zip(*columns.values(), strict=True))
    return text.getvalue().encode()


class HistoryFormat(StrEnum):
    """The formats of a history: states one by one, or columns as JSON or CSV."""

    ROWS = "rows"
    COLUMNS = "columns"
    CSV = "csv"


class _History(BaseModel):
    library: int = Field(description="number of the library")
    unit: LengthUnit = Field(description="unit of all lengths in this response")
    roll: float
    pitch: float
    undecided: list[UndecidedPhase] = Field(description="the phases without a state, and why")


class HistoryRows(_History):
    """A history, state by state."""

    states: list[StateDocument]


class HistoryColumns(_History):
    """A history as columns of equal length, with the names that the CSV has in its header."""

    columns: dict[str, list[float | str | None]]


router = APIRouter(prefix="/v1/libraries/{id}/histories", tags=["histories"])

FormatQuery = Annotated[
    HistoryFormat | None,
    Query(description="default: `csv` where the `Accept` header prefers text/csv, else `rows`"),
]


@router.get(
    "/{roll}/{pitch}",
    summary="The history of an orientation",
    response_model=HistoryRows | HistoryColumns,
    responses={
        200: {"content": {"text/csv": {"schema": {"type": "string"}}}},
        **NOT_MODIFIED,
    },
)
def get_history(
    request: Request,
    connection: ReadConnection,
    library: IdentifiedLibrary,
    roll: RollPath,
    pitch: PitchPath,
    format: FormatQuery = None,  # noqa: A002 - the parameter's name in the address
    unit: UnitQuery = None,
) -> Response:
    """The states of an orientation at all phases, in order; `csv` leaves out the phases without a state."""
    grid = library.grid
    orientation = grid.orientation_index(roll, pitch)
    if orientation is None:
        raise not_on_the_grid(library, roll, pitch)
    shown = unit or library.length_unit
    headers = {UNIT_HEADER: shown.value, "Vary": VARY_ACCEPT}
    accepted = HistoryFormat.CSV if prefers_csv(header_value(request.headers.raw, b"accept")) else HistoryFormat.ROWS
    chosen = format or accepted
    if chosen is HistoryFormat.ROWS and shown is library.length_unit:
        return representation(request, history_rows_json(connection, library, orientation), JSON, headers)
    factor = conversion_factor(library.length_unit, shown)
    first = grid.first_ordinal(orientation)
    states = library_states_between(connection, library.id, first, first + grid.phase_count - 1)
    content: dict[str, object]
    if chosen is HistoryFormat.ROWS:
        content = {"states": [state_document(state, factor) for state, _ in states]}
    else:
        columns = history_columns([library_state_document(*state, factor) for state in states])
        if chosen is HistoryFormat.CSV:
            return representation(request, csv_table(columns), CSV, headers)
        content = {"columns": columns}
    answer = {
        "library": library.id,
        "unit": shown.value,
        "roll": roll + 0.0,
        "pitch": pitch + 0.0,
        **content,
        "undecided": undecided_phases(connection, library, orientation),
    }
    return json_response(request, answer, headers)
