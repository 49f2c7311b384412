"""Reading jobs and what happened to them."""

from __future__ import annotations

from sqlalchemy import Connection, RowMapping, Select, func, select

from threadstate.errors import NotFoundError
from threadstate.jobs.inputs import inputs_from_json
from threadstate.jobs.model import JobEvent, JobRecord
from threadstate.jobs.names import EventKind, JobState
from threadstate.jobs.tables import job, job_chunk, job_event
from threadstate.library.read import LARGEST_ID
from threadstate.library.tables import library


def job_by_id(connection: Connection, job_id: int) -> JobRecord:
    """The job of that number.

    Raises:
        NotFoundError: there is none.
    """
    row = None
    if job_id <= LARGEST_ID:
        row = connection.execute(_jobs().where(job.c.id == job_id)).mappings().first()
    if row is None:
        raise NotFoundError(f"there is no job {job_id}")
    return _record(row)


def jobs_before(connection: Connection, before: int, limit: int) -> list[JobRecord]:
    """At most ``limit`` jobs with numbers below ``before``, the latest first."""
    query = _jobs().where(job.c.id < min(before, LARGEST_ID)).order_by(job.c.id.desc()).limit(limit)
    return [_record(row) for row in connection.execute(query).mappings()]


def events_after(connection: Connection, job_id: int, number: int) -> list[JobEvent]:
    """What happened to a job after the event of that number, in order."""
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
    """How many jobs there are of each state that any has."""
    query = select(job.c.state, func.count()).group_by(job.c.state)
    return {row[0]: row[1] for row in connection.execute(query)}


def _jobs() -> Select[tuple[object, ...]]:
    leases = (
        select(func.count())
        .where(job_chunk.c.job_id == job.c.id, job_chunk.c.worker_id.is_not(None))
        .scalar_subquery()
        .label("lease_count")
    )
    published = (
        select(library.c.id)
        .where(library.c.input_sha256 == job.c.input_sha256, library.c.published_at.is_not(None))
        .scalar_subquery()
        .label("library_id")
    )
    return select(*job.c, leases, published)


def _record(row: RowMapping) -> JobRecord:
    return JobRecord(
        id=row["id"],
        state=JobState(row["state"]),
        reason=row["reason"],
        inputs=inputs_from_json(row["inputs"]),
        input_sha256=row["input_sha256"],
        code_version=row["code_version"],
        chunk_count=row["chunk_count"],
        done_count=row["done_count"],
        lease_count=row["lease_count"],
        library_id=row["library_id"],
        event_count=row["event_count"],
        asked_at=row["asked_at"],
        ended_at=row["ended_at"],
    )
