"""A small library of a pair that no catalogue has, in millimetres, with tolerances of its own."""

from __future__ import annotations

from tests.stored_histories.history_library import rows_of
from threadstate.history.build import histories_of
from threadstate.library.engine import writer_engine
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import chunk_rows
from threadstate.library.write import open_library, publish, write_chunk
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_poses
from threadstate.thread.fit import Fit
from threadstate.thread.form import Form
from threadstate.thread.pair import Pair
from threadstate.units import LengthUnit

OWN_PAIR = Pair(
    designation="M6x1",
    unit=LengthUnit.MILLIMETRE,
    nominal_diameter=6.0,
    thread_pitch=1.0,
    form=Form("ISO", 30.0, 0.108, 0.054, 0.054, 0.108),
    fit=Fit("6g/6H", 5.974, 5.324, 4.783, 6.0, 5.35, 4.917),
)
OWN_OPTIONS = SolveOptions(turn_limit_deg=3.0, quasi_stable_fraction=0.4)
"""Turns end early, so that many states lack later contacts: nobody else's answers."""

OWN_GRID = Grid(4.0, 4.0, 90.0)


def store_own_library(database: str, grid: Grid = OWN_GRID, options: SolveOptions = OWN_OPTIONS) -> int:
    """Publish the library with its histories in a migrated database; its number."""
    engine = writer_engine(database)
    library = open_library(engine, LibraryInputs(OWN_PAIR, grid, options))
    tilts = [(roll, pitch) for roll in grid.tilts_deg for pitch in grid.tilts_deg]
    histories = histories_of(OWN_PAIR, tilts, options)
    for index, history in enumerate(histories):
        states = solve_poses(OWN_PAIR, grid.poses(index), options)
        rows = chunk_rows(grid.orientation(index), grid.first_ordinal(index), states)
        write_chunk(engine, library, rows, rows_of(history, OWN_PAIR, options))
    publish(engine, library, grid)
    engine.dispose()
    return library
