"""``/v1/histories/{roll}/{pitch}/intervals``, ``.../heights``, ``.../falls`` and ``.../held``: of any orientation,
computed on request.
"""

from __future__ import annotations

from typing import Annotated

from annotated_types import Ge, Gt, Le
from fastapi import APIRouter, Depends, Query, Response
from pydantic import AllowInfNan

from service.kernels import require_kernels
from service.libraries.requested import RequestedPair
from service.network.parameters import LeastQuery
from service.network.schemas import ComputedFalls, ComputedHeights, ComputedHeld, ComputedIntervals
from service.quantities import INTEGER_TEXT, NUMBER_TEXT, UNIT_HEADER, PitchPath, RollPath, UnitQuery
from service.representation import JSON
from service.statics.parameters import FrictionsQuery, LoadQuery
from threadstate.history.falls import SNAP_PITCHES, SPAN_DEG
from threadstate.responses.documents import FallsDocument
from threadstate.responses.falls_range import (
    LARGEST_SPAN_DEG,
    LARGEST_TOLERANCE_DEG,
    MOST_STEPS,
    STEPS,
    computed_falls,
    falls_range,
    tilts_within,
)
from threadstate.responses.heights import computed_heights, heights_document
from threadstate.responses.held import held_documents
from threadstate.responses.histories import computed_history, history_document
from threadstate.units import conversion_factor

router = APIRouter(prefix="/v1/histories", tags=["histories"], dependencies=[Depends(require_kernels)])

ToleranceQuery = Annotated[
    Annotated[float, Gt(0.0), Le(LARGEST_TOLERANCE_DEG), AllowInfNan(False), NUMBER_TEXT] | None,
    Query(
        description="tolerance of roll and of pitch, either way, in degrees",
    ),
]
StepsQuery = Annotated[
    int,
    Ge(STEPS),
    Le(MOST_STEPS),
    INTEGER_TEXT,
    Query(description="number of values of each angle within the tolerance, an odd number"),
]
SpanQuery = Annotated[
    float,
    Gt(0.0),
    Le(LARGEST_SPAN_DEG),
    AllowInfNan(False),
    NUMBER_TEXT,
    Query(
        description="span of phase, in degrees, of the steepest fall",
    ),
]


@router.get("/{roll}/{pitch}/intervals", summary="The intervals of any orientation", response_model=ComputedIntervals)
def get_computed_intervals(roll: RollPath, pitch: PitchPath, asked: RequestedPair, unit: UnitQuery = None) -> Response:
    """The intervals of any roll and pitch, computed on request."""
    pair = asked.pair
    shown = unit or pair.unit
    found = computed_history(pair, roll, pitch, asked.options)
    history = history_document(found, roll, pitch, pair, conversion_factor(pair.unit, shown))
    return _computed(
        ComputedIntervals(
            designation=pair.designation, source=asked.source, library=asked.library, unit=shown, history=history
        )
    )


@router.get("/{roll}/{pitch}/heights", summary="Height against phase", response_model=ComputedHeights)
def get_computed_heights(roll: RollPath, pitch: PitchPath, asked: RequestedPair, unit: UnitQuery = None) -> Response:
    """The heights of any roll and pitch, computed on request."""
    pair = asked.pair
    shown = unit or pair.unit
    found = computed_heights(pair, roll, pitch, asked.options)
    heights = heights_document(found, roll, pitch, pair.thread_pitch, conversion_factor(pair.unit, shown))
    return _computed(
        ComputedHeights(
            designation=pair.designation, source=asked.source, library=asked.library, unit=shown, heights=heights
        )
    )


@router.get("/{roll}/{pitch}/held", summary="Where a load holds along any phase", response_model=ComputedHeld)
def get_computed_held(
    roll: RollPath,
    pitch: PitchPath,
    asked: RequestedPair,
    load: LoadQuery,
    mus: FrictionsQuery,
    unit: UnitQuery = None,
) -> Response:
    """At which phases of any roll and pitch the contacts can hold a load or wedge, at each friction.

    Lengths of the load are in `unit`.
    """
    pair = asked.pair
    factor = conversion_factor(pair.unit, unit or pair.unit)
    cells = computed_history(pair, roll, pitch, asked.options).cells
    held = held_documents(pair, asked.options, (roll, pitch), cells, load.with_lengths_over(factor), mus)
    answer = ComputedHeld(designation=pair.designation, source=asked.source, library=asked.library, held=held)
    return Response(answer.model_dump_json(), headers={"Cache-Control": "no-store"}, media_type=JSON)


@router.get("/{roll}/{pitch}/falls", summary="Falls and snap of any orientation", response_model=ComputedFalls)
def get_computed_falls(
    roll: RollPath,
    pitch: PitchPath,
    asked: RequestedPair,
    tolerance: ToleranceQuery = None,
    steps: StepsQuery = STEPS,
    span: SpanQuery = SPAN_DEG,
    least: LeastQuery = SNAP_PITCHES,
    unit: UnitQuery = None,
) -> Response:
    """Where the bolt goes down at any roll and pitch, and whether it snaps, from first contacts alone.

    With a tolerance of the two angles also the range of what `steps` by `steps` tilts within it give.
    """
    pair = asked.pair
    shown = unit or pair.unit
    factor = conversion_factor(pair.unit, shown)

    def falls(roll_deg: float, pitch_deg: float) -> FallsDocument:
        return computed_falls(pair, asked.options, roll_deg, pitch_deg, factor, span, least)

    within = None
    if tolerance is not None:
        within = falls_range(falls, roll, pitch, tolerance, tilts_within(roll, pitch, tolerance, steps))
    return _computed(
        ComputedFalls(
            designation=pair.designation,
            source=asked.source,
            library=asked.library,
            unit=shown,
            falls=falls(roll, pitch),
            range=within,
        )
    )


def _computed(answer: ComputedIntervals | ComputedHeights | ComputedFalls) -> Response:
    headers = {UNIT_HEADER: answer.unit.value, "Cache-Control": "no-store"}
    return Response(answer.model_dump_json(by_alias=True), headers=headers, media_type=JSON)
