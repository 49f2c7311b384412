"""Summaries of the states of an orientation over all phases."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import Connection, func, select

from threadstate.library.tables import state
from threadstate.state.model import StateClass


@dataclass(frozen=True)
class OrientationSummary:
    """An orientation (degrees) over all phases of the grid; lengths in the library's unit, None where no state has one.

    ``of_class`` is the number of states of each class, every class included. ``margin_least`` is the least distance
    of any state's drop, embedment or pivot offset from its threshold. The last three are of the states under the
    default load: their least frictions, and the greatest support margin.
    """

    roll_deg: float
    pitch_deg: float
    of_class: tuple[tuple[StateClass, int], ...]
    drop_most: float | None
    embedment_most: float | None
    pivot_offset_least: float | None
    margin_least: float | None
    mu_hold_least: float | None
    mu_wedge_least: float | None
    support_margin_most: float | None


def orientation_summaries(connection: Connection, library_id: int) -> list[OrientationSummary]:
    """All orientations of a library that have a state, in the order of roll and pitch."""
    margins = (state.c.drop_margin, state.c.embedment_margin, state.c.pivot_margin)
    query = (
        select(
            state.c.roll_deg,
            state.c.pitch_deg,
            func.max(state.c.drop),
            func.max(state.c.embedment),
            func.min(state.c.pivot_offset),
            func.min(state.c.mu_hold),
            func.min(state.c.mu_wedge),
            func.max(state.c.support_margin),
            *(func.min(func.abs(margin)) for margin in margins),
            *(func.count().filter(state.c.state_class == name.value) for name in StateClass),
        )
        .where(state.c.library_id == library_id)
        .group_by(state.c.roll_deg, state.c.pitch_deg)
        .order_by(state.c.roll_deg, state.c.pitch_deg)
    )
    return [_summary(*row) for row in connection.execute(query)]


def _summary(
    roll_deg: float,
    pitch_deg: float,
    drop: float | None,
    embedment: float | None,
    pivot_offset: float | None,
    mu_hold: float | None,
    mu_wedge: float | None,
    support_margin: float | None,
    *rest: float | None,
) -> OrientationSummary:
    margins, counts = rest[: -len(StateClass)], rest[-len(StateClass) :]
    known = [margin for margin in margins if margin is not None]
    return OrientationSummary(
        roll_deg,
        pitch_deg,
        tuple((name, int(count or 0)) for name, count in zip(StateClass, counts, strict=True)),
        drop,
        embedment,
        pivot_offset,
        min(known) if known else None,
        mu_hold,
        mu_wedge,
        support_margin,
    )
