"""``POST /v1/solve``."""

from __future__ import annotations

import json

from fastapi import APIRouter, Depends, Request, Response

from service.kernels import require_kernels
from service.libraries.solved_pair import solved_pair
from service.representation import JSON
from service.solve.schemas import SolveAnswer, SolveRequest
from service.strict_json import StrictJsonRoute
from service.units import UNIT_HEADER, UnitQuery
from threadstate.state.document import state_document
from threadstate.state.solve import solve_poses
from threadstate.units import conversion_factor

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
        "library": asked.library,
        "unit": shown.value,
        "states": [state_document(state, factor) for state in states],
    }
    content = json.dumps(answer, separators=(",", ":"), allow_nan=False)
    return Response(content, headers={UNIT_HEADER: shown.value, "Cache-Control": "no-store"}, media_type=JSON)
