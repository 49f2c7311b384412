"""Workers as they are known to each other: by an id that fences and a count that says that they live."""

from __future__ import annotations

import secrets

from sqlalchemy import Connection, Engine, delete, insert, select, update

from threadstate.errors import ThreadstateError
from threadstate.jobs.tables import WORKER_ID_LENGTH, WORKER_NAME_LENGTH, job_worker


class LostLeaseError(ThreadstateError):
    """A worker was taken for dead: what it held belongs to others, and it may not publish."""


def join(engine: Engine, name: str) -> str:
    """Be known from now on, by an id that nobody has had before or will have."""
    worker_id = secrets.token_hex(WORKER_ID_LENGTH // 2)
    with engine.begin() as connection:
        connection.execute(insert(job_worker).values(id=worker_id, name=name[:WORKER_NAME_LENGTH], beat=0))
    return worker_id


def beat(engine: Engine, worker_id: str) -> None:
    """Say that one lives.

    Raises:
        LostLeaseError: too late.
    """
    with engine.begin() as connection:
        beaten = connection.execute(
            update(job_worker).where(job_worker.c.id == worker_id).values(beat=job_worker.c.beat + 1)
        )
        if beaten.rowcount == 0:
            raise _lost(worker_id)


def beats(engine: Engine) -> dict[str, int]:
    """The counts of all workers."""
    with engine.connect() as connection:
        return {row.id: row.beat for row in connection.execute(select(job_worker.c.id, job_worker.c.beat))}


def remove_silent(engine: Engine, worker_id: str, last_beat: int) -> bool:
    """Take a worker for dead unless its count has moved on: its chunks become free, and it can publish no more.

    Returns:
        Whether it was removed.
    """
    with engine.begin() as connection:
        removed = connection.execute(
            delete(job_worker).where(job_worker.c.id == worker_id, job_worker.c.beat == last_beat)
        )
        return removed.rowcount > 0


def leave(engine: Engine, worker_id: str) -> None:
    """Be gone, and leave one's chunks to others."""
    with engine.begin() as connection:
        connection.execute(delete(job_worker).where(job_worker.c.id == worker_id))


def require_alive(connection: Connection, worker_id: str) -> None:
    """Hold on to one's own row until the transaction ends: nobody can take one for dead before.

    Raises:
        LostLeaseError: somebody has.
    """
    own = select(job_worker.c.id).where(job_worker.c.id == worker_id).with_for_update(read=True, key_share=True)
    if connection.scalar(own) is None:
        raise _lost(worker_id)


def _lost(worker_id: str) -> LostLeaseError:
    return LostLeaseError(f"worker {worker_id} was silent for too long and was taken for dead")
