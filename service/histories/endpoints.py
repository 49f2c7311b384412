"""``/v1/libraries/{id}/histories/{roll}/{pitch}``."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from service.accepted import prefers_csv
from service.angles import PitchPath, RollPath
from service.database import ReadConnection
from service.histories.columns import csv_table, history_columns
from service.histories.repository import history
from service.histories.schemas import HistoryColumns, HistoryFormat, HistoryRows
from service.libraries.identify import IdentifiedLibrary
from service.representation import CSV, NOT_MODIFIED, VARY_ACCEPT, json_response, representation
from service.units import UNIT_HEADER, UnitQuery
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
    shown = unit or library.length_unit
    factor = conversion_factor(library.length_unit, shown)
    found = history(connection, library, roll, pitch)
    states = [state_document(state, factor) for state in found.states]
    headers = {UNIT_HEADER: shown.value, "Vary": VARY_ACCEPT}
    head = {"library": library.id, "unit": shown.value, "roll": roll + 0.0, "pitch": pitch + 0.0}
    tail = {"undecided": [{"phase": pose.phase_deg, "reason": pose.reason} for pose in found.undecided]}
    accepted = HistoryFormat.CSV if prefers_csv(request.headers.get("accept", "")) else HistoryFormat.ROWS
    match format or accepted:
        case HistoryFormat.CSV:
            return representation(request, csv_table(history_columns(states)), CSV, headers)
        case HistoryFormat.COLUMNS:
            columns = {column.name: column.cells for column in history_columns(states)}
            return json_response(request, {**head, "columns": columns, **tail}, headers)
        case HistoryFormat.ROWS:
            return json_response(request, {**head, "states": states, **tail}, headers)
