"""The names of the tables and formats that a library is exported as."""

from __future__ import annotations

from enum import StrEnum


class TableName(StrEnum):
    """A table of a library."""

    STATES = "states"
    INTERVALS = "intervals"
    UNDECIDED = "undecided"


class FileFormat(StrEnum):
    """A format of files."""

    PARQUET = "parquet"
    CSV = "csv"
    NDJSON = "ndjson"

    @property
    def media_type(self) -> str:
        """The value of the header ``Content-Type``."""
        return _MEDIA_TYPES[self]


_MEDIA_TYPES = {
    FileFormat.PARQUET: "application/vnd.apache.parquet",
    FileFormat.CSV: "text/csv; charset=utf-8; header=present",
    FileFormat.NDJSON: "application/x-ndjson",
}
