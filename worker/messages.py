"""Messages of a computing process to its parent."""

from __future__ import annotations

from dataclasses import dataclass

from threadstate.library.rows import ChunkRows, HistoryRows
from threadstate.settled.rows import SettledRows
from threadstate.success.model import OrientationMap


@dataclass(frozen=True, slots=True)
class Ready:
    """The kernels are loaded."""


@dataclass(frozen=True, slots=True)
class LibraryChunk:
    """The contact states of an orientation are computed; meshes give no history."""

    rows: ChunkRows
    history: HistoryRows | None


Chunk = LibraryChunk | SettledRows | OrientationMap
"""An orientation is computed, for each kind of job."""


@dataclass(frozen=True, slots=True)
class Failure:
    """The process cannot go on."""

    reason: str
