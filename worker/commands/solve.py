"""``threadstate solve``."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.mesh.options import Descent, FinalStep, MeshOptions, Tangent
from threadstate.mesh.presets import Preset
from worker.options import Designation, Json, Method, MethodName
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
    method: MethodName = Method.EXACT,
    preset: Annotated[
        Preset | None,
        typer.Option("--preset", help="Mesh: how finely the parts are tessellated.", show_default=Preset.PAPER.value),
    ] = None,
    descent: Annotated[
        Descent | None,
        typer.Option(
            "--descent", help="Mesh: how motions are stepped; decades tunnel.", show_default=Descent.SAFE.value
        ),
    ] = None,
    final_step: Annotated[
        FinalStep | None,
        typer.Option(
            "--final-step",
            help="Mesh: the smallest step, on a pitch of 0.05 in.",
            show_default=FinalStep.ONE_MICROINCH.value,
        ),
    ] = None,
    tangent: Annotated[
        Tangent | None,
        typer.Option("--tangent", help="Mesh: the axis of the second turn.", show_default=Tangent.EDGE.value),
    ] = None,
    as_json: Json = False,
) -> None:
    r"""Solve the contact state of one pose, or of every pose of a file.

    With --json, one object a line in the order of the file. Lengths are in the pair's own unit.

    \b
    Examples:
      threadstate solve --roll 4 --pitch -3 --phase 185
      threadstate solve --roll 4 --pitch -3 --phase 185 --json
      threadstate solve --poses poses.csv --json
      threadstate solve --roll 4 --pitch -3 --phase 185 --method mesh --preset medium
      threadstate solve --roll 0 --pitch -4 --phase 350 --method mesh --descent decades
    """
    wanted = _wanted(roll, pitch, phase, poses)
    options = _mesh_options(method, preset, descent, final_step, tangent)
    batch = BATCH if method is Method.EXACT else 1

    from threadstate.state.document import state_json
    from threadstate.state.model import ContactState
    from threadstate.state.solve import solve_poses
    from threadstate.thread.catalogue import DEFAULT_DESIGNATION, pair_by_designation
    from worker.state_table import print_contacts, print_states

    threads = pair_by_designation(DEFAULT_DESIGNATION if pair is None else pair)
    if method is Method.MESH:
        from threadstate.mesh.solve import solve_poses_by_mesh

        found: Callable[..., list[ContactState]] = partial(solve_poses_by_mesh, mesh=options)
    else:
        found = solve_poses
    if as_json:
        for start in range(0, len(wanted), batch):
            for state in found(threads, wanted[start : start + batch]):
                print_line(state_json(state))
        return
    states = found(threads, wanted) if wanted else []
    print_states(states, threads.unit)
    if poses is None:
        print_contacts(states[0], threads.unit)


def _mesh_options(
    method: Method,
    preset: Preset | None,
    descent: Descent | None,
    final_step: FinalStep | None,
    tangent: Tangent | None,
) -> MeshOptions:
    chosen = (("preset", preset), ("descent", descent), ("final-step", final_step), ("tangent", tangent))
    for name, value in chosen:
        if value is not None and method is not Method.MESH:
            raise InvalidValueError(f"--{name}", value.value, "a setting of --method mesh alone")
    return MeshOptions(
        tessellation=(preset or Preset.PAPER).tessellation,
        descent=descent or Descent.SAFE,
        final_step=(final_step or FinalStep.ONE_MICROINCH).thread_pitches,
        tangent=tangent or Tangent.EDGE,
    )


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
