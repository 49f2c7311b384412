"""``threadstate solve``."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from threadstate.errors import InvalidValueError
from threadstate.library.solver_method import SolverMethod
from worker.options import (
    DescentName,
    Dimensions,
    FinalStepName,
    Json,
    MethodName,
    PairName,
    Phase,
    Pitch,
    Poses,
    PresetName,
    Roll,
    SceneName,
    TangentName,
    Unchecked,
    UnitName,
    mesh_options,
)
from worker.output import print_json

BATCH = 1024
"""How many poses are solved before their answers are printed."""


def solve(
    roll: Roll = None,
    pitch: Pitch = None,
    phase: Phase = None,
    poses: Poses = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    unit: UnitName = None,
    method: MethodName = SolverMethod.EXACT,
    preset: PresetName = None,
    descent: DescentName = None,
    final_step: FinalStepName = None,
    tangent: TangentName = None,
    scene: SceneName = None,
    unchecked: Unchecked = False,
    as_json: Json = False,
) -> None:
    r"""Solve the contact state of one pose, or of every pose of a file.

    With --json, one object a line in the order of the file.

    \b
    Examples:
      threadstate solve --roll 4 --pitch -3 --phase 185
      threadstate solve --roll 4 --pitch -3 --phase 185 --json
      threadstate solve --poses poses.csv --json
      threadstate solve --roll 2.5 --pitch -1.2 --phase 357 --pair examples/m6x1.toml
      threadstate solve --roll 4 --pitch -3 --phase 185 --method mesh --preset medium
      threadstate solve --roll 4 --pitch -3 --phase 185 --method mesh --preset fine --scene curves
      threadstate solve --roll 0 --pitch -4 --phase 350 --method mesh --descent decades
    """
    wanted = wanted_poses(roll, pitch, phase, poses)
    mesh = mesh_options(method, preset, descent, final_step, tangent, scene, unchecked=unchecked)
    batch = BATCH if method is SolverMethod.EXACT else 1

    from threadstate.state.document import state_document
    from threadstate.state.model import ContactState
    from threadstate.state.solve import solve_poses
    from threadstate.thread.catalogue import source_of
    from threadstate.units import conversion_factor
    from worker.pairs.selection import chosen_pair
    from worker.tables import print_contacts, print_states

    threads = chosen_pair(pair, dimension or ())
    shown = unit or threads.unit
    factor = conversion_factor(threads.unit, shown)
    if mesh is not None:
        from threadstate.mesh.solve import solve_poses_by_mesh

        found: Callable[..., list[ContactState]] = partial(solve_poses_by_mesh, mesh=mesh)
    else:
        found = solve_poses
    if as_json:
        for start in range(0, len(wanted), batch):
            for state in found(threads, wanted[start : start + batch]):
                print_json({**state_document(state, factor), "unit": shown.value, "source": source_of(threads)})
        return
    states = found(threads, wanted) if wanted else []
    print_states(states, shown, factor)
    if poses is None:
        print_contacts(states[0], shown, factor)


def wanted_poses(
    roll: float | None, pitch: float | None, phase: float | None, poses: Path | None
) -> list[tuple[float, float, float]]:
    """The one pose of three options, or those of a file.

    Raises:
        InvalidValueError: both or neither are given, or the file is not valid.
    """
    if poses is not None:
        if not roll is pitch is phase is None:
            raise InvalidValueError("--poses", str(poses), "a file, or --roll, --pitch and --phase, not both")
        from worker.poses_file import read_poses

        return read_poses(poses)
    if roll is None or pitch is None or phase is None:
        missing = next(name for name, value in (("roll", roll), ("pitch", pitch), ("phase", phase)) if value is None)
        raise InvalidValueError(f"--{missing}", None, "an angle in degrees, or --poses with a file")
    return [(roll, pitch, phase)]
