"""``threadstate summary``."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.library.solver_method import SolverMethod
from worker.options import Database, Json, LibraryName
from worker.output import print_json, print_line


def summary(
    library: LibraryName = None,
    database: Database = None,
    method: Annotated[
        SolverMethod | None,
        typer.Option("--method", help="In place of --library: the latest by this method.", show_default="exact"),
    ] = None,
    as_json: Json = False,
) -> None:
    r"""Print what a library holds: how many states of each class, and with each flag.

    \b
    Examples:
      threadstate summary
      threadstate summary --library 1-4-20-unc
      threadstate summary --database sqlite:////tmp/threads.sqlite3 --json
    """
    if library is not None and method is not None:
        raise InvalidValueError("--method", method.value, "without --library, which names one library")

    from threadstate.library.identity import pair_of
    from threadstate.library.named import LATEST, LATEST_MESH
    from threadstate.library.read import counts, undecided_reasons
    from threadstate.thread.catalogue import source_of
    from worker.library_source import connected_library
    from worker.tables import OWN_DIMENSIONS

    name = library or (LATEST_MESH if method is SolverMethod.MESH else LATEST)
    with connected_library(database, name) as (connection, record):
        counted = counts(connection, record.id)
        reasons = undecided_reasons(connection, record.id)
    source = source_of(pair_of(record.pair))
    if as_json:
        print_json(
            {
                "library": record.id,
                "pair": record.designation,
                "source": source,
                "unit": record.length_unit.value,
                "input_sha256": record.input_sha256,
                "content_sha256": record.content_sha256,
                "code_version": record.code_version,
                "published_at": record.published_at.isoformat(),
                "method": record.method.value,
                "states": record.state_count,
                "undecided": dict(reasons),
                "classes": {name.value: count for name, count in counted.of_class},
                "flags": {name.value: count for name, count in counted.of_flag},
            }
        )
        return
    method_and_unit = f"{record.method.value} method, unit {record.length_unit}"
    print_line(f"library {record.id}: {record.designation}, {record.state_count} states, {method_and_unit}")
    print_line(f"rests on: {source or OWN_DIMENSIONS}")
    print_line(f"published {record.published_at:%Y-%m-%d %H:%M:%S} UTC by {record.code_version}")
    print_line(f"inputs  {record.input_sha256}")
    print_line(f"content {record.content_sha256}")
    for title, rows in (("class", counted.of_class), ("flag", counted.of_flag)):
        print_line(f"\n{title:<24}{'states':>8}")
        for name, count in rows:
            print_line(f"{name.value:<24}{count:>8}")
    if reasons:
        print_line(f"\n{'poses':>8}  undecided, as")
        for reason, count in reasons:
            print_line(f"{count:>8}  {reason}")
