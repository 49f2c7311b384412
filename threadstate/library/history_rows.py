"""The rows of an orientation's stored history."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass

from sqlalchemy import Table

from threadstate.library import history_tables as tables
from threadstate.library.fingerprint import chunk_sha256
from threadstate.library.rows import ChunkRows, Row


@dataclass(frozen=True, slots=True)
class FormationRows:
    """A formation: its key, its row and the rows of its contacts, without ``library_id``."""

    key: str
    formation: Row
    contacts: tuple[Row, ...]


@dataclass(frozen=True, slots=True)
class HistoryRows:
    """A history as rows without ``library_id``; formations are those that occur in it, by their keys."""

    formations: tuple[FormationRows, ...]
    intervals: tuple[Row, ...]
    boundaries: tuple[Row, ...]
    boundary_contacts: tuple[Row, ...]
    windows: tuple[Row, ...]
    window_courses: tuple[Row, ...]
    descents: tuple[Row, ...]
    descent_jumps: tuple[Row, ...]
    steepest_fall: tuple[Row, ...]

    def of_orientation(self) -> Iterator[tuple[Table, tuple[Row, ...]]]:
        """The tables that hold the orientation's own rows, in an order in which they can be written."""
        yield tables.history_interval, self.intervals
        yield tables.history_boundary, self.boundaries
        yield tables.history_boundary_contact, self.boundary_contacts
        yield tables.clearance_window, self.windows
        yield tables.clearance_window_course, self.window_courses
        yield tables.descent, self.descents
        yield tables.descent_jump, self.descent_jumps
        yield tables.steepest_fall, self.steepest_fall

    @property
    def content_sha256(self) -> str:
        """SHA-256, in hexadecimal, of all rows as JSON, in which every number is its shortest decimal."""
        rows = [[one.formation, one.contacts] for one in self.formations], *(rows for _, rows in self.of_orientation())
        return hashlib.sha256(json.dumps(rows, separators=(",", ":"), allow_nan=False).encode()).hexdigest()


def content_sha256_of(rows: ChunkRows, history: HistoryRows | None) -> str:
    """A chunk's content hash: that of its answers and, where it has one, of its history."""
    return rows.content_sha256 if history is None else chunk_sha256(rows.content_sha256, history.content_sha256)
