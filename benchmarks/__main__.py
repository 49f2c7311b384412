"""``make bench``: the exact method's pace, beside meshes, and the time of a whole library."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.exact import first_heights, seconds_to_solve
from benchmarks.rebuild import compile_seconds, floor, profile, rebuilt
from benchmarks.report import Pace, Report, as_json, print_tables
from benchmarks.request_times import measured
from benchmarks.rivalry import rivals
from benchmarks.sample import sample_poses
from benchmarks.work import work_of
from threadstate.library.grid import Grid
from threadstate.thread.catalogue import quarter_twenty_unc

CORES = (1, 2)


def main() -> None:
    """Measure, and print what was found."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of tables")
    parser.add_argument("--poses", type=int, default=6000, help="poses solved by the exact method [%(default)s]")
    parser.add_argument("--compared", type=int, default=1000, help="first of them, also by meshes [%(default)s]")
    parser.add_argument("--tilt-max", type=float, default=4.0, help="of the library, in degrees [%(default)s]")
    parser.add_argument("--tilt-step", type=float, default=1.0, help="of the library, in degrees [%(default)s]")
    parser.add_argument("--phase-step", type=float, default=1.0, help="of the library, in degrees [%(default)s]")
    parser.add_argument("--compilation", action="store_true", help="time the compilation of the kernels, too")
    arguments = parser.parse_args()
    grid = Grid(tilt_max_deg=arguments.tilt_max, tilt_step_deg=arguments.tilt_step, phase_step_deg=arguments.phase_step)
    report = _measured(arguments.poses, arguments.compared, grid, compiling=arguments.compilation)
    if arguments.json:
        print(as_json(report))
    else:
        print_tables(report)


def _measured(pose_count: int, compared_count: int, grid: Grid, *, compiling: bool) -> Report:
    pair = quarter_twenty_unc()
    seconds_to_compile = None
    if compiling:
        _report_progress("compilation ...")
        with tempfile.TemporaryDirectory() as name:
            seconds_to_compile = compile_seconds(Path(name))
    _report_progress("exact method ...")
    sampled = sample_poses(pose_count)
    heights = first_heights(pair, sampled)
    decided = ~np.isnan(heights)
    poses, heights = sampled[decided], heights[decided]
    paces = [Pace(cores, len(poses), seconds_to_solve(pair, poses, cores)) for cores in CORES]
    work = work_of(pair, poses)
    _report_progress("meshes ...")
    compared = poses[:compared_count]
    seconds = min(seconds_to_solve(pair, compared, 1) for _ in range(3))
    first_seconds = min(seconds_to_solve(pair, compared, 1, first_contact_only=True) for _ in range(3))
    found = rivals(pair, compared, heights[:compared_count], seconds)
    _report_progress("whole library ...")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rebuilds = [rebuilt(folder, grid, cores) for cores in CORES]
        parts = profile(folder, pair, grid)
        limit = floor(folder, parts, rebuilds[-1].processes, rebuilds[-1].database_bytes)
        _report_progress("requests ...")
        requests = measured(rebuilds[-1].path(folder), grid)
    return Report(
        sampled=len(sampled),
        declined=len(sampled) - len(poses),
        paces=paces,
        work=work,
        compared=len(compared),
        compared_poses_per_second=len(compared) / seconds,
        first_contacts_per_second=len(compared) / first_seconds,
        rivals=found,
        rebuilds=rebuilds,
        parts=parts,
        floor=limit,
        requests=requests,
        orientations=grid.orientation_count,
        compile_seconds=seconds_to_compile,
    )


def _report_progress(what: str) -> None:
    print(what, file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
