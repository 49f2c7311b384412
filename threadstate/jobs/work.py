"""Working on jobs: opening them, taking their chunks, handing these in, publishing. Every function is a transaction.

Rows are locked in one order: a job, a worker, chunks.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from sqlalchemy import ColumnElement, Connection, Engine, Select, delete, exists, func, insert, or_, select, update

from threadstate.jobs.events import change_job, locked_state
from threadstate.jobs.inputs import inputs_from_json
from threadstate.jobs.names import EventKind, JobState
from threadstate.jobs.tables import job, job_chunk, job_worker
from threadstate.jobs.workers import require_alive
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.tables import chunk
from threadstate.library.write import publish_in

MOST_SETBACKS = 5
"""After so many mishaps (a computing process that died, a library that went away) a job has failed."""


_HAS_FREE_CHUNKS = or_(
    job.c.state == JobState.QUEUED.value,
    (job.c.state == JobState.RUNNING.value)
    & exists().where(job_chunk.c.job_id == job.c.id, job_chunk.c.worker_id.is_(None)),
)
"""Whether a job is still to be opened, or has a chunk that no worker is at."""


def _is_at(job_id: ColumnElement[int] | int) -> ColumnElement[bool]:
    """Whether a worker holds a chunk of a job: by its few chunks, as a job may have very many."""
    held = exists().where(job_chunk.c.worker_id == job_worker.c.id, job_chunk.c.job_id == job_id)
    return held.correlate(job, job_worker)


_WORKER_COUNT = select(func.count()).select_from(job_worker).where(_is_at(job.c.id)).scalar_subquery()
"""How many workers are at a job."""


@dataclass(frozen=True)
class Work:
    """A job that there is something to do on."""

    job_id: int
    inputs: LibraryInputs


def next_work(engine: Engine, code_versions: Collection[str]) -> Work | None:
    """A job of these versions of the code that is to be opened, has a free chunk, or can be published.

    Of several the one that the fewest workers are at, and of these the oldest. Two workers that ask at the same moment
    may be given the same one; :func:`is_needed_elsewhere` parts them.
    """
    with engine.connect() as connection:
        row = connection.execute(next_work_query(code_versions)).first()
    return None if row is None else Work(row.id, inputs_from_json(row.inputs))


def next_work_query(code_versions: Collection[str]) -> Select[tuple[int, str]]:
    """The statement of :func:`next_work`."""
    whole = (job.c.state == JobState.RUNNING.value) & ~exists().where(job_chunk.c.job_id == job.c.id)
    return (
        select(job.c.id, job.c.inputs)
        .where(job.c.code_version.in_(code_versions), or_(_HAS_FREE_CHUNKS, whole))
        .order_by(_WORKER_COUNT, job.c.id)
        .limit(1)
    )


def is_needed_elsewhere(engine: Engine, worker_id: str, job_id: int, code_versions: Collection[str]) -> bool:
    """Whether a worker should leave its job: nobody is at another one that has free chunks, and somebody stays here.

    Of the workers of a job the one with the smallest id stays.
    """
    with engine.connect() as connection:
        return connection.scalar(needed_elsewhere_query(worker_id, job_id, code_versions)) is not None


def needed_elsewhere_query(worker_id: str, job_id: int, code_versions: Collection[str]) -> Select[tuple[int]]:
    """The statement of :func:`is_needed_elsewhere`: a job that a worker should leave its own for."""
    stays = exists().where(job_worker.c.id < worker_id, _is_at(job_id))
    nobody = _WORKER_COUNT == 0  # by NOT EXISTS PostgreSQL would read all chunks of all jobs
    return (
        select(job.c.id)
        .where(job.c.code_version.in_(code_versions), job.c.id != job_id, _HAS_FREE_CHUNKS, nobody, stays)
        .limit(1)
    )


def has_ended(engine: Engine, code_versions: Collection[str]) -> bool:
    """Whether every job of these versions of the code has ended."""
    living = [state.value for state in JobState if not state.ended]
    query = select(job.c.id).where(job.c.code_version.in_(code_versions), job.c.state.in_(living)).limit(1)
    with engine.connect() as connection:
        return connection.scalar(query) is None


def open_job(engine: Engine, job_id: int, library_id: int) -> None:
    """Begin a queued job with the chunks that its library has not; any other is left as it is."""
    with engine.begin() as connection:
        if locked_state(connection, job_id) is not JobState.QUEUED:
            return
        count = connection.scalar(select(job.c.chunk_count).where(job.c.id == job_id)) or 0
        committed = set(connection.scalars(select(chunk.c.orientation).where(chunk.c.library_id == library_id)))
        missing = [index for index in range(count) if index not in committed]
        connection.execute(delete(job_chunk).where(job_chunk.c.job_id == job_id))
        if missing:
            connection.execute(insert(job_chunk), [{"job_id": job_id, "orientation": index} for index in missing])
        change_job(connection, job_id, EventKind.STARTED, state=JobState.RUNNING, done_count=count - len(missing))


def take_chunks(engine: Engine, worker_id: str, job_id: int, count: int) -> Sequence[int]:
    """The numbers of up to ``count`` free orientations of a job, which are this worker's from now on.

    Workers do not wait for each other here: what another is about to take is passed over.

    Raises:
        LostLeaseError: the worker was taken for dead.
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


