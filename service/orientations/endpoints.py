"""``/v1/libraries/{id}/orientations``."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from service.database import ReadConnection
from service.libraries.identify import IdentifiedLibrary
from service.orientations.schemas import OrientationsAnswer, orientation_document
from service.representation import NOT_MODIFIED, json_response
from service.units import UNIT_HEADER, UnitQuery
from threadstate.library.orientations import orientation_summaries
from threadstate.units import conversion_factor

router = APIRouter(prefix="/v1/libraries/{id}/orientations", tags=["states"])


@router.get("", summary="All orientations, summed up", response_model=OrientationsAnswer, responses=NOT_MODIFIED)
def list_orientations(
    request: Request, connection: ReadConnection, library: IdentifiedLibrary, unit: UnitQuery = None
) -> Response:
    """Of each orientation, over all phases: how many states of each class, and the extremes of what is measured."""
    shown = unit or library.length_unit
    factor = conversion_factor(library.length_unit, shown)
    summaries = orientation_summaries(connection, library.id)
    answer = OrientationsAnswer(
        library=library.id, unit=shown, orientations=[orientation_document(summary, factor) for summary in summaries]
    )
    return json_response(request, answer.model_dump(mode="json"), {UNIT_HEADER: shown.value})
