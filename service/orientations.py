"""``/v1/libraries/{id}/orientations``."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, Field

from service.database import ReadConnection
from service.libraries.requested import IdentifiedLibrary
from service.quantities import UNIT_HEADER, UnitQuery
from service.representation import NOT_MODIFIED, json_response
from threadstate.library.orientations import OrientationSummary, orientation_summaries
from threadstate.state.model import StateClass
from threadstate.units import LengthUnit, conversion_factor


class OrientationDocument(BaseModel):
    """An orientation over all phases of the grid; a length is null where none of its states has it."""

    roll: float
    pitch: float
    counts: dict[StateClass, int] = Field(description="number of its states of each class")
    drop_most: float | None = Field(description="greatest drop")
    embedment_most: float | None = Field(description="greatest embedment")
    pivot_offset_least: float | None = Field(description="least pivot offset")
    margin_least: float | None = Field(description="least distance of any of a class's numbers from its threshold")
    mu_hold_least: float | None = Field(description="least friction that holds a push at any phase")
    mu_wedge_least: float | None = Field(description="least friction at which contacts wedge at any phase")
    support_margin_most: float | None = Field(description="greatest support margin under a push")


class OrientationsAnswer(BaseModel):
    """All orientations in the order of roll and pitch."""

    library: int = Field(description="number of the library")
    unit: LengthUnit = Field(description="unit of all lengths in this response")
    orientations: list[OrientationDocument]


def orientation_document(summary: OrientationSummary, factor: float) -> OrientationDocument:
    """The document of a summary, with its lengths multiplied by ``factor``."""

    def scaled(value: float | None) -> float | None:
        return None if value is None else value * factor

    return OrientationDocument(
        roll=summary.roll_deg,
        pitch=summary.pitch_deg,
        counts=dict(summary.of_class),
        drop_most=scaled(summary.drop_most),
        embedment_most=scaled(summary.embedment_most),
        pivot_offset_least=scaled(summary.pivot_offset_least),
        margin_least=scaled(summary.margin_least),
        mu_hold_least=summary.mu_hold_least,
        mu_wedge_least=summary.mu_wedge_least,
        support_margin_most=summary.support_margin_most,
    )


router = APIRouter(prefix="/v1/libraries/{id}/orientations", tags=["states"])


@router.get("", summary="Summaries of all orientations", response_model=OrientationsAnswer, responses=NOT_MODIFIED)
def list_orientations(
    request: Request, connection: ReadConnection, library: IdentifiedLibrary, unit: UnitQuery = None
) -> Response:
    """For each orientation, over all phases: the number of states of each class, and extremes of the lengths."""
    shown = unit or library.length_unit
    factor = conversion_factor(library.length_unit, shown)
    summaries = orientation_summaries(connection, library.id)
    answer = OrientationsAnswer(
        library=library.id, unit=shown, orientations=[orientation_document(summary, factor) for summary in summaries]
    )
    return json_response(request, answer.model_dump(mode="json"), {UNIT_HEADER: shown.value})
