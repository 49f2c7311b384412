"""``/v1/histories/{roll}/{pitch}/intervals`` and ``.../heights``: of any orientation."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Response

from service.angles import PitchPath, RollPath
from service.network.schemas import ComputedHeights, ComputedIntervals
from service.representation import JSON
from service.units import UNIT_HEADER, UnitQuery
from threadstate.answer.heights import computed_heights, heights_document
from threadstate.answer.histories import computed_history, history_document
from threadstate.thread.catalogue import DEFAULT_DESIGNATION, pair_by_designation
from threadstate.units import conversion_factor

router = APIRouter(prefix="/v1/histories", tags=["histories"])

DesignationQuery = Annotated[str, Query(max_length=100, description="designation of the pair")]


@router.get("/{roll}/{pitch}/intervals", summary="The intervals of any orientation", response_model=ComputedIntervals)
def get_computed_intervals(
    roll: RollPath, pitch: PitchPath, designation: DesignationQuery = DEFAULT_DESIGNATION, unit: UnitQuery = None
) -> Response:
    """As the intervals of a library's orientation, for any roll and pitch, computed now."""
    pair = pair_by_designation(designation)
    shown = unit or pair.unit
    history = history_document(
        computed_history(pair, roll, pitch), roll, pitch, pair.thread_pitch, conversion_factor(pair.unit, shown)
    )
    return _computed(ComputedIntervals(designation=pair.designation, unit=shown, history=history))


@router.get("/{roll}/{pitch}/heights", summary="Height against phase", response_model=ComputedHeights)
def get_computed_heights(
    roll: RollPath, pitch: PitchPath, designation: DesignationQuery = DEFAULT_DESIGNATION, unit: UnitQuery = None
) -> Response:
    """As the heights of a library's orientation, for any roll and pitch, computed now."""
    pair = pair_by_designation(designation)
    shown = unit or pair.unit
    heights = heights_document(
        computed_heights(pair, roll, pitch), roll, pitch, pair.thread_pitch, conversion_factor(pair.unit, shown)
    )
    return _computed(ComputedHeights(designation=pair.designation, unit=shown, heights=heights))


def _computed(answer: ComputedIntervals | ComputedHeights) -> Response:
    headers = {UNIT_HEADER: answer.unit.value, "Cache-Control": "no-store"}
    return Response(answer.model_dump_json(by_alias=True), headers=headers, media_type=JSON)
