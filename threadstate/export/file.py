"""A table of a library as a file, part by part, and its ETag."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from sqlalchemy import Engine

import threadstate
from threadstate.export.column import csv_parts, ndjson_parts
from threadstate.export.names import FileFormat, TableName
from threadstate.export.parquet import parquet_parts, writer_version
from threadstate.export.read import exported_table
from threadstate.library.read import LibraryRecord
from threadstate.units import LengthUnit, conversion_factor

_SOURCES = ("export/*.py", "state/document.py", "units.py")


def file_parts(
    engine: Engine, library: LibraryRecord, table: TableName, file_format: FileFormat, unit: LengthUnit
) -> Iterator[bytes]:
    """The parts of the file; memory does not grow with the library.

    Raises:
        MissingExtraError: the format is Parquet, and pyarrow is not installed.
        NotFoundError: the library is removed while it is read; what was given until then is not the file.
    """
    found = exported_table(engine, library, table, conversion_factor(library.length_unit, unit))
    names = [column.name for column in found.columns]
    match file_format:
        case FileFormat.CSV:
            return csv_parts(names, found.batches)
        case FileFormat.NDJSON:
            return ndjson_parts(names, found.batches)
        case FileFormat.PARQUET:
            return parquet_parts(found.columns, found.batches, _about(library, table, unit))


def file_sha256(library: LibraryRecord, table: TableName, file_format: FileFormat, unit: LengthUnit) -> str:
    """SHA-256, in hexadecimal, of everything that a file's bytes depend on, known before any of them is written.

    Raises:
        MissingExtraError: the format is Parquet, and pyarrow is not installed.
    """
    writer = writer_version() if file_format is FileFormat.PARQUET else ""
    parts = (library.input_sha256, library.content_sha256, table, file_format, unit, writer, _code_sha256())
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def file_name(library: LibraryRecord, table: TableName, file_format: FileFormat) -> str:
    """The suggested name of a file."""
    return f"library-{library.id}-{table}.{file_format}"


def _about(library: LibraryRecord, table: TableName, unit: LengthUnit) -> dict[str, str]:
    """The metadata in a file."""
    return {
        "designation": library.designation,
        "table": table.value,
        "length_unit": unit.value,
        "method": library.method.value,
        "code_version": library.code_version,
        "input_sha256": library.input_sha256,
        "content_sha256": library.content_sha256,
    }


@cache
def _code_sha256() -> str:
    """SHA-256, in hexadecimal, of the code that writes files, as changed code may write other bytes."""
    package = Path(threadstate.__file__).parent
    digest = hashlib.sha256(threadstate.__version__.encode())
    for path in sorted(path for pattern in _SOURCES for path in package.glob(pattern)):
        digest.update(path.read_bytes())
    return digest.hexdigest()
