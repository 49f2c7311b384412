"""Submitting, cancelling and reading jobs; every change of a job is recorded as its next event."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Connection, Engine, RowMapping, Select, delete, func, insert, select, update

from threadstate.errors import NotFoundError
from threadstate.jobs.model import JobEndedError, JobEvent, JobInputs, JobRecord, inputs_from_json, inputs_json, kind_of
from threadstate.jobs.names import EventKind, JobKind, JobState
from threadstate.jobs.tables import job, job_chunk, job_event
from threadstate.library.advisory_locks import WriterLock, take_lock
from threadstate.library.read import LARGEST_ID
from threadstate.library.settled_tables import settled_library
from threadstate.library.success_tables import success_map
from threadstate.library.tables import library

_PUBLISHED = (library, settled_library, success_map)
"""The tables of what jobs publish; a hash of inputs is in one of them at most."""


def submit_job(engine: Engine, inputs: JobInputs) -> JobRecord:
    """The job of these inputs: the existing one, queued again if it ended unpublished, or a new one."""
    with engine.begin() as connection:
        take_lock(connection, WriterLock.SUBMIT_JOB)
        job_id = connection.scalar(select(job.c.id).where(job.c.input_sha256 == inputs.sha256))
        if job_id is None:
            job_id = _insert_job(connection, inputs)
        elif _must_requeue(connection, job_id):
            change_job(
                connection,
                job_id,
                EventKind.QUEUED,
                state=JobState.QUEUED,
                done_count=0,
                setback_count=0,
                asked_at=datetime.now(UTC),
            )
        return job_by_id(connection, job_id)


def cancel(engine: Engine, job_id: int) -> JobRecord:
    """Cancel a job; its committed chunks stay, unpublished. Has no effect on a cancelled job.

    Raises:
        NotFoundError: the job does not exist.
        JobEndedError: the job is done or has failed.
    """
    with engine.begin() as connection:
        state = locked_state(connection, job_id)
        if state is None:
            raise NotFoundError(f"there is no job {job_id}")
        if state.ended and state is not JobState.CANCELLED:
            raise JobEndedError(f"job {job_id} is {state} and cannot be cancelled")
        if not state.ended:
            change_job(connection, job_id, EventKind.CANCELLED, state=JobState.CANCELLED)
            connection.execute(delete(job_chunk).where(job_chunk.c.job_id == job_id))
        return job_by_id(connection, job_id)


def _insert_job(connection: Connection, inputs: JobInputs) -> int:
    now = datetime.now(UTC)
    made = connection.execute(
        insert(job)
        .values(
            kind=kind_of(inputs).value,
            input_sha256=inputs.sha256,
            inputs=inputs_json(inputs),
            code_version=inputs.code_version,
            state=JobState.QUEUED.value,
            chunk_count=inputs.grid.orientation_count,
            done_count=0,
            setback_count=0,
            event_count=1,
            asked_at=now,
        )
        .returning(job.c.id)
    )
    job_id = int(made.scalar_one())
    connection.execute(
        insert(job_event).values(job_id=job_id, number=1, kind=EventKind.QUEUED.value, at=now, done_count=0)
    )
    return job_id


def _must_requeue(connection: Connection, job_id: int) -> bool:
    state = locked_state(connection, job_id)
    if state is JobState.DONE:
        return job_by_id(connection, job_id).published_id is None
    return state in (JobState.FAILED, JobState.CANCELLED)


def job_by_id(connection: Connection, job_id: int) -> JobRecord:
    """The job of that number.

    Raises:
        NotFoundError: the job does not exist.
    """
    row = None
    if job_id <= LARGEST_ID:
        row = connection.execute(_jobs().where(job.c.id == job_id)).mappings().first()
    if row is None:
        raise NotFoundError(f"there is no job {job_id}")
    return _record(row)


def jobs_before(connection: Connection, before: int, limit: int) -> list[JobRecord]:
    """At most ``limit`` jobs with ids below ``before``, the latest first."""
    query = _jobs().where(job.c.id < min(before, LARGEST_ID)).order_by(job.c.id.desc()).limit(limit)
    return [_record(row) for row in connection.execute(query).mappings()]


def events_after(connection: Connection, job_id: int, number: int) -> list[JobEvent]:
    """The events of a job after event ``number``, in order."""
    query = (
        select(job_event)
        .where(job_event.c.job_id == job_id, job_event.c.number > min(number, LARGEST_ID))
        .order_by(job_event.c.number)
    )
    return [
        JobEvent(row.number, EventKind(row.kind), row.at, row.done_count, row.reason)
        for row in connection.execute(query)
    ]


def job_counts(connection: Connection) -> dict[str, int]:
    """The number of jobs by state; states without a job are left out."""
    query = select(job.c.state, func.count()).group_by(job.c.state)
    return {row[0]: row[1] for row in connection.execute(query)}


def _jobs() -> Select[tuple[object, ...]]:
    leases = (
        select(func.count())
        .where(job_chunk.c.job_id == job.c.id, job_chunk.c.worker_id.is_not(None))
        .scalar_subquery()
        .label("lease_count")
    )
    published = func.coalesce(
        *(
            select(table.c.id)
            .where(table.c.input_sha256 == job.c.input_sha256, table.c.published_at.is_not(None))
            .scalar_subquery()
            for table in _PUBLISHED
        )
    ).label("published_id")
    return select(*job.c, leases, published)


def _record(row: RowMapping) -> JobRecord:
    return JobRecord(
        id=row["id"],
        state=JobState(row["state"]),
        reason=row["reason"],
        inputs=inputs_from_json(JobKind(row["kind"]), row["inputs"]),
        input_sha256=row["input_sha256"],
        code_version=row["code_version"],
        chunk_count=row["chunk_count"],
        done_count=row["done_count"],
        lease_count=row["lease_count"],
        published_id=row["published_id"],
        event_count=row["event_count"],
        asked_at=row["asked_at"],
        ended_at=row["ended_at"],
    )


def change_job(connection: Connection, job_id: int, kind: EventKind, reason: str | None = None, **changes: Any) -> None:
    """Update columns of a job and record the change as its next event; ``reason`` belongs to both.

    The update locks the job's row.
    """
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
    """The state of a job, its row locked until the transaction ends; None if the job does not exist."""
    state = connection.scalar(job.select().with_only_columns(job.c.state).where(job.c.id == job_id).with_for_update())
    return None if state is None else JobState(state)
