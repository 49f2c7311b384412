"""Columns of exported tables: type, unit and meaning; rows as CSV and NDJSON, whose doubles read back the same."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Generic, TypeVar

Cell = float | int | bool | str | None
Source_contra = TypeVar("Source_contra", contravariant=True)
Source = TypeVar("Source")


class Kind(StrEnum):
    """What the cells of a column are; any may be missing."""

    TEXT = "text"
    INTEGER = "integer"
    NUMBER = "number"
    TRUTH = "true or false"


class Unit(StrEnum):
    """What a number counts."""

    NONE = ""
    DEGREES = "deg"
    LENGTH = "length"
    """The requested unit of length, or else the library's own."""


@dataclass(frozen=True)
class Column(Generic[Source_contra]):
    """A column of a table.

    Attributes:
        name: as in the header of a file.
        kind: what its cells are.
        unit: what its numbers count.
        meaning: in words.
        cell: its cell for what a row is made of.
    """

    name: str
    kind: Kind
    unit: Unit
    meaning: str
    cell: Callable[[Source_contra], Cell]


def words(name: str, meaning: str, cell: Callable[[Source], Cell]) -> Column[Source]:
    """A column of words."""
    return Column(name, Kind.TEXT, Unit.NONE, meaning, cell)


def integer(name: str, meaning: str, cell: Callable[[Source], Cell]) -> Column[Source]:
    """A column of counts."""
    return Column(name, Kind.INTEGER, Unit.NONE, meaning, cell)


def truth(name: str, meaning: str, cell: Callable[[Source], Cell]) -> Column[Source]:
    """A column of yes and no."""
    return Column(name, Kind.TRUTH, Unit.NONE, meaning, cell)


def number(name: str, meaning: str, cell: Callable[[Source], Cell]) -> Column[Source]:
    """A column of numbers without a unit."""
    return Column(name, Kind.NUMBER, Unit.NONE, meaning, cell)


def degrees(name: str, meaning: str, cell: Callable[[Source], Cell]) -> Column[Source]:
    """A column of angles in degrees."""
    return Column(name, Kind.NUMBER, Unit.DEGREES, meaning, cell)


def length(name: str, meaning: str, cell: Callable[[Source], Cell]) -> Column[Source]:
    """A column of lengths."""
    return Column(name, Kind.NUMBER, Unit.LENGTH, meaning, cell)


def row_of(columns: Sequence[Column[Source]], source: Source) -> tuple[Cell, ...]:
    """The cells of a row."""
    return tuple(column.cell(source) for column in columns)


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
