"""Messages of a computing process to its parent."""

from __future__ import annotations

from dataclasses import dataclass

from threadstate.library.rows import ChunkRows, HistoryRows


@dataclass(frozen=True, slots=True)
class Ready:
    """The kernels are loaded."""


@dataclass(frozen=True, slots=True)
class Chunk:
    """An orientation is computed; meshes give no history."""

    rows: ChunkRows
    history: HistoryRows | None


@dataclass(frozen=True, slots=True)
class Failure:
    """The process cannot go on."""

    reason: str
