"""The class of a state from its three numbers (method, section 5)."""

from __future__ import annotations

from dataclasses import dataclass

from threadstate.state.model import StateClass


@dataclass(frozen=True, slots=True)
class Classification:
    """A class and the signed distances of the three numbers from their thresholds; None where one is absent.

    ``drop_margin`` is drop - embedment, ``embedment_margin`` is tolerance - embedment and ``pivot_margin`` is
    pivot_offset - q * nominal radius: positive on the stable side.
    """

    state_class: StateClass
    drop_margin: float | None
    embedment_margin: float | None
    pivot_margin: float | None


def classify(
    *,
    flush: bool,
    third: bool,
    drop: float | None,
    embedment: float | None,
    pivot_offset: float | None,
    pivot_threshold: float,
    embedment_tolerance: float,
) -> Classification:
    """The class by the method's rules, in their order; all lengths in one unit.

    ``flush``: contact is a patch. ``third``: a third contact was found. ``pivot_threshold`` is q times the nominal
    radius.
    """
    drop_margin = drop - embedment if drop is not None and embedment is not None else None
    embedment_margin = embedment_tolerance - embedment if embedment is not None else None
    pivot_margin = pivot_offset - pivot_threshold if pivot_offset is not None else None

    state_class = _class(flush, third, drop_margin, embedment_margin, pivot_margin)
    return Classification(state_class, drop_margin, embedment_margin, pivot_margin)


def _class(
    flush: bool, third: bool, drop_margin: float | None, embedment_margin: float | None, pivot_margin: float | None
) -> StateClass:
    if flush:
        return StateClass.STABLE_THREE_POINT
    if not third or drop_margin is None or embedment_margin is None or pivot_margin is None:
        return StateClass.UNSTABLE_TWO_POINT
    if drop_margin <= 0.0 and embedment_margin < 0.0:
        return StateClass.UNSTABLE_TWO_POINT
    if pivot_margin <= 0.0:
        return StateClass.QUASI_STABLE_TWO_POINT
    return StateClass.STABLE_THREE_POINT
