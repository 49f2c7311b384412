"""Answers as frames of pandas or polars, with the columns of ``frame_columns``."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, TypeVar

from threadstate.client.frame_columns import columns_and_sources
from threadstate.errors import MissingExtraError
from threadstate.export.column import Cell, Kind

if TYPE_CHECKING:
    import pandas
    import polars

Item = TypeVar("Item")


def to_pandas(items: Iterable[Item], item: type[Item] | None = None) -> pandas.DataFrame:
    """A row for each item; ``item`` is their type, as the list may be empty.

    What is missing is NaN or None; integers may be missing (``Int64``).

    Raises:
        MissingExtraError: pandas is not installed.
        InvalidValueError: there are no columns for such items.
    """
    try:
        import pandas
    except ModuleNotFoundError:
        raise MissingExtraError("a frame of pandas", "pandas") from None
    types = {Kind.TEXT: "str", Kind.INTEGER: "Int64", Kind.NUMBER: "float64", Kind.TRUTH: "boolean"}
    return pandas.DataFrame(
        {name: pandas.array(cells, dtype=types[kind]) for name, kind, cells in _columns(items, item)}
    )


def to_polars(items: Iterable[Item], item: type[Item] | None = None) -> polars.DataFrame:
    """A row for each item; ``item`` is their type, as the list may be empty. Missing values are null.

    Raises:
        MissingExtraError: polars is not installed.
        InvalidValueError: there are no columns for such items.
    """
    try:
        import polars
    except ModuleNotFoundError:
        raise MissingExtraError("a frame of polars", "polars") from None
    types = {
        Kind.TEXT: polars.String,
        Kind.INTEGER: polars.Int64,
        Kind.NUMBER: polars.Float64,
        Kind.TRUTH: polars.Boolean,
    }
    return polars.DataFrame(
        [polars.Series(name, cells, dtype=types[kind]) for name, kind, cells in _columns(items, item)]
    )


def _columns(items: Iterable[Item], item: type[Item] | None) -> list[tuple[str, Kind, Sequence[Cell]]]:
    """Name, kind and cells of every column."""
    listed = list(items)
    columns, sources = columns_and_sources(item or (type(listed[0]) if listed else type(None)), listed)
    return [(column.name, column.kind, [_plain(column.cell(source)) for source in sources]) for column in columns]


def _plain(cell: Cell) -> Cell:
    """The same cell; a name as the text that it is."""
    return str(cell) if isinstance(cell, str) else cell
