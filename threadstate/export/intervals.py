"""Intervals of histories as rows, each with the boundary that it begins at."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from threadstate.export.column import Cell, Column, degrees, integer, length, truth, words

LEAST_LABELS = 3
"""So many contacts have columns of their own, also where no formation has as many."""


@dataclass(frozen=True, slots=True)
class Labels:
    """What touches what at a contact: its stage, regions and features by their names."""

    stage: int
    bolt_region: str
    nut_region: str
    features: str


@dataclass(frozen=True, slots=True)
class IntervalRow:
    """An interval; angles in degrees, lengths in the unit of the table, None as in the history of the orientation."""

    roll_deg: float
    pitch_deg: float
    position: int
    start_deg: float
    end_deg: float
    in_window: bool
    flags: str
    margin: float | None
    first_height: float | None
    last_height: float | None
    formation: str
    state_class: str | None
    contacts: tuple[Labels, ...]
    low_deg: float | None
    high_deg: float | None
    flags_between: str | None
    first_height_before: float | None
    first_height_after: float | None
    last_height_before: float | None
    last_height_after: float | None


def interval_columns(contacts: int) -> tuple[Column[IntervalRow], ...]:
    """The columns of intervals of which no formation has more than so many contacts."""
    return (
        degrees("roll", "roll of the orientation", lambda one: one.roll_deg),
        degrees("pitch", "pitch of the orientation", lambda one: one.pitch_deg),
        integer("position", "place among the orientation's intervals, from 0", lambda one: one.position),
        degrees("start", "phase at which the interval begins", lambda one: one.start_deg),
        degrees("end", "phase at which it ends; above 360 where it holds phase 0", lambda one: one.end_deg),
        truth("in_window", "whether it belongs to a clearance window", lambda one: one.in_window),
        words("class", "class of its states; missing where undecided", lambda one: one.state_class),
        words("flags", "flags of its states, separated by spaces", lambda one: one.flags),
        words("formation", "key of its contact formation", lambda one: one.formation),
        length("margin", "smallest distance from other labels, half way", lambda one: one.margin),
        length("first_height", "height of the bolt's origin at first contact, half way", lambda one: one.first_height),
        length(
            "last_height",
            "height of the bolt's origin in the last pose, at rest or not, half way",
            lambda one: one.last_height,
        ),
        degrees("start_low", "the start lies between this phase, which was solved,", lambda one: one.low_deg),
        degrees("start_high", "and this one", lambda one: one.high_deg),
        words(
            "flags_between",
            "flags that hold at the start alone, separated by spaces",
            lambda one: one.flags_between,
        ),
        length("first_height_before", "height at first contact at `start_low`", lambda one: one.first_height_before),
        length("first_height_after", "height at first contact at `start_high`", lambda one: one.first_height_after),
        length(
            "last_height_before",
            "height in the last pose, at rest or not, at `start_low`",
            lambda one: one.last_height_before,
        ),
        length(
            "last_height_after",
            "height in the last pose, at rest or not, at `start_high`",
            lambda one: one.last_height_after,
        ),
        integer("contacts", "how many contacts the formation has", lambda one: len(one.contacts)),
        *(column for place in range(contacts) for column in _label_columns(place)),
    )


def _label_columns(place: int) -> list[Column[IntervalRow]]:
    def of(cell: Callable[[Labels], Cell]) -> Callable[[IntervalRow], Cell]:
        return lambda one: cell(one.contacts[place]) if len(one.contacts) > place else None

    head = f"contact_{place + 1}"
    return [
        integer(f"{head}_stage", "stage at which the contact is made", of(lambda labels: labels.stage)),
        words(f"{head}_bolt_region", "region of the bolt", of(lambda labels: labels.bolt_region)),
        words(f"{head}_nut_region", "region of the nut", of(lambda labels: labels.nut_region)),
        words(f"{head}_features", "what touches, the bolt's first", of(lambda labels: labels.features)),
    ]
