"""Rows as Parquet; the one file that imports pyarrow, which is an extra."""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from threadstate.errors import MissingExtraError
from threadstate.export.column import Cell, Column, Kind, Rows

ROWS_IN_A_GROUP = 16_384
"""Rows of a row group, which is compressed and written as a whole: the rows in memory."""

EXTRA = "parquet"


def writer_version() -> str:
    """The version of the Parquet writer, on which the bytes depend.

    Raises:
        MissingExtraError: pyarrow is not installed.
    """
    return str(_pyarrow().__version__)


def parquet_parts(columns: Sequence[Column[Any]], batches: Iterable[Rows], about: Mapping[str, str]) -> Iterator[bytes]:
    """A Parquet file, compressed by Zstandard, whose fields say their ``unit`` and ``meaning``.

    ``about`` is said of the whole file.

    Raises:
        MissingExtraError: pyarrow is not installed.
    """
    _pyarrow()
    import pyarrow
    from pyarrow import parquet

    types = {
        Kind.TEXT: pyarrow.string(),
        Kind.INTEGER: pyarrow.int32(),
        Kind.NUMBER: pyarrow.float64(),
        Kind.TRUTH: pyarrow.bool_(),
    }
    schema = pyarrow.schema(
        [
            pyarrow.field(one.name, types[one.kind], metadata={"unit": one.unit.value, "meaning": one.meaning})
            for one in columns
        ],
        metadata=dict(about),
    )
    sink = _Sink()
    with parquet.ParquetWriter(sink, schema, compression="zstd") as writer:
        for group in _groups(schema, batches):
            writer.write_table(group)
            yield sink.taken()
    yield sink.taken()


def _groups(schema: Any, batches: Iterable[Rows]) -> Iterator[Any]:
    import pyarrow

    waiting: list[Any] = []
    rows = 0
    for batch in batches:
        if batch:
            cells: list[Sequence[Cell]] = list(zip(*batch, strict=True))
            waiting.append(pyarrow.record_batch(cells, schema=schema))
            rows += len(batch)
        if rows >= ROWS_IN_A_GROUP:
            yield pyarrow.Table.from_batches(waiting)
            waiting, rows = [], 0
    if waiting:
        yield pyarrow.Table.from_batches(waiting)


class _Sink(io.RawIOBase):
    """A file-like object whose written bytes are taken out."""

    def __init__(self) -> None:
        super().__init__()
        self._parts: list[bytes] = []

    def writable(self) -> bool:
        return True

    def write(self, content: Any) -> int:
        part = bytes(content)
        self._parts.append(part)
        return len(part)

    def taken(self) -> bytes:
        """The bytes written since the last call."""
        content = b"".join(self._parts)
        self._parts.clear()
        return content


def _pyarrow() -> Any:
    try:
        import pyarrow
    except ModuleNotFoundError:
        raise MissingExtraError("Parquet", EXTRA) from None
    return pyarrow
