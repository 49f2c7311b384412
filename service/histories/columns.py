"""A history as columns of equal length: what a table or a plot wants."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence

from threadstate.export.column import Cell
from threadstate.export.states import STAGES, state_columns
from threadstate.state.document import StateDocument

Columns = Mapping[str, tuple[Cell, ...]]


def history_columns(states: Sequence[StateDocument]) -> Columns:
    """The states of an orientation as the columns that an export has of them, None where a state lacks one.

    Left out are roll and pitch, the number of contacts, and the stages and contacts that no state has.
    """
    stages = max((len(state["poses"]) for state in states), default=0)
    contacts = max((len(state["contacts"]) for state in states), default=0)
    unreached = tuple(f"pose_{stage}_" for stage in STAGES if stage > stages)
    return {
        column.name: tuple(column.cell(state) for state in states)
        for column in state_columns(contacts)
        if column.name not in ("roll", "pitch", "contacts") and not column.name.startswith(unreached)
    }


def csv_table(columns: Columns) -> bytes:
    """The columns as CSV with a header, in UTF-8; a cell that is None is empty."""
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow(columns)
    writer.writerows(zip(*columns.values(), strict=True))
    return text.getvalue().encode()
