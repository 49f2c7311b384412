"""``threadstate assemble``."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.device.strategy import Strategy
from worker.commands.settle import read_device
from worker.commands.solve import wanted_poses
from worker.options import DeviceFile, Dimensions, Json, PairName, Phase, Pitch, Poses, Roll, UnitName, number_option
from worker.output import print_json


def assemble(
    roll: Roll = None,
    pitch: Pitch = None,
    phase: Phase = None,
    poses: Poses = None,
    strategy: Annotated[
        Strategy,
        typer.Option("--strategy", help="How the hand turns: until the snap and back, or clockwise at once."),
    ] = Strategy.CCW_THEN_CW,
    device: DeviceFile = None,
    mu: Annotated[
        float, number_option("--mu", metavar="M", help="Coefficient of friction of all contacts, 0 to 1.")
    ] = 0.0,
    longest_step: Annotated[
        float | None,
        number_option(
            "--longest-step",
            metavar="DEG",
            help="Longest step of the phase, 0.25 to 2; default 2, with friction 1.",
        ),
    ] = None,
    confirm: Annotated[
        bool, typer.Option("--confirm", help="Follow each path with half the step as well, and flag what that changes.")
    ] = False,
    pair: PairName = None,
    dimension: Dimensions = None,
    unit: UnitName = None,
    as_json: Json = False,
) -> None:
    r"""Say how a bolt moves that a compliant device pushes into the nut and turns, and whether it engages.

    With --json, one object a line in the order of the file.

    \b
    Examples:
      threadstate assemble --roll 0 --pitch -4 --phase 300
      threadstate assemble --roll 0 --pitch -4 --phase 300 --strategy cw --json
      threadstate assemble --roll 0 --pitch -4 --phase 300 --mu 0.1 --confirm
      threadstate assemble --poses poses.csv --device examples/device.toml --unit mm --json
    """
    wanted = wanted_poses(roll, pitch, phase, poses)

    from threadstate.device.assemble import assemble_pose
    from threadstate.device.assembly_document import assembly_document
    from threadstate.units import conversion_factor
    from worker.pairs.selection import chosen_pair
    from worker.tables import print_assembly

    threads = chosen_pair(pair, dimension or ())
    shown = unit or threads.unit
    factor = conversion_factor(threads.unit, shown)
    held = read_device(device) if device is not None else None
    for pose in wanted:
        path = assemble_pose(threads, *pose, held, strategy, mu=mu, longest_step=longest_step, confirm=confirm)
        document = assembly_document(path, shown, factor)
        if as_json:
            print_json(document)
        else:
            print_assembly(document)
