"""Registered workers: an id that serves as a fencing token, and a heartbeat counter."""

from __future__ import annotations

import secrets

from sqlalchemy import Connection, Engine, delete, insert, select, update

from threadstate.errors import ThreadstateError
from threadstate.jobs.tables import WORKER_ID_LENGTH, WORKER_NAME_LENGTH, job_worker


class LostLeaseError(ThreadstateError):
    """The worker was considered dead: its chunks belong to others, and it may not publish."""


def join(engine: Engine, name: str) -> str:
    """Register a worker.

    Returns:
        Its id, random and never reused.
    """
    worker_id = secrets.token_hex(WORKER_ID_LENGTH // 2)
    with engine.begin() as connection:
        connection.execute(insert(job_worker).values(id=worker_id, name=name[:WORKER_NAME_LENGTH], beat=0))
    return worker_id


def beat(engine: Engine, worker_id: str) -> None:
    """Increment the heartbeat counter of a worker.

    Raises:
        LostLeaseError: the worker was considered dead.
    """
    with engine.begin() as connection:
        beaten = connection.execute(
            update(job_worker).where(job_worker.c.id == worker_id).values(beat=job_worker.c.beat + 1)
        )
        if beaten.rowcount == 0:
            raise _lost(worker_id)


def beats(engine: Engine) -> dict[str, int]:
    """The heartbeat counters of all workers, by id."""
    with engine.connect() as connection:
        return {row.id: row.beat for row in connection.execute(select(job_worker.c.id, job_worker.c.beat))}


def remove_dead_worker(engine: Engine, worker_id: str, last_beat: int) -> bool:
    """Remove a worker unless its counter has changed since: its chunks become free, and it can no longer publish.

    Returns:
        Whether it was removed.
    """
    with engine.begin() as connection:
        removed = connection.execute(
            delete(job_worker).where(job_worker.c.id == worker_id, job_worker.c.beat == last_beat)
        )
        return removed.rowcount > 0


def leave(engine: Engine, worker_id: str) -> None:
    """Remove a worker; its chunks become free."""
    with engine.begin() as connection:
        connection.execute(delete(job_worker).where(job_worker.c.id == worker_id))


def require_alive(connection: Connection, worker_id: str) -> None:
    """Lock the worker's row until the transaction ends, so that nobody can remove it before.

    Raises:
        LostLeaseError: the worker was removed.
    """
    own = select(job_worker.c.id).where(job_worker.c.id == worker_id).with_for_update(read=True, key_share=True)
    if connection.scalar(own) is None:
        raise _lost(worker_id)


def _lost(worker_id: str) -> LostLeaseError:
    return LostLeaseError(f"worker {worker_id} sent no heartbeat for too long and was considered dead")
