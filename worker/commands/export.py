"""``threadstate export``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.export.names import FileFormat, TableName
from threadstate.settings import read_settings
from worker.options import Database, Json, LibraryName, UnitName
from worker.output import print_json, print_line


def export(
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="The file; one that is there is replaced.")],
    table: Annotated[TableName, typer.Option("--table", help="Which table.")] = TableName.STATES,
    file_format: Annotated[
        FileFormat | None,
        typer.Option("--format", help="In which format.", show_default="as the file's name ends"),
    ] = None,
    library: LibraryName = None,
    unit: UnitName = None,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Write a table of a library to a file: all states, all intervals of its histories, or all undecided poses.

    \b
    Examples:
      threadstate export --out states.parquet
      threadstate export --table intervals --format csv --unit mm --out intervals.csv
    """
    from threadstate.atomic_file import replaced_file
    from threadstate.export.file import file_parts
    from threadstate.library.engine import reading
    from threadstate.library.named import LATEST, named_library
    from threadstate.library.schema import check_schema

    chosen = file_format or _format_of(out)
    if not out.absolute().parent.is_dir():
        raise InvalidValueError("--out", str(out), "a file in a folder that is there")
    with reading(database or read_settings().database) as engine:
        check_schema(engine)
        with engine.connect() as connection:
            record = named_library(connection, LATEST if library is None else library)
        shown = unit or record.length_unit
        written = 0
        with replaced_file(out) as file:
            for part in file_parts(engine, record, table, chosen, shown):
                written += file.write(part)
    if as_json:
        print_json(
            {
                "file": str(out),
                "library": record.id,
                "table": table.value,
                "format": chosen.value,
                "unit": shown.value,
                "bytes": written,
                "content_sha256": record.content_sha256,
            }
        )
        return
    print_line(f"{out}: {table} of library {record.id}, {written} bytes, lengths in {shown}")


def _format_of(out: Path) -> FileFormat:
    ending = out.suffix.removeprefix(".")
    if ending not in tuple(FileFormat):
        raise InvalidValueError(
            "--out", str(out), f"a name that ends in {', '.join(FileFormat)}, or --format beside it"
        )
    return FileFormat(ending)
