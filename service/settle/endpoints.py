"""``POST /v1/settle``."""

from __future__ import annotations

import json

from fastapi import APIRouter, Depends, Request, Response
from fastapi.concurrency import run_in_threadpool
from pydantic import ConfigDict, Field

from service.kernels import require_kernels
from service.libraries.requested import AnswerOfPair, solved_pair
from service.quantities import UNIT_HEADER, UnitQuery
from service.representation import JSON
from service.solve import NOT_BOTH, SolveRequest
from service.strict_json import StrictJsonRoute
from threadstate.device.document import DeviceDocument, SettledDocument, device_from_document, settled_document
from threadstate.device.model import Device
from threadstate.device.settle import settle_poses
from threadstate.errors import InvalidValueError
from threadstate.thread.pair import Pair
from threadstate.units import LengthUnit, conversion_factor

BATCH = 8
"""How many poses are settled before it is seen whether the request is still wanted."""


class SettleRequest(SolveRequest):
    """Poses that a device commands, and the device."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [{"device": {"unit": "mm", "push": 10}, "poses": [{"roll": 0, "pitch": 3, "phase": 250}]}],
            **NOT_BOTH,
        },
    )

    device: DeviceDocument | None = Field(
        default=None,
        description="the device; what it leaves out is as of the default one",
    )


class SettleAnswer(AnswerOfPair):
    """The settled states of the poses, in their order."""

    unit: LengthUnit = Field(description="unit of all lengths in this response")
    states: list[SettledDocument]


router = APIRouter(
    prefix="/v1/settle", tags=["settle"], route_class=StrictJsonRoute, dependencies=[Depends(require_kernels)]
)


@router.post("", summary="Where held bolts come to rest", response_model=SettleAnswer)
async def settle(request: Request, body: SettleRequest, unit: UnitQuery = None) -> Response:
    """Where a bolt comes to rest, without friction, that a compliant device holds and pushes: for up to 1,000 poses.

    A pose without a certain answer is `undecided`, with a flag that says why. Lengths of the answer are in `unit`,
    those of the device in its own.
    """
    device = device_of(body.device)
    asked = await run_in_threadpool(solved_pair, request, body.designation, body.library)
    shown = unit or asked.pair.unit
    factor = conversion_factor(asked.pair.unit, shown)
    poses = [(pose.roll, pose.pitch, pose.phase) for pose in body.poses]
    states: list[SettledDocument] = []
    for start in range(0, len(poses), BATCH):
        batch = poses[start : start + BATCH]
        # Between batches a request that has run out of time, or whose client is gone, is cancelled.
        states += await run_in_threadpool(_documents, asked.pair, batch, device, shown, factor)
    answer = {
        "designation": asked.pair.designation,
        "source": asked.source,
        "library": asked.library,
        "unit": shown.value,
        "states": states,
    }
    content = json.dumps(answer, separators=(",", ":"), allow_nan=False)
    return Response(content, headers={UNIT_HEADER: shown.value, "Cache-Control": "no-store"}, media_type=JSON)


def _documents(
    pair: Pair, poses: list[tuple[float, float, float]], device: Device | None, unit: LengthUnit, factor: float
) -> list[SettledDocument]:
    return [settled_document(state, unit, factor) for state in settle_poses(pair, poses, device)]


def device_of(given: DeviceDocument | None) -> Device | None:
    """The device of a body; None is the default one.

    Raises:
        InvalidValueError: it is not valid.
    """
    if given is None:
        return None
    try:
        return device_from_document(given.model_dump(exclude_none=True))
    except InvalidValueError as error:
        raise InvalidValueError(f"body device {error.name}", error.value, error.valid) from None
