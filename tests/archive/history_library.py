"""A published library with real histories."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from threadstate.archive.rows import history_rows
from threadstate.history.build import histories_of
from threadstate.history.descents import falls_of
from threadstate.history.falls import Falls
from threadstate.history.height_curve import height_curve
from threadstate.history.model import History
from threadstate.history.window import windows_of
from threadstate.library.engine import writer_engine
from threadstate.library.grid import Grid
from threadstate.library.history_rows import HistoryRows
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import chunk_rows
from threadstate.library.write import open_library, publish, write_chunk
from threadstate.state.solve import SolveOptions, solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair

PAIR = quarter_twenty_unc()
SMALL_GRID = Grid(3.0, 3.0, 180.0)
"""9 orientations."""


def histories_of_grid(grid: Grid) -> list[History]:
    """The histories of all orientations of a grid, in order; its phases do not matter."""
    return list(_histories_of_tilts(grid.tilts_deg))


@cache
def _histories_of_tilts(tilts_deg: tuple[float, ...]) -> tuple[History, ...]:
    return tuple(histories_of(quarter_twenty_unc(), [(roll, pitch) for roll in tilts_deg for pitch in tilts_deg]))


@cache
def falls_at(roll_deg: float, pitch_deg: float, pair: Pair = PAIR, options: SolveOptions | None = None) -> Falls:
    """The falls of an orientation."""
    return falls_of(height_curve(pair, roll_deg, pitch_deg, options), pair.thread_pitch)


def rows_of(history: History, pair: Pair = PAIR, options: SolveOptions | None = None) -> HistoryRows:
    """The rows of a history, with its windows and falls."""
    falls = falls_at(history.roll_deg, history.pitch_deg, pair, options)
    return history_rows(history, windows_of(pair, history), falls)


def store_histories(database: str, grid: Grid, histories: Sequence[History]) -> None:
    """Publish the library of a grid with its histories in a migrated database; chunks are written last to first."""
    pair = quarter_twenty_unc()
    engine = writer_engine(database)
    library_id = open_library(engine, LibraryInputs(pair, grid, SolveOptions()))
    for index in reversed(range(grid.orientation_count)):
        rows = chunk_rows(grid.orientation(index), grid.first_ordinal(index), solve_poses(pair, grid.poses(index)))
        history = rows_of(histories[index])
        assert write_chunk(engine, library_id, rows, history)
        assert not write_chunk(engine, library_id, rows, history)
    publish(engine, library_id, grid)
    engine.dispose()
