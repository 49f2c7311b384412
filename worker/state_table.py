"""States and contacts as tables for people."""

from __future__ import annotations

from collections.abc import Sequence

from threadstate.numbers import number_text
from threadstate.state.model import ContactState
from threadstate.units import LengthUnit, scale_length
from worker.tables import angle, length, table


def print_states(states: Sequence[ContactState], unit: LengthUnit, factor: float) -> None:
    """One row a state: pose, class, turns, lengths (multiplied by ``factor``, in ``unit``), flags."""
    rows = table(
        "roll", "pitch", "phase", "class", "lambda", "mu", f"drop ({unit})", "embedment", "pivot offset", "flags"
    )
    for state in states:
        rows.add_row(
            number_text(state.roll_deg),
            number_text(state.pitch_deg),
            f"{state.phase_deg % 360.0:.12g}",
            state.state_class.value,
            angle(state.lambda_deg),
            angle(state.mu_deg),
            length(scale_length(state.drop, factor), unit),
            length(scale_length(state.embedment, factor), unit),
            length(scale_length(state.pivot_offset, factor), unit),
            ", ".join(state.flags),
        )
    rows.print()


def print_contacts(state: ContactState, unit: LengthUnit, factor: float) -> None:
    """One row a contact: where it is (lengths multiplied by ``factor``, in ``unit``), between which features."""
    rows = table("stage", f"x ({unit})", "y", "z", "bolt region", "nut region", "features")
    for contact in state.contacts:
        rows.add_row(
            str(contact.stage),
            *(length(coordinate * factor, unit) for coordinate in contact.point),
            contact.bolt_region.value,
            contact.nut_region.value,
            contact.features.value,
        )
    rows.print()
