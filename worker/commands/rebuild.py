"""``threadstate rebuild``."""

from __future__ import annotations

import time

from threadstate.settings import read_settings
from worker.options import Database, Designation, Json, PhaseStep, TiltMax, TiltStep, Workers
from worker.output import print_json, print_line


def rebuild(
    database: Database = None,
    pair: Designation = None,
    phase_step: PhaseStep = 1.0,
    tilt_max: TiltMax = 4.0,
    tilt_step: TiltStep = 1.0,
    workers: Workers = None,
    as_json: Json = False,
) -> None:
    r"""Compute the library of a pair and publish it.

    Goes on where an earlier run was stopped. A library of the same inputs that is published already is left as it is;
    other inputs make a new library beside the old one. An empty database is migrated first.

    \b
    Examples:
      threadstate rebuild
      threadstate rebuild --database sqlite:////tmp/threads.sqlite3 --workers 2
      threadstate rebuild --phase-step 5 --tilt-max 2 --json
    """
    began = time.perf_counter()
    from worker.computed_library import computed_library

    settings = read_settings()
    result = computed_library(
        database or settings.database,
        designation=pair,
        phase_step_deg=phase_step,
        tilt_max_deg=tilt_max,
        tilt_step_deg=tilt_step,
        workers=workers or settings.workers,
    )
    elapsed_s = time.perf_counter() - began
    if as_json:
        print_json(
            {
                "library": result.library_id,
                "input_sha256": result.input_sha256,
                "content_sha256": result.content_sha256,
                "states": result.state_count,
                "computed": result.computed,
                "was_published": result.was_published,
                "elapsed_s": round(elapsed_s, 3),
            }
        )
        return
    name = f"library {result.library_id} ({result.state_count} states, content {result.content_sha256[:12]})"
    if result.was_published:
        print_line(f"{name} is published already; nothing to do")
    else:
        print_line(f"{name} published: {result.computed} states computed, {elapsed_s:.1f} s")
