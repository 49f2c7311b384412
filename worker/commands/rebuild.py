"""``threadstate rebuild``."""

from __future__ import annotations

import time

from threadstate.library.solver_method import SolverMethod
from threadstate.settings import read_settings
from worker.options import (
    Database,
    DescentName,
    Dimensions,
    FinalStepName,
    Json,
    MethodName,
    PairName,
    PhaseStep,
    PresetName,
    SceneName,
    Scheduler,
    TangentName,
    TiltMax,
    TiltStep,
    Unchecked,
    Workers,
    chosen_scheduler,
    mesh_options,
)
from worker.output import print_json, print_line


def rebuild(
    database: Database = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    phase_step: PhaseStep = 1.0,
    tilt_max: TiltMax = 4.0,
    tilt_step: TiltStep = 1.0,
    workers: Workers = None,
    scheduler: Scheduler = None,
    method: MethodName = SolverMethod.EXACT,
    preset: PresetName = None,
    descent: DescentName = None,
    final_step: FinalStepName = None,
    tangent: TangentName = None,
    scene: SceneName = None,
    unchecked: Unchecked = False,
    as_json: Json = False,
) -> None:
    r"""Compute the library of a pair and publish it.

    Resumes an interrupted run. A library of the same inputs that is published already is left as it is;
    other inputs make a new library beside the old one. An empty database is migrated first. Poses that the method
    cannot decide are stored as undecided, with the reason; by meshes a pose takes a tenth of a second and more. With a
    scheduler the workers of its Dask cluster compute, and this process writes.

    \b
    Examples:
      threadstate rebuild
      threadstate rebuild --database sqlite:////tmp/threads.sqlite3 --workers 2
      threadstate rebuild --phase-step 5 --tilt-max 2 --json
      threadstate rebuild --pair examples/m6x1.toml
      threadstate rebuild --scheduler tcp://scheduler.example:8786
      threadstate rebuild --phase-step 30 --tilt-max 1 --method mesh --preset coarse
    """
    began = time.perf_counter()
    from worker.forkserver import start_for

    settings = read_settings()
    cluster = chosen_scheduler(settings, scheduler, workers)
    mesh = mesh_options(method, preset, descent, final_step, tangent, scene, unchecked=unchecked)
    if cluster is None:
        start_for(database or settings.database)
    from worker.pairs.selection import chosen_pair
    from worker.rebuild import rebuild_library

    result = rebuild_library(
        database or settings.database,
        pair=chosen_pair(pair, dimension or ()),
        phase_step_deg=phase_step,
        tilt_max_deg=tilt_max,
        tilt_step_deg=tilt_step,
        workers=workers or settings.workers,
        scheduler=cluster,
        mesh=mesh,
    )
    elapsed_s = time.perf_counter() - began
    if as_json:
        print_json(
            {
                "library": result.library_id,
                "input_sha256": result.input_sha256,
                "content_sha256": result.content_sha256,
                "states": result.state_count,
                "undecided": result.undecided_count,
                "computed": result.computed,
                "was_published": result.was_published,
                "elapsed_s": round(elapsed_s, 3),
            }
        )
        return
    undecided = f", {result.undecided_count} poses undecided" if result.undecided_count else ""
    name = f"library {result.library_id} ({result.state_count} states{undecided}, content {result.content_sha256[:12]})"
    if result.was_published:
        print_line(f"{name} is published already; nothing to do")
    else:
        print_line(f"{name} published: {result.computed} poses computed, {elapsed_s:.1f} s")
