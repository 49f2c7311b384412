"""States and contacts as tables for people."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from threadstate.state.model import ContactState
from threadstate.units import LengthUnit

WIDTH_OF_A_FILE = 160
"""How wide tables are where stdout is no terminal."""


def print_states(states: Sequence[ContactState], unit: LengthUnit) -> None:
    """One row a state: pose, class, turns, lengths, flags."""
    table = _table(
        "roll", "pitch", "phase", "class", "lambda", "mu", f"drop ({unit})", "embedment", "pivot offset", "flags"
    )
    for state in states:
        table.add_row(
            f"{state.roll_deg:g}",
            f"{state.pitch_deg:g}",
            f"{state.phase_deg:g}",
            state.state_class.value,
            _angle(state.lambda_deg),
            _angle(state.mu_deg),
            _length(state.drop),
            _length(state.embedment),
            _length(state.pivot_offset),
            ", ".join(state.flags),
        )
    _console().print(table)


def print_contacts(state: ContactState, unit: LengthUnit) -> None:
    """One row a contact: where it is, on what, between which features."""
    table = _table("stage", f"x ({unit})", "y", "z", "bolt region", "nut region", "features")
    for contact in state.contacts:
        table.add_row(
            str(contact.stage),
            *(_length(coordinate) for coordinate in contact.point),
            contact.bolt_region.value,
            contact.nut_region.value,
            contact.features.value,
        )
    _console().print(table)


def _table(*columns: str) -> Table:
    table = Table(box=None, pad_edge=False)
    for column in columns:
        table.add_column(column)
    return table


def _console() -> Console:
    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=WIDTH_OF_A_FILE)


def _angle(value: float | None) -> str:
    return "-" if value is None else f"{value:.6f}"


def _length(value: float | None) -> str:
    return "-" if value is None else f"{value + 0.0:.9f}"
