"""States and contacts as tables for people."""

from __future__ import annotations

from collections.abc import Sequence

from threadstate.state.model import ContactState
from threadstate.units import LengthUnit
from worker.tables import angle, console, length, table


def print_states(states: Sequence[ContactState], unit: LengthUnit) -> None:
    """One row a state: pose, class, turns, lengths, flags."""
    rows = table(
        "roll", "pitch", "phase", "class", "lambda", "mu", f"drop ({unit})", "embedment", "pivot offset", "flags"
    )
    for state in states:
        rows.add_row(
            f"{state.roll_deg:g}",
            f"{state.pitch_deg:g}",
            f"{state.phase_deg:g}",
            state.state_class.value,
            angle(state.lambda_deg),
            angle(state.mu_deg),
            length(state.drop),
            length(state.embedment),
            length(state.pivot_offset),
            ", ".join(state.flags),
        )
    console().print(rows)


def print_contacts(state: ContactState, unit: LengthUnit) -> None:
    """One row a contact: where it is, on what, between which features."""
    rows = table("stage", f"x ({unit})", "y", "z", "bolt region", "nut region", "features")
    for contact in state.contacts:
        rows.add_row(
            str(contact.stage),
            *(length(coordinate) for coordinate in contact.point),
            contact.bolt_region.value,
            contact.nut_region.value,
            contact.features.value,
        )
    console().print(rows)
