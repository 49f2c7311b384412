"""``/v1/histories/{roll}/{pitch}/intervals`` and ``.../heights``: of any orientation."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request, Response

from service.angles import PitchPath, RollPath
from service.libraries.solved_pair import LIBRARY_DESCRIPTION, SolvedPair, solved_pair
from service.network.schemas import ComputedHeights, ComputedIntervals
from service.representation import JSON
from service.units import UNIT_HEADER, UnitQuery
from threadstate.answer.heights import computed_heights, heights_document
from threadstate.answer.histories import computed_history, history_document
from threadstate.thread.catalogue import DEFAULT_DESIGNATION
from threadstate.units import conversion_factor

router = APIRouter(prefix="/v1/histories", tags=["histories"])

DesignationQuery = Annotated[
    str | None,
    Query(
        min_length=1,
        max_length=100,
        description=f"designation of the pair; {DEFAULT_DESIGNATION} where neither it nor a library is given",
    ),
]
LibraryQuery = Annotated[str | None, Query(min_length=1, max_length=100, description=LIBRARY_DESCRIPTION)]


def _solved_pair(request: Request, designation: DesignationQuery = None, library: LibraryQuery = None) -> SolvedPair:
    return solved_pair(request, designation, library)


RequestedPair = Annotated[SolvedPair, Depends(_solved_pair)]


@router.get("/{roll}/{pitch}/intervals", summary="The intervals of any orientation", response_model=ComputedIntervals)
def get_computed_intervals(roll: RollPath, pitch: PitchPath, asked: RequestedPair, unit: UnitQuery = None) -> Response:
    """As the intervals of a library's orientation, for any roll and pitch, computed now."""
    pair = asked.pair
    shown = unit or pair.unit
    found = computed_history(pair, roll, pitch, asked.options)
    history = history_document(found, roll, pitch, pair.thread_pitch, conversion_factor(pair.unit, shown))
    return _computed(
        ComputedIntervals(designation=pair.designation, library=asked.library, unit=shown, history=history)
    )


@router.get("/{roll}/{pitch}/heights", summary="Height against phase", response_model=ComputedHeights)
def get_computed_heights(roll: RollPath, pitch: PitchPath, asked: RequestedPair, unit: UnitQuery = None) -> Response:
    """As the heights of a library's orientation, for any roll and pitch, computed now."""
    pair = asked.pair
    shown = unit or pair.unit
    found = computed_heights(pair, roll, pitch, asked.options)
    heights = heights_document(found, roll, pitch, pair.thread_pitch, conversion_factor(pair.unit, shown))
    return _computed(ComputedHeights(designation=pair.designation, library=asked.library, unit=shown, heights=heights))


def _computed(answer: ComputedIntervals | ComputedHeights) -> Response:
    headers = {UNIT_HEADER: answer.unit.value, "Cache-Control": "no-store"}
    return Response(answer.model_dump_json(by_alias=True), headers=headers, media_type=JSON)
