"""``POST /v1/assemblies``."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncGenerator
from contextlib import aclosing
from functools import partial
from typing import Annotated

from fastapi import APIRouter, Depends, Request, Response
from fastapi.concurrency import run_in_threadpool
from pydantic import ConfigDict, Field
from starlette.types import Receive, Scope, Send

from service.assemblies.running import running_path
from service.content_negotiation import header_value, prefers_events
from service.event_stream import HEADERS, EventStream, comment_text, event_text
from service.kernels import require_kernels, require_turning
from service.libraries.requested import solved_pair
from service.problems import OUT_OF_TIME, problem_text
from service.quantities import UNIT_HEADER, UnitQuery
from service.representation import JSON
from service.request_scope import ABORTED
from service.settle.endpoints import device_of
from service.solve import NOT_BOTH, PoseToSolve, RequestOfPair
from service.strict_json import StrictJsonRoute
from threadstate.device.assemble import LEAST_LONGEST_STEP_DEG, assemble_pose, checked_step
from threadstate.device.assembly_document import (
    AssemblyDocument,
    AssemblyProgressDocument,
    assembly_document,
    progress_document,
)
from threadstate.device.command import LONGEST_STEP_DEG
from threadstate.device.document import DeviceDocument
from threadstate.device.model import Device
from threadstate.device.settle import LARGEST_FRICTION, check_pair
from threadstate.device.strategy import Strategy
from threadstate.device.watch import PathWatch
from threadstate.numbers import number_text
from threadstate.thread.pair import Pair
from threadstate.units import LengthUnit, conversion_factor

PROGRESS, ANSWER, PROBLEM = "progress", "answer", "problem"
"""Events of a stream: how far the path is; the whole document, or why there is none, as the last one."""
LOOKS_PER_COMMENT = 100
"""After so many looks without anything new a comment is sent, so that the connection is seen to be alive."""

_EVENT_SCHEMA = {
    "type": "object",
    "title": "One event of the stream",
    "required": ["event", "data"],
    "properties": {
        "event": {"enum": [PROGRESS, ANSWER, PROBLEM]},
        "data": {"type": "string", "contentMediaType": JSON},
    },
}
_STREAM = {"responses": {"200": {"content": {EventStream.media_type: {"schema": _EVENT_SCHEMA}}}}}


class AssemblyRequest(RequestOfPair):
    """The pose at which a bolt settles, the device, and how that turns it."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [{"pose": {"roll": 1, "pitch": -2, "phase": 10}, "strategy": "cw", "device": {"unit": "mm"}}],
            **NOT_BOTH,
        },
    )

    pose: PoseToSolve = Field(description="the pose at which the bolt settles before it is turned")
    strategy: Strategy = Field(
        default=Strategy.CCW_THEN_CW,
        strict=False,
        description="`ccw_then_cw`: counter-clockwise until the snap, then clockwise; `cw`: clockwise at once",
    )
    mu: Annotated[float, Field(ge=0.0, le=LARGEST_FRICTION, allow_inf_nan=False)] = Field(
        default=0.0, description="coefficient of friction of all contacts"
    )
    longest_step: Annotated[
        float | None, Field(ge=LEAST_LONGEST_STEP_DEG, le=LONGEST_STEP_DEG, allow_inf_nan=False)
    ] = Field(default=None, description="longest step of the phase in degrees; by default 2, with friction 1")
    confirm: bool = Field(
        default=False,
        description="whether the path is followed with half the step as well, and flagged where that changes it",
    )
    device: DeviceDocument | None = Field(
        default=None, description="the device; what it leaves out is as of the default one"
    )


class PathStream(EventStream):
    """The events of a path, which is stopped when its client is gone."""

    def __init__(self, events: AsyncGenerator[str], headers: dict[str, str]) -> None:
        super().__init__(events, headers=headers)
        self._events = events

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the events (ASGI)."""
        # Also where the client is found gone between two events.
        async with aclosing(self._events):
            await super().__call__(scope, receive, send)


router = APIRouter(
    prefix="/v1/assemblies",
    tags=["settle"],
    route_class=StrictJsonRoute,
    dependencies=[Depends(require_kernels), Depends(require_turning)],
)


@router.post(
    "", summary="How held bolts move as they are turned", response_model=AssemblyDocument, openapi_extra=_STREAM
)
async def assemble(request: Request, body: AssemblyRequest, unit: UnitQuery = None) -> Response:
    """The path of a bolt that a compliant device pushes into the nut and turns, and whether it engages.

    With `Accept: text/event-stream` events `progress` come while it is computed, each an object with `leg`, `points`,
    `phase` and new `events`; the last event is `answer`, with the same document, or a `problem`. A path whose client
    is gone is not computed any further. Lengths of the answer are in `unit`, those of the device in its own.
    """
    device = device_of(body.device)
    asked = await run_in_threadpool(solved_pair, request, body.designation, body.library)
    check_pair(asked.pair)
    checked_step(body.longest_step, body.mu, confirm=body.confirm)
    shown = unit or asked.pair.unit
    factor = conversion_factor(asked.pair.unit, shown)
    compute = partial(_document, asked.pair, body, device, shown, factor)
    if prefers_events(header_value(request.headers.raw, b"accept")):
        limit_s: int = request.app.state.time_limit_s
        return PathStream(_events(compute, factor, limit_s), {UNIT_HEADER: shown.value, **HEADERS})
    async with running_path(compute) as path:
        while not await path.has_ended():
            if await request.is_disconnected():
                return Response(status_code=ABORTED)
        content = path.task.result()
    return Response(content, headers={UNIT_HEADER: shown.value, "Cache-Control": "no-store"}, media_type=JSON)


async def _events(compute: partial[str], factor: float, limit_s: float) -> AsyncGenerator[str]:
    """The events of a path: how far it is, whenever that has changed, and its end."""
    end = asyncio.get_running_loop().time() + limit_s
    sent, last, looks = 0, None, 0
    async with running_path(compute) as path:
        has_ended = False
        while not has_ended:
            has_ended = await path.has_ended()
            progress = path.watch.progress()
            looks += 1
            if progress != last:
                yield event_text(PROGRESS, _text(progress_document(progress, sent, factor)))
                sent, last, looks = len(progress.events), progress, 0
            elif looks == LOOKS_PER_COMMENT:
                looks = 0
                yield comment_text("nothing new")
            if not has_ended and asyncio.get_running_loop().time() >= end:
                yield event_text(PROBLEM, problem_text(OUT_OF_TIME, f"no answer within {number_text(limit_s)} s"))
                return
        yield event_text(ANSWER, path.task.result())


def _document(
    pair: Pair, body: AssemblyRequest, device: Device | None, unit: LengthUnit, factor: float, watch: PathWatch
) -> str:
    pose = body.pose
    path = assemble_pose(
        pair,
        pose.roll,
        pose.pitch,
        pose.phase,
        device,
        body.strategy,
        mu=body.mu,
        longest_step=body.longest_step,
        confirm=body.confirm,
        watch=watch,
    )
    return _text(assembly_document(path, unit, factor))


def _text(document: AssemblyDocument | AssemblyProgressDocument) -> str:
    return json.dumps(document, separators=(",", ":"), allow_nan=False)
