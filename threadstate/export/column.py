"""Columns: what a table says of each of its rows, with the unit and the meaning."""

from __future__ import annotations

from collections.abc import Callable, Sequence
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
    """The unit of length that was asked for, else the library's own."""


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
