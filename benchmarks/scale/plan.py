"""From one library to a catalogue: figures of one orientation, multiplied."""

from __future__ import annotations

from dataclasses import dataclass

from benchmarks.scale.figures import Computed, Figures, Room

HISTORY_TABLES = ("history_", "clearance_", "formation")
CORE_HOUR_USD, DISK_GB_MONTH_USD, OBJECTS_GB_MONTH_USD = 0.04, 0.08, 0.02
"""What is assumed a rented core, a disk and a store of objects cost."""
SECONDS_AN_HOUR = 3600.0


@dataclass(frozen=True)
class Step:
    """A size: so many pairs, each over so many orientations that are like those of ``of``."""

    name: str
    pairs: int
    orientations: int
    of: Computed

    @property
    def chunks(self) -> int:
        """Orientations of all pairs."""
        return self.pairs * self.orientations

    @property
    def states(self) -> int:
        """Poses of all pairs."""
        return self.chunks * self.of.poses

    @property
    def rows(self) -> float:
        """Rows of all tables."""
        return self.chunks * self.of.rows

    @property
    def core_hours(self) -> float:
        """Processor time to compute it."""
        return self.chunks * self.of.seconds / SECONDS_AN_HOUR


def steps(figures: Figures) -> list[Step]:
    """From one library of today to the catalogue."""
    coarse, _, fine = figures.computed
    return [
        Step("one pair, 1 deg", 1, 81, coarse),
        Step("10,000 pairs, 1 deg", 10_000, 81, coarse),
        Step("one pair, 0.1 deg", 1, 6_561, fine),
        Step("100 pairs, 0.1 deg", 100, 6_561, fine),
        Step("10,000 pairs, 0.1 deg", 10_000, 6_561, fine),
    ]


def is_history(room: Room) -> bool:
    """Whether a table is of histories."""
    return room.table.startswith(HISTORY_TABLES)


def bytes_of(figures: Figures, database: str, step: Step, *, histories: bool) -> float:
    """Room of the states of a step, or of its histories, with indexes: the measured bytes of a row times its rows."""
    of_kind = [room for room in figures.rooms if room.database == database and is_history(room) == histories]
    held = sum((room.table_bytes + room.index_bytes) * _times(figures, room, histories=histories) for room in of_kind)
    rows = sum(room.rows_each * _times(figures, room, histories=histories) for room in of_kind)
    return held / rows * step.chunks * (step.of.history_rows if histories else step.of.state_rows)


def _times(figures: Figures, room: Room, *, histories: bool) -> float:
    """Formations are counted by states, the other tables of histories by intervals."""
    if histories and not room.table.startswith("formation"):
        return figures.computed[0].intervals / figures.computed[0].poses
    return 1.0
