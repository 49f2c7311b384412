"""Rows as CSV and as lines of JSON; every double is written so that it reads back the same."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Iterator, Sequence

from threadstate.export.column import Cell

Rows = Sequence[Sequence[Cell]]


def csv_parts(names: Sequence[str], batches: Iterable[Rows]) -> Iterator[bytes]:
    """CSV (RFC 4180) in UTF-8 with a header; what is missing is empty, truths are ``true`` and ``false``."""
    yield _csv([names])
    for rows in batches:
        yield _csv([[_truth(cell) for cell in row] for row in rows])


def ndjson_parts(names: Sequence[str], batches: Iterable[Rows]) -> Iterator[bytes]:
    """An object a line, in UTF-8, each with every name; what is missing is null."""
    encode = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode
    for rows in batches:
        yield "".join(f"{encode(dict(zip(names, row, strict=True)))}\n" for row in rows).encode()


def _csv(rows: Iterable[Sequence[Cell]]) -> bytes:
    text = io.StringIO()
    csv.writer(text).writerows(rows)
    return text.getvalue().encode()


def _truth(cell: Cell) -> Cell:
    return str(cell).lower() if isinstance(cell, bool) else cell
