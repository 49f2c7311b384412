"""What computing processes are asked for, and their messages."""

from __future__ import annotations

from dataclasses import dataclass

from threadstate.chances.inputs import ChancesInputs
from threadstate.chances.model import Record
from threadstate.jobs.model import JobInputs
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


ChunkInputs = JobInputs | ChancesInputs
"""What chunks are computed from: the inputs of a job, or those of sampled paths, which are no job."""
Chunk = LibraryChunk | SettledRows | OrientationMap | Record
"""An orientation is computed, for each kind of job, or a sampled path."""


@dataclass(frozen=True, slots=True)
class Failure:
    """The process cannot go on."""

    reason: str
