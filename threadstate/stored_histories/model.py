"""Stored histories: labels, phases, heights, and the changes at each boundary."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from threadstate.history.falls import Falls
from threadstate.history.labels import ContactLabels
from threadstate.history.model import ContactChange
from threadstate.history.window import Window
from threadstate.network.cells import CIRCLE_DEG, Cell, CellMap
from threadstate.state.model import Contact, ContactState, Flag, Vector


@dataclass(frozen=True, slots=True)
class StoredContactChange:
    """A contact that changes at a boundary; labels and normals (nut's frame) are None on a side without it.

    ``stage`` and ``place`` (from 0, within its stage) say which contact; ``moved`` is a length, None where the contact
    is on one side alone.
    """

    stage: int
    place: int
    before: ContactLabels | None
    normal_before: Vector | None
    after: ContactLabels | None
    normal_after: Vector | None
    moved: float | None

    @property
    def reverse(self) -> StoredContactChange:
        """The change the other way round."""
        return StoredContactChange(
            self.stage, self.place, self.after, self.normal_after, self.before, self.normal_before, self.moved
        )


@dataclass(frozen=True, slots=True)
class StoredBoundary:
    """Where the interval of the same position begins: between two phases (degrees) that were solved.

    Heights of the bolt's origin at first contact and in its last pose, at the low and at the high phase; None where the
    state is undecided. ``flags_between`` hold at single phases in between.
    """

    low_deg: float
    high_deg: float
    first_height_before: float | None
    first_height_after: float | None
    last_height_before: float | None
    last_height_after: float | None
    flags_between: tuple[Flag, ...]
    changes: tuple[StoredContactChange, ...]

    @property
    def phase_deg(self) -> float:
        """The middle of the bracket, in [0, 360)."""
        return 0.5 * (self.low_deg + self.high_deg) % CIRCLE_DEG


@dataclass(frozen=True, slots=True)
class StoredHeights:
    """Heights of the bolt's origin half way through a cell, at first contact and in the last pose; None: undecided."""

    first: float | None
    last: float | None


@dataclass(frozen=True)
class StoredHistory:
    """The history of an orientation: ``heights[i]`` belong to ``cells[i]``, which begins at ``boundaries[i]``."""

    cells: tuple[Cell, ...]
    heights: tuple[StoredHeights, ...]
    boundaries: tuple[StoredBoundary, ...]
    windows: tuple[Window, ...]
    falls: Falls


@dataclass(frozen=True)
class StoredHistories:
    """The stored histories of a library, by orientation."""

    tilts_deg: tuple[float, ...]
    orientations: tuple[StoredHistory, ...]

    def tilt_deg(self, orientation: int) -> tuple[float, float]:
        """Roll and pitch of an orientation."""
        i_roll, i_pitch = divmod(orientation, len(self.tilts_deg))
        return self.tilts_deg[i_roll], self.tilts_deg[i_pitch]

    @property
    def cell_map(self) -> CellMap:
        """The cells of all orientations."""
        return CellMap(self.tilts_deg, tuple(one.cells for one in self.orientations))


def stored_changes(
    changes: Sequence[ContactChange], before: ContactState | None, after: ContactState | None
) -> tuple[StoredContactChange, ...]:
    """The changes between two states, with the normals of the contacts in both."""
    return tuple(
        StoredContactChange(
            change.stage,
            change.place,
            change.before,
            None if change.before is None or before is None else _contact(before, change).normal,
            change.after,
            None if change.after is None or after is None else _contact(after, change).normal,
            change.moved,
        )
        for change in changes
    )


def _contact(state: ContactState, change: ContactChange) -> Contact:
    return [contact for contact in state.contacts if contact.stage == change.stage][change.place]
