"""Telling what happens to a job, with the change itself: one update of the job's row, which locks it."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Connection, insert, update

from threadstate.jobs.names import EventKind, JobState
from threadstate.jobs.tables import job, job_event


def change_job(connection: Connection, job_id: int, kind: EventKind, reason: str | None = None, **changes: Any) -> None:
    """Change columns of a job, and tell it as its next event; ``reason`` belongs to both."""
    now = datetime.now(UTC)
    state = changes.get("state")
    if state is not None:
        changes |= {"state": state.value, "reason": reason, "ended_at": now if state.ended else None}
    row = connection.execute(
        update(job)
        .where(job.c.id == job_id)
        .values(event_count=job.c.event_count + 1, **changes)
        .returning(job.c.event_count, job.c.done_count)
    ).one()
    connection.execute(
        insert(job_event).values(
            job_id=job_id,
            number=row.event_count,
            kind=kind.value,
            at=now,
            done_count=row.done_count,
            reason=reason,
        )
    )


def locked_state(connection: Connection, job_id: int) -> JobState | None:
    """The state of a job, which nobody else changes before the transaction ends; None where there is no such job."""
    state = connection.scalar(job.select().with_only_columns(job.c.state).where(job.c.id == job_id).with_for_update())
    return None if state is None else JobState(state)
