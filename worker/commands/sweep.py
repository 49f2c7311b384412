"""``threadstate sweep``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.settings import read_settings
from worker.exit_codes import ExitCode
from worker.options import Database, Json, Scheduler, Workers, chosen_scheduler

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from threadstate.library.identity import LibraryInputs
    from worker.sweep.run import SweepResult


def sweep(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="TOML file that says which libraries.")],
    database: Database = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    dry_run: Annotated[
        bool,
        typer.Option("--dry-run", help="Only estimate rows, bytes and time.", show_default=False),
    ] = False,
    jobs: Annotated[
        bool, typer.Option("--jobs", help="Submit the libraries as jobs instead.", show_default=False)
    ] = False,
    as_json: Json = False,
) -> None:
    r"""Compute many libraries: those of a file that are not published yet, one after the other.

    The file crosses pairs, grids and methods, or lists libraries. It is checked before anything is computed. One that
    fails does not stop the others; the exit code is 1 then. Run again, it resumes.

    \b
    Examples:
      threadstate sweep examples/sweep.toml --dry-run
      threadstate sweep examples/sweep.toml --workers 2
      threadstate sweep examples/sweep.toml --scheduler tcp://scheduler.example:8786
      threadstate sweep examples/sweep.toml --jobs
    """
    from worker.sweep.document import read_sweep

    settings = read_settings()
    where = database or settings.database
    chosen = chosen_scheduler(settings, scheduler, workers)
    if jobs and dry_run:
        raise InvalidValueError("--jobs", "given", "without --dry-run")
    libraries = read_sweep(file)
    if dry_run:
        _estimate(where, libraries, workers or settings.workers, chosen, as_json=as_json)
    elif _sweep(where, libraries, workers or settings.workers, chosen, jobs=jobs, as_json=as_json):
        raise typer.Exit(ExitCode.FAILURE)


def _estimate(
    database: str, libraries: Sequence[LibraryInputs], workers: int, scheduler: str | None, *, as_json: bool
) -> None:
    from threadstate.library.engine import reading
    from threadstate.library.schema import check_schema, stored_revision
    from worker.cluster.chunks import cluster_threads
    from worker.sweep.estimate import estimates
    from worker.sweep.report import print_estimates

    with reading(database) as engine:
        is_empty = stored_revision(engine) is None
        if not is_empty:
            check_schema(engine)
        parallelism = workers if scheduler is None else cluster_threads(scheduler)
        print_estimates(estimates(engine, libraries, parallelism, is_empty=is_empty), as_json=as_json)


def _sweep(
    database: str,
    libraries: Sequence[LibraryInputs],
    workers: int,
    scheduler: str | None,
    *,
    jobs: bool,
    as_json: bool,
) -> int:
    """Compute or queue the libraries.

    Returns:
        How many of them failed.
    """
    from threadstate.library.engine import writing
    from worker.migrate import migrate_empty
    from worker.sweep.report import print_sweep_result
    from worker.sweep.run import Outcome, computed_sweep, queued_sweep

    failed = 0
    with writing(database) as engine:
        migrate_empty(engine)
        results: Iterable[SweepResult] = (
            queued_sweep(engine, libraries) if jobs else computed_sweep(engine, libraries, workers, scheduler)
        )
        for one in results:
            print_sweep_result(one, as_json=as_json)
            failed += one.outcome is Outcome.FAILED
    return failed
