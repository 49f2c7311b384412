"""``threadstate rebuild-settled``."""

from __future__ import annotations

import time

from threadstate.settings import read_settings
from worker.options import (
    Database,
    DeviceFile,
    Dimensions,
    Json,
    PairName,
    PhaseStep,
    Scheduler,
    TiltMax,
    TiltStep,
    Workers,
    chosen_scheduler,
)
from worker.output import print_json, print_line


def rebuild_settled(
    database: Database = None,
    device: DeviceFile = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    phase_step: PhaseStep = 1.0,
    tilt_max: TiltMax = 4.0,
    tilt_step: TiltStep = 1.0,
    workers: Workers = None,
    scheduler: Scheduler = None,
    as_json: Json = False,
) -> None:
    r"""Compute the library of settled states of a pair and a device, and publish it.

    Where a bolt comes to rest that the device holds at each pose of a grid and pushes, without friction. Resumes an
    interrupted run; a library of the same inputs that is published already is left as it is. An empty database is
    migrated first.

    \b
    Examples:
      threadstate rebuild-settled
      threadstate rebuild-settled --device examples/device.toml --workers 2
      threadstate rebuild-settled --pair M6 --phase-step 5 --tilt-max 2 --json
    """
    began = time.perf_counter()
    from threadstate.device.model import default_device
    from threadstate.device.settle import check_pair
    from threadstate.library.grid import Grid
    from threadstate.settled.inputs import SettledInputs
    from worker.commands.settle import read_device
    from worker.pairs.selection import chosen_pair
    from worker.settled.rebuild import rebuild_settled_library

    settings = read_settings()
    threads = chosen_pair(pair, dimension or ())
    check_pair(threads)
    held = default_device() if device is None else read_device(device)
    inputs = SettledInputs(threads, Grid(tilt_max, tilt_step, phase_step), held)
    computing = chosen_scheduler(settings, scheduler, workers)
    result = rebuild_settled_library(database or settings.database, inputs, workers or settings.workers, computing)
    elapsed_s = time.perf_counter() - began
    library = result.library
    outcomes = {name.value: count for name, count in result.counts.of_outcome}
    if as_json:
        print_json(
            {
                "settled_library": library.id,
                "input_sha256": library.input_sha256,
                "content_sha256": library.content_sha256,
                "states": library.grid.pose_count,
                "outcomes": outcomes,
                "computed": result.computed,
                "was_published": result.was_published,
                "elapsed_s": round(elapsed_s, 3),
            }
        )
        return
    ends = ", ".join(f"{count} {name}" for name, count in outcomes.items())
    name = f"library {library.id} of settled states ({ends}, content {library.content_sha256[:12]})"
    if result.was_published:
        print_line(f"{name} is published already; nothing to do")
    else:
        print_line(f"{name} published: {result.computed} poses computed, {elapsed_s:.1f} s")
