"""How far a state is from having other labels."""

from __future__ import annotations

from threadstate.state.model import ContactState, Flag, StateClass


def smallest_margin(state: ContactState | None) -> float | None:
    """The smallest margin of a state's class and regions, a length in the pair's unit; None where undecided."""
    if state is None:
        return None
    margins = [margin for contact in state.contacts for margin in (contact.bolt_margin, contact.nut_margin)]
    of_class = class_margin(state)
    return min(margins if of_class is None else [*margins, of_class])


def class_margin(state: ContactState) -> float | None:
    """By how much the nearest of a state's lengths may change before its class does (method, section 5).

    None where the class stands on no length: contact is a patch, or there is no third contact.
    """
    drop, embedment, pivot = state.drop_margin, state.embedment_margin, state.pivot_margin
    if Flag.FLUSH in state.flags or drop is None or embedment is None or pivot is None:
        return None
    if state.state_class is StateClass.UNSTABLE_TWO_POINT:
        return min(-drop, -embedment)
    return min(max(drop, embedment), abs(pivot))
