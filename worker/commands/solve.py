"""``threadstate solve``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from worker.options import Designation, Json
from worker.output import print_line

BATCH = 1024
"""How many poses are solved before their answers are printed."""


def solve(
    roll: Annotated[float | None, typer.Option("--roll", metavar="DEG", help="Roll, -10 to 10.")] = None,
    pitch: Annotated[float | None, typer.Option("--pitch", metavar="DEG", help="Pitch, -10 to 10.")] = None,
    phase: Annotated[float | None, typer.Option("--phase", metavar="DEG", help="Phase, any finite angle.")] = None,
    poses: Annotated[
        Path | None,
        typer.Option("--poses", metavar="FILE", help="CSV file of poses, header roll,pitch,phase; /dev/stdin works."),
    ] = None,
    pair: Designation = None,
    as_json: Json = False,
) -> None:
    r"""Solve the contact state of one pose, or of every pose of a file.

    With --json, one object a line in the order of the file. Lengths are in the pair's own unit.

    \b
    Examples:
      threadstate solve --roll 4 --pitch -3 --phase 185
      threadstate solve --roll 4 --pitch -3 --phase 185 --json
      threadstate solve --poses poses.csv --json
    """
    wanted = _wanted(roll, pitch, phase, poses)

    from threadstate.state.document import state_json
    from threadstate.state.solve import solve_poses
    from threadstate.thread.catalogue import DEFAULT_DESIGNATION, pair_by_designation
    from worker.state_table import print_contacts, print_states

    threads = pair_by_designation(DEFAULT_DESIGNATION if pair is None else pair)
    if as_json:
        for start in range(0, len(wanted), BATCH):
            for state in solve_poses(threads, wanted[start : start + BATCH]):
                print_line(state_json(state))
        return
    states = solve_poses(threads, wanted) if wanted else []
    print_states(states, threads.unit)
    if poses is None:
        print_contacts(states[0], threads.unit)


def _wanted(
    roll: float | None, pitch: float | None, phase: float | None, poses: Path | None
) -> list[tuple[float, float, float]]:
    if poses is not None:
        if not roll is pitch is phase is None:
            raise InvalidValueError("--poses", str(poses), "a file, or --roll, --pitch and --phase, not both")
        from worker.poses_file import read_poses

        return read_poses(poses)
    if roll is None or pitch is None or phase is None:
        missing = next(name for name, value in (("roll", roll), ("pitch", pitch), ("phase", phase)) if value is None)
        raise InvalidValueError(f"--{missing}", None, "an angle in degrees, or --poses with a file")
    return [(roll, pitch, phase)]
