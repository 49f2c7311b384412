"""The worker's loop: joins, works on one job after another, and begins anew after whatever goes wrong."""

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

from threadstate.jobs.work import (
    Work,
    hand_in,
    has_ended,
    is_needed_elsewhere,
    let_go,
    next_work,
    open_job,
    publish_job,
    set_back,
    take_chunks,
)
from threadstate.jobs.workers import LostLeaseError, join, leave
from threadstate.library.identity import code_versions
from threadstate.library.write import IncompleteLibraryError, open_library, write_chunk
from worker.cluster.errors import ClusterError
from worker.computers import computers
from worker.jobs.heart import Heart, beating
from worker.output import tell
from worker.processes import ComputeError

POLL_S = 1.0
RETRY_S = 2.0
"""How long a worker waits after the database, or the cluster, failed."""


@dataclass(frozen=True)
class Serving:
    """How a worker works.

    Attributes:
        processes: how many processes compute.
        scheduler: address of the Dask cluster that computes in their place; None: they do.
        lease_s: after how many seconds of silence another worker is taken for dead.
        heartbeat_file: file that is touched with every heartbeat; None: none.
    """

    processes: int
    scheduler: str | None
    lease_s: float
    heartbeat_file: Path | None


@dataclass(frozen=True)
class _Session:
    """A worker that has joined."""

    engine: Engine
    worker_id: str
    heart: Heart
    serving: Serving


def serve_jobs(engine: Engine, serving: Serving, *, until_idle: bool) -> None:
    """Work on jobs until interrupted or (``until_idle``) until all have ended."""
    while True:
        try:
            with _joined(engine, serving) as session:
                _work(session, until_idle=until_idle)
                return
        except LostLeaseError as error:
            tell(f"{error}; it begins anew")
        except ClusterError as error:
            tell(f"the cluster fails, it is tried again: {error}")
            time.sleep(RETRY_S)
        except SQLAlchemyError as error:
            reason = " ".join(str(getattr(error, "orig", None) or error).split())
            tell(f"the database fails, it is tried again: {reason}")
            time.sleep(RETRY_S)


@contextmanager
def _joined(engine: Engine, serving: Serving) -> Iterator[_Session]:
    worker_id = join(engine, f"{socket.gethostname()}:{os.getpid()}")
    try:
        with beating(engine, worker_id, serving.lease_s, serving.heartbeat_file) as heart:
            yield _Session(engine, worker_id, heart, serving)
    finally:
        # Where this fails the others find out that the worker is silent.
        with suppress(SQLAlchemyError):
            leave(engine, worker_id)


def _work(session: _Session, *, until_idle: bool) -> None:
    versions = code_versions()
    while True:
        session.heart.check()
        work = next_work(session.engine, versions)
        if work is not None:
            _work_on(session, work)
        elif until_idle and has_ended(session.engine, versions):
            return
        else:
            let_go(session.engine, session.worker_id)
            time.sleep(POLL_S)


def _work_on(session: _Session, work: Work) -> None:
    engine, job_id, grid = session.engine, work.job_id, work.inputs.grid
    library_id = open_library(engine, work.inputs)
    open_job(engine, job_id, library_id)
    try:
        _compute(session, work, library_id)
        if publish_job(engine, session.worker_id, job_id, library_id, grid):
            tell(f"job {job_id}: library {library_id} is published")
    except (ComputeError, IncompleteLibraryError, IntegrityError) as error:
        reason = " ".join(str(getattr(error, "orig", None) or error).split())
        state = set_back(engine, session.worker_id, job_id, reason)
        tell(f"job {job_id} is {state} after a mishap: {reason}")


def _compute(session: _Session, work: Work, library_id: int) -> None:
    """Compute chunks of a job until none is free, it is not to be worked on, or this worker is needed elsewhere."""
    taken = _taken(session, work)
    first = next(taken, None)
    if first is None:
        return
    tell(f"job {work.job_id}: chunks of library {library_id}")
    processes = min(session.serving.processes, work.inputs.grid.orientation_count)
    with computers(work.inputs, processes, session.serving.scheduler) as computing:
        for chunk in computing.chunks(chain([first], taken), lambda: None):
            write_chunk(session.engine, library_id, chunk.rows, chunk.history)
            if not hand_in(session.engine, session.worker_id, work.job_id, chunk.rows.orientation.index):
                return
            session.heart.check()


def _taken(session: _Session, work: Work) -> Iterator[int]:
    """Orientations, each taken when it is asked for, until none is free or another job has nobody."""
    engine, worker_id, job_id = session.engine, session.worker_id, work.job_id
    versions = code_versions()
    while not is_needed_elsewhere(engine, worker_id, job_id, versions):
        taken = take_chunks(engine, worker_id, job_id, 1)
        if not taken:
            return
        yield from taken
