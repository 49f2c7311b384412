"""The figures that are measured, and what the plan asks of them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Computed:
    """Means of an orientation: processor times of its states and of its history, its rows, its bytes when pickled."""

    tilt_step_deg: float
    phase_step_deg: float
    orientations: int
    poses: int
    answers_s: float
    history_s: float
    state_rows: float
    history_rows: float
    intervals: float
    pickled_bytes: float

    @property
    def seconds(self) -> float:
        """Processor time of an orientation."""
        return self.answers_s + self.history_s

    @property
    def rows(self) -> float:
        """Rows of an orientation, of all tables."""
        return self.state_rows + self.history_rows


@dataclass(frozen=True)
class Committed:
    """What committing a chunk of a :class:`Computed` takes: processor time here, and of the server if there is one."""

    database: str
    phase_step_deg: float
    here_s: float
    server_s: float

    @property
    def seconds(self) -> float:
        """Both: one waits for the other."""
        return self.here_s + self.server_s


@dataclass(frozen=True)
class Grown:
    """A database with several full libraries; processor times of both sides in ms, means."""

    database: str
    libraries: int
    states: int
    bytes: int
    pose_ms: float
    page_ms: float
    orientation_ms: float
    publish_ms: float


@dataclass(frozen=True)
class Room:
    """The room of a kind of table in the largest of the grown databases, in bytes a state, or an interval."""

    database: str
    table: str
    rows_each: float
    table_bytes: float
    index_bytes: float


@dataclass(frozen=True)
class Copied:
    """A full library that is copied into an empty database, by processor time of both sides."""

    database: str
    states: int
    seconds: float


@dataclass(frozen=True)
class Figures:
    """One run."""

    computed: list[Computed]
    committed: list[Committed]
    grown: list[Grown]
    rooms: list[Room]
    copied: list[Copied]
    parquet_bytes_a_state: float
    flush_ms: float
    network_s: float
