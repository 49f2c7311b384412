"""``POST /v1/solve``."""

from __future__ import annotations

import json
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from service.kernels import require_kernels
from service.libraries.requested import LIBRARY_DESCRIPTION, AnswerOfPair, solved_pair
from service.quantities import UNIT_HEADER, Tilt, UnitQuery
from service.representation import JSON
from service.strict_json import StrictJsonRoute
from threadstate.state.document import StateDocument, state_document
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import DEFAULT_DESIGNATION
from threadstate.units import LengthUnit, conversion_factor

LARGEST_POSE_COUNT = 1000
LARGEST_PHASE_DEG = 36000.0

_FORBID = ConfigDict(extra="forbid", strict=True)
NOT_BOTH: dict[str, Any] = {
    "not": {
        "required": ["designation", "library"],
        "properties": {"designation": {"type": "string"}, "library": {"type": ["integer", "string"]}},
    }
}
"""Of a designation and a library; for the OpenAPI document."""


class PoseToSolve(BaseModel):
    """A pose, in degrees; any, on a library's grid or not."""

    model_config = _FORBID

    roll: Tilt
    pitch: Tilt
    phase: Annotated[float, Field(ge=-LARGEST_PHASE_DEG, le=LARGEST_PHASE_DEG, allow_inf_nan=False)]


class RequestOfPair(BaseModel):
    """The pair of a request: of a known thread, or of a library."""

    model_config = _FORBID

    designation: Annotated[str, Field(min_length=1, max_length=100)] | None = Field(
        default=None, description=f"the thread; {DEFAULT_DESIGNATION} where neither it nor a library is given"
    )
    library: Annotated[int, Field(ge=1)] | Annotated[str, Field(min_length=1, max_length=100)] | None = Field(
        default=None, description=LIBRARY_DESCRIPTION
    )


class SolveRequest(RequestOfPair):
    """Poses to be solved."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [{"poses": [{"roll": 1, "pitch": -2, "phase": 10.5}]}],
            **NOT_BOTH,
        },
    )

    poses: Annotated[list[PoseToSolve], Field(min_length=1, max_length=LARGEST_POSE_COUNT)]


class SolveAnswer(AnswerOfPair):
    """The states of the poses, in their order."""

    unit: LengthUnit = Field(description="unit of all lengths in this response")
    states: list[StateDocument]


router = APIRouter(
    prefix="/v1/solve", tags=["solve"], route_class=StrictJsonRoute, dependencies=[Depends(require_kernels)]
)


@router.post("", summary="Solve poses", response_model=SolveAnswer)
def solve(request: Request, body: SolveRequest, unit: UnitQuery = None) -> Response:
    """The states of up to 1,000 poses, on the grid of a library or not, by the exact solver and in their order."""
    asked = solved_pair(request, body.designation, body.library)
    shown = unit or asked.pair.unit
    factor = conversion_factor(asked.pair.unit, shown)
    states = solve_poses(asked.pair, [(pose.roll, pose.pitch, pose.phase) for pose in body.poses], asked.options)
    answer = {
        "designation": asked.pair.designation,
        "source": asked.source,
        "library": asked.library,
        "unit": shown.value,
        "states": [state_document(state, factor) for state in states],
    }
    content = json.dumps(answer, separators=(",", ":"), allow_nan=False)
    return Response(content, headers={UNIT_HEADER: shown.value, "Cache-Control": "no-store"}, media_type=JSON)
