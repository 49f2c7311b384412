"""``POST /v1/outcomes``: how the paths of many commanded poses end."""

from __future__ import annotations

import json
import math
import time
from collections import Counter
from typing import Annotated

from fastapi import APIRouter, Depends, Request, Response
from fastapi.concurrency import run_in_threadpool
from pydantic import ConfigDict, Field

from service.kernels import require_kernels, require_turning
from service.libraries.requested import AnswerOfPair, solved_pair
from service.quantities import UNIT_HEADER, UnitQuery
from service.representation import JSON
from service.settle.endpoints import device_of
from service.solve import NOT_BOTH, PoseToSolve, RequestOfPair
from service.strict_json import StrictJsonRoute
from threadstate.device.document import DeviceDocument
from threadstate.device.model import default_device
from threadstate.device.settle import LARGEST_FRICTION, check_pair
from threadstate.device.strategy import Strategy
from threadstate.success.inputs import POINT_LIMIT, POINT_LIMITS
from threadstate.success.orientation_paths import OrientationPaths
from threadstate.success.summary_document import OutcomeDocument, outcome_document
from threadstate.units import LengthUnit, conversion_factor

LARGEST_POSE_COUNT = 100
LARGEST_TIME_S = 3600.0


class OutcomesRequest(RequestOfPair):
    """Commanded poses, the device, and how that turns the bolt."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [
                {"poses": [{"roll": 1, "pitch": -2, "phase": 10}], "strategy": "cw", "device": {"unit": "mm"}}
            ],
            **NOT_BOTH,
        },
    )

    poses: Annotated[list[PoseToSolve], Field(min_length=1, max_length=LARGEST_POSE_COUNT)] = Field(
        description="the poses at which the bolt settles before it is turned"
    )
    strategy: Strategy = Field(
        default=Strategy.CCW_THEN_CW,
        strict=False,
        description="`ccw_then_cw`: counter-clockwise until the snap, then clockwise; `cw`: clockwise at once",
    )
    mu: Annotated[float, Field(ge=0.0, le=LARGEST_FRICTION, allow_inf_nan=False)] = Field(
        default=0.0, description="coefficient of friction of all contacts"
    )
    point_limit: Annotated[int, Field(ge=POINT_LIMITS[0], le=POINT_LIMITS[1])] = Field(
        default=POINT_LIMIT, description="points of a turn beyond which a path is undecided"
    )
    time_limit: Annotated[float, Field(gt=0.0, le=LARGEST_TIME_S, allow_inf_nan=False)] | None = Field(
        default=None,
        description="seconds after which paths that have not ended are undecided, bounded; without it the request is "
        "refused once the service's own limit has passed",
    )
    device: DeviceDocument | None = Field(
        default=None, description="the device; what it leaves out is as of the default one"
    )


class OutcomesAnswer(AnswerOfPair):
    """How the paths end, in the order of the poses."""

    unit: LengthUnit = Field(description="unit of all lengths in this response; torques are in N times it")
    outcomes: list[OutcomeDocument]


router = APIRouter(
    prefix="/v1/outcomes",
    tags=["success"],
    route_class=StrictJsonRoute,
    dependencies=[Depends(require_kernels), Depends(require_turning)],
)


@router.post("", summary="How the paths of held bolts end", response_model=OutcomesAnswer)
async def outcomes(request: Request, body: OutcomesRequest, unit: UnitQuery = None) -> Response:
    """How each of up to 100 paths ends, and what it asks of the device, without the paths themselves.

    They are the cells of a success map: with friction a path that comes to that of an earlier pose, with the same roll
    and pitch, goes on as that does, if that ends alike with half the step. Between two paths a request whose client is
    gone is cancelled.
    """
    device = device_of(body.device) or default_device()
    asked = await run_in_threadpool(solved_pair, request, body.designation, body.library)
    check_pair(asked.pair)
    shown = unit or asked.pair.unit
    factor = conversion_factor(asked.pair.unit, shown)
    ends_s = time.monotonic() + (math.inf if body.time_limit is None else body.time_limit)
    counts = Counter((pose.roll, pose.pitch) for pose in body.poses)
    paths = {
        tilt: OrientationPaths(asked.pair, device, body.strategy, *tilt, body.point_limit, count > 1)
        for tilt, count in counts.items()
    }
    found = [
        await run_in_threadpool(_outcome, paths[pose.roll, pose.pitch], pose, body.mu, factor, ends_s)
        for pose in body.poses
    ]
    answer = {
        "designation": asked.pair.designation,
        "source": asked.source,
        "library": asked.library,
        "unit": shown.value,
        "outcomes": found,
    }
    content = json.dumps(answer, separators=(",", ":"), allow_nan=False)
    return Response(content, headers={UNIT_HEADER: shown.value, "Cache-Control": "no-store"}, media_type=JSON)


def _outcome(paths: OrientationPaths, pose: PoseToSolve, mu: float, factor: float, ends_s: float) -> OutcomeDocument:
    """How the path from a pose ends; ``ends_s`` is when it has to, by the monotonic clock."""
    cell = paths.cell(pose.phase, mu, ends_s - time.monotonic())
    return outcome_document(pose.roll, pose.pitch, cell, factor)
