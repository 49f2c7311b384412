"""``threadstate copy``."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.errors import NotFoundError
from threadstate.settings import DATABASE, read_settings
from worker.options import Json
from worker.output import print_json, print_line


def copy(
    target: Annotated[str, typer.Option("--to", metavar="URL", help="The database that libraries are copied to.")],
    source: Annotated[
        str | None,
        typer.Option(
            "--from",
            metavar="URL",
            help="The database that they are in.",
            show_default=f"{DATABASE}, else a file in the data directory",
        ),
    ] = None,
    library: Annotated[
        str | None,
        typer.Option(
            "--library",
            metavar="NAME",
            help="The one to copy: its number, its thread's designation or slug, latest, or latest-mesh.",
            show_default="all published",
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    r"""Copy published libraries to another database, and verify the copies.

    A copy is published only if the content hash of its rows is that of the source. Resumes an interrupted copy. An
    empty database is migrated first.

    \b
    Examples:
      threadstate copy --to postgresql+psycopg://threads@db.example/threads
      threadstate copy --from sqlite:////tmp/threads.sqlite3 --to sqlite:////tmp/copy.sqlite3 --library 1
    """
    from threadstate.library.copying import copy_library
    from threadstate.library.engine import reading, writing
    from threadstate.library.named import named_library
    from threadstate.library.read import published_libraries
    from threadstate.library.schema import check_schema
    from worker.migrate import migrate_empty

    with reading(source or read_settings().database) as here, writing(target) as there:
        check_schema(here)
        migrate_empty(there)
        with here.connect() as connection:
            records = (
                # The latest last, so that it is the latest there.
                published_libraries(connection)[::-1] if library is None else [named_library(connection, library)]
            )
        if not records:
            raise NotFoundError("no library is published yet; run `threadstate rebuild`")
        for record in records:
            copied = copy_library(here, there, record.id)
            if as_json:
                print_json(
                    {
                        "library": record.id,
                        "copy": copied.library_id,
                        "content_sha256": copied.content_sha256,
                        "poses": copied.pose_count,
                        "was_there": copied.was_there,
                    }
                )
            else:
                done = "is there already" if copied.was_there else "is copied"
                print_line(
                    f"library {record.id} {done}, as library {copied.library_id} "
                    f"({copied.pose_count} poses, content {copied.content_sha256[:12]})"
                )
