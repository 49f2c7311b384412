"""Asking for a library, and taking that back."""

from __future__ import annotations

from datetime import UTC, datetime

from sqlalchemy import Connection, Engine, delete, insert, select

from threadstate.errors import NotFoundError
from threadstate.jobs.events import change_job, locked_state
from threadstate.jobs.inputs import inputs_json
from threadstate.jobs.model import JobEndedError, JobRecord
from threadstate.jobs.names import EventKind, JobState
from threadstate.jobs.read import job_by_id
from threadstate.jobs.tables import job, job_chunk, job_event
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import library_by_input
from threadstate.library.turns import Turn, take_turn


def ask_for(engine: Engine, inputs: LibraryInputs) -> JobRecord:
    """The job of these inputs: the one that there is, begun again if it ended without a library, else a new one."""
    with engine.begin() as connection:
        take_turn(connection, Turn.ASK)
        job_id = connection.scalar(select(job.c.id).where(job.c.input_sha256 == inputs.sha256))
        if job_id is None:
            job_id = _new(connection, inputs)
        elif _is_to_begin_again(connection, job_id, inputs):
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
    """Cancel a job; what is computed of it stays, unpublished. One that is cancelled already stays so.

    Raises:
        NotFoundError: there is no such job.
        JobEndedError: it is done or has failed.
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


def _new(connection: Connection, inputs: LibraryInputs) -> int:
    now = datetime.now(UTC)
    made = connection.execute(
        insert(job)
        .values(
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


def _is_to_begin_again(connection: Connection, job_id: int, inputs: LibraryInputs) -> bool:
    state = locked_state(connection, job_id)
    if state is JobState.DONE:
        return library_by_input(connection, inputs.sha256) is None
    return state in (JobState.FAILED, JobState.CANCELLED)
