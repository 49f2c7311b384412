"""The worker's loop: registers, works on one job after another, and starts again after a failure."""

from __future__ import annotations

import os
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from sqlalchemy import Engine
from sqlalchemy.exc import IntegrityError, SQLAlchemyError

from threadstate.jobs.model import code_versions, kind_of
from threadstate.jobs.stores import STORES
from threadstate.jobs.work import (
    NextJob,
    all_jobs_ended,
    complete_chunk,
    lease_chunks,
    next_job,
    open_job,
    publish_job,
    release_chunks,
    requeue_job,
    should_switch_job,
)
from threadstate.jobs.workers import LostLeaseError, join, leave
from threadstate.library.write import IncompleteLibraryError
from worker.chunk_source import chunk_source
from worker.cluster.errors import ClusterError
from worker.commit import commit_chunk, orientation_of
from worker.interruption import waiting
from worker.jobs.heartbeat import Heartbeat, heartbeat
from worker.output import print_status
from worker.processes import ComputeError

POLL_S = 1.0
RETRY_S = 2.0
"""How long a worker waits after the database, or the cluster, failed."""


@dataclass(frozen=True)
class WorkerOptions:
    """Options of a worker.

    Attributes:
        processes: number of computing processes.
        scheduler: address of the Dask cluster that computes instead; None: local processes compute.
        lease_s: seconds without a heartbeat after which another worker is considered dead.
        heartbeat_file: file that is touched with every heartbeat; None for no file.
    """

    processes: int
    scheduler: str | None
    lease_s: float
    heartbeat_file: Path | None


@dataclass(frozen=True)
class _Session:
    """A registered worker."""

    engine: Engine
    worker_id: str
    heartbeat: Heartbeat
    options: WorkerOptions


def serve_jobs(engine: Engine, options: WorkerOptions, *, until_idle: bool) -> None:
    """Work on jobs until interrupted or (``until_idle``) until all have ended."""
    while True:
        try:
            with _joined(engine, options) as session:
                _work(session, until_idle=until_idle)
                return
        except LostLeaseError as error:
            print_status(f"{error}; it registers again")
        except ClusterError as error:
            print_status(f"the cluster failed, retrying: {error}")
            _wait(RETRY_S)
        except SQLAlchemyError as error:
            reason = " ".join(str(getattr(error, "orig", None) or error).split())
            print_status(f"the database failed, retrying: {reason}")
            _wait(RETRY_S)


@contextmanager
def _joined(engine: Engine, options: WorkerOptions) -> Iterator[_Session]:
    worker_id = join(engine, f"{socket.gethostname()}:{os.getpid()}")
    try:
        with heartbeat(engine, worker_id, options.lease_s, options.heartbeat_file) as beats:
            yield _Session(engine, worker_id, beats, options)
    finally:
        # If this fails the other workers detect the missing heartbeat.
        with suppress(SQLAlchemyError):
            leave(engine, worker_id)


def _work(session: _Session, *, until_idle: bool) -> None:
    versions = code_versions()
    while True:
        session.heartbeat.check()
        job = next_job(session.engine, versions)
        if job is not None:
            _work_on(session, job)
        elif until_idle and all_jobs_ended(session.engine, versions):
            return
        else:
            release_chunks(session.engine, session.worker_id)
            _wait(POLL_S)


def _wait(seconds: float) -> None:
    with waiting():
        time.sleep(seconds)


def _work_on(session: _Session, job: NextJob) -> None:
    engine, job_id, grid = session.engine, job.job_id, job.inputs.grid
    store = STORES[kind_of(job.inputs)]
    store_id = store.open(engine, job.inputs)
    open_job(engine, job_id, store_id)
    try:
        _compute(session, job, store_id)
        if publish_job(engine, session.worker_id, job_id, store_id, grid):
            print_status(f"job {job_id}: {kind_of(job.inputs).words} {store_id} is published")
    except (ComputeError, IncompleteLibraryError, IntegrityError) as error:
        reason = " ".join(str(getattr(error, "orig", None) or error).split())
        state = requeue_job(engine, session.worker_id, job_id, reason)
        print_status(f"job {job_id} is {state} after a failure: {reason}")


def _compute(session: _Session, job: NextJob, store_id: int) -> None:
    """Compute chunks of a job until none is free, the job is not running, or the worker should switch to another
    job.
    """
    taken = _leased(session, job)
    first = next(taken, None)
    if first is None:
        return
    print_status(f"job {job.job_id}: chunks of {kind_of(job.inputs).words} {store_id}")
    processes = min(session.options.processes, job.inputs.grid.orientation_count)
    with chunk_source(job.inputs, processes, session.options.scheduler) as computing:
        for chunk in computing.chunks(chain([first], taken), lambda: None):
            commit_chunk(session.engine, store_id, chunk)
            if not complete_chunk(session.engine, session.worker_id, job.job_id, orientation_of(chunk)):
                return
            session.heartbeat.check()


def _leased(session: _Session, job: NextJob) -> Iterator[int]:
    """Orientations, each leased when it is requested, until none is free or the worker should switch to another job."""
    engine, worker_id, job_id = session.engine, session.worker_id, job.job_id
    versions = code_versions()
    while not should_switch_job(engine, worker_id, job_id, versions):
        taken = lease_chunks(engine, worker_id, job_id, 1)
        if not taken:
            return
        yield from taken
