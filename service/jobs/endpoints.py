"""``/v1/jobs``, and the events of a job as server-sent events."""

from __future__ import annotations

from collections.abc import AsyncIterator, Sequence
from typing import Annotated, Any
from urllib.parse import urlencode

import anyio
from annotated_types import Ge, Le
from fastapi import APIRouter, Depends, Header, Path, Query, Request, Response
from fastapi.concurrency import run_in_threadpool
from sqlalchemy import Engine

from service.database import ReadConnection, RequestedControl, engine_of
from service.event_stream import HEADERS, EventStream, comment_text, event_text
from service.jobs.schemas import JobDocument, JobPage, JobRequest, event_document, job_document
from service.keys import require_write_key
from service.quantities import INTEGER_TEXT
from service.representation import JSON, NOT_MODIFIED, json_response
from service.request_scope import HEAD_REQUEST
from service.shutdown import Shutdown, shutdown_of
from service.strict_json import StrictJsonRoute
from threadstate.jobs.model import JobEvent, JobRecord
from threadstate.jobs.names import EventKind
from threadstate.jobs.queue import cancel, events_after, job_by_id, jobs_before, submit_job
from threadstate.library.read import LARGEST_ID

POLL_S = 0.5
POLLS_PER_COMMENT = 30
"""After this many polls without an event a comment is sent, so that proxies and clients see that the connection is
alive.
"""


async def event_stream(engine: Engine, job_id: int, after: int, shutdown: Shutdown) -> AsyncIterator[str]:
    """The events of a job after event ``after``, until the job ends or the process shuts down, after which clients
    reconnect.
    """
    idle_polls = 0
    while True:
        job, events = await run_in_threadpool(_poll, engine, job_id, after)
        for event in events:
            data = event_document(job, event).model_dump_json()
            yield f"id: {event.number}\n" + event_text(event.kind, data)
            after = event.number
        if job.state.ended or shutdown.started:
            return
        idle_polls = 0 if events else idle_polls + 1
        if idle_polls == POLLS_PER_COMMENT:
            idle_polls = 0
            yield comment_text("nothing new")
        await anyio.sleep(POLL_S)


def _poll(engine: Engine, job_id: int, after: int) -> tuple[JobRecord, Sequence[JobEvent]]:
    with engine.connect() as connection:
        return job_by_id(connection, job_id), events_after(connection, job_id, after)


router = APIRouter(prefix="/v1/jobs", tags=["jobs"], route_class=StrictJsonRoute)

LARGEST_LIMIT = 100

JobId = Annotated[
    int, Ge(1), Le(LARGEST_ID), INTEGER_TEXT, Path(alias="id", description="number of the job", examples=[1])
]
LimitQuery = Annotated[
    int, Ge(1), Le(LARGEST_LIMIT), INTEGER_TEXT, Query(description="how many jobs a page has at most")
]
BeforeQuery = Annotated[
    int, Ge(1), Le(LARGEST_ID), INTEGER_TEXT, Query(description="from the `next` link of the page before")
]
LastEventHeader = Annotated[
    int,
    Ge(0),
    Le(LARGEST_ID),
    INTEGER_TEXT,
    Header(alias="Last-Event-ID", description="number of the last event that was received"),
]

ACCEPTED: dict[int | str, dict[str, Any]] = {
    200: {"description": "It is published already"},
    202: {"model": JobDocument, "description": "It is queued or running; `Location` is its address"},
}
_ALL_SENT: dict[int | str, dict[str, Any]] = {
    204: {"description": "The job has ended, and all of it has been received: do not connect again"}
}
_EVENT_SCHEMA = {
    "type": "object",
    "title": "One event of the stream",
    "required": ["id", "event", "data"],
    "properties": {
        "id": {"type": "string", "pattern": "^[1-9][0-9]*$"},
        "event": {"enum": list(EventKind)},
        "data": {"type": "string", "contentMediaType": JSON},
    },
}
_EVENT_DESCRIPTION = {"responses": {"200": {"content": {EventStream.media_type: {"schema": _EVENT_SCHEMA}}}}}


@router.post(
    "",
    summary="Request a library",
    response_model=JobDocument,
    responses=ACCEPTED,
    dependencies=[Depends(require_write_key)],
)
def post_job(engine: RequestedControl, body: JobRequest) -> Response:
    """Have a library computed. The same inputs are the same job; one that failed or was cancelled is queued again."""
    job = submit_job(engine, body.inputs())
    return job_response(job, 200 if job.state.ended else 202)


@router.get("", summary="All jobs", response_model=JobPage, responses=NOT_MODIFIED)
def list_jobs(
    request: Request, connection: ReadConnection, limit: LimitQuery = 50, before: BeforeQuery = LARGEST_ID
) -> Response:
    """The jobs, the latest first, page by page."""
    found = jobs_before(connection, before, limit + 1)
    following, headers = None, {}
    if len(found) > limit:
        query = urlencode({**request.query_params, "before": found[limit - 1].id})
        following = f"{request.scope.get('root_path', '')}/v1/jobs?{query}"
        headers["Link"] = f'<{following}>; rel="next"'
    page = JobPage(jobs=[job_document(job) for job in found[:limit]], next=following)
    return json_response(request, page.model_dump(mode="json"), headers)


@router.get("/{id}", summary="One job", response_model=JobDocument, responses=NOT_MODIFIED)
def get_job(request: Request, connection: ReadConnection, job_id: JobId) -> Response:
    """The progress of a job, and the address of its result once that is published."""
    return json_response(request, job_document(job_by_id(connection, job_id)).model_dump(mode="json"))


@router.get(
    "/{id}/events",
    summary="Events of a job",
    response_class=EventStream,
    responses=_ALL_SENT,
    openapi_extra=_EVENT_DESCRIPTION,
)
def get_events(request: Request, job_id: JobId, last_event_id: LastEventHeader = 0) -> Response:
    """Server-sent events: those that have happened, and those that happen until the job ends.

    Each has a number, as `id`, a kind, as `event`, and as `data` an object with `job`, `kind`, `at`, `committed`,
    `chunks` and `reason`. A client that reconnects with `Last-Event-ID` receives what it has missed.
    """
    engine = engine_of(request)
    # Not the request's connection, which would be held as long as the stream is open.
    with engine.connect() as connection:
        job = job_by_id(connection, job_id)
    if job.state.ended and last_event_id >= job.event_count:
        return Response(status_code=204, headers={"Cache-Control": "no-store"})
    if request.scope.get(HEAD_REQUEST):
        return Response(media_type=EventStream.media_type, headers=HEADERS)
    return EventStream(event_stream(engine, job_id, last_event_id, shutdown_of(request)), headers=HEADERS)


@router.delete("/{id}", summary="Cancel a job", response_model=JobDocument, dependencies=[Depends(require_write_key)])
def delete_job(engine: RequestedControl, job_id: JobId) -> Response:
    """Cancel a job that has not ended. Its computed chunks stay, unpublished, for the next request of the same
    inputs.
    """
    return job_response(cancel(engine, job_id), 200)


def job_response(job: JobRecord, status: int) -> Response:
    """The response with the document of a job; ``Location`` is its address."""
    headers = {"Location": f"/v1/jobs/{job.id}", "Cache-Control": "no-store"}
    return Response(job_document(job).model_dump_json(), status, headers, JSON)
