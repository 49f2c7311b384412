"""``threadstate statics``."""

from __future__ import annotations

from typing import Annotated

import typer

from worker.commands.solve import BATCH, wanted_poses
from worker.options import (
    Dimensions,
    Json,
    PairName,
    Phase,
    Pitch,
    Poses,
    Roll,
    UnitName,
    lengths,
    number_option,
    vector,
)
from worker.output import print_json


def statics(
    roll: Roll = None,
    pitch: Pitch = None,
    phase: Phase = None,
    poses: Poses = None,
    mu: Annotated[float, number_option("--mu", metavar="M", help="Coefficient of friction of all contacts.")] = 0.2,
    force: Annotated[
        str, typer.Option("--force", metavar="X,Y,Z", help="Force on the bolt in N, in the nut's frame.")
    ] = "0,0,-1",
    moment: Annotated[
        str, typer.Option("--moment", metavar="X,Y,Z", help="Moment on the bolt, in N times the unit.")
    ] = "0,0,0",
    point: Annotated[
        str | None,
        typer.Option(
            "--point",
            metavar="X,Y,Z",
            help="The point about which the moment is taken.",
            show_default="the bolt's origin",
        ),
    ] = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    unit: UnitName = None,
    as_json: Json = False,
) -> None:
    r"""Say what a load does to a contact state: whether it is held, wedged, or moves, and what turns the bolt.

    With --json, one object a line in the order of the file.

    \b
    Examples:
      threadstate statics --roll 1 --pitch -2 --phase 10
      threadstate statics --roll 1 --pitch -2 --phase 10 --mu 0.15 --force 0,0,-10 --json
      threadstate statics --roll 1 --pitch -2 --phase 10 --force 0.5,0,-10 --moment 0,0.1,0 --json
      threadstate statics --poses poses.csv --mu 0.1 --json
    """
    wanted = wanted_poses(roll, pitch, phase, poses)

    from threadstate.state.solve import solve_poses
    from threadstate.statics.document import statics_document
    from threadstate.statics.load import Load
    from threadstate.statics.solve import checked_friction, statics_of
    from threadstate.units import conversion_factor
    from worker.pairs.selection import chosen_pair
    from worker.tables import print_statics

    threads = chosen_pair(pair, dimension or ())
    shown = unit or threads.unit
    factor = conversion_factor(threads.unit, shown)
    checked_friction(mu)
    load = Load(
        force=vector("--force", force),
        moment=lengths("--moment", moment, factor),
        point=None if point is None else lengths("--point", point, factor),
    )
    for start in range(0, len(wanted), BATCH):
        for state in solve_poses(threads, wanted[start : start + BATCH]):
            found = statics_of(threads, state, load, mu)
            if as_json:
                print_json(statics_document(found, factor))
            else:
                print_statics(found, shown, factor)
