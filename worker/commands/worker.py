"""``threadstate worker``."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.settings import read_settings
from worker.options import Database, Scheduler, Workers, chosen_scheduler


def worker(
    database: Database = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    until_idle: Annotated[
        bool, typer.Option("--until-idle", help="End when every job has ended.", show_default=False)
    ] = False,
) -> None:
    r"""Compute the libraries and success maps that were requested as jobs, until stopped.

    Any number may run at once, on several machines where the database is PostgreSQL's. SIGTERM and Ctrl-C end it as
    soon as what it is writing is written; its chunks are then free for others. One that is killed is detected by its
    missing heartbeat.

    \b
    Examples:
      threadstate worker
      threadstate worker --workers 2 --until-idle
      threadstate worker --scheduler tcp://scheduler.example:8786
    """
    from threadstate.library.engine import writing
    from threadstate.library.schema import check_schema
    from worker.interruption import interruptible_at_waits
    from worker.jobs.serve import WorkerOptions, serve_jobs
    from worker.output import print_status

    settings = read_settings()
    try:
        with interruptible_at_waits(), writing(database or settings.database) as engine:
            check_schema(engine)
            options = WorkerOptions(
                processes=workers or settings.workers,
                scheduler=chosen_scheduler(settings, scheduler, workers),
                lease_s=settings.lease_s,
                heartbeat_file=settings.heartbeat_file,
            )
            serve_jobs(engine, options, until_idle=until_idle)
    except KeyboardInterrupt:
        print_status("stopped")
