"""Window and snap of many orientations, in one table."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from threadstate.history.model import History
from threadstate.history.window import Window, deepest_window
from threadstate.thread.pair import Pair


@dataclass(frozen=True, slots=True)
class WindowRow:
    """An orientation, in degrees, and its deepest clearance window, None where it has none."""

    roll_deg: float
    pitch_deg: float
    window: Window | None


def window_table(pair: Pair, histories: Iterable[History]) -> tuple[WindowRow, ...]:
    """One row for each of the pair's histories, in their order."""
    return tuple(WindowRow(h.roll_deg, h.pitch_deg, deepest_window(pair, h)) for h in histories)
