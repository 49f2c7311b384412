"""Options that several commands share."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate import settings
from threadstate.errors import InvalidValueError
from threadstate.library.solver_method import SolverMethod
from threadstate.units import LengthUnit
from worker.number_options import integer_option, number_option

Database = Annotated[
    str | None,
    typer.Option(
        "--database",
        metavar="URL",
        help="A SQLite file (sqlite:////absolute/path/file.sqlite3) or a PostgreSQL database "
        "(postgresql+psycopg://user@host/name).",
        show_default=f"{settings.DATABASE}, else a file in the data directory",
    ),
]

LibraryName = Annotated[
    str | None,
    typer.Option(
        "--library",
        metavar="NAME",
        help="Which library: its number, its thread's designation or slug, latest, or latest-mesh.",
        show_default="latest",
    ),
]

UnitName = Annotated[
    LengthUnit | None, typer.Option("--unit", help="Unit of all lengths.", show_default="the thread's own")
]

MethodName = Annotated[SolverMethod, typer.Option("--method", help="How states are found.")]

Json = Annotated[bool, typer.Option("--json", help="Print JSON.", show_default=False)]

PairName = Annotated[
    str | None,
    typer.Option(
        "--pair",
        metavar="NAME",
        help="Designation of the pair, or a TOML file of its dimensions; with --dimension, a name for it.",
        show_default=f"{settings.PAIR}, else 1/4-20 UNC",
    ),
]
Dimensions = Annotated[
    list[str] | None,
    typer.Option(
        "--dimension",
        metavar="KEY=VALUE",
        help="A dimension of one's own pair, as thread_pitch=1 or fit.nut_pitch_diameter=5.35; any number of times.",
    ),
]

PhaseStep = Annotated[float, number_option("--phase-step", metavar="DEG", help="Step of phase; divides 360.")]
TiltMax = Annotated[float, number_option("--tilt-max", metavar="DEG", help="Largest roll and pitch; at most 10.")]
TiltStep = Annotated[
    float, number_option("--tilt-step", metavar="DEG", help="Step of roll and pitch; divides the largest.")
]
Workers = Annotated[
    int | None,
    integer_option(
        "--workers",
        metavar="N",
        min=1,
        max=settings.LARGEST_WORKER_COUNT,
        help="Processes that compute.",
        show_default=f"{settings.WORKERS}, else one a processor",
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        metavar="URL",
        help="Dask scheduler whose workers compute, tcp://host:port.",
        show_default=f"{settings.SCHEDULER}, else processes here",
    ),
]
Host = Annotated[
    str | None,
    typer.Option(
        "--host", metavar="ADDRESS", help="Address to listen on.", show_default=f"{settings.HOST}, else 127.0.0.1"
    ),
]
Port = Annotated[
    int | None,
    integer_option(
        "--port", metavar="N", min=1, max=65535, help="Port to listen on.", show_default=f"{settings.PORT}, else 8000"
    ),
]


def chosen_scheduler(read: settings.Settings, scheduler: str | None, workers: int | None) -> str | None:
    """The scheduler whose workers compute; None: processes here do, as where their number is an option.

    Raises:
        InvalidValueError: both are options.
    """
    if scheduler is not None and workers is not None:
        raise InvalidValueError("--workers", workers, "without --scheduler alone: a scheduler's workers compute there")
    return read.scheduler if scheduler is None and workers is None else scheduler
