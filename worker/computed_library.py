"""A library of a pair and a grid, computed in a database with a progress bar; what ``rebuild`` and ``run`` share."""

from __future__ import annotations

from threadstate.library.engine import writing
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.schema import check_schema, stored_revision
from threadstate.mesh.options import MeshOptions
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair
from worker.forkserver import running_forkserver
from worker.migrate import migrate
from worker.progress import progress_bar
from worker.rebuild import Rebuild, rebuild


def computed_library(
    database: str,
    *,
    pair: Pair,
    phase_step_deg: float,
    tilt_max_deg: float,
    tilt_step_deg: float,
    workers: int,
    scheduler: str | None = None,
    mesh: MeshOptions | None = None,
) -> Rebuild:
    """The published library of that pair and grid, computed if need be; an empty database is migrated first.

    Its states are those of the exact method, or with ``mesh`` of meshes.

    Raises:
        InvalidValueError: a value is not valid.
        SchemaError: the database is at another revision.
        ComputeError: a computing process failed.
        ClusterError: the cluster cannot be used, or not any more.
    """
    inputs = LibraryInputs(pair, Grid(tilt_max_deg, tilt_step_deg, phase_step_deg), SolveOptions(), mesh)
    with writing(database) as engine:
        if stored_revision(engine) is None:
            if scheduler is None:
                running_forkserver()  # it loads the kernels meanwhile
            migrate(engine)
        check_schema(engine)
        with progress_bar() as progress:
            return rebuild(engine, inputs, workers, progress, scheduler)
