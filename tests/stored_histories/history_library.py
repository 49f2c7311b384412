"""A published library with real histories."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

from tests.shared import computed_once
from threadstate.history.build import histories_of
from threadstate.history.descents import falls_of
from threadstate.history.falls import Falls
from threadstate.history.height_curve import height_curve
from threadstate.history.model import SolvedHistory
from threadstate.history.window import windows_of
from threadstate.library.engine import writer_engine
from threadstate.library.fingerprint import answers_sha256, chunk_sha256, library_sha256
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import HistoryRows, chunk_rows
from threadstate.library.write import open_library, publish, write_chunk
from threadstate.state.solve import SolveOptions, solve_poses
from threadstate.statics.rows import statics_by_ordinal
from threadstate.stored_histories.rows import history_rows
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair

PAIR = quarter_twenty_unc()
SMALL_GRID = Grid(3.0, 3.0, 180.0)
"""9 orientations."""


def histories_of_grid(grid: Grid) -> list[SolvedHistory]:
    """The histories of all orientations of a grid, in order; its phases do not matter."""
    return list(_histories_of_tilts(grid.tilts_deg))


@cache
def _histories_of_tilts(tilts_deg: tuple[float, ...]) -> tuple[SolvedHistory, ...]:
    orientations = [(roll, pitch) for roll in tilts_deg for pitch in tilts_deg]
    name = f"histories of tilts {tilts_deg}"
    return computed_once(name, lambda: tuple(histories_of(quarter_twenty_unc(), orientations)))


@cache
def falls_at(roll_deg: float, pitch_deg: float, pair: Pair = PAIR, options: SolveOptions | None = None) -> Falls:
    """The falls of an orientation."""

    def computed() -> Falls:
        return falls_of(height_curve(pair, roll_deg, pitch_deg, options), pair.thread_pitch)

    if (pair, options) != (PAIR, None):
        return computed()
    return computed_once(f"falls at {roll_deg} {pitch_deg}", computed)


def rows_of(history: SolvedHistory, pair: Pair = PAIR, options: SolveOptions | None = None) -> HistoryRows:
    """The rows of a history, with its windows and falls."""
    falls = falls_at(history.roll_deg, history.pitch_deg, pair, options)
    return history_rows(history, windows_of(pair, history), falls)


@cache
def content_of(grid: Grid, options: SolveOptions | None = None) -> str:
    """The content hash of the library of a grid, computed orientation by orientation without any database."""

    def computed() -> str:
        orientations = [(roll, pitch) for roll in grid.tilts_deg for pitch in grid.tilts_deg]
        histories = histories_of_grid(grid) if options is None else histories_of(PAIR, orientations, options)
        chunks = [solve_poses(PAIR, grid.poses(index), options) for index in range(grid.orientation_count)]
        rows = [rows_of(history, PAIR, options).content_sha256 for history in histories]
        pairs = zip(chunks, rows, strict=True)
        return library_sha256([chunk_sha256(answers_sha256(answers), history) for answers, history in pairs])

    return computed_once(f"content of {grid} {options}", computed)


def store_histories(database: str, grid: Grid, histories: Sequence[SolvedHistory]) -> None:
    """Publish the library of a grid with its histories in a migrated database; chunks are written last to first."""
    pair = quarter_twenty_unc()
    engine = writer_engine(database)
    library_id = open_library(engine, LibraryInputs(pair, grid, SolveOptions()))
    for index in reversed(range(grid.orientation_count)):
        answers, first = solve_poses(pair, grid.poses(index)), grid.first_ordinal(index)
        rows = chunk_rows(grid.orientation(index), first, answers, statics_by_ordinal(pair, first, answers))
        history = rows_of(histories[index])
        assert write_chunk(engine, library_id, rows, history)
        assert not write_chunk(engine, library_id, rows, history)
    publish(engine, library_id, grid)
    engine.dispose()
