"""Maps of the least frictions over the grid: a row for each orientation, a column for each phase."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from studies.stability.maps import Map, Shade
from studies.statics.study import PushedState

HOLD_LIMITS = (0.1, 0.2, 0.4, 1.0)
WEDGE_LIMITS = (1.0, 1.5, 2.0, 3.0)


@dataclass(frozen=True)
class MapRow:
    """An orientation with its states by phase."""

    roll_deg: float
    pitch_deg: float
    poses: Sequence[PushedState]


def map_rows(states: Sequence[PushedState]) -> list[MapRow]:
    """The rows of the maps; the states are in the order of the grid and all decided."""
    groups = groupby(states, key=lambda one: (one.state.roll_deg, one.state.pitch_deg))
    return [MapRow(roll, pitch, list(group)) for (roll, pitch), group in groups]


def _shade(value: float, limits: tuple[float, ...]) -> int:
    return len(limits) + 1 if value == math.inf else sum(value > limit for limit in limits)


def _hold_shade(one: PushedState) -> int:
    return len(HOLD_LIMITS) + 2 if one.kind == "flush" and one.hold == math.inf else _shade(one.hold, HOLD_LIMITS)


def _wedge_shade(one: PushedState) -> int:
    return _shade(one.wedge, WEDGE_LIMITS)


MAPS: tuple[Map[PushedState], ...] = (
    Map(
        "hold",
        "Least friction at which the contacts can hold a push",
        "A push along -z through the bolt's origin. Overlapping states are shown as if they did not.",
        (
            Shade("#00493a", "up to 0.1"),
            Shade("#1e8a6c", "0.1 to 0.2"),
            Shade("#6db59c", "0.2 to 0.4"),
            Shade("#b5d8cb", "0.4 to 1"),
            Shade("#e8f1ee", "above 1"),
            Shade("#f0c808", "none does"),
            Shade("#d55e00", "none: flush, tips"),
        ),
        _hold_shade,
    ),
    Map(
        "wedge",
        "Least friction at which the contacts can wedge",
        "From there on contact forces can balance each other, and no load frees the bolt for certain.",
        (
            Shade("#04233f", "up to 1"),
            Shade("#175582", "1 to 1.5"),
            Shade("#3d84b0", "1.5 to 2"),
            Shade("#7db4d0", "2 to 3"),
            Shade("#bcd9e6", "above 3"),
            Shade("#f4f1ea", "none does"),
        ),
        _wedge_shade,
    ),
)
