"""``/v1/libraries/{id}/histories/{roll}/{pitch}``: the states of an orientation at all phases, in order."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from service.accepted import header_value, prefers_csv
from service.angles import PitchPath, RollPath
from service.cache.stored import history_rows_json, undecided_phases
from service.database import ReadConnection
from service.histories.columns import csv_table, history_columns
from service.histories.schemas import HistoryColumns, HistoryFormat, HistoryRows
from service.libraries.identify import IdentifiedLibrary
from service.representation import CSV, JSON, NOT_MODIFIED, VARY_ACCEPT, json_response, representation
from service.units import UNIT_HEADER, UnitQuery
from threadstate.library.read import not_on_the_grid, states_between
from threadstate.state.document import state_document
from threadstate.units import conversion_factor

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
    states = [
        state_document(state, factor)
        for state in states_between(connection, library.id, first, first + grid.phase_count - 1)
    ]
    if chosen is HistoryFormat.CSV:
        return representation(request, csv_table(history_columns(states)), CSV, headers)
    content = {"columns": history_columns(states)} if chosen is HistoryFormat.COLUMNS else {"states": states}
    answer = {
        "library": library.id,
        "unit": shown.value,
        "roll": roll + 0.0,
        "pitch": pitch + 0.0,
        **content,
        "undecided": undecided_phases(connection, library, orientation),
    }
    return json_response(request, answer, headers)
