"""What workers do with jobs: open them, lease and complete chunks, publish. Every function is a transaction.

Rows are locked in one order: a job, a worker, chunks.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from sqlalchemy import ColumnElement, Connection, Engine, Select, delete, exists, func, insert, or_, select, update

from threadstate.jobs.model import JobInputs, inputs_from_json
from threadstate.jobs.names import EventKind, JobKind, JobState
from threadstate.jobs.queue import change_job, locked_state
from threadstate.jobs.stores import STORES
from threadstate.jobs.tables import job, job_chunk, job_worker
from threadstate.jobs.workers import require_alive
from threadstate.library.grid import Grid

MAX_FAILURES = 5
"""After this many failures (a computing process died, the library was removed) the job itself has failed."""


_HAS_FREE_CHUNKS = or_(
    job.c.state == JobState.QUEUED.value,
    (job.c.state == JobState.RUNNING.value)
    & exists().where(job_chunk.c.job_id == job.c.id, job_chunk.c.worker_id.is_(None)),
)
"""Whether a job is not opened yet, or has a chunk without a lease."""


def _holds_chunks_of(job_id: ColumnElement[int] | int) -> ColumnElement[bool]:
    """Whether a worker holds a chunk of a job; reads the worker's chunks, which are few, and not the job's."""
    held = exists().where(job_chunk.c.worker_id == job_worker.c.id, job_chunk.c.job_id == job_id)
    return held.correlate(job, job_worker)


_WORKER_COUNT = select(func.count()).select_from(job_worker).where(_holds_chunks_of(job.c.id)).scalar_subquery()
"""The number of workers that hold chunks of a job."""


@dataclass(frozen=True)
class NextJob:
    """A job that a worker can work on."""

    job_id: int
    inputs: JobInputs


def next_job(engine: Engine, code_versions: Collection[str]) -> NextJob | None:
    """A job of these code versions that can be opened, has a free chunk, or can be published; None if there is none.

    Of several jobs the one with the fewest workers, and of these the oldest. Two workers that ask at the same time may
    get the same one; :func:`should_switch_job` separates them.
    """
    with engine.connect() as connection:
        row = connection.execute(next_job_query(code_versions)).first()
    return None if row is None else NextJob(row.id, inputs_from_json(JobKind(row.kind), row.inputs))


def next_job_query(code_versions: Collection[str]) -> Select[tuple[int, str, str]]:
    """The statement of :func:`next_job`."""
    whole = (job.c.state == JobState.RUNNING.value) & ~exists().where(job_chunk.c.job_id == job.c.id)
    return (
        select(job.c.id, job.c.kind, job.c.inputs)
        .where(job.c.code_version.in_(code_versions), or_(_HAS_FREE_CHUNKS, whole))
        .order_by(_WORKER_COUNT, job.c.id)
        .limit(1)
    )


def should_switch_job(engine: Engine, worker_id: str, job_id: int, code_versions: Collection[str]) -> bool:
    """Whether a worker should leave its job: another one has free chunks and no worker, and this one keeps a worker.

    Of the workers of a job the one with the smallest id stays.
    """
    with engine.connect() as connection:
        return connection.scalar(switch_job_query(worker_id, job_id, code_versions)) is not None


def switch_job_query(worker_id: str, job_id: int, code_versions: Collection[str]) -> Select[tuple[int]]:
    """The statement of :func:`should_switch_job`: a job that the worker should switch to."""
    stays = exists().where(job_worker.c.id < worker_id, _holds_chunks_of(job_id))
    without_worker = _WORKER_COUNT == 0  # by NOT EXISTS PostgreSQL would read all chunks of all jobs
    return (
        select(job.c.id)
        .where(job.c.code_version.in_(code_versions), job.c.id != job_id, _HAS_FREE_CHUNKS, without_worker, stays)
        .limit(1)
    )


def all_jobs_ended(engine: Engine, code_versions: Collection[str]) -> bool:
    """Whether every job of these code versions has ended."""
    living = [state.value for state in JobState if not state.ended]
    query = select(job.c.id).where(job.c.code_version.in_(code_versions), job.c.state.in_(living)).limit(1)
    with engine.connect() as connection:
        return connection.scalar(query) is None


def open_job(engine: Engine, job_id: int, store_id: int) -> None:
    """Start a queued job with the chunks that its library or map lacks; has no effect on other jobs."""
    with engine.begin() as connection:
        if locked_state(connection, job_id) is not JobState.QUEUED:
            return
        row = connection.execute(select(job.c.kind, job.c.chunk_count).where(job.c.id == job_id)).one()
        count, committed = row.chunk_count, STORES[JobKind(row.kind)].committed(connection, store_id)
        missing = [index for index in range(count) if index not in committed]
        connection.execute(delete(job_chunk).where(job_chunk.c.job_id == job_id))
        if missing:
            connection.execute(insert(job_chunk), [{"job_id": job_id, "orientation": index} for index in missing])
        change_job(connection, job_id, EventKind.STARTED, state=JobState.RUNNING, done_count=count - len(missing))


def lease_chunks(engine: Engine, worker_id: str, job_id: int, count: int) -> Sequence[int]:
    """Lease up to ``count`` free orientations of a job to a worker.

    Rows that another worker has locked are skipped, so that workers do not wait for each other.

    Returns:
        The numbers of the orientations.

    Raises:
        LostLeaseError: the worker was considered dead.
    """
    free = (
        select(job_chunk.c.orientation)
        .where(job_chunk.c.job_id == job_id, job_chunk.c.worker_id.is_(None))
        .order_by(job_chunk.c.orientation)
        .limit(count)
        .with_for_update(skip_locked=True)
    )
    with engine.begin() as connection:
        require_alive(connection, worker_id)
        taken = connection.scalars(free).all()
        if not taken:
            return ()
        connection.execute(
            update(job_chunk)
            .where(job_chunk.c.job_id == job_id, job_chunk.c.orientation.in_(taken))
            .values(worker_id=worker_id)
        )
        return taken


def release_chunks(engine: Engine, worker_id: str) -> None:
    """Release all chunks of an idle worker.

    It has none, unless the database lost the transactions that completed them: a server with ``synchronous_commit =
    off`` that crashed, or a replica that took over. Without this an idle worker would hold such chunks for ever.
    """
    held = job_chunk.c.worker_id == worker_id
    with engine.connect() as connection:
        if connection.scalar(select(job_chunk.c.orientation).where(held).limit(1)) is None:
            return
    with engine.begin() as connection:
        connection.execute(update(job_chunk).where(held).values(worker_id=None))


def complete_chunk(engine: Engine, worker_id: str, job_id: int, orientation: int) -> bool:
    """Mark a chunk as committed to the library; it is not counted if the lease is another worker's by now.

    Returns:
        Whether the job is still running.
    """
    with engine.begin() as connection:
        if locked_state(connection, job_id) is not JobState.RUNNING:
            return False
        done = connection.execute(
            delete(job_chunk).where(
                job_chunk.c.job_id == job_id,
                job_chunk.c.orientation == orientation,
                job_chunk.c.worker_id == worker_id,
            )
        )
        if done.rowcount:
            change_job(connection, job_id, EventKind.PROGRESS, done_count=job.c.done_count + 1)
        return True


def publish_job(engine: Engine, worker_id: str, job_id: int, store_id: int, grid: Grid) -> bool:
    """Publish what a running job has computed if no chunk is missing, in one transaction with the check that the worker
    is alive.

    Returns:
        Whether this call finished the job.

    Raises:
        LostLeaseError: the worker was considered dead.
        IncompleteLibraryError: chunks are missing that the job has counted as committed.
    """
    with engine.begin() as connection:
        if locked_state(connection, job_id) is not JobState.RUNNING:
            return False
        require_alive(connection, worker_id)
        if _has_chunks(connection, job_id):
            return False
        kind = JobKind(connection.execute(select(job.c.kind).where(job.c.id == job_id)).scalar_one())
        STORES[kind].publish(connection, store_id, grid)
        change_job(connection, job_id, EventKind.PUBLISHED, state=JobState.DONE)
        return True


def requeue_job(engine: Engine, worker_id: str, job_id: int, reason: str) -> JobState | None:
    """Queue a running job again after a failure; after ``MAX_FAILURES`` of them the job has failed.

    Returns:
        Its new state; None if the job does not exist.

    Raises:
        LostLeaseError: the worker was considered dead.
    """
    with engine.begin() as connection:
        state = locked_state(connection, job_id)
        require_alive(connection, worker_id)
        if state is not JobState.RUNNING:
            return state
        count = (connection.scalar(select(job.c.setback_count).where(job.c.id == job_id)) or 0) + 1
        connection.execute(delete(job_chunk).where(job_chunk.c.job_id == job_id))
        failed = count >= MAX_FAILURES
        state, kind = (JobState.FAILED, EventKind.FAILED) if failed else (JobState.QUEUED, EventKind.QUEUED)
        change_job(connection, job_id, kind, reason, state=state, setback_count=count)
        return state


def _has_chunks(connection: Connection, job_id: int) -> bool:
    return connection.scalar(select(job_chunk.c.orientation).where(job_chunk.c.job_id == job_id).limit(1)) is not None