def let_go(engine: Engine, worker_id: str) -> None:
    """Free what a worker holds although it is at nothing: what it handed in, and the database has forgotten since.

    A server that confirms before it has written (``synchronous_commit = off``), or a copy of it that takes over, may
    lose the last transactions; the worker lives on and would hold these chunks for ever.
    """
    held = job_chunk.c.worker_id == worker_id
    with engine.connect() as connection:
        if connection.scalar(select(job_chunk.c.orientation).where(held).limit(1)) is None:
            return
    with engine.begin() as connection:
        connection.execute(update(job_chunk).where(held).values(worker_id=None))


def hand_in(engine: Engine, worker_id: str, job_id: int, orientation: int) -> bool:
    """Say that a chunk is committed to the library; nothing is counted where it is another's by now.

    Returns:
        Whether the job is still to be worked on.
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


def publish_job(engine: Engine, worker_id: str, job_id: int, library_id: int, grid: Grid) -> bool:
    """Publish a running job's library if no chunk is missing; in one transaction with the proof that one may.

    Returns:
        Whether the job is done by this.

    Raises:
        LostLeaseError: the worker was taken for dead.
        IncompleteLibraryError: the library lacks chunks that the job took for committed.
    """
    with engine.begin() as connection:
        if locked_state(connection, job_id) is not JobState.RUNNING:
            return False
        require_alive(connection, worker_id)
        if _has_chunks(connection, job_id):
            return False
        publish_in(connection, library_id, grid)
        change_job(connection, job_id, EventKind.PUBLISHED, state=JobState.DONE)
        return True


def set_back(engine: Engine, worker_id: str, job_id: int, reason: str) -> JobState | None:
    """Queue a running job again after a mishap; after too many of them it has failed.

    Returns:
        Its state then; None where there is no such job.

    Raises:
        LostLeaseError: the worker was taken for dead.
    """
    with engine.begin() as connection:
        state = locked_state(connection, job_id)
        require_alive(connection, worker_id)
        if state is not JobState.RUNNING:
            return state
        count = (connection.scalar(select(job.c.setback_count).where(job.c.id == job_id)) or 0) + 1
        connection.execute(delete(job_chunk).where(job_chunk.c.job_id == job_id))
        failed = count >= MOST_SETBACKS
        state, kind = (JobState.FAILED, EventKind.FAILED) if failed else (JobState.QUEUED, EventKind.QUEUED)
        change_job(connection, job_id, kind, reason, state=state, setback_count=count)
        return state


def _has_chunks(connection: Connection, job_id: int) -> bool:
    return connection.scalar(select(job_chunk.c.orientation).where(job_chunk.c.job_id == job_id).limit(1)) is not None
