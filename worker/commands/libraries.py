"""``threadstate libraries``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.settings import read_settings
from worker.options import Database, Json
from worker.output import print_json, print_status

if TYPE_CHECKING:
    from threadstate.library.read import LibraryRecord


def libraries(
    pin: Annotated[
        str | None,
        typer.Option(
            "--pin",
            metavar="NAME",
            help="First pin this library, so that latest means it: its number, designation or slug.",
        ),
    ] = None,
    unpin: Annotated[
        bool,
        typer.Option(
            "--unpin", help="First unpin, so that latest means the library published last.", show_default=False
        ),
    ] = False,
    settled: Annotated[
        bool, typer.Option("--settled", help="List the libraries of settled states instead.", show_default=False)
    ] = False,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""List the published libraries, and say which one "latest" means.

    That is the library published last by the exact method, unless one is pinned: then it is that one, whatever is
    published later. A designation means the pinned library, too, where that is one of this thread.

    \b
    Examples:
      threadstate libraries
      threadstate libraries --json
      threadstate libraries --pin 1-4-20-unc
      threadstate libraries --unpin
      threadstate libraries --settled
    """
    if pin is not None and unpin:
        raise InvalidValueError("--pin", pin, "without --unpin")
    if settled and (pin is not None or unpin):
        raise InvalidValueError("--settled", "given", "without --pin and --unpin")
    if settled:
        from worker.settled.listing import list_settled

        list_settled(database or read_settings().database, as_json=as_json)
        return

    from threadstate.library.engine import reading
    from threadstate.library.read import published_libraries
    from threadstate.library.schema import check_schema
    from threadstate.library.solver_method import SolverMethod

    where = database or read_settings().database
    if pin is not None or unpin:
        _pin(where, pin)
    with reading(where) as engine:
        check_schema(engine)
        with engine.connect() as connection:
            published = published_libraries(connection)
    by_exact_method = [one for one in published if one.method is SolverMethod.EXACT]
    latest = next((one for one in by_exact_method if one.is_pinned), next(iter(by_exact_method), None))
    if as_json:
        print_json({"libraries": [_document(one, is_latest=one is latest) for one in published]})
    else:
        _print(published, latest)


def _pin(database: str, name: str | None) -> None:
    """Pin the library of a name; with None none is pinned any more."""
    from threadstate.library.engine import writing
    from threadstate.library.solver_method import SolverMethod
    from threadstate.library.write import pin_library
    from worker.library_source import checked_database, connected_library

    library_id = None
    if name is None:
        checked_database(database)
    else:
        with connected_library(database, name) as (_, record):
            if record.method is not SolverMethod.EXACT:
                raise InvalidValueError("--pin", name, "a library by the exact method")
            library_id = record.id
    with writing(database) as engine:
        pin_library(engine, library_id)


def _document(record: LibraryRecord, *, is_latest: bool) -> dict[str, object]:
    from threadstate.library.identity import pair_of
    from threadstate.library.named import slug
    from threadstate.thread.catalogue import source_of

    return {
        "id": record.id,
        "designation": record.designation,
        "slug": slug(record.designation),
        "source": source_of(pair_of(record.pair)),
        "method": record.method.value,
        "unit": record.length_unit.value,
        "tilt_max": record.grid.tilt_max_deg,
        "tilt_step": record.grid.tilt_step_deg,
        "phase_step": record.grid.phase_step_deg,
        "states": record.state_count,
        "undecided": record.undecided_count,
        "published_at": record.published_at.isoformat(),
        "code_version": record.code_version,
        "content_sha256": record.content_sha256,
        "pinned": record.is_pinned,
        "latest": is_latest,
    }


def _print(published: list[LibraryRecord], latest: LibraryRecord | None) -> None:
    from worker.tables import table

    if not published:
        print_status("no library is published yet; run `threadstate rebuild`")
    rows = table("id", "designation", "method", "grid", "states", "unit", "published (UTC)", "")
    for one in published:
        grid = one.grid
        mark = ("latest, pinned" if one.is_pinned else "latest") if one is latest else ""
        rows.add_row(
            str(one.id),
            one.designation,
            one.method.value,
            str(grid),
            str(one.state_count),
            one.length_unit.value,
            f"{one.published_at:%Y-%m-%d %H:%M:%S}",
            mark,
        )
    rows.print()
