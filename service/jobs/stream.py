"""What happens to a job as server-sent events, told as it happens."""

from __future__ import annotations

from collections.abc import AsyncIterator, Sequence

import anyio
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import StreamingResponse
from sqlalchemy import Engine

from service.edge.drain import Drain
from service.jobs.schemas import event_document
from threadstate.jobs.model import JobEvent, JobRecord
from threadstate.jobs.queue import events_after, job_by_id

POLL_S = 0.5
QUIET_POLLS = 30
"""After so many looks without anything new a comment is sent: proxies and clients see that the connection lives."""


HEADERS = {"Cache-Control": "no-store", "X-Accel-Buffering": "no"}
"""Nothing is kept on the way, and nothing held back."""


class EventStream(StreamingResponse):
    """Server-sent events."""

    media_type = "text/event-stream"


async def told(engine: Engine, job_id: int, after: int, drain: Drain) -> AsyncIterator[str]:
    """The events of a job after the one of that number, to its end or the process's: clients connect again then."""
    quiet = 0
    while True:
        job, events = await run_in_threadpool(_look, engine, job_id, after)
        for event in events:
            data = event_document(job, event).model_dump_json()
            yield f"id: {event.number}\nevent: {event.kind}\ndata: {data}\n\n"
            after = event.number
        if job.state.ended or drain.begun:
            return
        quiet = 0 if events else quiet + 1
        if quiet == QUIET_POLLS:
            quiet = 0
            yield ": nothing new\n\n"
        await anyio.sleep(POLL_S)


def _look(engine: Engine, job_id: int, after: int) -> tuple[JobRecord, Sequence[JobEvent]]:
    with engine.connect() as connection:
        return job_by_id(connection, job_id), events_after(connection, job_id, after)
