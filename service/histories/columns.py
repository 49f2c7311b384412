"""A history as columns of equal length: what a table or a plot wants."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass

from threadstate.state.document import ContactDocument, StateDocument

Cell = float | int | str | None

_AXES = "xyz"


@dataclass(frozen=True)
class Column:
    """A named column; None where a state lacks it."""

    name: str
    cells: tuple[Cell, ...]


def history_columns(states: Sequence[StateDocument]) -> tuple[Column, ...]:
    """The states of an orientation as columns.

    They are phase, class, flags (separated by spaces), turns, lengths, margins, the poses ("pose_2_r13", "pose_2_tx" of
    the second stage) and the contacts ("contact_1_point_x"), as many as the state with most has.
    """
    columns = [
        Column("phase", tuple(state["phase"] for state in states)),
        Column("class", tuple(state["class"] for state in states)),
        Column("flags", tuple(" ".join(state["flags"]) for state in states)),
        Column("lambda", tuple(state["turns"][0] for state in states)),
        Column("mu", tuple(state["turns"][1] for state in states)),
        Column("drop", tuple(state["drop"] for state in states)),
        Column("embedment", tuple(state["embedment"] for state in states)),
        Column("pivot_offset", tuple(state["pivot_offset"] for state in states)),
        Column("margin_drop", tuple(state["margins"]["drop"] for state in states)),
        Column("margin_embedment", tuple(state["margins"]["embedment"] for state in states)),
        Column("margin_pivot_offset", tuple(state["margins"]["pivot_offset"] for state in states)),
    ]
    for stage in range(1, 1 + max((len(state["poses"]) for state in states), default=0)):
        columns += _pose_columns(states, stage)
    for number in range(1, 1 + max((len(state["contacts"]) for state in states), default=0)):
        columns += _contact_columns(states, number)
    return tuple(columns)


def csv_table(columns: Sequence[Column]) -> bytes:
    """The columns as CSV with a header, in UTF-8; a cell that is None is empty."""
    text = io.StringIO()
    writer = csv.writer(text)
    writer.writerow([column.name for column in columns])
    writer.writerows(zip(*(column.cells for column in columns), strict=True))
    return text.getvalue().encode()


def _pose_columns(states: Sequence[StateDocument], stage: int) -> list[Column]:
    poses = [state["poses"][stage - 1] if len(state["poses"]) >= stage else None for state in states]
    rotation = [
        Column(f"pose_{stage}_r{i + 1}{j + 1}", tuple(pose and pose["rotation"][i][j] for pose in poses))
        for i in range(3)
        for j in range(3)
    ]
    translation = [
        Column(f"pose_{stage}_t{axis}", tuple(pose and pose["translation"][i] for pose in poses))
        for i, axis in enumerate(_AXES)
    ]
    return rotation + translation


def _contact_columns(states: Sequence[StateDocument], number: int) -> list[Column]:
    contacts = [state["contacts"][number - 1] if len(state["contacts"]) >= number else None for state in states]
    cells = [_contact_cells(contact) for contact in contacts if contact is not None]
    names = [name for name, _ in cells[0]]
    rows = iter(cells)
    filled = [next(rows) if contact is not None else None for contact in contacts]
    return [
        Column(f"contact_{number}_{name}", tuple(None if row is None else row[i][1] for row in filled))
        for i, name in enumerate(names)
    ]


def _contact_cells(contact: ContactDocument) -> list[tuple[str, Cell]]:
    return [
        ("stage", contact["stage"]),
        *((f"point_{axis}", value) for axis, value in zip(_AXES, contact["point"], strict=True)),
        *((f"point_bolt_{axis}", value) for axis, value in zip(_AXES, contact["point_bolt"], strict=True)),
        *((f"normal_{axis}", value) for axis, value in zip(_AXES, contact["normal"], strict=True)),
        ("bolt_region", contact["bolt_region"]),
        ("nut_region", contact["nut_region"]),
        ("features", contact["features"]),
        ("bolt_margin", contact["bolt_margin"]),
        ("nut_margin", contact["nut_margin"]),
    ]
