"""Small jobs of each kind with made-up chunks, for tests of what happens to jobs."""

from __future__ import annotations

from sqlalchemy import Engine

from tests.library.states import plain_state
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.jobs.model import JobEvent, JobRecord
from threadstate.jobs.queue import events_after, job_by_id
from threadstate.jobs.work import complete_chunk, lease_chunks, open_job
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import published_libraries
from threadstate.library.rows import chunk_rows
from threadstate.library.write import open_library, write_chunk
from threadstate.settled.inputs import SettledInputs
from threadstate.state.options import SolveOptions
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import Cell, OrientationMap
from threadstate.success.search import mapped_cells
from threadstate.thread.catalogue import quarter_twenty_unc

GRID = Grid(1.0, 1.0, 180.0)
INPUTS = LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions())
SETTLED_INPUTS = SettledInputs(quarter_twenty_unc(), GRID, default_device())
SUCCESS_INPUTS = SuccessInputs(quarter_twenty_unc(), default_device(), Strategy.CCW_THEN_CW, GRID, (0.0, 0.2))


def made_up_orientation(inputs: SuccessInputs, index: int) -> OrientationMap:
    """An orientation of a map in which every frictionless path engages and no other one does."""
    orientation = inputs.grid.orientation(index)

    def made_up(phase_deg: float, mu: float) -> Cell:
        if mu > 0.0:
            return Cell(phase_deg, mu, AssemblyOutcome.NO_SNAP, (), False, 0.5, 2.0, 0.002, 360.0)
        return Cell(phase_deg, mu, AssemblyOutcome.ENGAGED, (), False, 0.25 + index, 3.0, 0.001, -90.0)

    found = mapped_cells(
        made_up,
        lambda _: True,
        inputs.grid.phases_deg,
        inputs.frictions,
        inputs.phase_tolerance_deg,
        inputs.mu_tolerance,
    )
    return OrientationMap(index, orientation.roll_deg, orientation.pitch_deg, *found)


def read_job(engine: Engine, job_id: int) -> JobRecord:
    with engine.connect() as connection:
        return job_by_id(connection, job_id)


def events(engine: Engine, job_id: int, after: int = 0) -> list[JobEvent]:
    with engine.connect() as connection:
        return events_after(connection, job_id, after)


def published_count(engine: Engine) -> int:
    with engine.connect() as connection:
        return len(published_libraries(connection))


def opened(engine: Engine, job_id: int, inputs: LibraryInputs = INPUTS) -> int:
    """Open a job.

    Returns:
        Number of its library.
    """
    library_id = open_library(engine, inputs)
    open_job(engine, job_id, library_id)
    return library_id


def commit(engine: Engine, library_id: int, index: int, grid: Grid = GRID) -> None:
    """Commit a chunk of plain states to the library."""
    states = [plain_state(*pose) for pose in grid.poses(index)]
    write_chunk(engine, library_id, chunk_rows(grid.orientation(index), grid.first_ordinal(index), states))


def work_off(
    engine: Engine,
    worker_id: str,
    job_id: int,
    library_id: int,
    most: int = GRID.orientation_count,
    grid: Grid = GRID,
) -> int:
    """Take, commit and hand in chunks as long as there are free ones, ``most`` at most.

    Returns:
        How many.
    """
    for done in range(most):
        taken = lease_chunks(engine, worker_id, job_id, 1)
        if not taken:
            return done
        commit(engine, library_id, taken[0], grid)
        assert complete_chunk(engine, worker_id, job_id, taken[0])
    return most
