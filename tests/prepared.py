"""Chunks that were computed before, in place of computing processes: for tests of what becomes of chunks."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import cache

import pytest

import worker.jobs.serve
import worker.rebuild
from tests.stored_histories.history_library import PAIR, histories_of_grid, rows_of
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import chunk_rows
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_poses
from threadstate.statics.rows import statics_by_ordinal
from worker.messages import LibraryChunk


class PreparedChunks:
    """Computes chunks as :class:`worker.rebuild.ChunkSource` do, in no time."""

    def __init__(self, grid: Grid) -> None:
        self._grid = grid

    def chunks(self, orientations: Iterable[int], on_ready: Callable[[], None]) -> Iterator[LibraryChunk]:
        """The chunks of these orientations, in their order."""
        on_ready()
        for index in orientations:
            yield prepared_chunk(self._grid, index)


@cache
def prepared_chunk(grid: Grid, index: int) -> LibraryChunk:
    """The chunk of an orientation of the 1/4-20 UNC library of a grid."""
    states, first = solve_poses(PAIR, grid.poses(index)), grid.first_ordinal(index)
    rows = chunk_rows(grid.orientation(index), first, states, statics_by_ordinal(PAIR, first, states))
    return LibraryChunk(rows, rows_of(histories_of_grid(grid)[index]))


def use_prepared_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let rebuilds and workers of this process take prepared chunks; processes of their own compute as ever."""

    @contextmanager
    def prepared(inputs: LibraryInputs, _processes: int, scheduler: str | None) -> Iterator[PreparedChunks]:
        assert inputs == LibraryInputs(PAIR, inputs.grid, SolveOptions())
        assert scheduler is None
        yield PreparedChunks(inputs.grid)

    # As objects: imported only here, the second would take over the first one's replacement for good.
    monkeypatch.setattr(worker.rebuild, "chunk_source", prepared)
    monkeypatch.setattr(worker.jobs.serve, "chunk_source", prepared)
