"""Tables on a terminal or in a file, and how their numbers are written."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table

WIDTH_OF_A_FILE = 160
"""How wide tables are where stdout is no terminal."""


def table(*columns: str) -> Table:
    """An empty table without lines."""
    made = Table(box=None, pad_edge=False)
    for column in columns:
        made.add_column(column)
    return made


def console() -> Console:
    """Where tables are printed."""
    found = Console(highlight=False)
    return found if found.is_terminal else Console(highlight=False, width=WIDTH_OF_A_FILE)


def angle(value: float | None) -> str:
    """An angle in degrees."""
    return "-" if value is None else f"{value:.6f}"


def length(value: float | None) -> str:
    """A length."""
    return "-" if value is None else f"{value + 0.0:.9f}"
